//! What the cameras of a scene see, with the truth about every tag and what the detector makes of it: a labelled set of
//! pictures.

pub(crate) mod camera;
mod folder;
mod forms;
mod light;
mod timeline;
pub(crate) mod view;

use crate::{Error, PROGRAM, RendererFactory, SceneRun};
use camera::{FollowerCamera, LabelledPicture};
use folder::DatasetFolder;
use light::{ExposureSettings, PictureRequest, gather};
use perception::imaging::Optics;
use perception::sensors::{CameraSettings, Sensor, SensorConfig, SensorKind};
use scene::Scene;
use serde_json::{Value, json};
use std::collections::HashSet;
use std::path::PathBuf;
use timeline::Timeline;
use vocabulary::{CameraRenderer, Edge, FleetInfo, Region, Word, words};

/// Version of the form of `dataset.json`.
const FORMAT: u32 = 1;

/// What a data set is to hold, and where.
#[derive(Debug, Clone)]
pub struct DatasetOptions {
    /// The folder.
    pub out: PathBuf,
    /// Replace an earlier data set in it.
    pub force: bool,
    /// Time from one picture of a camera to its next, s.
    pub every: f64,
    /// The edges whose followers take pictures.
    pub edges: Vec<Edge>,
    /// Look for the leader in the whole picture, instead of the part around where it is.
    pub whole: bool,
    /// What draws, in words.
    pub adapter: String,
}

impl DatasetOptions {
    /// Instants at which pictures are taken in a run of so many seconds.
    pub fn frames(&self, duration: f64) -> u64 {
        ((duration / self.every + 1e-9).floor() as u64).saturating_add(1)
    }
}

words! {
    /// How a data set ended; the word is that in `dataset.json`.
    pub enum DatasetStatus {
        /// All pictures were taken.
        Complete = "complete",
        /// The run ended before its time.
        Stopped = "stopped",
        /// Somebody asked it to end.
        Interrupted = "interrupted",
    }
}

/// A data set that is being written.
pub struct DatasetExport {
    scene: Scene,
    fleet: FleetInfo,
    renderer: Box<dyn CameraRenderer>,
    cameras: Vec<FollowerCamera>,
    sensor_config: SensorConfig,
    exposure: ExposureSettings,
    folder: DatasetFolder,
    timeline: Timeline,
    options: DatasetOptions,
    pictures: Vec<Value>,
    images: Vec<Value>,
    annotations: Vec<Value>,
}

impl DatasetExport {
    /// Makes the folder and writes a list of no pictures yet: a data set whose program was killed says so, and can be
    /// replaced. Cameras that the scene itself looks with have been attached to `run`.
    ///
    /// # Errors
    /// [`Error::Camera`] where nothing draws, [`Error::Output`] where the folder holds something, or cannot be written.
    pub fn create(
        run: SceneRun,
        renderer: RendererFactory<'_>,
        options: DatasetOptions,
    ) -> Result<Self, Error> {
        let SceneRun { scene, simulation } = run;
        let fleet = simulation.fleet().clone();
        let exposure = ExposureSettings { factor: scene.vision.exposure, shutter: scene.vision.shutter };
        let camera = |edge: &Edge| follower_camera(&scene, &fleet, *edge, options.whole);
        let export = Self {
            renderer: renderer(&fleet).map_err(Error::Camera)?,
            cameras: options.edges.iter().map(camera).collect(),
            sensor_config: sensor_config(&scene, &fleet),
            folder: DatasetFolder::create(&options.out, options.force)?,
            timeline: Timeline::new(simulation, exposure.shutter),
            exposure,
            options,
            pictures: vec![],
            images: vec![],
            annotations: vec![],
            fleet,
            scene,
        };
        export.write("running")?;
        Ok(export)
    }

    /// Takes all pictures and writes the lists; `step` gets the number of instants that are done, and `go_on` says whether the
    /// work goes on.
    ///
    /// # Errors
    /// [`Error`] where the run breaks off with a fault, or the disk refuses a file; the lists then hold what there is.
    pub fn take_all(
        &mut self,
        mut step: impl FnMut(u64),
        go_on: &dyn Fn() -> bool,
    ) -> Result<DatasetStatus, Error> {
        let frames = self.options.frames(self.scene.time.duration);
        let mut frame = 0;
        while frame < frames {
            let time = frame as f64 * self.options.every;
            if !self.timeline.reach(time, go_on)? {
                break;
            }
            // Half of an exposure comes after its instant; at the end of the run robots are held where they are.
            self.timeline.reach(time + 0.5 * self.exposure.shutter, go_on)?;
            self.take(frame, time).inspect_err(|_| {
                // The disk may still take the list.
                let _ = self.write(DatasetStatus::Interrupted.word());
            })?;
            frame += 1;
            step(frame);
            if !go_on() {
                break;
            }
        }
        let status = match frame == frames {
            true => DatasetStatus::Complete,
            false if !go_on() => DatasetStatus::Interrupted,
            false => DatasetStatus::Stopped,
        };
        self.write(status.word())?;
        Ok(status)
    }

    /// Pictures that were taken.
    pub fn pictures(&self) -> usize {
        self.pictures.len()
    }

    /// Takes the pictures of all cameras at `time`.
    fn take(&mut self, frame: u64, time: f64) -> Result<(), Error> {
        let Some(mut now) = self.timeline.at(time) else { return Ok(()) };
        // What is within rounding of a control sample is told as the time that was asked for.
        now.time = time;
        let want = |camera: &FollowerCamera| {
            let source = camera.sensor.source(Region::whole(&camera.sensor.optics().camera_model));
            PictureRequest { robot: camera.edge.follower, source }
        };
        let wanted: Vec<PictureRequest> = self.cameras.iter().map(want).collect();
        let light = gather(&mut *self.renderer, &self.fleet, &self.exposure, &self.timeline, &now, &wanted)?;
        for (camera, light) in self.cameras.iter_mut().zip(&light) {
            let picture = camera.expose(light, self.scene.seed, frame);
            let name = format!("{frame:05}-{:03}", camera.edge.follower);
            let file = self.folder.picture(&name, &picture)?;
            let labels = camera.labels(&self.fleet, &self.sensor_config, &now);
            let image = self.images.len() + 1;
            self.images.push(json!({
                "id": image, "file_name": file, "width": picture.width, "height": picture.height,
            }));
            for label in &labels {
                self.annotations.push(label.as_coco(self.annotations.len() + 1, image));
            }
            let taken = LabelledPicture { file, picture: &picture, snapshot: &now };
            self.pictures.push(camera.note(&self.fleet, &labels, &taken));
        }
        Ok(())
    }

    fn write(&self, status: &str) -> Result<(), Error> {
        self.folder.json(
            "dataset.json",
            &json!({
                "format": FORMAT, "program": PROGRAM, "status": status, "title": self.fleet.title,
                "seed": self.scene.seed, "adapter": self.options.adapter,
                "tags": { "family": "tag36h11", "opencv": "DICT_APRILTAG_36h11" },
                "sensor": {
                    "blur": self.scene.vision.blur, "noise": self.scene.vision.noise,
                    "exposure": self.exposure.factor, "shutter": self.exposure.shutter,
                },
                "robots": self.fleet.robots.iter().map(forms::robot).collect::<Vec<_>>(),
                "cameras": self.cameras.iter().map(|c| c.describe(&self.fleet)).collect::<Vec<_>>(),
                "summary": self.summary(),
                "pictures": self.pictures,
            }),
        )?;
        self.folder.json("coco.json", &forms::coco(&self.fleet.title, &self.images, &self.annotations))
    }

    /// How much there is of everything.
    pub fn summary(&self) -> Value {
        let tags = |key: &str, holds: &dyn Fn(&Value) -> bool| {
            let lists = self.pictures.iter().filter_map(|picture| picture[key].as_array());
            lists.flatten().filter(|tag| holds(tag)).count()
        };
        let located = self.pictures.iter().filter(|picture| picture["leader"]["estimate"].is_object());
        json!({
            "pictures": self.pictures.len(),
            "tags": tags("tags", &|_| true),
            "readable": tags("tags", &|tag| tag["readable"] == true && tag["hidden"] == false),
            "detected": tags("detected", &|tag| tag["accepted"] == true),
            "located": located.count(),
        })
    }
}

/// The edges of the followers that are named, one each; all if none is.
///
/// # Errors
/// [`Error::Usage`] where nobody follows, or no follower is called so.
pub fn followed_edges(fleet: &FleetInfo, names: &[String]) -> Result<Vec<Edge>, Error> {
    let follower = |edge: &Edge| fleet.robots[edge.follower].name.as_str();
    let known: Vec<&str> = fleet.edges.iter().map(follower).collect();
    if known.is_empty() {
        return Err(Error::Usage("the scene has no followers, and so no cameras".into()));
    }
    if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Error::Usage(format!(
            "--edges {name}: no follower is called that; there are {}",
            known.join(", ")
        )));
    }
    let wanted = |edge: &&Edge| names.is_empty() || names.iter().any(|name| name == follower(edge));
    let mut edges: Vec<Edge> = fleet.edges.iter().filter(wanted).copied().collect();
    // A camera looks at one leader: of several at the first.
    let mut seen = HashSet::new();
    edges.retain(|edge| seen.insert(edge.follower));
    Ok(edges)
}

/// Tilt that is expected of bodies on springs or uneven ground, standard deviation, rad; as for cameras that steer.
const TILT: f64 = std::f64::consts::PI / 180.0;

fn follower_camera(scene: &Scene, fleet: &FleetInfo, edge: Edge, whole: bool) -> FollowerCamera {
    let (vision, robots) = (&scene.vision, &scene.robots);
    let optics = Optics {
        camera_model: fleet.robots[edge.follower].camera_model,
        blur: vision.blur,
        noise: vision.noise,
    };
    let wheels = |index: usize| robots.get(index).is_some_and(|robot| robot.vehicle.kind.has_wheels());
    let upright = fleet.terrain.is_none() && !wheels(edge.leader) && !wheels(edge.follower);
    let asked = robots.get(edge.follower).and_then(|robot| robot.role.follow()?.sensing.tilt);
    let tilt = asked.unwrap_or(if upright { 0.0 } else { TILT });
    FollowerCamera::new(edge, optics, tilt, whole)
}

/// What knows what stands in the way of whom; nobody looks with it.
fn sensor_config(scene: &Scene, fleet: &FleetInfo) -> SensorConfig {
    let truth = Sensor { source: SensorKind::Truth, rate: 1.0, latency: 0.0, drop: 0.0, tilt: 0.0 };
    SensorConfig {
        edges: fleet.edges.clone(),
        sensors: vec![truth; fleet.edges.len()],
        robots: fleet.robots.clone(),
        props: fleet.props.clone(),
        terrain: fleet.terrain.clone(),
        camera: CameraSettings::default(),
        seed: scene.seed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Body, RobotInfo};

    #[test]
    fn followers_are_chosen_by_name() {
        let names = ["ann", "bob", "eve"];
        let fleet = FleetInfo {
            robots: names.map(|name| RobotInfo::new(name, name == "ann", Body::default())).to_vec(),
            edges: vec![Edge { leader: 0, follower: 1 }, Edge { leader: 1, follower: 2 }],
            ..FleetInfo::default()
        };
        let chosen = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            followed_edges(&fleet, &names)
        };
        assert_eq!(chosen(&[]).expect("all").len(), 2);
        assert_eq!(chosen(&["eve"]).expect("one"), [fleet.edges[1]]);
        for bad in ["ann", "", "boob"] {
            assert!(matches!(chosen(&[bad]), Err(Error::Usage(text)) if text.contains("bob, eve")));
        }
    }
}
