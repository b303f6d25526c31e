//! Elementary functions that give the same bits on every machine.
//!
//! The platform's own differ: glibc takes other code with fused multiply-add than without, and a browser has its own. What
//! decides a trajectory calls these; clippy refuses `f64::sin` and its like there. `sqrt`, `abs`, `floor`, `ceil`, `round`,
//! `%`, `rem_euclid` and `mul_add` are exact everywhere and stay methods. Angles are in rad.

pub use libm::{
    acos, asin, atan, atan2, cos, exp, exp2, expm1 as exp_m1, hypot, log as ln, log1p as ln_1p, log2, log10,
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
        let values = [
            sin(x),
            cos(x),
            tan(x),
            asin(x),
            acos(x),
            atan(x),
            atan2(x, y),
            exp(y),
            exp_m1(x),
            exp2(y),
            hypot(x, y),
            ln(x),
            ln_1p(x),
            log2(x),
            log10(x),
            powf(x, y),
            tanh(x),
        ];
        let bits = [
            0x3fe5_5e51_4630_e841,
            0x3fe7_d1e8_a18d_9c1c,
            0x3fec_b4e3_045b_1441,
            0x3fea_3e17_2ab4_f69a,
            0x3fe8_05df_7dd3_6397,
            0x3fe4_341a_2e19_1a08,
            0x4006_c893_0887_4c97,
            0x3fb6_cf3b_e21d_16ea,
            0x3ff1_3dbc_58a0_9b6b,
            0x3fc7_f365_848e_7be6,
            0x4004_3588_47be_bd48,
            0xbfd4_094f_7349_253f,
            0x3fe1_8fe4_1362_fbaf,
            0xbfdc_e807_d602_47b7,
            0xbfc1_6743_2a50_e930,
            0x4001_0e11_52be_f487,
            0x3fe3_f629_363a_b801,
        ];
        assert_eq!(values.map(f64::to_bits), bits);
    }

    #[test]
    fn whole_powers_are_products() {
        assert_eq!([powi(3.0, 0), powi(3.0, 1), powi(3.0, 4), powi(2.0, -3)], [1.0, 3.0, 81.0, 0.125]);
    }
}
