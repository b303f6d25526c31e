//! Vehicles and how they move: command in, snapshot out.
//!
//! Every kind of world stands behind [`World`]. [`Unicycles`] moves unicycles on the plane exactly; [`Physical`] moves
//! wheeled vehicles, unicycles and props among each other by forces, in rapier. [`wheeled`] is the vehicle itself: from
//! a command to throttle and steering, from there to the forces under four wheels.

pub mod arc;
mod guide;
mod physical;
mod prescribed;
mod touch;
pub mod unicycle;
pub mod wheeled;

pub use physical::{Actor, Physical, PropBody, Stage};
pub use unicycle::{Unicycle, Unicycles};
pub use wheeled::{Drivetrain, Wheeled};

use vocabulary::{Command, Contact, Passage, Snapshot};

/// A place where robots move.
pub trait World: Passage + Send {
    /// The truth at this instant: the only way out.
    fn snapshot(&self) -> &Snapshot;

    /// What every robot shall do from now on, in the order of the snapshot: the only way in.
    fn apply(&mut self, commands: &[Command]);

    /// Moves everything `duration` s on; positive.
    fn advance(&mut self, duration: f64);

    /// The contacts that are open, or that ended during the last advance.
    fn contacts(&self) -> &[Contact];

    /// A copy that goes on to the same future, bit for bit.
    fn save(&self) -> Box<dyn World>;
}
