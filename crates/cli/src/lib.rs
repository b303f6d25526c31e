//! The program `echelon`: a file per subcommand. It is a library, so that the module for Python holds it, too.

mod accuracy;
mod args;
mod budget;
mod cameras;
mod capture;
mod certify;
mod check;
mod compare;
mod dataset;
mod diff;
mod doctor;
mod failure;
mod figures;
mod film;
mod interrupt;
mod junit;
mod lab;
mod laws;
mod link;
mod load;
mod manuals;
mod plan;
mod print;
mod program;
mod progress;
mod quiet;
mod recorded;
mod replaced;
mod replay;
mod run;
mod scenes;
mod stills;
mod summary;
mod sweep;
mod terminal;
mod tune;
mod welcome;

use clap::Parser;
use failure::Failure;
use program::{Program, Subcommands};
use std::ffi::OsString;

/// Runs the program to its end, and returns its exit code. The first of `arguments` is the name under which it was called.
///
/// Help, and arguments that are none, end the process.
pub fn program(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let program = Program::parse_from(arguments);
    // All others may open a graphics adapter.
    if !matches!(
        program.command,
        None | Some(
            Subcommands::Diff(_)
                | Subcommands::Compare(_)
                | Subcommands::Check(_)
                | Subcommands::Plan(_)
                | Subcommands::Scenes(_)
                | Subcommands::Laws(_)
                | Subcommands::Schema
                | Subcommands::Completions { .. }
                | Subcommands::Manuals(_)
        )
    ) {
        quiet::restart_if_needed();
    }
    let outcome = match program.command {
        None => {
            welcome::welcome();
            Ok(())
        }
        Some(Subcommands::Run(args)) => run::run(&args),
        Some(Subcommands::Replay(args)) => replay::replay(&args),
        Some(Subcommands::Diff(args)) => diff::diff(&args),
        Some(Subcommands::Lab(args)) => lab::lab(args),
        Some(Subcommands::Link(args)) => link::link(&args),
        Some(Subcommands::Capture(args)) => capture::capture(&args),
        Some(Subcommands::Film(args)) => film::film(&args),
        Some(Subcommands::Plan(args)) => plan::plan(&args),
        Some(Subcommands::Sweep(args)) => sweep::sweep(&args),
        Some(Subcommands::Tune(args)) => tune::tune(&args),
        Some(Subcommands::Budget(args)) => budget::budget(&args),
        Some(Subcommands::Stills(args)) => stills::stills(&args),
        Some(Subcommands::Compare(args)) => compare::compare(&args),
        Some(Subcommands::Certify(args)) => certify::certify(&args),
        Some(Subcommands::Dataset(args)) => dataset::dataset(&args),
        Some(Subcommands::Figures(args)) => figures::figures(&args),
        Some(Subcommands::Accuracy(args)) => accuracy::accuracy(&args),
        Some(Subcommands::Check(args)) => check::check(&args),
        Some(Subcommands::Scenes(args)) => scenes::scenes(&args),
        Some(Subcommands::Laws(args)) => laws::laws(&args),
        Some(Subcommands::Schema) => {
            print::schema();
            Ok(())
        }
        Some(Subcommands::Doctor(args)) => doctor::doctor(&args),
        Some(Subcommands::Completions { shell }) => {
            print::completions(shell);
            Ok(())
        }
        Some(Subcommands::Manuals(args)) => manuals::manuals(&args),
    };
    let lost = || Failure::Machine("standard output could not be written".to_owned());
    let outcome = outcome.and_then(|()| if print::lost() { Err(lost()) } else { Ok(()) });
    outcome.map_or_else(
        |failure| {
            failure.tell();
            failure.code()
        },
        |()| 0,
    )
}

/// What a subcommand returns.
type Outcome = Result<(), Failure>;
