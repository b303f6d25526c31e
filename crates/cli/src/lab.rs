//! `echelon lab`: the window.

use crate::Outcome;
use crate::args::LabArgs;
use crate::failure::Failure;
use crate::interrupt;

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
