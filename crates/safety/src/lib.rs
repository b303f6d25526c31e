//! A safety filter: it moves a robot's command [dv/dt, ω] as little as barriers ask.
//!
//! A [`barrier`] turns what a robot senses into a half-plane of the commands that keep it safe. [`Filter`] cuts the limits
//! of the robot by these half-planes, class by class, and projects the command that was wished onto what is left. Where
//! nothing is left, a class gives way by the least slack that it needs, and the constraints in conflict are told by name.
//! Two unknowns need no solver.

pub mod barrier;
mod filter;
mod half_plane;
mod polygon;

pub use barrier::{Neighbour, Parameters, Placed, Sight};
pub use filter::{Filter, Wish};
pub use half_plane::HalfPlane;
