//! What the runs of a cell show, while the pointer rests on it.

use super::{SweptCells, shown_value};
use crate::numbers::{fixed, plain};
use eframe::egui::{RichText, Ui};
use std::collections::BTreeMap;
use sweeps::{CellSummary, ChartQuantity, RunRow};
use vocabulary::{Word, counted};

/// Values, share and number of the cell, and what failed first there.
pub(super) fn show(ui: &mut Ui, shown: &SweptCells<'_>, cell: u64) {
    ui.set_max_width(340.0);
    for (place, value) in shown.point(cell).values.iter().enumerate() {
        let text = format!("{} = {}", shown.label(place), shown_value(value));
        ui.label(RichText::new(text).strong());
    }
    let rows = shown.result.rows(cell);
    let Some(summary) = shown.cell(cell).filter(|_| !rows.is_empty()) else {
        ui.weak("not run yet");
        return;
    };
    ui.label(share(summary));
    if let ChartQuantity::Measure(_) = shown.quantity {
        let [low, middle, high] = shown.quantity.range(summary).map(number);
        let spread = if rows.len() > 1 { format!(" (5 to 95 %: {low} to {high})") } else { String::new() };
        ui.label(format!("{}: {middle}{spread}", shown.quantity.label()));
    }
    for line in failures(rows) {
        ui.label(line);
    }
    ui.weak("A click sets these values");
}

/// How many of its runs meet their expectations.
fn share(cell: &CellSummary) -> String {
    match (cell.met, cell.runs) {
        (1, 1) => "meets its expectations".to_owned(),
        (0, 1) => "does not meet its expectations".to_owned(),
        (met, runs) => format!(
            "{met} of {} meet their expectations: {} % ({} to {} %)",
            counted(runs as usize, "run"),
            fixed(100.0 * cell.share, 0),
            fixed(100.0 * cell.interval[0], 0),
            fixed(100.0 * cell.interval[1], 0)
        ),
    }
}

/// What the runs did not meet first, the most frequent first, with the reason of the earliest.
fn failures(rows: &[RunRow]) -> Vec<String> {
    let mut found: BTreeMap<&str, Vec<&RunRow>> = BTreeMap::new();
    for row in rows.iter().filter(|row| !row.met) {
        let key = if row.failed.is_empty() { row.status.word() } else { &*row.failed };
        found.entry(key).or_default().push(row);
    }
    let mut found: Vec<_> = found.into_iter().collect();
    found.sort_by_key(|(_, rows)| std::cmp::Reverse(rows.len()));
    let line = |(key, rows): (&str, Vec<&RunRow>)| {
        let first = rows.iter().min_by(|a, b| a.failed_time.total_cmp(&b.failed_time))?;
        let often = if rows.len() > 1 { format!(", {} times", rows.len()) } else { String::new() };
        let when = if first.failed_time.is_finite() {
            format!(" at {} s", fixed(first.failed_time, 2))
        } else {
            String::new()
        };
        Some(format!("{key}{often}{when}: {}", first.reason))
    };
    found.into_iter().filter_map(line).collect()
}

/// A number, or that there is none.
fn number(value: f64) -> String {
    if value.is_finite() { plain(value).replace('-', "−") } else { "none".to_owned() }
}
