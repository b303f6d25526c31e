//! From values to places along an axis, and where its ticks stand.

use crate::{Axis, Scale};
use vocabulary::math;

/// An axis laid out over some values.
#[derive(Debug, Clone, PartialEq)]
pub struct Ruler {
    scale: Scale,
    /// Values at both ends; of logarithmic axes their common logarithms.
    ends: [f64; 2],
    /// Share of the axis that is left of its values, for a zero that stands by itself.
    apart: f64,
}

/// A tick; those without a label are shorter.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Place, 0 to 1.
    pub at: f64,
    /// What stands at it; nothing at most ticks between others.
    pub label: String,
}

/// Share of a horizontal axis for a zero that stands by itself.
const APART: f64 = 0.13;
/// The end of a zero's part, where the axis is cut.
pub(crate) const CUT: f64 = 0.62 * APART;

impl Ruler {
    /// Over `values` and those the axis shows anyway. A zero stands apart on logarithmic axes that are `across`; where
    /// `snug`, the ends are at the outermost values.
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64>, across: bool) -> Self {
        let all: Vec<f64> = values.chain(axis.show.iter().copied()).filter(|v| v.is_finite()).collect();
        let log = axis.scale == Scale::Log;
        let taken =
            all.iter().copied().filter(|v| !log || *v > 0.0).map(|v| if log { math::log10(v) } else { v });
        let (low, high) = taken.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let asked = axis.range.map(|ends| if log { ends.map(math::log10) } else { ends });
        let ends = match asked.filter(|[low, high]| low < high && (high - low).is_finite()) {
            Some(ends) => ends,
            None if low > high => [0.0, 1.0],
            None => widened(low, high, log, across),
        };
        let zero = across && log && all.iter().any(|v| *v <= 0.0);
        Self { scale: axis.scale, ends, apart: if zero { APART } else { 0.0 } }
    }

    /// Place of a value, 0 to 1; `None` where it has none.
    pub fn at(&self, value: f64) -> Option<f64> {
        let along = match self.scale {
            Scale::Linear => value,
            Scale::Log if value > 0.0 => math::log10(value),
            Scale::Log if self.apart > 0.0 => return Some(0.3 * APART),
            Scale::Log => return None,
        };
        let share = (along - self.ends[0]) / (self.ends[1] - self.ends[0]);
        let at = self.apart + (1.0 - self.apart) * share;
        at.is_finite().then_some(at.clamp(-10.0, 11.0))
    }

    /// Whether a value stands apart from the others.
    pub(crate) fn apart(&self, value: f64) -> bool {
        self.apart > 0.0 && value <= 0.0
    }

    /// Whether the axis is cut after its zero.
    pub(crate) fn cut(&self) -> bool {
        self.apart > 0.0
    }

    /// About `most` labelled ticks at most, and unlabelled ones between them.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        let mut ticks = match self.scale {
            Scale::Linear => self.even(most),
            Scale::Log => self.decades(most),
        };
        ticks.retain(|t| (self.apart - 1e-9..=1.0 + 1e-9).contains(&t.at));
        if self.apart > 0.0 {
            ticks.insert(0, Tick { at: 0.3 * APART, label: "0".to_owned() });
        }
        ticks
    }

    fn even(&self, most: usize) -> Vec<Tick> {
        let [low, high] = self.ends;
        let (step, decimals) = step((high - low) / most.max(1) as f64);
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        let count = (last - first).clamp(0.0, 50.0) as usize;
        let tick = |k: usize| {
            let value = (first + k as f64) * step;
            let label = format!("{value:.decimals$}");
            let label = if label.trim_matches(['-', '0', '.']).is_empty() { "0".to_owned() } else { label };
            Tick { at: self.at(value).unwrap_or(-1.0), label: label.replace('-', "−") }
        };
        (0..=count).map(tick).collect()
    }

    fn decades(&self, most: usize) -> Vec<Tick> {
        let [low, high] = self.ends;
        let (first, last) = (low.floor() as i32, high.ceil() as i32);
        let places = |factors: &[i32]| {
            let inside = |v: f64| (low - 1e-9..=high + 1e-9).contains(&math::log10(v));
            let all = (first..=last)
                .flat_map(|d| factors.iter().map(move |f| f64::from(*f) * math::powi(10_f64, d)));
            all.filter(|v| inside(*v)).count()
        };
        // As many labels as there is room for: 1 2 5 10, 1 3 10, or decades only.
        let choices: [&[i32]; 3] = [&[1, 2, 5], &[1, 3], &[1]];
        let labelled = choices.into_iter().find(|c| places(c) <= most).unwrap_or(&[1]);
        let every = (places(&[1]).saturating_sub(1) / most.max(1) + 1) as i32;
        let mut ticks = vec![];
        for decade in first..=last {
            for factor in 1..10 {
                let value = f64::from(factor) * math::powi(10_f64, decade);
                let named = labelled.contains(&factor) && (factor > 1 || decade % every == 0);
                // Where not even every decade has a label, steps within them would be a grey smear.
                if every > 1 && !named {
                    continue;
                }
                let label = if named { decimal(factor, decade) } else { String::new() };
                ticks.push(Tick { at: self.at(value).unwrap_or(-1.0), label });
            }
        }
        ticks
    }
}

/// Ends a little beyond the outermost values, so that no marker is cut.
fn widened(low: f64, high: f64, log: bool, across: bool) -> [f64; 2] {
    let span = high - low;
    if span <= 1e-12 * low.abs().max(high.abs()).max(1e-300) {
        let by = if log { 0.5 } else { 0.5 * low.abs().max(1.0) };
        return [low - by, high + by];
    }
    if across && !log {
        return [low, high];
    }
    let by = if across { 0.03 } else { 0.07 } * span;
    // A zero at the end of a linear axis is its natural end.
    let end = |at: f64, by: f64| if !log && at == 0.0 { 0.0 } else { at + by };
    [end(low, -by), end(high, by)]
}

/// A round step of at least `least`, and the decimals it needs.
fn step(least: f64) -> (f64, usize) {
    if !least.is_finite() || least <= 0.0 {
        return (1.0, 0);
    }
    let step = vocabulary::round_step(least, 1e-9);
    (step, (-(math::log10(step) + 1e-9).floor()).clamp(0.0, 12.0) as usize)
}

/// A digit times a power of ten, as one writes it.
fn decimal(digit: i32, decade: i32) -> String {
    match decade {
        0..=3 => format!("{digit}{}", "0".repeat(decade as usize)),
        -4..=-1 => format!("0.{}{digit}", "0".repeat((-decade - 1) as usize)),
        _ => {
            let raised: String = decade.to_string().chars().map(raise).collect();
            let digit = if digit == 1 { String::new() } else { format!("{digit}·") };
            format!("{digit}10{raised}")
        }
    }
}

fn raise(c: char) -> char {
    match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale, values: &[f64], most: usize) -> Vec<String> {
        let axis = Axis { scale, ..Axis::default() };
        let ruler = Ruler::new(&axis, values.iter().copied(), true);
        ruler.ticks(most).into_iter().map(|t| t.label).filter(|l| !l.is_empty()).collect()
    }

    #[test]
    fn even_ticks_are_round() {
        assert_eq!(labels(Scale::Linear, &[0.0, 60.0], 6), ["0", "10", "20", "30", "40", "50", "60"]);
        assert_eq!(labels(Scale::Linear, &[-0.2, 0.2], 4), ["−0.2", "−0.1", "0", "0.1", "0.2"]);
    }

    #[test]
    fn decades_are_written_as_one_does() {
        assert_eq!(labels(Scale::Log, &[0.02, 1.0], 6), ["0.02", "0.05", "0.1", "0.2", "0.5", "1"]);
        assert_eq!(
            labels(Scale::Log, &[1e-6, 1.0], 7),
            ["10⁻⁶", "10⁻⁵", "0.0001", "0.001", "0.01", "0.1", "1"]
        );
    }

    #[test]
    fn a_zero_stands_apart_on_a_logarithmic_axis() {
        assert_eq!(labels(Scale::Log, &[0.0, 0.1, 1.0], 4), ["0", "0.1", "0.2", "0.5", "1"]);
        let axis = Axis { scale: Scale::Log, ..Axis::default() };
        let ruler = Ruler::new(&axis, [0.0, 0.1].into_iter(), true);
        assert!(ruler.apart(0.0) && ruler.at(0.0) < ruler.at(0.1));
        assert!(ruler.ticks(4)[1..].iter().all(|t| t.at > CUT), "no tick where the axis is cut");
        assert_eq!(Ruler::new(&axis, [0.0, 0.1].into_iter(), false).at(0.0), None);
    }

    #[test]
    fn nothing_and_one_value_have_an_axis_too() {
        for values in
            [&[][..], &[5.0], &[f64::NAN, f64::INFINITY], &[0.0], &[1e300, -1e300], &[f64::MAX, f64::MIN]]
        {
            for scale in [Scale::Linear, Scale::Log] {
                let axis = Axis { scale, ..Axis::default() };
                let ruler = Ruler::new(&axis, values.iter().copied(), true);
                let finite = || values.iter().copied().filter(|v| v.is_finite());
                let span = finite().fold(0.0, f64::max) - finite().fold(0.0, f64::min);
                // Where the span itself overflows, nothing has a place.
                let has_place =
                    |v: &f64| v.is_finite() && span.is_finite() && (scale == Scale::Linear || *v > 0.0);
                for value in values.iter().filter(|v| has_place(v)) {
                    let at = ruler.at(*value);
                    assert!(
                        at.is_some_and(|at| (0.0..=1.0).contains(&at)),
                        "{value} of {values:?} at {at:?}"
                    );
                }
                let ticks = ruler.ticks(5);
                let rise = ticks.windows(2).all(|pair| pair[0].at < pair[1].at);
                assert!(ticks.len() < 60 && (rise || !span.is_finite()), "{values:?}: {ticks:?}");
                assert!(ticks.iter().any(|tick| !tick.label.is_empty()), "{values:?}: {ticks:?}");
            }
        }
    }
}
