//! Why a valid scene cannot run.

use crate::drivable::Undrivable;
use formation::GraphError;
use formation::lead::SplinePathError;
use thiserror::Error;

/// Why a valid scene cannot run.
#[derive(Debug, Error)]
pub enum BuildError {
    /// Robots and edges make no formation.
    #[error(transparent)]
    Graph(#[from] GraphError),
    /// The way-points of a lead robot or of a guided prop make no curve.
    #[error("the path of `{robot}`: {source}")]
    SplinePath {
        /// The lead robot or prop.
        robot: String,
        /// What is wrong with its points.
        source: SplinePathError,
    },
    /// A path of a lead robot or a guided prop asks for what it cannot do.
    #[error("the path of `{robot}` cannot be driven: {found}")]
    Undrivable {
        /// The lead robot or prop.
        robot: String,
        /// What is asked for, and where.
        found: Box<Undrivable>,
    },
    /// There is no way to a goal.
    #[error("the path of `{robot}`: {why}")]
    Plan {
        /// The lead robot.
        robot: String,
        /// Why.
        why: String,
    },
    /// A path's heading in continuous time.
    #[error(
        "the law of `{robot}` holds its bearing against the heading of a path, which is filtered from sample to sample: \
         mode \"continuous\" has no samples; use mode \"sampled\", or `heading = \"leader\"`"
    )]
    PathHeading {
        /// The follower.
        robot: String,
    },
    /// A custom law that acts at samples, in continuous time.
    #[error(
        "{law}, the law of `{robot}`, acts at samples only: a memory is assigned in it, or it uses `noise`; give its memories \
         derivatives, as in `sum' = e`, or use mode \"sampled\""
    )]
    SampledLaw {
        /// The follower.
        robot: String,
        /// Its law.
        law: String,
    },
    /// An observer too fast for continuous time.
    #[error(
        "the observer of `{robot}` has ε = {epsilon} s: mode \"continuous\" takes steps of an eighth of it and would \
         not come to an end; use ε of at least {EPSILON_MIN} s, or mode \"sampled\", which is exact at any ε"
    )]
    Stiff {
        /// The follower.
        robot: String,
        /// Its smallest ε, s.
        epsilon: f64,
    },
}

/// Smallest ε that continuous time takes, s: three robots then run at about a third of real time.
pub(crate) const EPSILON_MIN: f64 = 1e-5;
