//! The light that falls on the sensors of cameras, over as long as their shutters are open.

use crate::Error;
use crate::dataset::timeline::Timeline;
use perception::imaging;
use vocabulary::{CameraRenderer, FleetInfo, Grey, Region, Shot, Snapshot};

/// A picture to be taken: of all a sensor needs for its whole frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PictureRequest {
    pub(crate) robot: usize,
    /// What to draw, and the principal point in it.
    pub(crate) region: Region,
    pub(crate) centre: [f64; 2],
}

/// How cameras are exposed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Exposure {
    /// Factor on the light.
    pub(crate) factor: f64,
    /// s.
    pub(crate) shutter: f64,
}

/// Ideal pictures of all that is `wanted` at the instant of `now`, the middle of their exposure.
pub(crate) fn gather(
    renderer: &mut dyn CameraRenderer,
    fleet: &FleetInfo,
    exposure: &Exposure,
    timeline: &Timeline,
    now: &Snapshot,
    wanted: &[PictureRequest],
) -> Result<Vec<Grey>, Error> {
    imaging::gather(exposure.shutter, |off, pictures| {
        let then = timeline.at(now.time + off).filter(|_| off != 0.0);
        let then = then.as_ref().unwrap_or(now);
        renderer.render(then, &shots(fleet, exposure, then, wanted), pictures).map_err(Error::Camera)
    })
}

fn shots(
    fleet: &FleetInfo,
    exposure: &Exposure,
    snapshot: &Snapshot,
    wanted: &[PictureRequest],
) -> Vec<Shot> {
    let shot = |want: &PictureRequest| {
        let member = &fleet.robots[want.robot];
        Shot {
            robot: want.robot,
            world_from_camera: member.camera_mount.world_from_camera(&snapshot.robots[want.robot]),
            focal: member.camera_model.focal,
            centre: want.centre,
            region: want.region,
            exposure: exposure.factor,
        }
    };
    wanted.iter().map(shot).collect()
}
