//! The light that falls on the sensors of cameras, over as long as their shutters are open.

use crate::dataset::timeline::Timeline;
use crate::failure::Failure;
use rendering::CameraEyes;
use vocabulary::{Cast, Grey, Region, Shot, Snapshot};

/// Instants over which a picture with a shutter gathers its light, as for cameras that steer by their pictures.
const SMEAR: u32 = 6;

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

/// Ideal pictures of all that is `wanted` at the instant of `now`, the end of their exposure.
pub(crate) fn gather(
    eyes: &mut CameraEyes,
    cast: &Cast,
    exposure: &Exposure,
    (timeline, now): (&Timeline, &Snapshot),
    wanted: &[Wanted],
) -> Result<Vec<Grey>, Failure> {
    let mut pictures = Vec::new();
    // At the start of the run nothing has moved yet.
    let shutter = exposure.shutter.min(now.time);
    if shutter <= 0.0 {
        eyes.take(now, &shots(cast, exposure, now, wanted), &mut pictures)?;
        return Ok(pictures);
    }
    let mut sums: Vec<Vec<u32>> = vec![Vec::new(); wanted.len()];
    for k in 0..SMEAR {
        let ago = shutter * f64::from(k) / f64::from(SMEAR - 1);
        let mut then = timeline.at(now.time - ago).unwrap_or_else(|| now.clone());
        // Where a camera points is known for the instant of the picture.
        for (robot, now) in then.robots.iter_mut().zip(&now.robots) {
            robot.camera_pan = now.camera_pan;
        }
        eyes.take(&then, &shots(cast, exposure, &then, wanted), &mut pictures)?;
        for (sum, picture) in sums.iter_mut().zip(&pictures) {
            sum.resize(picture.values.len(), 0);
            for (total, value) in sum.iter_mut().zip(&picture.values) {
                *total += u32::from(*value);
            }
        }
    }
    for (picture, sum) in pictures.iter_mut().zip(&sums) {
        for (value, total) in picture.values.iter_mut().zip(sum) {
            *value = ((total + SMEAR / 2) / SMEAR) as u8;
        }
    }
    Ok(pictures)
}

fn shots(cast: &Cast, exposure: &Exposure, snapshot: &Snapshot, wanted: &[Wanted]) -> Vec<Shot> {
    let shot = |want: &Wanted| {
        let member = &cast.members[want.robot];
        Shot {
            robot: want.robot,
            world_from_camera: member.mount.world_from_camera(&snapshot.robots[want.robot]),
            focal: member.lens.focal,
            centre: want.centre,
            region: want.region,
            exposure: exposure.factor,
        }
    };
    wanted.iter().map(shot).collect()
}
