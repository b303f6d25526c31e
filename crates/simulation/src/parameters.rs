//! The parameters that may change during a run: laws, set points, limits. All others are fixed.

use crate::goals::GoalWish;
use crate::setup::Setup;
use formation::EdgeLaw;
use std::collections::VecDeque;
use std::sync::Arc;
use world::Handling;

/// What holds from one control sample on, until something else does.
#[derive(Debug, Clone)]
pub struct ParameterSet {
    /// Laws, observers and set points, per edge.
    pub laws: Vec<EdgeLaw>,
    /// Limits and drivers, per robot.
    pub handling: Vec<Handling>,
    /// Barriers, per robot; `None` where its filter is off.
    pub filters: Vec<Option<safety::Parameters>>,
    /// What lead robots with goals want, by their numbers.
    pub wishes: Vec<(usize, Arc<GoalWish>)>,
}

/// A set of parameters, and from when on it holds.
#[derive(Debug, Clone)]
pub struct ScheduledChange {
    /// From the first control sample at or after this, s.
    pub at: f64,
    /// What holds from then on.
    pub parameters: ParameterSet,
}

impl ParameterSet {
    /// What a run begins with.
    pub fn of(setup: &Setup) -> Self {
        let actors = setup.stage.actors.iter();
        Self {
            laws: setup.formation.laws().to_vec(),
            handling: actors
                .map(|actor| Handling { limits: actor.robot.limits, wheels: actor.wheels.clone() })
                .collect(),
            filters: setup.filters.clone(),
            wishes: setup.goals.wishes(),
        }
    }
}

/// Whether an observer begins to run that was not needed before, or begins anew on another output.
pub(crate) fn wakes(before: &EdgeLaw, after: &EdgeLaw) -> bool {
    let output = |law: &EdgeLaw| law.law.heading.reference();
    after.observes() && (!before.observes() || output(before) != output(after)) && after.tracker.is_none()
}

/// The first control sample at or after `at` s; one that is missed by rounding only counts.
pub(crate) fn sample_at(at: f64, period: f64) -> u64 {
    (at / period * (1.0 - 1e-12) - 1e-9).ceil().max(0.0) as u64
}

/// Changes by the samples at which they take hold.
pub(crate) fn pending(changes: &[ScheduledChange], period: f64) -> VecDeque<(u64, Arc<ParameterSet>)> {
    let turn = |turn: &ScheduledChange| (sample_at(turn.at, period), Arc::new(turn.parameters.clone()));
    changes.iter().map(turn).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_that_is_a_sample_but_for_rounding_is_that_sample() {
        for (at, period, sample) in
            [(0.0, 0.01, 0), (0.29, 0.01, 29), (6.0, 0.01, 600), (0.1 + 0.2, 0.1, 3), (6.001, 0.01, 601)]
        {
            assert_eq!(sample_at(at, period), sample, "{at} s by {period} s");
        }
        assert!((0..100_000).all(|k| sample_at(k as f64 * 0.01, 0.01) == k));
    }
}
