//! Parameters of the law and of the observer of one edge.

use serde::Serialize;

/// Parameters of a control law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Law {
    /// Which law.
    pub kind: LawKind,
    /// Gains of [distance, bearing] (K = diag(k1, k2)), 1/s, above 0.
    pub k: [f64; 2],
    /// Gains of the switching term for [distance, bearing] (β), [m/s², rad/s²], not below 0.
    pub beta: [f64; 2],
    /// Form of the switching term.
    pub switching: Switching,
    /// Slope of tanh for [distance, bearing], [1/m, 1/rad], above 0.
    pub slope: [f64; 2],
    /// Least distance used in divisions (ℓ_min), m, above 0.
    pub distance_min: f64,
}

/// Which law a follower uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LawKind {
    /// Knows its leader's motion (eq 20).
    FullState,
    /// Knows the rates of distance and bearing, not its leader's motion (eq 22).
    RobustState,
    /// Knows distance and bearing only (eq 42).
    #[default]
    OutputFeedback,
}

/// Form of the switching term.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Switching {
    /// β tanh(slope · e), as in the paper's simulations.
    #[default]
    Tanh,
    /// β sign(e), as in the paper's theorems.
    Sign,
}

/// Parameters of the high-gain observer (eqs 31-32).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Observer {
    /// Time constant for [distance, bearing] (ε), s, above 0.
    pub epsilon: [f64; 2],
    /// α1 of s² + α1 s + α2 for [distance, bearing], above 0.
    pub alpha1: [f64; 2],
    /// α2 of s² + α1 s + α2 for [distance, bearing], above 0.
    pub alpha2: [f64; 2],
    /// Where the estimate of [distance, bearing] starts; that of their rates starts at 0.
    pub start: ObserverStart,
}

/// Where the estimate of [distance in m, bearing in rad] starts.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ObserverStart {
    /// At the first measurement, s(0).
    #[default]
    Measured,
    /// At these values.
    At([f64; 2]),
    /// At the first measurement plus these.
    Offset([f64; 2]),
}
