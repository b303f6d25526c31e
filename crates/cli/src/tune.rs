//! `echelon tune`: gains that fit the vehicles of a scene.

use crate::args::SceneArgs;
use crate::failure::Failure;
use crate::load::{load, stem};
use crate::print::{json, say};
use crate::progress::Progress;
use crate::{Outcome, interrupt};
use clap::Args;
use scene::FollowerScatter;
use serde_json::json;
use std::collections::BTreeMap;
use studies::SceneRun;
use studies::copies::StartScatter;
use studies::tune::{Trial, TuneEffort, tune as search};
use vocabulary::counted;

#[derive(Debug, Args)]
pub(crate) struct TuneArgs {
    #[command(flatten)]
    scene: SceneArgs,
    /// Largest number of runs of the scene
    #[arg(long, value_name = "N", default_value_t = 120, value_parser = clap::value_parser!(u64).range(4..=100_000))]
    trials: u64,
    /// Runs of a trial, each with a seed of its own: gains have to hold over all of them
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    seeds: u64,
    /// Start every follower within so many metres of where the scene puts it, with a heading that is off by so much: 0.5 or
    /// "0.5,20 deg"
    #[arg(long, value_name = "M[,ANGLE]", value_parser = crate::sweep::scatter)]
    scatter: Option<FollowerScatter>,
}

pub(crate) fn tune(args: &TuneArgs) -> Outcome {
    let SceneRun { scene, simulation } = load(&args.scene)?;
    if simulation.needs_cameras() {
        let text = format!(
            "{}: a hundred runs on pictures take too long to tune on; tune on calculated tags instead, which err alike: \
             --set sensing.kind=geometric --set sensing.pixel_noise=0.05",
            args.scene.scene.display()
        );
        return Err(Failure::Usage(text));
    }
    let quiet = args.scene.quiet || args.scene.json;
    let what =
        format!("Tuning {}, at most {}", stem(&args.scene.scene), counted(args.trials * args.seeds, "run"));
    let progress = Progress::begin(&what, args.trials, quiet);
    let (mut tried, mut interrupted) = (0, false);
    let look = |_: &Trial| {
        tried += 1;
        progress.at(tried);
        interrupted = interrupt::asked();
        !interrupted
    };
    let FollowerScatter { position, heading } = args.scatter.unwrap_or_default();
    let followers = scene.robots.iter().enumerate().filter(|(_, robot)| robot.role.follow().is_some());
    let scatter = StartScatter { robots: followers.map(|(index, _)| index).collect(), position, heading };
    // The scene's own gains are the first trial.
    let most = usize::try_from(args.trials - 1).unwrap_or(usize::MAX);
    let effort = TuneEffort { most, seeds: args.seeds, scatter };
    let found = search(&scene, &effort, look).map_err(|error| Failure::Usage(error.to_string()))?;
    drop(progress);
    let [first, best] = &found;
    if args.scene.json {
        json(&json!({ "trials": tried, "first": first, "best": best }));
    } else if !args.scene.quiet {
        say(&format!("{}\n{}\n", scene.title, studies::caption(&scene)));
        say(&format!(
            "{:12} {:>8} {:>26} {:>9} {:>9}",
            "", "cost", "error in the second half", "limited", "contacts"
        ));
        row("as it is", first);
        row("best", best);
        if let Some((law, names)) =
            studies::tune::tuned(&scene).filter(|(_, names)| names.len() < scene.followers().count())
        {
            say(&format!("\ntuned: {law}, of {}; other followers keep theirs", names.join(", ")));
        }
        let each = if args.seeds > 1 { format!(" of {}", counted(args.seeds, "run")) } else { String::new() };
        say(&format!("\nof {}{each}; in the scene:\n", counted(tried, "trial")));
        say(&in_scene(&best.gains));
    }
    if interrupted {
        return Err(Failure::Interrupted(format!(
            "after {}; the best so far is printed",
            counted(tried, "trial")
        )));
    }
    Ok(())
}

/// Gains as a scene has them.
fn in_scene(gains: &BTreeMap<String, f64>) -> String {
    match ["k", "beta", "slope", "epsilon"].map(|name| gains.get(name)) {
        [Some(k), Some(beta), Some(slope), Some(epsilon)] if gains.len() == 4 => {
            format!("[law]\nk = {k}\nbeta = {beta}\nslope = {slope}\n\n[observer]\nepsilon = {epsilon}")
        }
        _ => {
            let value = |(name, value): (&String, &f64)| format!("{name} = {value}");
            let all: Vec<String> = gains.iter().map(value).collect();
            format!("[law]\nparameters = {{ {} }}", all.join(", "))
        }
    }
}

fn row(name: &str, trial: &Trial) {
    let [distance, bearing] = trial.late_error;
    let error = format!("{distance:.4} m {:>8.3}°", bearing.to_degrees());
    let limited = format!("{:.1} %", trial.limited * 100.0);
    say(&format!("{name:12} {:>8.2} {error:>26} {limited:>9} {:>9}", trial.cost, trial.contacts));
}
