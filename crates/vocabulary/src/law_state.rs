//! What a custom law carries and shows at an instant.

use std::sync::Arc;

/// Memory and shown quantities of a follower's custom law.
#[derive(Debug, Clone, Default)]
pub struct LawState {
    /// Index of the follower.
    pub robot: usize,
    /// What the numbers are: memory first, then what the law shows.
    pub quantities: Arc<[LawQuantity]>,
    /// Their values, in the units of [`LawQuantity::unit`]. Those that are only shown may be no finite numbers.
    pub values: Vec<f64>,
    /// Where in its text and why the law broke off, at the sample at which it did; else empty.
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

/// Two are the same bit for bit: what is no number equals itself.
impl PartialEq for LawState {
    fn eq(&self, other: &Self) -> bool {
        let bits = |state: &Self| state.values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        (self.robot, &self.quantities, &self.fault) == (other.robot, &other.quantities, &other.fault)
            && bits(self) == bits(other)
    }
}

impl LawState {
    /// The value of the quantity called `name`.
    pub fn value(&self, name: &str) -> Option<f64> {
        let index = self.quantities.iter().position(|quantity| quantity.name == name)?;
        self.values.get(index).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_equals_itself() {
        let state = |value| LawState { values: vec![1.0, value], ..LawState::default() };
        assert_eq!(state(f64::NAN), state(f64::NAN));
        assert_ne!(state(f64::NAN), state(1.0));
        assert_ne!(state(0.0), state(-0.0));
    }
}
