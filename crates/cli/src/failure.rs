//! What can end a subcommand early, and the exit code it ends with.

use crate::print::note;
use vocabulary::counted;

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

    /// One message on standard error.
    pub(crate) fn tell(&self) {
        if let Some(text) = self.text() {
            let kind = if matches!(self, Self::Interrupted(_)) { "interrupted" } else { "error" };
            note(&format!("{kind}: {text}"));
        }
    }
}

impl From<studies::Error> for Failure {
    fn from(error: studies::Error) -> Self {
        match error {
            studies::Error::Usage(text) => Self::Usage(text),
            studies::Error::Build(error) => Self::Usage(error.to_string()),
            studies::Error::NotFinite(what) => Self::Broken(what.to_string()),
            studies::Error::Camera(text) => Self::Machine(text),
            studies::Error::Interrupted { samples } => {
                Self::Interrupted(format!("after {}", counted(samples, "sample")))
            }
            studies::Error::Output(error) => error.into(),
            studies::Error::Recording(error) => error.into(),
        }
    }
}

impl From<rendering::Error> for Failure {
    fn from(error: rendering::Error) -> Self {
        let text = error.to_string();
        if error.is_usage() { Self::Usage(text) } else { Self::Machine(text) }
    }
}

impl From<film::Error> for Failure {
    fn from(error: film::Error) -> Self {
        let text = error.to_string();
        if error.is_usage() { Self::Usage(text) } else { Self::Machine(text) }
    }
}

impl From<recording::Error> for Failure {
    fn from(error: recording::Error) -> Self {
        let text = error.to_string();
        let usage = match &error {
            recording::Error::Output(error) => error.is_usage(),
            recording::Error::Log { .. } => true,
            recording::Error::Table { .. } => false,
        };
        if usage { Self::Usage(text) } else { Self::Machine(text) }
    }
}

impl From<output::Error> for Failure {
    fn from(error: output::Error) -> Self {
        let text = error.to_string();
        if error.is_usage() { Self::Usage(text) } else { Self::Machine(text) }
    }
}
