//! A law for many followers in a run: whose commands it decides, and who cannot have it.

use formation::EdgeLaw;
use laws::BatchLaw;
use thiserror::Error;
use vocabulary::Edge;

/// A law for many followers, and whose commands it decides.
#[derive(Debug, Clone)]
pub(crate) struct BatchPipeline {
    pub(crate) law: Box<dyn BatchLaw>,
    /// Per robot.
    pub(crate) decides_for: Vec<bool>,
}

impl BatchPipeline {
    /// Puts the law in the place of those of its followers.
    pub(crate) fn mark(&self, edges: &[Edge], laws: &mut [EdgeLaw]) {
        for (edge, law) in edges.iter().zip(laws) {
            law.batch = self.decides_for[edge.follower].then(|| self.law.knows());
        }
    }
}

/// Why a run cannot have a law for many followers.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum BatchError {
    /// In continuous time.
    #[error(
        "a law for many followers acts at samples: mode \"continuous\" has none; use time.mode \"sampled\""
    )]
    Continuous,
    /// The run has begun.
    #[error("the run has begun at sample {0}: a law for many followers is attached before the first")]
    Begun(u64),
    /// A robot that never follows.
    #[error("`{0}` follows nobody: a law decides for followers")]
    Leads(String),
    /// A robot with more leaders than one.
    #[error("`{0}` has several leaders: a law for many followers looks at one leader of each")]
    SeveralLeaders(String),
}
