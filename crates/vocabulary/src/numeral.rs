//! Numbers in messages as people read them.

use std::borrow::Cow;
use std::fmt::{Display, Write};

/// So many zeros in a row nobody counts.
const ZEROS: &str = "0000000000000000";

/// A message whose numbers of very many zeros are written with an exponent: `1e-320` for 0.000…1.
pub fn readable(text: &str) -> Cow<'_, str> {
    if !text.contains(ZEROS) {
        return Cow::Borrowed(text);
    }
    let mut clean = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, run) = rest.split_at(start);
        let end = run.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(run.len());
        // A stop at the end is that of a sentence.
        let (number, after) = run.split_at(run[..end].trim_end_matches('.').len());
        // What stands in a word, such as a name of a file, is no number.
        let inside =
            clean.chars().chain(before.chars()).next_back().is_some_and(|c| c.is_alphanumeric() || c == '_');
        clean.push_str(before);
        // Written as this language writes numbers; with zeros in front it is a name.
        let long = |value: &f64| !inside && number.contains(ZEROS) && number == value.to_string();
        match number.parse::<f64>().ok().filter(long) {
            // Writing to a text cannot fail.
            Some(value) => drop(write!(clean, "{value:e}")),
            None => clean.push_str(number),
        }
        rest = after;
    }
    clean.push_str(rest);
    Cow::Owned(clean)
}

/// How many there are of what `noun` is one of: `1 frame`, `2 frames`.
pub fn counted(count: impl Display, noun: &str) -> String {
    let count = count.to_string();
    let plural = if count == "1" { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_no_plural() {
        assert_eq!(
            [0, 1, 2, 11].map(|n| counted(n, "frame")),
            ["0 frames", "1 frame", "2 frames", "11 frames"]
        );
        assert_eq!(
            (counted(1.0, "measurement"), counted("0.5 to 1", "measurement")),
            ("1 measurement".into(), "0.5 to 1 measurements".into())
        );
    }

    #[test]
    fn numbers_of_very_many_zeros_have_an_exponent() {
        for (text, wanted) in [
            (format!("from {} m, up to {} s.", 1e-320, -1e300), "from 1e-320 m, up to -1e300 s."),
            (format!("{} is 2.5", f64::MAX), "1.7976931348623157e308 is 2.5"),
            (format!("{}", 1.25e-30), "1.25e-30"),
            (format!("{} to {} of 3.", 1e-6, 1e12), "0.000001 to 1000000000000 of 3."),
            ("run-00000000000000000001.toml".to_owned(), "run-00000000000000000001.toml"),
            ("ab10000000000000000000".to_owned(), "ab10000000000000000000"),
        ] {
            assert_eq!(readable(&text), wanted);
        }
    }
}
