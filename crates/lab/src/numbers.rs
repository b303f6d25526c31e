//! Numbers as text, and rounded to steps.

/// A number as TOML, to five significant digits, with a point.
pub fn toml_number(value: f64) -> String {
    let short = format!("{value:.4e}").parse::<f64>().unwrap_or(value);
    // −0 is written as 0.
    let plain = (short + 0.0).to_string();
    if plain.contains(['.', 'e', 'n']) { plain } else { format!("{plain}.0") }
}

/// A number without a needless point.
pub fn plain(value: f64) -> String {
    let text = toml_number(value);
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// A number with a fixed number of decimals and a proper minus sign.
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|b| b == b'0' || b == b'.') => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => text,
    }
}

/// The nearest multiple of a step.
pub fn snap(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let cases = [
            (5.0, "5.0"),
            (0.1 + 0.2, "0.3"),
            (1.234_567, "1.2346"),
            (0.001, "0.001"),
            (-2.5, "-2.5"),
            (-0.0, "0.0"),
        ];
        for (value, text) in cases {
            assert_eq!(toml_number(value), text);
        }
        assert_eq!((fixed(-0.001, 2), fixed(-1.0, 1)), ("0.00".to_owned(), "−1.0".to_owned()));
        assert_eq!(snap(2.26, 0.1), 2.300_000_000_000_000_3);
    }
}
