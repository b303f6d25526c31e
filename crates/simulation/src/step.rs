//! One step of a simulation. New here? This is the page to read first.

use crate::continuous::Continuous;
use crate::fault::{Fault, not_finite};
use crate::parameters::{ParameterSet, ScheduledChange, sample_at, wakes};
use crate::sensing::SensingPipeline;
use formation::{Estimate, Formation, FormationState, LawKind};
use perception::sensors::SensorConfig;
use std::collections::VecDeque;
use std::f64::consts::PI;
use std::sync::Arc;
use vocabulary::{
    CameraRenderer, Contact, EdgeState, FleetInfo, MeasurementRecord, Observation, Relative, StepRecord, wrap,
};
use world::{Physical, Unicycles, World, WorldSetup};

/// How law and observer act in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Timing {
    /// Law and observer act in continuous time.
    Continuous,
    /// The law is held over a period; the observer sees the plant in between.
    Sampled,
    /// As sampled, but the observer sees samples only.
    Measured,
}

/// A run put together, before its first step.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Names, bodies and edges.
    pub fleet: FleetInfo,
    /// Graph, laws, set points, lead motions.
    pub formation: Formation,
    /// Robots, props and ground at the start.
    pub stage: WorldSetup,
    /// Where observers start: added to the first measurement [m, rad], or in its place.
    pub observer_starts: Vec<ObserverStart>,
    /// How followers sense their leaders; `None` where all are told the truth.
    pub sensor_config: Option<Arc<SensorConfig>>,
    /// How law and observer act in time.
    pub timing: Timing,
    /// Whether the run ends where bodies touch.
    pub stop_at_contact: bool,
    /// Control period, s.
    pub period: f64,
    /// Length of the run, s.
    pub duration: f64,
    /// What changes on the way, in the order of time.
    pub changes: Vec<ScheduledChange>,
}

/// Where the observer of one edge starts, [m, rad].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ObserverStart {
    /// The first measurement plus this.
    Offset([f64; 2]),
    /// Here.
    At([f64; 2]),
}

/// A run under way. The same setup gives the same moments, bit for bit.
pub struct Simulation {
    pub(crate) fleet: FleetInfo,
    pub(crate) formation: Formation,
    pub(crate) state: FormationState,
    pub(crate) plant: Plant,
    pub(crate) timing: Timing,
    pub(crate) period: f64,
    pub(crate) observations: Vec<Observation>,
    pub(crate) sensing: Option<SensingPipeline>,
    pub(crate) frames: Vec<MeasurementRecord>,
    pub(crate) record: StepRecord,
    /// The moment before, over which the next is written.
    pub(crate) spare: StepRecord,
    pub(crate) sample: u64,
    pub(crate) last_sample: u64,
    pub(crate) stop_at_contact: bool,
    pub(crate) stopped: bool,
    pub(crate) fault: Option<Fault>,
    /// What is to change, and at which sample.
    pub(crate) changes: VecDeque<(u64, Arc<ParameterSet>)>,
    /// What changes at the next sample.
    pub(crate) adopted: Option<Arc<ParameterSet>>,
}

/// What moves the robots: a world that is told commands to hold, or plant, law and observers as one system.
pub(crate) enum Plant {
    Held(Box<dyn World>),
    Continuous(Box<Continuous>),
}

impl Simulation {
    /// A run at time 0, nothing evaluated yet.
    pub fn new(setup: Setup) -> Self {
        let edges = setup.formation.edges().len();
        let plant = Plant::new(setup.stage, setup.timing, &setup.formation);
        let world = plant.world();
        let mut observations = Vec::with_capacity(edges);
        perception::observe(world.snapshot(), setup.formation.edges(), &mut observations);
        let start = |(o, s): (&Observation, &ObserverStart)| first_estimate(&o.relative, *s);
        let state =
            setup.formation.start(observations.iter().zip(&setup.observer_starts).map(start).collect());
        let record = StepRecord {
            snapshot: world.snapshot().clone(),
            edges: vec![EdgeState::default(); edges],
            ..StepRecord::default()
        };
        let changes = pending(&setup.changes, setup.period);
        let sensing = setup.sensor_config.map(|sensor_config| {
            SensingPipeline::new(sensor_config, setup.observer_starts.clone(), world.snapshot())
        });
        Self {
            fleet: setup.fleet,
            formation: setup.formation,
            state,
            plant,
            timing: setup.timing,
            period: setup.period,
            observations,
            sensing,
            frames: Vec::new(),
            spare: record.clone(),
            record,
            sample: 0,
            last_sample: sample_at(setup.duration, setup.period),
            stop_at_contact: setup.stop_at_contact,
            stopped: false,
            fault: None,
            changes,
            adopted: None,
        }
    }

    /// The next control sample: what is seen, what is decided, what is applied. `None` when the run is over.
    pub fn next_record(&mut self) -> Option<&StepRecord> {
        if self.sample > self.last_sample || self.stopped || self.fault.is_some() {
            return None;
        }
        if self.sample > 0 {
            self.advance();
        }
        let time = self.sample as f64 * self.period;
        let woken = self.change_over();
        let snapshot = self.plant.world().snapshot();
        perception::observe(snapshot, self.formation.edges(), &mut self.observations);
        for edge in woken {
            self.state.estimates[edge] = Estimate::at(&self.observations[edge].relative);
        }
        if let Err(fault) = self.look(time) {
            self.fault = Some(Fault::CameraRenderer(fault));
            return None;
        }
        self.formation.decide(time, &self.observations, &mut self.state);
        self.plant.world_mut().apply(&self.state.commands);
        std::mem::swap(&mut self.record, &mut self.spare);
        self.write_moment(time);
        self.fault = not_finite(&self.record, &self.fleet).map(Fault::NotFinite);
        if self.fault.is_some() {
            std::mem::swap(&mut self.record, &mut self.spare);
            return None;
        }
        self.stopped = self.stop_at_contact && self.record.contacts.iter().any(Contact::of_robot);
        self.sample += 1;
        Some(&self.record)
    }

    /// What changes at this sample takes hold; edges whose observers begin to run.
    fn change_over(&mut self) -> Vec<usize> {
        let mut woken = vec![];
        while let Some((_, parameters)) = self.changes.pop_front_if(|(sample, _)| *sample <= self.sample) {
            self.take_over(&parameters, &mut woken);
        }
        if let Some(parameters) = self.adopted.take() {
            self.take_over(&parameters, &mut woken);
        }
        woken
    }

    fn take_over(&mut self, parameters: &ParameterSet, woken: &mut Vec<usize>) {
        let pairs = self.formation.laws().iter().zip(&parameters.laws).enumerate();
        woken.extend(pairs.filter(|(_, (before, after))| wakes(before, after)).map(|(edge, _)| edge));
        let limits = parameters.handling.iter().map(|handling| handling.limits).collect();
        self.formation.apply_parameters(parameters.laws.clone(), limits);
        self.plant.apply_parameters(parameters, &self.formation);
    }

    /// Followers that are not told the truth look, and know what has arrived.
    fn look(&mut self, time: f64) -> Result<(), String> {
        let Some(sensing) = &mut self.sensing else { return Ok(()) };
        sensing.look(&self.formation, self.plant.world(), time, &mut self.frames)?;
        sensing.tell(self.formation.laws(), &mut self.observations, &mut self.state.estimates);
        Ok(())
    }

    /// Robots drive one period on, and observers with them.
    fn advance(&mut self) {
        if let Some(sensing) = &mut self.sensing {
            let time = (self.sample - 1) as f64 * self.period;
            sensing.begin(self.plant.world().snapshot(), time, self.period);
        }
        match &mut self.plant {
            Plant::Held(world) => {
                world.advance(self.period);
                let world: &dyn World = world.as_ref();
                match self.timing {
                    Timing::Measured => self.follow_samples(),
                    _ => follow(&self.formation, &mut self.state, world),
                }
                if let Some(sensing) = &mut self.sensing {
                    sensing.follow(&self.formation, self.plant.world(), self.period);
                }
            }
            Plant::Continuous(system) => {
                let time = (self.sample - 1) as f64 * self.period;
                system.advance(&self.formation, &mut self.state, time, self.period);
            }
        }
    }

    /// Observers that have seen samples only catch up with the period that has passed.
    fn follow_samples(&mut self) {
        let world = self.plant.world();
        for (index, edge) in self.formation.edges().iter().enumerate() {
            let law = &self.formation.laws()[index];
            if law.law.kind != LawKind::OutputFeedback || law.looks.is_some() {
                continue;
            }
            let mut before = perception::sample(world, *edge, 0.0, None);
            let after = perception::sample(world, *edge, self.period, None);
            before.acceleration = (after.own_speed - before.own_speed) / self.period;
            let estimate = &mut self.state.estimates[index];
            *estimate = law.observer.follow_samples(estimate, &before, &after.relative, self.period);
        }
    }

    /// Truth beside what was decided on it.
    fn write_moment(&mut self, time: f64) {
        self.record.snapshot.clone_from(self.plant.world().snapshot());
        self.record.snapshot.time = time;
        self.record.contacts.clear();
        self.record.contacts.extend_from_slice(self.plant.world().contacts());
        self.record.frames.clone_from(&self.frames);
        for (index, (edge, out)) in self.formation.edges().iter().zip(&mut self.record.edges).enumerate() {
            let robots = &mut self.record.snapshot.robots;
            let relative =
                Relative::between(robots[edge.leader].motion.pose, robots[edge.follower].motion.pose);
            let decision = &self.state.decisions[index];
            let wanted = decision.set_point;
            let looks = self.sensing.as_ref().filter(|_| self.formation.laws()[index].looks.is_some());
            let (age, pan) = looks
                .map_or_else(|| (0.0, wrap(relative.view_angle - PI)), |sensing| sensing.age_and_pan(index));
            robots[edge.follower].camera_pan = pan;
            let known = &self.observations[index];
            *out = EdgeState {
                relative,
                seen: known.relative,
                sight: known.sight,
                age,
                set_point: wanted,
                error: [wanted[0] - relative.distance, wrap(wanted[1] - relative.bearing)],
                asked: decision.asked,
                applied: decision.applied,
                rates: decision.rates,
                estimate: self.state.estimates[index].output,
                limited: decision.limited,
                too_close: decision.too_close,
            };
        }
    }

    /// Names, bodies and edges of the run.
    pub fn fleet(&self) -> &FleetInfo {
        &self.fleet
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
        self.sensing.as_ref().is_some_and(SensingPipeline::need_eyes)
    }

    /// Who draws what the cameras on robots see.
    pub fn attach_cameras(&mut self, eyes: Box<dyn CameraRenderer>) {
        if let Some(sensing) = &mut self.sensing {
            sensing.open(eyes);
        }
    }

    /// Why the run ended before its time, where it did so of itself.
    pub fn fault(&self) -> Option<&Fault> {
        self.fault.as_ref()
    }

    /// Never: a run has at least its first sample.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Control period, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// When plant, law and observer act.
    pub fn timing(&self) -> Timing {
        self.timing
    }
}

impl Plant {
    /// Unicycles on an empty plane are moved exactly; all else is moved by forces.
    fn new(stage: WorldSetup, timing: Timing, formation: &Formation) -> Self {
        let ideal = stage.props.is_empty()
            && stage.terrain.is_none()
            && stage.actors.iter().all(|a| a.wheels.is_none());
        if !ideal && timing != Timing::Continuous {
            return Self::Held(Box::new(Physical::new(stage)));
        }
        let world = Unicycles::new(stage.actors.into_iter().map(|actor| actor.robot).collect());
        match timing {
            Timing::Continuous => Self::Continuous(Box::new(Continuous::new(world, formation))),
            Timing::Sampled | Timing::Measured => Self::Held(Box::new(world)),
        }
    }

    /// Robots have the limits of `parameters` from now on, and laws are those of `formation`.
    fn apply_parameters(&mut self, parameters: &ParameterSet, formation: &Formation) {
        self.world_mut().apply_parameters(&parameters.handling);
        if let Self::Continuous(system) = self {
            system.keep_pace(formation);
        }
    }

    pub(crate) fn save(&self) -> Self {
        match self {
            Self::Held(world) => Self::Held(world.save()),
            Self::Continuous(system) => Self::Continuous(system.clone()),
        }
    }

    fn world(&self) -> &dyn World {
        match self {
            Self::Held(world) => world.as_ref(),
            Self::Continuous(system) => system.world(),
        }
    }

    fn world_mut(&mut self) -> &mut dyn World {
        match self {
            Self::Held(world) => world.as_mut(),
            Self::Continuous(system) => system.world_mut(),
        }
    }
}

/// Observers that see the plant without interruption follow it through the period.
fn follow(formation: &Formation, state: &mut FormationState, world: &dyn World) {
    for (index, edge) in formation.edges().iter().enumerate() {
        let law = &formation.laws()[index];
        if law.law.kind == LawKind::OutputFeedback && law.looks.is_none() {
            let estimate = &mut state.estimates[index];
            perception::tracks(world, *edge, |track| *estimate = law.observer.follow(estimate, track));
        }
    }
}

fn first_estimate(seen: &Relative, start: ObserverStart) -> Estimate {
    let output = match start {
        ObserverStart::Offset([distance, bearing]) => [seen.distance + distance, seen.bearing + bearing],
        ObserverStart::At(at) => at,
    };
    Estimate { output, rates: [0.0; 2] }
}

/// Changes by the samples at which they take hold.
pub(crate) fn pending(changes: &[ScheduledChange], period: f64) -> VecDeque<(u64, Arc<ParameterSet>)> {
    let turn = |turn: &ScheduledChange| (sample_at(turn.at, period), Arc::new(turn.parameters.clone()));
    changes.iter().map(turn).collect()
}
