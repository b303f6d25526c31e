//! Changes to a scene from the command line: `--set time.duration=5`.

use crate::text::{
    Node, Place, Reading, Value,
    node::Entry,
    words::{did_you_mean, nearest},
};
use std::{fmt, str::FromStr};

/// One change: a dotted path, and the value to put there.
///
/// Robots and groups are named, or counted from 0: `robots.follower-1.distance=1.5`, `robots.0.path.speed=0.8`. The
/// value is TOML; what is not TOML is taken as text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Override(String);

/// An override without `=`, or with an empty part in its path.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is not an override: write path.to.key=value, such as time.duration=5")]
pub struct OverrideError(String);

impl FromStr for Override {
    type Err = OverrideError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.split_once('=') {
            Some((path, _)) if path.split('.').all(|part| !part.trim().is_empty()) => {
                Ok(Self(text.to_owned()))
            }
            _ => Err(OverrideError(text.to_owned())),
        }
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A part of a path and where it stands.
struct Part<'a> {
    text: &'a str,
    place: Place,
}

impl Override {
    /// Puts the value where the path says; notes where there is no such place.
    pub(crate) fn apply(&self, root: &mut Node, reading: &mut Reading) {
        let source = reading.add_source("--set".to_owned(), &self.0);
        let (path, value) = self.0.split_once('=').unwrap_or((&self.0, ""));
        let indent = value.len() - value.trim_start().len();
        let value = Node::parse_value(value.trim(), source, path.len() + 1 + indent);
        let mut start = 0;
        let parts = path.split('.').map(|text| {
            let place = Place { source, start, end: start + text.len() };
            start += text.len() + 1;
            Part { text: text.trim(), place }
        });
        put(root, &parts.collect::<Vec<_>>(), value, reading);
    }
}

fn put(node: &mut Node, path: &[Part<'_>], value: Node, reading: &mut Reading) {
    let [part, rest @ ..] = path else {
        *node = value;
        return;
    };
    match &mut node.value {
        Value::Table(entries) => {
            let index = entries.iter().position(|entry| entry.key == part.text).unwrap_or_else(|| {
                // A table that is not there yet; whether it may be is checked with all others.
                let node = Node { place: part.place, value: Value::Table(vec![]) };
                entries.push(Entry { key: part.text.to_owned(), place: part.place, node });
                entries.len() - 1
            });
            if let Some(entry) = entries.get_mut(index) {
                if entry.key == "vehicle" && !rest.is_empty() {
                    spell_out(&mut entry.node);
                }
                put(&mut entry.node, rest, value, reading);
            }
        }
        Value::List(items) => match find(items, part.text) {
            Ok(index) => {
                if let Some(item) = items.get_mut(index) {
                    put(item, rest, value, reading);
                }
            }
            Err(fault) => reading.note(part.place, fault),
        },
        _ => reading
            .note(part.place, format!("there is nothing called `{}` here: this is a plain value", part.text)),
    }
}

/// Makes a vehicle that is the word of its kind a table of that kind.
fn spell_out(vehicle: &mut Node) {
    if vehicle.as_text().is_some() {
        let place = vehicle.place;
        let kind = Entry { key: "kind".to_owned(), place, node: vehicle.clone() };
        vehicle.value = Value::Table(vec![kind]);
    }
}

/// Index of the item with that name or number.
fn find(items: &[Node], text: &str) -> Result<usize, String> {
    let names = || items.iter().filter_map(|item| item.get("name").and_then(Node::as_text));
    if let Some(index) = items.iter().position(|item| item.get("name").and_then(Node::as_text) == Some(text))
    {
        return Ok(index);
    }
    match text.parse::<usize>() {
        Ok(index) if index < items.len() => Ok(index),
        Ok(index) => Err(format!("there is no item {index}: this list has {}, counted from 0", items.len())),
        Err(_) => {
            let hint = nearest(text, names()).map_or_else(String::new, did_you_mean);
            Err(format!("nothing in this list is called `{text}`{hint}"))
        }
    }
}
