//! `echelon sweep merge` and `echelon sweep show`: studies that were run before.

use super::{ShownArgs, folder, tell};
use crate::Outcome;
use crate::failure::Failure;
use crate::print::note;
use clap::Args;
use scene::Study;
use std::path::{Path, PathBuf};
use sweeps::{Experiment, StudyFolder, merge as join};
use vocabulary::counted;

#[derive(Debug, Args)]
pub(super) struct MergeArgs {
    /// Folder of the whole study, which is made
    #[arg(value_name = "DIR")]
    out: PathBuf,
    /// Folders of shards, and files of rows
    #[arg(value_name = "SHARD", required = true)]
    shards: Vec<PathBuf>,
    /// The study file; by default the one in the first of the folders
    #[arg(long, value_name = "FILE")]
    study: Option<PathBuf>,
    /// Replace what an earlier study left in the folder
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    shown: ShownArgs,
}

#[derive(Debug, Args)]
pub(super) struct ShowArgs {
    /// Folder of a study
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    #[command(flatten)]
    shown: ShownArgs,
}

pub(super) fn merge(args: &MergeArgs) -> Outcome {
    let first = || args.shards.iter().find(|shard| shard.is_dir()).cloned();
    let experiment = match (&args.study, first()) {
        (Some(file), _) => {
            let study = Study::load(file).map_err(|errors| Failure::Usage(errors.to_string()))?;
            Experiment::new(study)?
        }
        (None, Some(folder)) => recalled(&folder)?,
        (None, None) => {
            return Err(Failure::Usage(
                "files of rows do not say which study they are of: name it with --study".to_owned(),
            ));
        }
    };
    let missing = join(&args.out, &args.shards, &experiment, args.force)?;
    if !missing.is_empty() {
        return Err(Failure::Usage(format!(
            "{} of the study {} missing: {missing}; make them with --range, and merge again",
            counted(missing.len(), "run"),
            if missing.len() == 1 { "is" } else { "are" }
        )));
    }
    let summary = folder::complete(&args.out, &experiment, &args.shown, true, &[])?;
    tell::study(&experiment, &summary, &args.out, &tell::SweepEffort::default(), &args.shown, &[]);
    Ok(())
}

pub(super) fn show(args: &ShowArgs) -> Outcome {
    let manifest = StudyFolder::manifest_of(&args.folder)?;
    let experiment = recalled(&args.folder)?;
    let whole = manifest.complete && manifest.range == [0, manifest.runs];
    let summary = folder::complete(&args.folder, &experiment, &args.shown, whole, &[])?;
    if !whole && !args.shown.quiet {
        note(&format!("{} of {} runs are there so far", summary.runs, manifest.runs));
    }
    tell::study(&experiment, &summary, &args.folder, &tell::SweepEffort::default(), &args.shown, &[]);
    Ok(())
}

/// The experiment whose rows are in a folder; its scene has to be what it was.
fn recalled(folder: &Path) -> Result<Experiment, Failure> {
    let manifest = StudyFolder::manifest_of(folder)?;
    let study =
        Study::load(&StudyFolder::study_file(folder)).map_err(|errors| Failure::Usage(errors.to_string()))?;
    let experiment = Experiment::new(study)?;
    if experiment.fingerprint() != manifest.fingerprint {
        return Err(Failure::Usage(format!(
            "{} holds a study by {} of a scene that has changed since, or that another version reads otherwise",
            folder.display(),
            manifest.program
        )));
    }
    Ok(experiment)
}
