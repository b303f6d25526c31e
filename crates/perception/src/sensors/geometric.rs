//! Tags as a camera would see them, calculated: no picture is drawn.

use super::{Exposure, SensorConfig};
use crate::imaging::NoiseStream;
use crate::pose::{Rig, SeenFace};
use vocabulary::FACES;

/// Pixels that a cell needs, seen from ahead and at the steepest angle at which a tag is still read.
const LEAST_CELL: [f64; 2] = [1.75, 2.5];
/// Cosine of that angle, 62°.
const STEEPEST: f64 = 0.469;
/// Pixels that a tag's corners keep from the edge of the picture.
pub const MARGIN: f64 = 4.0;

/// Whether a tag is large enough for its slant to be read: `slant` is the cosine of the angle between the way to the
/// camera and the tag's normal, `cell` the side of a cell that is seen from ahead at that distance, pixels.
pub fn readable(slant: f64, cell: f64) -> bool {
    let share = (1.0 - slant) / (1.0 - STEEPEST);
    slant >= STEEPEST && cell >= LEAST_CELL[0] + (LEAST_CELL[1] - LEAST_CELL[0]) * share
}

/// Corners of the tags that can be read, each coordinate with an error of `pixel_noise` pixels standard deviation.
pub(super) fn faces(
    sensor_config: &SensorConfig,
    exposure: &Exposure<'_>,
    pixel_noise: f64,
    random: &mut NoiseStream,
) -> Vec<SeenFace> {
    let Some(Rig { shell, camera_model, .. }) = sensor_config.rig(exposure) else { return Vec::new() };
    let robots = &exposure.snapshot.robots;
    let world_from_leader = robots[exposure.leader].world_from_body();
    let camera_mount = sensor_config.robots[exposure.follower].camera_mount;
    let world_from_camera = camera_mount.world_from_camera(&robots[exposure.follower]);
    let camera_from_leader = world_from_camera.inverse().after(&world_from_leader);
    let mut seen = Vec::new();
    for face in 0..FACES {
        // Errors are drawn for every face, so that a face out of sight changes none of the others.
        let errors: [[f64; 2]; 4] = std::array::from_fn(|_| [0, 1].map(|_| f64::from(random.normal())));
        let eye = shell.body_from_face(face).inverse().after(&camera_from_leader.inverse()).translation;
        let away = eye.iter().map(|x| x * x).sum::<f64>().sqrt();
        let slant = eye[2] / away;
        let cell = camera_model.focal * shell.cell / away;
        if shell.first_tag.is_none() || !readable(slant, cell) {
            continue;
        }
        let corners = shell.tag_corners(face);
        let pixels = corners.map(|corner| camera_model.project(camera_from_leader.apply(corner)));
        let [Some(a), Some(b), Some(c), Some(d)] = pixels else { continue };
        let pixels = [a, b, c, d];
        let in_picture = pixels.iter().all(|p| camera_model.holds(*p, MARGIN));
        let from = world_from_camera.translation;
        let pair = [exposure.follower, exposure.leader];
        let hidden = |corner: [f64; 3]| {
            sensor_config
                .scenery()
                .hides(exposure.snapshot, pair, from, world_from_leader.apply(corner))
                .is_some()
        };
        if in_picture && !corners.into_iter().any(hidden) {
            let moved = |k: usize| [0, 1].map(|i| pixels[k][i] + pixel_noise * errors[k][i]);
            seen.push(SeenFace { face, corners: [0, 1, 2, 3].map(moved), deviation: 0.0 });
        }
    }
    seen
}
