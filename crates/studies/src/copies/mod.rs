//! Many copies of a scene side by side, whose followers are driven from outside: what learning needs.
//!
//! A copy goes on by one action at a time. Between two calls every copy stands at a sample that its followers have sensed and
//! have not decided on. What becomes of a copy depends on its own episode and actions alone, so it is the same for any number
//! of copies and threads.

mod observation_column;
mod scatter;

pub use observation_column::ObservationColumn;
pub use scatter::{Episode, StartScatter};

use crate::Error;
use formation::AgentAction;
use laws::INPUTS;
use rayon::ThreadPool;
use rayon::prelude::*;
use scene::Scene;
use simulation::{Simulation, build};
use thiserror::Error;
use vocabulary::{Command, EntityId, FleetInfo, StepRecord};

/// What goes for all copies.
#[derive(Debug, Clone, PartialEq)]
pub struct CopyConfig {
    /// Those who are driven from outside.
    pub agents: Vec<Agent>,
    /// What each of them observes.
    pub columns: Vec<ObservationColumn>,
    /// Whether actions are added to what laws ask for; else they take the place of the laws.
    pub residual: bool,
    /// Control samples for which an action holds, 1 or more.
    pub samples: u64,
    /// Where robots start.
    pub scatter: StartScatter,
    /// What pictures say of the laws.
    pub caption: Option<String>,
}

/// A follower that is driven from outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agent {
    /// Number of the robot.
    pub robot: usize,
    /// Number of its edge; the first, where it has several leaders.
    pub edge: usize,
    /// What an action of 1 is, acceleration in m/s² and turn rate in rad/s.
    pub scale: Command,
}

/// True numbers of every agent at a sample, from which rewards are made. Names end in units.
pub const SIGNALS: [&str; 9] = [
    "error_distance_m",
    "error_bearing_rad",
    "acceleration_m_s2",
    "turn_rate_rad_s",
    "speed_m_s",
    "x_m",
    "y_m",
    "heading_rad",
    "touches",
];

/// Numbers of an action.
pub const ACTION: usize = 2;

/// How a copy goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CopyStatus {
    /// It has no episode yet.
    #[default]
    Blank,
    /// It takes actions.
    Running,
    /// Its last sample is reached.
    TimeUp,
    /// Robots touched, and the scene stops then.
    Stopped,
}

/// Takes the records of a copy.
pub trait CopySink: Send {
    /// The next record.
    fn take(&mut self, record: &StepRecord);
}

/// What a step of the copies comes to; one entry after the other in every slice.
pub struct Outcome<'a> {
    /// Copies × agents × columns.
    pub observations: &'a mut [f64],
    /// Copies × agents × [`SIGNALS`].
    pub signals: &'a mut [f64],
    /// Per copy.
    pub progress: &'a mut [CopyStatus],
}

/// Why a copy did not go on. Where there is one copy only, its fault says it all.
#[derive(Debug, Error)]
#[error("copy {copy}: {fault}")]
pub struct CopyError {
    /// Number of the copy.
    pub copy: usize,
    /// What is wrong with it.
    pub fault: CopyFault,
}

/// What is wrong with a copy.
#[derive(Debug, Error)]
pub enum CopyFault {
    /// An action is no finite number.
    #[error("the {what} of `{robot}` is {value}: an action is a finite number, −1 to 1")]
    NotFinite {
        /// The agent.
        robot: String,
        /// Which of the two numbers.
        what: &'static str,
        /// What it is.
        value: f64,
    },
    /// It takes no actions: its episode has ended or has not begun.
    #[error("its episode {0}: reset it first")]
    NotRunning(&'static str),
    /// Its run broke off.
    #[error("{0}")]
    Broken(Error),
}

impl CopyFault {
    fn of(self, copy: usize) -> CopyError {
        CopyError { copy, fault: self }
    }
}

/// One copy.
struct Copied<S> {
    simulation: Simulation,
    sink: S,
    actions: Vec<(usize, AgentAction)>,
    /// Per agent: whether it touched something since the last action.
    touches: Vec<bool>,
}

/// A copy's place among the others.
struct CopySlot<S> {
    copied: Option<Copied<S>>,
    progress: CopyStatus,
}

/// Copies of a scene.
pub struct Copies<S> {
    scene: Scene,
    config: CopyConfig,
    slots: Vec<CopySlot<S>>,
    /// Makes what takes the records of an episode.
    sink: Box<dyn Fn(&FleetInfo) -> S + Send + Sync>,
    pool: Option<ThreadPool>,
}

/// Copies from which on threads share the work: waking them costs more than a few steps.
const SHARED_FROM: usize = 16;
/// Copies that a thread takes at a time.
const SHARE: usize = 8;

impl<S: CopySink> Copies<S> {
    /// So many copies of `scene`, none of which has an episode yet. `pool` shares the work, or rayon's own where there is none.
    pub fn new(
        scene: Scene,
        config: CopyConfig,
        count: usize,
        pool: Option<ThreadPool>,
        sink: impl Fn(&FleetInfo) -> S + Send + Sync + 'static,
    ) -> Self {
        let slots = (0..count).map(|_| CopySlot { copied: None, progress: CopyStatus::Blank }).collect();
        Self { scene, config, slots, sink: Box::new(sink), pool }
    }

    /// What goes for all copies.
    pub fn config(&self) -> &CopyConfig {
        &self.config
    }

    /// Number of copies.
    pub fn len(&self) -> usize {
        self.slots.len()
    }

    /// Whether there are no copies.
    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// What takes the records of a copy, and its simulation; `None` before its first episode.
    pub fn copy(&self, copy: usize) -> Option<(&Simulation, &S)> {
        let copied = self.slots.get(copy)?.copied.as_ref()?;
        Some((&copied.simulation, &copied.sink))
    }

    /// The record that the sample at which a copy stands would have with its last actions; `None` before its first episode.
    pub fn outlook(&self, copy: usize) -> Option<StepRecord> {
        let Copied { simulation, actions, .. } = self.slots.get(copy)?.copied.as_ref()?;
        let mut ahead = simulation.save();
        ahead.act(actions.iter().copied());
        Some(ahead.record().clone())
    }

    /// Begins a new episode in the copies for which there is one; the others stay as they are.
    ///
    /// # Errors
    /// [`CopyFault::Broken`] where a copy cannot begin.
    pub fn reset(&mut self, episodes: &[Option<Episode>]) -> Result<(), CopyError> {
        let Self { scene, config, slots, sink, pool } = self;
        let begun = slots.iter_mut().zip(episodes).enumerate();
        let begun = begun.filter_map(|(copy, (slot, episode))| Some((copy, slot, (*episode)?)));
        share(pool.as_ref(), begun.collect(), |(copy, slot, episode)| {
            slot.progress = CopyStatus::Blank;
            let copied = Copied::begin(scene.clone(), config, episode, sink);
            slot.copied = Some(copied.map_err(|error| CopyFault::Broken(error).of(copy))?);
            slot.progress = CopyStatus::Running;
            Ok(())
        })
    }

    /// Drives every copy on by one action, copies × agents × [`ACTION`], each −1 to 1 and cut there; those that are `idle` stay
    /// as they are. `outcome` is that of all.
    ///
    /// # Errors
    /// [`CopyError`]; of several, that of any copy.
    pub fn step(&mut self, actions: &[f64], idle: &[bool], outcome: Outcome<'_>) -> Result<(), CopyError> {
        let names: Vec<&str> =
            self.config.agents.iter().map(|agent| &*self.scene.robots[agent.robot].name).collect();
        check(actions, idle, &names)?;
        let per_copy = ACTION * self.config.agents.len();
        self.each(outcome, |config, copy, slot| {
            if idle[copy] {
                return Ok(());
            }
            let own = &actions[copy * per_copy..(copy + 1) * per_copy];
            slot.step(config, own).map_err(|fault| fault.of(copy))
        })
    }

    /// What all agents observe, as they stand.
    ///
    /// # Errors
    /// [`CopyFault::NotRunning`] where a copy has no episode.
    pub fn observe(&mut self, outcome: Outcome<'_>) -> Result<(), CopyError> {
        self.each(outcome, |_, _, _| Ok(()))
    }

    /// What the laws of all agents are told as they stand: a row for each of [`INPUTS`], copies × agents.
    ///
    /// # Errors
    /// [`CopyFault::NotRunning`] where a copy has no episode.
    pub fn told(&self) -> Result<Vec<f64>, CopyError> {
        let agents = self.config.agents.len();
        let mut rows = vec![0.0; INPUTS.len() * self.slots.len() * agents];
        for (copy, slot) in self.slots.iter().enumerate() {
            let copied = slot.copied.as_ref().ok_or_else(|| CopyFault::NotRunning(BLANK).of(copy))?;
            for (place, agent) in self.config.agents.iter().enumerate() {
                let at = copy * agents + place;
                let columns = rows.iter_mut().skip(at).step_by(self.slots.len() * agents);
                copied.simulation.told(agent.edge, |input, _| {
                    for (number, (kind, ..)) in columns.zip(&INPUTS) {
                        *number = input.value(0, *kind);
                    }
                });
            }
        }
        Ok(rows)
    }

    /// Does `work` with every copy and writes what it came to.
    fn each(
        &mut self,
        outcome: Outcome<'_>,
        work: impl Fn(&CopyConfig, usize, &mut CopySlot<S>) -> Result<(), CopyError> + Send + Sync,
    ) -> Result<(), CopyError> {
        let Self { config, slots, pool, .. } = self;
        let Outcome { observations, signals, progress } = outcome;
        let agents = config.agents.len();
        let [wide, told] = [config.columns.len(), SIGNALS.len()].map(|columns| (columns * agents).max(1));
        let rows = slots.iter_mut().zip(observations.chunks_mut(wide)).zip(signals.chunks_mut(told));
        let rows = rows.zip(progress).enumerate();
        let rows = rows.map(|(copy, (((slot, seen), signals), progress))| CopyRow {
            copy,
            slot,
            seen,
            signals,
            progress,
        });
        share(pool.as_ref(), rows.collect(), |row| {
            work(config, row.copy, row.slot)?;
            *row.progress = row.slot.progress;
            row.slot.write(config, row.seen, row.signals).map_err(|fault| fault.of(row.copy))
        })
    }
}

/// A copy, and where what it comes to is written.
struct CopyRow<'a, S> {
    copy: usize,
    slot: &'a mut CopySlot<S>,
    seen: &'a mut [f64],
    signals: &'a mut [f64],
    progress: &'a mut CopyStatus,
}

/// Does `work` with each of `items`, on the threads of `pool` or rayon's own where there are many.
fn share<T: Send>(
    pool: Option<&ThreadPool>,
    items: Vec<T>,
    work: impl Fn(T) -> Result<(), CopyError> + Send + Sync,
) -> Result<(), CopyError> {
    if items.len() < SHARED_FROM {
        return items.into_iter().try_for_each(work);
    }
    let all = || items.into_par_iter().with_min_len(SHARE).try_for_each(work);
    match pool {
        Some(pool) => pool.install(all),
        None => all(),
    }
}

/// Refuses actions that are no finite numbers.
fn check(actions: &[f64], idle: &[bool], names: &[&str]) -> Result<(), CopyError> {
    let bad = |(index, value): &(usize, &f64)| !value.is_finite() && !idle[index / (ACTION * names.len())];
    match actions.iter().enumerate().find(bad) {
        None => Ok(()),
        Some((index, value)) => {
            let fault = CopyFault::NotFinite {
                robot: names[index / ACTION % names.len()].to_owned(),
                what: ["acceleration", "turn rate"][index % ACTION],
                value: *value,
            };
            Err(fault.of(index / (ACTION * names.len())))
        }
    }
}

/// What is the matter with a copy that has no episode.
const BLANK: &str = "has not begun";

impl<S: CopySink> CopySlot<S> {
    fn step(&mut self, config: &CopyConfig, actions: &[f64]) -> Result<(), CopyFault> {
        let why = match (self.progress, &mut self.copied) {
            (CopyStatus::Running, Some(copied)) => {
                self.progress = copied.step(config, actions).map_err(CopyFault::Broken)?;
                return Ok(());
            }
            (CopyStatus::TimeUp, _) => "has come to its end",
            (CopyStatus::Stopped, _) => "has stopped at a contact",
            _ => BLANK,
        };
        Err(CopyFault::NotRunning(why))
    }

    fn write(&self, config: &CopyConfig, seen: &mut [f64], signals: &mut [f64]) -> Result<(), CopyFault> {
        let copied = self.copied.as_ref().ok_or(CopyFault::NotRunning(BLANK))?;
        let columns = config.columns.len().max(1);
        let rows = seen.chunks_mut(columns).zip(signals.chunks_mut(SIGNALS.len()));
        for ((row, signals), (agent, touches)) in rows.zip(config.agents.iter().zip(&copied.touches)) {
            copied.simulation.told(agent.edge, |input, error| {
                for (number, column) in row.iter_mut().zip(&config.columns) {
                    *number = column.value(input);
                }
                copied.signals(agent, error, *touches, signals);
            });
        }
        Ok(())
    }
}

impl<S: CopySink> Copied<S> {
    fn begin(
        mut scene: Scene,
        config: &CopyConfig,
        episode: Episode,
        sink: &dyn Fn(&FleetInfo) -> S,
    ) -> Result<Self, Error> {
        config.scatter.scatter(&mut scene, episode)?;
        let mut simulation = Simulation::new(build(&scene)?);
        if let Some(caption) = &config.caption {
            simulation.set_caption(caption.clone());
        }
        let sink = sink(simulation.fleet());
        if !simulation.sense() {
            return Err(broken(&simulation));
        }
        let touches = vec![false; config.agents.len()];
        Ok(Self { simulation, sink, actions: vec![], touches })
    }

    fn step(&mut self, config: &CopyConfig, actions: &[f64]) -> Result<CopyStatus, Error> {
        let Self { simulation, sink, touches, .. } = self;
        touches.fill(false);
        self.actions.clear();
        self.actions.extend(config.agents.iter().zip(actions.chunks(ACTION)).map(|(agent, own)| {
            let [acceleration, turn_rate] = [0, 1].map(|which| own[which].clamp(-1.0, 1.0));
            let command = Command {
                acceleration: acceleration * agent.scale.acceleration,
                turn_rate: turn_rate * agent.scale.turn_rate,
            };
            let action =
                if config.residual { AgentAction::Added(command) } else { AgentAction::Instead(command) };
            (agent.robot, action)
        }));
        for _ in 0..config.samples {
            if !simulation.act(self.actions.iter().copied()) {
                return Err(broken(simulation));
            }
            sink.take(simulation.record());
            if !simulation.sense() {
                let stopped = simulation.fault().is_none();
                return if stopped { Ok(CopyStatus::Stopped) } else { Err(broken(simulation)) };
            }
            let contacts = simulation.contacts();
            if !contacts.is_empty() {
                for (touches, agent) in touches.iter_mut().zip(&config.agents) {
                    *touches |= contacts.iter().any(|c| c.things.contains(&EntityId::Robot(agent.robot)));
                }
            }
            if simulation.sample() + 1 >= simulation.len() {
                return Ok(CopyStatus::TimeUp);
            }
        }
        Ok(CopyStatus::Running)
    }

    fn signals(&self, agent: &Agent, [distance, bearing]: [f64; 2], touches: bool, out: &mut [f64]) {
        let simulation = &self.simulation;
        let motion = &simulation.snapshot().robots[agent.robot].motion;
        let applied = simulation.decision(agent.edge).applied;
        let numbers: [f64; SIGNALS.len()] = [
            distance,
            bearing,
            applied.acceleration,
            applied.turn_rate,
            motion.speed,
            motion.pose.x,
            motion.pose.y,
            motion.pose.heading,
            f64::from(touches),
        ];
        out.copy_from_slice(&numbers);
    }
}

/// Why a simulation went no further.
fn broken(simulation: &Simulation) -> Error {
    simulation.fault().map_or_else(|| Error::Usage("the run has no further sample".to_owned()), Error::from)
}

#[cfg(test)]
mod tests;
