//! The program and its subcommands, as clap reads them.

use crate::{
    accuracy, budget, capture, certify, check, compare, dataset, diff, doctor, figures, film, lab, replay,
    run, scenes, stills, tune,
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
    /// Simulate a scene, record it, and hold it against what it expects
    Run(run::RunArgs),
    /// Run a recorded run again, and say whether it comes out the same bit for bit; or draw it as it was recorded
    Replay(replay::ReplayArgs),
    /// Say whether two recorded runs are the same bit for bit, and where they part
    Diff(diff::DiffArgs),
    /// Open a window in which set points and gains are tuned while the scene runs
    Lab(lab::LabArgs),
    /// Draw pictures of a scene at given times
    Capture(capture::CaptureArgs),
    /// Make a film of a scene
    Film(film::FilmArgs),
    /// Draw a run on one sheet of pictures, and all of it in one picture as under a stroboscope
    Stills(stills::StillsArgs),
    /// Compare pictures, or folders of pictures, as eyes would, and show where they differ
    Compare(compare::CompareArgs),
    /// Search gains that fit a scene's vehicles, and print them
    Tune(tune::TuneArgs),
    /// Say where errors of following come from: the scene with better and worse sensing, side by side
    Budget(budget::BudgetArgs),
    /// Say what the paper's theorems promise for a scene's run, and whether their premises are met
    Certify(certify::CertifyArgs),
    /// Write what the cameras of a scene see, with the truth about every tag: a labelled set of pictures
    Dataset(dataset::DatasetArgs),
    /// Make figures for print of the paper's runs or of a scene, and say whether they show what is claimed
    Figures(figures::FiguresArgs),
    /// Measure how well leaders are found and located in drawn pictures
    Accuracy(accuracy::AccuracyArgs),
    /// Read scenes and say what is wrong with them, without running
    Check(check::CheckArgs),
    /// List the scenes that come with the program, or print one to start from
    Scenes(scenes::ScenesArgs),
    /// Print the JSON Schema of scene files
    Schema,
    /// Say which adapters, drivers and encoders this machine has, and what is missing
    Doctor(doctor::DoctorArgs),
    /// Print completions for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
}
