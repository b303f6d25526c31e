//! `echelon check`: is a scene right?

use crate::failure::Failure;
use crate::load::load_file;
use crate::print::{note, say};
use crate::{Outcome, link};
use clap::Args;
use scene::Override;
use std::path::PathBuf;
use studies::SceneRun;
use vocabulary::counted;

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Scene files, names of shipped scenes, or links in quotes
    #[arg(value_name = "SCENE", required = true)]
    scenes: Vec<PathBuf>,
    /// Override a value of every scene
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<Override>,
    /// Print the resolved scene with every default written out
    #[arg(long)]
    resolved: bool,
}

pub(crate) fn check(args: &CheckArgs) -> Outcome {
    let mut problems = Vec::new();
    for path in &args.scenes {
        let name =
            link::meant(path)?.map_or_else(|| path.display().to_string(), |link| link.name().to_owned());
        match load_file(path, &args.set) {
            Ok(run) if run.scene.film.beyond(run.scene.time.duration).is_some() => {
                let beyond = run.scene.film.beyond(run.scene.time.duration).unwrap_or_default();
                problems.push(format!("{name}: {beyond}"));
            }
            Ok(run) if args.resolved => {
                say(&format!("# {name}: {}", counted(run.simulation.fleet().robots.len(), "robot")));
                say(&run.scene.to_toml());
            }
            Ok(run) => {
                for remark in run.remarks() {
                    note(&format!("{name}: note: {remark}"));
                }
                let SceneRun { scene, simulation } = run;
                let fleet = simulation.fleet();
                let (robots, edges) = (fleet.robots.len(), fleet.edges.len());
                let length = scene.time.duration;
                let (robots, edges) = (counted(robots, "robot"), counted(edges, "edge"));
                say(&format!("{name}: good: {}; {robots} and {edges}, {length} s", scene.title));
            }
            Err(Failure::Usage(text)) => problems.push(text),
            Err(other) => return Err(other),
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(Failure::Usage(problems.join("\nerror: "))) }
}
