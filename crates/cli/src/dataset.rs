//! `echelon dataset`: what the cameras of a scene see, with the truth about every tag and what we made of it.

pub(crate) mod camera;
mod folder;
mod light;
mod timeline;
pub(crate) mod view;
mod words;

use crate::Outcome;
use crate::args::DatasetArgs;
use crate::failure::Failure;
use crate::interrupt;
use crate::load::{load, stem};
use crate::print;
use crate::progress::Progress;
use crate::run::PROGRAM;
use camera::{FollowerCamera, Taken};
use folder::Folder;
use light::{Exposure, Wanted, gather};
use perception::imaging::Optics;
use perception::sensors::{CameraSettings, Sensor, SensorConfig, SensorKind};
use rendering::{AdapterChoice, Gpu, GpuCameraRenderer};
use scene::{Role, Scene};
use serde_json::{Value, json};
use std::time::Instant;
use timeline::Timeline;
use vocabulary::{Edge, FleetInfo, Region, counted};

/// Version of the form of `dataset.json`.
const FORMAT: u32 = 1;

pub(crate) fn dataset(args: &DatasetArgs) -> Outcome {
    let began = Instant::now();
    let mut loaded = load(&args.scene)?;
    let fleet = loaded.simulation.fleet().clone();
    let edges = chosen(&fleet, &args.edges)?;
    let gpu = Gpu::open(&AdapterChoice::from(args.scene.adapter.as_str()))?;
    loaded.attach_cameras(Some(&gpu), &args.scene)?;
    let scene = loaded.scene;
    let mut export = Export {
        eyes: GpuCameraRenderer::new(&gpu, &fleet)?,
        cameras: edges.iter().map(|edge| follower_camera(&scene, &fleet, *edge, args.whole)).collect(),
        sensor_config: sensor_config(&scene, &fleet),
        exposure: Exposure { factor: scene.vision.exposure, shutter: scene.vision.shutter },
        folder: Folder::create(&args.out, args.force)?,
        adapter: gpu.description(),
        pictures: vec![],
        images: vec![],
        annotations: vec![],
        fleet,
        scene,
    };
    // A data set whose program was killed says so, and can be replaced.
    export.write("running")?;

    let duration = export.scene.time.duration;
    let frames = ((duration / args.every + 1e-9).floor() as u64).saturating_add(1);
    let name = stem(&args.scene.scene);
    let what = format!(
        "Exporting {name}, {}, to {}",
        counted(frames.saturating_mul(edges.len() as u64), "picture"),
        args.out.display()
    );
    let progress = Progress::begin(&what, frames, args.scene.quiet || args.scene.json);
    let mut timeline = Timeline::new(loaded.simulation, export.exposure.shutter);
    let mut frame = 0;
    while frame < frames && timeline.reach(frame as f64 * args.every)? {
        let time = frame as f64 * args.every;
        // Half of an exposure comes after its instant; at the end of the run robots are held where they are.
        timeline.reach(time + 0.5 * export.exposure.shutter)?;
        export.take(&timeline, frame, time).map_err(|failure| {
            let count = counted(export.pictures.len(), "picture");
            // The disk may still take the list.
            let _ = export.write("interrupted");
            failure.but(&format!("{} keeps the first {count}; --force begins anew", args.out.display()))
        })?;
        frame += 1;
        progress.at(frame);
        if interrupt::asked() {
            break;
        }
    }
    progress.end();
    let status = match frame == frames {
        true => "complete",
        false if interrupt::asked() => "interrupted",
        false => "stopped",
    };
    export.write(status)?;
    if status == "interrupted" {
        let count = counted(export.pictures.len(), "picture");
        let text = format!("{} holds the first {count}", args.out.display());
        return Err(Failure::Interrupted(text));
    }
    let seconds = began.elapsed().as_secs_f64();
    let summary = export.summary();
    if args.scene.json {
        print::json(&json!({
            "folder": args.out.display().to_string(), "status": status, "adapter": export.adapter,
            "wall_seconds": seconds, "summary": summary,
        }));
    } else if !args.scene.quiet {
        print::say(&format!(
            "{}: {} of {}, {} in view, {} readable, {} detected",
            args.out.display(),
            counted(&summary["pictures"], "picture"),
            counted(edges.len(), "camera"),
            counted(&summary["tags"], "tag"),
            summary["readable"],
            summary["detected"]
        ));
        print::say(&format!("drawn in {seconds:.1} s with {}", export.adapter));
    }
    Ok(())
}

/// The edges of the followers that are named; all if none is.
fn chosen(fleet: &FleetInfo, names: &[String]) -> Result<Vec<Edge>, Failure> {
    let follower = |edge: &Edge| fleet.robots[edge.follower].name.as_str();
    let known: Vec<&str> = fleet.edges.iter().map(follower).collect();
    if known.is_empty() {
        return Err(Failure::Usage("the scene has no followers, and so no cameras".into()));
    }
    if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Failure::Usage(format!(
            "--edges {name}: no follower is called that; there are {}",
            known.join(", ")
        )));
    }
    let wanted = |edge: &&Edge| names.is_empty() || names.iter().any(|name| name == follower(edge));
    Ok(fleet.edges.iter().filter(wanted).copied().collect())
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
    let asked = robots.get(edge.follower).and_then(|robot| match &robot.role {
        Role::Follow(follow) => follow.sensing.tilt,
        Role::Lead { .. } => None,
    });
    let tilt = asked.unwrap_or(if upright { 0.0 } else { TILT });
    FollowerCamera::new(edge, optics, tilt, whole)
}

/// What knows what stands in the way of whom; nobody looks with it.
fn sensor_config(scene: &Scene, fleet: &FleetInfo) -> SensorConfig {
    let truth = Sensor { source: SensorKind::Truth, rate: 1.0, latency: 0.0, drop: 0.0, tilt: 0.0 };
    let sensors = fleet.edges.iter().map(|_| truth).collect();
    SensorConfig::new(
        &fleet.edges,
        sensors,
        &fleet.robots,
        &fleet.props,
        fleet.terrain.clone(),
        CameraSettings::default(),
        scene.seed,
    )
}

/// A data set that is being written.
struct Export {
    scene: Scene,
    fleet: FleetInfo,
    eyes: GpuCameraRenderer,
    cameras: Vec<FollowerCamera>,
    sensor_config: SensorConfig,
    exposure: Exposure,
    folder: Folder,
    adapter: String,
    pictures: Vec<Value>,
    images: Vec<Value>,
    annotations: Vec<Value>,
}

impl Export {
    /// Takes the pictures of all cameras at `time`.
    fn take(&mut self, timeline: &Timeline, frame: u64, time: f64) -> Outcome {
        let Some(mut now) = timeline.at(time) else { return Ok(()) };
        // What is within rounding of a control sample is told as the time that was asked for.
        now.time = time;
        let want = |camera: &FollowerCamera| {
            let source = camera.sensor.source(Region::whole(&camera.sensor.optics().camera_model));
            Wanted { robot: camera.edge.follower, region: source.region, centre: source.centre }
        };
        let wanted: Vec<Wanted> = self.cameras.iter().map(want).collect();
        let light = gather(&mut self.eyes, &self.fleet, &self.exposure, (timeline, &now), &wanted)?;
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
            let taken = Taken { file, picture: &picture, snapshot: &now };
            self.pictures.push(camera.note(&self.fleet, &labels, &taken));
        }
        Ok(())
    }

    fn write(&self, status: &str) -> Outcome {
        self.folder.json(
            "dataset.json",
            &json!({
                "format": FORMAT, "program": PROGRAM, "status": status, "title": self.fleet.title,
                "seed": self.scene.seed, "adapter": self.adapter,
                "tags": { "family": "tag36h11", "opencv": "DICT_APRILTAG_36h11" },
                "sensor": {
                    "blur": self.scene.vision.blur, "noise": self.scene.vision.noise,
                    "exposure": self.exposure.factor, "shutter": self.exposure.shutter,
                },
                "robots": self.fleet.robots.iter().map(words::robot).collect::<Vec<_>>(),
                "cameras": self.cameras.iter().map(|c| c.describe(&self.fleet)).collect::<Vec<_>>(),
                "summary": self.summary(),
                "pictures": self.pictures,
            }),
        )?;
        self.folder.json("coco.json", &words::coco(&self.fleet.title, &self.images, &self.annotations))
    }

    /// How much there is of everything.
    fn summary(&self) -> Value {
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
            chosen(&fleet, &names)
        };
        assert_eq!(chosen(&[]).expect("all").len(), 2);
        assert_eq!(chosen(&["eve"]).expect("one"), [fleet.edges[1]]);
        for bad in ["ann", "", "boob"] {
            assert!(matches!(chosen(&[bad]), Err(Failure::Usage(text)) if text.contains("bob, eve")));
        }
    }
}
