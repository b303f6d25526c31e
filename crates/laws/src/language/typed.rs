//! Values as the checker knows them: where they are, and their units.

use super::assembler::Operand;
use crate::unit::Unit;

/// A number: where it is, and its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Measured {
    pub(super) operand: Operand,
    pub(super) unit: Unit,
    /// A 0 without a unit, which fits any.
    pub(super) is_bare_zero: bool,
}

impl Measured {
    pub(super) fn new(operand: Operand, unit: Unit) -> Self {
        Self { operand, unit, is_bare_zero: false }
    }

    /// The unit that both have; none where they differ.
    pub(super) fn common(self, other: Self) -> Option<Unit> {
        match (self.is_bare_zero, other.is_bare_zero) {
            (true, _) => Some(other.unit),
            (_, true) => Some(self.unit),
            // Of an angle and a number, the angle says more.
            _ => {
                (self.unit == other.unit).then_some(if self.unit.is_angle() { self.unit } else { other.unit })
            }
        }
    }

    /// Whether it may stand where a unit is asked for.
    pub(super) fn fits(self, unit: Unit) -> bool {
        self.is_bare_zero || self.unit == unit
    }
}

/// A value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Typed {
    /// Comes of a mistake that was reported.
    Unknown,
    Number(Measured),
    Vector([Measured; 2]),
    /// A condition: 1 where it is true, else 0.
    Truth(Operand),
}

impl Typed {
    /// Its operands.
    pub(super) fn operands(&self) -> impl Iterator<Item = Operand> {
        let operands = match self {
            Self::Unknown => [None, None],
            Self::Number(number) => [Some(number.operand), None],
            Self::Vector([x, y]) => [Some(x.operand), Some(y.operand)],
            Self::Truth(operand) => [Some(*operand), None],
        };
        operands.into_iter().flatten()
    }

    /// The same value with other operands.
    pub(super) fn with(self, mut operand: impl FnMut(Operand) -> Operand) -> Self {
        match self {
            Self::Unknown => Self::Unknown,
            Self::Number(number) => Self::Number(Measured { operand: operand(number.operand), ..number }),
            Self::Vector(both) => {
                Self::Vector(both.map(|number| Measured { operand: operand(number.operand), ..number }))
            }
            Self::Truth(truth) => Self::Truth(operand(truth)),
        }
    }

    /// What it is, for messages: "is in m/s", "is an angle (rad)".
    pub(super) fn described(&self) -> String {
        match self {
            Self::Unknown => "is unknown".to_owned(),
            Self::Number(number) => described(number.unit),
            Self::Vector([x, y]) => {
                let [x, y] = [x, y].map(|number| match number.unit.to_string() {
                    unit if unit.is_empty() => "-".to_owned(),
                    unit => unit,
                });
                format!("is a vector in ({x}, {y})")
            }
            Self::Truth(_) => "is a condition".to_owned(),
        }
    }
}

/// What something in this unit is: "is in m/s", "is a number".
pub(super) fn described(unit: Unit) -> String {
    if unit.is_angle() {
        "is an angle (rad)".to_owned()
    } else if unit == Unit::NUMBER && unit.to_string().is_empty() {
        "is a number".to_owned()
    } else {
        format!("is in {unit}")
    }
}
