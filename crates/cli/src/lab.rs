//! `echelon lab`: the window.

use crate::Outcome;
use crate::args::size;
use crate::failure::Failure;
use crate::interrupt;
use clap::Args;
use scene::Override;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct LabArgs {
    /// Scene file or the name of a scene that comes with the program, a run folder or log.mcap to look through, or a picture
    /// that the lab has made; a shipped scene if left out
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Change a value of the scene, as an edit that can be undone; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<Override>,
    /// Adapter to draw with: its number in `echelon doctor`, vulkan, gl, part of its name, or both as in vulkan:llvmpipe; fails
    /// where there is none such
    #[arg(long, default_value = "auto")]
    adapter: String,
    /// Width and height of the window, such as 1280x800
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Stand at first instead of running
    #[arg(long)]
    paused: bool,
    /// Print what happens, and how fast the window was when it is closed
    #[arg(long)]
    timings: bool,
}

pub(crate) fn lab(args: LabArgs) -> Outcome {
    interrupt::watch();
    let options = lab::Options {
        scene: args.scene,
        set: args.set,
        adapter: args.adapter,
        paused: args.paused,
        size: args.size.map(|size| size.map(|side| side as f32)),
        timings: args.timings,
        stop: Some(interrupt::asked),
    };
    lab::open(options).map_err(|error| match error {
        lab::Error::Window(text) => Failure::Machine(text),
        lab::Error::Interrupted => Failure::Interrupted(error.to_string()),
    })
}
