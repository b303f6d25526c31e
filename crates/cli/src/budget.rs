//! `echelon budget`: where errors of following come from. The scene runs again and again on the same seed, from followers
//! that are told the truth over corners of tags with more and more noise to pictures of cameras, with both observers; or,
//! with `--epsilon`, with one observer constant after the other.

mod case;
mod files;
mod measure;
mod picture;
mod scaling;
mod table;

use crate::Outcome;
use crate::args::BudgetArgs;
use crate::failure::Failure;
use crate::load::{Loaded, load, stem};
use crate::print::{note, say};
use crate::progress::Progress;
use crate::{eyes, interrupt};
use case::{Case, Level, Observer};
use measure::{Run, measure};
use output::Place;
use rendering::{AdapterChoice, Gpu};
use scene::Scene;
use simulation::Simulation;
use std::path::Path;
use vocabulary::{FleetInfo, counted};

/// A comparison, as far as it has come.
pub(crate) struct Budget<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) fleet: FleetInfo,
    /// Time from which errors count, s.
    pub(crate) settled_after: f64,
    /// Whether observer constants are compared instead of ways of sensing.
    pub(crate) constants: bool,
    pub(crate) runs: Vec<(Case, Run)>,
    /// Adapter that drew for the cameras, if any did.
    pub(crate) adapter: Option<String>,
    /// Why there are no pictures of cameras, where there are none.
    pub(crate) without_camera: Option<String>,
    /// Whether all runs were made.
    pub(crate) complete: bool,
}

impl Budget<'_> {
    /// Names of the edges.
    pub(crate) fn edge(&self, index: usize) -> [&str; 2] {
        let name = |robot: usize| self.fleet.robots.get(robot).map_or("", |m| m.name.as_str());
        self.fleet.edges.get(index).map_or([""; 2], |edge| [name(edge.leader), name(edge.follower)])
    }

    /// The run of a case, where it has come to that.
    pub(crate) fn run(&self, level: Level, observer: Observer) -> Option<&Run> {
        self.runs.iter().find(|(c, _)| *c == Case { level, observer }).map(|(_, run)| run)
    }

    /// The noises of corners that were tried, in order.
    pub(crate) fn pixels(&self) -> Vec<f64> {
        let mut all: Vec<f64> = self.runs.iter().filter_map(|(case, _)| case.level.pixels()).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// [pixels, value] of an edge over all noises of corners with an observer; without what has no value.
    pub(crate) fn curve(
        &self,
        edge: usize,
        observer: Observer,
        value: impl Fn(&measure::Measured) -> Option<f64>,
    ) -> Vec<[f64; 2]> {
        let at = |pixels: f64| {
            let run = self.run(Level::Pixels(pixels), observer)?;
            Some([pixels, value(run.edges.get(edge)?)?])
        };
        self.pixels().into_iter().filter_map(at).collect()
    }

    /// The noise of corners that an edge's looks by camera stand for: by distance, bearing, view angle, and by all.
    pub(crate) fn camera_as_pixels(&self, edge: usize) -> ([Option<f64>; 3], Option<f64>) {
        let of = |channel: usize| {
            let run = self.run(Level::Camera, Observer::HighGain)?;
            let error = run.edges.get(edge)?.looks?[channel];
            scaling::noise_of(&self.curve(edge, Observer::HighGain, |m| Some(m.looks?[channel])), error)
        };
        let each = [0, 1, 2].map(of);
        (each, scaling::middle(&each))
    }
}

pub(crate) fn budget(args: &BudgetArgs) -> Outcome {
    let Loaded { scene, simulation } = load(&args.scene)?;
    case::check(&scene)?;
    let folder = args.out.as_deref();
    let _place = folder.map(Place::folder).transpose()?;
    let silent = args.scene.quiet || args.scene.json;
    let (gpu, without_camera) = camera(args)?;
    if let Some(why) = without_camera.as_ref().filter(|_| !args.no_camera) {
        note(why);
    }
    let cases = cases(args, gpu.is_some(), &scene);
    let settled_after = scene.judging().settled_after;
    let mut budget = Budget {
        scene: &scene,
        fleet: simulation.fleet().clone(),
        settled_after,
        constants: !args.epsilon.is_empty(),
        runs: vec![],
        adapter: gpu.as_ref().map(Gpu::description),
        without_camera,
        complete: false,
    };
    let each = simulation.len();
    let what = format!(
        "{} of {}, {} s each",
        counted(cases.len(), "run"),
        stem(&args.scene.scene),
        scene.time.duration
    );
    let progress = Progress::begin(&what, each.saturating_mul(cases.len() as u64), silent);
    for (index, case) in cases.iter().enumerate() {
        let mut simulation = Simulation::new(case.build(&scene)?);
        eyes::open(&mut simulation, gpu.as_ref(), &args.scene.adapter, None)?;
        let go_on = |step: u64| {
            progress.at(index as u64 * each + step);
            !interrupt::asked()
        };
        match measure(&mut simulation, settled_after, go_on).map_err(Failure::Machine)? {
            Some(run) => budget.runs.push((*case, run)),
            None => break,
        }
    }
    progress.end();
    budget.complete = budget.runs.len() == cases.len();
    finish(&budget, folder, args)?;
    if !budget.complete {
        let done =
            format!("after {} of {}; they are printed", budget.runs.len(), counted(cases.len(), "run"));
        return Err(Failure::Interrupted(done));
    }
    Ok(())
}

/// Prints what has come out, and writes it where asked to.
fn finish(budget: &Budget<'_>, folder: Option<&Path>, args: &BudgetArgs) -> Outcome {
    if args.scene.json {
        crate::print::json(&files::as_json(budget));
    } else if !args.scene.quiet {
        table::print(budget);
    }
    let Some(folder) = folder else { return Ok(()) };
    let written = files::write(folder, budget, args.scene.quiet)?;
    if !args.scene.json && !args.scene.quiet {
        for path in written {
            say(&path.display().to_string());
        }
    }
    Ok(())
}

/// An adapter to draw for cameras, or why there is none.
fn camera(args: &BudgetArgs) -> Result<(Option<Gpu>, Option<String>), Failure> {
    if args.no_camera {
        return Ok((None, Some("no camera: --no-camera".to_owned())));
    }
    match Gpu::open(&AdapterChoice::from(args.scene.adapter.as_str())) {
        Ok(gpu) => Ok((Some(gpu), None)),
        // One that was asked for by name has to be there.
        Err(error) if args.scene.adapter != "auto" => Err(error.into()),
        Err(error) => Ok((None, Some(format!("no camera: {error}")))),
    }
}

/// What is run, in order.
fn cases(args: &BudgetArgs, camera: bool, scene: &Scene) -> Vec<Case> {
    if !args.epsilon.is_empty() {
        let level = if camera { Level::Camera } else { Level::Pixels(pixels_of(scene)) };
        let constants = sorted(&args.epsilon).into_iter().map(Some).chain([None]);
        return constants.map(|constant| Case { level, observer: Observer::Constant(constant) }).collect();
    }
    let mut levels: Vec<Level> = sorted(&args.pixel_noise).into_iter().map(Level::Pixels).collect();
    levels.extend(camera.then_some(Level::Camera));
    let with = |observer: Observer| levels.iter().map(move |level| Case { level: *level, observer });
    let truth = Case { level: Level::Truth, observer: Observer::HighGain };
    [truth].into_iter().chain(with(Observer::HighGain)).chain(with(Observer::Unscented)).collect()
}

/// Noise of corners of the scene's first follower, px.
fn pixels_of(scene: &Scene) -> f64 {
    let noise = |robot: &scene::Robot| match &robot.role {
        scene::Role::Follow(follow) => Some(follow.sensing.pixel_noise),
        scene::Role::Lead { .. } => None,
    };
    scene.robots.iter().find_map(noise).unwrap_or(0.0)
}

fn sorted(values: &[f64]) -> Vec<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}
