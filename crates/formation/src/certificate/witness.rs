//! What one edge went through, sample by sample, in the quantities of the theorems.

use super::boundary::BoundaryLayer;
use super::constants::Constants;
use super::ledger::Ledger;
use crate::law::{Law, Switching};
use crate::observer::{Estimate, Observer};
use crate::relative::Geometry;
use nalgebra::Vector2;
use vocabulary::{LawKind, MotionInput, Relative, SetPoint, math, wrap};

/// One edge at one control sample, as it truly was.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a premise of its own, none excludes another")]
pub struct Instant {
    /// s.
    pub time: f64,
    /// Relative position.
    pub relative: Relative,
    /// v_j, m/s, above zero.
    pub follower_speed: f64,
    /// The leader's motion.
    pub leader: MotionInput,
    /// s^d and its derivatives.
    pub set_point: SetPoint,
    /// e, [m, rad], bearing wrapped.
    pub error: [f64; 2],
    /// The observer's state where one runs.
    pub estimate: Option<Estimate>,
    /// Whether a bound cut the command.
    pub limited: bool,
    /// What of d²s^d/dt² the law is not told, [m/s², rad/s²]: that of a path's heading. It acts as g_v V_i does.
    pub untold: [f64; 2],
    /// Whether the speed stood at its bound.
    pub at_speed_bound: bool,
    /// Whether the standing rule had a part in the command.
    pub stands: bool,
    /// Whether a safety filter moved the command.
    pub diverted: bool,
    /// Whether the distance was below ℓ_min.
    pub too_close: bool,
}

/// The quantities of the theorems at one sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a premise of its own, none excludes another")]
pub struct WitnessRow {
    /// s.
    pub time: f64,
    /// ‖e‖, of metres and radians together as in the paper.
    pub error: f64,
    /// ‖de/dt‖.
    pub error_rate: f64,
    /// ‖r‖ with r = de/dt + K e (eq 18).
    pub filtered: f64,
    /// ‖g_v V_i‖, m/s² and rad/s².
    pub effect: f64,
    /// ‖d(g_v V_i)/dt‖: the larger of the slopes before and after the sample.
    pub effect_rate: f64,
    /// β − ‖g_v V_i‖ − ‖d(g_v V_i)/dt‖/k₁₂ (Lemma 4.1).
    pub margin: f64,
    /// P (eq 28).
    pub p: f64,
    /// V = ½ rᵀr + P (eq 29).
    pub v: f64,
    /// ‖η‖ (eqs 33-34); zero where no observer runs.
    pub observer_error: f64,
    /// W = ηᵀP₀η (eq 39).
    pub w: f64,
    /// ‖g_s‖.
    pub rate_gain: f64,
    /// Whether a bound cut the command.
    pub limited: bool,
    /// Whether the speed stood at its bound.
    pub at_speed_bound: bool,
    /// Whether the standing rule had a part in the command.
    pub stands: bool,
    /// Whether a safety filter moved the command.
    pub diverted: bool,
    /// Whether the distance was below ℓ_min.
    pub too_close: bool,
    /// Whether a sign in the law switched back since a few samples.
    pub chatters: bool,
}

impl WitnessRow {
    /// ‖r‖/‖η‖, which σ₁ bounds.
    pub(super) fn reach(&self) -> f64 {
        self.filtered / self.observer_error
    }

    /// ‖e‖ + ‖de/dt‖ + ‖η‖ (eq 53).
    pub(super) fn whole(&self) -> f64 {
        self.error + self.error_rate + self.observer_error
    }
}

/// Goes along with one edge; its law and observer stay the same.
#[derive(Debug, Clone)]
pub struct Witness {
    /// The law it goes along with.
    pub law: Law,
    /// The observer it goes along with; only output feedback uses it.
    pub observer: Observer,
    /// The boundary layer of the observer; `None` where it is not stable.
    pub layer: Option<BoundaryLayer>,
    /// ζ_b (eq 26).
    pub initial: f64,
    pub(super) ledger: Ledger,
    last_row: Option<WitnessRow>,
    /// Every sample, where they are kept.
    rows: Option<Vec<WitnessRow>>,
    last: Option<Sums>,
    /// Index of the sample at which the sign of each error switched last.
    switched: [Option<u64>; 2],
}

/// A sign that switches back within so many samples switches faster than steps follow.
const FEW: u64 = 4;

/// What the integrals of P need of the sample before.
#[derive(Debug, Clone, Copy)]
struct Sums {
    time: f64,
    error: Vector2<f64>,
    effect: Vector2<f64>,
    /// (K e)ᵀ(g_v V_i − ū).
    integrand: f64,
    /// ∫ L, from the first sample on.
    integral: f64,
}

impl Witness {
    /// Before the first sample.
    pub fn new(law: Law, observer: Observer) -> Self {
        Self {
            law,
            observer,
            layer: BoundaryLayer::of(&observer),
            ledger: Ledger::default(),
            last_row: None,
            rows: None,
            last: None,
            initial: 0.0,
            switched: [None; 2],
        }
    }

    /// Keeps every sample from now on, which takes about a hundred bytes each.
    #[must_use]
    pub fn keeping(self) -> Self {
        Self { rows: Some(Vec::new()), ..self }
    }

    /// All samples so far; none unless it is [`Self::keeping`] them.
    pub fn rows(&self) -> &[WitnessRow] {
        self.rows.as_deref().unwrap_or_default()
    }

    /// Number of samples.
    pub fn samples(&self) -> u64 {
        self.ledger.samples
    }

    /// First and last time, s; `None` before the first sample.
    pub fn span(&self) -> Option<[f64; 2]> {
        (self.ledger.samples > 0).then_some(self.ledger.span)
    }

    /// g_v V_i at the last sample, [m/s², rad/s²].
    pub fn last_effect(&self) -> [f64; 2] {
        self.last.map_or([0.0; 2], |last| last.effect.into())
    }

    /// Takes in the next sample.
    pub fn push(&mut self, now: &Instant) {
        let geometry = Geometry::new(&now.relative, self.law.distance_min);
        let rates = self.law.rates(&geometry, now.follower_speed, &now.leader);
        let error = Vector2::from(now.error);
        let error_rate = Vector2::from(now.set_point.rate) - rates;
        let gain = Vector2::from(self.law.gain);
        let filtered = error_rate + gain.component_mul(&error);
        let effect =
            self.law.leader_effect(&geometry, now.follower_speed, &now.leader) + Vector2::from(now.untold);
        let integrand = gain.component_mul(&error).dot(&(effect - self.robust_term(now.error)));
        let sums = self.integrate(now.time, error, effect, integrand);
        let p = self.initial - sums.integral;
        let chatters = self.chatters(&error);
        let eta = self.observer_error(now, &rates);
        let slope = self.last.map_or(0.0, |last| {
            let step = sums.time - last.time;
            if step > 0.0 { (effect - last.effect).norm() / step } else { 0.0 }
        });
        // The slope to this sample counts for the one before, too.
        if let Some(before) = &mut self.last_row {
            before.effect_rate = before.effect_rate.max(slope);
            before.margin = margin(&self.law, before);
        }
        let mut row = WitnessRow {
            time: now.time,
            error: error.norm(),
            error_rate: error_rate.norm(),
            filtered: filtered.norm(),
            effect: effect.norm(),
            effect_rate: slope,
            margin: 0.0,
            p,
            v: 0.5 * filtered.norm_squared() + p,
            observer_error: eta.iter().map(|x| x * x).sum::<f64>().sqrt(),
            w: self.layer.map_or(0.0, |layer| layer.energy(&eta)),
            rate_gain: geometry.line.rate_column(now.follower_speed).norm(),
            limited: now.limited,
            at_speed_bound: now.at_speed_bound,
            stands: now.stands,
            diverted: now.diverted,
            too_close: now.too_close,
            chatters,
        };
        row.margin = margin(&self.law, &row);
        let before = self.last_row.replace(row);
        if let Some(rows) = &mut self.rows {
            if let (Some(last), Some(before)) = (rows.last_mut(), before) {
                *last = before;
            }
            rows.push(row);
        }
        self.ledger.push(&row, before.as_ref());
        let constants = Constants::of(self).filter(|_| self.law.kind == LawKind::OutputFeedback);
        self.ledger.judge(before.as_ref(), constants.as_ref());
        self.last = Some(sums);
    }

    /// ∫ L dτ with L = rᵀ(g_v V_i − ū) (eq 25), r = de/dt + K e: the part with de/dt as a Stieltjes sum and, for ū, in
    /// closed form, so that steps of the sign do no harm; the rest by trapezoids.
    fn integrate(&mut self, time: f64, error: Vector2<f64>, effect: Vector2<f64>, integrand: f64) -> Sums {
        let Some(last) = self.last else {
            let beta = self.law.robust_gain;
            let robust = self.law.kind != LawKind::FullState;
            let start = if robust { beta[0] * error.x.abs() + beta[1] * error.y.abs() } else { 0.0 };
            self.initial = start - error.dot(&effect);
            return Sums { time, error, effect, integrand, integral: 0.0 };
        };
        // The bearing's error is wrapped: where it jumps by a turn, it did not move.
        let mut moved = error - last.error;
        moved.y = wrap(moved.y);
        let potential = self.potential(&error) - self.potential(&last.error);
        let integral = last.integral + moved.dot(&(effect + last.effect)) / 2.0 - potential
            + (time - last.time) * (integrand + last.integrand) / 2.0;
        Sums { time, error, effect, integrand, integral }
    }

    /// Whether the law's sign of an error switches, not for the first time within a few samples.
    fn chatters(&mut self, error: &Vector2<f64>) -> bool {
        let sign = self.law.kind != LawKind::FullState && self.law.switching == Switching::Sign;
        let Some(last) = self.last.filter(|_| sign) else { return false };
        let now = self.ledger.samples;
        let mut again = false;
        for i in 0..2 {
            if last.error[i] * error[i] < 0.0 {
                again |= self.switched[i].is_some_and(|before| now - before <= FEW);
                self.switched[i] = Some(now);
            }
        }
        again
    }

    fn robust_term(&self, error: [f64; 2]) -> Vector2<f64> {
        match self.law.kind {
            LawKind::FullState => Vector2::zeros(),
            LawKind::RobustState | LawKind::OutputFeedback => self.law.robust_term(error),
        }
    }

    /// ∫ ūᵀ de from e = 0: β‖e‖₁ for the sign, (β/slope) ln cosh(slope e) for tanh.
    fn potential(&self, error: &Vector2<f64>) -> f64 {
        if self.law.kind == LawKind::FullState {
            return 0.0;
        }
        let channel = |i: usize| {
            let e = error[i].abs();
            self.law.robust_gain[i]
                * match self.law.switching {
                    Switching::Sign => e,
                    Switching::Tanh(slope) => log_cosh(slope[i] * e) / slope[i],
                }
        };
        channel(0) + channel(1)
    }

    /// η = [(s − ŝ₁)/ε, ds/dt − ŝ₂] (eqs 33-34).
    fn observer_error(&self, now: &Instant, rates: &Vector2<f64>) -> [f64; 4] {
        let Some(estimate) = now.estimate else { return [0.0; 4] };
        let epsilon = self.observer.epsilon;
        [
            (now.relative.distance - estimate.output[0]) / epsilon[0],
            wrap(now.relative.bearing - estimate.output[1]) / epsilon[1],
            rates.x - estimate.rates[0],
            rates.y - estimate.rates[1],
        ]
    }
}

/// ln cosh x for x ≥ 0, without overflow.
fn log_cosh(x: f64) -> f64 {
    x + math::ln_1p(math::exp(-2.0 * x)) - std::f64::consts::LN_2
}

/// β − ‖g_v V_i‖ − ‖d(g_v V_i)/dt‖/k₁₂ (Lemma 4.1), β the smaller of the two.
fn margin(law: &Law, row: &WitnessRow) -> f64 {
    let [k, beta] = [law.gain, law.robust_gain].map(|pair| pair[0].min(pair[1]));
    beta - row.effect - row.effect_rate / k
}
