//! The light that falls on the sensors of cameras, over as long as their shutters are open.

use crate::dataset::timeline::Timeline;
use crate::failure::Failure;
use perception::imaging;
use rendering::GpuCameraRenderer;
use vocabulary::{FleetInfo, Grey, Region, Shot, Snapshot};

/// A picture to be taken: of all a sensor needs for its whole frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted {
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
    eyes: &mut GpuCameraRenderer,
    fleet: &FleetInfo,
    exposure: &Exposure,
    (timeline, now): (&Timeline, &Snapshot),
    wanted: &[Wanted],
) -> Result<Vec<Grey>, Failure> {
    imaging::gather(exposure.shutter, |off, pictures| {
        let then = timeline.at(now.time + off).filter(|_| off != 0.0);
        let then = then.as_ref().unwrap_or(now);
        Ok(eyes.take(then, &shots(fleet, exposure, then, wanted), pictures)?)
    })
}

fn shots(fleet: &FleetInfo, exposure: &Exposure, snapshot: &Snapshot, wanted: &[Wanted]) -> Vec<Shot> {
    let shot = |want: &Wanted| {
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
