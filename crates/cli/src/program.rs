//! The program and its subcommands, as clap reads them.

use crate::{
    accuracy, budget, capture, certify, check, compare, dataset, diff, doctor, figures, film, lab, laws,
    link, manuals, plan, replay, run, scenes, stills, sweep, tune,
};
use clap::{Parser, Subcommand};
use clap_complete::Shell;

/// Echelon, a 3D laboratory for vehicle formations.
#[derive(Debug, Parser)]
#[command(name = "echelon", version, about, max_term_width = 110)]
#[command(after_help = "Exit codes: 0 done and expectations met, 1 an expectation of the scene failed or a \
    replay or another run differs, \
    2 wrong usage or a bad scene, 3 the machine (no adapter, disk full), 130 interrupted.")]
pub(crate) struct Program {
    #[command(subcommand)]
    pub(crate) command: Option<Subcommands>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Subcommands {
    /// Simulate a scene, record the run, and check the scene's expectations
    Run(run::RunArgs),
    /// Run a recorded run again and check that it is the same bit for bit; or draw it as it was recorded
    Replay(replay::ReplayArgs),
    /// Compare two recorded runs bit for bit, and report where they diverge
    Diff(diff::DiffArgs),
    /// Open a window to tune set points and gains while the scene runs
    Lab(lab::LabArgs),
    /// Print a link that leads others to a run, and proves that theirs is the same
    Link(link::LinkArgs),
    /// Render pictures of a scene at given times
    Capture(capture::CaptureArgs),
    /// Render a film of a scene
    Film(film::FilmArgs),
    /// Render a contact sheet of a run, and a stroboscopic picture of all of it
    Stills(stills::StillsArgs),
    /// Compare pictures, or folders of pictures, by perceptual similarity, and show where they differ
    Compare(compare::CompareArgs),
    /// Plan the ways of lead robots to their goals without a run, and show them
    Plan(plan::PlanArgs),
    /// Make many runs of a scene that differ, and tell for which values and seeds they meet its expectations
    Sweep(Box<sweep::SweepArgs>),
    /// Search for gains that fit a scene's vehicles, and print them
    Tune(tune::TuneArgs),
    /// Compute an error budget: run the scene with better and worse sensing, side by side
    Budget(budget::BudgetArgs),
    /// Check which statements of the paper's theorems hold for a run, and whether their premises are met
    Certify(certify::CertifyArgs),
    /// Export the cameras' images with ground truth for every tag: a labelled data set
    Dataset(dataset::DatasetArgs),
    /// Plot figures for print of the paper's runs or of a scene, and check the claims about them
    Figures(figures::FiguresArgs),
    /// Benchmark the detection and localization of leaders in rendered pictures
    Accuracy(accuracy::AccuracyArgs),
    /// Validate scene files without running them
    Check(check::CheckArgs),
    /// List the shipped scenes, or print one to start from
    Scenes(scenes::ScenesArgs),
    /// List, check, start and test custom laws
    Laws(laws::LawsArgs),
    /// Print the JSON Schema of scene files
    Schema,
    /// Report this machine's graphics adapters, drivers and encoders, and what is missing
    Doctor(doctor::DoctorArgs),
    /// Print shell completions
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Write manual pages: echelon manuals share/man/man1
    Manuals(manuals::ManualsArgs),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;
    use clap::error::ErrorKind;

    #[test]
    fn arguments_are_consistent() {
        Program::command().debug_assert();
    }

    /// What stands after `such as` in a help text, up to the end of the word.
    fn examples(help: &str) -> impl Iterator<Item = &str> {
        let after = help.split("such as ").skip(1);
        after
            .filter_map(|rest| rest.split_whitespace().next())
            .map(|word| word.trim_end_matches([',', ';', ':']))
    }

    /// Every example of an option is taken by the option.
    #[test]
    fn examples_in_the_help_are_values_that_are_taken() {
        let (program, mut tried) = (Program::command(), 0);
        for command in program.get_subcommands() {
            for argument in command.get_arguments() {
                let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
                let Some(option) = argument.get_long() else { continue };
                for example in examples(&help) {
                    let line = ["echelon", command.get_name(), &format!("--{option}={example}")];
                    let kind = Program::try_parse_from(line).map_err(|error| error.kind());
                    let refused =
                        [ErrorKind::ValueValidation, ErrorKind::InvalidValue, ErrorKind::UnknownArgument];
                    assert!(!kind.is_err_and(|kind| refused.contains(&kind)), "{line:?}");
                    tried += 1;
                }
            }
        }
        assert!(tried >= 10, "{tried} examples");
    }
}
