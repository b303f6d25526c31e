//! Runs that share a past: going back, changing something, and running on, exactly.
//!
//! A branch is its scene and a list of changes, each before a control sample. Where a branch stands, and where it stood
//! every second or so, is kept as a saved simulation; going back starts from the one before and runs on to the sample
//! asked for, which is the same run bit for bit.

use recording::Digest;
use scene::{Override, Scene, SceneText};
use simulation::{BuildError, Simulation};
use std::rc::Rc;
use std::sync::Arc;
use vocabulary::Moment;

/// Simulated time between two saved states at first, s.
const MARK_EVERY: f64 = 1.0;
/// Most saved states of a branch; when there are more, every second goes and their distance doubles.
const MOST_MARKS: usize = 48;

/// Longer than anybody looks, s.
const FOR_EVER: f64 = 1e7;

/// All branches of a run; the first is its trunk.
pub struct Branches {
    scene: Arc<Scene>,
    list: Vec<Branch>,
}

/// One future of the run.
pub struct Branch {
    /// What it is called.
    pub name: String,
    /// Branch and control sample at which it leaves its parent.
    pub parent: Option<(usize, u64)>,
    /// What was changed, from time 0 on, in the order of the samples.
    pub changes: Vec<Change>,
    simulation: Simulation,
    digest: Digest,
    marks: Vec<Rc<Mark>>,
    mark_every: u64,
}

/// Parameters that hold from a control sample on.
#[derive(Debug, Clone)]
pub struct Change {
    /// The first sample that is decided with them.
    pub sample: u64,
    /// s.
    pub time: f64,
    /// The scene with these parameters, as it is written.
    pub scene: Arc<Scene>,
    /// The scene with these parameters, and with what its own script had changed until then.
    pub held: Arc<Scene>,
    /// What is different from before, as overrides.
    pub set: Vec<String>,
}

/// A branch as it stood before a sample.
struct Mark {
    simulation: Simulation,
    digest: Digest,
}

impl Branches {
    /// The trunk of `scene` at time 0; `ready` gives its simulation what it needs besides, such as eyes.
    ///
    /// # Errors
    /// [`BuildError`] for a scene that cannot run.
    pub fn open(scene: Arc<Scene>, ready: impl FnOnce(&mut Simulation)) -> Result<Self, BuildError> {
        let mut simulation = Simulation::new(simulation::build(&scene)?);
        // A laboratory runs on for as long as somebody looks.
        simulation.extend_to(FOR_EVER);
        ready(&mut simulation);
        let mark = Rc::new(Mark { simulation: simulation.save(), digest: Digest::default() });
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

    /// All of them, in the order in which they were made.
    pub fn list(&self) -> &[Branch] {
        &self.list
    }

    /// The next sample of a branch; `None` where it is over.
    pub fn advance(&mut self, branch: usize) -> Option<&Moment> {
        self.list.get_mut(branch)?.advance()
    }

    /// Lets the parameters of `scene` hold from the next sample of a branch on.
    ///
    /// # Errors
    /// What of the scene cannot change while a run goes, in words.
    pub fn change(&mut self, branch: usize, scene: Arc<Scene>) -> Result<Option<Change>, String> {
        let base = Arc::clone(&self.scene);
        match self.list.get_mut(branch) {
            Some(branch) => branch.change(&base, scene),
            None => Ok(None),
        }
    }

    /// A new branch that leaves `from` before control sample `sample`; its index.
    pub fn fork(&mut self, from: usize, sample: u64, name: String) -> Option<usize> {
        let branch = self.list.get(from)?.fork((from, sample), name);
        self.list.push(branch);
        Some(self.list.len() - 1)
    }
}

impl Branch {
    fn advance(&mut self) -> Option<&Moment> {
        self.digest.push(self.simulation.next_moment()?);
        let sample = self.simulation.sample();
        if sample.is_multiple_of(self.mark_every) {
            self.mark();
        }
        Some(self.simulation.moment())
    }

    fn mark(&mut self) {
        let mark = Mark { simulation: self.simulation.save(), digest: self.digest.clone() };
        self.marks.push(Rc::new(mark));
        if self.marks.len() > MOST_MARKS {
            self.mark_every *= 2;
            let every = self.mark_every;
            self.marks.retain(|mark| mark.simulation.sample().is_multiple_of(every));
        }
    }

    /// Takes the parameters of `scene`; what of them is new. Changes before the same sample become one.
    fn change(&mut self, base: &Arc<Scene>, scene: Arc<Scene>) -> Result<Option<Change>, String> {
        let sample = self.simulation.sample();
        let time = sample as f64 * self.simulation.period();
        let earlier = self.changes.iter().rfind(|change| change.sample < sample);
        let before = earlier.map_or(base, |change| &change.scene);
        let set = before.sets_to(&scene).map_err(|standing| standing.join("\n"))?;
        let held = match earlier {
            None if base.changes.is_empty() => Arc::clone(&scene),
            None => with(scripted(base, time), &set)?,
            Some(_) if base.changes.is_empty() => Arc::clone(&scene),
            Some(change) => with(&change.held, &set)?,
        };
        let change = Change { sample, time, scene, held, set };
        self.take(&change)?;
        if self.changes.last().is_some_and(|last| last.sample == sample) {
            self.changes.pop();
        }
        if change.set.is_empty() {
            return Ok(None);
        }
        self.changes.push(change.clone());
        Ok(Some(change))
    }

    /// Lets a change hold from the next sample on. Where a hand takes over, a scene's own script ends.
    fn take(&mut self, change: &Change) -> Result<(), String> {
        let scene = Scene { changes: Vec::new(), ..Scene::clone(&change.held) };
        let setup = simulation::build(&scene).map_err(|error| error.to_string())?;
        self.simulation.adopt(&setup);
        self.simulation.reschedule(&setup);
        Ok(())
    }

    fn fork(&self, parent: (usize, u64), name: String) -> Self {
        let until = parent.1;
        let marks: Vec<_> = self.marks.iter().filter(|m| m.simulation.sample() <= until).cloned().collect();
        let changes: Vec<_> = self.changes.iter().filter(|c| c.sample < until).cloned().collect();
        // The mark at time 0 is always there.
        let start = Rc::clone(marks.last().unwrap_or(&self.marks[0]));
        let mut branch = Self {
            name,
            parent: Some(parent),
            changes: Vec::new(),
            simulation: start.simulation.save(),
            digest: start.digest.clone(),
            marks,
            mark_every: self.mark_every,
        };
        while branch.simulation.sample() < until {
            let sample = branch.simulation.sample();
            if let Some(change) = changes.iter().find(|change| change.sample == sample) {
                // It was built before, when it was made.
                let _ = branch.take(change);
            }
            let Some(moment) = branch.simulation.next_moment() else { break };
            branch.digest.push(moment);
        }
        Self { changes, ..branch }
    }

    /// Digest of all samples so far.
    pub fn digest(&self) -> String {
        self.digest.text()
    }

    /// The run as it stands, before its next sample.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// A copy of the run as it stands: it goes on to the same future.
    pub fn copy(&self) -> Simulation {
        self.simulation.save()
    }
}

/// The scene as its own script has made it by `time` s.
fn scripted(base: &Arc<Scene>, time: f64) -> &Scene {
    let due = base.changes.iter().rfind(|change| change.at <= time + 1e-9);
    due.map_or(base, |change| &change.then)
}

/// A scene with overrides.
fn with(scene: &Scene, set: &[String]) -> Result<Arc<Scene>, String> {
    let set: Vec<Override> = set.iter().filter_map(|set| set.parse().ok()).collect();
    let scene = Scene { changes: Vec::new(), ..scene.clone() };
    let loaded = Scene::parse(&scene.to_toml(), "scene.toml", &set).map_err(|faults| faults.to_string())?;
    Ok(Arc::new(loaded.scene))
}

/// The text of a scene that runs as a branch ran: `base` with the branch's changes, for `duration` s.
///
/// # Errors
/// Why the text cannot be edited, in words.
pub fn script(base: &str, changes: &[Change], duration: f64) -> Result<String, String> {
    let fault = |error: scene::EditError| error.to_string();
    let mut text = SceneText::parse(base).map_err(fault)?;
    text.set("time.duration", &format!("{duration:?}")).map_err(fault)?;
    if let Some(first) = changes.first() {
        // From there on the hand held, not the script.
        for item in (0..text.count("changes")).rev() {
            let at = text.get(&format!("changes.{item}.at")).and_then(|at| at.parse::<f64>().ok());
            if at.is_some_and(|at| at > first.time + 1e-9) {
                text.remove_item("changes", &item.to_string()).map_err(fault)?;
            }
        }
    }
    for change in changes {
        let set: Vec<String> = change.set.iter().map(|set| format!("    {set:?},\n")).collect();
        let item = format!("at = {:?}\nset = [\n{}]\n", change.time, set.concat());
        text.add_table("changes", &item).map_err(fault)?;
    }
    Ok(text.text())
}
