//! Vehicles and how they move: command in, snapshot out.
//!
//! Every kind of vehicle world stands behind [`World`]; exact unicycles are in [`unicycle`].

pub mod arc;
pub mod unicycle;

pub use unicycle::{Unicycle, Unicycles};

use vocabulary::{Command, Passage, Snapshot};

/// A place where robots move.
pub trait World: Passage + Send {
    /// The truth at this instant: the only way out.
    fn snapshot(&self) -> &Snapshot;

    /// What every robot shall do from now on, in the order of the snapshot: the only way in.
    fn apply(&mut self, commands: &[Command]);

    /// Moves everything `duration` s on; positive.
    fn advance(&mut self, duration: f64);
}
