//! What is wrong with the text of a law.

use super::law_text::{LawText, Stretch};
use crate::custom_law::Place;
use std::fmt;

/// What is wrong with the text of a law, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mistake {
    /// Its first character.
    pub place: Place,
    /// The place behind its last character.
    pub end: Place,
    /// What is wrong, and what would be right.
    pub message: String,
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// The most mistakes that are reported at once.
const MISTAKES_MAX: usize = 20;

/// Mistakes as they are found.
#[derive(Debug, Default)]
pub(super) struct MistakeList {
    found: Vec<(Stretch, String)>,
}

impl MistakeList {
    /// Notes one; the second at the same place is a consequence of the first.
    pub(super) fn add(&mut self, at: Stretch, message: impl Into<String>) {
        if !self.found.iter().any(|(known, _)| known.from == at.from) {
            // What is quoted may hold anything.
            let message = message.into().replace(char::is_control, "\u{fffd}");
            self.found.push((at, message));
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// Whether so many have been found that no more are worth looking for.
    pub(super) fn is_full(&self) -> bool {
        self.found.len() > 3 * MISTAKES_MAX
    }

    /// The first of them, in the order of the text.
    pub(super) fn in_order(mut self, text: LawText<'_>) -> Vec<Mistake> {
        self.found.sort_by_key(|(at, _)| at.from);
        let first = self.found.into_iter().take(MISTAKES_MAX);
        let placed = first.map(|(at, message)| Mistake {
            place: text.place(at.from),
            end: text.place(at.to),
            message,
        });
        placed.collect()
    }
}
