//! From places in the world to pixels and back, for pointing at a picture.

use crate::camera::Camera;
use crate::camera::viewpoint::{FreeCamera, Tile, Viewpoint};
use crate::ground::floor::Floor;
use glam::{DVec2, DVec3};
use vocabulary::math;

/// Maximum distance of a search, m.
const FAR: f64 = 2_000.0;

/// How one view of a picture is seen. Pixels are those of the whole picture, from its upper left corner, and whole
/// numbers are between two of them; places are in the world frame, m.
#[derive(Debug, Clone)]
pub struct Sightline {
    /// The view.
    pub view: Viewpoint,
    /// Its part of the picture.
    pub tile: Tile,
    pub(crate) camera: Camera,
    pub(crate) floor: Floor,
}

/// A half line from the eye.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ViewRay {
    pub(crate) from: DVec3,
    /// Not of unit length: one deep.
    pub(crate) along: DVec3,
}

impl ViewRay {
    pub(crate) fn at(&self, far: f64) -> DVec3 {
        self.from + self.along * far
    }
}

impl Sightline {
    /// Whether a pixel is in its part of the picture.
    pub fn holds(&self, [x, y]: [f64; 2]) -> bool {
        let inside =
            |at: f64, from: u32, size: u32| at >= f64::from(from) && at < f64::from(from) + f64::from(size);
        inside(x, self.tile.x, self.tile.width) && inside(y, self.tile.y, self.tile.height)
    }

    /// Where a place appears, also beside the tile; `None` behind the eye.
    pub fn pixel(&self, place: [f64; 3]) -> Option<[f64; 2]> {
        let seen = self.camera.project(DVec3::from_array(place))?;
        let x = f64::from(self.tile.x) + (seen.x + 1.0) * 0.5 * f64::from(self.tile.width);
        let y = f64::from(self.tile.y) + (1.0 - seen.y) * 0.5 * f64::from(self.tile.height);
        (x.is_finite() && y.is_finite()).then_some([x, y])
    }

    /// Where a place on the floor appears: on the ground, or on the ramp or platform that is there.
    pub fn pixel_of_ground(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        self.pixel([x, y, self.floor.height(DVec2::new(x, y))])
    }

    /// The place on the floor that is seen at a pixel, the nearest where there are several; `None` in the sky.
    pub fn ground(&self, pixel: [f64; 2]) -> Option<[f64; 2]> {
        let ray = self.ray(pixel);
        let place = ray.at(self.depth(&ray)?);
        place.is_finite().then_some([place.x, place.y])
    }

    /// Height of the floor at a place, m.
    pub fn height(&self, [x, y]: [f64; 2]) -> f64 {
        self.floor.height(DVec2::new(x, y))
    }

    /// Metres across a pixel at a place.
    pub fn metres_per_pixel(&self, place: [f64; 3]) -> f64 {
        self.camera.metres_per_pixel(DVec3::from_array(place), f64::from(self.tile.height))
    }

    /// The free camera that shows the same ground in the same places, for the user to take over: it orbits around what
    /// is in the middle of the tile. A view without perspective gets one, and a view through a camera loses its lean.
    pub fn free(&self) -> FreeCamera {
        let camera = &self.camera;
        let flat = if camera.forward.truncate().length() > 1e-6 { camera.forward } else { camera.up };
        let (heading, pitch) =
            (math::atan2(flat.y, flat.x), math::asin((-camera.forward.z).clamp(-1.0, 1.0)));
        let middle = ViewRay { from: camera.eye, along: camera.forward };
        let (depth, distance, field_of_view) = if camera.perspective {
            // Where the middle is sky or far away, something near that is not.
            let most = 12.0 * (camera.eye.z - self.floor.ground(camera.eye.truncate())).max(0.5);
            let distance = self.depth(&middle).unwrap_or(most).min(most);
            (distance, distance, 2.0 * math::atan(camera.half.y))
        } else {
            let field_of_view = FreeCamera::FIELD_OF_VIEW;
            let distance = camera.half.y / math::tan(0.5 * field_of_view);
            (self.depth(&middle).unwrap_or(camera.eye.z), distance, field_of_view)
        };
        FreeCamera { target: middle.at(depth).to_array(), heading, pitch, distance, field_of_view }
    }

    /// The ray that is seen at a pixel.
    pub(crate) fn ray(&self, [x, y]: [f64; 2]) -> ViewRay {
        let camera = &self.camera;
        let right = 2.0 * (x - f64::from(self.tile.x)) / f64::from(self.tile.width) - 1.0;
        let up = 1.0 - 2.0 * (y - f64::from(self.tile.y)) / f64::from(self.tile.height);
        let seen = DVec2::new(right, up) * camera.half;
        if camera.perspective {
            let [aside, above] = (seen + camera.shift).to_array();
            let along = camera.forward + camera.right * aside + camera.up * above;
            return ViewRay { from: camera.eye, along };
        }
        ViewRay { from: camera.eye + camera.right * seen.x + camera.up * seen.y, along: camera.forward }
    }

    /// How far along a ray the floor is.
    pub(crate) fn depth(&self, ray: &ViewRay) -> Option<f64> {
        if self.floor.is_plane() {
            let far = -ray.from.z / ray.along.z;
            return (ray.along.z < -1e-9 && far > 0.0 && far < FAR).then_some(far);
        }
        let over = |far: f64| {
            let at = ray.at(far);
            at.z - self.floor.height(at.truncate())
        };
        let [low, high] = self.floor.range;
        // From where it may meet the floor to where it no longer can.
        let reach = |height: f64| (height - ray.from.z) / ray.along.z;
        let (mut from, until) = if ray.along.z < -1e-9 {
            (reach(high).max(0.0), reach(low).min(FAR))
        } else if ray.along.z > 1e-9 {
            (0.0, reach(high).min(FAR))
        } else {
            (0.0, FAR)
        };
        if over(from) < 0.0 {
            // The eye is under the floor.
            return None;
        }
        // Steps grow with the distance as pixels do, and none passes over a ridge of some pixels.
        let step = self.floor.grain() / ray.along.truncate().length().max(1e-6);
        while from < until {
            let next = (from + step.max(0.004 * from)).min(until + 1e-9);
            if over(next) <= 0.0 {
                return Some(met(from, next, over));
            }
            from = next;
        }
        None
    }
}

/// Where between two depths the floor is met, to the last digit.
fn met(mut above: f64, mut under: f64, over: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..64 {
        let middle = 0.5 * (above + under);
        if over(middle) > 0.0 { above = middle } else { under = middle }
    }
    0.5 * (above + under)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use vocabulary::{FleetInfo, Mobility, Placement, Pose, Prop, Solid, Terrain};

    const TILE: Tile = Tile { x: 100, y: 40, width: 640, height: 360 };

    fn line(camera: Camera, floor: Floor) -> Sightline {
        Sightline { view: Viewpoint::Snake, tile: TILE, camera, floor }
    }

    fn looking(eye: [f64; 3]) -> Camera {
        Camera::looking(DVec3::from_array(eye), DVec3::new(1.0, 0.5, 0.0), 0.7, 640.0 / 360.0)
    }

    fn parallel() -> Camera {
        Camera {
            forward: DVec3::NEG_Z,
            right: DVec3::X,
            up: DVec3::Y,
            half: DVec2::new(8.0, 4.5),
            perspective: false,
            ..looking([1.0, 2.0, 100.0])
        }
    }

    fn hills() -> Floor {
        let height = |k: usize| 0.4 * math::sin((k % 61) as f64 * 0.3) * math::cos((k / 61) as f64 * 0.2);
        let heights = (0..61 * 61).map(height).collect();
        let terrain = Terrain { origin: [-7.5; 2], cell: 0.25, columns: 61, rows: 61, heights, grip: vec![] };
        let ramp = Prop {
            name: String::new(),
            solid: Solid::Wedge { size: [2.0, 1.5, 0.6] },
            placement: Placement::upright(Pose::new(1.0, 0.0, 0.4), 0.1),
            mobility: Mobility::Fixed,
        };
        Floor::new(&FleetInfo { props: vec![ramp], terrain: Some(Arc::new(terrain)), ..FleetInfo::default() })
    }

    #[test]
    fn ground_and_pixels_are_each_others_inverse() {
        for floor in [Floor::default(), hills()] {
            for camera in [looking([-6.0, -3.0, 4.0]), looking([1.0, 0.5, 9.0]), parallel()] {
                let sight = line(camera, floor.clone());
                let mut found = 0;
                for k in 0..24 * 14 {
                    let pixel = [110.0 + f64::from(k % 24) * 26.0, 45.0 + f64::from(k / 24) * 25.0];
                    let Some(place) = sight.ground(pixel) else { continue };
                    let [x, y] = sight.pixel_of_ground(place).unwrap();
                    // At the foot of a ramp's side the floor jumps.
                    found += usize::from(math::hypot(x - pixel[0], y - pixel[1]) < 1e-6);
                }
                assert!(found > 300, "{found} of {}", 24 * 14);
            }
        }
    }

    #[test]
    fn there_is_no_ground_in_the_sky() {
        let level = Camera::looking(DVec3::new(0.0, 0.0, 1.0), DVec3::new(1.0, 0.0, 1.0), 0.7, 1.0);
        for floor in [Floor::default(), hills()] {
            let sight = line(level, floor);
            assert!(sight.ground([400.0, 60.0]).is_none() && sight.ground([400.0, 390.0]).is_some());
        }
        assert!(line(level, Floor::default()).pixel([-1.0, 0.0, 0.0]).is_none());
    }

    #[test]
    fn a_hand_takes_over_without_a_jump() {
        let pitched = looking([-6.0, -3.0, 4.0]);
        for camera in [pitched, looking([0.0, 0.0, 0.4]), parallel()] {
            let sight = line(camera, Floor::default());
            let view = sight.free().view();
            let Viewpoint::Fixed { eye, target, field_of_view } = view else { panic!("{view:?}") };
            let [eye, target] = [eye, target].map(DVec3::from_array);
            let free = line(Camera::looking(eye, target, field_of_view, 640.0 / 360.0), Floor::default());
            for pixel in [[101.0, 399.0], [420.0, 220.0], [700.0, 300.0], [739.0, 399.0]] {
                let [x, y] = free.pixel_of_ground(sight.ground(pixel).unwrap()).unwrap();
                assert!(math::hypot(x - pixel[0], y - pixel[1]) < 0.01, "{pixel:?} {x} {y}");
            }
        }
    }
}
