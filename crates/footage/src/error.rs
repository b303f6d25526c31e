//! Why there are no pictures.

use vocabulary::counted;

/// Why there are no pictures, or not all. The text is for people.
#[derive(Debug)]
pub enum Error {
    /// The run came to a number that is none.
    Broken(String),
    /// What was asked for, or the scene, is wrong.
    Usage(String),
    /// The machine cannot do it: there is no adapter, or it failed.
    Machine(String),
    /// A file or folder could not be written.
    Output {
        /// Why.
        error: output::Error,
        /// What is there all the same.
        kept: Option<String>,
    },
    /// It was stopped.
    Interrupted(String),
}

impl Error {
    /// With what is there all the same, where the machine is at fault.
    #[must_use]
    pub fn but(self, kept: &str) -> Self {
        match self {
            Self::Machine(text) => Self::Machine(format!("{text}; {kept}")),
            Self::Output { error, .. } if !error.is_usage() => {
                Self::Output { error, kept: Some(kept.to_owned()) }
            }
            other => other,
        }
    }

    fn of(error: &impl std::error::Error, usage: bool) -> Self {
        let text = error.to_string();
        if usage { Self::Usage(text) } else { Self::Machine(text) }
    }
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Broken(text) | Self::Usage(text) | Self::Machine(text) | Self::Interrupted(text) => {
                f.write_str(text)
            }
            Self::Output { error, kept: None } => error.fmt(f),
            Self::Output { error, kept: Some(kept) } => write!(f, "{error}; {kept}"),
        }
    }
}

impl std::error::Error for Error {}

impl From<studies::Error> for Error {
    fn from(error: studies::Error) -> Self {
        match error {
            studies::Error::Usage(text) => Self::Usage(text),
            studies::Error::Build(error) => Self::Usage(error.to_string()),
            studies::Error::NotFinite(what) => Self::Broken(what.to_string()),
            studies::Error::Camera(text) | studies::Error::Law(text) => Self::Machine(text),
            studies::Error::Interrupted { samples } => {
                Self::Interrupted(format!("after {}", counted(samples, "sample")))
            }
            studies::Error::Output(error) => error.into(),
            studies::Error::Recording(error) => error.into(),
        }
    }
}

impl From<rendering::Error> for Error {
    fn from(error: rendering::Error) -> Self {
        Self::of(&error, error.is_usage())
    }
}

impl From<film::Error> for Error {
    fn from(error: film::Error) -> Self {
        match error {
            film::Error::Output(error) => error.into(),
            other => Self::of(&other, other.is_usage()),
        }
    }
}

impl From<output::Error> for Error {
    fn from(error: output::Error) -> Self {
        Self::Output { error, kept: None }
    }
}

impl From<recording::Error> for Error {
    fn from(error: recording::Error) -> Self {
        match error {
            recording::Error::Output(error) => error.into(),
            recording::Error::Log { .. } => Self::Usage(error.to_string()),
            recording::Error::Table { .. } => Self::Machine(error.to_string()),
        }
    }
}
