//! Estimates from looks at the leader: one every few periods, late, noisy, sometimes missing or wrong.
//!
//! Between looks an estimate is carried on by the equations of the observer, driven by what the follower itself does.
//! A look is put in at the instant it was taken, and what the follower did since is played again on top of it, so that
//! latency costs nothing but that time's disturbance. [`high_gain`] is the observer of eqs 31-32 in discrete form,
//! [`unscented`] a dual unscented Kalman filter to compare it with.

pub mod high_gain;
pub mod unscented;

use crate::observer::{Estimate, Observer};
use high_gain::HighGain;
use std::collections::VecDeque;
use unscented::Unscented;
use vocabulary::{Measurement, ObserverKind, Outcome, Relative, TrackingState, wrap};

/// Parameters of an estimate from looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LookLaw {
    /// How looks become an estimate.
    pub method: ObserverKind,
    /// ε, α and ℓ_min.
    pub observer: Observer,
    /// Whether ε follows from how certain the looks are.
    pub adaptive: bool,
    /// δ, [m/s², rad/s²]: what the leader does to d²s/dt², unknown to the follower.
    pub disturbance: [f64; 2],
    /// Standard deviations beyond which a look is not believed.
    pub gate: f64,
    /// Time between looks that is expected, s.
    pub interval: f64,
    /// Time without a look after which the leader is lost, s.
    pub hold: f64,
}

impl LookLaw {
    /// Whether a look of this age, s, should have been followed by another.
    fn coasts(&self, age: f64) -> bool {
        age > 1.5 * self.interval + SLACK
    }
}

/// Looks may come this much later than they should, s: they wait for a control sample, and for their latency.
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

/// The estimate of one edge from looks.
#[derive(Debug, Clone, Default)]
pub struct Tracker {
    now: f64,
    past: VecDeque<OwnMotion>,
    /// What was believed right after the last look, at its instant.
    anchor: Option<(f64, EdgeEstimator)>,
    /// The same, carried on to now.
    current: Option<EdgeEstimator>,
    /// Looks that were not believed, one after the other.
    rejected: u32,
}

/// The follower's past is kept for this long, s: no look is older.
const MEMORY: f64 = 4.0;
/// A look this far from the prediction this many times in a row is right, and the prediction wrong.
const STUBBORN: u32 = 3;

impl Tracker {
    /// Carries the estimate on over a period that has passed.
    pub fn advance(&mut self, law: &LookLaw, own: Own, period: f64) {
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

    /// Puts in a look that has arrived; what came of it.
    pub fn take(&mut self, law: &LookLaw, look: &Measurement) -> Outcome {
        let finite =
            |r: &Relative| r.distance.is_finite() && r.bearing.is_finite() && r.view_angle.is_finite();
        if !finite(&look.relative) || look.stamp < self.now - MEMORY {
            return Outcome::Rejected;
        }
        let Some((time, belief)) = self.anchor.take() else {
            self.restart(law, look);
            return Outcome::Used;
        };
        // Looks come in the order of their stamps; one out of order adds nothing.
        if look.stamp < time {
            self.anchor = Some((time, belief));
            return Outcome::Rejected;
        }
        if !belief.is_of(law.method) {
            // The method has changed since: it begins anew.
            self.restart(law, look);
            return Outcome::Used;
        }
        let mut at_look = belief.clone();
        self.replay(law, &mut at_look, time, look.stamp);
        let age = (look.stamp - time).max(1e-6);
        if at_look.surprise(law, look, age) > law.gate {
            self.rejected += 1;
            if self.rejected < STUBBORN {
                self.anchor = Some((time, belief));
                return Outcome::Rejected;
            }
            self.restart(law, look);
            return Outcome::Used;
        }
        self.rejected = 0;
        at_look.correct(law, look, age);
        if !at_look.is_finite() {
            self.restart(law, look);
            return Outcome::Used;
        }
        self.settle(law, look.stamp, at_look);
        Outcome::Used
    }

    /// Begins anew at a look, rates zero.
    fn restart(&mut self, law: &LookLaw, look: &Measurement) {
        self.rejected = 0;
        let own = self.past.iter().find(|s| look.stamp <= s.until).or(self.past.back());
        let speed = own.map_or(0.0, |s| s.own.speed);
        let belief = match law.method {
            ObserverKind::HighGain => EdgeEstimator::HighGain(HighGain::at(look)),
            ObserverKind::Unscented => EdgeEstimator::Unscented(Box::new(Unscented::at(law, look, speed))),
        };
        self.settle(law, look.stamp, belief);
    }

    /// What is believed at `stamp` becomes the anchor, and is carried on to now.
    fn settle(&mut self, law: &LookLaw, stamp: f64, belief: EdgeEstimator) {
        let mut current = belief.clone();
        self.replay(law, &mut current, stamp, self.now);
        self.anchor = Some((stamp, belief));
        self.current = Some(current);
    }

    /// Carries `belief` from one instant to another by what the follower did.
    fn replay(&self, law: &LookLaw, belief: &mut EdgeEstimator, from: f64, until: f64) {
        for stretch in self.past.iter().filter(|s| s.until > from && s.from < until) {
            let (start, end) = (from.max(stretch.from), until.min(stretch.until));
            let coasting = law.coasts(stretch.from - from);
            belief.predict(law, stretch.own, [start - stretch.from, end - start], coasting);
        }
    }

    /// Adds to the estimate as it stands, [m, rad] and [m/s, rad/s]: to watch it recover.
    pub fn disturb(&mut self, output: [f64; 2], rates: [f64; 2]) {
        let beliefs = self.anchor.iter_mut().map(|(_, belief)| belief).chain(&mut self.current);
        for belief in beliefs {
            if let EdgeEstimator::HighGain(belief) = belief {
                for k in 0..2 {
                    belief.estimate.output[k] += output[k];
                    belief.estimate.rates[k] += rates[k];
                }
            }
        }
    }

    /// Where the follower is believed to be relative to its leader now; `None` before the first look.
    pub fn relative(&self) -> Option<Relative> {
        let Relative { distance, bearing, view_angle } = self.current.as_ref()?.relative();
        Some(Relative { distance, bearing: wrap(bearing), view_angle: wrap(view_angle) })
    }

    /// ŝ now; at rest and where it is before the first look.
    pub fn estimate(&self, law: &LookLaw) -> Estimate {
        self.current.as_ref().map_or_else(Estimate::default, |belief| belief.estimate(law, self.own_speed()))
    }

    fn own_speed(&self) -> f64 {
        self.past.back().map_or(0.0, |s| s.own.speed + s.own.acceleration * (s.until - s.from))
    }

    /// Time since the look that the estimate rests on, s; since the start before there was one.
    pub fn age(&self) -> f64 {
        self.anchor.as_ref().map_or(self.now, |(time, _)| self.now - time)
    }

    /// Whether the leader counts as seen.
    pub fn sight(&self, law: &LookLaw) -> TrackingState {
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
    fn predict(&mut self, law: &LookLaw, own: Own, [since, duration]: [f64; 2], coasting: bool) {
        let own = Own { speed: own.speed + own.acceleration * since, ..own };
        match self {
            Self::HighGain(belief) => belief.predict(law, own, duration, coasting),
            Self::Unscented(belief) => belief.predict(law, own, duration),
        }
    }

    /// How far a look is from what was expected, in standard deviations.
    fn surprise(&self, law: &LookLaw, look: &Measurement, age: f64) -> f64 {
        match self {
            Self::HighGain(belief) => belief.surprise(law, look, age),
            Self::Unscented(belief) => belief.surprise(look),
        }
    }

    fn correct(&mut self, law: &LookLaw, look: &Measurement, age: f64) {
        match self {
            Self::HighGain(belief) => belief.correct(law, look, age),
            Self::Unscented(belief) => belief.correct(law, look),
        }
    }

    fn relative(&self) -> Relative {
        match self {
            Self::HighGain(belief) => belief.relative(),
            Self::Unscented(belief) => belief.relative(),
        }
    }

    fn estimate(&self, law: &LookLaw, own_speed: f64) -> Estimate {
        match self {
            Self::HighGain(belief) => belief.estimate,
            Self::Unscented(belief) => belief.estimate(law, own_speed),
        }
    }

    fn is_finite(&self) -> bool {
        let Relative { distance, bearing, view_angle } = self.relative();
        let sound = [distance, bearing, view_angle].iter().all(|x| x.is_finite());
        sound
            && match self {
                Self::HighGain(belief) => belief.estimate.rates.iter().all(|x| x.is_finite()),
                Self::Unscented(belief) => belief.is_sound(),
            }
    }
}

/// What a look says less what was expected, angles wrapped.
fn innovation(look: &Relative, expected: &Relative) -> [f64; 3] {
    [
        look.distance - expected.distance,
        wrap(look.bearing - expected.bearing),
        wrap(look.view_angle - expected.view_angle),
    ]
}

#[cfg(test)]
mod tests;
