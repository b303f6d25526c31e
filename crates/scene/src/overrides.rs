//! Changes to a scene from the command line: `--set time.duration=5`.

use std::str::FromStr;

/// One change: a dotted path, and the value to put there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Override(String);

/// An override without `=`, or without a path.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is not an override: write path.to.key=value, such as time.duration=5")]
pub struct OverrideError(String);

impl FromStr for Override {
    type Err = OverrideError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.split_once('=') {
            Some((path, _)) if !path.trim().is_empty() => Ok(Self(text.to_owned())),
            _ => Err(OverrideError(text.to_owned())),
        }
    }
}

impl std::fmt::Display for Override {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}
