//! What the theorems say of a run's edges, as `metrics.json` holds it.

use serde::Serialize;

/// What the theorems say of one edge over a stretch of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CertificateMetrics {
    /// Who is followed.
    pub leader: String,
    /// Who follows.
    pub follower: String,
    /// First and last sample of the stretch, s.
    pub span: [f64; 2],
    /// Statement by statement.
    pub statements: Vec<StatementMetrics>,
    /// The bound on ‖e‖ that the proof promises in the end, m and rad together; `None` without an observer.
    pub ultimate_error: Option<f64>,
    /// The largest ε for which it finds an invariant set, s; `None` without an observer.
    pub epsilon_1: Option<f64>,
}

/// One statement of the theorems.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StatementMetrics {
    /// Which one.
    pub statement: String,
    /// Where the paper states it.
    pub source: String,
    /// `holds`, `violated` or `premise-not-met`.
    pub outcome: String,
    /// First sample at which the numbers are against it, premises met or not, s.
    pub against_from: Option<f64>,
    /// Last such sample, s.
    pub against_to: Option<f64>,
    /// Least room to the other side.
    pub margin: Option<f64>,
    /// Premises that are not met, in words.
    pub unmet: Vec<String>,
}
