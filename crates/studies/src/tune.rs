//! Gains that fit a scene's vehicles: what a few hundred runs of the scene show, searched by COBYLA from several starts.
//!
//! The cost of a run is in units of one: late errors against 1 cm and 1°, errors summed over the run against 1 m s and
//! 1 rad s, commands that a limit cut against a tenth of the samples, and a hundred for every contact, robot that can
//! drive no more, or law that breaks off. The search goes over logarithms, since gains multiply, and begins at the scene's own gains.

use crate::copies::{Episode, StartScatter};
use cobyla::{RhoBeg, StopTols, minimize};
use metrics::{Metrics, MetricsBuilder};
use scene::{Follow, Role, Scene, WrittenLaw};
use serde::Serialize;
use simulation::{BuildError, Simulation, build};
use std::cell::RefCell;
use std::collections::BTreeMap;
use thiserror::Error;
use vocabulary::{LawKind, math};

/// A number that is searched, of every follower the same.
struct Knob {
    /// What it is called where it is written.
    name: String,
    /// Least and largest value.
    bounds: [f64; 2],
    /// Whether equal steps are equal ratios.
    logarithmic: bool,
}

/// One run with some gains.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Trial {
    /// What was tried, by name: `k` in 1/s, `beta` in m/s² and rad/s², `slope` in 1/m and 1/rad and `epsilon` in s, or the
    /// parameters of a custom law.
    pub gains: BTreeMap<String, f64>,
    /// What it cost; less is better.
    pub cost: f64,
    /// Largest |error| of any edge in the second half of the run, [m, rad].
    pub late_error: [f64; 2],
    /// Share of the samples at which a limit cut a command, of the worst edge.
    pub limited: f64,
    /// Contacts.
    pub contacts: usize,
}

/// What a trial runs.
#[derive(Debug, Clone, PartialEq)]
pub struct TuneEffort {
    /// Largest number of trials.
    pub most: usize,
    /// Runs of a trial, each with a seed of its own: gains have to hold over all of them.
    pub seeds: u64,
    /// Where followers start in each.
    pub scatter: StartScatter,
}

/// Why no gains were found.
#[derive(Debug, Error)]
pub enum TuneError {
    /// The scene cannot run.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// Robots have no room to start as they are asked to.
    #[error("{0}")]
    Scatter(String),
    /// Nobody follows by output feedback or by a custom law with parameters.
    #[error(
        "no robot of the scene follows by `output-feedback`, or by a custom law with parameters: there are no such gains to find"
    )]
    NothingToTune,
}

/// The gains of output feedback with the bounds of their search: what has been seen to run on vehicles from 1/10 scale to
/// full size; and where the search begins besides the scene's own, from cautious to very cautious.
const GAINS: [(&str, [f64; 2], [f64; 2]); 4] = [
    ("k", [0.3, 10.0], [2.0, 1.0]),
    ("beta", [0.05, 10.0], [1.5, 0.5]),
    ("slope", [1.0, 40.0], [8.0, 5.0]),
    ("epsilon", [0.002, 0.2], [0.02, 0.05]),
];
/// First steps of the search, as a factor, and as a share of a range.
const FIRST_STEP: f64 = 1.6;
const FIRST_SHARE: f64 = 0.15;
/// What a contact costs, and a robot that cannot drive any more.
const DISASTER: f64 = 100.0;

/// What is searched, and where from.
struct Search<'a> {
    /// The law whose parameters are searched; the gains of output feedback where there is none.
    law: Option<&'a WrittenLaw>,
    knobs: Vec<Knob>,
    /// The scene's own values, then others.
    starts: Vec<Vec<f64>>,
}

impl<'a> Search<'a> {
    /// Of the first follower by output feedback or by a custom law.
    fn of(scene: &'a Scene) -> Option<Self> {
        let tuned = |follow: &&Follow| match follow.law.custom() {
            Some(law) => !law.declaration().parameters.is_empty(),
            None => follow.law.kind == LawKind::OutputFeedback,
        };
        let follow = scene.followers().map(|(_, follow)| follow).find(tuned)?;
        Some(follow.law.custom().map_or_else(|| Self::built_in(follow), |law| Self::custom(follow, law)))
    }

    /// The parameters of a custom law, within the ranges that it declares.
    fn custom(follow: &Follow, law: &'a WrittenLaw) -> Self {
        let knob = |own: &laws::Parameter| Knob {
            name: own.name.clone(),
            bounds: own.range,
            logarithmic: own.scale == laws::Scale::Logarithmic,
        };
        let knobs = law.declaration().parameters.iter().map(knob).collect();
        Self { law: Some(law), knobs, starts: vec![follow.law.values()] }
    }

    /// The gains of output feedback.
    fn built_in(follow: &Follow) -> Self {
        let own = [follow.law.k[0], follow.law.beta[0], follow.law.slope[0], follow.observer.epsilon[0]];
        let knob = |(name, bounds, _): &(&str, [f64; 2], _)| Knob {
            name: (*name).to_owned(),
            bounds: *bounds,
            logarithmic: true,
        };
        let knobs = GAINS.iter().map(knob).collect();
        let others = [0, 1].map(|which| GAINS.iter().map(|(.., starts)| starts[which]).collect());
        Self { law: None, knobs, starts: std::iter::once(own.to_vec()).chain(others).collect() }
    }

    fn give(&self, values: &[f64], scene: &mut Scene) {
        scene.for_every_robot(|robot| {
            let Role::Follow(follow) = &mut robot.role else { return };
            match (self.law, values) {
                (Some(law), _) if follow.law.custom() == Some(law) => {
                    let named = self.knobs.iter().map(|knob| knob.name.clone()).zip(values.iter().copied());
                    follow.law.parameters.extend(named);
                }
                (None, [k, beta, slope, epsilon]) => {
                    follow.law.k = [*k; 2];
                    follow.law.beta = [*beta; 2];
                    follow.law.slope = [*slope; 2];
                    follow.observer.epsilon = [*epsilon; 2];
                    // It is ε that is searched, with measurements too.
                    follow.observer.adaptive = false;
                }
                _ => {}
            }
        });
    }

    /// Runs the scene with some values, once for each seed: costs are their mean, all else is of the worst.
    fn trial(&self, scene: &Scene, values: &[f64], effort: &TuneEffort) -> Result<Trial, TuneError> {
        let gains = self.knobs.iter().map(|knob| knob.name.clone()).zip(values.iter().copied()).collect();
        let mut trial = Trial { gains, cost: 0.0, late_error: [0.0; 2], limited: 0.0, contacts: 0 };
        for number in 0..effort.seeds {
            let mut scene = scene.clone();
            self.give(values, &mut scene);
            // The first run is the scene's own where nothing is scattered.
            let episode = Episode { seed: scene.seed, number };
            effort
                .scatter
                .scatter(&mut scene, episode)
                .map_err(|error| TuneError::Scatter(error.to_string()))?;
            let metrics = run(&scene)?;
            trial.cost += cost(&metrics) / effort.seeds as f64;
            trial.contacts += metrics.contacts;
            for edge in &metrics.edges {
                trial.limited = trial.limited.max(edge.limited);
                for (worst, error) in trial.late_error.iter_mut().zip(edge.late_peak_error) {
                    *worst = worst.max(error);
                }
            }
        }
        Ok(trial)
    }
}

/// The metrics of a run.
fn run(scene: &Scene) -> Result<Metrics, BuildError> {
    let mut simulation = Simulation::new(build(scene)?);
    let mut metrics = MetricsBuilder::new(simulation.fleet(), scene.judging());
    while let Some(record) = simulation.next_record() {
        metrics.push(record);
    }
    Ok(metrics.finish())
}

impl Knob {
    /// The value as the search sees it: its logarithm, or its share of the range.
    fn seen(&self, value: f64) -> f64 {
        let [low, high] = self.bounds;
        let value = value.clamp(low, high);
        if self.logarithmic { math::ln(value) } else { (value - low) / (high - low).max(f64::MIN_POSITIVE) }
    }

    /// The value that is tried. It has four digits, so that what is printed is what was run.
    fn value(&self, seen: f64) -> f64 {
        let [low, high] = self.bounds;
        let value = if self.logarithmic { math::exp(seen) } else { low + seen * (high - low) };
        rounded(value).clamp(low, high)
    }

    fn first_step(&self) -> f64 {
        if self.logarithmic { math::ln(FIRST_STEP) } else { FIRST_SHARE }
    }
}

/// A value to four digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

/// Whose gains are searched, and what law they have: followers by name, in their order.
pub fn tuned(scene: &Scene) -> Option<(String, Vec<&str>)> {
    let search = Search::of(scene)?;
    let has = |follow: &Follow| match search.law {
        Some(law) => follow.law.custom() == Some(law),
        None => follow.law.custom().is_none(),
    };
    let names = scene.followers().filter(|(_, follow)| has(follow)).map(|(name, _)| name).collect();
    let law = search.law.map_or("the built-in laws", WrittenLaw::name);
    Some((law.to_owned(), names))
}

/// Tries the scene's own gains first and then others; `look` sees every trial and says whether to go on. What comes back is that first trial and the best of all.
///
/// # Errors
/// [`TuneError`] where the scene cannot run or has no follower with gains to be found.
pub fn tune(
    scene: &Scene,
    effort: &TuneEffort,
    look: impl FnMut(&Trial) -> bool,
) -> Result<[Trial; 2], TuneError> {
    let search = Search::of(scene).ok_or(TuneError::NothingToTune)?;
    let first = search.trial(scene, &search.starts[0], effort)?;
    let seen = RefCell::new(Seen { best: first.clone(), look, on: true });
    seen.borrow_mut().take_in(first.clone());
    let cost = |at: &[f64], (): &mut ()| {
        // Once nobody wants to go on, every other place is as bad, and the search ends by itself.
        if !seen.borrow().on {
            return f64::MAX;
        }
        let values: Vec<f64> = search.knobs.iter().zip(at).map(|(knob, at)| knob.value(*at)).collect();
        let Ok(trial) = search.trial(scene, &values, effort) else { return f64::MAX };
        let cost = trial.cost;
        seen.borrow_mut().take_in(trial);
        cost
    };
    let bounds: Vec<(f64, f64)> =
        search.knobs.iter().map(|knob| (knob.seen(knob.bounds[0]), knob.seen(knob.bounds[1]))).collect();
    let steps: Vec<f64> = search.knobs.iter().map(Knob::first_step).collect();
    let tolerances = StopTols { xtol_rel: 1e-2, ..StopTols::default() };
    for start in &search.starts {
        let no_constraints: [fn(&[f64], &mut ()) -> f64; 0] = [];
        let share = (effort.most / search.starts.len()).max(1);
        let from: Vec<f64> = search.knobs.iter().zip(start).map(|(knob, value)| knob.seen(*value)).collect();
        // It ends by its tolerance or by the number of trials; the best that was seen counts either way.
        let _ = minimize(
            cost,
            &from,
            &bounds,
            &no_constraints,
            (),
            share,
            RhoBeg::Set(steps.clone()),
            Some(tolerances.clone()),
        );
    }
    let best = seen.borrow().best.clone();
    Ok([first, best])
}

/// What has been seen so far.
struct Seen<L> {
    best: Trial,
    look: L,
    on: bool,
}

impl<L: FnMut(&Trial) -> bool> Seen<L> {
    fn take_in(&mut self, trial: Trial) {
        self.on &= (self.look)(&trial);
        if trial.cost < self.best.cost {
            self.best = trial;
        }
    }
}

/// Less is better.
fn cost(metrics: &Metrics) -> f64 {
    let edge = |e: &metrics::EdgeMetrics| {
        let late = e.late_peak_error[0] / 0.01 + e.late_peak_error[1].to_degrees();
        late + e.iae[0] + e.iae[1] + 10.0 * e.limited
    };
    let edges: f64 = metrics.edges.iter().map(edge).sum();
    let unable = metrics.robots.iter().filter(|robot| robot.condition != "able").count();
    let disasters = metrics.contacts + unable + metrics.law_faults.len();
    edges / metrics.edges.len().max(1) as f64 + DISASTER * disasters as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn effort(most: usize) -> TuneEffort {
        TuneEffort { most, seeds: 1, scatter: StartScatter::default() }
    }

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
        let [first, best] = tune(&scene(&format!("{HEAD}{follower}")), &effort(30), |_| {
            trials += 1;
            true
        })
        .expect("gains");
        let own = [("k", 5.0), ("beta", 5.0), ("slope", 24.53), ("epsilon", 0.02)];
        assert_eq!(first.gains, own.map(|(name, value)| (name.to_owned(), value)).into());
        assert!(first.late_error[0] > 0.05 && best.late_error[0] < 0.04, "{first:?} {best:?}");
        assert!(best.cost < 0.5 * first.cost && (4..=40).contains(&trials), "{trials} trials");
    }

    #[test]
    fn parameters_of_a_custom_law_are_searched_within_their_ranges() {
        let law = "knows rates\nparameter k = 0.4 [1/s] in 0.2 .. 6\nparameter d = 0.5 in 0.1 .. 2\n\
            let e = (wanted.distance - leader.distance, wrap(wanted.bearing - leader.bearing))\n\
            let b = k^2 * e - 2 * d * k * leader.rates\nlet c = cos(leader.view_angle)\n\
            let s = sin(leader.view_angle)\nlet a = leader.distance * b.y\n\
            command = c * b.x - s * a, (s * b.x + c * a) / own.speed\n";
        let text = format!(
            "{}[law]\ntext = {law:?}\n[[robots]]\nname = \"b\"\npose = [-2, -1, 0]\nspeed = 0.8\nleader = \"a\"\n\
             distance = 2.0\nbearing = \"-135 deg\"\n",
            HEAD.replace("vehicle = \"car\"\n", "")
        );
        let [first, best] = tune(&scene(&text), &effort(40), |_| true).expect("gains");
        assert_eq!((first.gains["k"], first.gains["d"]), (0.4, 0.5));
        assert!(best.cost < 0.5 * first.cost, "{first:?} {best:?}");
        assert!((0.2..=6.0).contains(&best.gains["k"]) && (0.1..=2.0).contains(&best.gains["d"]));
    }

    /// A trial of several seeds is as good as their mean and as bad as their worst.
    #[test]
    fn gains_are_judged_by_all_their_runs() {
        let follower = "[sensing]\nkind = \"noise\"\n[[robots]]\nname = \"b\"\npose = [-2, -1, 0]\nspeed = 0.8\nleader = \"a\"\n\
            distance = 2.0\nbearing = \"-135 deg\"\n";
        let scene = scene(&format!("{HEAD}{follower}"));
        let search = Search::of(&scene).expect("a search");
        let scatter = StartScatter { robots: vec![1], position: 0.3, heading: 0.2 };
        let trial = |seeds: u64| {
            let all = TuneEffort { seeds, scatter: scatter.clone(), ..effort(4) };
            search.trial(&scene, &search.starts[0], &all).expect("a trial")
        };
        let one = trial(1);
        let three = trial(3);
        assert_ne!(one.cost, three.cost);
        assert!(three.late_error[0] >= one.late_error[0] && three.late_error[1] >= one.late_error[1]);
        assert_eq!(three, trial(3));
    }

    #[test]
    fn a_scene_without_output_feedback_has_nothing_to_tune() {
        assert!(matches!(tune(&scene(HEAD), &effort(5), |_| true), Err(TuneError::NothingToTune)));
    }

    #[test]
    fn the_search_ends_when_nobody_looks_on() {
        let follower = "[[robots]]\nname = \"b\"\npose = [-2, -1, 0]\nspeed = 0.8\nleader = \"a\"\ndistance = 2.0\n\
            bearing = \"-135 deg\"\n";
        let mut trials = 0;
        let _ = tune(&scene(&format!("{HEAD}{follower}")), &effort(300), |_| {
            trials += 1;
            trials < 3
        });
        assert_eq!(trials, 3);
    }
}
