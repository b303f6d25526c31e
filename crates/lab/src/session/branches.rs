//! Branches of a run: going back, changing parameters and continuing, exactly.
//!
//! A branch is a scene and a list of changes, each before a control sample. The simulation of a branch is kept,
//! with checkpoints about every second. Going back starts from the checkpoint before and simulates up to the requested
//! sample, which gives the same run bit for bit.

use super::checked_scene::{CheckedScene, build, build_change};
use metrics::Digest;
use scene::{ChangeText, Event, Scene, SceneText, Trigger};
use simulation::{BuildError, Setup, Simulation};
use std::rc::Rc;
use std::sync::Arc;
use vocabulary::StepRecord;

/// Initial simulated time between two checkpoints, s.
const MARK_EVERY: f64 = 1.0;
/// Maximum number of checkpoints of a branch; beyond it every second one is dropped and their distance doubles.
const MOST_MARKS: usize = 48;

/// Longer than any session, s.
const FOR_EVER: f64 = 1e7;

/// All branches of a run; the first is its trunk.
pub struct Branches {
    scene: Arc<Scene>,
    list: Vec<Branch>,
}

/// A branch of the run.
pub struct Branch {
    /// Its name.
    pub name: String,
    /// Parent branch, and the control sample of the fork.
    pub parent: Option<(usize, u64)>,
    /// Its changes since time 0, in the order of the samples.
    pub changes: Vec<BranchChange>,
    simulation: Simulation,
    digest: Digest,
    marks: Vec<Rc<SavedState>>,
    mark_every: u64,
}

/// A change of parameters at a control sample.
#[derive(Debug, Clone)]
pub struct BranchChange {
    /// The first control sample with the new parameters.
    pub sample: u64,
    /// s.
    pub time: f64,
    /// The scene with these parameters.
    pub scene: Arc<Scene>,
    /// The differences from before, as overrides.
    pub set: Vec<String>,
    /// What is to happen besides.
    pub events: Vec<Event>,
}

impl BranchChange {
    /// Whether nothing is set and nothing is to happen.
    pub(crate) fn is_empty(&self) -> bool {
        self.set.is_empty() && self.events.is_empty()
    }
}

/// A checkpoint: the state of a branch before a sample.
struct SavedState {
    simulation: Simulation,
    digest: Digest,
}

impl Branches {
    /// The trunk of `scene` at time 0; `ready` completes its simulation, for example with a camera renderer.
    ///
    /// # Errors
    /// [`BuildError`] for a scene that cannot run.
    pub fn open(scene: Arc<Scene>, ready: impl FnOnce(&mut Simulation)) -> Result<Self, BuildError> {
        let mut simulation = Simulation::new(build(&scene)?);
        // The lab has no end time.
        simulation.extend_to(FOR_EVER);
        ready(&mut simulation);
        let mark = Rc::new(SavedState { simulation: simulation.save(), digest: Digest::default() });
        let mark_every = (MARK_EVERY / simulation.period()).ceil().max(1.0) as u64;
        let trunk = Branch {
            name: "main".to_owned(),
            parent: None,
            changes: Vec::new(),
            digest: Digest::default(),
            marks: vec![mark],
            mark_every,
            simulation,
        };
        Ok(Self { scene, list: vec![trunk] })
    }

    /// All branches in the order of creation.
    pub fn list(&self) -> &[Branch] {
        &self.list
    }

    /// Simulates the next sample of a branch; `None` after its end.
    pub fn advance(&mut self, branch: usize) -> Option<&StepRecord> {
        self.list.get_mut(branch)?.advance()
    }

    /// Applies the parameters of `scene` from the next sample of a branch on. A change that reverts an earlier one at
    /// the same sample sets nothing.
    ///
    /// # Errors
    /// Which part of the scene cannot change during a run.
    pub fn change(&mut self, branch: usize, checked: &CheckedScene) -> Result<Option<BranchChange>, String> {
        let base = Arc::clone(&self.scene);
        match self.list.get_mut(branch) {
            Some(branch) => branch.change(&base, checked),
            None => Ok(None),
        }
    }

    /// Digest of the first `samples` samples of a branch.
    pub fn digest_at(&self, branch: usize, samples: u64) -> Option<String> {
        let branch = self.list.get(branch)?;
        if branch.simulation.sample() == samples {
            return Some(branch.digest());
        }
        Some(branch.fork(&self.scene, 0, samples, String::new()).digest())
    }

    /// Forks branch `from` before control sample `sample`; the index of the new branch.
    pub fn fork(&mut self, from: usize, sample: u64, name: String) -> Option<usize> {
        let branch = self.list.get(from)?.fork(&self.scene, from, sample, name);
        self.list.push(branch);
        Some(self.list.len() - 1)
    }
}

impl Branch {
    fn advance(&mut self) -> Option<&StepRecord> {
        self.digest.push(self.simulation.next_record()?);
        let sample = self.simulation.sample();
        if sample.is_multiple_of(self.mark_every) {
            self.mark();
        }
        Some(self.simulation.record())
    }

    fn mark(&mut self) {
        let mark = SavedState { simulation: self.simulation.save(), digest: self.digest.clone() };
        self.marks.push(Rc::new(mark));
        if self.marks.len() > MOST_MARKS {
            self.mark_every *= 2;
            let every = self.mark_every;
            self.marks.retain(|mark| mark.simulation.sample().is_multiple_of(every));
        }
    }

    /// Applies the parameters of `scene` and returns the differences. Changes before the same sample are merged.
    fn change(&mut self, base: &Arc<Scene>, checked: &CheckedScene) -> Result<Option<BranchChange>, String> {
        let sample = self.simulation.sample();
        let earlier = self.changes.partition_point(|change| change.sample < sample);
        let again = earlier < self.changes.len();
        let before = self.changes[..earlier].last().map_or(base, |last| &last.scene);
        let set = checked.set_from(before).map_err(|standing| standing.join("\n"))?;
        let scene = Arc::clone(checked.scene());
        // Events come on top of those that are there.
        let events = scene.events.get(before.events.len()..).unwrap_or_default().to_vec();
        let late = |event: &Event| match event.trigger {
            Trigger::At { at } => self.simulation.sample_at(at) < sample,
            Trigger::When { .. } => false,
        };
        if let Some(event) = events.iter().find(|event| late(event)) {
            return Err(format!("Too late for that: {}", event.words()));
        }
        let change =
            BranchChange { sample, time: sample as f64 * self.simulation.period(), scene, set, events };
        let new = (!change.is_empty()).then(|| change.clone());
        if base.changes.is_empty() {
            self.simulation.apply_parameters(checked.setup());
            self.simulation.replan(checked.setup());
        } else {
            let changes: Vec<BranchChange> =
                self.changes[..earlier].iter().cloned().chain(new.clone()).collect();
            self.simulation.reschedule(&planned(base, &changes)?);
        }
        self.changes.truncate(earlier);
        self.changes.extend(new);
        Ok((again || !change.is_empty()).then_some(change))
    }

    fn fork(&self, base: &Scene, index: usize, until: u64, name: String) -> Self {
        let marks: Vec<_> = self.marks.iter().filter(|m| m.simulation.sample() <= until).cloned().collect();
        let changes: Vec<_> = self.changes.iter().filter(|c| c.sample < until).cloned().collect();
        // The checkpoint at time 0 always exists.
        let start = marks.last().unwrap_or(&self.marks[0]);
        let (mut simulation, mut digest) = (start.simulation.save(), start.digest.clone());
        // It was built before, so it can be built again.
        if !base.changes.is_empty()
            && let Ok(setup) = planned(base, &changes)
        {
            simulation.reschedule(&setup);
        }
        while simulation.sample() < until {
            let sample = simulation.sample();
            let due = changes.iter().filter(|change| change.sample == sample && base.changes.is_empty());
            for setup in due.filter_map(|change| build_change(&change.scene).ok()) {
                simulation.apply_parameters(&setup);
                simulation.replan(&setup);
            }
            let Some(record) = simulation.next_record() else { break };
            digest.push(record);
        }
        Self {
            name,
            parent: Some((index, until)),
            changes,
            simulation,
            digest,
            marks,
            mark_every: self.mark_every,
        }
    }

    /// Digest of all samples so far.
    pub fn digest(&self) -> String {
        self.digest.text()
    }

    /// The simulation before its next sample.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// A copy of the simulation, which continues identically.
    pub fn copy(&self) -> Simulation {
        self.simulation.save()
    }
}

/// The changes of a scene merged with those of a branch; the later change wins.
fn planned(base: &Scene, changes: &[BranchChange]) -> Result<Setup, String> {
    let last = changes.last().map_or(0.0, |change| change.time);
    let text =
        script(&base.to_toml(), &base.changes, changes, base.time.duration.max(last + base.time.period))?;
    let scene = Scene::parse(&text, "", &[]).map_err(|faults| faults.to_string())?.scene;
    build(&scene).map_err(|error| error.to_string())
}

/// The text of a scene that reproduces a branch: `base`, which has changes `own`, with the branch's changes, for
/// `duration` s.
///
/// # Errors
/// Why the text cannot be edited.
pub fn script(
    base: &str,
    own: &[scene::Change],
    changes: &[BranchChange],
    duration: f64,
) -> Result<String, String> {
    let mut text = SceneText::parse(base).map_err(|error| error.to_string())?;
    // Expectations apply to the original run.
    let whole = text.get("time.duration").and_then(|whole| whole.parse::<f64>().ok());
    if !changes.is_empty() || whole.is_none_or(|whole| duration < whole) {
        text.remove("expect").map_err(|error| error.to_string())?;
    }
    text.set("time.duration", &format!("{duration:?}")).map_err(|error| error.to_string())?;
    let own: Vec<scene::Change> = own.iter().filter(|change| change.at <= duration).cloned().collect();
    let later: Vec<ChangeText> =
        changes.iter().map(|change| ChangeText { at: change.time, set: change.set.clone() }).collect();
    text.schedule(&own, &later).map_err(|error| error.to_string())?;
    for event in changes.iter().flat_map(|change| &change.events) {
        text.add_table("events", &event.to_lines()).map_err(|error| error.to_string())?;
    }
    Ok(text.text())
}
