//! What can end a subcommand early, and the exit code it ends with.

use crate::print::note;
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

impl From<footage::Error> for Failure {
    fn from(error: footage::Error) -> Self {
        match error {
            footage::Error::Broken(text) => Self::Broken(text),
            footage::Error::Usage(text) => Self::Usage(text),
            footage::Error::Machine(text) => Self::Machine(text),
            footage::Error::Interrupted(text) => Self::Interrupted(text),
        }
    }
}

impl From<studies::Error> for Failure {
    fn from(error: studies::Error) -> Self {
        footage::Error::from(error).into()
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
        footage::Error::from(error).into()
    }
}

impl From<output::Error> for Failure {
    fn from(error: output::Error) -> Self {
        footage::Error::from(error).into()
    }
}
