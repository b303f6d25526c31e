//! Barriers: from what a robot senses to half-planes of its commands.
//!
//! A barrier is on a point ahead of the robot (Wilson et al., The Robotarium, IEEE Control Systems Magazine 40(1), 2020):
//! its velocity depends on the turn rate at any speed, so that a robot which stands nose-on to another can still turn away.
//! With the middle p of the body, the heading's unit vector h and the left of it h⊥, the point is p + c h. Its distance
//! from what is near, less radii, margin and c, is the barrier function h_L, and dh_L/dt + α h_L ≥ 0 (Ames et al., Control
//! barrier functions, ECC 2019) is asked of the speed T_h from now: a half-plane in dv/dt and ω.

use crate::half_plane::{HalfPlane, dot};
use vocabulary::{Constraint, Pose, math, wrap};

/// Parameters of the barriers of one robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameters {
    /// Room that is kept beyond radii (D), m.
    pub margin: f64,
    /// How far ahead of the middle of its body the point is (c), m; positive.
    pub point_ahead: f64,
    /// How fast room may be used up (α), 1/s; positive.
    pub gain: f64,
    /// How far ahead the speed is looked at (T_h), s; positive.
    pub horizon: f64,
    /// It stays within these [x from, y from, x to, y to], m.
    pub arena: Option<[f64; 4]>,
    /// Farthest that its leader may be, m.
    pub view_distance: Option<f64>,
    /// Farthest that its leader may be off the middle of its picture, rad.
    pub view_angle: Option<f64>,
}

/// Where a robot is and how it drives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// Of the point under the middle of its rear axle.
    pub pose: Pose,
    /// m/s.
    pub speed: f64,
    /// From there to the middle of its body, m.
    pub middle: f64,
    /// Of the circle around its body, m.
    pub radius: f64,
}

/// Something near a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbour {
    /// What it is.
    pub constraint: Constraint,
    /// Unit vector from its nearest point, or its middle, to the robot's point ahead.
    pub normal: [f64; 2],
    /// From its outline to the robot's point ahead, m; below zero inside.
    pub distance: f64,
    /// Its velocity, m/s.
    pub velocity: [f64; 2],
}

/// How a follower's camera sees its leader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// From the follower to the leader, m.
    pub offset: [f64; 2],
    /// Of the leader against the follower, m/s.
    pub velocity: [f64; 2],
    /// Direction of the camera from the heading, rad.
    pub pan: f64,
    /// Farthest that it turns, rad.
    pub pan_max: f64,
    /// Fastest that it turns, rad/s.
    pub pan_rate: f64,
}

/// How fast the camera follows what is off the middle, 1/s.
const PAN_GAIN: f64 = 20.0;
/// How fast the angle of view may be used up, 1/s.
const VIEW_GAIN: f64 = 5.0;
/// Double pole of the barrier on the view distance, 1/s.
const VIEW_POLE: f64 = 2.0;
/// Nearer than this, directions mean nothing, m.
const NEAREST: f64 = 1e-6;

impl Placed {
    /// h and h⊥.
    fn directions(&self) -> [[f64; 2]; 2] {
        let (sin, cos) = math::sin_cos(self.pose.heading);
        [[cos, sin], [-sin, cos]]
    }

    /// The point ahead, m.
    pub fn point_ahead(&self, parameters: &Parameters) -> [f64; 2] {
        self.pose.world_from_body(self.middle + parameters.point_ahead, 0.0)
    }
}

/// The commands that keep a robot off a neighbour.
pub fn keep_apart(own: &Placed, neighbour: &Neighbour, parameters: &Parameters) -> HalfPlane {
    let [along, left] = own.directions();
    let Parameters { margin, point_ahead, gain, horizon, .. } = *parameters;
    let normal = neighbour.normal;
    let value = neighbour.distance - own.radius - margin - point_ahead;
    let lever = own.middle + point_ahead;
    let approach = own.speed * dot(normal, along) - dot(normal, neighbour.velocity);
    HalfPlane {
        normal: [horizon * dot(normal, along), lever * dot(normal, left)],
        bound: -approach - gain * value,
        constraint: neighbour.constraint,
        value,
        direction: math::atan2(-normal[1], -normal[0]),
    }
}

/// The sides of a robot's arena as neighbours that stand.
pub fn edges(own: &Placed, parameters: &Parameters) -> impl Iterator<Item = Neighbour> + use<> {
    let [x, y] = own.point_ahead(parameters);
    parameters.arena.into_iter().flat_map(move |[x0, y0, x1, y1]| {
        let sides =
            [([1.0, 0.0], x - x0), ([0.0, 1.0], y - y0), ([-1.0, 0.0], x1 - x), ([0.0, -1.0], y1 - y)];
        sides.into_iter().enumerate().map(|(side, (normal, distance))| Neighbour {
            constraint: Constraint::Edge(side),
            normal,
            distance,
            velocity: [0.0; 2],
        })
    })
}

/// The commands that keep a follower's leader in view: near enough (a barrier of second order with a double pole), and
/// within the picture to either side.
pub fn keep_in_view(
    own: &Placed,
    sight: &Sight,
    parameters: &Parameters,
) -> impl Iterator<Item = HalfPlane> + use<> {
    let [along, left] = own.directions();
    let distance = math::hypot(sight.offset[0], sight.offset[1]).max(NEAREST);
    let towards = sight.offset.map(|x| x / distance);
    let (ahead, beside) = (dot(towards, along), dot(towards, left));
    let direction = math::atan2(towards[1], towards[0]);
    let rate = dot(towards, sight.velocity);
    let across = towards[0] * sight.velocity[1] - towards[1] * sight.velocity[0];
    let far = parameters.view_distance.map(|most| {
        let value = most - distance;
        HalfPlane {
            normal: [ahead, own.speed * beside],
            bound: across * across / distance + 2.0 * VIEW_POLE * rate - VIEW_POLE * VIEW_POLE * value,
            constraint: Constraint::ViewDistance,
            value,
            direction,
        }
    });
    let off = wrap(math::atan2(beside, ahead) - sight.pan);
    let turning = (PAN_GAIN * off).clamp(-sight.pan_rate, sight.pan_rate);
    let stopped =
        (sight.pan >= sight.pan_max && turning > 0.0) || (sight.pan <= -sight.pan_max && turning < 0.0);
    let drift = across / distance - if stopped { 0.0 } else { turning };
    let beside = parameters.view_angle.into_iter().flat_map(move |most| {
        [(1.0, Constraint::ViewLeft), (-1.0, Constraint::ViewRight)].map(|(sign, constraint)| {
            let value = most - sign * off;
            HalfPlane {
                normal: [0.0, sign],
                bound: sign * drift - VIEW_GAIN * value,
                constraint,
                value,
                direction,
            }
        })
    });
    far.into_iter().chain(beside)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    const PARAMETERS: Parameters = Parameters {
        margin: 0.05,
        point_ahead: 0.1,
        gain: 2.0,
        horizon: 0.1,
        arena: None,
        view_distance: Some(4.0),
        view_angle: Some(0.38),
    };

    /// A robot after `t` s at a constant command.
    fn later(own: &Placed, [a, w]: [f64; 2], t: f64) -> Placed {
        let (speed, turned) = (own.speed + 0.5 * a * t, own.pose.heading + 0.5 * w * t);
        let (x, y) = (own.pose.x + speed * t * math::cos(turned), own.pose.y + speed * t * math::sin(turned));
        Placed { pose: Pose::new(x, y, own.pose.heading + w * t), speed: own.speed + a * t, ..*own }
    }

    proptest! {
        /// dh_L/dt by finite differences, at the speed T_h from now.
        #[test]
        fn the_row_is_the_rate_of_the_barrier(
            x in -3.0..3.0, y in -3.0..3.0, heading in -PI..PI, v in 0.0..1.5, a in -3.0..3.0, w in -3.0..3.0,
            vx in -1.0..1.0, vy in -1.0..1.0,
        ) {
            let own = Placed { pose: Pose::new(x, y, heading), speed: v, middle: 0.135, radius: 0.24 };
            let gap = |own: &Placed, at: [f64; 2]| {
                let p = own.point_ahead(&PARAMETERS);
                let d = [p[0] - at[0], p[1] - at[1]];
                (math::hypot(d[0], d[1]), d)
            };
            let (distance, d) = gap(&own, [0.0; 2]);
            prop_assume!(distance > 0.3);
            let neighbour = Neighbour {
                constraint: Constraint::Robot(1), normal: d.map(|x| x / distance), distance: distance - 0.24,
                velocity: [vx, vy],
            };
            let row = keep_apart(&own, &neighbour, &PARAMETERS);
            let t = 1e-6;
            let fast = Placed { speed: v + PARAMETERS.horizon * a, ..own };
            let [before, after] = [-t, t].map(|t| gap(&later(&fast, [0.0, w], t), [vx * t, vy * t]).0);
            let rate = (after - before) / (2.0 * t);
            prop_assert!((row.slack([a, w]) - (rate + PARAMETERS.gain * row.value)).abs() < 1e-7);
        }

        /// d²h/dt² + 2 p dh/dt + p² h by finite differences for the view distance; dh/dt + 5 h for its sides.
        #[test]
        fn the_view_rows_are_rates(
            x in -3.0..3.0, y in -3.0..3.0, heading in -PI..PI, v in 0.1..1.5, a in -3.0..3.0, w in -3.0..3.0,
            vx in -1.0..1.0, vy in -1.0..1.0,
        ) {
            let own = Placed { pose: Pose::new(x, y, heading), speed: v, middle: 0.0, radius: 0.24 };
            prop_assume!(math::hypot(x, y) > 0.5);
            let offset = |t: f64| {
                let own = later(&own, [a, w], t);
                ([vx * t - own.pose.x, vy * t - own.pose.y], own.pose.heading)
            };
            let (sin, cos) = math::sin_cos(heading);
            let bearing = |(o, heading): ([f64; 2], f64)| wrap(math::atan2(o[1], o[0]) - heading);
            let pan = wrap(bearing(offset(0.0)) - 0.1);
            let sight = Sight {
                offset: offset(0.0).0, velocity: [vx - v * cos, vy - v * sin], pan, pan_max: 10.0, pan_rate: 1.0,
            };
            let rows: Vec<_> = keep_in_view(&own, &sight, &PARAMETERS).collect();
            let t = 1e-4;
            let far = [-t, 0.0, t].map(|t| { let o = offset(t).0; 4.0 - math::hypot(o[0], o[1]) });
            let second = (far[2] - 2.0 * far[1] + far[0]) / (t * t);
            let first = (far[2] - far[0]) / (2.0 * t);
            prop_assert!((rows[0].slack([a, w]) - (second + 4.0 * first + 4.0 * far[1])).abs() < 1e-4);
            // The camera turns at its fastest, 1 rad/s, to the left.
            let off = |t: f64| wrap(bearing(offset(t)) - (pan + t));
            let rate = (off(t) - off(-t)) / (2.0 * t);
            prop_assert!((rows[1].slack([a, w]) - (-rate + 5.0 * (0.38 - 0.1))).abs() < 1e-5);
            prop_assert!((rows[2].slack([a, w]) - (rate + 5.0 * (0.38 + 0.1))).abs() < 1e-5);
        }
    }

    /// Nose-on to a wall at rest, it is the turn rate that leads away, and a lever of zero would leave none.
    #[test]
    fn a_robot_that_stands_beside_a_wall_may_turn_away_only() {
        let own = Placed { pose: Pose::new(0.0, 0.0, 0.3), speed: 0.0, middle: 0.135, radius: 0.24 };
        let neighbour = Neighbour {
            constraint: Constraint::Prop(0),
            normal: [0.0, -1.0],
            distance: 0.2,
            velocity: [0.0; 2],
        };
        let row = keep_apart(&own, &neighbour, &PARAMETERS);
        assert!(row.value < 0.0 && row.slack([0.0, 0.0]) < 0.0);
        assert!(row.slack([0.0, -3.0]) > 0.0 && row.slack([0.0, 3.0]) < 0.0);
    }

    #[test]
    fn the_sides_of_an_arena_face_inwards() {
        let own = Placed { pose: Pose::new(1.0, 0.5, 0.0), speed: 1.0, middle: 0.0, radius: 0.1 };
        let parameters = Parameters { arena: Some([-2.0, -1.0, 3.0, 4.0]), ..PARAMETERS };
        let rooms: Vec<f64> = edges(&own, &parameters).map(|edge| edge.distance).collect();
        assert!(rooms.iter().zip([3.1, 1.5, 1.9, 3.5]).all(|(a, b)| (a - b).abs() < 1e-12), "{rooms:?}");
        assert_eq!(edges(&own, &PARAMETERS).count(), 0);
    }
}
