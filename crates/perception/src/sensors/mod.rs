//! Measurements of leaders: who measures when, by which sensor, and when the follower has the result.
//!
//! A measurement is taken at its own instant, which need not be a control sample: robots are where they were at that
//! instant, cameras point where they pointed. What is seen is on its way for the sensor's latency. [`SensorConfig`] are
//! parameters, [`SensorState`] is their state.

mod camera;
mod geometric;
mod noise;
mod pan;
mod sightline;

use camera::CameraPipeline;
pub use camera::CameraSettings;
pub use geometric::{MARGIN, readable};
pub use noise::NoiseModel;
pub use sightline::Scenery;

use crate::imaging::{Purpose, noise_stream};
use crate::pose::{Prior, Rig, SeenFace, locate};
use pan::Pan;
use std::collections::{HashMap, VecDeque};
use vocabulary::{
    CameraRenderer, Edge, Measurement, MeasurementRecord, Outcome, Prop, Relative, RobotInfo, Snapshot,
    StepInterpolant, Terrain, TrackingState,
};

/// Where the measurements of one follower come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SensorKind {
    /// It is told the truth at every instant, and measures nothing.
    Truth,
    /// The truth with errors.
    Noise(NoiseModel),
    /// Corners of tags, calculated, with errors of this standard deviation in pixels; the pose from them.
    Geometric {
        /// Of each coordinate, pixels.
        pixel_noise: f64,
    },
    /// Pictures.
    Camera,
}

/// How one follower senses its leader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensor {
    /// Where its measurements come from.
    pub source: SensorKind,
    /// Measurements a second.
    pub rate: f64,
    /// From a measurement until the follower has it, s.
    pub latency: f64,
    /// Share of the measurements that never arrive.
    pub drop: f64,
    /// How far bodies are expected to tilt against each other, standard deviation, rad.
    pub tilt: f64,
}

/// Parameters of all followers' senses.
#[derive(Debug, Clone)]
pub struct SensorConfig {
    /// Who measures whom.
    pub edges: Vec<Edge>,
    /// The sensor of every edge.
    pub sensors: Vec<Sensor>,
    /// What robots are seen by and see with, in the order of the snapshots.
    pub robots: Vec<RobotInfo>,
    /// What may stand between them, in the order of the snapshots.
    pub props: Vec<Prop>,
    /// Uneven ground, if it is.
    pub terrain: Option<std::sync::Arc<Terrain>>,
    /// Settings of all cameras.
    pub camera: CameraSettings,
    /// Seed of the noise.
    pub seed: u64,
}

/// State of all followers' senses.
#[derive(Clone)]
pub struct SensorState {
    edges: Vec<EdgeWatch>,
    camera_pipeline: CameraPipeline,
}

/// State of one follower's senses.
#[derive(Debug, Clone)]
struct EdgeWatch {
    /// Whose random numbers its errors are, beside the seed.
    stream: usize,
    /// Measurements taken so far.
    taken: u64,
    pan: Pan,
    /// Slowly changing errors of the noisy truth.
    drift: noise::Drift,
    /// Whether the leader was recognised in the last measurement.
    seen: bool,
    on_the_way: VecDeque<MeasurementRecord>,
}

/// What a follower believes, for its camera to follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeaderPrediction {
    /// Where it believes itself to be relative to its leader.
    pub relative: Option<Relative>,
    /// How well it knows.
    pub sight: TrackingState,
}

/// One measurement as it is taken.
pub(crate) struct Exposure<'a> {
    pub(crate) edge: usize,
    pub(crate) leader: usize,
    pub(crate) follower: usize,
    /// Counts the measurements of this follower.
    pub(crate) number: u64,
    /// All robots at that instant, cameras included.
    pub(crate) snapshot: &'a Snapshot,
    /// Where the follower expects to be relative to its leader.
    pub(crate) expected: Option<Relative>,
    /// Whether that can be relied on.
    pub(crate) seen: bool,
    /// How fast the camera turns on its mast, rad/s.
    pub(crate) pan_rate: f64,
}

/// Instants closer together than this are one, s.
const INSTANT: f64 = 1e-9;
/// Measurements that are on their way at once, per follower; more than this and the oldest are lost.
const MOST_ON_THE_WAY: usize = 4096;

impl SensorConfig {
    /// Whether any follower measures at all.
    pub fn has_sensors(&self) -> bool {
        self.sensors.iter().any(|sensor| sensor.source != SensorKind::Truth)
    }

    /// Whether any follower needs pictures.
    pub fn need_eyes(&self) -> bool {
        self.sensors.iter().any(|sensor| sensor.source == SensorKind::Camera)
    }

    /// The state before the first measurement: cameras point at the leaders as they stand.
    pub fn start(&self, snapshot: &Snapshot) -> SensorState {
        let mut before: HashMap<usize, usize> = HashMap::new();
        let sensor_state = |edge: &Edge| {
            // Measurements of a second leader have errors of their own.
            let count = before.entry(edge.follower).or_default();
            let stream = edge.follower + self.robots.len() * std::mem::replace(count, *count + 1);
            let (leader, follower) = (&snapshot.robots[edge.leader], &snapshot.robots[edge.follower]);
            let relative = Relative::between(leader.motion.pose, follower.motion.pose);
            let camera_mount = self.robots[edge.follower].camera_mount;
            EdgeWatch {
                stream,
                taken: 0,
                pan: Pan::at(pan::towards(&relative, camera_mount.forward), &self.camera),
                drift: noise::Drift::default(),
                seen: false,
                on_the_way: VecDeque::new(),
            }
        };
        SensorState {
            edges: self.edges.iter().map(sensor_state).collect(),
            camera_pipeline: CameraPipeline::default(),
        }
    }

    /// The follower of an edge looks for another leader from now on; what is on its way is of the one before.
    pub fn change_leader(&mut self, sensor_state: &mut SensorState, edge: usize, leader: usize) {
        self.edges[edge].leader = leader;
        if let Some(state) = sensor_state.edges.get_mut(edge) {
            state.on_the_way.clear();
            state.seen = false;
            state.drift = noise::Drift::default();
        }
    }

    /// Takes all measurements due after the last ones up to the end of a period, which began with the snapshot `before`
    /// and ended with `after`; both are the same for the measurements at the start.
    ///
    /// # Errors
    /// What kept the cameras from taking pictures, in words.
    pub fn take_measurements(
        &self,
        sensor_state: &mut SensorState,
        [before, after]: [&Snapshot; 2],
        interpolant: &(impl StepInterpolant + ?Sized),
        beliefs: &[LeaderPrediction],
        mut eyes: Option<&mut (dyn CameraRenderer + '_)>,
    ) -> Result<(), String> {
        while let Some((instant, due)) = self.next_measurements(sensor_state, after.time) {
            let share = if after.time > before.time {
                (instant - before.time) / (after.time - before.time)
            } else {
                1.0
            };
            let snapshot = self.instant(sensor_state, [before, after], interpolant, share);
            let exposures: Vec<Exposure<'_>> = due
                .iter()
                .map(|&edge| Exposure {
                    edge,
                    leader: self.edges[edge].leader,
                    follower: self.edges[edge].follower,
                    number: sensor_state.edges[edge].taken,
                    snapshot: &snapshot,
                    expected: beliefs[edge].relative,
                    seen: sensor_state.edges[edge].seen && beliefs[edge].sight == TrackingState::Tracking,
                    pan_rate: sensor_state.edges[edge].pan.rate(after.time - before.time),
                })
                .collect();
            let pictures = self.pictures(
                &exposures,
                [before, after],
                eyes.as_deref_mut(),
                &mut sensor_state.camera_pipeline,
            )?;
            for (exposure, picture) in exposures.iter().zip(pictures) {
                let frame = self.frame(sensor_state, exposure, instant, picture);
                let state = &mut sensor_state.edges[exposure.edge];
                state.taken += 1;
                state.seen = frame.outcome.seen() || (state.seen && frame.outcome == Outcome::Dropped);
                state.on_the_way.push_back(frame);
                if state.on_the_way.len() > MOST_ON_THE_WAY {
                    state.on_the_way.pop_front();
                }
            }
        }
        Ok(())
    }

    /// The next instant at which someone measures, and who does.
    fn next_measurements(&self, sensor_state: &SensorState, until: f64) -> Option<(f64, Vec<usize>)> {
        let due = |edge: usize| {
            let sensor = &self.sensors[edge];
            (sensor.source != SensorKind::Truth).then(|| sensor_state.edges[edge].taken as f64 / sensor.rate)
        };
        let all = 0..self.sensors.len();
        let instant = all.clone().filter_map(due).fold(f64::INFINITY, f64::min);
        (instant <= until + INSTANT).then(|| {
            (instant, all.filter(|edge| due(*edge).is_some_and(|d| d <= instant + INSTANT)).collect())
        })
    }

    /// Everything as it was at `share` of the period: robots on their way, cameras between their directions.
    fn instant(
        &self,
        sensor_state: &SensorState,
        [before, after]: [&Snapshot; 2],
        interpolant: &(impl StepInterpolant + ?Sized),
        share: f64,
    ) -> Snapshot {
        let mut now = Snapshot::between(before, after, share);
        let duration = interpolant.duration();
        if duration > 0.0 && after.time > before.time {
            for (index, robot) in now.robots.iter_mut().enumerate() {
                robot.motion = interpolant.during(index, share.clamp(0.0, 1.0) * duration);
            }
        }
        for (edge, state) in self.edges.iter().zip(&sensor_state.edges) {
            if let Some(robot) = now.robots.get_mut(edge.follower) {
                robot.camera_pan = state.pan.between(share);
            }
        }
        now
    }

    /// What comes of one measurement.
    fn frame(
        &self,
        sensor_state: &mut SensorState,
        exposure: &Exposure<'_>,
        stamp: f64,
        picture: Option<camera::CameraDetection>,
    ) -> MeasurementRecord {
        let sensor = &self.sensors[exposure.edge];
        let robot = |index: usize| &exposure.snapshot.robots[index];
        let truth =
            Relative::between(robot(exposure.leader).motion.pose, robot(exposure.follower).motion.pose);
        let mut frame = MeasurementRecord {
            edge: exposure.edge,
            measurement: Measurement { stamp, ..Measurement::default() },
            arrival: stamp + sensor.latency,
            outcome: Outcome::Missed,
            truth,
            pan: robot(exposure.follower).camera_pan,
            ..MeasurementRecord::default()
        };
        let source = sensor_state.edges[exposure.edge].stream;
        let stream = |purpose| noise_stream(self.seed, source, exposure.number, purpose);
        if stream(Purpose::Dropouts).uniform() < sensor.drop {
            frame.outcome = Outcome::Dropped;
            return frame;
        }
        let mut random = stream(Purpose::Errors);
        match (sensor.source, picture) {
            (SensorKind::Noise(model), _) => {
                let drift = &mut sensor_state.edges[exposure.edge].drift;
                frame.measurement = model.measurement(stamp, &truth, 1.0 / sensor.rate, drift, &mut random);
                frame.outcome = Outcome::Used;
            }
            (SensorKind::Geometric { pixel_noise }, _) => {
                let faces = geometric::faces(self, exposure, pixel_noise, &mut random);
                self.locate(exposure, &faces, pixel_noise, &mut frame);
            }
            (SensorKind::Camera, Some(seen)) => {
                frame.region = seen.region;
                self.locate(exposure, &seen.faces, camera::CORNER_NOISE, &mut frame);
            }
            (SensorKind::Camera | SensorKind::Truth, _) => {}
        }
        frame
    }

    /// The pose of the leader from the faces seen.
    fn locate(
        &self,
        exposure: &Exposure<'_>,
        faces: &[SeenFace],
        deviation: f64,
        frame: &mut MeasurementRecord,
    ) {
        for seen in faces {
            if let Some(tag) = frame.tags.get_mut(seen.face) {
                *tag = Some(seen.corners);
            }
        }
        let (Some(rig), false) = (self.rig(exposure), faces.is_empty()) else { return };
        let prior = Prior { tilt: self.sensors[exposure.edge].tilt, height: 0.0 };
        let near = exposure.expected.filter(|_| exposure.seen).map(|relative| pan::leader_pose(&relative));
        let Some(found) = locate(&rig, faces, deviation.max(1e-3), &prior, near) else { return };
        let (relative, deviation) = found.measurement();
        frame.measurement = Measurement { stamp: frame.measurement.stamp, relative, deviation };
        frame.outcome = if found.ambiguous { Outcome::Ambiguous } else { Outcome::Used };
    }

    /// What the follower measures, and with what.
    fn rig(&self, exposure: &Exposure<'_>) -> Option<Rig> {
        let follower = &self.robots[exposure.follower];
        let pan = exposure.snapshot.robots[exposure.follower].camera_pan;
        Some(Rig {
            shell: self.robots[exposure.leader].shell?,
            camera_model: follower.camera_model,
            body_from_camera: follower.camera_mount.body_from_camera(pan),
        })
    }

    /// Takes the pictures of all measurements that need one; `None` for those that do not.
    fn pictures(
        &self,
        exposures: &[Exposure<'_>],
        period: [&Snapshot; 2],
        eyes: Option<&mut (dyn CameraRenderer + '_)>,
        camera_pipeline: &mut CameraPipeline,
    ) -> Result<Vec<Option<camera::CameraDetection>>, String> {
        let by_camera = |exposure: &Exposure<'_>| self.sensors[exposure.edge].source == SensorKind::Camera;
        if !exposures.iter().any(by_camera) {
            return Ok(exposures.iter().map(|_| None).collect());
        }
        let eyes = eyes.ok_or("cameras take pictures, but no renderer is attached")?;
        let wanted: Vec<&Exposure<'_>> = exposures.iter().filter(|exposure| by_camera(exposure)).collect();
        let mut seen = self.camera.see(self, &wanted, period, eyes, camera_pipeline)?.into_iter();
        Ok(exposures.iter().map(|exposure| if by_camera(exposure) { seen.next() } else { None }).collect())
    }

    /// The measurements of an edge that have arrived by `time`, in the order of their stamps.
    pub fn arrived(
        sensor_state: &mut SensorState,
        edge: usize,
        time: f64,
    ) -> impl Iterator<Item = MeasurementRecord> + '_ {
        let waiting = sensor_state.edges.get_mut(edge).map(|state| &mut state.on_the_way);
        let mut waiting = waiting.into_iter().flat_map(move |frames| {
            let count = frames.iter().take_while(|frame| frame.arrival <= time + INSTANT).count();
            frames.drain(..count)
        });
        std::iter::from_fn(move || waiting.next())
    }

    /// Turns all cameras for a period to come towards where leaders are believed to be.
    pub fn turn_cameras(&self, sensor_state: &mut SensorState, beliefs: &[LeaderPrediction], period: f64) {
        for ((edge, state), belief) in self.edges.iter().zip(&mut sensor_state.edges).zip(beliefs) {
            state.pan.turn(belief, self.robots[edge.follower].camera_mount.forward, &self.camera, period);
        }
    }

    /// Direction of the camera of an edge's follower at the start of the period that begins, rad from its heading.
    pub fn pan(&self, sensor_state: &SensorState, edge: usize) -> f64 {
        sensor_state.edges.get(edge).map_or(0.0, |state| state.pan.between(0.0))
    }
}
