//! How far an edge is from rest, as one number: of its tracking error, and of its observer's.

use vocabulary::wrap;

/// ½ rᵀr with r = ė + K e (eqs 18, 29 without P), from e [m, rad], its rate, and K [1/s].
pub fn tracking_energy(error: [f64; 2], error_rate: [f64; 2], gain: [f64; 2]) -> f64 {
    let r = [0, 1].map(|k| error_rate[k] + gain[k] * error[k]);
    0.5 * (r[0] * r[0] + r[1] * r[1])
}

/// An observer and how wrong it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObserverError {
    /// s − ŝ₁, [m, rad].
    pub output: [f64; 2],
    /// ds/dt − ŝ₂, [m/s, rad/s].
    pub rates: [f64; 2],
    /// ε, s.
    pub epsilon: [f64; 2],
    /// α1.
    pub alpha1: [f64; 2],
    /// α2.
    pub alpha2: [f64; 2],
}

/// W = ηᵀ P₀ η (eq 39) with η = [(s − ŝ₁)/ε, ds/dt − ŝ₂] (eq 35).
pub fn observer_energy(error: &ObserverError) -> f64 {
    let channel = |k: usize| {
        let output = if k == 1 { wrap(error.output[k]) } else { error.output[k] };
        let (a, b) = (output / error.epsilon[k], error.rates[k]);
        let [p11, p12, p22] = boundary_layer(error.alpha1[k], error.alpha2[k]);
        p11 * a * a + 2.0 * p12 * a * b + p22 * b * b
    };
    channel(0) + channel(1)
}

/// P₀ of one channel, [p11, p12, p22], from A₀ᵀP₀ + P₀A₀ = −I with A₀ = [[−α1, 1], [−α2, 0]] (eq 40).
pub fn boundary_layer(alpha1: f64, alpha2: f64) -> [f64; 3] {
    let p12 = -0.5;
    let p11 = (1.0 + alpha2) / (2.0 * alpha1);
    [p11, p12, (p11 - alpha1 * p12) / alpha2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_boundary_layer_solves_its_lyapunov_equation() {
        for (a, b) in [(2.0, 1.0), (0.3, 4.0), (5.0, 0.2)] {
            let [p, q, s] = boundary_layer(a, b);
            // Entries of A₀ᵀP₀ + P₀A₀.
            let entries = [2.0 * (-a * p - b * q), p - a * q - b * s, 2.0 * q];
            for (entry, wanted) in entries.into_iter().zip([-1.0, 0.0, -1.0]) {
                assert!((entry - wanted).abs() < 1e-12, "{a} {b}: {entries:?}");
            }
            assert!(p > 0.0 && p * s - q * q > 0.0, "not positive definite at {a} {b}");
        }
    }

    #[test]
    fn energies_vanish_at_rest_only() {
        assert_eq!(tracking_energy([0.0; 2], [0.0; 2], [5.0; 2]), 0.0);
        assert_eq!(tracking_energy([0.1, 0.0], [0.0; 2], [5.0; 2]), 0.125);
        let rest = ObserverError {
            output: [0.0; 2],
            rates: [0.0; 2],
            epsilon: [0.01; 2],
            alpha1: [2.0; 2],
            alpha2: [1.0; 2],
        };
        assert_eq!(observer_energy(&rest), 0.0);
        assert!(observer_energy(&ObserverError { rates: [0.0, 0.1], ..rest }) > 0.0);
    }
}
