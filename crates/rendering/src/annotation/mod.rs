//! Annotations of a picture: texts, charts, cards, and shapes on the ground.

pub(crate) mod annotations;
pub(crate) mod detections;
pub(crate) mod events;
pub(crate) mod inset;
pub(crate) mod labels;
pub(crate) mod overlays;
pub(crate) mod plans;
pub(crate) mod text_shaper;
