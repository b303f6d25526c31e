//! Pictures that cameras on robots take, and who takes them.

use crate::math;
use crate::{Body, Region, Rigid, RobotState, Shell, Snapshot};

/// Where a camera sits on a robot: it turns about an upright axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CameraMount {
    /// Of its axis ahead of the robot's reference point, m.
    pub forward: f64,
    /// Of the optical centre over the ground, m.
    pub height: f64,
}

impl CameraMount {
    /// The mount that fits a body: over the front of its shell.
    pub fn fitting(body: &Body) -> Self {
        let shell = Shell::fitting(body);
        let size = shell.apothem / Shell::PAPER.apothem;
        Self { forward: shell.forward + 0.105 * size, height: shell.height + 0.10 * size }
    }

    /// The camera's frame (x right, y down, z ahead) in the body's, turned by `pan` rad from the heading.
    pub fn body_from_camera(&self, pan: f64) -> Rigid {
        let (sin, cos) = math::sin_cos(pan);
        Rigid {
            rotation: [[sin, 0.0, cos], [-cos, 0.0, sin], [0.0, -1.0, 0.0]],
            translation: [self.forward, 0.0, self.height],
        }
    }

    /// The camera's frame in the world's, on a robot as it stands.
    pub fn world_from_camera(&self, robot: &RobotState) -> Rigid {
        robot.world_from_body().after(&self.body_from_camera(robot.camera_pan))
    }
}

/// A picture to be taken by an ideal camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shot {
    /// The robot that carries the camera.
    pub robot: usize,
    /// The camera's frame (x right, y down, z ahead) in the world's.
    pub world_from_camera: Rigid,
    /// Focal length, pixels.
    pub focal: f64,
    /// Principal point, pixels; the middle of the top left pixel of the whole picture is (0, 0).
    pub centre: [f64; 2],
    /// What part of the picture is wanted.
    pub region: Region,
    /// Factor on the light; 1 shows white paper in the sun at about 0.85.
    pub exposure: f64,
}

/// A monochrome picture, linear in light.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Grey {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `width · height` bytes, rows from the top.
    pub values: Vec<u8>,
}

/// Takes pictures of a world: implemented by whoever can draw.
pub trait CameraRenderer: Send {
    /// Takes all `shots` of the same instant, one image each in `images`.
    ///
    /// # Errors
    /// What went wrong, in words.
    fn render(&mut self, snapshot: &Snapshot, shots: &[Shot], images: &mut Vec<Grey>) -> Result<(), String>;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Motion, Pose};

    #[test]
    fn a_camera_that_looks_ahead_sees_right_on_the_right_and_down_below() {
        let camera_mount = CameraMount { forward: 0.1, height: 0.3 };
        let robot = RobotState {
            motion: Motion { pose: Pose::new(1.0, 2.0, std::f64::consts::FRAC_PI_2), ..Motion::default() },
            ..RobotState::default()
        };
        let seen = camera_mount.world_from_camera(&robot).inverse().apply([1.5, 4.1, 0.2]);
        for (got, want) in seen.iter().zip([0.5, 0.1, 2.0]) {
            assert!((got - want).abs() < 1e-12, "{seen:?}");
        }
    }
}
