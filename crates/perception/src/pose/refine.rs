//! The pose on the ground that fits tag corners best: Gauss-Newton steps, damped where they overshoot (Levenberg and
//! Marquardt), and the covariance of the result.
//!
//! Unknown are x, y and θ of the leader's body in the follower's, and how far the two are from standing on one plane:
//! height, roll and pitch of the one in the frame of the other, of which only a spread around zero is known. Those
//! three are counted in units of their spread, so with spreads of zero they stay zero and x, y, θ are all there is.

use super::Prior;
use nalgebra::{Matrix2, Matrix3, Matrix6, Rotation3, Vector2, Vector3, Vector6};
use vocabulary::{CameraModel, Pose, Rigid, math, wrap};

/// A corner further off than this, in standard deviations, counts by its distance and no longer by its square (Huber):
/// one bad corner pulls no harder than three good ones. One good corner in 90 is that far off.
const FAR: f64 = 3.0;

const ROUNDS: usize = 40;
/// A step this small, in m, rad and spreads, is the last: each is a small part of the one before, and the best corners tell
/// tenths of a millimetre.
const SMALLEST_STEP: f64 = 1e-9;

/// A corner of a tag as it was seen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    /// m, leader's body frame.
    point: Vector3<f64>,
    /// Direction it is seen in, the lens undone.
    seen: Vector2<f64>,
    /// Turns a small change of direction into standard deviations of what was seen.
    metric: Matrix2<f64>,
}

impl Corner {
    /// A corner seen at `pixel` with an error of `sigma` pixels in each direction; `None` if the lens cannot be undone.
    pub(super) fn new(
        camera_model: &CameraModel,
        point: [f64; 3],
        pixel: [f64; 2],
        sigma: f64,
    ) -> Option<Self> {
        let seen = camera_model.direction(pixel);
        let [[a, b], [c, d]] = camera_model.slope(seen);
        let metric = Matrix2::new(a, b, c, d) * (camera_model.focal / sigma);
        let finite = seen.iter().chain(metric.iter()).all(|x| x.is_finite());
        // Beyond where the mapping folds over a direction has nothing to do with the pixel.
        let back = camera_model.project([seen[0], seen[1], 1.0])?;
        let there = (0..2).all(|k| (back[k] - pixel[k]).abs() < 1e-3);
        (finite && there).then(|| Self { point: point.into(), seen: seen.into(), metric })
    }
}

/// What is to be explained.
pub(super) struct Problem<'a> {
    pub(super) camera_from_body: Rigid,
    pub(super) corners: &'a [Corner],
    pub(super) prior: Prior,
}

/// A pose that nothing near it betters.
#[derive(Debug, Clone, Copy)]
pub(super) struct Minimum {
    pub(super) pose: Pose,
    /// Leader's body in the follower's, with height and tilt.
    pub(super) body: Rigid,
    /// What is left, corners and prior, in squares of standard deviations.
    pub(super) cost: f64,
    /// Of x, y, θ.
    pub(super) covariance: Matrix3<f64>,
}

/// Cost at a place, its curvature and its slope there.
struct Local {
    cost: f64,
    curvature: Matrix6<f64>,
    slope: Vector6<f64>,
    /// How far off the worst corner is, in standard deviations.
    farthest: f64,
}

impl Problem<'_> {
    /// Goes down from `start` to the next minimum; `None` where that leads behind the camera or nowhere.
    pub(super) fn minimum(&self, start: Pose) -> Option<Minimum> {
        let distance = math::hypot(start.x, start.y);
        // A follower that pitches sees its leader higher or lower by its distance times the angle.
        let height = math::hypot(self.prior.height, distance * self.prior.tilt);
        let scale = Vector6::new(1.0, 1.0, 1.0, height, self.prior.tilt, self.prior.tilt);
        let mut at = Vector6::new(start.x, start.y, start.heading, 0.0, 0.0, 0.0);
        // Far from the minimum every corner is far off; squares get there in fewer steps.
        let mut local = self.descend(&mut at, &scale, f64::INFINITY)?;
        if local.farthest > FAR {
            local = self.descend(&mut at, &scale, FAR)?;
        }
        let covariance: Matrix3<f64> = local.curvature.try_inverse()?.fixed_view::<3, 3>(0, 0).into_owned();
        let body = body(&at, &scale);
        let finite = at.iter().chain(covariance.iter()).all(|x| x.is_finite()) && local.cost.is_finite();
        let pose = Pose::new(at[0], at[1], wrap(at[2]));
        finite.then_some(Minimum { pose, body, cost: local.cost, covariance })
    }

    fn descend(&self, at: &mut Vector6<f64>, scale: &Vector6<f64>, far: f64) -> Option<Local> {
        let mut here = self.local(at, scale, far)?;
        let mut damping = 0.0_f64;
        for _ in 0..ROUNDS {
            let mut damped = here.curvature;
            for k in 0..6 {
                damped[(k, k)] *= 1.0 + damping;
            }
            let step = -(damped.cholesky()?.solve(&here.slope));
            let next = *at + step;
            match self.local(&next, scale, far) {
                // Equal up to rounding is as low as it gets.
                Some(there) if there.cost <= here.cost * (1.0 + 1e-12) => {
                    *at = next;
                    here = there;
                    // The first three are in m and rad, the others in their spreads. Damped steps are small anyway.
                    if damping < 1e-3 && step.amax() < SMALLEST_STEP {
                        break;
                    }
                    damping = if damping < 1e-6 { 0.0 } else { damping * 0.1 };
                }
                _ => damping = if damping == 0.0 { 1e-4 } else { damping * 10.0 },
            }
            if damping > 1e8 {
                break;
            }
        }
        Some(here)
    }

    /// `None` where a corner is not in front of the camera.
    fn local(&self, at: &Vector6<f64>, scale: &Vector6<f64>, far: f64) -> Option<Local> {
        let mut cost = at.fixed_rows::<3>(3).norm_squared();
        let mut curvature = Matrix6::from_diagonal(&Vector6::new(0.0, 0.0, 0.0, 1.0, 1.0, 1.0));
        let mut slope = Vector6::new(0.0, 0.0, 0.0, at[3], at[4], at[5]);
        let mut farthest = 0.0_f64;
        let turn = matrix(&self.camera_from_body);
        let shift = Vector3::from(self.camera_from_body.translation);
        let (roll, pitch) = (scale[4] * at[4], scale[5] * at[5]);
        let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), pitch)
            * Rotation3::from_axis_angle(&Vector3::x_axis(), roll);
        let heading = Rotation3::from_axis_angle(&Vector3::z_axis(), at[2]);
        let (heading, tilt) = (heading.into_inner(), tilt.into_inner());
        let (upright, height) = (heading * tilt, turn.column(2) * scale[3]);
        let place = Vector3::new(at[0], at[1], scale[3] * at[3]);
        for corner in self.corners {
            let tilted = tilt * corner.point;
            let turned = heading * tilted;
            let seen = turn * (turned + place) + shift;
            if seen.z.is_nan() || seen.z < 1e-3 {
                return None;
            }
            let direction = seen.xy() / seen.z;
            let off = corner.metric * (direction - corner.seen);
            // How far off it is where a point of the follower's camera moves.
            let view = |moved: Vector3<f64>| corner.metric * (moved.xy() - direction * moved.z) / seen.z;
            let columns = [
                view(turn.column(0).into_owned()),
                view(turn.column(1).into_owned()),
                view(turn * Vector3::new(-turned.y, turned.x, 0.0)),
                view(height),
                view(turn * (upright * Vector3::new(0.0, -corner.point.z, corner.point.y)) * scale[4]),
                view(turn * (heading * Vector3::new(tilted.z, 0.0, -tilted.x)) * scale[5]),
            ];
            let size = off.norm();
            farthest = farthest.max(size);
            let weight = if size > far { far / size } else { 1.0 };
            cost += if size > far { far * (2.0 * size - far) } else { size * size };
            for (row, column) in columns.iter().enumerate() {
                let column = column * weight;
                slope[row] += column.dot(&off);
                for (k, other) in columns[..=row].iter().enumerate() {
                    curvature[(row, k)] += column.dot(other);
                }
            }
        }
        curvature.fill_upper_triangle_with_lower_triangle();
        cost.is_finite().then_some(Local { cost, curvature, slope, farthest })
    }
}

/// The body's frame at scaled unknowns.
fn body(at: &Vector6<f64>, scale: &Vector6<f64>) -> Rigid {
    Rigid::turned([at[0], at[1], at[3] * scale[3]], at[2], at[5] * scale[5], at[4] * scale[4])
}

pub(super) fn matrix(frame: &Rigid) -> Matrix3<f64> {
    Matrix3::from_fn(|r, c| frame.rotation[r][c])
}
