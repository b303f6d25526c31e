//! A run at any time: the moments between two control samples are interpolated, and the past is remembered.

use crate::failure::Failure;
use crate::interrupt;
use recording::{Judging, Metrics, MetricsBuilder};
use rendering::Trail;
use simulation::Simulation;
use vocabulary::{Cast, Moment};

/// What nothing is judged by.
const NOTHING: Judging = Judging { settling_band: [0.0; 2], settled_after: 0.0 };

/// A simulation that is asked for growing times.
pub(crate) struct Playback {
    simulation: Simulation,
    trail: Trail,
    before: Moment,
    after: Moment,
    metrics: Option<Box<MetricsBuilder>>,
}

impl Playback {
    /// At time 0.
    pub(crate) fn new(mut simulation: Simulation) -> Self {
        let mut trail = Trail::new(simulation.cast());
        let first = simulation.next_moment().cloned().unwrap_or_default();
        trail.push(&first);
        Self { simulation, trail, before: first.clone(), after: first, metrics: None }
    }

    /// Measures what goes by, from the first moment on.
    pub(crate) fn measured(mut self, mut metrics: MetricsBuilder) -> Self {
        metrics.push(&self.after);
        self.metrics = Some(Box::new(metrics));
        self
    }

    /// What was measured so far.
    pub(crate) fn metrics(&self) -> impl FnOnce() -> Metrics + '_ {
        || {
            self.metrics
                .as_ref()
                .map_or_else(|| MetricsBuilder::new(&Cast::default(), NOTHING).finish(), |m| m.finish())
        }
    }

    /// The moment at `time` s, not before the last one asked for; the last moment of the run after its end; an
    /// earlier one where the program has been asked to stop.
    pub(crate) fn at(&mut self, time: f64) -> Moment {
        while self.after.snapshot.time < time && !interrupt::asked() {
            std::mem::swap(&mut self.before, &mut self.after);
            let Some(moment) = self.simulation.next_moment() else {
                std::mem::swap(&mut self.before, &mut self.after);
                break;
            };
            self.after.clone_from(moment);
            self.trail.push(&self.after);
            if let Some(metrics) = &mut self.metrics {
                metrics.push(&self.after);
            }
        }
        let (from, to) = (self.before.snapshot.time, self.after.snapshot.time);
        let share = if to > from { ((time - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
        Moment::between(&self.before, &self.after, share)
    }

    /// Fails where the cameras on robots could not take their pictures.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        self.simulation.fault().map_or(Ok(()), |fault| Err(Failure::Machine(fault.to_owned())))
    }

    /// What has been.
    pub(crate) fn trail(&self) -> &Trail {
        &self.trail
    }
}
