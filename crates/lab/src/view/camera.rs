//! A camera in the hand: around a place that may be a robot's, nearer and farther, up and down.

use rendering::View;
use std::f64::consts::{FRAC_PI_2, PI};
use vocabulary::{Snapshot, wrap};

/// Lowest and highest elevation, rad: never under the ground, never past the zenith.
const ELEVATIONS: [f64; 2] = [0.05, FRAC_PI_2 - 0.001];
/// Nearest and farthest, m.
const DISTANCES: [f64; 2] = [0.6, 400.0];
/// A drag across the height of the view turns by this, rad.
const TURN: f64 = PI;

/// A free camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeCamera {
    /// The robot it stays with; `None` for a place in the world.
    pub robot: Option<usize>,
    /// What it looks at, m: from the robot's place, or in the world.
    pub target: [f64; 3],
    /// Direction from the target to the eye, rad from the world's x axis.
    pub azimuth: f64,
    /// Height of the eye over the target, rad.
    pub elevation: f64,
    /// m.
    pub distance: f64,
    /// Vertical, rad.
    pub field_of_view: f64,
}

impl FreeCamera {
    /// A camera that takes over from an eye without a jump; `robot` is the one it stays with.
    pub fn from_eye(
        eye: [f64; 3],
        target: [f64; 3],
        field_of_view: f64,
        robot: Option<usize>,
        snapshot: &Snapshot,
    ) -> Self {
        let [dx, dy, dz] = [0, 1, 2].map(|k| eye[k] - target[k]);
        let flat = dx.hypot(dy);
        let anchor = place(robot, snapshot);
        Self {
            robot,
            target: [target[0] - anchor[0], target[1] - anchor[1], target[2]],
            azimuth: if flat < 1e-9 { -FRAC_PI_2 } else { dy.atan2(dx) },
            elevation: dz.atan2(flat).clamp(ELEVATIONS[0], ELEVATIONS[1]),
            distance: flat.hypot(dz).clamp(DISTANCES[0], DISTANCES[1]),
            field_of_view,
        }
    }

    /// The view from here.
    pub fn view(&self, snapshot: &Snapshot) -> View {
        let target = self.at(snapshot);
        let (rise, flat) = self.elevation.sin_cos();
        let (sin, cos) = self.azimuth.sin_cos();
        let eye = [
            target[0] + self.distance * flat * cos,
            target[1] + self.distance * flat * sin,
            target[2] + self.distance * rise,
        ];
        View::Fixed { eye, target, field_of_view: self.field_of_view }
    }

    /// What it looks at, m, world frame.
    pub fn at(&self, snapshot: &Snapshot) -> [f64; 3] {
        let anchor = place(self.robot, snapshot);
        [self.target[0] + anchor[0], self.target[1] + anchor[1], self.target[2]]
    }

    /// Turns by a drag, in shares of the view's height: right and down positive.
    pub fn orbit(&mut self, [across, down]: [f64; 2]) {
        self.azimuth = wrap(self.azimuth - across * TURN);
        self.elevation = (self.elevation + down * TURN).clamp(ELEVATIONS[0], ELEVATIONS[1]);
    }

    /// Moves along the ground by a drag, in shares of the view's height: right and down positive.
    pub fn pan(&mut self, [across, down]: [f64; 2]) {
        let reach = 2.0 * (0.5 * self.field_of_view).tan() * self.distance;
        // The ground follows the pointer, farther the flatter it is seen.
        let deep = reach / self.elevation.sin().max(0.2);
        let (sin, cos) = self.azimuth.sin_cos();
        let (right, away) = ([-sin, cos], [-cos, -sin]);
        for k in 0..2 {
            self.target[k] += -right[k] * across * reach + away[k] * down * deep;
        }
    }

    /// Goes nearer (above 1) or farther by a factor.
    pub fn zoom(&mut self, factor: f64) {
        if factor.is_finite() && factor > 0.0 {
            self.distance = (self.distance / factor).clamp(DISTANCES[0], DISTANCES[1]);
        }
    }

    /// Stays with another robot, or with none, without a jump.
    pub fn stay_with(&mut self, robot: Option<usize>, snapshot: &Snapshot) {
        let target = self.at(snapshot);
        let anchor = place(robot, snapshot);
        self.robot = robot;
        self.target = [target[0] - anchor[0], target[1] - anchor[1], target[2]];
    }

    /// Looks at a robot and stays with it.
    pub fn follow(&mut self, robot: usize) {
        self.robot = Some(robot);
        self.target = [0.0, 0.0, 0.1];
        self.distance = self.distance.min(6.0);
    }
}

fn place(robot: Option<usize>, snapshot: &Snapshot) -> [f64; 2] {
    let pose = robot.and_then(|robot| snapshot.robots.get(robot)).map(|robot| robot.motion.pose);
    pose.map_or([0.0; 2], |pose| [pose.x, pose.y])
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Pose, RobotState};

    fn snapshot(x: f64) -> Snapshot {
        let mut robot = RobotState::default();
        robot.motion.pose = Pose::new(x, 2.0, 0.0);
        Snapshot { robots: vec![robot], ..Snapshot::default() }
    }

    fn eye(camera: &FreeCamera, snapshot: &Snapshot) -> [f64; 3] {
        match camera.view(snapshot) {
            View::Fixed { eye, .. } => eye,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn it_takes_over_without_a_jump_and_stays_with_its_robot() {
        let (from, to) = ([1.0, -3.0, 2.0], [2.0, 1.0, 0.0]);
        let camera = FreeCamera::from_eye(from, to, 0.8, Some(0), &snapshot(5.0));
        for (now, wanted) in eye(&camera, &snapshot(5.0)).into_iter().zip(from) {
            assert!((now - wanted).abs() < 1e-12);
        }
        assert!((eye(&camera, &snapshot(7.0))[0] - 3.0).abs() < 1e-12);
    }

    #[test]
    fn it_stays_above_the_ground_and_within_reach() {
        let mut camera = FreeCamera::from_eye([0.0, -5.0, 3.0], [0.0; 3], 0.8, None, &snapshot(0.0));
        for _ in 0..50 {
            camera.orbit([0.3, -0.4]);
            camera.zoom(0.5);
        }
        assert!(eye(&camera, &snapshot(0.0))[2] > 0.0 && camera.distance <= 400.0);
        for _ in 0..50 {
            camera.orbit([0.3, 0.4]);
            camera.zoom(3.0);
        }
        assert!(camera.elevation < FRAC_PI_2 && camera.distance >= 0.6);
        camera.zoom(f64::NAN);
        assert!(camera.distance.is_finite());
    }

    #[test]
    fn letting_a_robot_go_moves_nothing() {
        let mut camera = FreeCamera::from_eye([1.0, -3.0, 2.0], [2.0, 1.0, 0.0], 0.8, Some(0), &snapshot(5.0));
        let before = eye(&camera, &snapshot(5.0));
        camera.stay_with(None, &snapshot(5.0));
        for (now, wanted) in eye(&camera, &snapshot(5.0)).into_iter().zip(before) {
            assert!((now - wanted).abs() < 1e-12);
        }
    }
}
