//! Where paths lead in a text.

use super::EditError;
use crate::overrides::{MOST_PARTS, is_first};
use crate::text::{node::composed, words::instead_of};
use toml_edit::{Item, Table};

/// A part of a path that has been looked up.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum PathStep {
    /// Into a table.
    Key(String),
    /// Into a list.
    Item(usize),
}

/// What the parts of `path` mean in the text; keys need not be there yet.
pub(super) fn steps(root: &Table, path: &str) -> Result<Vec<PathStep>, EditError> {
    let mut parts: Vec<String> = path.split('.').map(|part| composed(part.trim())).collect();
    if parts.iter().any(String::is_empty) {
        return Err(EditError::new(format!("`{path}` is not a path: write it as law.k")));
    }
    if parts.len() > MOST_PARTS {
        return Err(EditError::new(format!("a path of {} parts is too long", parts.len())));
    }
    if let [list, name, ..] = parts.as_slice()
        && list == "robots"
        && index_of(root, "robots", name).is_none()
        && let Some((group, key)) = made_by_group(root, name)
    {
        let group = ["groups".to_owned(), group.to_string()];
        // Its path is that of the group.
        if is_first(&key) && parts.get(2).is_some_and(|part| part == "path") {
            parts.splice(..2, group);
        } else {
            parts.splice(..2, group.into_iter().chain(["members".to_owned(), key]));
        }
    }
    let mut steps: Vec<PathStep> = Vec::with_capacity(parts.len());
    let mut at: Option<&Item> = None;
    for part in parts {
        let list = at.filter(|item| item.is_array_of_tables() || item.is_array());
        if list.is_some() {
            let Some(PathStep::Key(key)) = steps.last() else {
                return Err(EditError::new(format!("`{path}` leads into a list of lists")));
            };
            let inside = steps.len() > 1;
            let found = list.and_then(|list| index_in(&items_of(list), &part));
            let index = found.ok_or_else(|| {
                let own = list.map(items_of).unwrap_or_default();
                let known: Vec<String> = own.iter().filter_map(|item| called(item)).collect();
                EditError::new(if inside {
                    unknown(key, &part, &known)
                } else {
                    nothing_called(root, key, &part)
                })
            })?;
            at = at.and_then(|item| item.get(index));
            steps.push(PathStep::Item(index));
        } else {
            at = if steps.is_empty() { root.get(&part) } else { at.and_then(|item| item.get(&part)) };
            if steps.len() == 1 && steps == [PathStep::Key("robots".to_owned())] && at.is_none() {
                return Err(EditError::new(nothing_called(root, "robots", &part)));
            }
            steps.push(PathStep::Key(part));
        }
    }
    Ok(steps)
}

/// What the steps lead to.
pub(super) fn item_at<'a>(root: &'a Item, steps: &[PathStep]) -> Option<&'a Item> {
    steps.iter().try_fold(root, |item, step| match step {
        PathStep::Key(key) => item.get(key),
        PathStep::Item(index) => item.get(*index),
    })
}

/// The items of a list.
pub(super) fn items<'a>(root: &'a Table, list: &str) -> Vec<&'a Item> {
    root.get(list).map_or_else(Vec::new, items_of)
}

fn items_of(list: &Item) -> Vec<&Item> {
    (0..).map_while(|index| list.get(index)).collect()
}

fn called(item: &Item) -> Option<String> {
    item.get("name").and_then(Item::as_str).map(composed)
}

/// The names in a list.
pub(super) fn names(root: &Table, list: &str) -> impl Iterator<Item = String> {
    items(root, list).into_iter().filter_map(called)
}

/// Index of the item of a list with that name or number.
fn index_of(root: &Table, list: &str, name: &str) -> Option<usize> {
    index_in(&items(root, list), name)
}

fn index_in(items: &[&Item], name: &str) -> Option<usize> {
    let named = items.iter().position(|item| called(item).as_deref() == Some(name));
    named.or_else(|| name.parse().ok().filter(|index| *index < items.len()))
}

/// Index of the group that makes a robot called `name`, and the name that the robot has by its place there.
pub(super) fn made_by_group(root: &Table, name: &str) -> Option<(usize, String)> {
    let groups = items(root, "groups");
    groups.iter().enumerate().find_map(|(index, group)| Some((index, member_called(group, name)?)))
}

fn member_called(group: &Item, name: &str) -> Option<String> {
    let members = group.get("members").and_then(Item::as_table_like);
    let other = |item: &Item| item.get("name").and_then(Item::as_str).map(composed);
    let mut all = members.into_iter().flat_map(toml_edit::TableLike::iter);
    let renamed = all.find(|(_, item)| other(item).as_deref() == Some(name)).map(|(key, _)| composed(key));
    let own = members.and_then(|members| members.get(name)).and_then(other);
    let by_place = || own.is_none().then(|| name.to_owned());
    renamed.or_else(by_place).filter(|key| made_by(group).any(|made| made == *key))
}

fn made_by(group: &Item) -> impl Iterator<Item = String> {
    let start = composed(group.get("name").and_then(Item::as_str).unwrap_or("robot"));
    let count = group.get("count").and_then(Item::as_integer).unwrap_or(0).clamp(0, 10_000);
    let first = if group.get("path").is_some() { 1 } else { 2 };
    (first..=count).map(move |place| format!("{start}-{place}"))
}

/// That `list` has nothing called `name`, with the nearest and some that it has.
pub(super) fn nothing_called(root: &Table, list: &str, name: &str) -> String {
    let mut known: Vec<String> = names(root, list).collect();
    if list == "robots" {
        known.extend(items(root, "groups").into_iter().flat_map(|group| made_by(group).take(1000)));
    }
    unknown(list, name, &known)
}

fn unknown(list: &str, name: &str, known: &[String]) -> String {
    let hint = instead_of(name, known.iter().map(String::as_str));
    format!("no item of `{list}` is called `{name}`{hint}")
}
