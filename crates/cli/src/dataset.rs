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
use perception::sensors::{CameraModel, Senses, Sensor, Source};
use rendering::{AdapterChoice, CameraEyes, Gpu};
use scene::{Role, Scene};
use serde_json::{Value, json};
use std::time::Instant;
use timeline::Timeline;
use vocabulary::{Cast, Edge, Region, counted};

/// Version of the form of `dataset.json`.
const FORMAT: u32 = 1;

pub(crate) fn dataset(args: &DatasetArgs) -> Outcome {
    let began = Instant::now();
    let mut loaded = load(&args.scene)?;
    let cast = loaded.simulation.cast().clone();
    let edges = chosen(&cast, &args.edges)?;
    let gpu = Gpu::open(&AdapterChoice::from(args.scene.adapter.as_str()))?;
    loaded.open_eyes(Some(&gpu), &args.scene)?;
    let scene = loaded.scene;
    let mut export = Export {
        eyes: CameraEyes::new(&gpu, &cast)?,
        cameras: edges.iter().map(|edge| follower_camera(&scene, &cast, *edge, args.whole)).collect(),
        senses: senses(&scene, &cast),
        exposure: Exposure { factor: scene.vision.exposure, shutter: scene.vision.shutter },
        folder: Folder::create(&args.out, args.force)?,
        adapter: gpu.description(),
        pictures: vec![],
        images: vec![],
        annotations: vec![],
        cast,
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
fn chosen(cast: &Cast, names: &[String]) -> Result<Vec<Edge>, Failure> {
    let follower = |edge: &Edge| cast.members[edge.follower].name.as_str();
    let known: Vec<&str> = cast.edges.iter().map(follower).collect();
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
    Ok(cast.edges.iter().filter(wanted).copied().collect())
}

/// Tilt that is expected of bodies on springs or uneven ground, standard deviation, rad; as for cameras that steer.
const TILT: f64 = std::f64::consts::PI / 180.0;

fn follower_camera(scene: &Scene, cast: &Cast, edge: Edge, whole: bool) -> FollowerCamera {
    let (vision, robots) = (&scene.vision, &scene.robots);
    let optics = Optics { lens: cast.members[edge.follower].lens, blur: vision.blur, noise: vision.noise };
    let wheels = |index: usize| robots.get(index).is_some_and(|robot| robot.vehicle.kind.has_wheels());
    let upright = cast.terrain.is_none() && !wheels(edge.leader) && !wheels(edge.follower);
    let asked = robots.get(edge.follower).and_then(|robot| match &robot.role {
        Role::Follow(follow) => follow.sensing.tilt,
        Role::Lead { .. } => None,
    });
    let tilt = asked.unwrap_or(if upright { 0.0 } else { TILT });
    FollowerCamera::new(edge, optics, tilt, whole)
}

/// What knows what stands in the way of whom; nobody looks with it.
fn senses(scene: &Scene, cast: &Cast) -> Senses {
    let truth = Sensor { source: Source::Truth, rate: 1.0, latency: 0.0, drop: 0.0, tilt: 0.0 };
    let sensors = cast.edges.iter().map(|_| truth).collect();
    let things = (cast.members.as_slice(), cast.props.as_slice());
    Senses::new(&cast.edges, sensors, things, cast.terrain.clone(), CameraModel::default(), scene.seed)
}

/// A data set that is being written.
struct Export {
    scene: Scene,
    cast: Cast,
    eyes: CameraEyes,
    cameras: Vec<FollowerCamera>,
    senses: Senses,
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
            let source = camera.sensor.source(Region::whole(&camera.sensor.optics().lens));
            Wanted { robot: camera.edge.follower, region: source.region, centre: source.centre }
        };
        let wanted: Vec<Wanted> = self.cameras.iter().map(want).collect();
        let light = gather(&mut self.eyes, &self.cast, &self.exposure, (timeline, &now), &wanted)?;
        for (camera, light) in self.cameras.iter_mut().zip(&light) {
            let picture = camera.expose(light, self.scene.seed, frame);
            let name = format!("{frame:05}-{:03}", camera.edge.follower);
            let file = self.folder.picture(&name, &picture)?;
            let labels = camera.labels(&self.cast, &self.senses, &now);
            let image = self.images.len() + 1;
            self.images.push(json!({
                "id": image, "file_name": file, "width": picture.width, "height": picture.height,
            }));
            for label in &labels {
                self.annotations.push(label.as_coco(self.annotations.len() + 1, image));
            }
            let taken = Taken { file, picture: &picture, snapshot: &now };
            self.pictures.push(camera.note(&self.cast, &labels, &taken));
        }
        Ok(())
    }

    fn write(&self, status: &str) -> Outcome {
        self.folder.json(
            "dataset.json",
            &json!({
                "format": FORMAT, "program": PROGRAM, "status": status, "title": self.cast.title,
                "seed": self.scene.seed, "adapter": self.adapter,
                "tags": { "family": "tag36h11", "opencv": "DICT_APRILTAG_36h11" },
                "sensor": {
                    "blur": self.scene.vision.blur, "noise": self.scene.vision.noise,
                    "exposure": self.exposure.factor, "shutter": self.exposure.shutter,
                },
                "robots": self.cast.members.iter().map(words::robot).collect::<Vec<_>>(),
                "cameras": self.cameras.iter().map(|c| c.describe(&self.cast)).collect::<Vec<_>>(),
                "summary": self.summary(),
                "pictures": self.pictures,
            }),
        )?;
        self.folder.json("coco.json", &words::coco(&self.cast.title, &self.images, &self.annotations))
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
    use vocabulary::{Body, Member};

    #[test]
    fn followers_are_chosen_by_name() {
        let names = ["ann", "bob", "eve"];
        let cast = Cast {
            members: names.map(|name| Member::new(name, name == "ann", Body::default())).to_vec(),
            edges: vec![Edge { leader: 0, follower: 1 }, Edge { leader: 1, follower: 2 }],
            ..Cast::default()
        };
        let chosen = |names: &[&str]| {
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            chosen(&cast, &names)
        };
        assert_eq!(chosen(&[]).expect("all").len(), 2);
        assert_eq!(chosen(&["eve"]).expect("one"), [cast.edges[1]]);
        for bad in ["ann", "", "boob"] {
            assert!(matches!(chosen(&[bad]), Err(Failure::Usage(text)) if text.contains("bob, eve")));
        }
    }
}
