//! `echelon figures`: the paper's evidence, or that of any scene, made anew: figures for print, the numbers behind them, a
//! report in one file, and for every sentence about a figure whether it is so.

mod drawn;
mod folder;
mod meter;
mod tell;

use crate::args::AdapterArgs;
use crate::failure::Failure;
use crate::load::{build, read, stem, with_seed};
use crate::print::note;
use crate::{Outcome, cameras, interrupt};
use clap::Args;
use folder::Folder;
use meter::Meter;
use rendering::Gpu;
use report::{FinishedRun, PlannedRun, Rasterizer, Report, Tracer};
use scene::{Override, Scene};
use std::path::PathBuf;
use std::time::Instant;
use studies::{COMMIT, PROGRAM, SceneRun};

/// Figures for print, with what they show and whether it is so. Without a scene, those of the paper.
#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub(crate) struct FiguresArgs {
    /// Scene file or the name of a shipped scene; by default the paper's two cases and its seven robots
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Folder for figures (SVG, PNG, PDF, CSV), films, claims.json and report.html
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Override a value of the scene, such as time.duration=5; may be repeated
    #[arg(long, value_name = "KEY=VALUE", requires = "scene")]
    set: Vec<Override>,
    /// Random seed, in place of the scene's
    #[arg(value_parser = crate::args::seed, allow_negative_numbers = true, long, requires = "scene")]
    seed: Option<u64>,
    /// Replace an earlier set of figures in the folder
    #[arg(long)]
    force: bool,
    /// Skip what has to be rendered: snake views and films
    #[arg(long)]
    no_pictures: bool,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print claims and files as JSON
    #[arg(long)]
    json: bool,
    /// Print errors only
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

/// What figures are of.
struct Subject {
    /// A scene other than the paper's, and the name of its file.
    own: Option<(Scene, String)>,
    jobs: Vec<PlannedRun>,
}

pub(crate) fn figures(args: &FiguresArgs) -> Outcome {
    let began = Instant::now();
    let subject = subject(args)?;
    interrupt::watch();
    let adapter = adapter(args)?;
    if let Some(why) = adapter.as_ref().err().filter(|_| !args.no_pictures) {
        note(why);
    }
    let gpu = adapter.as_ref().ok();
    let mut prepared = vec![];
    for job in &subject.jobs {
        prepared.push(ready(job, gpu, &args.adapter.name)?);
    }
    let shows: Vec<drawn::FilmedRun> = gpu.map_or_else(Vec::new, |_| drawn::shows(&subject));
    let mut folder = Folder::create(&args.out, args.force)?;
    let mut meter = Meter::begin(args, &subject, &prepared, &shows);
    let made = make(args, &subject, prepared, gpu, &shows, &mut folder, &mut meter);
    drop(meter);
    match made {
        Ok((mut report, runs)) => {
            report
                .left_out
                .extend(adapter.as_ref().err().map(|why| format!("Snake views and films: {why}.")));
            report.versions = versions(gpu);
            folder.write("report.html", report::page(&report, rendering::FONT).as_bytes())?;
            folder.close("complete", Some((&report, runs.as_slice())))?;
            tell::tell(args, &report, &runs, &folder, began.elapsed().as_secs_f64());
            Ok(())
        }
        Err(failure) => {
            let status = if matches!(failure, Failure::Interrupted(_)) { "interrupted" } else { "failed" };
            // The first failure is the one to tell.
            let _ = folder.close(status, None);
            Err(failure.but(&format!("{} keeps what was written before", args.out.display())))
        }
    }
}

fn subject(args: &FiguresArgs) -> Result<Subject, Failure> {
    let Some(path) = &args.scene else {
        let jobs = report::paper_runs().map_err(|errors| Failure::Usage(errors.to_string()))?;
        return Ok(Subject { own: None, jobs });
    };
    let scene = read(path, &with_seed(&args.set, args.seed)?)?;
    Ok(Subject { jobs: report::scene_runs(&scene), own: Some((scene, stem(path))) })
}

/// An adapter to draw with, or why there is none.
fn adapter(args: &FiguresArgs) -> Result<Result<Gpu, String>, Failure> {
    if args.no_pictures {
        return Ok(Err("--no-pictures was given".to_owned()));
    }
    Ok(args.adapter.open_if_any()?.map_err(|error| format!("there is nothing to draw with ({error})")))
}

/// A run before its first step.
fn ready(job: &PlannedRun, gpu: Option<&Gpu>, adapter: &str) -> Result<SceneRun, Failure> {
    let mut run = build(job.scene.clone(), &job.name)?;
    cameras::attach(&mut run, gpu, adapter, None)?;
    Ok(run)
}

/// Runs, draws and writes everything but the report.
fn make(
    args: &FiguresArgs,
    subject: &Subject,
    ready: Vec<SceneRun>,
    gpu: Option<&Gpu>,
    shows: &[drawn::FilmedRun],
    folder: &mut Folder,
    meter: &mut Meter,
) -> Result<(Report, Vec<FinishedRun>), Failure> {
    let mut runs = vec![];
    for (job, ready) in subject.jobs.iter().zip(ready) {
        runs.push(run(job, ready, meter)?);
    }
    let mut report = match &subject.own {
        None => report::paper(&runs),
        Some((scene, _)) => report::of_scene(scene, &runs),
    };
    if let Some(gpu) = gpu {
        for show in shows {
            drawn::draw(show, gpu, &args.adapter.name, &runs, &mut *folder, &mut *meter, &mut report)?;
        }
    }
    let rasterizer = Rasterizer::new(&[rendering::FONT]);
    let printed = |error: report::RasterizerError| Failure::Machine(error.to_string());
    for item in &report.items {
        stop(meter)?;
        folder.write(&format!("{}.svg", item.stem), item.svg.as_bytes())?;
        folder.write(&format!("{}.csv", item.stem), item.csv.as_bytes())?;
        let png = item.picture.clone().map_or_else(|| rasterizer.png(&item.svg, DPI).map_err(printed), Ok)?;
        folder.write(&format!("{}.png", item.stem), &png)?;
        folder.write(&format!("{}.pdf", item.stem), &rasterizer.pdf(&item.svg).map_err(printed)?)?;
        meter.figure();
    }
    Ok((report, runs))
}

/// Pixels an inch of figures.
const DPI: f32 = 300.0;

fn run(job: &PlannedRun, mut run: SceneRun, meter: &mut Meter) -> Result<FinishedRun, Failure> {
    let colours = rendering::robot_colours(run.simulation.fleet());
    let mut tracer = Tracer::new(job.name.clone(), &job.scene, &run.simulation, &colours, job.transient);
    run.step_through(|simulation, _| {
        tracer.push(simulation.record());
        meter.sample();
        !interrupt::asked()
    })?;
    stop(meter)?;
    Ok(FinishedRun { case: job.case, variant: job.variant, trace: tracer.finish() })
}

/// Fails where the program has been asked to stop.
fn stop(meter: &Meter) -> Outcome {
    if !interrupt::asked() {
        return Ok(());
    }
    Err(Failure::Interrupted(format!("{}; there is no report yet", meter.so_far())))
}

/// What made the figures.
fn versions(gpu: Option<&Gpu>) -> Vec<[String; 2]> {
    let commit = COMMIT.unwrap_or("unknown");
    let drawn = gpu.map_or_else(|| "none".to_owned(), Gpu::description);
    [("made with", PROGRAM), ("commit", commit), ("pictures drawn with", &*drawn)]
        .map(|(name, value)| [name.to_owned(), value.to_owned()])
        .to_vec()
}
