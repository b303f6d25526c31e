//! Vehicles and how they move: command in, snapshot out.
//!
//! Every kind of world stands behind [`World`]. [`Unicycles`] moves unicycles on the plane exactly; [`Physical`] moves
//! wheeled vehicles, unicycles and props among each other by forces, in rapier. [`wheeled`] is the vehicle itself: from
//! a command to throttle and steering, from there to the forces under four wheels.

pub mod arc;
pub mod guide;
mod physical;
mod prescribed;
mod touch;
pub mod unicycle;
pub mod wheeled;

pub use physical::{Physical, PropBody, RobotSetup, WorldSetup};
pub use unicycle::{Unicycle, Unicycles};
pub use wheeled::{Drivetrain, Wheeled};

use std::sync::Arc;
use vocabulary::{Command, Contact, Limits, Snapshot, StepInterpolant};

/// What a robot can do, and how it is driven: what may change as it moves.
#[derive(Debug, Clone)]
pub struct Handling {
    /// Bounds on speed, turn rate and acceleration.
    pub limits: Limits,
    /// Of one on wheels: the vehicle, of which driver and actuators count, and body, springs and tyres stay as they are.
    pub wheels: Option<Arc<Wheeled>>,
}

/// A place where robots move.
pub trait World: StepInterpolant + Send {
    /// The truth at this instant: the only way out.
    fn snapshot(&self) -> &Snapshot;

    /// What every robot shall do from now on, in the order of the snapshot: the only way in.
    fn apply(&mut self, commands: &[Command]);

    /// What every robot can do from now on, in the order of the snapshot. A follower without mass that is too fast or too
    /// slow for its limits has the nearest speed at once; one on wheels is driven there.
    fn apply_parameters(&mut self, handling: &[Handling]);

    /// A robot that went its own way goes by its commands from now on.
    fn release(&mut self, robot: usize);

    /// A robot has failed, and goes by its commands; one that is `removed` is not there any more: nothing touches it.
    fn fail(&mut self, robot: usize, removed: bool);

    /// Moves everything `duration` s on; positive.
    fn advance(&mut self, duration: f64);

    /// The contacts that are open, or that ended during the last advance.
    fn contacts(&self) -> &[Contact];

    /// A copy that goes on to the same future, bit for bit.
    fn save(&self) -> Box<dyn World>;
}
