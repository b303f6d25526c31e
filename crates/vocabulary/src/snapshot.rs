//! The truth about all robots at one instant: the only way out of a world.

use crate::{Placement, Pose, Rigid, nearest_turn, words, wrap};

/// How a robot moves at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Where the ground point under the middle of its rear axle is.
    pub pose: Pose,
    /// Forward speed, m/s.
    pub speed: f64,
    /// Rate of change of the speed that was applied, m/s².
    pub acceleration: f64,
    /// Turn rate that was applied, rad/s.
    pub turn_rate: f64,
}

/// How the body stands off the plane: zero for a unicycle on flat ground.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// Height of the body's ground point over z = 0, m.
    pub height: f64,
    /// rad about the body's x axis, right side down positive.
    pub roll: f64,
    /// rad about the body's y axis, nose down positive.
    pub pitch: f64,
}

/// One wheel, for drawing and for the log.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wheel {
    /// Angle rolled since the start, rad, forward positive.
    pub rotation: f64,
    /// Steering angle, rad, left positive.
    pub steering: f64,
    /// Spring compression from rest, m.
    pub compression: f64,
}

words! {
    /// Whether a robot can still drive.
    pub enum Condition = Able {
        /// It can.
        Able = "able",
        /// Its wheels are not under it.
        Overturned = "overturned",
        /// It is told to drive and does not move.
        Stuck = "stuck",
        /// It is deep below the ground around it, or out of all bounds.
        Fallen = "fallen",
        /// An event made it fail.
        Failed = "failed",
        /// It is not there any more.
        Removed = "removed",
    }
}

/// One robot at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RobotState {
    /// Planar motion.
    pub motion: Motion,
    /// Height, roll, pitch.
    pub attitude: Attitude,
    /// Front left, front right, rear left, rear right.
    pub wheels: [Wheel; 4],
    /// Direction of the camera from the heading, rad.
    pub camera_pan: f64,
    /// Whether it can still drive.
    pub condition: Condition,
}

impl RobotState {
    /// Whether it is there.
    pub fn is_present(&self) -> bool {
        self.condition != Condition::Removed
    }

    /// The body's frame in the world's: its origin is the reference point on the ground.
    pub fn world_from_body(&self) -> Rigid {
        let (pose, tilt) = (self.motion.pose, self.attitude);
        Rigid::turned([pose.x, pose.y, tilt.height], pose.heading, tilt.pitch, tilt.roll)
    }
}

/// All robots and props at one instant, in the order of the scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Snapshot {
    /// s from the start of the run.
    pub time: f64,
    /// One entry per robot.
    pub robots: Vec<RobotState>,
    /// One entry per prop of the cast, those that never move included.
    pub props: Vec<Placement>,
}

impl Snapshot {
    /// The snapshot at `share` (0 to 1) of the way from `a` to `b`; positions and angles are interpolated linearly.
    #[must_use]
    pub fn between(a: &Self, b: &Self, share: f64) -> Self {
        let mix = |p: f64, q: f64| p + (q - p) * share;
        let turn = |p: f64, q: f64| wrap(mix(p, nearest_turn(q, p)));
        let mut out = a.clone();
        out.time = mix(a.time, b.time);
        for (o, n) in out.robots.iter_mut().zip(&b.robots) {
            let (p, q) = (o.motion.pose, n.motion.pose);
            o.motion.pose = Pose::new(mix(p.x, q.x), mix(p.y, q.y), turn(p.heading, q.heading));
            o.motion.speed = mix(o.motion.speed, n.motion.speed);
            o.attitude.height = mix(o.attitude.height, n.attitude.height);
            o.attitude.roll = turn(o.attitude.roll, n.attitude.roll);
            o.attitude.pitch = turn(o.attitude.pitch, n.attitude.pitch);
            o.camera_pan = turn(o.camera_pan, n.camera_pan);
            for (w, m) in o.wheels.iter_mut().zip(&n.wheels) {
                w.rotation = mix(w.rotation, m.rotation);
                w.steering = mix(w.steering, m.steering);
                w.compression = mix(w.compression, m.compression);
            }
        }
        for (o, n) in out.props.iter_mut().zip(&b.props) {
            *o = Placement::between(o, n, share);
        }
        out
    }
}
