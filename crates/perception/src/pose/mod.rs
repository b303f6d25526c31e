//! From the corners of tags to where the leader is.
//!
//! [`posit`] and [`coplanar_posit`] find a pose without being told where to look; [`locate`] goes on from there to the
//! one on the ground that fits best, says how sure it is, and whether another pose would explain the picture too.

mod coplanar;
mod posit;
mod refine;
#[cfg(test)]
mod tests;

pub(crate) use coplanar::homography;
pub use coplanar::{coplanar_posit, misfit, square_poses};
pub use posit::{Match, posit};

use nalgebra::{Matrix3, Vector3};
use refine::{Corner, Minimum, Problem};
use vocabulary::{CameraModel, FACE_DIRECTIONS, FACES, Pose, Relative, Rigid, Shell, math, wrap};

/// Poses whose headings differ by less, rad, are not told apart: their difference goes into the covariance.
const ALIKE: f64 = 4.0 * std::f64::consts::PI / 180.0;

/// A rival has to fit worse by this factor in the sum of squares, or it may be the truth as well.
const WORSE: f64 = 2.0;

/// And by this much, in squares of standard deviations: the likelihoods are then 1 to 900.
const WORSE_BY: f64 = 13.6;

/// Corners that are off by more than this share of a tag's side are not those of this shell.
const ABSURD: f64 = 0.1;

/// Headings that a single face is tried at, rad from facing the camera: one of them leads into every minimum.
const FAN: [f64; 7] = [0.0, 0.4, -0.4, 0.8, -0.8, 1.1, -1.1];

/// What is known before a picture is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rig {
    /// The leader's shell.
    pub shell: Shell,
    /// The follower's lens.
    pub camera_model: CameraModel,
    /// The follower's camera (x right, y down, z ahead) in its body, pan included.
    pub body_from_camera: Rigid,
}

/// How far leader and follower may be from standing on one plane: standard deviations.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Prior {
    /// Of roll and pitch of the one in the frame of the other, rad; 0 on flat ground.
    pub tilt: f64,
    /// Of the height of the one over the other, m, besides what tilt and distance make of it; 0 on flat ground.
    pub height: f64,
}

/// A face of the leader's shell as found in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenFace {
    /// Which one.
    pub face: usize,
    /// Pixels of the whole picture, in the order of `Shell::tag_corners`.
    pub corners: [[f64; 2]; 4],
    /// Standard deviation of a corner in one direction, pixels, where whoever measured it knows; otherwise 0.
    pub deviation: f64,
}

/// Where the leader is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseEstimate {
    /// The leader's body in the follower's: m ahead, m to the left, rad.
    pub pose: Pose,
    /// Of x, y and heading, [m, m, rad]: (JᵀJ)⁻¹ at the pose, the Cramér-Rao bound for the given error of corners.
    pub covariance: [[f64; 3]; 3],
    /// Root of the mean square distance between corners seen and corners explained, pixels.
    pub residual: f64,
    /// Whether `other` explains the picture about as well.
    pub ambiguous: bool,
    /// The best pose that is clearly another one, and its residual in pixels.
    pub other: Option<(Pose, f64)>,
    /// What POSIT alone makes of the corners: the homogeneous form for several faces, the coplanar one for a single face.
    pub raw: Option<Pose>,
}

impl PoseEstimate {
    /// Distance, bearing and view angle, with the standard deviations [m, rad, rad] that the covariance gives them.
    pub fn measurement(&self) -> (Relative, [f64; 3]) {
        let relative = Relative::between(self.pose, Pose::default());
        let square = math::powi(relative.distance, 2).max(1e-12);
        let (x, y) = (self.pose.x, self.pose.y);
        let along = Vector3::new(x, y, 0.0) / square.sqrt();
        // The view angle turns with the direction of the leader; the bearing also against its heading.
        let across = Vector3::new(-y, x, 0.0) / square;
        let covariance = Matrix3::from_fn(|r, c| self.covariance[r][c]);
        let deviation = [along, across - Vector3::z(), across]
            .map(|g| (g.transpose() * covariance * g)[(0, 0)].max(0.0).sqrt());
        (relative, deviation)
    }
}

/// The leader's pose from the faces seen of it. Corners have errors of `pixel_sigma` pixels (standard deviation, each
/// direction) and independently of that those of their face's `deviation`. `near` is one more place to start from; where two poses are ambiguous the one with the nearer
/// heading is given as `pose`, and the caller decides what to make of it.
///
/// Two poses are ambiguous unless the sum of squared residuals (in standard deviations, prior included) of the worse is
/// over twice that of the better and 13.6 more.
///
/// `None` if there is no face, if numbers are no numbers, or if no pose in front of the camera explains the corners.
pub fn locate(
    rig: &Rig,
    faces: &[SeenFace],
    pixel_sigma: f64,
    prior: &Prior,
    near: Option<Pose>,
) -> Option<PoseEstimate> {
    let valid = pixel_sigma.is_finite() && pixel_sigma > 0.0 && rig.camera_model.focal > 0.0;
    let prior_valid = [prior.tilt, prior.height].iter().all(|s| s.is_finite() && *s >= 0.0);
    if !(valid && prior_valid) || faces.is_empty() || faces.iter().any(|seen| seen.face >= FACES) {
        return None;
    }
    let mut corners = Vec::with_capacity(4 * faces.len());
    let mut matches = Vec::with_capacity(4 * faces.len());
    for seen in faces {
        let sigma = math::hypot(pixel_sigma, seen.deviation);
        for (point, pixel) in rig.shell.tag_corners(seen.face).into_iter().zip(seen.corners) {
            corners.push(Corner::new(&rig.camera_model, point, pixel, sigma)?);
            matches.push(Match { point, seen: rig.camera_model.direction(pixel) });
        }
    }
    let raw = if faces.len() > 1 { posit(&matches) } else { None };
    let raw = raw.or_else(|| coplanar_posit(&matches).into_iter().next());
    let raw = raw.and_then(|camera_from_leader| flat(&rig.body_from_camera.after(&camera_from_leader)));

    let camera_from_body = rig.body_from_camera.inverse();
    let problem = Problem { camera_from_body, corners: &corners, prior: *prior };
    let mut minima: Vec<Minimum> = vec![];
    for start in starts(rig, faces, &matches, raw, near) {
        let Some(found) = problem.minimum(start) else { continue };
        let known = minima.iter().any(|m| apart(&m.pose, &found.pose) < 1e-5);
        if !known && faces.iter().all(|seen| faces_camera(rig, &found.body, seen.face)) {
            minima.push(found);
        }
    }
    minima.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    judge(rig, faces, &matches, &minima, near, raw)
}

/// Picks the best of the minima and says what there is to say about the rest.
fn judge(
    rig: &Rig,
    faces: &[SeenFace],
    matches: &[Match],
    minima: &[Minimum],
    near: Option<Pose>,
    raw: Option<Pose>,
) -> Option<PoseEstimate> {
    let camera_from_body = rig.body_from_camera.inverse();
    let residual = |m: &Minimum| misfit(&camera_from_body.after(&m.body), matches) * rig.camera_model.focal;
    let mut best = minima.first()?;
    let side = faces.iter().map(|seen| longest_side(&seen.corners)).fold(0.0, f64::max);
    let explained = residual(best) < ABSURD * side;
    if !explained {
        return None;
    }
    let turned = |m: &Minimum, from: &Minimum| wrap(m.pose.heading - from.pose.heading).abs();
    let mut rival = minima.iter().find(|m| turned(m, best) > ALIKE || apart(&m.pose, &best.pose) > 0.5);
    let ambiguous = rival.is_some_and(|r| r.cost < WORSE * best.cost || r.cost - best.cost < WORSE_BY);
    if let (true, Some(other), Some(near)) = (ambiguous, rival, near) {
        let from_near = |m: &Minimum| wrap(m.pose.heading - near.heading).abs();
        if from_near(other) < from_near(best) {
            (best, rival) = (other, Some(best));
        }
    }
    let mut covariance = best.covariance;
    for twin in minima.iter().filter(|m| turned(m, best) <= ALIKE && apart(&m.pose, &best.pose) > 1e-5) {
        // Half-way between two minima so close together it is as likely as in either.
        let share = 1.0 / (1.0 + math::exp((0.5 * (twin.cost - best.cost)).clamp(-50.0, 50.0)));
        let (a, b) = (twin.pose, best.pose);
        let off = Vector3::new(a.x - b.x, a.y - b.y, wrap(a.heading - b.heading));
        covariance += off * off.transpose() * share;
    }
    Some(PoseEstimate {
        pose: best.pose,
        covariance: [0, 1, 2].map(|r| [0, 1, 2].map(|c| covariance[(r, c)])),
        residual: residual(best),
        ambiguous,
        other: rival.map(|m| (m.pose, residual(m))),
        raw,
    })
}

/// Where to start from: POSIT's pose, what is expected, both poses of the face that looks largest, and for a single face a fan of
/// headings.
fn starts(
    rig: &Rig,
    faces: &[SeenFace],
    matches: &[Match],
    raw: Option<Pose>,
    near: Option<Pose>,
) -> Vec<Pose> {
    let finite = |p: &Pose| p.x.is_finite() && p.y.is_finite() && p.heading.is_finite();
    let mut starts: Vec<Pose> = raw.into_iter().chain(near).filter(finite).collect();
    let sizes = faces.iter().map(|seen| area(&seen.corners));
    let Some((index, _)) = sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) else { return starts };
    let (Some(seen), Some(matches)) = (faces.get(index), matches.get(4 * index..4 * index + 4)) else {
        return starts;
    };
    let directions = [0, 1, 2, 3].map(|k| matches[k].seen);
    let body_from_tag = rig.shell.body_from_face(seen.face);
    for camera_from_tag in square_poses(rig.shell.half_tag(), &directions) {
        let tag = rig.body_from_camera.after(&camera_from_tag);
        starts.extend(flat(&tag.after(&body_from_tag.inverse())).filter(finite));
        // With the tag where it is and its heading in doubt, the body swings around it.
        let [x, y, _] = tag.translation;
        let camera = rig.body_from_camera.translation;
        let at = |turn: f64| {
            let outward = math::atan2(camera[1] - y, camera[0] - x) + turn;
            let heading = wrap(outward - FACE_DIRECTIONS[seen.face % FACES]);
            let [forward, left, _] = body_from_tag.translation;
            let [dx, dy] = Pose::new(0.0, 0.0, heading).world_from_body(forward, left);
            Pose::new(x - dx, y - dy, heading)
        };
        let single = faces.len() == 1;
        starts.extend(FAN.into_iter().filter(|_| single).map(at).filter(finite));
    }
    starts
}

/// Whether a face's outside is turned towards the camera.
fn faces_camera(rig: &Rig, leader: &Rigid, face: usize) -> bool {
    let tag = leader.after(&rig.shell.body_from_face(face));
    let (out, camera) = (tag.turn([0.0, 0.0, 1.0]), rig.body_from_camera.translation);
    (0..3).map(|k| out[k] * (camera[k] - tag.translation[k])).sum::<f64>() > 0.0
}

/// The pose on the ground of a body that may be tilted.
fn flat(body: &Rigid) -> Option<Pose> {
    let pose = Pose::new(
        body.translation[0],
        body.translation[1],
        math::atan2(body.rotation[1][0], body.rotation[0][0]),
    );
    (pose.x.is_finite() && pose.y.is_finite() && pose.heading.is_finite()).then_some(pose)
}

/// A measure of how far two poses are apart, m and rad alike.
fn apart(a: &Pose, b: &Pose) -> f64 {
    math::hypot(a.x - b.x, a.y - b.y).max(wrap(a.heading - b.heading).abs())
}

/// Twice the area of a quadrilateral, positive for corners in the order of a tag's; square pixels.
pub(crate) fn area(corners: &[[f64; 2]; 4]) -> f64 {
    let [a, b, c, d] = corners;
    (c[0] - a[0]) * (d[1] - b[1]) - (d[0] - b[0]) * (c[1] - a[1])
}

fn longest_side(corners: &[[f64; 2]; 4]) -> f64 {
    (0..4)
        .map(|k| {
            let ([a, b], [c, d]) = (corners[k], corners[(k + 1) % 4]);
            math::hypot(a - c, b - d)
        })
        .fold(0.0, f64::max)
}
