//! Gains that fit a scene's vehicles: what a few hundred runs of the scene show, searched by COBYLA from several starts.
//!
//! The cost of a run is in units of one: late errors against 1 cm and 1°, errors summed over the run against 1 m s and
//! 1 rad s, commands that a limit cut against a tenth of the samples, and a hundred for every contact or robot that can
//! drive no more. The search goes over logarithms, since gains multiply, and begins at the scene's own gains.

use cobyla::{RhoBeg, StopTols, minimize};
use metrics::{Metrics, MetricsBuilder};
use scene::{Role, Scene};
use serde::Serialize;
use simulation::{BuildError, Simulation, build};
use std::cell::RefCell;
use thiserror::Error;
use vocabulary::{LawKind, math};

/// Gains of every follower, the same for distance and bearing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Gains {
    /// 1/s.
    pub k: f64,
    /// m/s² and rad/s².
    pub beta: f64,
    /// 1/m and 1/rad.
    pub slope: f64,
    /// s.
    pub epsilon: f64,
}

/// One run with some gains.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Trial {
    /// What was tried.
    #[serde(flatten)]
    pub gains: Gains,
    /// What it cost; less is better.
    pub cost: f64,
    /// Largest |error| of any edge in the second half of the run, [m, rad].
    pub late_error: [f64; 2],
    /// Share of the samples at which a limit cut a command, of the worst edge.
    pub limited: f64,
    /// Contacts.
    pub contacts: usize,
}

/// Why no gains were found.
#[derive(Debug, Error)]
pub enum TuneError {
    /// The scene cannot run.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// Nobody follows by output feedback.
    #[error("no robot of the scene follows by `output-feedback`: there are no such gains to find")]
    NothingToTune,
}

/// Bounds of the search: what has been seen to run on vehicles from 1/10 scale to full size.
const BOUNDS: [[f64; 2]; 4] = [[0.3, 10.0], [0.05, 10.0], [1.0, 40.0], [0.002, 0.2]];
/// First steps of the search, as a factor.
const FIRST_STEP: f64 = 1.6;
/// Where the search begins besides the scene's own gains: from cautious to very cautious.
const STARTS: [Gains; 2] = [
    Gains { k: 2.0, beta: 1.5, slope: 8.0, epsilon: 0.02 },
    Gains { k: 1.0, beta: 0.5, slope: 5.0, epsilon: 0.05 },
];
/// What a contact costs, and a robot that cannot drive any more.
const DISASTER: f64 = 100.0;

impl Gains {
    /// Those of the first follower by output feedback.
    fn of(scene: &Scene) -> Option<Self> {
        let mut followers = scene.followers().map(|(_, follow)| follow);
        let follow = followers.find(|follow| follow.law.built_in() == Some(LawKind::OutputFeedback))?;
        let (law, epsilon) = (&follow.law, follow.observer.epsilon[0]);
        Some(Self { k: law.k[0], beta: law.beta[0], slope: law.slope[0], epsilon })
    }

    fn give(self, scene: &mut Scene) {
        scene.for_every_robot(|robot| {
            if let Role::Follow(follow) = &mut robot.role {
                follow.law.k = [self.k; 2];
                follow.law.beta = [self.beta; 2];
                follow.law.slope = [self.slope; 2];
                follow.observer.epsilon = [self.epsilon; 2];
                // It is ε that is searched, with measurements too.
                follow.observer.adaptive = false;
            }
        });
    }

    fn logarithms(self) -> [f64; 4] {
        let values = [self.k, self.beta, self.slope, self.epsilon];
        [0, 1, 2, 3].map(|i| math::ln(values[i].clamp(BOUNDS[i][0], BOUNDS[i][1])))
    }

    fn from_logarithms(values: &[f64]) -> Self {
        let at = |i: usize| values.get(i).map_or(1.0, |x| math::exp(*x)).clamp(BOUNDS[i][0], BOUNDS[i][1]);
        Self { k: at(0), beta: at(1), slope: at(2), epsilon: at(3) }
    }
}

/// Tries the scene's own gains first and then at most `most` others; `look` sees every trial and says whether to go on.
/// What comes back is that first trial and the best of all.
///
/// # Errors
/// [`TuneError`] where the scene cannot run or has no follower by output feedback.
pub fn tune(scene: &Scene, most: usize, look: impl FnMut(&Trial) -> bool) -> Result<[Trial; 2], TuneError> {
    let own = Gains::of(scene).ok_or(TuneError::NothingToTune)?;
    let first = trial(scene, own)?;
    let search = RefCell::new(Search { best: first, look, on: true });
    search.borrow_mut().take_in(first);
    let cost = |at: &[f64], (): &mut ()| {
        // Once nobody wants to go on, every other place is as bad, and the search ends by itself.
        if !search.borrow().on {
            return f64::MAX;
        }
        let Ok(trial) = trial(scene, Gains::from_logarithms(at)) else { return f64::MAX };
        search.borrow_mut().take_in(trial);
        trial.cost
    };
    let bounds = BOUNDS.map(|[low, high]| (math::ln(low), math::ln(high)));
    let tolerances = StopTols { xtol_rel: 1e-2, ..StopTols::default() };
    let starts = [&[own][..], &STARTS].concat();
    for start in &starts {
        let no_constraints: [fn(&[f64], &mut ()) -> f64; 0] = [];
        let (first_step, share) = (RhoBeg::All(math::ln(FIRST_STEP)), (most / starts.len()).max(1));
        // It ends by its tolerance or by the number of trials; the best that was seen counts either way.
        let _ = minimize(
            cost,
            &start.logarithms(),
            &bounds,
            &no_constraints,
            (),
            share,
            first_step,
            Some(tolerances.clone()),
        );
    }
    let best = search.borrow().best;
    Ok([first, best])
}

/// What has been seen so far.
struct Search<L> {
    best: Trial,
    look: L,
    on: bool,
}

impl<L: FnMut(&Trial) -> bool> Search<L> {
    fn take_in(&mut self, trial: Trial) {
        if trial.cost < self.best.cost {
            self.best = trial;
        }
        self.on &= (self.look)(&trial);
    }
}

/// Runs the scene with some gains.
fn trial(scene: &Scene, gains: Gains) -> Result<Trial, BuildError> {
    let mut scene = scene.clone();
    gains.give(&mut scene);
    let mut simulation = Simulation::new(build(&scene)?);
    let mut metrics = MetricsBuilder::new(simulation.fleet(), scene.judging());
    while let Some(record) = simulation.next_record() {
        metrics.push(record);
    }
    let metrics = metrics.finish();
    let largest =
        |channel: usize| metrics.edges.iter().map(|edge| edge.late_peak_error[channel]).fold(0.0, f64::max);
    Ok(Trial {
        gains,
        cost: cost(&metrics),
        late_error: [largest(0), largest(1)],
        limited: metrics.edges.iter().map(|edge| edge.limited).fold(0.0, f64::max),
        contacts: metrics.contacts,
    })
}

/// Less is better.
fn cost(metrics: &Metrics) -> f64 {
    let edge = |e: &metrics::EdgeMetrics| {
        let late = e.late_peak_error[0] / 0.01 + e.late_peak_error[1].to_degrees();
        late + e.iae[0] + e.iae[1] + 10.0 * e.limited
    };
    let edges: f64 = metrics.edges.iter().map(edge).sum();
    let unable = metrics.robots.iter().filter(|robot| robot.condition != "able").count();
    edges / metrics.edges.len().max(1) as f64 + DISASTER * (metrics.contacts + unable) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(text: &str) -> Scene {
        Scene::parse(text, "tune.toml", &[]).expect("a scene").scene
    }

    const HEAD: &str = "schema = 1\ntitle = \"t\"\nvehicle = \"car\"\n[time]\nduration = 6.0\n[[robots]]\nname = \"a\"\n\
        pose = [0, 0, 0]\npath = { kind = \"constant\", speed = 1.0 }\n";

    #[test]
    fn gains_that_circle_are_replaced_by_gains_that_settle() {
        let follower = "[law]\nk = 5.0\nbeta = 5.0\nslope = 24.53\n[observer]\nepsilon = 0.02\n[[robots]]\nname = \"b\"\n\
            pose = [-2, -1, 0]\nspeed = 0.8\nleader = \"a\"\ndistance = 2.0\nbearing = \"-135 deg\"\n";
        let mut trials = 0;
        let [first, best] = tune(&scene(&format!("{HEAD}{follower}")), 30, |_| {
            trials += 1;
            true
        })
        .expect("gains");
        assert_eq!(first.gains, Gains { k: 5.0, beta: 5.0, slope: 24.53, epsilon: 0.02 });
        assert!(first.late_error[0] > 0.05 && best.late_error[0] < 0.04, "{first:?} {best:?}");
        assert!(best.cost < 0.5 * first.cost && (4..=40).contains(&trials), "{trials} trials");
    }

    #[test]
    fn a_scene_without_output_feedback_has_nothing_to_tune() {
        assert!(matches!(tune(&scene(HEAD), 5, |_| true), Err(TuneError::NothingToTune)));
    }

    #[test]
    fn the_search_ends_when_nobody_looks_on() {
        let follower = "[[robots]]\nname = \"b\"\npose = [-2, -1, 0]\nspeed = 0.8\nleader = \"a\"\ndistance = 2.0\n\
            bearing = \"-135 deg\"\n";
        let mut trials = 0;
        let _ = tune(&scene(&format!("{HEAD}{follower}")), 300, |_| {
            trials += 1;
            trials < 3
        });
        assert_eq!(trials, 3);
    }
}
