//! One row of a run: the truth, and what every edge wanted, knew and did. Pictures and records are made of it.

use crate::{
    Command, Contact, Edge, EventRecord, FleetInfo, LawState, MeasurementRecord, MotionPhase, PlannedPath,
    Relative, SafetyState, Snapshot, TrackingState, nearest_turn, wrap,
};
use std::sync::Arc;

/// One edge at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EdgeState {
    /// True relative position.
    pub relative: Relative,
    /// Relative position as the follower took it: the truth where it is told the truth.
    pub seen: Relative,
    /// How well it knows where its leader is.
    pub sight: TrackingState,
    /// Time since the last measurement that corrected the estimate, s; 0 where it is told the truth.
    pub age: f64,
    /// Wanted [distance in m, bearing in rad], from the leader's own heading: the place that the follower is driven to.
    pub set_point: [f64; 2],
    /// How far the heading that the bearing is held against is behind the leader's own, rad: what a set point that is
    /// written in a scene lies beside the one here; 0 where it is the leader's own.
    pub behind: f64,
    /// Tracking error [m, rad], set point minus truth, bearing wrapped (eq 14).
    pub error: [f64; 2],
    /// What the law asked for, before limits.
    pub asked: Command,
    /// What was applied.
    pub applied: Command,
    /// Estimate of the rates of [distance, bearing] in [m/s, rad/s]; the observer's where one runs, else the truth. Where the
    /// bearing is held against a path's heading, the second is that of the direction of the line in the world.
    pub rates: [f64; 2],
    /// Estimate of [distance in m, bearing in rad] that the observer corrects by (ŝ₁); where none runs it means
    /// nothing.
    pub estimate: [f64; 2],
    /// Whether a limit (turn rate, speed, acceleration) or a safety filter cut the command.
    pub limited: bool,
    /// Whether the distance was below its minimum.
    pub too_close: bool,
    /// What drove the follower.
    pub phase: MotionPhase,
    /// How far that place is from its set point, m: while it starts again after a stand, or goes to another place.
    pub displacement: f64,
    /// How far the follower has filed in, 0 at its set point to 1 in the column (λ); `set_point` is its place as it has.
    pub narrowing: f64,
}

/// Snapshot and edges of one instant.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StepRecord {
    /// The truth about the robots.
    pub snapshot: Snapshot,
    /// One entry per edge, in the order of [`crate::FleetInfo::edges`].
    pub edges: Vec<EdgeState>,
    /// Contacts that are open, or that ended since the moment before.
    pub contacts: Vec<Contact>,
    /// Measurements of leaders that arrived since the moment before.
    pub frames: Vec<MeasurementRecord>,
    /// What the safety filters did, one entry per robot that has one, in the order of the robots.
    pub safety: Vec<SafetyState>,
    /// What custom laws carry and show, one entry per follower that has one, in the order of their first edges.
    pub laws: Vec<LawState>,
    /// Whom the follower of each edge follows; `None` where it follows nobody. Empty where that is as in
    /// [`FleetInfo::edges`].
    pub leaders: Vec<Option<usize>>,
    /// What happened at this sample.
    pub events: Vec<EventRecord>,
    /// Plans that hold from this sample on, each until its lead has another.
    pub plans: Vec<Arc<PlannedPath>>,
}

impl StepRecord {
    /// Edge number `index` as it is at this moment; `None` where its follower follows nobody.
    pub fn edge(&self, fleet: &FleetInfo, index: usize) -> Option<Edge> {
        let edge = *fleet.edges.get(index)?;
        match self.leaders.get(index) {
            None => Some(edge),
            Some(leader) => leader.map(|leader| Edge { leader, ..edge }),
        }
    }

    /// Who follows whom at this moment: number, robots and state of every edge.
    pub fn pairs<'a>(&'a self, fleet: &'a FleetInfo) -> impl Iterator<Item = (usize, Edge, &'a EdgeState)> {
        let all = self.edges.iter().enumerate();
        all.filter_map(|(index, state)| Some((index, self.edge(fleet, index)?, state)))
    }

    /// Whether the safety filter of a robot moved its command.
    pub fn is_filtered(&self, robot: usize) -> bool {
        self.safety.iter().any(|state| state.robot == robot && state.is_moved())
    }

    /// The moment at `share` (0 to 1) of the way from `a` to `b`, for pictures between two control samples.
    ///
    /// Positions, angles and errors are interpolated linearly; commands and flags are those of `a`.
    pub fn between(a: &Self, b: &Self, share: f64) -> Self {
        let mix = |p: f64, q: f64| p + (q - p) * share;
        let turn = |p: f64, q: f64| wrap(mix(p, nearest_turn(q, p)));
        let mut out = a.clone();
        out.snapshot = Snapshot::between(&a.snapshot, &b.snapshot, share);
        // Events and new plans belong to the moment at which they are made.
        out.events.clear();
        out.plans.clear();
        for (k, (o, n)) in out.edges.iter_mut().zip(&b.edges).enumerate() {
            // Between two leaders there is no middle.
            if a.leaders.get(k) != b.leaders.get(k) {
                continue;
            }
            o.relative.distance = mix(o.relative.distance, n.relative.distance);
            o.relative.bearing = turn(o.relative.bearing, n.relative.bearing);
            o.relative.view_angle = turn(o.relative.view_angle, n.relative.view_angle);
            o.set_point = [mix(o.set_point[0], n.set_point[0]), turn(o.set_point[1], n.set_point[1])];
            o.narrowing = mix(o.narrowing, n.narrowing);
            o.error = [mix(o.error[0], n.error[0]), turn(o.error[1], n.error[1])];
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Pose, RobotState};

    #[test]
    fn headings_take_the_short_way_round() {
        let at = |time, heading| {
            let mut robot = RobotState::default();
            robot.motion.pose = Pose::new(time, 0.0, heading);
            StepRecord {
                snapshot: Snapshot { time, robots: vec![robot], ..Snapshot::default() },
                ..StepRecord::default()
            }
        };
        let middle = StepRecord::between(&at(0.0, 3.0), &at(1.0, -3.0), 0.5);
        let pose = middle.snapshot.robots[0].motion.pose;
        assert!((pose.x - 0.5).abs() < 1e-15 && (pose.heading.abs() - std::f64::consts::PI).abs() < 1e-12);
    }
}
