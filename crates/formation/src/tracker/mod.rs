//! Estimates from measurements of the leader: one every few periods, late, noisy, sometimes missing or wrong.
//!
//! Between measurements an estimate is carried on by the equations of the observer, driven by what the follower itself
//! does.
//! A measurement is put in at the instant it was taken, and what the follower did since is played again on top of it,
//! so that latency costs nothing but that time's disturbance. [`high_gain`] is the observer of eqs 31-32 in discrete
//! form, [`unscented`] a dual unscented Kalman filter to compare it with.

pub mod high_gain;
pub mod unscented;

use crate::observer::{Estimate, Observer};
use crate::path_heading::Heading;
use high_gain::HighGain;
use std::collections::VecDeque;
use unscented::Unscented;
use vocabulary::{Measurement, ObserverKind, Outcome, Relative, TrackingState, wrap};

/// Parameters of an estimate from measurements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackerParameters {
    /// How measurements become an estimate.
    pub method: ObserverKind,
    /// ε, α and ℓ_min.
    pub observer: Observer,
    /// Whether ε follows from how certain the measurements are.
    pub adaptive: bool,
    /// δ, [m/s², rad/s²]: what the leader does to d²s/dt², unknown to the follower.
    pub disturbance: [f64; 2],
    /// Standard deviations beyond which a measurement is not believed.
    pub gate: f64,
    /// Time between measurements that is expected, s.
    pub interval: f64,
    /// Time without a measurement after which the leader is lost, s.
    pub hold: f64,
}

impl TrackerParameters {
    /// Whether a measurement of this age, s, should have been followed by another.
    fn coasts(&self, age: f64) -> bool {
        age > 1.5 * self.interval + SLACK
    }
}

/// Measurements may come this much later than they should, s: they wait for a control sample, and for their latency.
const SLACK: f64 = 0.03;

/// What the follower itself does over a stretch of time, as applied.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Own {
    /// At the start of the stretch, m/s.
    pub speed: f64,
    /// Constant over the stretch, m/s².
    pub acceleration: f64,
    /// Constant over the stretch, rad/s.
    pub turn_rate: f64,
}

/// A stretch of the follower's own past.
#[derive(Debug, Clone, Copy)]
struct OwnMotion {
    from: f64,
    until: f64,
    own: Own,
}

/// An estimate at an instant.
#[derive(Debug, Clone)]
enum EdgeEstimator {
    HighGain(HighGain),
    Unscented(Box<Unscented>),
}

/// The estimate of one edge from measurements.
#[derive(Debug, Clone, Default)]
pub struct Tracker {
    now: f64,
    past: VecDeque<OwnMotion>,
    /// What was believed right after the last measurement, at its instant.
    anchor: Option<(f64, EdgeEstimator)>,
    /// The same, carried on to now.
    current: Option<EdgeEstimator>,
    /// Measurements that were not believed, one after the other.
    rejected: u32,
}

/// The follower's past is kept for this long, s: no measurement is older.
const MEMORY: f64 = 4.0;
/// A measurement this far from the prediction this many times in a row is right, and the prediction wrong.
const STUBBORN: u32 = 3;

impl Tracker {
    /// Carries the estimate on over a period that has passed.
    pub fn advance(&mut self, law: &TrackerParameters, own: Own, period: f64) {
        let stretch = OwnMotion { from: self.now, until: self.now + period, own };
        let coasting = law.coasts(self.age());
        if let Some(belief) = &mut self.current {
            belief.predict(law, own, [0.0, period], coasting);
        }
        self.past.push_back(stretch);
        self.now += period;
        while self.past.front().is_some_and(|oldest| oldest.until < self.now - MEMORY) {
            self.past.pop_front();
        }
    }

    /// Puts in a measurement that has arrived; what came of it.
    pub fn take(&mut self, law: &TrackerParameters, measurement: &Measurement) -> Outcome {
        let finite = measurement.relative.coordinates().iter().all(|x| x.is_finite());
        if !finite || measurement.stamp < self.now - MEMORY {
            return Outcome::Rejected;
        }
        let Some((time, belief)) = self.anchor.take() else {
            return self.restart(law, measurement);
        };
        // Measurements come in the order of their stamps; one out of order adds nothing.
        if measurement.stamp < time {
            self.anchor = Some((time, belief));
            return Outcome::Rejected;
        }
        if !belief.is_of(law.method) {
            // The method has changed since: it begins anew.
            return self.restart(law, measurement);
        }
        let mut at_measurement = belief.clone();
        self.replay(law, &mut at_measurement, time, measurement.stamp);
        let age = (measurement.stamp - time).max(1e-6);
        if at_measurement.surprise(law, measurement, age) > law.gate {
            self.rejected += 1;
            if self.rejected < STUBBORN {
                self.anchor = Some((time, belief));
                return Outcome::Rejected;
            }
            return self.restart(law, measurement);
        }
        self.rejected = 0;
        at_measurement.correct(law, measurement, age);
        if !at_measurement.is_finite() {
            return self.restart(law, measurement);
        }
        self.settle(law, measurement.stamp, at_measurement);
        Outcome::Used
    }

    /// Begins anew at a measurement, which is used so; rates are zero.
    fn restart(&mut self, law: &TrackerParameters, measurement: &Measurement) -> Outcome {
        self.rejected = 0;
        let own = self.past.iter().find(|s| measurement.stamp <= s.until).or(self.past.back());
        let speed = own.map_or(0.0, |s| s.own.speed);
        let belief = match law.method {
            ObserverKind::HighGain => EdgeEstimator::HighGain(HighGain::at(measurement)),
            ObserverKind::Unscented => EdgeEstimator::Unscented(Box::new(Unscented::at(measurement, speed))),
        };
        self.settle(law, measurement.stamp, belief);
        Outcome::Used
    }

    /// What is believed at `stamp` becomes the anchor, and is carried on to now.
    fn settle(&mut self, law: &TrackerParameters, stamp: f64, belief: EdgeEstimator) {
        let mut current = belief.clone();
        self.replay(law, &mut current, stamp, self.now);
        self.anchor = Some((stamp, belief));
        self.current = Some(current);
    }

    /// Carries `belief` from one instant to another by what the follower did.
    fn replay(&self, law: &TrackerParameters, belief: &mut EdgeEstimator, from: f64, until: f64) {
        for stretch in self.past.iter().filter(|s| s.until > from && s.from < until) {
            let (start, end) = (from.max(stretch.from), until.min(stretch.until));
            let coasting = law.coasts(stretch.from - from);
            belief.predict(law, stretch.own, [start - stretch.from, end - start], coasting);
        }
    }

    /// Begins anew with the next measurement: it will be of another leader. The follower's own past stays.
    pub fn change_leader(&mut self) {
        (self.anchor, self.current, self.rejected) = (None, None, 0);
    }

    /// Adds to the estimate as it stands, [m, rad].
    pub fn disturb(&mut self, output: [f64; 2]) {
        let beliefs = self.anchor.iter_mut().map(|(_, belief)| belief).chain(&mut self.current);
        for belief in beliefs {
            if let EdgeEstimator::HighGain(belief) = belief {
                belief.estimate.output[0] += output[0];
                belief.estimate.output[1] += output[1];
            }
        }
    }

    /// Where the follower is believed to be relative to its leader now; `None` before the first measurement.
    pub fn relative(&self) -> Option<Relative> {
        let Relative { distance, bearing, view_angle } = self.current.as_ref()?.relative();
        Some(Relative { distance, bearing: wrap(bearing), view_angle: wrap(view_angle) })
    }

    /// ŝ now; at rest and where it is before the first measurement.
    pub fn estimate(&self, law: &TrackerParameters) -> Estimate {
        self.current.as_ref().map_or_else(Estimate::default, |belief| belief.estimate(law, self.own_speed()))
    }

    /// ŝ as a law takes it that holds its bearing against `heading`: against a path's, with the direction φ of the line and
    /// its rate in place of the bearing's, where the follower heads for `own_heading` rad.
    pub fn output(&self, law: &TrackerParameters, heading: &Heading, own_heading: f64) -> Estimate {
        let mut estimate = self.estimate(law);
        if let (Some(_), Some(belief)) = (heading.filter(), &self.current) {
            estimate.output[1] = wrap(belief.relative().view_angle + own_heading);
            estimate.rates[1] = belief.line_rate(estimate.rates[1]);
        }
        estimate
    }

    fn own_speed(&self) -> f64 {
        self.past.back().map_or(0.0, |s| s.own.speed + s.own.acceleration * (s.until - s.from))
    }

    /// Time since the measurement that the estimate rests on, s; since the start before there was one.
    pub fn age(&self) -> f64 {
        self.anchor.as_ref().map_or(self.now, |(time, _)| self.now - time)
    }

    /// Whether the leader counts as seen.
    pub fn sight(&self, law: &TrackerParameters) -> TrackingState {
        let age = self.age();
        if age > law.hold {
            TrackingState::Lost
        } else if self.anchor.is_none() {
            TrackingState::Waiting
        } else if law.coasts(age - law.interval) {
            TrackingState::Coasting
        } else {
            TrackingState::Tracking
        }
    }
}

impl EdgeEstimator {
    fn is_of(&self, method: ObserverKind) -> bool {
        match self {
            Self::HighGain(_) => method == ObserverKind::HighGain,
            Self::Unscented(_) => method == ObserverKind::Unscented,
        }
    }

    /// Carries it on over `duration` s of a stretch that began `since` s before.
    fn predict(&mut self, law: &TrackerParameters, own: Own, [since, duration]: [f64; 2], coasting: bool) {
        let own = Own { speed: own.speed + own.acceleration * since, ..own };
        match self {
            Self::HighGain(belief) => belief.predict(law, own, duration, coasting),
            Self::Unscented(belief) => belief.predict(law, own, duration),
        }
    }

    /// How far a measurement is from what was expected, in standard deviations.
    fn surprise(&self, law: &TrackerParameters, measurement: &Measurement, age: f64) -> f64 {
        match self {
            Self::HighGain(belief) => belief.surprise(law, measurement, age),
            Self::Unscented(belief) => belief.surprise(measurement),
        }
    }

    fn correct(&mut self, law: &TrackerParameters, measurement: &Measurement, age: f64) {
        match self {
            Self::HighGain(belief) => belief.correct(law, measurement, age),
            Self::Unscented(belief) => belief.correct(law, measurement),
        }
    }

    fn relative(&self) -> Relative {
        match self {
            Self::HighGain(belief) => belief.relative(),
            Self::Unscented(belief) => belief.relative(),
        }
    }

    fn estimate(&self, law: &TrackerParameters, own_speed: f64) -> Estimate {
        match self {
            Self::HighGain(belief) => belief.estimate,
            Self::Unscented(belief) => belief.estimate(law, own_speed),
        }
    }

    /// How fast the line to the leader turns in the world, where the bearing is believed to change at `bearing_rate`,
    /// both rad/s.
    fn line_rate(&self, bearing_rate: f64) -> f64 {
        match self {
            Self::HighGain(belief) => belief.line_rate(),
            Self::Unscented(belief) => bearing_rate + belief.leader_turn_rate(),
        }
    }

    fn is_finite(&self) -> bool {
        self.relative().coordinates().iter().all(|x| x.is_finite())
            && match self {
                Self::HighGain(belief) => belief.estimate.rates.iter().all(|x| x.is_finite()),
                Self::Unscented(belief) => belief.is_sound(),
            }
    }
}

/// What a measurement says less what was expected, angles wrapped.
fn innovation(measurement: &Relative, expected: &Relative) -> [f64; 3] {
    [
        measurement.distance - expected.distance,
        wrap(measurement.bearing - expected.bearing),
        wrap(measurement.view_angle - expected.view_angle),
    ]
}

#[cfg(test)]
mod tests;
