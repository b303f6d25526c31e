//! One run, and what it showed about every edge once it had settled.

use crate::{Error, SceneRun};
use metrics::{RootMeanSquare, difference};
use serde::Serialize;
use vocabulary::{EdgeState, MeasurementRecord, Outcome, StepRecord, TrackingState};

/// One edge of one run, from the time after which it counts as settled. Triples are distance, bearing, view angle in m
/// and rad, pairs distance and bearing.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct EdgeErrors {
    /// Root mean square error of the measurements used; `None` where there were none.
    pub measurements: Option<[f64; 3]>,
    /// The same of the distance as a share of the distance.
    pub measurements_relative: Option<f64>,
    /// Root mean square error of what the law was told, while the leader was not lost; `None` where it always was.
    pub told: Option<[f64; 3]>,
    /// Root mean square tracking error.
    pub tracking: [f64; 2],
    /// Root mean square of the estimated rates minus the true ones, m/s and rad/s.
    pub rate_error: [f64; 2],
    /// Share of the samples at which a limit cut the command.
    pub limited: f64,
    /// Share of the measurements that arrived in which the leader was recognised; `None` where there were none.
    pub in_view: Option<f64>,
    /// Measurements that reached the follower, or were lost on the way.
    pub taken: u64,
    /// Measurements that were not believed, or that two poses explained alike.
    pub refused: u64,
    /// Share of the samples at which the leader was lost, or had never been seen.
    pub lost: f64,
}

/// [`EdgeErrors`] under way.
#[derive(Debug, Clone, Default)]
struct EdgeErrorSums {
    measurements: RootMeanSquare<3>,
    relative: RootMeanSquare<1>,
    told: RootMeanSquare<3>,
    tracking: RootMeanSquare<2>,
    rates: RootMeanSquare<2>,
    /// The two samples before, for the true rate in the middle.
    before: [Option<EdgeState>; 2],
    samples: u64,
    limited: u64,
    lost: u64,
    taken: u64,
    arrived: u64,
    seen: u64,
    refused: u64,
}

impl EdgeErrorSums {
    fn know(&mut self, edge: &EdgeState, period: f64) {
        self.samples += 1;
        self.limited += u64::from(edge.limited);
        self.tracking.add(edge.error);
        match edge.sight {
            TrackingState::Waiting | TrackingState::Lost => self.lost += 1,
            TrackingState::Truth | TrackingState::Tracking | TrackingState::Coasting => {
                self.told.add(difference(&edge.seen, &edge.relative));
            }
        }
        if let [Some(first), Some(middle)] = self.before {
            let [distance, bearing, _] = difference(&edge.relative, &first.relative);
            let rates = [distance, bearing].map(|d| d / (2.0 * period));
            self.rates.add([middle.rates[0] - rates[0], middle.rates[1] - rates[1]]);
        }
        self.before = [self.before[1], Some(*edge)];
    }

    fn add(&mut self, frame: &MeasurementRecord) {
        self.taken += 1;
        self.arrived += u64::from(frame.outcome != Outcome::Dropped);
        self.seen += u64::from(frame.outcome.seen());
        self.refused += u64::from(matches!(frame.outcome, Outcome::Rejected | Outcome::Ambiguous));
        if frame.outcome == Outcome::Used {
            let off = difference(&frame.measurement.relative, &frame.truth);
            self.measurements.add(off);
            self.relative.add([off[0] / frame.truth.distance.max(1e-9)]);
        }
    }

    fn finish(&self) -> EdgeErrors {
        let share = |part: u64, whole: u64| part as f64 / whole.max(1) as f64;
        EdgeErrors {
            measurements: self.measurements.root(),
            measurements_relative: self.relative.root().map(|[r]| r),
            told: self.told.root(),
            tracking: self.tracking.root().unwrap_or_default(),
            rate_error: self.rates.root().unwrap_or_default(),
            limited: share(self.limited, self.samples),
            in_view: (self.arrived > 0).then(|| share(self.seen, self.arrived)),
            taken: self.taken,
            refused: self.refused,
            lost: share(self.lost, self.samples),
        }
    }
}

/// A run that has been measured.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct MeasuredRun {
    /// In the order of the edges.
    pub edges: Vec<EdgeErrors>,
    /// Contacts that began.
    pub contacts: usize,
    /// Time of the last sample, s.
    pub duration: f64,
}

/// Steps between two reports of how far a run is.
const STRIDE: u64 = 64;

/// Runs a scene to its end; `None` where `go_on`, told the number of steps done, says no.
///
/// # Errors
/// [`Error`] where the run breaks off with a fault.
pub fn measure(
    run: &mut SceneRun,
    settled_after: f64,
    mut go_on: impl FnMut(u64) -> bool,
) -> Result<Option<MeasuredRun>, Error> {
    let period = run.simulation.period();
    let mut edges = vec![EdgeErrorSums::default(); run.simulation.fleet().edges.len()];
    let (mut measured, mut on, mut before) = (MeasuredRun::default(), true, f64::NEG_INFINITY);
    run.step_through(|simulation, step| {
        let record = simulation.record();
        take_in(&mut edges, record, settled_after, period);
        let time = record.snapshot.time;
        measured.contacts += record.contacts.iter().filter(|c| c.begin > before && c.begin <= time).count();
        (measured.duration, before) = (time, time);
        on = step % STRIDE != 0 || go_on(step);
        on
    })?;
    measured.edges = edges.iter().map(EdgeErrorSums::finish).collect();
    Ok(on.then_some(measured))
}

fn take_in(edges: &mut [EdgeErrorSums], record: &StepRecord, settled_after: f64, period: f64) {
    for frame in record.frames.iter().filter(|f| f.measurement.stamp >= settled_after) {
        if let Some(edge) = edges.get_mut(frame.edge) {
            edge.add(frame);
        }
    }
    if record.snapshot.time >= settled_after {
        for (gathering, edge) in edges.iter_mut().zip(&record.edges) {
            gathering.know(edge, period);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::Relative;

    #[test]
    fn a_rate_is_held_against_the_motion_around_it() {
        let mut gathering = EdgeErrorSums::default();
        for k in 0..5 {
            let relative = Relative { distance: 2.0 + 0.03 * f64::from(k), ..Relative::default() };
            let rates = [3.5, 0.0];
            gathering.know(&EdgeState { relative, seen: relative, rates, ..EdgeState::default() }, 0.01);
        }
        let measured = gathering.finish();
        assert!((measured.rate_error[0] - 0.5).abs() < 1e-9, "{measured:?}");
        assert_eq!((measured.measurements, measured.in_view, measured.told), (None, None, Some([0.0; 3])));
    }

    #[test]
    fn only_measurements_that_were_used_count_as_errors() {
        let mut gathering = EdgeErrorSums::default();
        for (outcome, distance) in [(Outcome::Used, 2.2), (Outcome::Rejected, 9.0), (Outcome::Missed, 0.0)] {
            let mut frame = MeasurementRecord { outcome, ..MeasurementRecord::default() };
            frame.truth.distance = 2.0;
            frame.measurement.relative.distance = distance;
            gathering.add(&frame);
        }
        let measured = gathering.finish();
        assert!((measured.measurements.expect("one")[0] - 0.2).abs() < 1e-12);
        assert!((measured.measurements_relative.expect("one") - 0.1).abs() < 1e-12);
        assert_eq!((measured.taken, measured.refused), (3, 1));
        assert!((measured.in_view.expect("some") - 2.0 / 3.0).abs() < 1e-12);
    }
}
