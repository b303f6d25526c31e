//! `echelon manuals`: manual pages.

use crate::Outcome;
use crate::failure::Failure;
use crate::program::Program;
use clap::{Args, CommandFactory};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ManualsArgs {
    /// The folder that they go to
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Writes a page for the program and one for every subcommand.
pub(crate) fn manuals(args: &ManualsArgs) -> Outcome {
    let folder = &args.folder;
    let failed =
        |error: std::io::Error| Failure::Machine(format!("cannot write to {}: {error}", folder.display()));
    std::fs::create_dir_all(folder).map_err(failed)?;
    let mut program = Program::command().disable_help_subcommand(true);
    // Gives subcommands their whole names, such as echelon-run.
    program.build();
    let mut pages = vec![program];
    while let Some(page) = pages.pop() {
        pages.extend(page.get_subcommands().cloned());
        let name = page.get_display_name().unwrap_or_else(|| page.get_name()).to_owned();
        let mut text = Vec::new();
        clap_mangen::Man::new(page).render(&mut text).map_err(failed)?;
        output::write_whole(&folder.join(format!("{name}.1")), &text)
            .map_err(|error| Failure::Machine(error.to_string()))?;
    }
    Ok(())
}
