//! `echelon check`: is a scene right?

use crate::Outcome;
use crate::args::CheckArgs;
use crate::failure::Failure;
use crate::load::load_file;
use crate::print::{note, say};
use vocabulary::counted;

pub(crate) fn check(args: &CheckArgs) -> Outcome {
    let mut problems = Vec::new();
    for path in &args.scenes {
        match load_file(path, &args.set) {
            Ok((scene, _)) if scene.film.beyond(scene.time.duration).is_some() => {
                let beyond = scene.film.beyond(scene.time.duration).unwrap_or_default();
                problems.push(format!("{}: {beyond}", path.display()));
            }
            Ok((scene, setup)) if args.resolved => {
                say(&format!("# {}: {}", path.display(), counted(setup.fleet.robots.len(), "robot")));
                say(&scene.to_toml());
            }
            Ok((scene, setup)) => {
                for late in scene.late() {
                    note(&format!("{}: note: {late}", path.display()));
                }
                let (robots, edges) = (setup.fleet.robots.len(), setup.fleet.edges.len());
                let length = scene.time.duration;
                let (robots, edges) = (counted(robots, "robot"), counted(edges, "edge"));
                say(&format!("{}: good: {}; {robots} and {edges}, {length} s", path.display(), scene.title));
            }
            Err(Failure::Usage(text)) => problems.push(text),
            Err(other) => return Err(other),
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(Failure::Usage(problems.join("\nerror: "))) }
}
