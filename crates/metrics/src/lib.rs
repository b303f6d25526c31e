//! What a run was like, as numbers that are taken from its moments one after the other, in memory that does not grow.

mod certificates;
pub mod clearance;
mod contacts;
mod digest;
mod expectations;
mod measurements;
mod metrics;
mod plan_tracking;
mod safety;
mod statistics;
mod status;

pub use certificates::{CertificateMetrics, StatementMetrics};
pub use contacts::ContactMetrics;
pub use digest::{Digest, NumberOwner, numbers};
pub use expectations::JudgedExpectation;
pub use measurements::{MeasurementMetrics, difference};
pub use metrics::{
    EdgeMetrics, EventSummary, LawFaultMetrics, Metrics, MetricsBuilder, NarrowingMetrics, RobotMetrics,
    STANDING_AFTER, StandingMetrics,
};
pub use plan_tracking::PlanTrackingMetrics;
pub use safety::SafetyMetrics;
pub use statistics::{RootMeanSquare, median};
pub use status::Status;
