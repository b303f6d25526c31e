//! A run at any time: the moments between two control samples are interpolated, and the past is remembered.

use crate::error::Error;
use metrics::{Metrics, MetricsBuilder};
use rendering::Trail;
use studies::RecordSource;
use vocabulary::{FleetInfo, Judging, StepRecord};

/// A source that is asked for growing times.
pub struct Playback<'a> {
    source: RecordSource,
    /// Whether the work is to stop.
    stops: &'a dyn Fn() -> bool,
    fault: Option<Error>,
    trail: Trail,
    before: StepRecord,
    after: StepRecord,
    /// Whether there is no moment after that.
    ended: bool,
    metrics: Option<Box<MetricsBuilder>>,
}

impl<'a> Playback<'a> {
    /// At time 0 of a run by `fleet`; it goes no further once it `stops`.
    pub fn new(fleet: &FleetInfo, source: RecordSource, stops: &'a dyn Fn() -> bool) -> Self {
        let (before, after) = (StepRecord::default(), StepRecord::default());
        let mut playback = Self {
            source,
            stops,
            fault: None,
            trail: Trail::new(fleet),
            before,
            after,
            ended: false,
            metrics: None,
        };
        playback.step();
        playback.before.clone_from(&playback.after);
        playback
    }

    /// Measures what goes by, from the first moment on.
    #[must_use]
    pub fn measured(mut self, mut metrics: MetricsBuilder) -> Self {
        metrics.push(&self.after);
        self.metrics = Some(Box::new(metrics));
        self
    }

    /// What was measured so far.
    pub fn metrics(&self) -> Metrics {
        let nothing = || MetricsBuilder::new(&FleetInfo::default(), Judging::NONE).finish();
        self.metrics.as_ref().map_or_else(nothing, |metrics| metrics.finish())
    }

    /// Takes the next moment; whether there was one.
    fn step(&mut self) -> bool {
        match self.source.next_into(&mut self.after) {
            Ok(true) => {}
            Ok(false) => return false,
            Err(error) => {
                self.fault = Some(error.into());
                return false;
            }
        }
        self.trail.push(&self.after);
        if let Some(metrics) = &mut self.metrics {
            metrics.push(&self.after);
        }
        true
    }

    /// The moment at `time` s, not before the last one asked for; the last moment of the run after its end; an
    /// earlier one where the work is to stop.
    pub fn at(&mut self, time: f64) -> StepRecord {
        while self.after.snapshot.time < time && !(self.stops)() {
            std::mem::swap(&mut self.before, &mut self.after);
            if !self.step() {
                std::mem::swap(&mut self.before, &mut self.after);
                self.ended = true;
                break;
            }
        }
        let (from, to) = (self.before.snapshot.time, self.after.snapshot.time);
        let share = if to > from { ((time - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
        StepRecord::between(&self.before, &self.after, share)
    }

    /// When the run ended, s, if all of it has been asked for.
    pub fn ended(&self) -> Option<f64> {
        self.ended.then_some(self.after.snapshot.time)
    }

    /// Fails where the cameras on robots could not take their pictures, or the recording is damaged.
    ///
    /// # Errors
    /// What broke off, once.
    pub fn check(&mut self) -> Result<(), Error> {
        self.fault.take().map_or(Ok(()), Err)
    }

    /// What has been.
    pub fn trail(&self) -> &Trail {
        &self.trail
    }
}
