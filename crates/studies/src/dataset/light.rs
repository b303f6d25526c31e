//! The light that falls on the sensors of cameras, over as long as their shutters are open.

use crate::Error;
use crate::dataset::timeline::Timeline;
use perception::imaging::{self, IdealPicture};
use vocabulary::{CameraRenderer, FleetInfo, Grey, Shot, Snapshot};

/// A picture to be taken: of all a sensor needs for its whole frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PictureRequest {
    pub(crate) robot: usize,
    pub(crate) source: IdealPicture,
}

/// How cameras are exposed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ExposureSettings {
    /// Factor on the light.
    pub(crate) factor: f64,
    /// s.
    pub(crate) shutter: f64,
}

/// Ideal pictures of all that is `wanted` at the instant of `now`, the middle of their exposure.
pub(crate) fn gather(
    renderer: &mut dyn CameraRenderer,
    fleet: &FleetInfo,
    exposure: &ExposureSettings,
    timeline: &Timeline,
    now: &Snapshot,
    wanted: &[PictureRequest],
) -> Result<Vec<Grey>, Error> {
    imaging::gather(exposure.shutter, |off, pictures| {
        let then = timeline.at(now.time + off).filter(|_| off != 0.0);
        let then = then.as_ref().unwrap_or(now);
        let shot = |PictureRequest { robot, source }: &PictureRequest| {
            source.shot(*robot, &fleet.robots[*robot], &then.robots[*robot], exposure.factor)
        };
        let shots: Vec<Shot> = wanted.iter().map(shot).collect();
        renderer.render(then, &shots, pictures).map_err(Error::Camera)
    })
}
