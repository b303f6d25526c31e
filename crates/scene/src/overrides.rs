//! Changes to a scene from the command line: `--set time.duration=5`.

use crate::{
    groups::{made_by, member_called},
    law_file::replaced_by,
    text::{
        Node, Reporter, Span, Value,
        node::{Entry, composed},
        words::instead_of,
    },
};
use std::{fmt, str::FromStr};

/// One change: a dotted path, and the value to put there.
///
/// Robots and groups are named, or counted from 0: `robots.follower-1.distance=1.5`, `robots.0.path.speed=0.8`. The
/// value is TOML; what is not TOML is taken as text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Override(String);

/// What is no override.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum OverrideError {
    /// Without `=`, or with an empty part in its path.
    #[error("`{0}` is not an override: write path.to.key=value, such as time.duration=5")]
    Form(String),
    /// With a path of so many parts.
    #[error("an override with a path of {0} parts is too long: none has more than {MOST_PARTS}")]
    Deep(usize),
}

/// Most parts of a path: nothing in a scene lies deeper.
pub(crate) const MOST_PARTS: usize = 32;

impl FromStr for Override {
    type Err = OverrideError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.split_once('=') {
            Some((path, _)) if path.split('.').count() > MOST_PARTS => {
                Err(OverrideError::Deep(path.split('.').count()))
            }
            Some((path, _)) if path.split('.').all(|part| !part.trim().is_empty()) => {
                Ok(Self(composed(text)))
            }
            _ => Err(OverrideError::Form(text.to_owned())),
        }
    }
}

impl Override {
    /// The path, and the value as it is written.
    pub fn parts(&self) -> (&str, &str) {
        self.0.split_once('=').unwrap_or((&self.0, ""))
    }
}

impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// A part of a path and where it stands.
#[derive(Clone, Copy)]
struct PathPart<'a> {
    text: &'a str,
    span: Span,
}

impl Override {
    /// Puts the value where the path says; reports an error if there is no such place.
    pub(crate) fn apply(&self, root: &mut Node, reporter: &mut Reporter) {
        let source = reporter.add_source("--set".to_owned(), &self.0);
        self.apply_at(Origin { source, offset: 0, whole: None }, root, reporter);
    }

    /// As [`Override::apply`], for text that stands somewhere else.
    pub(crate) fn apply_at(&self, origin: Origin, root: &mut Node, reporter: &mut Reporter) {
        let Origin { source, offset, whole } = origin;
        let (path, value) = self.0.split_once('=').unwrap_or((&self.0, ""));
        let indent = value.len() - value.trim_start().len();
        let mut value = Node::parse_value(value.trim(), source, offset + path.len() + 1 + indent);
        if let Some(whole) = whole {
            value.stand_at(whole);
        }
        let mut start = offset;
        let parts = path.split('.').map(|text| {
            let span = Span { source, start, end: start + text.len() };
            start += text.len() + 1;
            PathPart { text: text.trim(), span: whole.unwrap_or(span) }
        });
        put_in_scene(root, &parts.collect::<Vec<_>>(), value, reporter);
    }

    /// The parts of its path.
    pub(crate) fn path(&self) -> Vec<&str> {
        let (path, _) = self.0.split_once('=').unwrap_or((&self.0, ""));
        path.split('.').map(str::trim).collect()
    }
}

/// Where the text of an override stands.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Origin {
    pub(crate) source: usize,
    /// Of its first character.
    pub(crate) offset: usize,
    /// Where all of it stands, if its characters have no positions of their own.
    pub(crate) whole: Option<Span>,
}

/// Whether a member of a group, by its name by place, is the one that leads where the group has a path.
pub(crate) fn is_first(member: &str) -> bool {
    member.rsplit_once('-').is_some_and(|(_, place)| place == "1")
}

/// Puts `value` at `path`. Robots that a group makes are reached as if they stood in `robots`.
fn put_in_scene(root: &mut Node, path: &[PathPart<'_>], value: Node, reporter: &mut Reporter) {
    let [list, name, rest @ ..] = path else { return put(root, path, value, reporter) };
    let groups = root.items("groups");
    if list.text != "robots" || groups.is_empty() || find(root.items("robots"), name.text).is_ok() {
        return put(root, path, value, reporter);
    }
    let mut known = groups.iter().enumerate();
    let Some((index, key)) = known.find_map(|(index, group)| Some((index, member_called(group, name.text)?)))
    else {
        reporter.report(name.span, unknown_robot(root, name.text));
        return;
    };
    // Its path is that of the group.
    if is_first(&key) && rest.first().is_some_and(|part| part.text == "path") {
        if let Some(group) = root.items_mut("groups").get_mut(index) {
            put(group, rest, value, reporter);
        }
        return;
    }
    let inside: Vec<_> =
        [PathPart { text: "members", span: list.span }, PathPart { text: &key, span: name.span }]
            .into_iter()
            .chain(rest.iter().copied())
            .collect();
    if let Some(group) = root.items_mut("groups").get_mut(index) {
        put(group, &inside, value, reporter);
    }
}

/// That no robot is called `name`, with the nearest and some that there are.
fn unknown_robot(root: &Node, name: &str) -> String {
    let written = root.items("robots").iter().filter_map(|robot| robot.get("name")?.as_text());
    let made: Vec<String> = root.items("groups").iter().flat_map(|group| made_by(group).take(1000)).collect();
    let names = written.chain(made.iter().map(String::as_str));
    format!("there is no robot called `{name}`{}", instead_of(name, names))
}

fn put(node: &mut Node, path: &[PathPart<'_>], value: Node, reporter: &mut Reporter) {
    let [part, rest @ ..] = path else {
        *node = value;
        return;
    };
    if let [key] = rest {
        let replaced: Vec<_> = replaced_by(part.text, key.text).collect();
        if let (false, Value::Table(entries)) = (replaced.is_empty(), &mut node.value)
            && let Some(table) = entries.iter_mut().find(|entry| entry.key == part.text)
        {
            table.node.leave_out(&replaced);
        }
    }
    match &mut node.value {
        Value::Table(entries) => {
            let index = entries.iter().position(|entry| entry.key == part.text).unwrap_or_else(|| {
                // A table that is not there yet; whether it may be is checked with all others.
                let node = Node { span: part.span, value: Value::Table(vec![]) };
                entries.push(Entry { key: part.text.to_owned(), span: part.span, node });
                entries.len() - 1
            });
            if let Some(entry) = entries.get_mut(index) {
                if ["vehicle", "sensing"].contains(&entry.key.as_str()) && !rest.is_empty() {
                    spell_out(&mut entry.node);
                }
                put(&mut entry.node, rest, value, reporter);
            }
        }
        Value::List(items) => match find(items, part.text) {
            Ok(index) => {
                if let Some(item) = items.get_mut(index) {
                    put(item, rest, value, reporter);
                }
            }
            Err(fault) => reporter.report(part.span, fault),
        },
        _ => {
            reporter
                .report(part.span, format!("there is no key `{}` here: this is a plain value", part.text));
        }
    }
}

/// Makes what is the word of its kind a table of that kind.
fn spell_out(thing: &mut Node) {
    if thing.as_text().is_some() {
        let span = thing.span;
        let kind = Entry { key: "kind".to_owned(), span, node: thing.clone() };
        thing.value = Value::Table(vec![kind]);
    }
}

/// Index of the item with that name or number.
fn find(items: &[Node], text: &str) -> Result<usize, String> {
    let names = items.iter().filter_map(|item| item.get("name").and_then(Node::as_text));
    if let Some(index) = items.iter().position(|item| item.get("name").and_then(Node::as_text) == Some(text))
    {
        return Ok(index);
    }
    match text.parse::<usize>() {
        Ok(index) if index < items.len() => Ok(index),
        Ok(index) => Err(format!("there is no item {index}: this list has {}, counted from 0", items.len())),
        Err(_) => Err(format!("no item of this list is called `{text}`{}", instead_of(text, names))),
    }
}
