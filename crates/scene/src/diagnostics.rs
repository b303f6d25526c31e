//! What is wrong with a scene, and where.

use std::{fmt, path::PathBuf};

/// One thing that is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
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

/// Everything that is wrong, in the order of the text; never empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostics(pub(crate) Vec<Diagnostic>);

impl Diagnostics {
    /// All of them.
    pub fn all(&self) -> &[Diagnostic] {
        &self.0
    }

    pub(crate) fn whole_file(path: &std::path::Path, message: String) -> Self {
        let origin = PathBuf::from(path).display().to_string();
        Self(vec![Diagnostic { origin, line: 0, column: 0, excerpt: String::new(), width: 1, message }])
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for diagnostic in &self.0 {
            writeln!(f, "{}: {}", diagnostic.origin, diagnostic.message)?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}
