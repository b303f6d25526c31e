//! What every custom law can do, whatever language it is written in.

use crate::declaration::Declaration;
use crate::input::Input;
use std::fmt;
use vocabulary::Command;

/// A law that a user wrote. It is a function of what it is told, its parameters and its memory.
///
/// `parameters`, `memory` and `shown` are as long as, and in the order of, those of the [`Declaration`], in its units.
pub trait CustomLaw: fmt::Debug + Send + Sync {
    /// What the law says of itself.
    fn declaration(&self) -> &Declaration;

    /// The memory with which a follower meets its leaders.
    ///
    /// # Errors
    /// [`Fault`] where a number is not finite; `memory` is then of no use.
    fn start(&self, input: &Input<'_>, parameters: &[f64], memory: &mut [f64]) -> Result<(), Fault>;

    /// The command of one control sample. `memory` becomes that of the next sample, and `shown` the quantities that the law
    /// offers to plots.
    ///
    /// # Errors
    /// [`Fault`] where the command or the memory is not finite, or the law broke off; `memory` is then of no use.
    fn decide(
        &self,
        input: &Input<'_>,
        parameters: &[f64],
        memory: &mut [f64],
        shown: &mut [f64],
    ) -> Result<Command, Fault>;

    /// The command of an instant of continuous time, with the time derivatives of the memory, per s. Only for laws that are
    /// [`Declaration::continuous`].
    ///
    /// # Errors
    /// As [`CustomLaw::decide`].
    fn derive(
        &self,
        input: &Input<'_>,
        parameters: &[f64],
        memory: &[f64],
        rates: &mut [f64],
    ) -> Result<Command, Fault>;
}

/// Where in the text of a law; both count from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Line.
    pub line: u32,
    /// Character within the line.
    pub column: u32,
}

impl Place {
    /// The byte of `text` that stands here; its length for a place behind its end.
    pub fn byte_in(self, text: &str) -> usize {
        // Places do not count the byte order mark.
        let mark = text.len() - text.strip_prefix('\u{feff}').unwrap_or(text).len();
        let line = self.line.saturating_sub(1) as usize;
        let start = match line {
            0 => mark,
            _ => text.match_indices('\n').nth(line - 1).map_or(text.len(), |(at, _)| at + 1),
        };
        let within = text[start..].char_indices().nth(self.column.saturating_sub(1) as usize);
        within.map_or(text.len(), |(at, _)| start + at)
    }
}

/// Why a law gave no command.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Where in its text, as far as that is known.
    pub place: Option<Place>,
    /// What happened, such as "`b0` is not a number".
    pub message: String,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            Some(place) => write!(f, "{place}: {}", self.message),
            None => f.write_str(&self.message),
        }
    }
}
