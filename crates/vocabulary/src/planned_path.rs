//! The way of a formation to its goals, as it is planned.

use crate::Pose;

/// A plan of a lead robot for all that follow it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlannedPath {
    /// The robots that it holds for, the lead first.
    pub robots: Vec<usize>,
    /// In the order of time.
    pub points: Vec<PlannedPoint>,
}

/// A point of a plan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlannedPoint {
    /// s from the start of the run.
    pub time: f64,
    /// Of the lead, m/s; negative backwards.
    pub speed: f64,
    /// 0 in the shape, 1 in the column.
    pub narrowing: f64,
    /// Where the robots are that hold their places, in the order of [`PlannedPath::robots`].
    pub poses: Vec<Pose>,
}

impl PlannedPath {
    /// The robot that leads.
    pub fn lead(&self) -> Option<usize> {
        self.robots.first().copied()
    }
}
