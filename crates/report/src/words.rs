//! Numbers as people read them.

use std::f64::consts::PI;

/// A value with its unit, in three digits, small lengths in mm and angles in degrees.
pub(crate) fn quantity(value: f64, unit: &str) -> String {
    match unit {
        "m" if value.abs() < 0.1 && value != 0.0 => format!("{} mm", digits(value * 1e3)),
        "rad" if value.abs() < 0.5 * PI && value != 0.0 => format!("{}°", digits(value * 180.0 / PI)),
        "" => digits(value),
        unit => format!("{} {unit}", digits(value)),
    }
}

/// Three digits that count; powers of ten where zeros would have to be counted.
pub(crate) fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { "—".to_owned() };
    }
    let decade = value.abs().log10().floor();
    // Rounding may carry into the next decade: 9.996 is 10.0.
    let decade =
        if (value.abs() / 10_f64.powf(decade) * 100.0).round() >= 1000.0 { decade + 1.0 } else { decade };
    if (-3.0..6.0).contains(&decade) {
        let decimals = (2.0 - decade).max(0.0) as usize;
        return format!("{value:.decimals$}").replace('-', "−");
    }
    let factor = value / 10_f64.powf(decade);
    let raised: String = format!("{decade}").chars().map(raise).collect();
    format!("{factor:.2}·10{raised}").replace('-', "−")
}

fn raise(c: char) -> char {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    match c.to_digit(10) {
        Some(d) => RAISED[d as usize],
        None => '⁻',
    }
}

/// The nearest of 1, 2, 5 times a power of ten that is not above `value`.
pub(crate) fn round(value: f64) -> f64 {
    if !value.is_finite() || value <= 0.0 {
        return 1.0;
    }
    let decade = 10_f64.powf(value.log10().floor());
    let factor = [5.0, 2.0, 1.0].into_iter().find(|f| f * decade <= value * (1.0 + 1e-9)).unwrap_or(1.0);
    factor * decade
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_count() {
        let told = [0.0, 1.0, 11.5, 0.003_47, 1309.5, -0.0123, 9.996, 3.9e-14, 2.5e7].map(digits);
        assert_eq!(
            told,
            ["0", "1.00", "11.5", "0.00347", "1310", "−0.0123", "10.0", "3.90·10⁻¹⁴", "2.50·10⁷"]
        );
        assert_eq!(digits(f64::NAN), "—");
    }

    #[test]
    fn small_lengths_are_millimetres_and_small_angles_degrees() {
        assert_eq!(quantity(0.003_47, "m"), "3.47 mm");
        assert_eq!(quantity(2.0, "m"), "2.00 m");
        assert_eq!(quantity(PI / 180.0, "rad"), "1.00°");
        assert_eq!(quantity(5.41, "rad"), "5.41 rad");
        assert_eq!(quantity(3.0, ""), "3.00");
    }

    #[test]
    fn steps_are_round() {
        assert_eq!([15.0 / 6.0, 0.5, 0.09, 7.0, 10.0].map(round), [2.0, 0.5, 0.05, 5.0, 10.0]);
    }
}
