//! A free camera that stays with a moving robot or with a place.

use rendering::{FreeCamera, Viewpoint};
use vocabulary::Snapshot;

/// Rotation by a drag across the height of the view, rad.
const TURN: f64 = std::f64::consts::PI;

/// A camera that the user moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraControl {
    /// The robot it stays with; `None` for a place in the world.
    pub robot: Option<usize>,
    /// Its target is relative to that robot's position.
    free: FreeCamera,
}

impl CameraControl {
    /// Takes over from a camera without a jump, and stays with a robot.
    pub fn take(free: FreeCamera, robot: Option<usize>, snapshot: &Snapshot) -> Self {
        Self { robot, free: moved(free, place(robot, snapshot), -1.0) }
    }

    /// The view through it.
    pub fn view(&self, snapshot: &Snapshot) -> Viewpoint {
        self.in_world(snapshot).view()
    }

    fn in_world(&self, snapshot: &Snapshot) -> FreeCamera {
        moved(self.free, place(self.robot, snapshot), 1.0)
    }

    /// Rotates it by a drag, in fractions of the view's height: right and down are positive.
    pub fn orbit(&mut self, [across, down]: [f64; 2]) {
        self.free = self.free.turned(-across * TURN, down * TURN);
    }

    /// Moves it so that the place `from` appears where `to` was, m.
    pub fn pan(&mut self, from: [f64; 2], to: [f64; 2]) {
        // Near the horizon a pixel spans a large distance.
        let most = 2.0 * self.free.distance;
        for k in 0..2 {
            self.free.target[k] += (from[k] - to[k]).clamp(-most, most);
        }
    }

    /// Zooms by a factor, below 1 nearer; a place on the ground stays at its pixel.
    pub fn zoom(&mut self, factor: f64, about: Option<[f64; 2]>, snapshot: &Snapshot) {
        if factor.is_finite() && factor > 0.0 {
            let about = about.map(|[x, y]| [x, y, 0.0]);
            let zoomed = self.in_world(snapshot).zoomed(factor, about);
            *self = Self::take(zoomed, self.robot, snapshot);
        }
    }

    /// Attaches it to a robot.
    pub fn follow(&mut self, robot: usize) {
        self.robot = Some(robot);
        self.free.target = [0.0, 0.0, 0.1];
        self.free.distance = self.free.distance.min(5.0);
    }

    /// Detaches it from its robot.
    pub fn let_go(&mut self, snapshot: &Snapshot) {
        *self = Self::take(self.in_world(snapshot), None, snapshot);
    }
}

fn moved(free: FreeCamera, [x, y]: [f64; 2], by: f64) -> FreeCamera {
    let [a, b, c] = free.target;
    FreeCamera { target: [a + by * x, b + by * y, c], ..free }
}

fn place(robot: Option<usize>, snapshot: &Snapshot) -> [f64; 2] {
    let pose = robot.and_then(|robot| snapshot.robots.get(robot)).map(|robot| robot.motion.pose);
    pose.map_or([0.0; 2], |pose| [pose.x, pose.y])
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Pose, RobotState};

    const FREE: FreeCamera = FreeCamera {
        target: [2.0, 1.0, 0.0],
        heading: 0.3,
        pitch: 0.5,
        distance: 6.0,
        field_of_view: FreeCamera::FIELD_OF_VIEW,
    };

    fn snapshot(x: f64) -> Snapshot {
        let mut robot = RobotState::default();
        robot.motion.pose = Pose::new(x, 2.0, 0.0);
        Snapshot { robots: vec![robot], ..Snapshot::default() }
    }

    fn eye(view: &Viewpoint) -> [f64; 3] {
        match view {
            Viewpoint::Fixed { eye, .. } => *eye,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn it_takes_over_without_a_jump_stays_with_its_robot_and_lets_it_go() {
        let mut camera = CameraControl::take(FREE, Some(0), &snapshot(5.0));
        let (before, now) = (eye(&FREE.view()), eye(&camera.view(&snapshot(5.0))));
        assert!((0..3).all(|k| (before[k] - now[k]).abs() < 1e-12));
        assert!((eye(&camera.view(&snapshot(7.0)))[0] - before[0] - 2.0).abs() < 1e-12);
        camera.let_go(&snapshot(7.0));
        assert!((eye(&camera.view(&snapshot(9.0)))[0] - before[0] - 2.0).abs() < 1e-12);
    }

    #[test]
    fn it_stays_above_the_ground_and_within_reach() {
        let mut camera = CameraControl::take(FREE, None, &snapshot(0.0));
        for _ in 0..50 {
            camera.orbit([0.3, -0.4]);
            camera.zoom(2.0, Some([1.0, 1.0]), &snapshot(0.0));
            camera.zoom(f64::NAN, None, &snapshot(0.0));
        }
        assert!(eye(&camera.view(&snapshot(0.0)))[2] > 0.0 && camera.free.distance <= 400.0);
    }
}
