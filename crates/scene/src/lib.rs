//! Scene files: text to a checked experiment.
