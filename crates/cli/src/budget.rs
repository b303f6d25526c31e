//! `echelon budget`: where errors of following come from. The scene runs again and again on the same seed, from followers
//! that are told the truth over corners of tags with more and more noise to pictures of cameras, with both observers; or,
//! with `--epsilon`, with one observer constant after the other.

mod files;
mod picture;
mod table;

use crate::args::{SceneArgs, within};
use crate::failure::Failure;
use crate::load::{load, stem};
use crate::print::{note, say};
use crate::progress::Progress;
use crate::{Outcome, cameras, interrupt};
use clap::Args;
use output::Place;
use rendering::Gpu;
use std::path::{Path, PathBuf};
use studies::SceneRun;
use studies::budget::{Budget, check, epsilon_cases, sensing_cases};
use vocabulary::counted;

#[derive(Debug, Args)]
pub(crate) struct BudgetArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Folder for budget.svg, .json and .csv, with --epsilon for epsilon.svg, .json and .csv; it may hold other files
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Standard deviations of the corner noise to try, px
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        allow_negative_numbers = true,
        default_value = "0,0.02,0.05,0.1,0.2,0.5,1",
        value_parser = within(0.0..=50.0, "write pixels from 0 to 50, such as 0,0.1,0.5")
    )]
    pixel_noise: Vec<f64>,
    /// Compare observer constants ε instead, s, such as 0.001,0.003,0.01,0.03,0.1, with the adaptive ε that follows from
    /// the noise
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        allow_negative_numbers = true,
        conflicts_with = "pixel_noise",
        value_parser = within(1e-6..=100.0, "write seconds from 0.000001 to 100, such as 0.001,0.01,0.1")
    )]
    epsilon: Vec<f64>,
    /// Skip camera sensing; with --epsilon, use geometric sensing instead
    #[arg(long)]
    no_camera: bool,
}

pub(crate) fn budget(args: &BudgetArgs) -> Outcome {
    let SceneRun { scene, simulation } = load(&args.scene)?;
    check(&scene)?;
    let folder = args.out.as_deref();
    let _place = folder.map(Place::folder).transpose()?;
    let silent = args.scene.quiet || args.scene.json;
    let camera = camera(args)?;
    if let Some(why) = camera.as_ref().err().filter(|_| !args.no_camera) {
        note(why);
    }
    let gpu = camera.as_ref().ok();
    let constants = !args.epsilon.is_empty();
    let cases = if constants {
        epsilon_cases(&args.epsilon, gpu.is_some(), &scene)
    } else {
        sensing_cases(&args.pixel_noise, gpu.is_some())
    };
    let mut budget = Budget::new(&scene, simulation.fleet().clone(), constants);
    budget.camera = camera.as_ref().map(Gpu::description).map_err(String::clone);
    let each = simulation.len();
    let what = format!(
        "{} of {}, {} s each",
        counted(cases.len(), "run"),
        stem(&args.scene.scene),
        scene.time.duration
    );
    let progress = Progress::begin(&what, each.saturating_mul(cases.len() as u64), silent);
    budget.measure(&cases, &mut cameras::factory(gpu), |index, step| {
        progress.at(index as u64 * each + step);
        !interrupt::asked()
    })?;
    drop(progress);
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
fn camera(args: &BudgetArgs) -> Result<Result<Gpu, String>, Failure> {
    if args.no_camera {
        return Ok(Err("no camera: --no-camera".to_owned()));
    }
    Ok(args.scene.adapter.open_if_any()?.map_err(|error| format!("no camera: {error}")))
}
