//! Random places of a leader before a camera.

use perception::imaging::{Purpose, noise_stream};
use std::f64::consts::{PI, TAU};
use vocabulary::{Body, Motion, Pose, RobotInfo, RobotState, Snapshot, math};

/// Bounds of the distances that are told apart, m.
pub const BINS: [[f64; 2]; 6] = [[0.5, 1.0], [1.0, 2.0], [2.0, 3.0], [3.0, 4.0], [4.0, 5.0], [5.0, 6.0]];

/// The camera turns so far from straight ahead, rad: beyond that its own shell stands in the picture.
const PAN: f64 = 70.0 * PI / 180.0;
/// The shell's axis stands within this share of the picture's width from its middle.
const ASIDE: f64 = 0.42;
/// Room between two bodies, m.
const CLEARANCE: f64 = 0.02;

/// Index of the leader and of the follower.
pub(crate) const LEADER: usize = 0;
pub(crate) const FOLLOWER: usize = 1;

/// The `number`th pose of a benchmark: the bins take turns, so that each gets its share.
pub(crate) fn place(seed: u64, number: u64, follower: &RobotInfo) -> Snapshot {
    let mut stream = noise_stream(seed, LEADER, number, Purpose::Setup);
    let [low, high] = BINS[(number % BINS.len() as u64) as usize];
    let mut between = |low: f64, high: f64| low + (high - low) * stream.uniform();
    let distance = between(low, high);
    loop {
        // The sun shines from all sides in turn.
        let own = Pose::new(between(-2.0, 2.0), between(-2.0, 2.0), between(-PI, PI));
        let direction = between(-2.0, 2.0);
        let [x, y] = own.world_from_body(distance * math::cos(direction), distance * math::sin(direction));
        let leader = Pose::new(x, y, vocabulary::wrap(between(0.0, TAU)));
        // The leader stands anywhere across the picture: the camera looks past it by that much.
        let width = f64::from(follower.camera_model.width);
        let aside = between(-ASIDE, ASIDE) * width / follower.camera_model.focal;
        let forward = follower.camera_mount.forward;
        let towards = math::atan2(distance * math::sin(direction), distance * math::cos(direction) - forward);
        let pan = towards + math::atan(aside);
        let body = &follower.body;
        if pan.abs() <= PAN && !touch(&leader, &own, body) {
            let robot = |pose: Pose, camera_pan: f64| RobotState {
                motion: Motion { pose, ..Motion::default() },
                camera_pan,
                ..RobotState::default()
            };
            return Snapshot { time: 0.0, robots: vec![robot(leader, 0.0), robot(own, pan)], props: vec![] };
        }
    }
}

/// Whether two bodies of one kind stand in one another: no side of either divides their rectangles.
fn touch(a: &Pose, b: &Pose, body: &Body) -> bool {
    let half = [0.5 * (body.length + CLEARANCE), 0.5 * (body.width + CLEARANCE)];
    let middle = |pose: &Pose| pose.world_from_body(0.5 * body.wheelbase, 0.0);
    let (p, q) = (middle(a), middle(b));
    let axes = [a.heading, a.heading + PI / 2.0, b.heading, b.heading + PI / 2.0];
    axes.iter().all(|axis| {
        let (sin, cos) = math::sin_cos(*axis);
        let reach = |pose: &Pose| {
            let turn = axis - pose.heading;
            half[0] * math::cos(turn).abs() + half[1] * math::sin(turn).abs()
        };
        ((p[0] - q[0]) * cos + (p[1] - q[1]) * sin).abs() < reach(a) + reach(b)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Relative, wrap};

    fn member() -> RobotInfo {
        RobotInfo::new("follower", false, Body::default())
    }

    #[test]
    fn poses_are_within_their_bins_in_the_picture_and_all_around() {
        let follower = member();
        let mut around = [0; 8];
        for number in 0..600 {
            let snapshot = place(5, number, &follower);
            let [leader, own] = [LEADER, FOLLOWER].map(|robot| snapshot.robots[robot]);
            let relative = Relative::between(leader.motion.pose, own.motion.pose);
            let [low, high] = BINS[(number % 6) as usize];
            assert!((low..=high).contains(&relative.distance), "{number}: {relative:?}");
            let camera = follower.camera_mount.world_from_camera(&own);
            let axis = camera.inverse().apply(leader.world_from_body().apply([0.0, 0.0, 0.2]));
            let pixel = follower.camera_model.project(axis).expect("ahead");
            assert!(pixel[0] > 0.0 && pixel[0] < 639.0, "{number}: {pixel:?}");
            around[((wrap(relative.bearing) + PI) / TAU * 7.999) as usize] += 1;
        }
        assert!(around.iter().all(|count| *count > 40), "{around:?}");
        assert_eq!(place(5, 3, &follower), place(5, 3, &follower));
        assert_ne!(place(5, 3, &follower), place(6, 3, &follower));
    }

    #[test]
    fn bodies_touch_where_their_rectangles_do() {
        let body = Body::default();
        let at = |x: f64, y: f64, heading: f64| touch(&Pose::new(x, y, heading), &Pose::default(), &body);
        assert!(at(0.0, 0.0, 0.0) && at(0.40, 0.0, 0.0) && !at(0.45, 0.0, 0.0));
        assert!(at(0.0, 0.2, 0.0) && !at(0.0, 0.27, 0.0));
        assert!(!at(0.55, 0.5, PI / 4.0));
    }
}
