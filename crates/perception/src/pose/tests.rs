//! Poses from exact and from noisy corners, against bounds and an oracle.

use super::*;
use crate::imaging::{NoiseStream, Purpose, noise_stream};
use proptest::prelude::*;
use std::ops::Range;
use vocabulary::{Body, CameraMount, math};

/// Random views of the paper's shell.
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
        Self { stream: noise_stream(seed, 0, 0, Purpose::Pixels) }
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
pub(crate) fn frames_apart(a: &Rigid, b: &Rigid) -> f64 {
    let numbers = |r: &Rigid| r.rotation.into_iter().flatten().chain(r.translation).collect::<Vec<_>>();
    numbers(a).iter().zip(numbers(b)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

const FLAT: Prior = Prior { tilt: 0.0, height: 0.0 };

fn off(a: &Pose, b: &Pose) -> f64 {
    apart(a, b)
}

#[test]
fn exact_corners_give_the_pose() {
    let mut views = Views::seeded(11);
    let (mut tried, mut flipped) = (0, 0);
    for _ in 0..600 {
        let view = views.next(0.5..6.0);
        if view.faces.is_empty() {
            continue;
        }
        tried += 1;
        let found = locate(&view.rig, &view.seen(), 0.1, &FLAT, None).expect("a pose");
        assert!(off(&found.pose, &view.pose) < 1e-9, "{:?} {:?}", found, view.pose);
        assert!(found.residual < 1e-8);
        flipped += usize::from(found.ambiguous && view.faces.len() > 1);
    }
    assert!(tried > 400 && flipped == 0, "{flipped} of {tried}");
}

#[test]
fn a_distorting_lens_is_undone() {
    let mut views = Views::seeded(12);
    for _ in 0..100 {
        let mut view = views.next(1.0..4.0);
        view.rig.camera_model.distortion = [-0.28, 0.09, 1e-3, -7e-4, -0.01];
        let view = PoseView::of(view.rig, view.pose);
        if !view.faces.is_empty() {
            let found = locate(&view.rig, &view.seen(), 0.1, &FLAT, None).expect("a pose");
            assert!(off(&found.pose, &view.pose) < 1e-8);
        }
    }
}

/// Mahalanobis distance of the error, over trials, for leaders that stand on a plane or are tilted as the prior says.
fn calibration(seed: u64, prior: Prior, trials: usize) -> (f64, f64) {
    let mut views = Views::seeded(seed);
    let (mut sum, mut squares, mut n) = (0.0, 0.0, 0.0_f64);
    while n < trials as f64 {
        let view = views.next(1.0..4.0);
        let [roll, pitch] = [0, 1].map(|_| prior.tilt * views.normal());
        let (x, y) = (view.pose.x, view.pose.y);
        let z = math::hypot(prior.height, prior.tilt * math::hypot(x, y)) * views.normal();
        let body = Rigid::turned([x, y, z], view.pose.heading, pitch, roll);
        let view = PoseView::tilted(view.rig, view.pose, &body);
        if view.faces.len() < 2 {
            continue;
        }
        let noisy = view.noisy(0.15, &mut views);
        let Some(found) = locate(&noisy.rig, &noisy.seen(), 0.15, &prior, None) else { continue };
        let (a, b) = (found.pose, noisy.pose);
        let error = Vector3::new(a.x - b.x, a.y - b.y, wrap(a.heading - b.heading));
        let bound = Matrix3::from_fn(|r, c| found.covariance[r][c]);
        let distance = (error.transpose() * bound.try_inverse().expect("regular") * error)[(0, 0)];
        sum += distance / 3.0;
        squares += math::powi(error.z, 2) / bound[(2, 2)];
        n += 1.0;
    }
    (sum / n, squares / n)
}

/// The error's covariance is the Cramér-Rao bound that is reported with it.
#[test]
fn errors_are_what_the_covariance_says() {
    for (prior, seed) in [(FLAT, 21), (Prior { tilt: 0.03, height: 0.02 }, 22)] {
        let (all, heading) = calibration(seed, prior, 2000);
        assert!((0.9..1.12).contains(&all) && (0.88..1.15).contains(&heading), "{prior:?}: {all} {heading}");
    }
}

#[test]
fn one_bad_corner_does_little() {
    let mut views = Views::seeded(23);
    let (mut squares, mut clean, mut n) = (0.0, 0.0, 0.0);
    for _ in 0..600 {
        let view = views.next(1.5..3.0).noisy(0.1, &mut views);
        if view.faces.len() < 2 {
            continue;
        }
        let mut seen = view.seen();
        let error = |seen: &[SeenFace]| {
            let found = locate(&view.rig, seen, 0.1, &FLAT, None).expect("a pose");
            math::powi(wrap(found.pose.heading - view.pose.heading).to_degrees(), 2)
        };
        clean += error(&seen);
        seen[0].corners[1][0] += 2.0;
        squares += error(&seen);
        n += 1.0;
    }
    let (bad, clean) = ((squares / n).sqrt(), (clean / n).sqrt());
    // Least squares without Huber's weights: 5 times.
    assert!(bad < 2.2 * clean, "{bad} {clean}");
}

#[test]
fn a_single_face_is_never_taken_for_its_mirror_image_unawares() {
    let mut views = Views::seeded(31);
    let (mut tried, mut flips, mut ambiguous, mut raw_flips) = (0, 0, 0, 0);
    while tried < 1500 {
        let sigma = views.uniform(0.1..0.2);
        let mut view = views.next(2.0..5.0);
        if view.faces.is_empty() {
            continue;
        }
        view.faces.truncate(1);
        let view = view.noisy(sigma, &mut views);
        let Some(found) = locate(&view.rig, &view.seen(), 0.2, &FLAT, None) else { continue };
        tried += 1;
        let far = |p: &Pose| wrap(p.heading - view.pose.heading).abs() > 8_f64.to_radians();
        ambiguous += usize::from(found.ambiguous);
        flips += usize::from(!found.ambiguous && far(&found.pose));
        raw_flips += usize::from(found.raw.as_ref().is_none_or(far));
    }
    println!("{ambiguous} ambiguous, {flips} flips, POSIT alone {raw_flips} of {tried}");
    assert!(flips == 0 && ambiguous * 4 < tried, "{flips} flips, {ambiguous} ambiguous of {tried}");
}

#[test]
fn the_expected_pose_settles_which_of_two_is_reported_but_not_that_there_are_two() {
    let mut views = Views::seeded(32);
    let mut seen = 0;
    while seen < 20 {
        let mut view = views.next(4.0..5.0);
        view.faces.truncate(1);
        let view = view.noisy(0.3, &mut views);
        let Some(found) = locate(&view.rig, &view.seen(), 0.5, &FLAT, None).filter(|f| f.ambiguous) else {
            continue;
        };
        let (other, _) = found.other.expect("a rival");
        let again = locate(&view.rig, &view.seen(), 0.5, &FLAT, Some(other)).expect("a pose");
        assert!(again.ambiguous && off(&again.pose, &other) < 5e-3, "{found:?} {again:?}");
        seen += 1;
    }
}

/// On the same noisy corners, unconstrained: a pose as good as SQPnP's or better, and the same one.
#[test]
fn posit_and_sqpnp_agree() {
    use glam::{Vec2, Vec3};
    let mut views = Views::seeded(41);
    let (mut n, mut ours, mut theirs) = (0, 0.0, 0.0);
    for _ in 0..300 {
        let view = views.next(1.0..4.0).noisy(0.1, &mut views);
        if view.faces.len() < 2 {
            continue;
        }
        let matches = matches_of(&view);
        let points: Vec<_> = matches.iter().map(|m| Vec3::from(m.point.map(|x| x as f32))).collect();
        let seen: Vec<_> = matches.iter().map(|m| Vec2::from(m.seen.map(|x| x as f32))).collect();
        let mut solver = sqpnp::Solver::<sqpnp::DefaultParameters>::new();
        assert!(solver.solve(&points, &seen, None));
        let best = solver.best_solution().expect("a pose");
        let t = best.translation();
        let turn = best.rotation_matrix();
        let other = Rigid {
            rotation: [0, 1, 2].map(|r| [0, 1, 2].map(|c| f64::from(turn.col(c)[r]))),
            translation: [t.x, t.y, t.z].map(f64::from),
        };
        let posit = posit(&matches).expect("a pose");
        let refined = locate(&view.rig, &view.seen(), 0.1, &FLAT, None).expect("a pose");
        let heading =
            |camera: &Rigid| flat(&view.rig.body_from_camera.after(camera)).expect("finite").heading;
        // Six degrees of freedom from POSIT and SQPnP; the ground makes three of them known.
        let (a, b) = (heading(&posit), heading(&other));
        assert!(wrap(a - b).abs() < 5_f64.to_radians(), "{a} {b}");
        ours += math::powi(wrap(refined.pose.heading - view.pose.heading), 2);
        theirs += math::powi(wrap(b - view.pose.heading), 2);
        n += 1;
    }
    assert!(n > 100 && ours < theirs, "{n} {ours} {theirs}");
}

#[test]
fn a_sighting_has_the_spread_of_its_noise() {
    let mut views = Views::seeded(51);
    let view = views.next(2.5..2.6);
    let view = PoseView::of(view.rig, Pose::new(2.4, 0.3, 0.9));
    let truth = Relative::between(view.pose, Pose::default());
    let (mut squares, mut said, n) = ([0.0; 3], [0.0; 3], 1500.0);
    for _ in 0..1500 {
        let noisy = PoseView::of(view.rig, view.pose).noisy(0.15, &mut views);
        let found = locate(&noisy.rig, &noisy.seen(), 0.15, &FLAT, None).expect("a pose");
        let (relative, deviation) = found.measurement();
        let errors = [
            relative.distance - truth.distance,
            wrap(relative.bearing - truth.bearing),
            wrap(relative.view_angle - truth.view_angle),
        ];
        for k in 0..3 {
            squares[k] += errors[k] * errors[k] / n;
            said[k] += deviation[k] * deviation[k] / n;
        }
    }
    for k in 0..3 {
        assert!((0.85..1.2).contains(&(squares[k] / said[k])), "{k}: {}", squares[k] / said[k]);
    }
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -1e3..1e3_f64, 1 => any::<f64>(), 1 => Just(0.0)]
}

proptest! {
    #[test]
    fn nothing_makes_it_panic(
        numbers in prop::collection::vec(any_number(), 48),
        faces in prop::collection::vec(0_usize..7, 0..5),
        distortion in prop::array::uniform5(any_number()),
        distorts: bool,
    ) {
        let camera_model = if distorts { CameraModel { distortion, ..CameraModel::default() } } else { CameraModel::default() };
        let body_from_camera = vocabulary::CameraMount { forward: 0.1, height: 0.3 }.body_from_camera(numbers[46]);
        let rig = Rig { shell: Shell::PAPER, camera_model, body_from_camera };
        let seen: Vec<_> = faces.iter().enumerate().map(|(k, face)| SeenFace {
            face: *face,
            corners: [0, 1, 2, 3].map(|c| [numbers[8 * k + 2 * c], numbers[8 * k + 2 * c + 1]]), deviation: numbers[47],
        }).collect();
        let prior = Prior { tilt: numbers[44], height: numbers[45] };
        for prior in [prior, FLAT] {
            for near in [None, Some(Pose::new(numbers[40], numbers[41], numbers[42]))] {
                if let Some(found) = locate(&rig, &seen, numbers[43].abs(), &prior, near) {
                    prop_assert!(found.pose.x.is_finite() && found.measurement().1.iter().all(|d| d.is_finite()));
                }
            }
        }
    }
}
