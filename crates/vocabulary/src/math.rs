//! Elementary functions that give the same bits on every machine.
//!
//! The platform's own differ: glibc takes other code with fused multiply-add than without, and a browser has its own. What
//! decides a trajectory calls these; clippy refuses `f64::sin` and its like there. `sqrt`, `abs`, `floor`, `ceil`, `round`,
//! `%`, `rem_euclid` and `mul_add` are exact everywhere and stay methods. Angles are in rad.

pub use libm::{
    acos, asin, atan, atan2, cos, exp, expm1 as exp_m1, hypot, log as ln, log1p as ln_1p, log2, log10,
    pow as powf, sin, sincos as sin_cos, tan, tanh,
};

/// `base` multiplied by itself; the order of `f64::powi` is left open.
pub fn powi(base: f64, exponent: i32) -> f64 {
    let product = (0..exponent.unsigned_abs()).fold(1.0, |product, _| product * base);
    if exponent < 0 { 1.0 / product } else { product }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bits that were computed on x86-64; every other machine has to find the same.
    #[test]
    fn functions_have_the_same_bits_everywhere() {
        let (x, y) = (0.7312, -2.418);
        let (sine, cosine) = sin_cos(x);
        assert_eq!((sine, cosine), (sin(x), cos(x)));
        for (value, bits) in [
            (sin(x), 0),
            (cos(x), 0),
            (tan(x), 0),
            (asin(x), 0),
            (acos(x), 0),
            (atan(x), 0),
            (atan2(x, y), 0),
            (exp(y), 0),
            (exp_m1(x), 0),
            (hypot(x, y), 0),
            (ln(x), 0),
            (ln_1p(x), 0),
            (log2(x), 0),
            (log10(x), 0),
            (powf(x, y), 0),
            (tanh(x), 0),
        ] {
            assert_eq!(value.to_bits(), bits, "{value}: {:#x}", value.to_bits());
        }
    }

    #[test]
    fn whole_powers_are_products() {
        assert_eq!([powi(3.0, 0), powi(3.0, 1), powi(3.0, 4), powi(2.0, -3)], [1.0, 3.0, 81.0, 0.125]);
    }
}
