//! What is wrong with a scene, and where.

use crate::text::words::suggested;
use std::{fmt, path::Path};

/// One thing that is wrong.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Diagnostic {
    /// File or override it was found in, as shown to the user.
    pub origin: String,
    /// Line from 1; 0 where the whole file is meant.
    pub line: usize,
    /// Column in characters from 1; 0 where the whole file is meant.
    pub column: usize,
    /// The line it stands in; empty where the whole file is meant.
    pub excerpt: String,
    /// Number of characters from `column` that are meant, at least 1.
    pub width: usize,
    /// What is wrong and what would be right.
    pub message: String,
}

impl Diagnostic {
    /// The word that may have been meant, if the message names one.
    pub fn suggestion(&self) -> Option<&str> {
        suggested(&self.message)
    }
}

/// Everything that is wrong, in the order of the text; never empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostics(pub(crate) Vec<Diagnostic>);

impl Diagnostics {
    /// All of them.
    pub fn all(&self) -> &[Diagnostic] {
        &self.0
    }

    /// One thing that is wrong with a whole file.
    pub fn of_file(path: &Path, message: &str) -> Self {
        Self::whole_file(path, [message.to_owned()])
    }

    pub(crate) fn whole_file(path: &Path, messages: impl IntoIterator<Item = String>) -> Self {
        let origin = path.display().to_string();
        let one = |message| Diagnostic { origin: origin.clone(), width: 1, message, ..Diagnostic::default() };
        Self(messages.into_iter().map(one).collect())
    }
}

impl std::error::Error for Diagnostics {}

/// More than this at once are not read.
const MOST_SHOWN: usize = 20;

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, diagnostic) in self.0.iter().take(MOST_SHOWN).enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{diagnostic}")?;
        }
        if self.0.len() > MOST_SHOWN {
            write!(f, "\n… and {} more", self.0.len() - MOST_SHOWN)?;
        }
        Ok(())
    }
}

/// Longest part of a line that is shown, characters.
const MOST_SHOWN_OF_LINE: usize = 100;

impl fmt::Display for Diagnostic {
    /// `file:line:column: message`, then the line with carets under what is meant.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { origin, line, column, message, .. } = self;
        if *line == 0 {
            return write!(f, "{}: {}", plain(origin), plain(message));
        }
        writeln!(f, "{}:{line}:{column}: {}", plain(origin), plain(message))?;
        // A long line is shown from a little before the place that is meant.
        let skip = if *column > MOST_SHOWN_OF_LINE { column - MOST_SHOWN_OF_LINE / 2 } else { 0 };
        let shown: String = self.excerpt.chars().skip(skip).take(MOST_SHOWN_OF_LINE).collect();
        let indent = column.saturating_sub(1 + skip);
        let carets = "^".repeat(self.width.min(MOST_SHOWN_OF_LINE - indent.min(MOST_SHOWN_OF_LINE - 1)));
        let number = line.to_string();
        let margin = " ".repeat(number.len());
        write!(f, "  {number} | {}\n  {margin} | {:indent$}{carets}", plain(&shown).trim_end(), "")
    }
}

/// Text from a file with nothing in it that could move a terminal's cursor.
fn plain(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
