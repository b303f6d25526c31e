//! Cameras on robots: they look at parts of a picture, lean with their robots, and see nothing that is out of sight.

use crate::camera::Camera;
use glam::{DVec2, DVec3};
use vocabulary::math;
use vocabulary::{Body, CameraModel, CameraMount, FleetInfo, Region, Shot, Snapshot};

/// What is nearer is not seen, m.
const NEAR: f64 = 0.02;

impl Camera {
    /// The camera of a shot: one that looks ahead in a frame with x to the right and y down, of whose picture it sees a
    /// part.
    pub(crate) fn shot(shot: &Shot) -> Self {
        let axis = |k: usize| DVec3::from_array(shot.world_from_camera.rotation.map(|row| row[k]));
        let region = shot.region;
        // Half the side, and where its middle is; pixels have their middles at whole numbers.
        let side = |size: u32| 0.5 * f64::from(size) / shot.focal;
        let middle = |at: u32, size: u32, centre: f64| {
            (f64::from(at) - 0.5 + 0.5 * f64::from(size) - centre) / shot.focal
        };
        Self {
            eye: DVec3::from_array(shot.world_from_camera.translation),
            forward: axis(2),
            right: axis(0),
            up: -axis(1),
            half: DVec2::new(side(region.width), side(region.height)),
            shift: DVec2::new(
                middle(region.x, region.width, shot.centre[0]),
                -middle(region.y, region.height, shot.centre[1]),
            ),
            near: NEAR,
            perspective: true,
        }
    }

    /// Whether a ball may be in the picture.
    pub(crate) fn may_see(&self, middle: DVec3, radius: f64) -> bool {
        if !self.perspective {
            return true;
        }
        let p = self.view_from_world(middle);
        let beside = |at: f64, shift: f64, half: f64| {
            let out = |edge: f64, side: f64| side * (at - edge * p.z) / math::hypot(edge, 1.0) > radius;
            out(shift + half, 1.0) || out(shift - half, -1.0)
        };
        p.z > -radius && !beside(p.x, self.shift.x, self.half.x) && !beside(p.y, self.shift.y, self.half.y)
    }
}

/// Through the camera of a robot: all of its sensor, and what is beside that or over it where the picture has room.
pub(crate) fn onboard(snapshot: &Snapshot, fleet: &FleetInfo, robot: usize, aspect: f64) -> Camera {
    let state = snapshot.robots.get(robot).copied().unwrap_or_default();
    let (camera_mount, camera_model) = fleet.robots.get(robot).map_or_else(
        || (CameraMount::fitting(&Body::default()), CameraModel::default()),
        |member| (member.camera_mount, member.camera_model),
    );
    let mut camera = Camera::shot(&Shot {
        robot,
        world_from_camera: camera_mount.world_from_camera(&state),
        focal: camera_model.focal,
        centre: camera_model.centre,
        region: Region::whole(&camera_model),
        exposure: 1.0,
    });
    let DVec2 { x, y } = camera.half;
    camera.half = DVec2::new(x.max(y * aspect), y.max(x / aspect));
    camera
}
