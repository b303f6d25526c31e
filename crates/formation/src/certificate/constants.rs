//! The constants of section 4.3 for one run: σ_s to T_ε, and the ultimate bound (eqs 44-53).
//!
//! The paper takes maxima over compact sets it leaves open; here they are taken over what the run went through, so that
//! the constants speak about this run. Two places need a choice. D_c is the smallest ball ‖r‖ ≤ μ that holds the run, P
//! left aside, and at least the one in which everything ends: the proof needs no more of it than dV/dt ≤ 0 on its
//! border. Eq 51 prints ‖r‖² ≤ 2 L₁ε; from eq 44 follows dV/dt ≤ −½k₁₂‖r‖² where
//! ‖r‖ ≥ 2 L₁ε, and this is what is used.

use super::ledger::Peaks;
use super::witness::Witness;
use vocabulary::math;

/// Constants of one edge of a run by output feedback.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// λ_min(P₀).
    pub least: f64,
    /// ‖P₀‖ = λ_max(P₀).
    pub norm: f64,
    /// Largest ‖g_s‖, 1/s (below eq 44).
    pub sigma_s: f64,
    /// Largest ‖g_v V_i‖, m/s² (below eq 45).
    pub sigma_v: f64,
    /// (σ_s + 2 k̄₁₂)/k₁₂ (below eq 44).
    pub sigma_1: f64,
    /// 16 σ_v² ‖P₀‖³ (below eq 45).
    pub rho: f64,
    /// σ₁ √(ρ/λ_min(P₀)).
    pub l1: f64,
    /// Largest ‖r‖, at least 2 L₁ε: the border of D_c.
    pub mu: f64,
    /// min(1/(4 σ_s ‖P₀‖), μ/L₁), s: the largest ε for which the proof finds an invariant set.
    pub epsilon_1: f64,
    /// ε ‖η‖ at the first sample.
    pub c3: f64,
    /// 1/(2 ‖P₀‖) (eq 47).
    pub mu_1: f64,
    /// c₃² ‖P₀‖ (eq 48).
    pub mu_2: f64,
    /// (ε/μ₁) ln(μ₂/(ρ ε⁴)), not below zero, s: when the observer's error is trapped (eq 49).
    pub t_epsilon: f64,
    /// ε, s; the larger of the two.
    pub epsilon: f64,
    /// ρ ε²: the border of D_ε.
    pub trap: f64,
    /// 2 L₁ε: where ‖r‖ ends (eq 51).
    pub filtered: f64,
    /// What that leaves of ‖e‖: 2 L₁ε/k₁₂.
    pub error: f64,
    /// δ₀, the bound on ‖e‖ + ‖de/dt‖ + ‖η‖ (eq 53).
    pub delta_0: f64,
    /// k₁₂, 1/s.
    pub k_least: f64,
}

impl Constants {
    /// Of what a witness has seen; `None` where its observer is not stable or it has seen nothing.
    pub fn of(witness: &Witness) -> Option<Self> {
        let layer = witness.layer?;
        witness.span()?;
        let Peaks { first_observer_error, rate_gain: sigma_s, effect: sigma_v, filtered } =
            witness.ledger.peaks;
        let (least, norm) = (layer.least, layer.norm);
        let gain = witness.law.gain;
        let (k_least, k_most) = (gain[0].min(gain[1]), gain[0].max(gain[1]));
        let epsilon = witness.observer.epsilon;
        let epsilon = epsilon[0].max(epsilon[1]);
        let sigma_1 = (sigma_s + 2.0 * k_most) / k_least;
        let rho = 16.0 * math::powi(sigma_v, 2) * math::powi(norm, 3);
        let l1 = sigma_1 * (rho / least).sqrt();
        // A run that stays inside the ball of eq 51 needs no larger one.
        let mu = filtered.max(2.0 * l1 * epsilon);
        let c3 = epsilon * first_observer_error;
        let (mu_1, mu_2) = (1.0 / (2.0 * norm), c3 * c3 * norm);
        let trap = rho * math::powi(epsilon, 2);
        let late = epsilon / mu_1 * math::ln(mu_2 / (rho * math::powi(epsilon, 4)));
        let filtered = 2.0 * l1 * epsilon;
        let error = filtered / k_least;
        let eta = epsilon * (rho / least).sqrt();
        Some(Self {
            least,
            norm,
            sigma_s,
            sigma_v,
            sigma_1,
            rho,
            l1,
            mu,
            epsilon_1: (1.0 / (4.0 * sigma_s * norm)).min(mu / l1),
            c3,
            mu_1,
            mu_2,
            t_epsilon: if late.is_finite() { late.max(0.0) } else { 0.0 },
            epsilon,
            trap,
            filtered,
            error,
            // ‖de/dt‖ ≤ ‖r‖ + k̄₁₂‖e‖.
            delta_0: error + filtered + k_most * error + eta,
            k_least,
        })
    }

    /// The largest ε for which the proof promises ‖e‖ ≤ `bound` in the end, s.
    pub fn epsilon_for(&self, bound: f64) -> f64 {
        (bound * self.k_least / (2.0 * self.l1)).min(self.epsilon_1)
    }
}
