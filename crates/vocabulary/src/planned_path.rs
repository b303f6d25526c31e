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
    /// Where robot number `place` of the plan is by it at a time in s, [x, y] in m: at its ends before and after. Between two
    /// points it goes straight, and the lead gains speed or brakes evenly.
    pub fn place_at(&self, place: usize, time: f64) -> Option<[f64; 2]> {
        let after = self.points.partition_point(|point| point.time <= time);
        let at = |k: usize| self.points.get(k)?.poses.get(place).map(|pose| [pose.x, pose.y]);
        let Some(before) = after.checked_sub(1) else { return at(0) };
        let (a, Some(b)) = (at(before)?, at(after)) else { return at(before) };
        let [from, to] = [&self.points[before], &self.points[after]];
        let part = (time - from.time) / (to.time - from.time);
        let [slow, fast] = [from.speed.abs(), to.speed.abs()];
        let mean = 0.5 * (slow + fast);
        let share = if mean > 0.0 { part * (slow + 0.5 * part * (fast - slow)) / mean } else { part };
        Some([0, 1].map(|k| a[k] + share * (b[k] - a[k])))
    }

    /// The robot that leads.
    pub fn lead(&self) -> Option<usize> {
        self.robots.first().copied()
    }
}
