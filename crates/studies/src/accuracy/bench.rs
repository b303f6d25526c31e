//! Draws poses, looks for the leader in them, and takes the time.

use crate::accuracy::poses::{FOLLOWER, LEADER};
use crate::accuracy::tally::{Errors, PoseSample};
use crate::dataset::camera::{CORNER_NOISE, errors, relative_pose};
use crate::dataset::view::{FaceView, region_around};
use crate::pace::Clock;
use crate::{Error, RendererFactory};
use perception::detect::{Detector, Locus, Tag, recognise};
use perception::imaging::{ImageSensor, Optics, Purpose, noise_stream};
use perception::pose::{Prior, Rig, SeenFace, locate};
use vocabulary::{
    Body, CameraRenderer, Edge, FACES, FleetInfo, Grey, Pose, Region, Rigid, RobotInfo, Shell, Snapshot, math,
};

/// What is timed, in the order of [`Times`].
pub const STAGES: [&str; 4] = ["draw", "sensor", "detect and sharpen", "locate"];
/// Milliseconds of each stage.
pub type Times = [f64; 4];

/// A corner that is off by more pixels, or by more than half a cell, is not that of the face it is said to be.
const ELSEWHERE: f64 = 2.0;

/// A leader, a camera that looks at it, and all that is needed to find the one in the picture of the other.
pub(crate) struct LocalisationBench {
    pub(crate) fleet: FleetInfo,
    renderer: Box<dyn CameraRenderer>,
    sensor: ImageSensor,
    detector: CountingDetector,
    seed: u64,
}

/// A detector, and how many of the tags it found are not there.
struct CountingDetector {
    inner: Locus,
    shell: Shell,
    foreign: usize,
}

impl Detector for CountingDetector {
    fn detect(&mut self, picture: &Grey, found: &mut Vec<Tag>) {
        self.inner.detect(picture, found);
        self.count(found);
    }

    fn detect_in_shade(&mut self, picture: &Grey, found: &mut Vec<Tag>) {
        // What was foreign before has been taken out.
        self.inner.detect_in_shade(picture, found);
        self.count(found);
    }
}

impl CountingDetector {
    fn count(&mut self, found: &[Tag]) {
        self.foreign += found.iter().filter(|tag| self.shell.face_of(tag.id).is_none()).count();
    }
}

/// A part of a picture in which faces are looked for.
#[derive(Clone, Copy)]
struct SearchFrame<'a> {
    snapshot: &'a Snapshot,
    /// Number of the picture, for the noise.
    number: u64,
    region: Region,
    /// Faces that are expected in it.
    expected: usize,
    camera_from_body: Rigid,
}

/// What was found in one picture.
struct FoundFaces {
    faces: Vec<SeenFace>,
    wrong: usize,
    strayed: usize,
    times: Times,
}

impl LocalisationBench {
    /// With a leader that carries the tags of robot number `number`.
    pub(crate) fn new(renderer: RendererFactory<'_>, number: usize, seed: u64) -> Result<Self, Error> {
        let mut leader = RobotInfo::new("leader", true, Body::default());
        let shell = leader.shell.unwrap_or(Shell::PAPER).tagged(number);
        leader.shell = Some(shell);
        let fleet = FleetInfo {
            robots: vec![leader, RobotInfo::new("follower", false, Body::default())],
            edges: vec![Edge { leader: LEADER, follower: FOLLOWER }],
            has_sensors: true,
            ..FleetInfo::default()
        };
        Ok(Self {
            renderer: renderer(&fleet).map_err(Error::Camera)?,
            sensor: ImageSensor::new(Optics {
                camera_model: fleet.robots[FOLLOWER].camera_model,
                ..Optics::default()
            }),
            detector: CountingDetector { inner: Locus::new(), shell, foreign: 0 },
            seed,
            fleet,
        })
    }

    /// What comes of the `number`th pose, and the times of the tracked part and of the whole picture.
    pub(crate) fn try_pose(
        &mut self,
        snapshot: &Snapshot,
        number: u64,
        clock: Clock<'_>,
    ) -> Result<(PoseSample, [Times; 2]), Error> {
        let [leader, own] = [LEADER, FOLLOWER].map(|robot| snapshot.robots[robot]);
        let follower = &self.fleet.robots[FOLLOWER];
        let (shell, camera_model) = (self.detector.shell, follower.camera_model);
        let body_from_camera = follower.camera_mount.body_from_camera(own.camera_pan);
        let camera_from_body =
            follower.camera_mount.world_from_camera(&own).inverse().after(&leader.world_from_body());
        let truth = relative_pose(&leader.motion.pose, &own.motion.pose);
        let view = |face: usize| FaceView::of(&shell, &camera_model, &camera_from_body, face);
        let views: Vec<FaceView> = (0..FACES).filter_map(view).collect();
        let readable = views.iter().filter(|view| view.readable(&camera_model)).count();
        // A camera that tracks its leader expects so many, and searches the shade for them only.
        let expected = views.iter().filter(|view| view.surely_readable()).count().max(1);

        let region = region_around(&shell, &camera_model, &camera_from_body);
        let mut near =
            self.look(&SearchFrame { snapshot, number, region, expected, camera_from_body }, clock)?;
        let whole = Region::whole(&camera_model);
        let whole = self.look(
            &SearchFrame { snapshot, number, region: whole, expected: FACES, camera_from_body },
            clock,
        )?;
        let rig = Rig { shell, camera_model, body_from_camera };
        let began = clock();
        let estimate = locate(&rig, &near.faces, CORNER_NOISE, &Prior::default(), None);
        near.times[3] = 1e3 * (clock() - began);
        let off = |pose: &Pose| relative_errors(pose, &truth);
        let sample = PoseSample {
            distance: math::hypot(truth.x, truth.y),
            readable,
            seen: near.faces.len(),
            seen_whole: whole.faces.len(),
            wrong: near.wrong + whole.wrong,
            strayed: near.strayed + whole.strayed,
            refined: estimate.as_ref().map(|found| off(&found.pose)),
            ambiguous: estimate.as_ref().is_some_and(|found| found.ambiguous),
            raw: estimate.as_ref().and_then(|found| found.raw.as_ref()).map(off),
        };
        let located = near.times[3];
        Ok((sample, [near.times, [whole.times[0], whole.times[1], whole.times[2], located]]))
    }

    /// Draws a part of the picture and finds the leader's faces in it.
    fn look(&mut self, frame: &SearchFrame<'_>, clock: Clock<'_>) -> Result<FoundFaces, Error> {
        let SearchFrame { snapshot, number, region, expected, .. } = *frame;
        let follower = &self.fleet.robots[FOLLOWER];
        let source = self.sensor.source(region);
        let shot = source.shot(FOLLOWER, follower, &snapshot.robots[FOLLOWER], 1.0);
        let mut times = Times::default();
        let mut pictures = Vec::new();
        let began = clock();
        self.renderer.render(snapshot, &[shot], &mut pictures).map_err(Error::Camera)?;
        times[0] = 1e3 * (clock() - began);
        let light = pictures.pop().unwrap_or_default();
        let mut picture = Grey::default();
        let mut random = noise_stream(self.seed, FOLLOWER, number, Purpose::Pixels);
        let began = clock();
        self.sensor.expose(&light, region, &mut random, &mut picture);
        times[1] = 1e3 * (clock() - began);
        let optics = *self.sensor.optics();
        let shell = self.detector.shell;
        self.detector.foreign = 0;
        let began = clock();
        let faces = recognise(&mut self.detector, &picture, region, &optics, &shell, expected);
        times[2] = 1e3 * (clock() - began);
        let strayed =
            faces.iter().filter(|seen| strays(seen, &shell, &optics, &frame.camera_from_body)).count();
        Ok(FoundFaces { faces, wrong: self.detector.foreign, strayed, times })
    }
}

/// Whether a face was found where it is not.
fn strays(seen: &SeenFace, shell: &Shell, optics: &Optics, camera_from_body: &Rigid) -> bool {
    let Some(view) = FaceView::of(shell, &optics.camera_model, camera_from_body, seen.face) else {
        return true;
    };
    let most = ELSEWHERE.max(0.5 * view.cell);
    seen.corners.iter().zip(view.corners).any(|(a, b)| math::hypot(a[0] - b[0], a[1] - b[1]) > most)
}

/// Range as a share of the range, bearing and heading.
fn relative_errors(pose: &Pose, truth: &Pose) -> Errors {
    let [range, bearing, heading] = errors(pose, truth);
    [range / math::hypot(truth.x, truth.y).max(1e-9), bearing, heading]
}
