//! Numbers as text.

use std::f64::consts::PI;
use vocabulary::math;

/// A value with its unit, in three digits, small lengths in mm and angles in degrees.
pub(crate) fn quantity(value: f64, unit: &str) -> String {
    quantity_to(3, value, unit)
}

/// Values with their unit, in three digits, or as many more as tell those apart that differ.
pub(crate) fn told_apart(values: &[f64], unit: &str) -> Vec<String> {
    let mut texts = vec![];
    for count in 3..=17 {
        texts = values.iter().map(|value| quantity_to(count, *value, unit)).collect();
        let apart = |a: usize, b: usize| values[a] == values[b] || texts[a] != texts[b];
        if (0..values.len()).all(|a| (0..a).all(|b| apart(a, b))) {
            break;
        }
    }
    texts
}

fn quantity_to(count: i32, value: f64, unit: &str) -> String {
    match unit {
        "m" if value.abs() < 0.1 && value != 0.0 => format!("{} mm", digits_to(count, value * 1e3)),
        "rad" if value.abs() < 0.5 * PI && value != 0.0 => {
            format!("{}°", digits_to(count, value * 180.0 / PI))
        }
        "" => digits_to(count, value),
        unit => format!("{} {unit}", digits_to(count, value)),
    }
}

/// Three digits that count; powers of ten where zeros would have to be counted.
pub(crate) fn digits(value: f64) -> String {
    digits_to(3, value)
}

/// As many digits that count as `count`.
fn digits_to(count: i32, value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { "—".to_owned() };
    }
    let decade = math::log10(value.abs()).floor();
    // Rounding may carry into the next decade: 9.996 is 10.0.
    let shift = math::powi(10_f64, count - 1);
    let carried = (value.abs() / math::powf(10_f64, decade) * shift).round() >= 10.0 * shift;
    let decade = if carried { decade + 1.0 } else { decade };
    if (-3.0..6.0).contains(&decade) {
        let decimals = (f64::from(count - 1) - decade).max(0.0) as usize;
        return format!("{value:.decimals$}").replace('-', "−");
    }
    let factor = value / math::powf(10_f64, decade);
    let raised: String = format!("{decade}").chars().map(raise).collect();
    let decimals = (count - 1) as usize;
    format!("{factor:.decimals$}·10{raised}").replace('-', "−")
}

/// A number without zeros at the end of its decimals.
pub(crate) fn trimmed(text: String) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
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
    let decade = math::powf(10_f64, math::log10(value).floor());
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

    /// "NOT SO: 20.0 mm, at most 20.0 mm" helps nobody.
    #[test]
    fn what_differs_is_told_apart() {
        assert_eq!(told_apart(&[0.020_04, 0.02], "m"), ["20.04 mm", "20.00 mm"]);
        assert_eq!(told_apart(&[1.234, 1.234, 2.0], ""), ["1.23", "1.23", "2.00"]);
        assert_eq!(told_apart(&[1.0, 1.0 + 1e-9], "rad"), ["57.2957795°", "57.2957796°"]);
        assert_eq!(told_apart(&[3.9e-14, 3.901e-14], ""), ["3.900·10⁻¹⁴", "3.901·10⁻¹⁴"]);
        assert_eq!(told_apart(&[0.0, f64::NAN, f64::NAN], ""), ["0", "—", "—"]);
    }

    #[test]
    fn steps_are_round() {
        assert_eq!([15.0 / 6.0, 0.5, 0.09, 7.0, 10.0].map(round), [2.0, 0.5, 0.05, 5.0, 10.0]);
    }
}
