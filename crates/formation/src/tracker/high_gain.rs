//! The high-gain observer on measurements: eqs 31-32 without innovation between measurements, a discrete correction at
//! each.

use super::{Own, TrackerParameters, innovation};
use crate::observer::{Estimate, Observer, input_effect};
use crate::relative::{Geometry, LineOfSight};
use vocabulary::{EdgeSample, Measurement, MotionInput, Relative, math};

/// ŝ1 and ŝ2, and the view angle, which no law controls but all of them use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HighGain {
    pub(super) estimate: Estimate,
    /// γ, rad.
    view_angle: f64,
    /// How fast the line to the leader turns in the world, rad/s; dγ/dt is that less the follower's turn rate.
    line_rate: f64,
    /// Variances of the measurements, smoothed.
    variance: [f64; 3],
}

/// Share of a measurement's own variance in the smoothed one.
const SMOOTHING: f64 = 0.2;
/// ε that follows from noise stays above this share of the time between measurements, and below this time, s.
const EPSILON: [f64; 2] = [0.25, 0.3];
/// How much stronger than δ a leader's sudden moves are.
const SUDDEN: f64 = 8.0;
/// Longest step of the prediction, s.
const STEP: f64 = 0.02;

/// State of the prediction: ℓ, ψ, their rates, γ and the rate of the line.
type State = [f64; 6];

impl HighGain {
    /// Begins at a measurement with rates of zero.
    pub(super) fn at(measurement: &Measurement) -> Self {
        Self {
            estimate: Estimate::at(&measurement.relative),
            view_angle: measurement.relative.view_angle,
            line_rate: 0.0,
            variance: measurement.deviation.map(|d| d * d),
        }
    }

    /// Where the follower is relative to its leader; angles run on.
    pub fn relative(&self) -> Relative {
        let [distance, bearing] = self.estimate.output;
        Relative { distance, bearing, view_angle: self.view_angle }
    }

    /// How fast the line to the leader turns in the world, rad/s.
    pub(super) fn line_rate(&self) -> f64 {
        self.line_rate
    }

    /// Carries on over `duration` s in midpoint steps. The line turns with the bearing but for the leader's own turn,
    /// so both have the same second derivative where that turn is steady. While measurements come in, what the leader
    /// does is the unknown that they make up for; when they stay out (`coasting`) it is taken to keep its speed and
    /// turn rate.
    pub(super) fn predict(&mut self, law: &TrackerParameters, own: Own, duration: f64, coasting: bool) {
        let steps = (duration / STEP).ceil().max(1.0);
        let h = duration / steps;
        for k in 0..steps as usize {
            let start = Own { speed: own.speed + own.acceleration * h * k as f64, ..own };
            let middle = Own { speed: start.speed + own.acceleration * 0.5 * h, ..own };
            let x = self.state();
            let slope = slope(&x, law.observer.distance_min, start, coasting);
            let half: State = std::array::from_fn(|i| x[i] + 0.5 * h * slope[i]);
            let again = self::slope(&half, law.observer.distance_min, middle, coasting);
            self.set(std::array::from_fn(|i| x[i] + h * again[i]));
        }
    }

    fn state(&self) -> State {
        let ([distance, bearing], [dd, db]) = (self.estimate.output, self.estimate.rates);
        [distance, bearing, dd, db, self.view_angle, self.line_rate]
    }

    /// Takes over a state; one that is not finite, where rates have run away, leaves the position and rates of zero.
    fn set(&mut self, state: State) {
        let [distance, bearing, dd, db, view_angle, line_rate] = state;
        if !state.iter().all(|x| x.is_finite()) {
            (self.estimate.rates, self.line_rate) = ([0.0; 2], 0.0);
            return;
        }
        self.estimate = Estimate { output: [distance, bearing], rates: [dd, db] };
        (self.view_angle, self.line_rate) = (view_angle, line_rate);
    }

    /// How far a measurement is from what was expected, in standard deviations: those of the measurement, of the
    /// estimate it meets, and what the leader may have done unseen in `age` s.
    pub(super) fn surprise(&self, law: &TrackerParameters, measurement: &Measurement, age: f64) -> f64 {
        let off = innovation(&measurement.relative, &self.relative());
        let unseen = |k: usize| {
            let delta = law.disturbance[k.min(1)];
            // Rates are known about as well as ε allows, and what is unknown acts for `age` more. A leader may do more
            // for a moment than it does as a rule.
            let reach = age + 2.0 * self.epsilon(law, k, age);
            0.5 * SUDDEN * delta * reach * reach
        };
        let share = |k: usize| {
            let variance =
                math::powi(measurement.deviation[k], 2) + self.variance[k] + math::powi(unseen(k), 2);
            off[k].abs() / variance.max(1e-24).sqrt()
        };
        (0..3).map(share).fold(0.0, f64::max)
    }

    /// Corrects each channel with L = [1 − p², (1 − p)²/Δt], p = e^(−Δt/ε), Δt the time since the last measurement. A
    /// measurement that is less certain than those before, such as the last one of a tag that slips behind a pillar,
    /// corrects less.
    pub(super) fn correct(&mut self, law: &TrackerParameters, measurement: &Measurement, age: f64) {
        let trust: [f64; 3] = std::array::from_fn(|k| {
            let ratio = math::powi(measurement.deviation[k], 2) / self.variance[k].max(1e-24);
            if ratio > 1.0 { 2.0 / (1.0 + ratio) } else { 1.0 }
        });
        for (variance, deviation) in self.variance.iter_mut().zip(measurement.deviation) {
            *variance += SMOOTHING * (deviation * deviation - *variance);
        }
        let off = innovation(&measurement.relative, &self.relative());
        for k in 0..2 {
            let [position, rate] = gain(&law.observer, k, self.epsilon(law, k, age), age);
            self.estimate.output[k] += trust[k] * position * off[k];
            self.estimate.rates[k] += trust[k] * rate * off[k];
        }
        let [position, rate] = gain(&law.observer, 1, self.epsilon(law, 2, age), age);
        self.view_angle += trust[2] * position * off[2];
        self.line_rate += trust[2] * rate * off[2];
        if !self.state().iter().all(|x| x.is_finite()) {
            *self = Self::at(measurement);
        }
    }

    /// ε of a channel, s: as given, or the one at which what noise and disturbance do to the rates is least in sum, ε⁵
    /// = 3σ²T/(32 δ²).
    fn epsilon(&self, law: &TrackerParameters, channel: usize, age: f64) -> f64 {
        if !law.adaptive {
            return law.observer.epsilon[channel.min(1)];
        }
        let delta = law.disturbance[channel.min(1)];
        let interval = law.interval;
        let best = math::powf(3.0 * self.variance[channel] * interval / (32.0 * delta * delta), 0.2);
        best.clamp(EPSILON[0] * interval.min(age), EPSILON[1])
    }
}

/// Gains on position [1] and rate [1/s] after `age` s without a measurement: the poles of s² + α1 s + α2 at ε, taken
/// through e^(s Δt).
fn gain(observer: &Observer, channel: usize, epsilon: f64, age: f64) -> [f64; 2] {
    let (a1, a2) = (observer.alpha1[channel], observer.alpha2[channel]);
    let reach = age / epsilon;
    let product = math::exp(-a1 * reach);
    let root = 0.25 * a1 * a1 - a2;
    let decay = math::exp(-0.5 * a1 * reach);
    let sum = if root >= 0.0 {
        let r = root.sqrt() * reach;
        // Two decaying exponentials, written so that neither overflows.
        math::exp(r - 0.5 * a1 * reach) + math::exp(-r - 0.5 * a1 * reach)
    } else {
        2.0 * decay * math::cos((-root).sqrt() * reach)
    };
    [1.0 - product, (1.0 - sum + product) / age]
}

fn slope(x: &State, distance_min: f64, own: Own, coasting: bool) -> State {
    let [distance, bearing, dd, db, view_angle, line_rate] = *x;
    let relative = Relative { distance, bearing, view_angle };
    let geometry = Geometry::new(&relative, distance_min);
    let sample = EdgeSample {
        relative,
        own_speed: own.speed,
        acceleration: own.acceleration,
        turn_rate: own.turn_rate,
    };
    let mut second = input_effect(&geometry.line, &sample) - geometry.line.rate_column(own.speed) * dd;
    if coasting {
        second -= geometry.leader_effect(own.speed, &leader(&geometry, x, own));
    }
    [dd, db, second.x, second.y, line_rate - own.turn_rate, second.y]
}

/// What the leader does by the rates that are believed: eqs 6-7 solved for its speed, along its heading, and its turn
/// rate.
fn leader(geometry: &Geometry, &[_, _, dd, db, _, line_rate]: &State, own: Own) -> MotionInput {
    let LineOfSight { distance, sin_view, cos_view } = geometry.line;
    let along = own.speed * cos_view - dd;
    let across = line_rate * distance + own.speed * sin_view;
    MotionInput {
        speed: geometry.cos_bearing * along + geometry.sin_bearing * across,
        turn_rate: line_rate - db,
        ..MotionInput::default()
    }
}
