//! A robot's name, wherever it is spoken of.

use super::merge::merge;
use crate::text::node::composed;
use toml_edit::{Item, Table, Value};

/// Calls the robot `old` `new` from now on.
pub(super) fn rename(root: &mut Table, old: &str, new: &str) {
    for (list, key) in [("robots", "name"), ("robots", "leader"), ("groups", "leader")] {
        for_every_item(root, list, |item| {
            item.get_mut(key).into_iter().for_each(|item| exchange(item, old, new));
        });
    }
    for_every_item(root, "robots", |robot| {
        let leaders = robot.get_mut("leaders");
        for_every_one(leaders, |leader| {
            leader.get_mut("name").into_iter().for_each(|item| exchange(item, old, new));
        });
    });
    for_every_item(root, "groups", |group| {
        let members = group.get_mut("members").and_then(Item::as_table_like_mut);
        for (_, member) in members.into_iter().flat_map(toml_edit::TableLike::iter_mut) {
            member.get_mut("leader").into_iter().for_each(|item| exchange(item, old, new));
        }
    });
    for (table, key) in [("views", "default"), ("film", "view")] {
        for start in ["follow:", "camera:"] {
            let view = root.get_mut(table).and_then(|table| table.get_mut(key));
            if let Some(view) = view {
                exchange(view, &format!("{start}{old}"), &format!("{start}{new}"));
            }
        }
    }
    if let Some(film) = root.get_mut("film").and_then(Item::as_table_mut) {
        for_every_item(film, "shots", |item| {
            if let Some(Item::Value(view)) = item.get_mut("view")
                && let Some(renamed) = view.as_str().and_then(|text| in_views(text, old, new))
            {
                merge(view, Value::from(renamed));
            }
        });
    }
    for_every_item(root, "changes", |item| {
        let sets = item.get_mut("set").and_then(Item::as_array_mut);
        for set in sets.into_iter().flat_map(|sets| sets.iter_mut()) {
            if let Some(renamed) = set.as_str().and_then(|text| in_path(text, old, new)) {
                merge(set, Value::from(renamed));
            }
        }
    });
}

/// Views of the robot `old` as those of `new`.
fn in_views(text: &str, old: &str, new: &str) -> Option<String> {
    let view = |part: &str| {
        let of = |start: &str| {
            part.trim().strip_prefix(start).filter(|name| *name == old).map(|_| start.to_owned())
        };
        of("follow:").or_else(|| of("camera:")).map_or_else(|| part.to_owned(), |start| start + new)
    };
    let renamed = text.split('+').map(view).collect::<Vec<_>>().join("+");
    (renamed != text).then_some(renamed)
}

/// An override of the robot `old` as one of `new`.
fn in_path(text: &str, old: &str, new: &str) -> Option<String> {
    let (path, value) = text.split_once('=')?;
    let mut parts = path.splitn(3, '.');
    let (list, name, rest) = (parts.next()?, parts.next()?, parts.next()?);
    let mut inside = rest.splitn(3, '.');
    let leader = inside.next().filter(|key| key.trim() == "leaders").and(inside.next());
    let led = leader.filter(|leader| leader.trim() == old).and(inside.next());
    let own = name.trim() == old;
    let name = if own { new } else { name };
    let rest = led.map_or_else(|| rest.to_owned(), |key| format!("leaders.{new}.{key}"));
    (list.trim() == "robots" && (own || led.is_some())).then(|| format!("robots.{name}.{rest}={value}"))
}

fn for_every_item(root: &mut Table, list: &str, work: impl Fn(&mut Item)) {
    for_every_one(root.get_mut(list), work);
}

fn for_every_one(list: Option<&mut Item>, work: impl Fn(&mut Item)) {
    let Some(list) = list else { return };
    let mut index = 0;
    while let Some(item) = list.get_mut(index) {
        work(item);
        index += 1;
    }
}

/// Puts the text `new` where the text `old` stands.
fn exchange(item: &mut Item, old: &str, new: &str) {
    if let Item::Value(value) = item
        && value.as_str().map(composed).as_deref() == Some(old)
    {
        merge(value, Value::from(new));
    }
}
