//! The way of a camera from one view to another; it never leans.

use crate::camera::Camera;
use crate::camera::smoothing::SmoothedFormation;
use glam::{DVec2, DVec3};
use vocabulary::math;
use vocabulary::nearest_turn;

/// The camera at `share` of the way, 0 to 1. What it looks at stays about as large as in both: place and size of what is
/// seen go evenly, heading and pitch turn, and a view without perspective is one from very far away.
pub(crate) fn between(from: &Camera, to: &Camera, share: f64, smoothed: &SmoothedFormation) -> Camera {
    if share <= 0.0 {
        return *from;
    }
    if share >= 1.0 {
        return *to;
    }
    let extent = smoothed.formation();
    let [x, y] = extent.middle();
    let middle = DVec3::new(x, y, extent.ground[0]);
    let (a, b) = (CameraFraming::of(from, middle), CameraFraming::of(to, middle));
    let mix = |p: f64, q: f64| p + (q - p) * share;
    let geometric = |p: f64, q: f64| math::exp(mix(math::ln(p), math::ln(q)));
    let (heading, pitch) = (mix(a.heading, nearest_turn(b.heading, a.heading)), mix(a.pitch, b.pitch));
    let tangent = geometric(a.tangent, b.tangent);
    let distance = geometric(a.size, b.size) / tangent;
    let target = a.target.lerp(b.target, share);
    let (ahead, right) = (math::sin_cos(heading), DVec3::new(math::sin(heading), -math::cos(heading), 0.0));
    let forward = DVec3::new(ahead.1 * math::cos(pitch), ahead.0 * math::cos(pitch), -math::sin(pitch));
    let half = DVec2::new(tangent * from.half.x / from.half.y, tangent);
    let camera = Camera::upright(target - forward * distance, forward, right, half);
    Camera { shift: from.shift.lerp(to.shift, share), near: from.near, ..camera }
}

/// A camera by what it sees.
struct CameraFraming {
    /// The way it looks, as on a compass; of one that looks straight down, where the picture's top is. rad.
    heading: f64,
    /// How far it looks down, rad.
    pitch: f64,
    /// Straight ahead, as far away as the middle of the formation, m.
    target: DVec3,
    /// Half the height of what is seen there, m.
    size: f64,
    /// Tangent of half the field of view.
    tangent: f64,
}

impl CameraFraming {
    fn of(camera: &Camera, middle: DVec3) -> Self {
        let away = (middle - camera.eye).dot(camera.forward).max(0.5);
        let flat = if camera.forward.z < -0.999_999 { camera.up } else { camera.forward };
        let (heading, pitch) =
            (math::atan2(flat.y, flat.x), math::asin((-camera.forward.z).clamp(-1.0, 1.0)));
        let target = camera.eye + camera.forward * away;
        // Sides in metres where there is no perspective, tangents elsewhere.
        let (size, tangent) = if camera.perspective {
            (camera.half.y * away, camera.half.y)
        } else {
            (camera.half.y, camera.half.y / away)
        };
        Self { heading, pitch, target, size, tangent }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends() -> (Camera, Camera) {
        let near = Camera::looking(DVec3::new(-6.0, 1.0, 3.0), DVec3::ZERO, 0.8, 1.6);
        let far = Camera {
            eye: DVec3::new(0.5, 0.0, 100.0),
            forward: DVec3::NEG_Z,
            right: DVec3::X,
            up: DVec3::Y,
            half: DVec2::new(6.4, 4.0),
            perspective: false,
            ..near
        };
        (near, far)
    }

    #[test]
    fn it_begins_and_ends_where_the_views_are() {
        let (near, far) = ends();
        let smoothed = SmoothedFormation::default();
        for (share, wanted) in [(1e-9, near), (1.0 - 1e-9, far)] {
            let camera = between(&near, &far, share, &smoothed);
            for place in [DVec3::ZERO, DVec3::new(1.0, -0.8, 0.1), DVec3::new(-1.0, 1.5, 0.0)] {
                let (found, seen) = (camera.project(place), wanted.project(place));
                let apart = found.zip(seen).map_or(f64::INFINITY, |(a, b)| a.distance(b));
                // A parallel view is one from a hundred metres, nearly.
                assert!(apart < 0.02, "{share}: {found:?} is not {seen:?}");
            }
        }
    }

    #[test]
    fn it_goes_smoothly_and_keeps_what_it_looks_at() {
        let (near, far) = ends();
        let smoothed = SmoothedFormation::default();
        let mut before: Option<DVec2> = None;
        for k in 0..=200 {
            let camera = between(&near, &far, f64::from(k) / 200.0, &smoothed);
            let seen = camera.project(DVec3::new(0.3, 0.2, 0.0)).expect("in front of it");
            assert!(seen.abs().max_element() < 1.0, "{k}: {seen}");
            assert!(before.is_none_or(|b| b.distance(seen) < 0.03), "it jumps at {k}");
            assert!(
                (camera.right.cross(camera.up) + camera.forward).length() < 1e-9 && camera.right.z == 0.0
            );
            before = Some(seen);
        }
    }
}
