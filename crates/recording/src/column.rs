//! A column of a table.

use std::borrow::Cow;

/// Values of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum Column {
    /// Names.
    Text(Vec<String>),
    /// SI numbers.
    Number(Vec<f64>),
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Yes or no.
    Flag(Vec<bool>),
}

/// A column and its name, which ends in its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedColumn {
    /// The name.
    pub name: Cow<'static, str>,
    /// The values.
    pub column: Column,
}

impl Column {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Text(v) => v.len(),
            Self::Number(v) => v.len(),
            Self::Whole(v) => v.len(),
            Self::Flag(v) => v.len(),
        }
    }

    /// Whether it has no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A value as text.
    ///
    /// # Panics
    /// Where there is no such row.
    pub fn text(&self, row: usize) -> String {
        match self {
            Self::Text(v) => v[row].clone(),
            Self::Number(v) => v[row].to_string(),
            Self::Whole(v) => v[row].to_string(),
            Self::Flag(v) => v[row].to_string(),
        }
    }
}

impl NamedColumn {
    /// A column of this name.
    pub fn new(name: impl Into<Cow<'static, str>>, column: Column) -> Self {
        Self { name: name.into(), column }
    }
}
