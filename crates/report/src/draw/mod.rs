//! Runs to figures and the numbers behind them.

mod curves;
mod graph;
mod ways;

pub(crate) use curves::{EdgeCurve, Magnify, errors, inputs, observer};
pub(crate) use graph::{farthest, graph};
pub(crate) use ways::trajectories;

use crate::figure::ReportFigure;
use crate::words::trimmed;
use figures::{Rgb, Stroke};
use std::iter::once;
use vocabulary::math;

/// A figure as it leaves this folder: SVG, and a table of what it shows.
pub(crate) struct Drawn {
    pub(crate) svg: String,
    pub(crate) csv: String,
}

impl Drawn {
    pub(crate) fn item(self, stem: impl Into<String>, caption: impl Into<String>) -> ReportFigure {
        ReportFigure::new(stem, caption, self.svg, self.csv)
    }
}

/// Strokes in turn, so that curves can be told apart in grey.
pub(crate) fn stroke(index: usize) -> Stroke {
    const TURN: [Stroke; 4] = [Stroke::Solid, Stroke::Dashed, Stroke::DashDotted, Stroke::Dotted];
    TURN[index % TURN.len()]
}

/// Colours of what is compared, of Okabe and Ito's: as far apart in grey as in colour.
pub(crate) const COMPARED: [Rgb; 3] = [[0.835, 0.369, 0.0], [0.0, 0.62, 0.451], [0.0, 0.447, 0.698]];

/// Robots from which on names would cover each other.
pub(crate) const NAMED: usize = 8;

/// Rows that a table has at most, and cells.
const ROWS: usize = 2001;
const CELLS: usize = 400_000;

/// A table of samples: `times` first, then columns by name; long ones every so many samples.
pub(crate) fn table(times: &[f64], columns: &[(String, Vec<f64>)]) -> String {
    let most = (CELLS / (columns.len() + 1)).clamp(100, ROWS);
    let every = times.len().div_ceil(most).max(1);
    let names = columns.iter().map(|(name, _)| quoted(name));
    let mut csv = once("time_s".to_owned()).chain(names).collect::<Vec<_>>().join(",") + "\n";
    for (row, time) in times.iter().enumerate().step_by(every) {
        let cells =
            columns.iter().map(|(_, values)| values.get(row).map_or_else(String::new, |v| number(*v)));
        csv += &(once(number(*time)).chain(cells).collect::<Vec<_>>().join(",") + "\n");
    }
    csv
}

/// Nine digits: more than any figure shows, fewer than f64 has.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = 8 - math::log10(value.abs()).floor() as i32;
    if (0..=12).contains(&digits) {
        trimmed(format!("{value:.*}", digits as usize))
    } else {
        format!("{value:.8e}")
    }
}

/// A cell that may hold commas.
pub(crate) fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_nine_digits() {
        let told = [0.0, 1.5, -0.236_067_977_499_79, 1_234.567_891_234, 3.9e-14, 2e12].map(number);
        assert_eq!(told, ["0", "1.5", "-0.236067977", "1234.56789", "3.90000000e-14", "2.00000000e12"]);
    }

    #[test]
    fn long_tables_are_thinned_and_names_are_quoted() {
        let times: Vec<f64> = (0..10_000).map(f64::from).collect();
        let csv = table(&times, &[("a, b".to_owned(), times.clone())]);
        assert!(csv.starts_with("time_s,\"a, b\"\n0,0\n5,5\n"), "{}", &csv[..40]);
        assert_eq!(csv.lines().count(), 2001);
    }
}
