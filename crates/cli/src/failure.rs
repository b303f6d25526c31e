//! What can end a subcommand early, and the exit code it ends with.

use crate::print::note;
use output::Error::{Busy, Occupied};

/// Why the program does not end with 0.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The run did not show what its scene expects; already printed in the report.
    Expectation,
    /// The run came to a number that is none.
    Broken(String),
    /// The command line or the scene is wrong.
    Usage(String),
    /// The machine cannot do it: no adapter, disk full.
    Machine(String),
    /// Ctrl-C.
    Interrupted(String),
}

impl Failure {
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Expectation | Self::Broken(_) => 1,
            Self::Usage(_) => 2,
            Self::Machine(_) => 3,
            Self::Interrupted(_) => 130,
        }
    }

    /// With what is there all the same, where the machine is at fault.
    pub(crate) fn but(self, kept: &str) -> Self {
        match self {
            Self::Machine(text) => Self::Machine(format!("{text}; {kept}")),
            other => other,
        }
    }

    /// What cut the work short; nothing where it came to its end.
    pub(crate) fn text(&self) -> Option<&str> {
        match self {
            Self::Expectation => None,
            Self::Broken(text) | Self::Usage(text) | Self::Machine(text) | Self::Interrupted(text) => {
                Some(text)
            }
        }
    }

    /// What could not be written, with what helps; `by` names the option that names the place.
    fn of_output(error: &output::Error, by: &str) -> Self {
        let text = match error {
            Occupied { what: Some(_), .. } => {
                format!("{error}: choose another folder{by}, or give --force to replace it")
            }
            Occupied { what: None, .. } => format!("{error}: choose another folder{by}"),
            Busy(_) => format!("{error}: wait for it, or choose another place{by}"),
            _ => error.to_string(),
        };
        if error.is_usage() { Self::Usage(text) } else { Self::Machine(text) }
    }

    /// One message on standard error.
    pub(crate) fn tell(&self) {
        if let Some(text) = self.text() {
            let kind = if matches!(self, Self::Interrupted(_)) { "interrupted" } else { "error" };
            note(&format!("{kind}: {text}"));
        }
    }
}

impl From<footage::Error> for Failure {
    fn from(error: footage::Error) -> Self {
        match error {
            footage::Error::Broken(text) => Self::Broken(text),
            footage::Error::Usage(text) => Self::Usage(text),
            footage::Error::Machine(text) => Self::Machine(text),
            // A film is named by one option of one subcommand, by another of another.
            footage::Error::Output { error, kept: None } => Self::of_output(&error, ""),
            footage::Error::Output { error, kept: Some(kept) } => Self::of_output(&error, "").but(&kept),
            footage::Error::Interrupted(text) => Self::Interrupted(text),
        }
    }
}

impl From<studies::Error> for Failure {
    fn from(error: studies::Error) -> Self {
        match error {
            studies::Error::Output(error) => error.into(),
            studies::Error::Recording(error) => error.into(),
            other => footage::Error::from(other).into(),
        }
    }
}

impl From<sweeps::Error> for Failure {
    fn from(error: sweeps::Error) -> Self {
        match error {
            sweeps::Error::Output(error) => error.into(),
            sweeps::Error::Recording(error) => error.into(),
            other => Self::Usage(other.to_string()),
        }
    }
}

impl From<rendering::Error> for Failure {
    fn from(error: rendering::Error) -> Self {
        footage::Error::from(error).into()
    }
}

impl From<film::Error> for Failure {
    fn from(error: film::Error) -> Self {
        footage::Error::from(error).into()
    }
}

impl From<recording::Error> for Failure {
    fn from(error: recording::Error) -> Self {
        match error {
            recording::Error::Output(error) => error.into(),
            other => footage::Error::from(other).into(),
        }
    }
}

impl From<output::Error> for Failure {
    fn from(error: output::Error) -> Self {
        Self::of_output(&error, " with --out")
    }
}
