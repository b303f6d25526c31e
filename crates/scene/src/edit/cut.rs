//! Lines taken out of a text. What is left stands as it stood, comment lines above all.

use super::EditError;
use super::find::{PathStep, item_at};
use std::ops::Range;
use toml_edit::{Document, DocumentMut, Item, Table};

/// Takes out what the steps lead to.
pub(super) fn cut(document: &mut DocumentMut, steps: &[PathStep]) -> Result<(), EditError> {
    let [before @ .., PathStep::Key(key)] = steps else {
        return Err(EditError::new("this is an item of a list: it is removed by its name"));
    };
    let read = read(document)?;
    let parent = item_at(read.as_item(), before);
    if let Some(Item::Table(table)) = parent {
        let text = read.raw();
        let mut gone = vec![];
        if let Some((key, item)) = table.get_key_value(key) {
            lines_of(text, key.span(), item, &mut gone);
        }
        let member = matches!(before, [.., PathStep::Key(key), PathStep::Key(_)] if key == "members");
        if member && table.len() == 1 {
            gone.extend(table.span().map(|span| lines(text, &span)));
        }
        return take_out(document, text, gone);
    }
    let parent = before.iter().try_fold(document.as_item_mut(), |item, step| match step {
        PathStep::Key(key) => item.get_mut(key),
        PathStep::Item(index) => item.get_mut(*index),
    });
    if let Some(Item::Value(toml_edit::Value::InlineTable(table))) = parent {
        table.remove(key);
        super::merge::settle(table);
    }
    Ok(())
}

/// Takes out the item of a list that the steps lead to, with the comment lines right above it.
pub(super) fn cut_item(document: &mut DocumentMut, steps: &[PathStep]) -> Result<(), EditError> {
    let read = read(document)?;
    if let Some(Item::Table(table)) = item_at(read.as_item(), steps) {
        let text = read.raw();
        return take_out(document, text, item_of(text, table));
    }
    let [PathStep::Key(list), PathStep::Item(index)] = steps else {
        return Err(EditError::new("this is not an item of a list"));
    };
    if let Some(list) = document.get_mut(list).and_then(Item::as_array_mut) {
        list.remove(*index);
    }
    Ok(())
}

/// Takes out all items of a list, as [`cut_item`] does with one.
pub(super) fn cut_items(document: &mut DocumentMut, list: &str) -> Result<(), EditError> {
    let read = read(document)?;
    let Some(Item::ArrayOfTables(tables)) = read.get(list) else {
        return cut(document, &[PathStep::Key(list.to_owned())]);
    };
    let text = read.raw();
    take_out(document, text, tables.iter().flat_map(|table| item_of(text, table)).collect())
}

/// The lines of an item of a list, with the comment lines right above it.
fn item_of(text: &str, table: &Table) -> Vec<Range<usize>> {
    let mut gone = vec![];
    blocks_of(text, table, &mut gone);
    if let Some(first) = gone.iter_mut().min_by_key(|range| range.start) {
        first.start = above(text, first.start);
    }
    gone
}

/// The text again, with the places of everything.
fn read(document: &DocumentMut) -> Result<Document<String>, EditError> {
    Document::parse(document.to_string()).map_err(|error| EditError::new(error.to_string()))
}

/// Lines of a value or of a table, heads and values one by one: what stands between them stays.
fn lines_of(text: &str, key: Option<Range<usize>>, item: &Item, gone: &mut Vec<Range<usize>>) {
    match item {
        Item::Value(value) => {
            let span = key.zip(value.span()).map(|(key, value)| key.start..value.end);
            gone.extend(span.map(|span| lines(text, &span)));
        }
        Item::Table(table) => lines_of_table(text, table, gone),
        Item::ArrayOfTables(tables) => tables.iter().for_each(|table| lines_of_table(text, table, gone)),
        Item::None => {}
    }
}

fn lines_of_table(text: &str, table: &Table, gone: &mut Vec<Range<usize>>) {
    if !table.is_dotted() && !table.is_implicit() {
        gone.extend(table.span().map(|span| lines(text, &span)));
    }
    for (key, item) in table {
        lines_of(text, table.key(key).and_then(toml_edit::Key::span), item, gone);
    }
}

/// The lines from the head of a table to its last value, and those of the tables in it.
fn blocks_of(text: &str, table: &Table, gone: &mut Vec<Range<usize>>) {
    let mut own = vec![];
    for (key, item) in table {
        match item {
            Item::Table(inner) if !inner.is_dotted() => blocks_of(text, inner, gone),
            Item::ArrayOfTables(inner) => inner.iter().for_each(|table| blocks_of(text, table, gone)),
            item => lines_of(text, table.key(key).and_then(toml_edit::Key::span), item, &mut own),
        }
    }
    if !table.is_implicit() {
        own.extend(table.span().map(|span| lines(text, &span)));
    }
    let (start, end) = (own.iter().map(|r| r.start).min(), own.iter().map(|r| r.end).max());
    gone.extend(start.zip(end).map(|(start, end)| start..end));
}

/// The whole lines that `span` touches.
fn lines(text: &str, span: &Range<usize>) -> Range<usize> {
    let start = text.get(..span.start).and_then(|before| before.rfind('\n')).map_or(0, |at| at + 1);
    let end =
        text.get(span.end..).and_then(|after| after.find('\n')).map_or(text.len(), |at| span.end + at + 1);
    start..end
}

/// Start of the comment lines right above `start`, and of the blank lines above those.
fn above(text: &str, start: usize) -> usize {
    let mut start = start;
    for comments in [true, false] {
        while let Some(before) = text.get(..start).and_then(|before| before.strip_suffix('\n')) {
            let line = before.rfind('\n').map_or(0, |at| at + 1);
            let words = before.get(line..).unwrap_or("").trim();
            if words.starts_with('#') != comments || (!comments && !words.is_empty()) {
                break;
            }
            start = line;
        }
    }
    start
}

fn take_out(document: &mut DocumentMut, text: &str, mut gone: Vec<Range<usize>>) -> Result<(), EditError> {
    gone.sort_by_key(|range| range.start);
    let (mut left, mut at) = (String::with_capacity(text.len()), 0);
    for range in gone {
        left.push_str(text.get(at..range.start.max(at)).unwrap_or(""));
        at = range.end.max(at);
    }
    left.push_str(text.get(at..).unwrap_or(""));
    *document = left.parse().map_err(|error: toml_edit::TomlError| EditError::new(error.to_string()))?;
    Ok(())
}
