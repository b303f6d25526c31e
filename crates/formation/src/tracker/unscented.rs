//! A dual unscented Kalman filter after the same authors' paper of 2007 (Orqueda, Fierro: *Visual tracking of mobile
//! robots in formation*, ACC): one filter for the relative position, one for what it depends on and nobody tells, the
//! leader's speed and turn rate.

use super::{Own, TrackerParameters, innovation};
use crate::observer::Estimate;
use crate::relative::Geometry;
use nalgebra::{Cholesky, Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3};
use vocabulary::{Measurement, Relative};

/// State of both filters.
#[derive(Debug, Clone, PartialEq)]
pub struct Unscented {
    /// ℓ, ψ, γ; angles run on.
    position: Vector3<f64>,
    position_covariance: Matrix3<f64>,
    /// The leader's speed, m/s, and turn rate, rad/s.
    motion: Vector2<f64>,
    motion_covariance: Matrix2<f64>,
    /// What position and covariance were at the last measurement, and what the follower did since.
    before: Vector3<f64>,
    since: Vec<(Own, f64)>,
}

/// How fast the model drifts off the truth, [m², rad², rad²] per s.
const DRIFT: [f64; 3] = [1e-5, 1e-5, 1e-5];
/// Spread of the sigma points: Julier's κ such that N + κ = 3.
const SPREAD: f64 = 3.0;
/// What the leader's motion may be at first, [m/s, rad/s].
const AT_FIRST: [f64; 2] = [1.0, 0.5];

impl Unscented {
    /// Begins at a measurement; the leader is taken to be as fast as its follower and to drive straight on.
    pub(super) fn at(measurement: &Measurement, own_speed: f64) -> Self {
        let Relative { distance, bearing, view_angle } = measurement.relative;
        let position = Vector3::new(distance, bearing, view_angle);
        let variance = Vector3::from(measurement.deviation.map(|d| d * d + 1e-12));
        Self {
            position,
            position_covariance: Matrix3::from_diagonal(&variance),
            motion: Vector2::new(own_speed, 0.0),
            motion_covariance: Matrix2::from_diagonal(&Vector2::from(AT_FIRST.map(|x| x * x))),
            before: position,
            since: Vec::new(),
        }
    }

    /// Where the follower is relative to its leader; angles run on.
    pub fn relative(&self) -> Relative {
        relative(&self.position)
    }

    /// ŝ, its rates those of eqs 6-7 with the leader's motion as estimated.
    pub(super) fn estimate(&self, law: &TrackerParameters, own_speed: f64) -> Estimate {
        let geometry = Geometry::new(&self.relative(), law.observer.distance_min);
        let rates = geometry.rates(own_speed, self.motion.x, self.motion.y);
        Estimate { output: [self.position.x, self.position.y], rates: rates.into() }
    }

    /// rad/s.
    pub(super) fn leader_turn_rate(&self) -> f64 {
        self.motion.y
    }

    pub(super) fn is_sound(&self) -> bool {
        let finite = self.motion.iter().chain(self.position_covariance.iter()).all(|x| x.is_finite());
        finite && self.motion_covariance.iter().all(|x| x.is_finite())
    }

    pub(super) fn predict(&mut self, law: &TrackerParameters, own: Own, duration: f64) {
        let motion = self.motion;
        let carried = |x: &Vector3<f64>| drive(x, &motion, own, duration, law.observer.distance_min);
        let (mean, covariance, _) = through(&self.position, &self.position_covariance, carried);
        self.position = mean;
        self.position_covariance = covariance + Matrix3::from_diagonal(&Vector3::from(DRIFT)) * duration;
        self.since.push((own, duration));
        // A leader that changes its speed by δ within a second, at random.
        let walk = [law.disturbance[0], law.disturbance[1]].map(|d| d * d * law.interval);
        self.motion_covariance += Matrix2::from_diagonal(&Vector2::from(walk)) * duration;
    }

    pub(super) fn surprise(&self, measurement: &Measurement) -> f64 {
        let off = Vector3::from(innovation(&measurement.relative, &self.relative()));
        let motion = self.motion_covariance.diagonal();
        let age: f64 = self.since.iter().map(|(_, duration)| duration).sum();
        let unknown = Vector3::new(motion.x, motion.y + motion.x, motion.x) * (age * age);
        let variance = self.position_covariance.diagonal() + noise(measurement).diagonal() + unknown;
        (0..3).map(|k| off[k].abs() / variance[k].max(1e-24).sqrt()).fold(0.0, f64::max)
    }

    pub(super) fn correct(&mut self, law: &TrackerParameters, measurement: &Measurement) {
        let noise = noise(measurement);
        let (before, since) = (self.before, std::mem::take(&mut self.since));
        let replay = |motion: &Vector2<f64>| {
            let step = |x: Vector3<f64>, (own, duration): &(Own, f64)| {
                drive(&x, motion, *own, *duration, law.observer.distance_min)
            };
            since.iter().fold(before, step)
        };
        let (expected, covariance, cross) = through(&self.motion, &self.motion_covariance, replay);
        let off = Vector3::from(innovation(&measurement.relative, &relative(&expected)));
        if let Some(inverse) = (covariance + noise + self.position_covariance).try_inverse() {
            let gain = cross * inverse;
            self.motion += gain * off;
            self.motion_covariance -= gain * cross.transpose();
            self.motion_covariance = sound(self.motion_covariance);
        }
        let off = Vector3::from(innovation(&measurement.relative, &self.relative()));
        // What the motion filter did not know of the leader is uncertain in the position too.
        let prior = self.position_covariance + covariance;
        if let Some(inverse) = (prior + noise).try_inverse() {
            let gain = prior * inverse;
            self.position += gain * off;
            self.position_covariance = sound(prior - gain * prior);
        }
        self.before = self.position;
    }
}

fn relative(position: &Vector3<f64>) -> Relative {
    Relative { distance: position.x, bearing: position.y, view_angle: position.z }
}

fn noise(measurement: &Measurement) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::from(measurement.deviation.map(|d| d * d + 1e-12)))
}

/// Symmetric, and positive on its diagonal.
fn sound<const N: usize>(matrix: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let mut even = (matrix + matrix.transpose()) * 0.5;
    for k in 0..N {
        even[(k, k)] = even[(k, k)].max(1e-12);
    }
    even
}

/// The relative position `duration` s later with a leader that keeps its speed and turn rate (eqs 6-7), by midpoints.
fn drive(
    x: &Vector3<f64>,
    motion: &Vector2<f64>,
    own: Own,
    duration: f64,
    distance_min: f64,
) -> Vector3<f64> {
    let slope = |x: &Vector3<f64>, speed: f64| {
        let geometry = Geometry::new(&relative(x), distance_min);
        let rates = geometry.rates(speed, motion.x, motion.y);
        Vector3::new(rates.x, rates.y, rates.y + motion.y - own.turn_rate)
    };
    let half = x + slope(x, own.speed) * (0.5 * duration);
    x + slope(&half, own.speed + 0.5 * own.acceleration * duration) * duration
}

/// Mean and covariance of a function's value, and its covariance with the argument, by the unscented transform.
fn through<const N: usize>(
    mean: &SVector<f64, N>,
    covariance: &SMatrix<f64, N, N>,
    function: impl Fn(&SVector<f64, N>) -> Vector3<f64>,
) -> (Vector3<f64>, Matrix3<f64>, SMatrix<f64, N, 3>) {
    let root = Cholesky::new(sound(*covariance) * SPREAD).map_or_else(SMatrix::zeros, |c| c.l());
    let centre = function(mean);
    let weight = 0.5 / SPREAD;
    let middle = 1.0 - N as f64 / SPREAD;
    let mut points = Vec::with_capacity(2 * N);
    for k in 0..N {
        for sign in [1.0, -1.0] {
            let off = root.column(k) * sign;
            points.push((off, function(&(mean + off))));
        }
    }
    let out = points.iter().fold(centre * middle, |sum, (_, value)| sum + value * weight);
    let away = centre - out;
    let mut spread = away * away.transpose() * middle.max(0.0);
    let mut cross = SMatrix::<f64, N, 3>::zeros();
    for (off, value) in &points {
        let away = value - out;
        spread += away * away.transpose() * weight;
        cross += off * away.transpose() * weight;
    }
    (out, spread, cross)
}
