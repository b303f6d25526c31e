//! A law that decides for many followers at once, such as a function over arrays.

use crate::custom_law::Fault;
use crate::declaration::Knowledge;
use crate::input::Input;
use std::fmt;
use vocabulary::Command;

/// A law that decides for many followers at once, one leader each. It keeps its own memory.
pub trait BatchLaw: fmt::Debug + Send + Sync {
    /// Its name, for captions.
    fn name(&self) -> &str;

    /// What it has to know of the leaders. With [`Knowledge::Output`] it is asked once a sample, for all followers. Otherwise it
    /// is told what leaders do in the same sample, and so it is asked once per depth of the graph, leaders before followers.
    fn knows(&self) -> Knowledge;

    /// The commands of one control sample, one for each of `inputs`, which are in the order of the robots.
    ///
    /// # Errors
    /// [`Fault`] where there are none; the run ends.
    fn decide(&mut self, inputs: &[BatchInput<'_>]) -> Result<Vec<Command>, Fault>;

    /// The same law with a memory of its own, equal to this one's.
    fn fork(&self) -> Box<dyn BatchLaw>;
}

impl Clone for Box<dyn BatchLaw> {
    fn clone(&self) -> Self {
        self.fork()
    }
}

/// What a law is told of one follower.
#[derive(Debug, Clone, Copy)]
pub struct BatchInput<'a> {
    /// Number of the follower among all robots.
    pub robot: usize,
    /// Whether it meets its leader now: at the first sample, and after the leader was lost or changed.
    pub meets: bool,
    /// Its numbers, with one leader.
    pub input: Input<'a>,
}
