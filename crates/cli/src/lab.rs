//! `echelon lab`: the window.

use crate::Outcome;
use crate::args::{AdapterArgs, size};
use crate::failure::Failure;
#[cfg(feature = "lab")]
use crate::load::read_file;
#[cfg(feature = "lab")]
use crate::{interrupt, link};
use clap::Args;
use scene::Override;
#[cfg(feature = "lab")]
use signal_hook::low_level;
#[cfg(feature = "lab")]
use std::path::Path;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct LabArgs {
    /// Scene file or the name of a shipped scene, a run folder or log.mcap to browse, a picture that the lab has saved,
    /// or a link in quotes; by default a shipped scene
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Override a value of the scene, as an edit that can be undone; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<Override>,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Window size, such as 1280x800
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Start paused
    #[arg(long)]
    paused: bool,
    /// Print events, and frame times when the window closes
    #[arg(long)]
    timings: bool,
}

/// A program without the window says where it is to be had.
#[cfg(not(feature = "lab"))]
pub(crate) fn lab(_: LabArgs) -> Outcome {
    let text =
        "this program was built without its window: build it with the feature `lab`, which is on by default";
    Err(Failure::Usage(text.to_owned()))
}

/// Opens the window, and waits until it is closed.
#[cfg(feature = "lab")]
pub(crate) fn lab(args: LabArgs) -> Outcome {
    if let Some(path) = &args.scene {
        check_there(path)?;
    }
    interrupt::watch();
    let options = lab::Options {
        scene: args.scene,
        set: args.set,
        adapter: args.adapter.name,
        paused: args.paused,
        size: args.size.map(|size| size.map(|side| side as f32)),
        timings: args.timings,
        stop: Some(interrupt::asked),
        abandon: Some(abandon),
    };
    lab::open(options).map_err(|error| match error {
        lab::Error::Window(text) => Failure::Machine(text),
        lab::Error::Interrupted => Failure::Interrupted(error.to_string()),
    })
}

/// Fails where there is nothing to open, and the window would stay empty. A scene with mistakes is opened: it is mended there.
#[cfg(feature = "lab")]
fn check_there(path: &Path) -> Outcome {
    let shipped = || path.to_str().and_then(scene::shipped).is_some();
    if path.is_dir() && !path.join(recording::log::FILE).exists() {
        let (shown, log) = (path.display(), recording::log::FILE);
        return Err(Failure::Usage(format!(
            "{shown} is a folder without {log}: name a scene file, a run folder, or a scene that `echelon scenes` lists"
        )));
    }
    if path.exists() || link::meant(path)?.is_some() || shipped() {
        return Ok(());
    }
    read_file(path, &[]).map(drop)
}

/// Ends the process as [`lab()`] would have failed: the window library leaves no way back to it.
#[cfg(feature = "lab")]
fn abandon(reason: &str) {
    let failure = Failure::Machine(reason.to_owned());
    failure.tell();
    // Nothing that runs at an ordinary exit may wait for a window that is gone.
    low_level::exit(failure.code().into())
}
