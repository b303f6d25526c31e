//! How well robots keep to the plans that were made for them.

use crate::statistics::RootMeanSquare;
use serde::Serialize;
use std::sync::Arc;
use vocabulary::{Condition, PlannedPath, StepRecord, math};

/// A robot beside the place at which its formation's plan has it at each time. A lead robot on wheels tracks its plan; followers
/// follow, so that theirs is the error of the whole chain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PlanTrackingMetrics {
    /// Farthest from it, m.
    pub error_max: f64,
    /// When that was, s.
    pub error_max_time: f64,
    /// Root mean square, m.
    pub error_rms: f64,
    /// Whether it leads by that plan.
    pub leads: bool,
    /// How much of it was left at the end, s.
    pub time_left: f64,
}

/// Running sums of one robot.
#[derive(Debug, Clone, Default)]
pub(crate) struct PlanTrackingSums {
    /// The plan that holds for it now, and which of its robots it is.
    path: Option<(Arc<PlannedPath>, usize)>,
    squares: RootMeanSquare<1>,
    /// Farthest, m, and when, s.
    farthest: [f64; 2],
    /// How much of the plan is left, s.
    left: f64,
}

impl PlanTrackingSums {
    /// Adds a moment to the sums of all robots.
    pub(crate) fn push(all: &mut [Self], record: &StepRecord) {
        for path in &record.plans {
            for (place, robot) in path.robots.iter().enumerate() {
                if let Some(sums) = all.get_mut(*robot) {
                    sums.path = Some((Arc::clone(path), place));
                }
            }
        }
        let time = record.snapshot.time;
        for (sums, robot) in all.iter_mut().zip(&record.snapshot.robots) {
            // A robot that has failed is no longer part of the plan.
            let Some((path, place)) = sums.path.as_ref().filter(|_| robot.condition == Condition::Able)
            else {
                continue;
            };
            let Some([x, y]) = path.place_at(*place, time) else { continue };
            sums.left = path.points.last().map_or(0.0, |last| (last.time - time).max(0.0));
            let off = math::hypot(robot.motion.pose.x - x, robot.motion.pose.y - y);
            sums.squares.add([off]);
            if off > sums.farthest[0] {
                sums.farthest = [off, time];
            }
        }
    }

    pub(crate) fn finish(&self) -> Option<PlanTrackingMetrics> {
        let [error_rms] = self.squares.root()?;
        let [error_max, error_max_time] = self.farthest;
        let leads = self.path.as_ref().is_some_and(|(_, place)| *place == 0);
        Some(PlanTrackingMetrics { error_max, error_max_time, error_rms, leads, time_left: self.left })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{PlannedPoint, Pose, RobotState};

    #[test]
    fn a_robot_is_held_against_where_its_plan_has_it() {
        let point = |time: f64, x: f64| PlannedPoint {
            time,
            poses: vec![Pose::default(), Pose::new(x, 1.0, 0.0)],
            ..PlannedPoint::default()
        };
        let starts = PlannedPoint { speed: 4.0, ..point(1.0, 0.0) };
        let path = PlannedPath { robots: vec![2, 0], points: vec![starts, point(3.0, 4.0)] };
        let mut sums = vec![PlanTrackingSums::default(); 3];
        let mut record = StepRecord::default();
        record.snapshot.robots = vec![RobotState::default(); 3];
        record.plans = vec![Arc::new(path)];
        // Before it begins the plan has the robot where it starts, after its end where it stops.
        // Braking evenly it has gone three quarters of the way after half of the time.
        for (time, x) in [(0.0, 0.0), (2.0, 3.0), (9.0, 7.0)] {
            record.snapshot.time = time;
            record.snapshot.robots[0].motion.pose = Pose::new(x, 1.0, 0.0);
            PlanTrackingSums::push(&mut sums, &record);
            record.plans.clear();
        }
        let found = sums[0].finish().expect("a plan");
        assert_eq!((found.error_max, found.error_max_time), (3.0, 9.0));
        assert!((found.error_rms - 3.0_f64.sqrt()).abs() < 1e-15);
        assert!(!found.leads && sums[2].finish().is_some_and(|lead| lead.leads));
        assert_eq!(found.time_left, 0.0);
        assert_eq!(sums[1].finish(), None);
    }
}
