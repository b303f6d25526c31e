//! What has been read so far: the texts, and what was found wrong with them.

use crate::{Diagnostic, Diagnostics, text::Node};
use std::path::{Path, PathBuf};
use vocabulary::readable;

/// Messages that are kept at most: more would not help.
const MOST_NOTES: usize = 100;

/// Where something stands: bytes `start..end` of one of the texts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) struct Span {
    pub(crate) source: usize,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

impl Span {
    /// Its first character.
    pub(crate) fn first(self) -> Self {
        Self { end: self.start, ..self }
    }
}

struct SourceText {
    origin: String,
    text: String,
}

/// Texts read and faults found while a scene is loaded.
pub(crate) struct Reporter {
    sources: Vec<SourceText>,
    notes: Vec<(Span, String)>,
    /// Key whose value is being read.
    key: String,
    /// Folder in which the tables of a scene are looked for.
    folder: PathBuf,
    /// Files read besides the scene.
    pub(crate) files: Vec<PathBuf>,
}

impl Reporter {
    pub(crate) fn new(folder: &Path) -> Self {
        Self { sources: vec![], notes: vec![], key: String::new(), folder: folder.to_owned(), files: vec![] }
    }

    /// Keeps a text, so that places in it can be shown; returns its number.
    pub(crate) fn add_source(&mut self, origin: String, text: &str) -> usize {
        self.sources.push(SourceText { origin, text: text.to_owned() });
        self.sources.len() - 1
    }

    /// Path of a file named in the scene.
    pub(crate) fn beside_scene(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    pub(crate) fn report(&mut self, span: Span, message: impl Into<String>) {
        if !self.is_full() {
            self.notes.push((span, message.into()));
        }
    }

    /// Reports that the value being read is not what it has to be.
    pub(crate) fn wrong(&mut self, node: &Node, expected: &str) {
        let subject = if self.key.is_empty() { "this".to_owned() } else { format!("`{}`", self.key) };
        let found = node.describe(self.shown(node.span));
        self.report(node.span, format!("{subject} must be {expected}, not {found}"));
    }

    /// `value`, if there is one; else reports that the value being read is not what it must be.
    pub(crate) fn expect<T>(
        &mut self,
        value: Option<T>,
        node: &Node,
        expected: impl FnOnce() -> String,
    ) -> Option<T> {
        if value.is_none() {
            self.wrong(node, &expected());
        }
        value
    }

    /// Does `work` as part of reading the value of `key`.
    pub(crate) fn inside<T>(&mut self, key: &str, work: impl FnOnce(&mut Self) -> T) -> T {
        let outer = std::mem::replace(&mut self.key, key.to_owned());
        let result = work(self);
        self.key = outer;
        result
    }

    /// Appends to the last message.
    pub(crate) fn append_to_last(&mut self, more: &str) {
        if let Some((_, message)) = self.notes.last_mut() {
            message.push_str(more);
        }
    }

    /// Whether further messages are dropped.
    pub(crate) fn is_full(&self) -> bool {
        self.notes.len() >= MOST_NOTES
    }

    pub(crate) fn is_clean(&self) -> bool {
        self.notes.is_empty()
    }

    pub(crate) fn into_diagnostics(mut self) -> Diagnostics {
        self.notes.sort();
        self.notes.dedup();
        Diagnostics(self.notes.iter().map(|(span, message)| self.diagnostic(*span, message)).collect())
    }

    /// Number of messages so far.
    pub(crate) fn notes(&self) -> usize {
        self.notes.len()
    }

    /// Moves messages from number `first` on that lie outside `span` to `span`, and appends `why`.
    pub(crate) fn gather(&mut self, first: usize, span: Span, why: &str) {
        for (at, message) in self.notes.iter_mut().skip(first) {
            if at.source != span.source || at.start < span.start || at.end > span.end {
                *at = span;
                message.push_str(why);
            }
        }
    }

    /// The text at a place.
    pub(crate) fn shown(&self, span: Span) -> &str {
        self.sources.get(span.source).and_then(|s| s.text.get(span.start..span.end)).unwrap_or("")
    }

    fn diagnostic(&self, span: Span, message: &str) -> Diagnostic {
        let message = readable(message).into_owned();
        let Some(source) = self.sources.get(span.source) else {
            return Diagnostic { width: 1, message, ..Diagnostic::default() };
        };
        let (before, after) = source.text.split_at(floor_boundary(&source.text, span.start));
        let line_start = before.rfind('\n').map_or(0, |at| at + 1);
        let rest = after.split(['\n', '\r']).next().unwrap_or("");
        let meant = self.shown(span).split(['\n', '\r']).next().unwrap_or("");
        Diagnostic {
            origin: source.origin.clone(),
            line: before.bytes().filter(|byte| *byte == b'\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            excerpt: format!("{}{rest}", &before[line_start..]),
            width: meant.trim_end().chars().count().max(1),
            message,
        }
    }
}

fn floor_boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}
