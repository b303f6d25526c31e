//! The program `echelon`: a file per subcommand.

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
mod load;
mod picture;
mod playback;
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
mod times;
mod tune;
mod welcome;

use clap::Parser;
use failure::Failure;
use program::{Program, Subcommands};
use std::process::ExitCode;

fn main() -> ExitCode {
    let program = Program::parse();
    if matches!(
        program.command,
        Some(
            Subcommands::Run(_)
                | Subcommands::Replay(_)
                | Subcommands::Capture(_)
                | Subcommands::Lab(_)
                | Subcommands::Film(_)
                | Subcommands::Tune(_)
                | Subcommands::Budget(_)
                | Subcommands::Certify(_)
                | Subcommands::Stills(_)
                | Subcommands::Dataset(_)
                | Subcommands::Figures(_)
                | Subcommands::Accuracy(_)
                | Subcommands::Doctor(_)
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
        Some(Subcommands::Capture(args)) => capture::capture(&args),
        Some(Subcommands::Film(args)) => film::film(&args),
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
        Some(Subcommands::Schema) => {
            print::schema();
            Ok(())
        }
        Some(Subcommands::Doctor(args)) => doctor::doctor(&args),
        Some(Subcommands::Completions { shell }) => {
            print::completions(shell);
            Ok(())
        }
    };
    match outcome {
        Ok(()) if print::lost() => {
            let failure = Failure::Machine("standard output could not be written".to_owned());
            failure.tell();
            ExitCode::from(failure.code())
        }
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            failure.tell();
            ExitCode::from(failure.code())
        }
    }
}

/// What a subcommand returns.
type Outcome = Result<(), Failure>;
