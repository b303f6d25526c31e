//! A simulation: its state, its queries, and the changes that it takes between steps.

use crate::batch::{BatchError, BatchPipeline};
use crate::chase::Chases;
use crate::events::Events;
use crate::fault::Fault;
use crate::goals::Goals;
use crate::parameters::{ParameterSet, pending, sample_at};
use crate::plant::Plant;
use crate::safety::SafetyPipeline;
use crate::sensing::SensingPipeline;
use crate::setup::Setup;
use crate::step::{act, sense, step};
use formation::{AgentAction, Decision, EdgeLaw, Estimate, Formation, FormationState};
use laws::{BatchLaw, Input};
use std::collections::VecDeque;
use std::sync::Arc;
use vocabulary::{
    CameraRenderer, Contact, Edge, EdgeState, EntityId, FleetInfo, Limits, MeasurementRecord, Observation,
    ObserverStart, Relative, Snapshot, StepRecord, TimeMode, TrackingState,
};
use world::Handling;

/// A simulation. The same setup gives the same records, bit for bit.
#[derive(Clone)]
pub struct Simulation {
    pub(crate) fleet: FleetInfo,
    pub(crate) formation: Formation,
    pub(crate) state: FormationState,
    pub(crate) plant: Plant,
    pub(crate) mode: TimeMode,
    pub(crate) period: f64,
    pub(crate) observations: Vec<Observation>,
    pub(crate) sensing: Option<SensingPipeline>,
    pub(crate) safety: Option<SafetyPipeline>,
    /// A law that decides for many followers.
    pub(crate) batch: Option<BatchPipeline>,
    /// Robots that lead by commands.
    pub(crate) chases: Chases,
    /// Lead robots that have goals.
    pub(crate) goals: Goals,
    pub(crate) events: Events,
    /// Limits and drivers as they were set last.
    pub(crate) handling: Vec<Handling>,
    pub(crate) frames: Vec<MeasurementRecord>,
    pub(crate) record: StepRecord,
    /// The moment before, over which the next is written.
    pub(crate) spare: StepRecord,
    pub(crate) sample: u64,
    /// Whether the first half of the next step is done.
    pub(crate) sensed: bool,
    pub(crate) last_sample: u64,
    pub(crate) stop_at_contact: bool,
    pub(crate) stopped: bool,
    pub(crate) fault: Option<Fault>,
    /// What is to change, and at which sample.
    pub(crate) changes: VecDeque<(u64, Arc<ParameterSet>)>,
    /// What changes at the next sample.
    pub(crate) adopted: Option<Arc<ParameterSet>>,
}

impl Simulation {
    /// A run at time 0, nothing evaluated yet.
    pub fn new(setup: Setup) -> Self {
        let edges = setup.formation.edges().len();
        let handling = setup.stage.actors.iter();
        let handling = handling
            .map(|actor| Handling { limits: actor.robot.limits, wheels: actor.wheels.clone() })
            .collect();
        let plant = Plant::new(setup.stage, setup.mode, &setup.formation);
        let world = plant.world();
        let mut observations = Vec::with_capacity(edges);
        perception::observe(world.snapshot(), setup.formation.edges(), &mut observations);
        let known = observations.iter().zip(setup.formation.laws());
        let start = |((seen, law), start): ((&Observation, &EdgeLaw), &ObserverStart)| {
            let output = law.law.heading.output(&seen.relative, seen.own_heading);
            first_estimate(&output, seen.relative.bearing, *start)
        };
        let state = setup.formation.start(known.zip(&setup.observer_starts).map(start).collect());
        let record = StepRecord {
            snapshot: world.snapshot().clone(),
            edges: vec![EdgeState::default(); edges],
            ..StepRecord::default()
        };
        let changes = pending(&setup.changes, setup.period);
        let sensing = setup.sensor_config.map(|sensor_config| {
            SensingPipeline::new(sensor_config, setup.observer_starts.clone(), world.snapshot())
        });
        let safety =
            setup.safety_config.map(|config| SafetyPipeline::new(config, setup.filters, setup.period));
        Self {
            chases: Chases::new(&setup.chased),
            goals: setup.goals,
            events: Events::new(setup.events, setup.fleet.robots.len()),
            handling,
            fleet: setup.fleet,
            formation: setup.formation,
            state,
            plant,
            mode: setup.mode,
            period: setup.period,
            observations,
            sensing,
            safety,
            batch: None,
            frames: Vec::new(),
            spare: record.clone(),
            record,
            sample: 0,
            sensed: false,
            last_sample: sample_at(setup.duration, setup.period),
            stop_at_contact: setup.stop_at_contact,
            stopped: false,
            fault: None,
            changes,
            adopted: None,
        }
    }

    /// The next control sample: what is measured, what is decided, what is applied. `None` when the run is over.
    pub fn next_record(&mut self) -> Option<&StepRecord> {
        step(self).then_some(&self.record)
    }

    /// The first half of the next step: time goes on to its sample, and followers know what they know there, see
    /// [`Simulation::told`]. Their decisions are left to [`Simulation::act`]. False when the run is over.
    pub fn sense(&mut self) -> bool {
        sense(self)
    }

    /// The second half of a step: `actions` decide for the robots that they name, laws for the others. False when the run is
    /// over.
    pub fn act(&mut self, actions: impl IntoIterator<Item = (usize, AgentAction)>) -> bool {
        if !sense(self) {
            return false;
        }
        for (robot, action) in actions {
            self.state.set_action(robot, action);
        }
        act(self)
    }

    /// Hands to `read` what the law of edge number `edge` is told at the sample that [`Simulation::sense`] went on to, and its true
    /// tracking error, set point minus truth, [m, rad]. Motions of leaders are those of the sample before.
    pub fn told<R>(&self, edge: usize, read: impl FnOnce(&Input<'_>, [f64; 2]) -> R) -> R {
        let (time, seen) = (self.sample as f64 * self.period, &self.observations[edge]);
        if seen.sight == TrackingState::Truth {
            return self.formation.told(edge, time, seen, &self.state, read);
        }
        let Edge { leader, follower } = self.formation.edges()[edge];
        let robots = &self.snapshot().robots;
        let truth = Observation::true_of([leader, follower].map(|k| &robots[k].motion));
        let error = self.formation.true_error(edge, time, &truth, &self.state);
        self.formation.told(edge, time, seen, &self.state, |input, _| read(input, error))
    }

    /// Where everything is as of the last call of [`Simulation::sense`] or [`Simulation::next_record`].
    pub fn snapshot(&self) -> &Snapshot {
        self.plant.world().snapshot()
    }

    /// Contacts that are open or have ended in the last period.
    pub fn contacts(&self) -> &[Contact] {
        self.plant.world().contacts()
    }

    /// Pictures say this of the laws of the run.
    pub fn set_caption(&mut self, caption: String) {
        self.fleet.caption = caption;
    }

    /// Names, bodies and edges of the run.
    pub fn fleet(&self) -> &FleetInfo {
        &self.fleet
    }

    /// Lead robots that have goals, and how they get there.
    pub fn goals(&self) -> &Goals {
        &self.goals
    }

    /// Graph, laws and set points of the run.
    pub fn formation(&self) -> &Formation {
        &self.formation
    }

    /// Control samples in the whole run, the one at time 0 included.
    pub fn len(&self) -> u64 {
        self.last_sample + 1
    }

    /// Whether the run ended before its time because bodies touched.
    pub fn stopped(&self) -> bool {
        self.stopped
    }

    /// Whether cameras on robots take pictures, for which the run needs [`Simulation::attach_cameras`].
    pub fn needs_cameras(&self) -> bool {
        self.sensing.as_ref().is_some_and(|sensing| sensing.sensor_config.need_eyes())
    }

    /// Attaches the renderer of the cameras on robots.
    pub fn attach_cameras(&mut self, eyes: Box<dyn CameraRenderer>) {
        if let Some(sensing) = &mut self.sensing {
            sensing.open(eyes);
        }
    }

    /// Attaches a law that decides for `followers`, numbers of robots, in the place of their own laws; before the first step.
    ///
    /// # Errors
    /// [`BatchError`], naming the robot.
    pub fn attach_law(&mut self, law: Box<dyn BatchLaw>, followers: &[usize]) -> Result<(), BatchError> {
        let name = |robot: usize| self.fleet.name(EntityId::Robot(robot)).to_owned();
        if self.mode == TimeMode::Continuous {
            return Err(BatchError::Continuous);
        }
        if self.sample > 0 {
            return Err(BatchError::Begun(self.sample));
        }
        let mut decides_for = vec![false; self.fleet.robots.len()];
        for robot in followers {
            match self.fleet.edges_of(*robot).count() {
                0 => return Err(BatchError::Leads(name(*robot))),
                1 => decides_for[*robot] = true,
                _ => return Err(BatchError::SeveralLeaders(name(*robot))),
            }
        }
        self.fleet.caption = format!("law {}", law.name());
        let batch = BatchPipeline { law, decides_for };
        let mut laws = self.formation.laws().to_vec();
        batch.mark(self.formation.edges(), &mut laws);
        self.formation.apply_parameters(laws, self.limits());
        self.batch = Some(batch);
        Ok(())
    }

    /// Bounds of all robots.
    fn limits(&self) -> Vec<Limits> {
        (0..self.fleet.robots.len()).map(|robot| *self.formation.limits(robot)).collect()
    }

    /// Whether the last sample has been computed, or the run ended before it.
    pub fn is_over(&self) -> bool {
        self.sample > self.last_sample || self.stopped || self.fault.is_some()
    }

    /// Why the run ended before its time, if a fault ended it.
    pub fn fault(&self) -> Option<&Fault> {
        self.fault.as_ref()
    }

    /// Never: a run has at least its first sample.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// When plant, law and observer act.
    pub fn mode(&self) -> TimeMode {
        self.mode
    }

    /// What the law of edge number `edge` decided at the last sample.
    pub fn decision(&self, edge: usize) -> &Decision {
        &self.state.decisions[edge]
    }

    /// Control period, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// From the next sample on the laws, set points and limits of `setup` hold, until something else does. Poses, time,
    /// motions of lead robots and what observers believe stay; changes that are to come stay too. `setup` is that of a
    /// scene which this run's scene leads to while it goes, see [`scene::Scene::sets_to`]; any other is not taken.
    pub fn apply_parameters(&mut self, setup: &Setup) {
        let followers =
            |formation: &Formation| formation.edges().iter().map(|edge| edge.follower).collect::<Vec<_>>();
        let fits = followers(&setup.formation) == followers(&self.formation)
            && setup.fleet.robots.len() == self.fleet.robots.len();
        debug_assert!(fits, "the setup of another formation");
        if fits {
            self.adopted = Some(Arc::new(ParameterSet::of(setup)));
        }
    }

    /// The events of `setup` take the place of those that were to come; those that have happened are the first of both.
    pub fn replan(&mut self, setup: &Setup) {
        self.events.replan(setup.events.clone());
    }

    /// The changes of `setup` that are due at the next sample or later take the place of those that were to come.
    pub fn reschedule(&mut self, setup: &Setup) {
        self.changes = pending(&setup.changes, self.period);
        self.changes.retain(|(sample, _)| *sample >= self.sample);
        self.events.replan(setup.events.clone());
    }

    /// The last moment, as it was when it was computed.
    pub fn record(&self) -> &StepRecord {
        &self.record
    }

    /// Followers observe the true state from now on, whatever their sensors: for predictions, which draw no pictures.
    pub fn trust(&mut self) {
        self.sensing = None;
        let limits = self.limits();
        self.formation.apply_parameters(trusting(self.formation.laws()), limits);
        let told = |parameters: &ParameterSet| ParameterSet {
            laws: trusting(&parameters.laws),
            ..parameters.clone()
        };
        self.adopted = self.adopted.take().map(|parameters| Arc::new(told(&parameters)));
        for (_, parameters) in &mut self.changes {
            *parameters = Arc::new(told(parameters));
        }
    }

    /// How far beside the middle of a robot nothing else may be, m: the circle around its body, and what its filter keeps free
    /// beside that, which it does of the point ahead.
    pub(crate) fn room_beside(&self, robot: usize) -> f64 {
        let filter = self.filter(robot);
        self.fleet.robots[robot].body.radius()
            + filter.map_or(0.0, |filter| filter.margin + filter.point_ahead)
    }

    /// How far ahead of its middle the point is that the filter of a robot keeps clear of things, m.
    pub(crate) fn looks_ahead(&self, robot: usize) -> f64 {
        self.filter(robot).map_or(0.0, |filter| filter.point_ahead)
    }

    fn filter(&self, robot: usize) -> Option<safety::Parameters> {
        self.safety.as_ref().and_then(|safety| safety.filters[robot])
    }

    /// How far a robot senses what is near it, m; `None` where it does not.
    pub(crate) fn senses(&self, robot: usize) -> Option<f64> {
        self.safety.as_ref()?.range(robot)
    }

    /// Number of the next control sample, from 0; its time is this times the period.
    pub fn sample(&self) -> u64 {
        self.sample
    }

    /// Number of the first control sample at or after `time` s.
    pub fn sample_at(&self, time: f64) -> u64 {
        sample_at(time, self.period)
    }

    /// Goes on until `duration` s at least.
    pub fn extend_to(&mut self, duration: f64) {
        self.last_sample = self.last_sample.max(sample_at(duration, self.period));
        self.fleet.duration = self.fleet.duration.max(duration);
    }

    /// A copy of the whole run as it stands: it goes on to the same future, bit for bit.
    #[must_use]
    pub fn save(&self) -> Self {
        self.clone()
    }
}

/// The laws of followers that observe the true state.
fn trusting(laws: &[EdgeLaw]) -> Vec<EdgeLaw> {
    laws.iter().map(|law| EdgeLaw { tracker: None, ..law.clone() }).collect()
}

/// Where an observer starts whose first measurement is `output`; `bearing` is that from the leader's heading, by which
/// scenes say it.
fn first_estimate(output: &Relative, bearing: f64, start: ObserverStart) -> Estimate {
    let output = match start {
        ObserverStart::Measured => [output.distance, output.bearing],
        ObserverStart::Offset([distance, more]) => [output.distance + distance, output.bearing + more],
        ObserverStart::At([distance, at]) => [distance, at + (output.bearing - bearing)],
    };
    Estimate { output, rates: [0.0; 2] }
}
