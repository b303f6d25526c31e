//! The tree of a TOML text, each value with its place.

use crate::text::{Reporter, Span};
use std::ops::Range;
use toml::de::{DeTable, DeValue};
use unicode_normalization::UnicodeNormalization;

/// A value and where it stands.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) span: Span,
    pub(crate) value: Value,
}

/// A value as TOML knows it.
#[derive(Debug, Clone)]
pub(crate) enum Value {
    Number(f64),
    Integer(i64),
    Flag(bool),
    Text(String),
    Date,
    List(Vec<Node>),
    Table(Vec<Entry>),
}

/// One line `key = value` of a table.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) key: String,
    /// Where the key stands.
    pub(crate) span: Span,
    pub(crate) node: Node,
}

impl Node {
    /// The tree of a whole file; syntax errors go to `reporter`.
    pub(crate) fn parse_document(text: &str, source: usize, reporter: &mut Reporter) -> Option<Self> {
        let (table, errors) = DeTable::parse_recoverable(text);
        let mut last_line = None;
        for error in &errors {
            let span = error.span().unwrap_or(0..0);
            let line = text.get(..span.start).map(|before| before.matches('\n').count());
            // What follows on the same line is mostly a consequence of the first error there.
            if line != last_line {
                reporter.report(span_at(source, 0, &span), format!("not TOML: {}", error.message()));
            }
            last_line = line;
        }
        let at = table.span();
        errors.is_empty().then(|| from_table(table.get_ref(), span_at(source, 0, &at), 0))
    }

    /// The tree of a single value that stands at byte `offset` of its source; plain text where it is not TOML.
    pub(crate) fn parse_value(text: &str, source: usize, offset: usize) -> Self {
        match DeValue::parse(text) {
            Ok(value) => from_value(value.get_ref(), span_at(source, offset, &value.span()), offset),
            Err(_) => {
                Self { span: span_at(source, offset, &(0..text.len())), value: Value::Text(composed(text)) }
            }
        }
    }

    /// What this is, in words; `shown` is its text in the file.
    pub(crate) fn describe(&self, shown: &str) -> String {
        match &self.value {
            Value::Table(_) => "a table".to_owned(),
            Value::List(list) => format!("a list of {}", list.len()),
            Value::Text(text) => format!("the text {:?}", shorten(text)),
            Value::Date => format!("the date `{}`", shorten(shown)),
            Value::Number(number) if shown.is_empty() => format!("`{number}`"),
            _ => format!("`{}`", shorten(shown)),
        }
    }

    /// The line of `key`, if this is a table that has it.
    pub(crate) fn entry(&self, key: &str) -> Option<&Entry> {
        self.as_table()?.iter().find(|entry| entry.key == key)
    }

    /// The value of `key`, if this is a table that has it.
    pub(crate) fn get(&self, key: &str) -> Option<&Self> {
        self.entry(key).map(|entry| &entry.node)
    }

    /// The items of the list `key`, if this is a table that has it.
    pub(crate) fn items(&self, key: &str) -> &[Self] {
        self.get(key).and_then(Self::as_list).unwrap_or_default()
    }

    /// The list `key`, if this is a table that has it.
    pub(crate) fn items_mut(&mut self, key: &str) -> &mut [Self] {
        let entry = match &mut self.value {
            Value::Table(entries) => entries.iter_mut().find(|entry| entry.key == key),
            _ => None,
        };
        match entry.map(|entry| &mut entry.node.value) {
            Some(Value::List(items)) => items,
            _ => &mut [],
        }
    }

    /// Leaves out the lines of `keys`, if this is a table that has them.
    pub(crate) fn leave_out(&mut self, keys: &[&str]) {
        if let Value::Table(entries) = &mut self.value {
            entries.retain(|entry| !keys.contains(&entry.key.as_str()));
        }
    }

    /// Says of all of it that it stands at `span`.
    pub(crate) fn stand_at(&mut self, span: Span) {
        self.span = span;
        match &mut self.value {
            Value::List(items) => items.iter_mut().for_each(|item| item.stand_at(span)),
            Value::Table(entries) => {
                for entry in entries {
                    entry.span = span;
                    entry.node.stand_at(span);
                }
            }
            _ => {}
        }
    }

    /// The lines of this table.
    pub(crate) fn as_table(&self) -> Option<&[Entry]> {
        match &self.value {
            Value::Table(entries) => Some(entries),
            _ => None,
        }
    }

    /// The items of this list.
    pub(crate) fn as_list(&self) -> Option<&[Self]> {
        match &self.value {
            Value::List(items) => Some(items),
            _ => None,
        }
    }

    /// This as a number.
    pub(crate) fn as_number(&self) -> Option<f64> {
        match self.value {
            Value::Number(number) => Some(number),
            Value::Integer(integer) => Some(integer as f64),
            _ => None,
        }
    }

    /// This as text.
    pub(crate) fn as_text(&self) -> Option<&str> {
        match &self.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// Text in NFC: letters with accents are one character each, so that texts that look the same are equal.
pub fn composed(text: &str) -> String {
    text.nfc().collect()
}

fn shorten(text: &str) -> String {
    if text.chars().count() <= 40 {
        return text.to_owned();
    }
    text.chars().take(39).chain(['…']).collect()
}

fn span_at(source: usize, offset: usize, span: &Range<usize>) -> Span {
    Span { source, start: offset + span.start, end: offset + span.end }
}

fn from_table(table: &DeTable<'_>, at: Span, offset: usize) -> Node {
    let entries = table.iter().map(|(key, value)| Entry {
        key: composed(key.get_ref()),
        span: span_at(at.source, offset, &key.span()),
        node: from_value(value.get_ref(), span_at(at.source, offset, &value.span()), offset),
    });
    Node { span: at, value: Value::Table(entries.collect()) }
}

fn from_value(value: &DeValue<'_>, at: Span, offset: usize) -> Node {
    let value = match value {
        DeValue::String(text) => Value::Text(composed(text)),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(integer) => Value::Integer(integer),
            Err(_) => Value::Number(integer.as_str().parse().unwrap_or(f64::INFINITY)),
        },
        DeValue::Float(float) => Value::Number(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(items) => {
            let items = items.iter();
            Value::List(
                items
                    .map(|i| from_value(i.get_ref(), span_at(at.source, offset, &i.span()), offset))
                    .collect(),
            )
        }
        DeValue::Table(table) => return from_table(table, at, offset),
    };
    Node { span: at, value }
}
