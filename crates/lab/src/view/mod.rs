//! The 3D view: a camera in the hand, handles on the ground, and what is drawn to explain.

pub mod annotations;
pub mod camera;
pub mod feasibility;
pub mod viewport;
