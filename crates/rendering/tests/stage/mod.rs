//! A play for tests: formations that move along prescribed curves, without any control law.

use std::f64::consts::{FRAC_PI_2, TAU};
use vocabulary::math;
use vocabulary::{
    Body, Edge, EdgeState, FleetInfo, Motion, Pose, Relative, RobotInfo, RobotState, Snapshot, StepRecord,
    Wheel, wrap,
};

/// What the lead robot drives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Path {
    /// Along x at 0.6 m/s.
    Straight,
    /// A circle of 3 m radius.
    Circle,
    /// A lying eight, 8 m long.
    Eight,
}

impl Path {
    /// The path called `name`; an eight for every other name.
    pub(crate) fn named(name: &str) -> Self {
        match name {
            "straight" => Self::Straight,
            "circle" => Self::Circle,
            _ => Self::Eight,
        }
    }
}

/// A cast and its motion as a function of time.
#[derive(Debug, Clone)]
pub(crate) struct Play {
    /// Who is on stage.
    pub(crate) fleet: FleetInfo,
    goals: Vec<[f64; 2]>,
    path: Path,
}

impl Play {
    /// Three robots in a triangle, seven in a wedge, or a column of rows for more.
    pub(crate) fn new(robots: usize, path: Path) -> Self {
        let mut edges = Vec::new();
        let mut goals = Vec::new();
        for follower in 1..robots {
            // Two to a row; each follows the one in front of it in its own file.
            let (leader, goal) = if robots <= 12 {
                let side = if follower % 2 == 1 { 1.0 } else { -1.0 };
                (follower.saturating_sub(2), [if follower < 3 { 2.0 } else { 1.7 }, side * 2.356])
            } else if follower % 10 == 0 {
                (follower - 10, [1.6, std::f64::consts::PI])
            } else {
                (follower - 1, [1.5, -FRAC_PI_2 - 0.02])
            };
            edges.push(Edge { leader, follower });
            goals.push(goal);
        }
        let name = |k: usize| if k == 0 { "leader".to_owned() } else { format!("follower-{k}") };
        let member = |k| Play::tagged(RobotInfo::new(name(k), k == 0, Body::default()), k);
        let fleet = FleetInfo {
            title: "Holding a shape".into(),
            caption: "output feedback, observer · k = (5, 5), β = 5, ε = 0.001".into(),
            duration: 30.0,
            robots: (0..robots).map(member).collect(),
            edges,
            ..FleetInfo::default()
        };
        Self { fleet, goals, path }
    }

    /// A member with the tags of its place.
    fn tagged(member: RobotInfo, place: usize) -> RobotInfo {
        let shell = member.shell.map(|shell| shell.tagged(place));
        RobotInfo { shell, ..member }
    }

    fn lead(&self, time: f64) -> [f64; 2] {
        match self.path {
            Path::Straight => [0.6 * time, 0.0],
            Path::Circle => [3.0 * math::sin(0.2 * time), 3.0 - 3.0 * math::cos(0.2 * time)],
            Path::Eight => [4.0 * math::sin(TAU * time / 40.0), 2.0 * math::sin(2.0 * TAU * time / 40.0)],
        }
    }

    fn place(&self, robot: usize, time: f64) -> [f64; 2] {
        let Some(k) = self.fleet.edges.iter().position(|e| e.follower == robot) else {
            return self.lead(time);
        };
        let leader = self.pose(self.fleet.edges[k].leader, time);
        let [distance, bearing] = self.goals[k];
        let off = 0.5 * math::exp(-time / 3.0);
        let (sin, cos) = math::sin_cos(bearing + 0.5 * off);
        leader.world_from_body((distance + off) * cos, (distance + off) * sin)
    }

    fn pose(&self, robot: usize, time: f64) -> Pose {
        // Differences through a chain of leaders would double the work at every link: one heading for all is enough there.
        let h = 0.02;
        let [x, y] = self.place(robot, time);
        let (a, b) = if self.fleet.edges.len() > 12 {
            (self.lead(time - h), self.lead(time + h))
        } else {
            (self.place(robot, time - h), self.place(robot, time + h))
        };
        Pose::new(x, y, math::atan2(b[1] - a[1], b[0] - a[0]))
    }

    /// The moment at `time`, s.
    pub(crate) fn at(&self, time: f64) -> StepRecord {
        let robots: Vec<_> = (0..self.fleet.robots.len()).map(|k| self.robot(k, time)).collect();
        let edge = |(edge, goal): (&Edge, &[f64; 2])| {
            let (leader, follower) = (robots[edge.leader].motion.pose, robots[edge.follower].motion.pose);
            let (dx, dy) = (follower.x - leader.x, follower.y - leader.y);
            let relative = Relative {
                distance: math::hypot(dx, dy),
                bearing: wrap(math::atan2(dy, dx) - leader.heading),
                view_angle: wrap(math::atan2(dy, dx) - follower.heading),
            };
            let error = [goal[0] - relative.distance, wrap(goal[1] - relative.bearing)];
            EdgeState { relative, set_point: *goal, error, ..EdgeState::default() }
        };
        let edges = self.fleet.edges.iter().zip(&self.goals).map(edge).collect();
        StepRecord { snapshot: Snapshot { time, robots, props: vec![] }, edges, ..StepRecord::default() }
    }

    fn robot(&self, robot: usize, time: f64) -> RobotState {
        let pose = self.pose(robot, time);
        let wheel = |steering| Wheel { rotation: 0.6 * time / 0.045, steering, compression: 0.0 };
        let turn = 0.25 * math::sin(0.4 * time);
        RobotState {
            motion: Motion { pose, speed: 0.6, ..Motion::default() },
            wheels: [wheel(turn), wheel(turn), wheel(0.0), wheel(0.0)],
            camera_pan: 0.4 * math::sin(0.3 * time),
            ..RobotState::default()
        }
    }

    /// A trail up to and including `time`.
    pub(crate) fn trail(&self, time: f64) -> rendering::Trail {
        let mut trail = rendering::Trail::new(&self.fleet);
        for k in 0..=(time * 30.0) as i32 {
            trail.push(&self.at(f64::from(k) / 30.0));
        }
        trail
    }
}
