//! Random views of the paper's shell, for tests.

use super::{Match, Rig, SeenFace};
use crate::imaging::{NoiseStream, Purpose};
use std::ops::Range;
use vocabulary::math;
use vocabulary::{Body, CameraModel, CameraMount, FACES, Pose, Rigid, Shell, wrap};

pub(crate) struct Views {
    stream: NoiseStream,
}

pub(crate) struct PoseView {
    pub(crate) rig: Rig,
    pub(crate) pose: Pose,
    /// Leader's body in the camera.
    pub(crate) camera_from_body: Rigid,
    /// Directions (x/z, y/z) of the corners of every face that can be seen.
    pub(crate) faces: Vec<(usize, [[f64; 2]; 4])>,
}

impl Views {
    pub(crate) fn seeded(seed: u64) -> Self {
        Self { stream: NoiseStream::new(seed, 0, 0, Purpose::Pixels) }
    }

    pub(crate) fn uniform(&mut self, range: Range<f64>) -> f64 {
        range.start + (range.end - range.start) * self.stream.uniform()
    }

    pub(crate) fn normal(&mut self) -> f64 {
        f64::from(self.stream.normal())
    }

    /// A leader at a distance from `range` (m), somewhere ahead, with any heading; the camera turned towards it but for
    /// a few degrees.
    pub(crate) fn next(&mut self, range: Range<f64>) -> PoseView {
        let (distance, bearing) = (self.uniform(range), self.uniform(-0.8..0.8));
        let pose = Pose::new(
            distance * math::cos(bearing),
            distance * math::sin(bearing),
            wrap(self.uniform(-3.1..3.1)),
        );
        let pan = bearing + self.uniform(-0.15..0.15);
        let body_from_camera = CameraMount::fitting(&Body::default()).body_from_camera(pan);
        let rig =
            Rig { shell: Shell::PAPER.tagged(3), camera_model: CameraModel::default(), body_from_camera };
        PoseView::of(rig, pose)
    }
}

impl PoseView {
    pub(crate) fn of(rig: Rig, pose: Pose) -> Self {
        let body = Rigid::turned([pose.x, pose.y, 0.0], pose.heading, 0.0, 0.0);
        Self::tilted(rig, pose, &body)
    }

    /// Of a leader whose body is not upright.
    pub(crate) fn tilted(rig: Rig, pose: Pose, body: &Rigid) -> Self {
        let camera_from_body = rig.body_from_camera.inverse().after(body);
        let seen = |face: usize| {
            let tag = camera_from_body.after(&rig.shell.body_from_face(face));
            let (out, at) = (tag.turn([0.0, 0.0, 1.0]), tag.translation);
            let cosine =
                -(0..3).map(|k| out[k] * at[k]).sum::<f64>() / at.iter().map(|x| x * x).sum::<f64>().sqrt();
            let corners = rig.shell.tag_corners(face).map(|c| camera_from_body.apply(c));
            let ahead = corners.iter().all(|c| c[2] > 0.05);
            (cosine > math::cos(65_f64.to_radians()) && ahead)
                .then(|| (face, corners.map(|[x, y, z]| [x / z, y / z])))
        };
        Self { rig, pose, camera_from_body, faces: (0..FACES).filter_map(seen).collect() }
    }

    /// With every corner off by `sigma` pixels of the default lens.
    pub(crate) fn noisy(mut self, sigma: f64, views: &mut Views) -> Self {
        let sigma = sigma / self.rig.camera_model.focal;
        for x in self.faces.iter_mut().flat_map(|(_, corners)| corners.iter_mut().flatten()) {
            *x += sigma * views.normal();
        }
        self
    }

    /// The faces in pixels.
    pub(crate) fn seen(&self) -> Vec<SeenFace> {
        let pixel = |[x, y]: [f64; 2]| self.rig.camera_model.project([x, y, 1.0]).expect("in front");
        self.faces
            .iter()
            .map(|(face, c)| SeenFace { face: *face, corners: c.map(pixel), deviation: 0.0 })
            .collect()
    }
}

pub(crate) fn matches_of(view: &PoseView) -> Vec<Match> {
    view.faces
        .iter()
        .flat_map(|(face, corners)| {
            let points = view.rig.shell.tag_corners(*face);
            points.into_iter().zip(*corners).map(|(point, seen)| Match { point, seen })
        })
        .collect()
}

/// Largest difference between two frames' numbers.
pub(crate) fn apart(a: &Rigid, b: &Rigid) -> f64 {
    let numbers = |r: &Rigid| r.rotation.into_iter().flatten().chain(r.translation).collect::<Vec<_>>();
    numbers(a).iter().zip(numbers(b)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}
