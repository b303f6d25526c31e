//! How a wheeled lead robot keeps to its prescribed motion: it chases an ideal robot that has it exactly.
//!
//! Y. Kanayama, Y. Kimura, F. Miyazaki, T. Noguchi, A stable tracking control method for an autonomous mobile robot,
//! ICRA 1990, with the path errors closed over a length that fits the wheelbase.

use vocabulary::{Command, Limits, Motion, math, wrap};

/// Along the path, 1/s.
const ALONG: f64 = 0.8;
/// Speed, 1/s.
const SPEED: f64 = 3.0;
/// Path errors die out over this many wheelbases.
const WHEELBASES: f64 = 1.5;
/// No farther than this many wheelbases is looked at: a robot that was held up does not rush.
const FARTHEST: f64 = 3.0;

/// The command that brings a robot that moves as `now` to the motion `ideal`.
pub fn chase(ideal: &Motion, now: &Motion, wheelbase: f64, limits: &Limits) -> Command {
    let length = WHEELBASES * wheelbase;
    let hold = |error: f64| error.clamp(-FARTHEST * wheelbase, FARTHEST * wheelbase);
    let (dx, dy) = (ideal.pose.x - now.pose.x, ideal.pose.y - now.pose.y);
    let (sin, cos) = math::sin_cos(now.pose.heading);
    let (ahead, left) = (hold(cos * dx + sin * dy), hold(cos * dy - sin * dx));
    let turned = wrap(ideal.pose.heading - now.pose.heading);
    let speed = ideal.speed * math::cos(turned) + ALONG * ahead;
    let bend = left / (length * length) + 2.0 * math::sin(turned) / length;
    let asked = Command {
        acceleration: ideal.acceleration + SPEED * (speed - now.speed),
        turn_rate: ideal.turn_rate + ideal.speed * bend,
    };
    limits.saturate(asked, now.speed)
}

/// Nearer to its place than this many wheelbases a robot is where it should be, and stays until it is this many away.
const PLACED: [f64; 2] = [0.01, 0.03];

/// Whether the ideal stands still.
pub(crate) fn waits(ideal: &Motion) -> bool {
    ideal.speed == 0.0 && ideal.acceleration <= 0.0
}

/// Whether a robot that has come to its place, or past it, stands there while its ideal waits.
pub(crate) fn stands(ideal: &Motion, now: &Motion, wheelbase: f64, stood: bool) -> bool {
    waits(ideal) && along(ideal, now) <= PLACED[usize::from(stood)] * wheelbase
}

/// The speed at which the chase closes in on a motion, m/s.
pub(crate) fn wanted_speed(ideal: &Motion, now: &Motion) -> f64 {
    ideal.speed + ALONG * along(ideal, now)
}

/// How far a motion is ahead, m.
fn along(ideal: &Motion, now: &Motion) -> f64 {
    let (sin, cos) = math::sin_cos(now.pose.heading);
    cos * (ideal.pose.x - now.pose.x) + sin * (ideal.pose.y - now.pose.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::Pose;

    const LIMITS: Limits = Limits {
        speed_min: 0.01,
        speed_max: 4.0,
        turn_rate_max: 8.0,
        acceleration_max: 4.0,
        curvature_max: 2.0,
        lateral_acceleration_max: 7.0,
    };

    #[test]
    fn a_unicycle_that_starts_beside_its_path_comes_to_it() {
        let step = 0.01;
        let mut ideal = Motion { speed: 1.0, turn_rate: 0.3, ..Motion::default() };
        let mut now = Motion { pose: Pose::new(-0.2, 0.3, 0.4), speed: 0.8, ..Motion::default() };
        for _ in 0..1500 {
            let command = chase(&ideal, &now, 0.3, &LIMITS);
            now.acceleration = command.acceleration;
            now.turn_rate = command.turn_rate;
            now = crate::arc::after(&now, step);
            ideal = crate::arc::after(&ideal, step);
        }
        let off = math::hypot(ideal.pose.x - now.pose.x, ideal.pose.y - now.pose.y);
        assert!(off < 0.01, "{off} m off");
    }
}
