//! The loop: the only place that knows the order of a step.
