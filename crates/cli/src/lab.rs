//! `echelon lab`: the window.

use crate::Outcome;
use crate::args::LabArgs;
use crate::failure::Failure;

pub(crate) fn lab(args: LabArgs) -> Outcome {
    let options = lab::Options {
        scene: args.scene,
        set: args.set,
        adapter: args.adapter,
        paused: args.paused,
        size: args.size.map(|size| size.map(|side| side as f32)),
        timings: args.timings,
    };
    lab::open(options).map_err(|error| Failure::Machine(error.to_string()))
}
