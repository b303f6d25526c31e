//! The 3D view: the free camera, the pointer and annotations on the ground.

pub mod annotations;
pub mod camera;
pub mod feasibility;
pub mod viewport;
