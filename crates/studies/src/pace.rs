//! How fast a machine does what users wait for: something is repeated within a budget of time, and the median counts.

use crate::{Error, RendererFactory, SceneRun};
use metrics::median;
use scene::Scene;

/// Reads a stop watch, s.
pub type Clock<'a> = &'a dyn Fn() -> f64;

/// Fewest repetitions that have a median, whatever they take.
pub const LEAST: usize = 3;
/// More repetitions tell nothing new.
const MOST: usize = 100;

/// How long one repetition takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// Median, s.
    pub seconds: f64,
    /// Repetitions that count.
    pub repetitions: usize,
}

/// What bounds a measurement.
#[derive(Clone, Copy)]
pub struct PaceBench<'a> {
    /// The stop watch.
    pub clock: Clock<'a>,
    /// Time for all repetitions, s. At least [`LEAST`] are made, however long they take.
    pub budget: f64,
    /// Asked before every repetition.
    pub go_on: &'a dyn Fn() -> bool,
}

impl PaceBench<'_> {
    /// Repeats `once`, which returns the seconds that count of it, or nothing where there is no more to repeat. The first
    /// repetition is for warming up and does not count. `None` where there were fewer than [`LEAST`].
    ///
    /// # Errors
    /// The first error of `once`.
    pub fn repeat<E>(&self, mut once: impl FnMut() -> Result<Option<f64>, E>) -> Result<Option<Pace>, E> {
        if !(self.go_on)() || once()?.is_none() {
            return Ok(None);
        }
        let (began, mut times) = ((self.clock)(), Vec::new());
        while times.len() < LEAST || (times.len() < MOST && (self.clock)() - began < self.budget) {
            if !(self.go_on)() {
                break;
            }
            let Some(seconds) = once()? else { break };
            times.push(seconds);
        }
        let repetitions = times.len();
        let seconds = median(&mut times).filter(|_| repetitions >= LEAST);
        Ok(seconds.map(|seconds| Pace { seconds, repetitions }))
    }

    /// Seconds that `work` takes.
    ///
    /// # Errors
    /// That of `work`.
    pub fn time<E>(&self, work: impl FnOnce() -> Result<(), E>) -> Result<f64, E> {
        let began = (self.clock)();
        work()?;
        Ok((self.clock)() - began)
    }

    /// The pace of a run of `scene` by stretches of `stretch` s of simulated time, the first of which does not count.
    /// `renderer` draws for the scene's cameras, if it has any.
    ///
    /// # Errors
    /// [`Error`] where the scene cannot run, or its run breaks off.
    pub fn simulation(
        &self,
        scene: Scene,
        renderer: RendererFactory<'_>,
        stretch: f64,
    ) -> Result<Option<Pace>, Error> {
        let mut run = SceneRun::new(scene)?;
        run.attach_cameras(renderer)?;
        let steps = (stretch / run.simulation.period()).round().max(1.0) as u64;
        let mut ended = false;
        self.repeat(|| {
            let seconds = self.time(|| {
                let mut left = steps;
                run.step_through(|_, _| {
                    left -= 1;
                    left > 0
                })?;
                ended = left > 0;
                Ok::<_, Error>(())
            })?;
            Ok((!ended).then_some(seconds))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;
    use std::convert::Infallible;

    /// What comes of repetitions that take `times`, one after the other and the last for ever, until `stopped` of them.
    fn paced(times: &[f64], budget: f64, stopped: usize) -> (Option<Pace>, usize) {
        let (now, made) = (Cell::new(5.0), Cell::new(0));
        let (clock, go_on) = (|| now.get(), || made.get() < stopped);
        let bench = PaceBench { clock: &clock, budget, go_on: &go_on };
        let pace = bench.repeat(|| {
            let time = times[made.get().min(times.len() - 1)];
            made.set(made.get() + 1);
            let work = || {
                now.set(now.get() + time);
                Ok::<_, Infallible>(())
            };
            bench.time(work).map(Some)
        });
        (pace.expect("no error"), made.get())
    }

    #[test]
    fn the_median_counts_and_warming_up_does_not() {
        let (pace, made) = paced(&[50.0, 1.0, 4.0, 2.0], 0.0, usize::MAX);
        assert_eq!((pace, made), (Some(Pace { seconds: 2.0, repetitions: 3 }), 4));
    }

    #[test]
    fn repetitions_fill_the_budget_and_end_at_a_limit() {
        assert_eq!(paced(&[0.25], 2.0, usize::MAX).1, 1 + 8);
        assert_eq!(paced(&[0.25], 1e9, usize::MAX).1, 1 + MOST);
    }

    #[test]
    fn what_is_interrupted_before_it_has_a_median_has_none() {
        for stopped in 0..=LEAST {
            assert_eq!(paced(&[1.0], 9.0, stopped), (None, stopped));
        }
        let (pace, _) = paced(&[1.0], 9.0, LEAST + 1);
        assert_eq!(pace, Some(Pace { seconds: 1.0, repetitions: LEAST }));
    }

    #[test]
    fn a_run_is_repeated_by_stretches_until_it_ends() {
        let text = scene::shipped("circle-three").expect("a scene").text;
        let scene = |duration: f64| {
            let set = [format!("time.duration={duration}").parse().expect("an override")];
            Scene::parse(text, "circle-three", &set).expect("a scene").scene
        };
        let readings = Cell::new(0.0);
        let clock = || readings.replace(readings.get() + 1.0);
        let bench = PaceBench { clock: &clock, budget: f64::INFINITY, go_on: &|| true };
        let pace = |duration| bench.simulation(scene(duration), &mut |_| Err(String::new()), 0.1);
        // One stretch warms up; the one that the end cuts short does not count.
        let found = pace(0.65).expect("a run").expect("a median");
        assert_eq!(found, Pace { seconds: 1.0, repetitions: 5 });
        assert_eq!(pace(0.35).expect("a run"), None);
    }
}
