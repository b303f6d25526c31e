//! How well a follower saw its leader over a run.

use crate::statistics::RootMeanSquare;
use serde::Serialize;
use vocabulary::{EdgeState, MeasurementRecord, Outcome, Relative, TrackingState, wrap};

/// Measurements of one follower over a run.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct MeasurementMetrics {
    /// Measurements that reached the follower, and those that were lost on the way.
    pub taken: u64,
    /// Measurements that corrected the estimate.
    pub used: u64,
    /// Measurements too far from the prediction to be believed.
    pub rejected: u64,
    /// Measurements that two poses explained alike.
    pub ambiguous: u64,
    /// Measurements in which the leader was not recognised.
    pub missed: u64,
    /// Measurements that never arrived.
    pub dropped: u64,
    /// Share of the measurements that arrived in which the leader was recognised; 0 where none arrived.
    pub in_view: f64,
    /// Root mean square error of the measurements used, [m, rad, rad]: distance, bearing, view angle.
    /// `None` where none was used.
    pub rms_error: Option<[f64; 3]>,
    /// Root mean square error of what the law was told, [m, rad, rad], while the leader was not lost; `None` where it
    /// was never told.
    pub rms_estimate_error: Option<[f64; 3]>,
    /// Longest time without a measurement that corrected the estimate, s.
    pub longest_gap: f64,
    /// Time for which the leader was lost, s.
    pub lost: f64,
}

/// Running sums of [`MeasurementMetrics`].
#[derive(Debug, Clone, Default)]
pub(crate) struct MeasurementSums {
    metrics: MeasurementMetrics,
    used: RootMeanSquare<3>,
    estimates: RootMeanSquare<3>,
}

impl MeasurementSums {
    pub(crate) fn add(&mut self, frame: &MeasurementRecord) {
        let m = &mut self.metrics;
        m.taken += 1;
        match frame.outcome {
            Outcome::Used => {
                m.used += 1;
                self.used.add(difference(&frame.measurement.relative, &frame.truth));
            }
            Outcome::Rejected => m.rejected += 1,
            Outcome::Ambiguous => m.ambiguous += 1,
            Outcome::Missed => m.missed += 1,
            Outcome::Dropped => m.dropped += 1,
        }
    }

    /// Takes in what a follower knows at a sample, `step` s after the one before.
    pub(crate) fn know(&mut self, edge: &EdgeState, step: f64) {
        self.metrics.longest_gap = self.metrics.longest_gap.max(edge.age);
        match edge.sight {
            TrackingState::Truth | TrackingState::Waiting => {}
            TrackingState::Lost => self.metrics.lost += step,
            TrackingState::Tracking | TrackingState::Coasting => {
                self.estimates.add(difference(&edge.seen, &edge.relative));
            }
        }
    }

    /// The metrics so far; `None` for a follower that does not measure.
    pub(crate) fn finish(&self) -> Option<MeasurementMetrics> {
        let m = &self.metrics;
        let arrived = m.taken - m.dropped;
        (m.taken > 0).then(|| MeasurementMetrics {
            in_view: (arrived - m.missed) as f64 / arrived.max(1) as f64,
            rms_error: self.used.root(),
            rms_estimate_error: self.estimates.root(),
            ..m.clone()
        })
    }
}

/// `seen` minus `truth`: distance in m, bearing and view angle in rad, wrapped.
pub fn difference(seen: &Relative, truth: &Relative) -> [f64; 3] {
    [
        seen.distance - truth.distance,
        wrap(seen.bearing - truth.bearing),
        wrap(seen.view_angle - truth.view_angle),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::Measurement;

    #[test]
    fn measurements_are_counted_by_what_came_of_them() {
        let mut sums = MeasurementSums::default();
        assert_eq!(sums.finish(), None);
        let outcomes = [Outcome::Used, Outcome::Used, Outcome::Rejected, Outcome::Missed, Outcome::Dropped];
        for (k, outcome) in (0..).zip(outcomes) {
            let relative = Relative { distance: 2.0 + 0.1 * f64::from(k), ..Relative::default() };
            let truth = Relative { distance: 2.0, ..Relative::default() };
            let measurement = Measurement { relative, ..Measurement::default() };
            sums.add(&MeasurementRecord { outcome, measurement, truth, ..MeasurementRecord::default() });
        }
        sums.know(&EdgeState { sight: TrackingState::Lost, age: 0.7, ..EdgeState::default() }, 0.01);
        let metrics = sums.finish().expect("it measured");
        assert_eq!((metrics.taken, metrics.used, metrics.dropped), (5, 2, 1));
        assert!((metrics.in_view - 0.75).abs() < 1e-12);
        let rms = metrics.rms_error.expect("some were used")[0];
        assert!((rms - (0.01_f64 / 2.0).sqrt()).abs() < 1e-12);
        assert_eq!(metrics.rms_estimate_error, None);
        assert_eq!((metrics.longest_gap, metrics.lost), (0.7, 0.01));
    }
}
