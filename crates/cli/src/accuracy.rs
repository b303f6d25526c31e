//! `echelon accuracy`: how well leaders are found and located, over random poses that are drawn as cameras see them.

mod table;

use crate::args::AdapterArgs;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::{Outcome, cameras, interrupt, print};
use clap::Args;
use serde_json::json;
use std::time::Instant;
use vocabulary::counted;

#[derive(Debug, Args)]
pub(crate) struct AccuracyArgs {
    /// Number of random poses of the leader
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    poses: u64,
    /// Random seed of poses and noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn accuracy(args: &AccuracyArgs) -> Outcome {
    let began = Instant::now();
    interrupt::watch();
    let gpu = args.adapter.open()?;
    let what = format!("Locating a leader in {}", counted(args.poses, "pose"));
    let progress = Progress::begin(&what, args.poses, args.json);
    let clock = || began.elapsed().as_secs_f64();
    let mut renderer = cameras::factory(Some(&gpu));
    let found = studies::accuracy::accuracy(args.poses, args.seed, &mut renderer, &clock, |done| {
        progress.at(done);
        !interrupt::asked()
    })?;
    drop(progress);
    let seconds = clock();
    let adapter = gpu.description();
    if args.json {
        let mut value = table::as_json(&found.bins, &found.medians);
        value["poses"] = json!(found.poses);
        value["seed"] = json!(args.seed);
        value["adapter"] = json!(adapter);
        value["wall_seconds"] = json!(seconds);
        print::json(&value);
    } else {
        let poses = counted(found.poses, "pose");
        print::say(&format!("{poses}, seed {}, drawn in {seconds:.1} s with {adapter}\n", args.seed));
        for line in table::text(&found.bins, &found.medians) {
            print::say(&line);
        }
    }
    if found.poses < args.poses {
        return Err(Failure::Interrupted(format!(
            "after {} of {}; they are printed",
            found.poses,
            counted(args.poses, "pose")
        )));
    }
    Ok(())
}
