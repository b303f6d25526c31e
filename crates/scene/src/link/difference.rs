//! The link to a text: where it can be told as a shipped scene with values set, as that.

use super::opened::alone;
use super::{Link, LinkError, LinkOrigin, MOST_SETS, TimedOverride};
use crate::shipped::{SHIPPED, shipped};
use crate::{Override, Scene, Shipped};
use std::path::PathBuf;
use toml::{Table, Value};
use toml_edit::Value as Written;

impl Link {
    /// The link to the scene of `text`, called `name`: to the shipped scene of that name, or else of that title, with what
    /// differs set, where that comes to the same scene; else one that carries the text.
    ///
    /// # Errors
    /// What is wrong with the scene, or that it reads other files.
    pub fn to_text(text: &str, name: &str) -> Result<Self, LinkError> {
        let wanted = alone(Scene::parse(text, PathBuf::from(name).with_extension("toml"), &[])?)?;
        let titled = || SHIPPED.iter().find(|shipped| shipped.title() == wanted.title);
        let found = shipped(name).or_else(titled).and_then(|shipped| from_shipped(shipped, text, &wanted));
        Ok(found.unwrap_or_else(|| Self::to(LinkOrigin::Text(text.to_owned()))))
    }
}

/// The link to a shipped scene that leads to `wanted`, whose text is `text`.
fn from_shipped(shipped: &'static Shipped, text: &str, wanted: &Scene) -> Option<Link> {
    let mut link = Link::to(LinkOrigin::Shipped(shipped));
    if text == shipped.text {
        return Some(link);
    }
    let [mut before, mut after] = [shipped.text, text].map(|text| text.parse::<Table>().ok());
    let [before, after] = [before.as_mut()?, after.as_mut()?];
    let [own, changes] = [before.remove("changes"), after.remove("changes")];
    let changed = own != changes;
    if !after.contains_key("expect") && changed {
        // What a link changes later is not what the scene expects.
        before.remove("expect");
    }
    let mut sets = vec![];
    difference(before, after, "", &mut sets)?;
    if sets.len() > MOST_SETS[0] {
        return None;
    }
    link.set = sets.iter().map(|set| set.parse()).collect::<Result<_, _>>().ok()?;
    if changed {
        link.changes = match own {
            None => written_changes(&changes?)?,
            Some(_) => added_changes(&link.open().ok()?.scene, wanted)?,
        };
    }
    let same = link.open().is_ok_and(|opened| opened.scene == *wanted);
    same.then_some(link)
}

/// Overrides that lead from one table to another; `None` where there are none.
fn difference(before: &Table, after: &Table, at: &str, sets: &mut Vec<String>) -> Option<()> {
    if before.keys().any(|key| !after.contains_key(key)) {
        return None;
    }
    for (key, value) in after.iter().filter(|(key, value)| before.get(*key) != Some(*value)) {
        if key.contains(['.', '=']) || key.trim() != key {
            return None;
        }
        let path = format!("{at}{key}");
        match (before.get(key), value) {
            (Some(Value::Table(old)), Value::Table(new)) => {
                // Another kind has other keys.
                if difference(old, new, &format!("{path}."), sets).is_none() {
                    sets.push(format!("{path}={}", short(value)));
                }
            }
            (None, Value::Table(new)) if at.is_empty() => {
                difference(&Table::new(), new, &format!("{path}."), sets)?;
            }
            (Some(Value::Array(old)), Value::Array(new)) if at.is_empty() => {
                items(old, new, &path, sets)?;
            }
            _ if at.is_empty() && matches!(value, Value::Array(_)) => return None,
            _ => sets.push(format!("{path}={}", short(value))),
        }
    }
    Some(())
}

/// Overrides that lead from one list of tables to another with the same items.
fn items(before: &[Value], after: &[Value], list: &str, sets: &mut Vec<String>) -> Option<()> {
    let name = |item: &Value| item.get("name").and_then(Value::as_str).map(str::to_owned);
    if !before.iter().map(name).eq(after.iter().map(name)) {
        return None;
    }
    for (index, (old, new)) in before.iter().zip(after).enumerate() {
        let item = name(new).unwrap_or_else(|| index.to_string());
        difference(old.as_table()?, new.as_table()?, &format!("{list}.{item}."), sets)?;
    }
    Some(())
}

/// The `[[changes]]` of a text, as they are written.
fn written_changes(changes: &Value) -> Option<Vec<TimedOverride>> {
    let mut later = vec![];
    for change in changes.as_array()? {
        let at = change.get("at")?;
        let at = at.as_float().or_else(|| Some(at.as_integer()? as f64))?;
        for set in change.get("set")?.as_array()? {
            later.push(TimedOverride { at, set: tightened(set.as_str()?)? });
        }
    }
    Some(later)
}

/// The changes that `wanted` has more than `own`.
fn added_changes(own: &Scene, wanted: &Scene) -> Option<Vec<TimedOverride>> {
    let mut left: Vec<_> = own.changes.iter().map(|change| (change.at, &change.set)).collect();
    let mut later = vec![];
    for change in &wanted.changes {
        match left.iter().position(|known| *known == (change.at, &change.set)) {
            Some(known) => drop(left.remove(known)),
            None => {
                for set in &change.set {
                    later.push(TimedOverride { at: change.at, set: tightened(set)? });
                }
            }
        }
    }
    left.is_empty().then_some(later)
}

/// An override whose value is written as shortly as can be.
pub(super) fn tightened(set: &str) -> Option<Override> {
    let (path, value) = set.split_once('=')?;
    let value = value.trim();
    let short = value.parse::<Value>().map_or_else(|_| value.to_owned(), |value| short(&value));
    format!("{}={short}", path.trim()).parse().ok()
}

/// A value behind `=`, without the spaces and quotes that it does not need.
fn short(value: &Value) -> String {
    match value {
        // A word needs quotes where it would be something else without.
        Value::String(text) => {
            let plain = text.trim() == text && !text.is_empty() && !text.contains(char::is_control);
            if plain && text.parse::<Written>().is_err() { text.clone() } else { value.to_string() }
        }
        Value::Array(items) => format!("[{}]", items.iter().map(inner).collect::<Vec<_>>().join(",")),
        Value::Float(number) => number_text(*number),
        _ => value.to_string(),
    }
}

/// A value in a list.
fn inner(value: &Value) -> String {
    match value {
        Value::Array(_) | Value::Float(_) => short(value),
        _ => value.to_string(),
    }
}

/// Whole numbers without their `.0`: scenes take both.
fn number_text(number: f64) -> String {
    if number == number.trunc() && number.abs() < 1e6 && (number != 0.0 || number.is_sign_positive()) {
        format!("{number}")
    } else {
        format!("{number:?}")
    }
}
