//! From when on, and within which band, the errors of a run are judged.

/// What a run is judged by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judging {
    /// |error| under which an edge counts as settled, [m, rad].
    pub settling_band: [f64; 2],
    /// Time from which late errors count, s.
    pub settled_after: f64,
}

impl Judging {
    /// For figures that are not judged: nothing is settled, and all errors are late ones.
    pub const NONE: Self = Self { settling_band: [0.0; 2], settled_after: 0.0 };
}
