//! What a varied key becomes: a list, a range, numbers that are drawn, or what another key is.

use std::{fmt, str::FromStr};
use vocabulary::math;

/// How the numbers of a range lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ValueScale {
    /// Evenly.
    #[default]
    Linear,
    /// With even ratios.
    Logarithmic,
}

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// Evenly between two numbers.
    Uniform([f64; 2]),
    /// With a logarithm that is evenly between two.
    LogUniform([f64; 2]),
    /// Normally.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation, above 0.
        deviation: f64,
    },
}

/// What a varied key becomes. Values are as an override has them.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Each, combined with all values of other keys.
    Grid {
        /// The values.
        values: Vec<String>,
        /// How they lie, if they are numbers.
        scale: ValueScale,
        /// As it was written.
        written: String,
    },
    /// Each with the value at the same place in all other lists of this kind.
    Zipped(Vec<String>),
    /// Numbers that are drawn, in degrees where the flag says so.
    Drawn {
        /// From which distribution.
        distribution: Distribution,
        /// Whether they are angles in degrees.
        degrees: bool,
    },
    /// What another varied key is in the same run.
    Same(String),
}

/// Values that cannot be read; the text says what would be right.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct ValuesError(String);

/// Most values of a range.
const MOST_VALUES: usize = 1_000_000;
/// What values look like.
const FORMS: &str = "write a range with its number of values, such as 1..10/19 or log:0.001..0.1/13; a list, such as 1,2,5 or \
    zip:1,2,5; a distribution, such as uniform:0..1, log-uniform:0.001..0.1 or normal:MEAN,DEVIATION; or =KEY for what \
    another key is";

impl FromStr for Values {
    type Err = ValuesError;

    fn from_str(text: &str) -> Result<Self, ValuesError> {
        let text = text.trim();
        if text.is_empty() {
            return Err(ValuesError(format!("there are no values: {FORMS}")));
        }
        if let Some(key) = text.strip_prefix('=') {
            return Ok(Self::Same(key.trim().to_owned()));
        }
        let (kind, rest) =
            text.split_once(':').filter(|(kind, _)| KINDS.contains(&kind.trim())).unwrap_or(("", text));
        match kind.trim() {
            "zip" => Ok(Self::Zipped(listed(rest)?)),
            "log" => range(rest, ValueScale::Logarithmic, text),
            "uniform" | "log-uniform" => between(rest, kind.trim() == "log-uniform"),
            "normal" => normal(rest),
            _ if is_range(rest) => range(rest, ValueScale::Linear, text),
            _ => {
                Ok(Self::Grid { values: listed(rest)?, scale: ValueScale::Linear, written: text.to_owned() })
            }
        }
    }
}

/// What may stand before a colon.
const KINDS: [&str; 5] = ["zip", "log", "uniform", "log-uniform", "normal"];

impl fmt::Display for Values {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = |degrees: bool| if degrees { " deg" } else { "" };
        match self {
            Self::Grid { written, .. } => f.write_str(written),
            Self::Zipped(values) => write!(f, "zip:{}", values.join(",")),
            Self::Drawn { distribution: Distribution::Uniform([low, high]), degrees } => {
                write!(f, "uniform:{low}..{high}{}", unit(*degrees))
            }
            Self::Drawn { distribution: Distribution::LogUniform([low, high]), degrees } => {
                write!(f, "log-uniform:{low}..{high}{}", unit(*degrees))
            }
            Self::Drawn { distribution: Distribution::Normal { mean, deviation }, degrees } => {
                write!(f, "normal:{mean},{deviation}{}", unit(*degrees))
            }
            Self::Same(key) => write!(f, "={key}"),
        }
    }
}

/// A number as it is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WrittenNumber {
    /// Its value, in the unit that it is written in.
    pub number: f64,
    /// Whether it is an angle in degrees.
    pub degrees: bool,
}

impl WrittenNumber {
    /// The number that `text` is, or the angle, which may be in quotes. `None` for what is no finite number.
    pub fn of(text: &str) -> Option<Self> {
        let text = text.trim();
        let quoted = text.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
        let text = quoted.unwrap_or(text).trim();
        let degrees = text.strip_suffix("deg").or_else(|| text.strip_suffix('°'));
        let angle = degrees.or_else(|| text.strip_suffix("rad"));
        // A number in quotes is text.
        if quoted.is_some() && angle.is_none() {
            return None;
        }
        let number: f64 = angle.unwrap_or(text).trim_end().parse().ok()?;
        number.is_finite().then_some(Self { number, degrees: degrees.is_some() })
    }

    /// It in SI units: angles in rad.
    pub fn si(self) -> f64 {
        if self.degrees { self.number.to_radians() } else { self.number }
    }
}

fn is_range(text: &str) -> bool {
    let ends = text.split_once("..");
    ends.is_some_and(|(low, rest)| {
        WrittenNumber::of(low).is_some() && !rest.is_empty() && !rest.contains(',')
    })
}

/// Two numbers with `..` between them, the lower first. Both are in degrees if the second is.
fn ends(text: &str) -> Result<([f64; 2], bool), ValuesError> {
    let wrong = || {
        ValuesError(format!("`{text}` is no range: write two numbers with `..` between them, such as 0.5..2"))
    };
    let (low, high) = text.split_once("..").ok_or_else(wrong)?;
    let (low, high) = (WrittenNumber::of(low).ok_or_else(wrong)?, WrittenNumber::of(high).ok_or_else(wrong)?);
    if low.number >= high.number {
        return Err(ValuesError(format!("the range `{text}` does not rise: write the lower number first")));
    }
    if low.degrees && !high.degrees {
        return Err(ValuesError(format!(
            "the range `{text}` has two units: write `deg` behind the second number"
        )));
    }
    Ok(([low.number, high.number], high.degrees))
}

fn range(text: &str, scale: ValueScale, written: &str) -> Result<Values, ValuesError> {
    let (range, count) = text.rsplit_once('/').ok_or_else(|| {
        ValuesError(format!(
            "the range `{text}` has no number of values: write it behind a slash, such as {text}/10"
        ))
    })?;
    let count =
        count.trim().parse().ok().filter(|count| (2..=MOST_VALUES).contains(count)).ok_or_else(|| {
            ValuesError(format!(
                "`{count}` is no number of values: write a whole number from 2 to {MOST_VALUES}"
            ))
        })?;
    let (ends, degrees) = ends(range)?;
    positive(ends, scale == ValueScale::Logarithmic, text)?;
    let values = (0..count).map(|k| in_range(ends, scale, k as f64 / (count - 1) as f64));
    let values = values.map(|value| value_text(value, degrees)).collect();
    Ok(Values::Grid { values, scale, written: written.to_owned() })
}

/// A share of a range.
fn in_range([low, high]: [f64; 2], scale: ValueScale, share: f64) -> f64 {
    let value = match scale {
        ValueScale::Linear => low + share * (high - low),
        ValueScale::Logarithmic => low * math::exp(share * math::ln(high / low)),
    };
    value.clamp(low, high)
}

/// A number as an override has it, in degrees where the flag says so. It has nine digits: what is printed is what runs.
pub fn value_text(value: f64, degrees: bool) -> String {
    let rounded: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    // A zero has no sign.
    let rounded = rounded + 0.0;
    if degrees { format!("\"{rounded} deg\"") } else { rounded.to_string() }
}

fn positive([low, _]: [f64; 2], logarithmic: bool, text: &str) -> Result<(), ValuesError> {
    if logarithmic && low <= 0.0 {
        return Err(ValuesError(format!(
            "the range `{text}` is logarithmic: both its numbers have to be above 0"
        )));
    }
    Ok(())
}

fn between(text: &str, logarithmic: bool) -> Result<Values, ValuesError> {
    let (ends, degrees) = ends(text)?;
    positive(ends, logarithmic, text)?;
    let distribution = if logarithmic { Distribution::LogUniform(ends) } else { Distribution::Uniform(ends) };
    Ok(Values::Drawn { distribution, degrees })
}

fn normal(text: &str) -> Result<Values, ValuesError> {
    let wrong = || {
        ValuesError(format!(
            "`{text}` is no normal distribution: write normal:MEAN,DEVIATION with a deviation above 0"
        ))
    };
    let (mean, deviation) = text.split_once(',').ok_or_else(wrong)?;
    let (mean, deviation) =
        (WrittenNumber::of(mean).ok_or_else(wrong)?, WrittenNumber::of(deviation).ok_or_else(wrong)?);
    let degrees = deviation.degrees;
    let distribution = Distribution::Normal { mean: mean.number, deviation: deviation.number };
    if deviation.number > 0.0 { Ok(Values::Drawn { distribution, degrees }) } else { Err(wrong()) }
}

/// A text at its commas; those in brackets and quotes do not divide it.
pub(crate) fn parts_of_list(text: &str) -> Vec<&str> {
    let (mut parts, mut start, mut depth, mut quote) = (vec![], 0, 0, None);
    for (at, letter) in text.char_indices() {
        match (quote, letter) {
            (Some(open), _) if open == letter => quote = None,
            (None, '"' | '\'') => quote = Some(letter),
            (None, '[' | '{') => depth += 1,
            (None, ']' | '}') => depth -= 1,
            (None, ',') if depth == 0 => {
                parts.push(text[start..at].trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(text[start..].trim());
    parts
}

fn listed(text: &str) -> Result<Vec<String>, ValuesError> {
    let parts = parts_of_list(text);
    if parts.is_empty() || parts.iter().any(|part| part.is_empty()) {
        return Err(ValuesError(format!("`{text}` has an empty value: {FORMS}")));
    }
    Ok(parts.into_iter().map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Values {
        text.parse().unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    fn values(text: &str) -> Vec<String> {
        match read(text) {
            Values::Grid { values, .. } | Values::Zipped(values) => values,
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn ranges_have_their_ends_and_as_many_values_as_they_say() {
        assert_eq!(values("1..10/4"), ["1", "4", "7", "10"]);
        assert_eq!(values("0..0.3/4"), ["0", "0.1", "0.2", "0.3"]);
        assert_eq!(values("log:0.001..0.1/3"), ["0.001", "0.01", "0.1"]);
        assert_eq!(values("-90..90 deg/3"), ["\"-90 deg\"", "\"0 deg\"", "\"90 deg\""]);
    }

    #[test]
    fn commas_inside_of_a_value_do_not_divide_a_list() {
        assert_eq!(values("car, unicycle"), ["car", "unicycle"]);
        assert_eq!(values("[0, 1, \"a,b\"],[2, 3, 4]"), ["[0, 1, \"a,b\"]", "[2, 3, 4]"]);
        assert_eq!(values("zip:1,2"), ["1", "2"]);
        // One value is a list, too, and a name may have a colon.
        assert_eq!((values("5"), values("a:b")), (vec!["5".to_owned()], vec!["a:b".to_owned()]));
    }

    #[test]
    fn what_is_written_is_what_was_read() {
        for text in [
            "1..10/4",
            "log:0.001..0.1/3",
            "1,2,5",
            "zip:1,2",
            "uniform:0..1",
            "log-uniform:0.01..1",
            "normal:1,0.5",
            "=law.k",
        ] {
            assert_eq!(read(text).to_string(), text);
        }
        assert_eq!(read("uniform:-20..20 deg").to_string(), "uniform:-20..20 deg");
    }

    #[test]
    fn what_is_wrong_is_said_with_what_would_be_right() {
        for (text, wanted) in [
            ("", "there are no values"),
            ("1..10", "no number of values"),
            ("1..10/1", "from 2 to"),
            ("1..10/9999999", "from 2 to"),
            ("10..1/3", "does not rise"),
            ("log:0..1/3", "above 0"),
            ("uniform:5", "no range"),
            ("normal:1", "MEAN,DEVIATION"),
            ("normal:1,0", "deviation above 0"),
            ("1,,2", "empty value"),
            ("1 deg..2/3", "two units"),
        ] {
            let error = text.parse::<Values>().expect_err(text).to_string();
            assert!(error.contains(wanted), "{text}: {error}");
        }
    }
}
