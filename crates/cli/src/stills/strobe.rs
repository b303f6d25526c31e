//! All of a run in one picture, as under a stroboscope: pictures from one place, and of each what moved.

use rendering::Viewpoint;
use vocabulary::{FleetInfo, Picture, StepRecord, math};

/// Vertical field of view, rad.
const FIELD: f64 = 0.55;
/// How far down the camera looks, rad.
const PITCH: f64 = 0.62;
/// Share of the picture that what moves may fill.
const FILL: f64 = 0.86;
/// Directions to look from that are tried.
const HEADINGS: usize = 24;
/// Of a channel, summed over all: what differs by more has moved.
const MOVED: i32 = 26;
/// Opacity of the first body; the last is all there.
const FAINT: f32 = 0.5;

/// A place from which all moments are seen, as near as can be.
pub(super) fn view(records: &[StepRecord], fleet: &FleetInfo, aspect: f64) -> Viewpoint {
    let mut points = Vec::new();
    for record in records {
        for (robot, member) in record.snapshot.robots.iter().zip(&fleet.robots) {
            let (pose, size) = (robot.motion.pose, member.body.length);
            let around = [[-size, -size], [-size, size], [size, -size], [size, size]];
            points.extend(around.map(|[x, y]| [pose.x + x, pose.y + y, robot.attitude.height]));
            points.push([pose.x, pose.y, robot.attitude.height + 2.0 * member.body.height]);
        }
    }
    points.retain(|p| p.iter().all(|x| x.is_finite()));
    let looks = (0..HEADINGS).map(|k| std::f64::consts::TAU * k as f64 / HEADINGS as f64);
    let nearest = looks.map(|heading| stand(&points, heading, aspect)).min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map_or(Viewpoint::Top, |(view, _)| view)
}

/// The nearest place from which all points are seen when looking along `heading`, and how far its eye is from them.
fn stand(points: &[[f64; 3]], heading: f64, aspect: f64) -> (Viewpoint, f64) {
    let (sin, cos) = math::sin_cos(heading);
    let forward = [cos * math::cos(PITCH), sin * math::cos(PITCH), -math::sin(PITCH)];
    let right = [sin, -cos, 0.0];
    let up = [cos * math::sin(PITCH), sin * math::sin(PITCH), math::cos(PITCH)];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let high = FILL * math::tan(0.5 * FIELD);
    let wide = high * aspect;
    // Each side of the picture is a plane through the eye: the farthest point beyond it bounds the eye.
    let most =
        |side: &dyn Fn([f64; 3]) -> f64| points.iter().map(|p| side(*p)).fold(f64::NEG_INFINITY, f64::max);
    let left = most(&|p| -dot(p, right) - wide * dot(p, forward));
    let other = most(&|p| dot(p, right) - wide * dot(p, forward));
    let under = most(&|p| -dot(p, up) - high * dot(p, forward));
    let over = most(&|p| dot(p, up) - high * dot(p, forward));
    let nearest = points.iter().map(|p| dot(*p, forward)).fold(f64::INFINITY, f64::min);
    let along = (-(left + other) / (2.0 * wide)).min(-(under + over) / (2.0 * high)).min(nearest - 1.0);
    let (across, rise) = (0.5 * (other - left), 0.5 * (over - under));
    let eye = [0, 1, 2].map(|k| right[k] * across + up[k] * rise + forward[k] * along);
    let target = [0, 1, 2].map(|k| eye[k] + 10.0 * forward[k]);
    let middle = points.iter().map(|p| dot(*p, forward)).sum::<f64>() / points.len().max(1) as f64;
    (Viewpoint::Fixed { eye, target, field_of_view: FIELD }, middle - along)
}

/// What moved in any of the pictures, on what did not; earlier pictures fainter.
pub(super) fn together(pictures: &[Picture]) -> Picture {
    let Some(last) = pictures.last() else { return Picture { width: 1, height: 1, rgba: vec![0; 4] } };
    let mut out = last.clone();
    let mut column: Vec<u8> = vec![0; pictures.len()];
    for pixel in 0..out.rgba.len() / 4 {
        let at = 4 * pixel;
        let still: [u8; 3] = std::array::from_fn(|channel| {
            for (value, picture) in column.iter_mut().zip(pictures) {
                *value = picture.rgba[at + channel];
            }
            // Most of the time there is no robot at a pixel.
            column.sort_unstable();
            column[column.len() / 2]
        });
        let mut colour = still.map(f32::from);
        for (k, picture) in pictures.iter().enumerate() {
            let own: [u8; 3] = std::array::from_fn(|channel| picture.rgba[at + channel]);
            let apart: i32 = own.iter().zip(&still).map(|(a, b)| (i32::from(*a) - i32::from(*b)).abs()).sum();
            if apart > MOVED {
                let share = k as f32 / (pictures.len() - 1).max(1) as f32;
                let opacity = FAINT + (1.0 - FAINT) * share;
                colour = std::array::from_fn(|c| colour[c] + opacity * (f32::from(own[c]) - colour[c]));
            }
        }
        for (channel, value) in colour.into_iter().enumerate() {
            out.rgba[at + channel] = value.round() as u8;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_is_there_as_often_as_it_was_seen() {
        let picture = |place: usize| {
            let mut rgba = [100, 100, 100, 255].repeat(8);
            rgba[4 * place..4 * place + 3].copy_from_slice(&[250, 20, 20]);
            Picture { width: 8, height: 1, rgba }
        };
        let all = together(&[picture(0), picture(2), picture(4), picture(6), picture(7)]);
        let red = |place: usize| all.rgba[4 * place];
        assert_eq!([red(1), red(3), red(5)], [100; 3]);
        assert!(red(0) == 175 && red(4) > red(2) && red(7) == 250);
    }

    #[test]
    fn every_point_is_in_the_picture() {
        let points = [[0.0, 0.0, 0.0], [12.0, 0.5, 0.0], [5.0, -2.0, 0.4]];
        for heading in [0.0, 1.0, 2.5] {
            let (Viewpoint::Fixed { eye, target, .. }, _) = stand(&points, heading, 1.6) else {
                panic!("a place")
            };
            let forward = [0, 1, 2].map(|k| (target[k] - eye[k]) / 10.0);
            for p in points {
                let d = [0, 1, 2].map(|k| p[k] - eye[k]);
                let depth: f64 = (0..3).map(|k| d[k] * forward[k]).sum();
                let (sin, cos) = math::sin_cos(heading);
                let (across, rise) = (
                    d[0] * sin - d[1] * cos,
                    (d[0] * cos + d[1] * sin) * math::sin(PITCH) + d[2] * math::cos(PITCH),
                );
                let most = math::tan(0.5 * FIELD) * depth;
                assert!(depth > 0.9 && rise.abs() < most && across.abs() < 1.6 * most, "{heading}: {p:?}");
            }
        }
    }
}
