//! Units of the numbers of a law: powers of the metre and the second. A radian is a number, as in SI.

/// Powers of metre and second, in twelfths, so that roots and thirds of powers are exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Unit {
    /// Power of the metre, in twelfths.
    pub metre: i16,
    /// Power of the second, in twelfths.
    pub second: i16,
}

impl Unit {
    /// A number without a unit, and an angle in rad.
    pub const NUMBER: Self = Self::new(0, 0);

    /// The unit with whole powers of metre and second.
    pub const fn new(metre: i16, second: i16) -> Self {
        Self { metre: 12 * metre, second: 12 * second }
    }
}
