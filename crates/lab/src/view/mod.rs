//! The 3D view: a camera in the hand, handles on the ground, and what is drawn to explain.

pub mod camera;
mod hand;
pub mod holding;
pub mod sketching;
pub mod viewport;
