//! What a custom law carries and shows at an instant.

use std::sync::Arc;

/// Memory and shown quantities of a follower's custom law.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LawState {
    /// Index of the follower.
    pub robot: usize,
    /// What the numbers are: memory first, then what the law shows.
    pub quantities: Arc<[LawQuantity]>,
    /// Their values, in the units of [`LawQuantity::unit`]. Those that are only shown may be no finite numbers.
    pub values: Vec<f64>,
    /// Why the law broke off, at the sample at which it did; else empty.
    pub fault: String,
}

/// A named number of a law.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LawQuantity {
    /// Its name in the text of the law.
    pub name: String,
    /// Its unit, such as "m/s"; empty for a number without one.
    pub unit: String,
}

impl LawState {
    /// The value of the quantity called `name`.
    pub fn value(&self, name: &str) -> Option<f64> {
        let index = self.quantities.iter().position(|quantity| quantity.name == name)?;
        self.values.get(index).copied()
    }
}
