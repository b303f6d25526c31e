//! The digests of the shipped scenes: what every machine has to agree on.
//!
//! Truth, noise and geometric sensing are covered. Cameras draw pictures with the graphics driver of the machine, so their
//! scenes run with geometric sensing here.

use metrics::{Digest, NumberOwner, numbers};
use scene::{Override, SHIPPED, Scene, Shipped};
use simulation::{Setup, Simulation, build};
use std::fmt::Write;

/// Longest part of a scene that is run, s: long enough for every law to settle and every vehicle to meet what is in its way.
const LONGEST: f64 = 12.0;

/// A shipped scene and what is set in it.
#[derive(Debug, Clone, Copy)]
pub struct DigestRun {
    scene: &'static Shipped,
    /// The kind of sensing that replaces the scene's own.
    sensing: Option<&'static str>,
}

/// Every shipped scene, and some with noise or geometric sensing besides.
pub fn cases() -> Vec<DigestRun> {
    let own = |scene: &'static Shipped| {
        let sensing = scene.name.starts_with("vision-").then_some("geometric");
        DigestRun { scene, sensing }
    };
    let besides = |sensing, names: [&'static str; 2]| {
        let known = names.into_iter().filter_map(scene::shipped);
        known.map(move |scene| DigestRun { scene, sensing: Some(sensing) })
    };
    let mut cases: Vec<DigestRun> = SHIPPED.iter().map(own).collect();
    cases.extend(besides("noise", ["seven-v", "cars-line-three"]));
    cases.extend(besides("geometric", ["circle-three", "cars-yard"]));
    cases
}

impl DigestRun {
    /// Such as `seven-v/noise`.
    pub fn name(&self) -> String {
        format!("{}/{}", self.scene.name, self.sensing.unwrap_or("own"))
    }

    /// Runs it and gives its line: name, duration in s, digest.
    ///
    /// # Errors
    /// Why the scene cannot be run.
    pub fn line(&self) -> Result<String, String> {
        let (setup, mut digest) = (self.setup()?, Digest::default());
        let duration = setup.duration;
        let mut run = Simulation::new(setup);
        while let Some(record) = run.next_record() {
            digest.push(record);
        }
        Ok(format!("{} {duration} {}", self.name(), digest.text()))
    }

    /// Runs it and hands every number that the digest covers to `visit`, a line each: name, sample, what it belongs to,
    /// quantity, value, bits.
    ///
    /// # Errors
    /// Why the scene cannot be run.
    pub fn trace(&self, mut visit: impl FnMut(&str)) -> Result<(), String> {
        let mut run = Simulation::new(self.setup()?);
        let fleet = run.fleet().clone();
        let robot = |k: usize| fleet.robots.get(k).map_or("?", |robot| &*robot.name);
        let (name, mut sample, mut line) = (self.name(), 0, String::new());
        while let Some(record) = run.next_record() {
            numbers(record, |part, quantity, value| {
                line.clear();
                let part = match part {
                    NumberOwner::Time => "the run".to_owned(),
                    NumberOwner::Robot(k) => format!("robot {}", robot(k)),
                    NumberOwner::Edge(k) => {
                        let edge = fleet.edges[k];
                        format!("edge {} → {}", robot(edge.leader), robot(edge.follower))
                    }
                    NumberOwner::Prop(k) => format!("prop {}", fleet.props[k].name),
                    NumberOwner::Contact(k) => format!("contact {k}"),
                    NumberOwner::Measurement(k) => format!("measurement {k}"),
                };
                let bits = (value + 0.0).to_bits();
                // Writing to a string does not fail.
                let _ = write!(line, "{name}, sample {sample}, {part}: {quantity} {value:?} ({bits:016x})");
                visit(&line);
            });
            sample += 1;
        }
        Ok(())
    }

    fn setup(&self) -> Result<Setup, String> {
        let mut set: Vec<String> = self.sensing.iter().map(|kind| format!("sensing.kind={kind}")).collect();
        let whole = self.scene(&set)?.time.duration;
        set.push(format!("time.duration={}", whole.min(LONGEST)));
        build(&self.scene(&set)?).map_err(|error| error.to_string())
    }

    fn scene(&self, set: &[String]) -> Result<Scene, String> {
        let set: Result<Vec<Override>, _> = set.iter().map(|text| text.parse()).collect();
        let set = set.map_err(|error| format!("{error}"))?;
        let loaded = Scene::parse(self.scene.text, self.scene.name, &set);
        loaded.map(|loaded| loaded.scene).map_err(|error| error.to_string())
    }
}
