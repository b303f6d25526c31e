//! First-order actuators with range and rate.

use vocabulary::math;

/// Share of the way to its demand that an actuator goes in `step` s with a first-order `lag` in s: exact for a demand
/// that is held.
pub fn share(step: f64, lag: f64) -> f64 {
    -math::exp_m1(-step / lag)
}

/// How much faster than its own lag a compensated actuator answers. The demand overshoots by as much, so its range and
/// rate bound what can be gained.
const LEAD: f64 = 3.0;

/// What to demand so that an actuator which stands at `now` and goes `share` of its way in a step comes to `wanted`:
/// beyond it, if its lag is led, but never so far that it would overshoot within the step.
pub fn demand(now: f64, wanted: f64, share: f64, led: bool) -> f64 {
    if led { now + LEAD.min(1.0 / share) * (wanted - now) } else { wanted }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(time: f64, lag: f64, led: bool) -> f64 {
        let mut at = 0.0;
        for _ in 0..(time / 0.005_f64).round() as usize {
            let share = share(0.005, lag);
            at += share * (demand(at, 1.0, share, led) - at);
        }
        at
    }

    #[test]
    fn a_lag_is_exact_at_any_step() {
        assert!((after(0.1, 0.1, false) - (1.0 - math::exp(-1.0_f64))).abs() < 1e-12);
        assert!((share(1.0, 0.1) - (1.0 - math::exp(-10.0_f64))).abs() < 1e-15);
    }

    #[test]
    fn a_lead_answers_sooner_and_does_not_overshoot() {
        assert!(after(0.05, 0.1, true) > 0.75 && after(0.05, 0.1, false) < 0.40);
        assert!(after(1.0, 0.1, true) <= 1.0);
        assert_eq!(after(0.005, 0.0, true), 1.0, "an actuator without lag is there at once");
    }
}
