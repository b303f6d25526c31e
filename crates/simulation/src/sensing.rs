//! Followers with sensors: what they measure, when it reaches them, and what they make of it.

use formation::{EdgeLaw, Estimate, Formation, Own, Tracker};
use perception::sensors::{LeaderPrediction, SensorConfig, SensorState};
use std::sync::{Arc, Mutex, PoisonError};
use vocabulary::{
    CameraRenderer, Edge, MeasurementRecord, Observation, ObserverStart, Outcome, Relative, Snapshot,
    StepInterpolant, TrackingState,
};
use world::World;

/// Sensors, estimates and camera renderer of all followers with sensors.
#[derive(Clone)]
pub(crate) struct SensingPipeline {
    pub(crate) sensor_config: Arc<SensorConfig>,
    sensor_state: SensorState,
    trackers: Vec<Tracker>,
    beliefs: Vec<LeaderPrediction>,
    starts: Vec<ObserverStart>,
    /// Where followers were told that their new leaders are, until they see them.
    told: Vec<Option<Relative>>,
    /// Everything as it was a period ago.
    before: Snapshot,
    /// Shared by copies of a run, which take turns.
    eyes: Option<Arc<Mutex<Box<dyn CameraRenderer>>>>,
}

impl SensingPipeline {
    pub(crate) fn new(
        sensor_config: Arc<SensorConfig>,
        starts: Vec<ObserverStart>,
        snapshot: &Snapshot,
    ) -> Self {
        let edges = sensor_config.sensors.len();
        Self {
            sensor_state: sensor_config.start(snapshot),
            trackers: vec![Tracker::default(); edges],
            beliefs: vec![LeaderPrediction { relative: None, sight: TrackingState::Waiting }; edges],
            starts,
            told: vec![None; edges],
            before: snapshot.clone(),
            eyes: None,
            sensor_config,
        }
    }

    pub(crate) fn open(&mut self, eyes: Box<dyn CameraRenderer>) {
        self.eyes = Some(Arc::new(Mutex::new(eyes)));
    }

    /// The follower of an edge looks for another leader from now on, which it was told to be at `relative`.
    pub(crate) fn change_leader(&mut self, edge: usize, leader: usize, relative: Relative) {
        let config = Arc::make_mut(&mut self.sensor_config);
        config.change_leader(&mut self.sensor_state, edge, leader);
        self.trackers[edge].change_leader();
        (self.starts[edge], self.told[edge]) = (ObserverStart::Measured, Some(relative));
    }

    /// Remembers everything as it is before a period, and turns the cameras for it.
    pub(crate) fn begin(&mut self, snapshot: &Snapshot, time: f64, period: f64) {
        self.before.clone_from(snapshot);
        self.before.time = time;
        self.sensor_config.turn_cameras(&mut self.sensor_state, &self.beliefs, period);
    }

    /// Carries estimates on over a period that has passed, by what the followers themselves did in it.
    pub(crate) fn follow(&mut self, formation: &Formation, world: &dyn World, period: f64) {
        for ((edge, law), tracker) in formation.edges().iter().zip(formation.laws()).zip(&mut self.trackers) {
            if let Some(parameters) = &law.tracker {
                tracker.advance(parameters, own_motion(world, *edge, period), period);
            }
        }
        self.believe(formation);
    }

    /// Takes the measurements that are due by `time`, and puts those that have arrived into the estimates; `frames` are
    /// theirs.
    pub(crate) fn measure(
        &mut self,
        formation: &Formation,
        world: &dyn World,
        time: f64,
        frames: &mut Vec<MeasurementRecord>,
    ) -> Result<(), String> {
        let mut now = world.snapshot().clone();
        now.time = time;
        {
            let mut eyes = self.eyes.as_ref().map(|eyes| eyes.lock().unwrap_or_else(PoisonError::into_inner));
            let eyes = eyes.as_mut().map(|eyes| eyes.as_mut() as &mut dyn CameraRenderer);
            let period = [&self.before, &now];
            self.sensor_config.take_measurements(
                &mut self.sensor_state,
                period,
                world as &dyn StepInterpolant,
                &self.beliefs,
                eyes,
            )?;
        }
        frames.clear();
        for (index, law) in formation.laws().iter().enumerate() {
            for mut frame in SensorConfig::arrived(&mut self.sensor_state, index, time) {
                put(&mut self.trackers[index], law, &mut frame, self.starts[index]);
                frames.push(frame);
            }
        }
        self.believe(formation);
        Ok(())
    }

    fn believe(&mut self, formation: &Formation) {
        let trackers = self.trackers.iter().zip(&self.told);
        for ((belief, (tracker, told)), law) in self.beliefs.iter_mut().zip(trackers).zip(formation.laws()) {
            let (relative, sight) = match &law.tracker {
                Some(parameters) => (tracker.relative().or(*told), tracker.sight(parameters)),
                None => (None, TrackingState::Truth),
            };
            *belief = LeaderPrediction { relative, sight };
        }
    }

    /// What followers with sensors know, in place of the truth in `observations`, and their estimates.
    pub(crate) fn tell(
        &self,
        laws: &[EdgeLaw],
        observations: &mut [Observation],
        estimates: &mut [Estimate],
    ) {
        for (index, law) in laws.iter().enumerate() {
            let Some(parameters) = &law.tracker else { continue };
            let (belief, seen) = (&self.beliefs[index], &mut observations[index]);
            seen.leader_speed = None;
            seen.sight = belief.sight;
            seen.relative = belief
                .relative
                .unwrap_or(Relative { distance: parameters.observer.distance_min, ..Relative::default() });
            estimates[index] = self.trackers[index].output(parameters, &law.law.heading, seen.own_heading);
        }
    }

    /// Time since the measurement that an edge's estimate rests on, s, and where the follower's camera points.
    pub(crate) fn age_and_pan(&self, edge: usize) -> (f64, f64) {
        (self.trackers[edge].age(), self.sensor_config.pan(&self.sensor_state, edge))
    }
}

/// Puts a measurement into an estimate.
fn put(tracker: &mut Tracker, law: &EdgeLaw, frame: &mut MeasurementRecord, start: ObserverStart) {
    let (Some(parameters), Outcome::Used) = (&law.tracker, frame.outcome) else { return };
    let first = tracker.relative().is_none();
    frame.outcome = tracker.take(parameters, &frame.measurement);
    let (true, Some(seen)) = (first, tracker.relative()) else { return };
    match start {
        ObserverStart::Measured | ObserverStart::Offset([0.0, 0.0]) => {}
        ObserverStart::Offset(offset) => tracker.disturb(offset),
        ObserverStart::At([distance, bearing]) => {
            tracker.disturb([distance - seen.distance, vocabulary::wrap(bearing - seen.bearing)]);
        }
    }
}

/// A follower's motion over the period by odometry: the mean acceleration and turn rate.
fn own_motion(world: &dyn World, edge: Edge, period: f64) -> Own {
    let (before, after) = (world.during(edge.follower, 0.0), world.during(edge.follower, period));
    let turned = vocabulary::wrap(after.pose.heading - before.pose.heading);
    Own {
        speed: before.speed,
        acceleration: (after.speed - before.speed) / period,
        turn_rate: turned / period,
    }
}
