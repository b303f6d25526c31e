//! The snake view: behind and above a formation, low for a small one and higher for a wide one, so that it fills its room.

use crate::camera::free_space::{Bound, FreeSpace};
use crate::camera::smoothing::SmoothedFormation;
use crate::camera::{Camera, NEAREST, REACH, corners, sides};
use glam::DVec3;
use vocabulary::math;

/// How the snake view is composed, from looking at pictures: as it is for small formations, and as it is at the most for
/// wide ones, which would fill only a thin band of the picture if seen from low down.
struct SnakeComposition {
    /// Where the horizon stands, as a share of the height from the top; negative above the picture.
    horizon: f64,
    /// Share of the width the formation may take.
    width: f64,
    /// Normalised height (−1 bottom, 1 top) up to which the formation stays.
    top: f64,
}

const FIELD_OF_VIEW: f64 = 0.8029;
const LOW: SnakeComposition = SnakeComposition { horizon: 0.10, width: 0.70, top: 0.30 };
const HIGH: SnakeComposition = SnakeComposition { horizon: -1.9, width: 0.90, top: 0.90 };
/// Normalised height down to which the formation stays; higher where words are.
const BOTTOM: f64 = -0.52;
/// How wide a formation is at which the eye begins to rise, and at which it is as high as it may be: m of robots of the
/// default size, over the aspect of the view.
const WIDE: [f64; 2] = [5.0, 26.0];
/// From this share of the way up on, the formation may take all the room there is.
const ALL_ROOM: f64 = 0.6;

impl SnakeComposition {
    /// On the way from the low to the high one.
    fn at(share: f64) -> Self {
        let mix = |low: f64, high: f64, share: f64| low + (high - low) * share;
        let room = (share / ALL_ROOM).min(1.0);
        Self {
            horizon: mix(LOW.horizon, HIGH.horizon, share),
            width: mix(LOW.width, HIGH.width, room),
            top: mix(LOW.top, HIGH.top, room),
        }
    }
}

/// Its camera.
pub(crate) fn snake(smoothed: &SmoothedFormation, room: &FreeSpace) -> Camera {
    let extent = smoothed.formation();
    let places = corners(&extent, REACH * extent.size);
    let [bottom, over] = room.rows();
    let bottom = bottom.max(BOTTOM);
    let tangent = math::tan(0.5 * FIELD_OF_VIEW);
    let at = |share: f64| {
        let form = SnakeComposition::at(share);
        let pitch = math::atan((1.0 - 2.0 * form.horizon) * tangent);
        let camera = Camera::pitched(extent.frame.heading, pitch, tangent, room.aspect());
        (camera, sides(form.width, [bottom, form.top.min(over)]))
    };
    // How much more of the picture the formation takes across than up and down.
    let flat = |share: f64| {
        let (camera, bounds) = at(share);
        let most = |bound: &Bound| {
            let (a, b) = (bound.across / camera.half.x, bound.up / camera.half.y);
            let over = |p: &DVec3| {
                let p = camera.view_from_world(*p);
                a * p.x + b * p.y - bound.most * p.z
            };
            places.iter().map(over).fold(f64::NEG_INFINITY, f64::max)
        };
        let [right, left, up, down] = bounds.each_ref().map(|bound| (most(bound), bound.most));
        let far = |a: (f64, f64), b: (f64, f64)| (a.0 + b.0) / (a.1 + b.1);
        far(right, left) - far(up, down)
    };
    let wide = (extent.left[1] - extent.left[0]) / (extent.size * room.aspect());
    let most = ((wide - WIDE[0]) / (WIDE[1] - WIDE[0])).clamp(0.0, 1.0);
    let most = most * most * (3.0 - 2.0 * most);
    let (mut low, mut high) = (0.0, most);
    if flat(high) >= 0.0 {
        low = high;
    } else if flat(low) > 0.0 {
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if flat(middle) > 0.0 { low = middle } else { high = middle }
        }
    }
    let (mut camera, bounds) = at(low);
    let bounds: Vec<_> = bounds.into_iter().chain(room.corners()).collect();
    camera.fit(&places, &bounds, NEAREST * extent.size);
    camera
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Pose, RobotState, Snapshot, StepRecord};

    fn seen(places: &[[f64; 2]], size: [f64; 2]) -> (Camera, [f64; 2], [f64; 2]) {
        let robot = |[x, y]: &[f64; 2]| {
            let mut robot = RobotState::default();
            robot.motion.pose = Pose::new(*x, *y, 0.0);
            robot
        };
        let robots = places.iter().map(robot).collect();
        let mut smoothed = SmoothedFormation::new(0, 1.0);
        smoothed.push(
            &StepRecord { snapshot: Snapshot { robots, ..Snapshot::default() }, ..StepRecord::default() },
            &[],
        );
        let camera = snake(&smoothed, &FreeSpace::new(size, vec![], 1.0));
        let points: Vec<_> =
            places.iter().map(|[x, y]| camera.project(DVec3::new(*x, *y, 0.0)).expect("seen")).collect();
        let range = |of: fn(&glam::DVec2) -> f64| {
            points.iter().map(of).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)])
        };
        (camera, range(|p| p.x), range(|p| p.y))
    }

    #[test]
    fn a_wide_formation_fills_the_picture_and_a_small_one_has_a_horizon() {
        // Seven rays of fourteen, twice as wide as deep: from straight above it would be half as high as wide.
        let fan: Vec<_> = (0..7)
            .flat_map(|ray| {
                (0..15).map(move |k| (f64::from(ray) / 6.0 * std::f64::consts::PI, 1.4 * f64::from(k)))
            })
            .map(|(turn, far)| [-far * math::sin(turn), far * math::cos(turn)])
            .collect();
        for (size, least) in
            [([1280.0, 720.0], [0.7, 0.5]), ([640.0, 720.0], [0.7, 0.33]), ([720.0, 1280.0], [0.7, 0.2])]
        {
            let (camera, across, up) = seen(&fan, size);
            let share = [across, up].map(|[low, high]| 0.5 * (high - low));
            assert!(share[0] > least[0] && share[1] > least[1], "{size:?}: {share:?}");
            assert!(across[1] < 0.9 && up[0] > -0.53 && up[1] < 0.9 && camera.horizon() > 1.0);
        }
        let (camera, across, _) = seen(&[[0.0, 0.0], [-1.4, 1.4], [-1.4, -1.4]], [1280.0, 720.0]);
        assert!((0.7..0.9).contains(&camera.horizon()) && across[1] < 0.7, "{} {across:?}", camera.horizon());
    }
}
