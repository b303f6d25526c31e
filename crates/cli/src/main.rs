//! The program `echelon`: a file per subcommand.

mod accuracy;
mod args;
mod budget;
mod capture;
mod certify;
mod check;
mod compare;
mod dataset;
mod diff;
mod doctor;
mod eyes;
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

use args::{Command, Program};
use clap::Parser;
use failure::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let program = Program::parse();
    if matches!(
        program.command,
        Some(
            Command::Run(_)
                | Command::Replay(_)
                | Command::Capture(_)
                | Command::Lab(_)
                | Command::Film(_)
                | Command::Tune(_)
                | Command::Budget(_)
                | Command::Certify(_)
                | Command::Stills(_)
                | Command::Dataset(_)
                | Command::Figures(_)
                | Command::Accuracy(_)
                | Command::Doctor(_)
        )
    ) {
        quiet::restart_if_needed();
    }
    let outcome = match program.command {
        None => {
            welcome::welcome();
            Ok(())
        }
        Some(Command::Run(args)) => run::run(&args),
        Some(Command::Replay(args)) => replay::replay(&args),
        Some(Command::Diff(args)) => diff::diff(&args),
        Some(Command::Lab(args)) => lab::lab(args),
        Some(Command::Capture(args)) => capture::capture(&args),
        Some(Command::Film(args)) => film::film(&args),
        Some(Command::Tune(args)) => tune::tune(&args),
        Some(Command::Budget(args)) => budget::budget(&args),
        Some(Command::Stills(args)) => stills::stills(&args),
        Some(Command::Compare(args)) => compare::compare(&args),
        Some(Command::Certify(args)) => certify::certify(&args),
        Some(Command::Dataset(args)) => dataset::dataset(&args),
        Some(Command::Figures(args)) => figures::figures(&args),
        Some(Command::Accuracy(args)) => accuracy::accuracy(&args),
        Some(Command::Check(args)) => check::check(&args),
        Some(Command::Scenes(args)) => scenes::scenes(&args),
        Some(Command::Schema) => {
            print::schema();
            Ok(())
        }
        Some(Command::Doctor(args)) => doctor::doctor(&args),
        Some(Command::Completions { shell }) => {
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
