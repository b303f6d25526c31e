//! How a tag stands in a camera's picture, by geometry alone.

use perception::sensors::{MARGIN, readable};
use vocabulary::{CameraModel, FACES, Region, Rigid, Shell, math};

/// Cosine of the angle, and pixels a cell, at which a tag is surely read.
const SURELY: (f64, f64) = (0.55, 2.0);
/// What is looked at reaches this share of the shell's size beyond it, and this many pixels, as for cameras that track.
const AROUND: (f64, f64) = (0.25, 14.0);
/// Sides of what is looked at are whole multiples of this, pixels.
const GRID: u32 = 16;

/// A tag that is turned towards a camera and lies within its picture.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FaceView {
    /// The tag's frame in the camera's: x to the right and y up as seen from outside, z outward.
    pub(crate) camera_from_tag: Rigid,
    /// Pixels, in the order of `Shell::tag_corners`.
    pub(crate) corners: [[f64; 2]; 4],
    /// Between the way to the camera and the tag's normal, rad.
    pub(crate) incidence: f64,
    /// Side of a cell that is seen from ahead at that distance, pixels.
    pub(crate) cell: f64,
}

impl FaceView {
    /// How a face of a shell is seen; `None` if it is turned away or not all of its tag is in the picture.
    pub(crate) fn of(
        shell: &Shell,
        camera_model: &CameraModel,
        camera_from_body: &Rigid,
        face: usize,
    ) -> Option<Self> {
        let camera_from_tag = camera_from_body.after(&shell.body_from_face(face));
        let (at, out) = (camera_from_tag.translation, camera_from_tag.turn([0.0, 0.0, 1.0]));
        let away = at.iter().map(|x| x * x).sum::<f64>().sqrt();
        let slant = -(0..3).map(|k| at[k] * out[k]).sum::<f64>() / away;
        // Not so for numbers that are none either.
        if !(slant > 0.0 && away > 1e-6) {
            return None;
        }
        let [Some(a), Some(b), Some(c), Some(d)] =
            shell.tag_corners(face).map(|corner| seen(camera_model, camera_from_body.apply(corner)))
        else {
            return None;
        };
        let corners = [a, b, c, d];
        corners.iter().all(|p| camera_model.holds(*p, 0.0)).then(|| Self {
            camera_from_tag,
            corners,
            incidence: math::acos(slant.clamp(-1.0, 1.0)),
            cell: camera_model.focal * shell.cell / away,
        })
    }

    /// Whether there can be no doubt that it is read, as cameras that track judge it.
    pub(crate) fn surely_readable(&self) -> bool {
        math::cos(self.incidence) > SURELY.0 && self.cell > SURELY.1
    }

    /// Whether a detector should read it: large enough for its slant, and not at the edge of the picture.
    pub(crate) fn readable(&self, camera_model: &CameraModel) -> bool {
        readable(math::cos(self.incidence), self.cell)
            && self.corners.iter().all(|p| camera_model.holds(*p, MARGIN))
    }
}

/// Where a point of the camera's frame is seen; `None` where distortion folds the picture over and what is outside of
/// the view seems to be in it.
fn seen(camera_model: &CameraModel, point: [f64; 3]) -> Option<[f64; 2]> {
    let pixel = camera_model.project(point)?;
    let back = camera_model.direction(pixel);
    let off = |k: usize| (back[k] - point[k] / point[2]).abs();
    (off(0).max(off(1)) < 1e-6).then_some(pixel)
}

/// The part of a picture that a camera which tracks a shell looks at; the whole where the shell is not in it.
pub(crate) fn region_around(shell: &Shell, camera_model: &CameraModel, camera_from_body: &Rigid) -> Region {
    let whole = Region::whole(camera_model);
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in (0..FACES).flat_map(|face| shell.tag_corners(face)) {
        let Some(pixel) = seen(camera_model, camera_from_body.apply(corner)) else { return whole };
        for k in 0..2 {
            low[k] = low[k].min(pixel[k]);
            high[k] = high[k].max(pixel[k]);
        }
    }
    let margin = AROUND.0 * (high[0] - low[0]).max(high[1] - low[1]) + AROUND.1;
    let along = |k: usize, pixels: u32| {
        let first = ((low[k] - margin).max(0.0) as u32).min(pixels) / GRID * GRID;
        let last = ((high[k] + margin).max(0.0) as u32).min(pixels);
        let length = last.checked_sub(first)?.next_multiple_of(GRID).min(pixels - first);
        (length >= 2 * GRID).then_some((first, length))
    };
    match (along(0, camera_model.width), along(1, camera_model.height)) {
        (Some((x, width)), Some((y, height))) => Region { x, y, width, height },
        _ => whole,
    }
}

/// Whether the walls of a shell stand between two points of its robot's frame: a camera that looks back over its
/// shoulder has its own in the way.
pub(crate) fn walls_hide(shell: &Shell, from: [f64; 3], to: [f64; 3]) -> bool {
    (0..FACES).any(|face| {
        let frame = shell.body_from_face(face).inverse();
        let (a, b) = (frame.apply(from), frame.apply(to));
        if a[2] * b[2] >= 0.0 {
            return false;
        }
        let share = a[2] / (a[2] - b[2]);
        let [x, y] = [0, 1].map(|k| a[k] + (b[k] - a[k]) * share);
        2.0 * y.abs() * math::cos(shell.lean) < shell.face_height && x.abs() < shell.half_width(y)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Body, CameraMount, Pose, RobotState};

    /// A leader in the frame of a default camera that looks ahead.
    fn leader(x: f64, y: f64, heading: f64) -> Rigid {
        let camera = CameraMount::fitting(&Body::default()).world_from_camera(&RobotState::default());
        let body = Rigid::turned([x, y, 0.0], Pose::new(x, y, heading).heading, 0.0, 0.0);
        camera.inverse().after(&body)
    }

    fn faces(camera_from_body: &Rigid) -> Vec<usize> {
        let (shell, camera_model) = (Shell::PAPER, CameraModel::default());
        let readable = |face: &usize| {
            FaceView::of(&shell, &camera_model, camera_from_body, *face)
                .is_some_and(|view| view.readable(&camera_model))
        };
        (0..FACES).filter(readable).collect()
    }

    #[test]
    fn the_faces_that_are_read_are_those_that_look_here_and_are_near() {
        assert_eq!(faces(&leader(2.0, 0.0, 0.0)), [1, 2, 3]);
        assert_eq!(faces(&leader(2.0, 0.0, std::f64::consts::FRAC_PI_4)), [0, 1, 2]);
        assert_eq!(faces(&leader(2.0, 0.0, -0.75 * std::f64::consts::PI)), [4]);
        assert_eq!(faces(&leader(5.5, 0.0, 0.0)), [2]);
        assert!(faces(&leader(7.0, 0.0, 0.0)).is_empty());
        assert!(faces(&leader(2.0, 0.0, std::f64::consts::PI)).is_empty());
        assert!(faces(&leader(2.0, 1.5, 0.0)).is_empty(), "outside of the picture");
        assert!(faces(&leader(-2.0, 0.0, 0.0)).is_empty(), "behind the camera");
        assert!(faces(&leader(f64::NAN, 0.0, 0.0)).is_empty());
    }

    #[test]
    fn a_face_that_looks_here_has_corners_in_the_order_of_its_tag() {
        let view =
            FaceView::of(&Shell::PAPER, &CameraModel::default(), &leader(2.0, 0.0, 0.0), 2).expect("seen");
        let [[left, top], [right, _], [_, bottom], _] = view.corners;
        assert!(left < right && top < bottom, "{view:?}");
        // It leans back by 10°, and the camera is a little above it.
        assert!(view.incidence < 0.15, "{view:?}");
        let side = right - left;
        assert!((side / view.cell - 8.0).abs() < 0.2, "{view:?}");
    }

    #[test]
    fn a_region_holds_the_shell() {
        let (shell, camera_model) = (Shell::PAPER, CameraModel::default());
        let camera_from_body = leader(3.0, 0.2, 0.4);
        let region = region_around(&shell, &camera_model, &camera_from_body);
        assert!(region.width < 320 && region.height < 240, "{region:?}");
        for face in 0..FACES {
            let Some(view) = FaceView::of(&shell, &camera_model, &camera_from_body, face) else { continue };
            for [x, y] in view.corners {
                assert!(x > f64::from(region.x) && x < f64::from(region.x + region.width), "{region:?}");
                assert!(y > f64::from(region.y) && y < f64::from(region.y + region.height), "{region:?}");
            }
        }
        assert_eq!(
            region_around(&shell, &camera_model, &leader(-3.0, 0.0, 0.0)),
            Region::whole(&camera_model)
        );
    }

    #[test]
    fn a_shells_walls_are_behind_its_own_camera() {
        let eye = CameraMount::fitting(&Body::default()).body_from_camera(0.0).translation;
        let hides = |x: f64, y: f64, z: f64| walls_hide(&Shell::PAPER, eye, [x, y, z]);
        assert!(!hides(2.0, 0.0, 0.2) && !hides(0.5, 0.0, 0.1) && !hides(0.3, 2.0, 0.2));
        assert!(hides(-1.0, 0.0, 0.2) && hides(-0.8, 0.8, 0.15));
        assert!(!hides(-1.0, 0.0, 0.4), "over the rim");
        assert!(!hides(-0.1, 0.0, 0.2), "within the shell");
    }

    /// With strong distortion the edge of the world is drawn back into the picture.
    #[test]
    fn what_only_seems_to_be_in_the_picture_is_not() {
        let camera_model = CameraModel { distortion: [-0.4, 0.0, 0.0, 0.0, 0.0], ..CameraModel::default() };
        assert!(seen(&camera_model, [0.1, 0.1, 1.0]).is_some());
        let folded = [1.55, 0.0, 1.0];
        assert!(camera_model.project(folded).is_some_and(|p| camera_model.holds(p, 0.0)));
        assert_eq!(seen(&camera_model, folded), None);
    }
}
