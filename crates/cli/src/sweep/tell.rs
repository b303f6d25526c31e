//! What is printed of a study.

use super::ShownArgs;
use crate::print::{json, say};
use report::ReportTable;
use scene::Values;
use serde_json::{Value, json};
use std::fmt::Write;
use std::ops::Range;
use std::path::Path;
use sweeps::{CellSummary, Experiment, MEASURES, RunRow, StudySummary};
use vocabulary::{Word, counted};

/// Runs that a trial without runs shows.
const FIRST: u64 = 8;
/// Cells that are printed.
const MOST_CELLS: usize = 40;
/// Cells that a report has.
const MOST_REPORTED: usize = 100;
/// Runs that are named.
const MOST_WORST: usize = 3;

/// The runs that there would be.
pub(super) fn dry(experiment: &Experiment, range: &Range<u64>, args: &ShownArgs) {
    let (study, design) = (experiment.study(), experiment.design());
    let points: Vec<_> = range.clone().take(FIRST as usize).map(|index| design.point(index)).collect();
    if args.json {
        let keys: Vec<&str> = study.parameters.iter().map(|parameter| parameter.key.as_str()).collect();
        let rows: Vec<_> =
            points.iter().map(|p| json!({ "index": p.index, "seed": p.seed, "values": p.values })).collect();
        json(&json!({
            "runs": study.runs(), "cells": study.cells(), "samples": study.samples, "seeds": study.seeds,
            "range": [range.start, range.end], "keys": keys, "first": rows,
        }));
        return;
    }
    if args.quiet {
        return;
    }
    say(&format!(
        "{}: {} ({} × {} × {})",
        study.title,
        counted(study.runs(), "run"),
        counted(study.cells(), "cell"),
        counted(study.samples, "sample"),
        counted(study.seeds, "seed")
    ));
    if *range != (0..study.runs()) {
        say(&format!(
            "here: {} to {}, {}",
            range.start,
            range.end - 1,
            counted(range.end - range.start, "run")
        ));
    }
    for point in points {
        let values =
            study.parameters.iter().zip(&point.values).map(|(p, value)| format!("{}={value}", p.key));
        let values: Vec<String> = values.chain([format!("seed={}", point.seed)]).collect();
        say(&format!("{:>8}  {}", point.index, values.join("  ")));
    }
    if range.end - range.start > FIRST {
        say(&format!("{:>8}", "…"));
    }
}

/// A share, with its interval where its runs are a sample.
fn share(met: u64, runs: u64, interval: Option<[f64; 2]>) -> String {
    let percent = 100.0 * met as f64 / runs.max(1) as f64;
    let interval = interval.map(|ends| ends.map(|end| 100.0 * end));
    let words = interval.map_or_else(String::new, |[low, high]| format!(" ({low:.2} to {high:.2} %)"));
    format!("{percent:.2} %{words}")
}

/// What all runs show, in a sentence or two.
pub(super) fn lead(experiment: &Experiment, summary: &StudySummary) -> String {
    let study = experiment.study();
    // Of several cells the runs are those of a grid, or of a part of it.
    let sample = |interval| (study.cells() == 1).then_some(interval);
    let mut text = format!(
        "{} of {} meet what their scene expects: {}; {} without contact.",
        summary.met,
        counted(summary.runs, "run"),
        share(summary.met, summary.runs, sample(summary.met_interval)),
        share(summary.runs - summary.with_contacts, summary.runs, sample(summary.contact_free_interval))
    );
    if summary.cells.iter().any(|cell| cell.alike) {
        text.push_str(
            " Runs with the same values are the same, whatever their seed: nothing in the scene is drawn. Scatter the starts, or add \
             noise; the intervals of cells say nothing.",
        );
    }
    let odd = summary.by_status.iter().filter(|(word, _)| **word != "complete");
    for (word, count) in odd {
        let _ = write!(text, " {} {word}.", counted(*count, "run"));
    }
    if study.samples > 1 {
        let _ = write!(text, " Numbers are drawn {} times ({}).", study.samples, study.sampling.word());
    }
    text
}

/// Columns of the table that is printed, by measure and quantile.
const SHOWN: [(&str, &str, usize); 4] = [
    ("settling_time_s", "settles (s)", 1),
    ("late_distance_error_m", "late error (m)", 1),
    ("late_distance_error_m", "95 % (m)", 2),
    ("clearance_min_m", "clearance, 5 % (m)", 0),
];

fn keys(experiment: &Experiment) -> Vec<usize> {
    let all = experiment.study().parameters.iter().enumerate();
    all.filter(|(_, p)| !matches!(p.values, Values::Drawn { .. } | Values::Same(_)))
        .map(|(index, _)| index)
        .collect()
}

/// The table of cells, as text.
fn cells(experiment: &Experiment, cells: &[CellSummary]) -> ReportTable {
    let keys = keys(experiment);
    let parameters = &experiment.study().parameters;
    let head = keys.iter().map(|k| parameters[*k].key.clone());
    let head = head.chain(["runs", "met", "95 %", "contacts"].map(str::to_owned));
    let head = head.chain(SHOWN.iter().map(|(_, title, _)| (*title).to_owned())).collect();
    let row = |cell: &CellSummary| {
        let values =
            keys.iter().map(|k| cell.values.get(*k).map_or("", |value| value.trim_matches('"')).to_owned());
        let [low, high] = cell.interval.map(|end| 100.0 * end);
        let counts = [
            cell.runs.to_string(),
            format!("{:.0} %", 100.0 * cell.share),
            format!("{low:.0} to {high:.0} %"),
            cell.with_contacts.to_string(),
        ];
        let numbers = SHOWN.iter().map(|(column, _, quantile)| {
            let which = MEASURES.iter().position(|measure| measure.column == *column);
            let value = which.and_then(|which| cell.quantiles.get(which)).map_or(f64::NAN, |q| q[*quantile]);
            if value.is_finite() { format!("{value:.3}") } else { "—".to_owned() }
        });
        values.chain(counts).chain(numbers).collect()
    };
    let caption = "Runs of each combination: the share that meets its expectations with its 95 % interval, runs with \
        contacts, medians and other quantiles of those that have the number; one that never settles settles later than all others";
    ReportTable { caption: caption.to_owned(), head, rows: cells.iter().map(row).collect(), words: false }
}

/// What `echelon run` needs to make a run again.
fn again(experiment: &Experiment, row: &RunRow) -> String {
    let scene = quoted(&experiment.study().scene);
    let overrides = experiment.overrides(&row.point).unwrap_or_default();
    let set: Vec<String> =
        overrides.iter().map(|change| format!("--set {}", quoted(&change.to_string()))).collect();
    format!("echelon run {scene} {}", set.join(" "))
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-=/:+,".contains(c);
    if word.chars().all(plain) { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

/// What became of a run.
pub(super) fn worst_line(row: &RunRow) -> String {
    let when = if row.failed_time.is_nan() { String::new() } else { format!(" at {:.2} s", row.failed_time) };
    let what = if row.failed.is_empty() { row.status.word() } else { &row.failed };
    format!("Run {}: {what}{when}; {}", row.point.index, row.reason)
}

/// The tables of a report.
pub(super) fn tables(experiment: &Experiment, summary: &StudySummary) -> Vec<ReportTable> {
    let mut tables = vec![];
    let first = &summary.cells[..summary.cells.len().min(MOST_REPORTED)];
    let mut table = cells(experiment, first);
    if first.len() < summary.cells.len() {
        let _ = write!(
            table.caption,
            "; the first {} of {}, all are in summary.csv",
            first.len(),
            summary.cells.len()
        );
    }
    tables.push(table);
    if !summary.by_failure.is_empty() {
        let rows =
            summary.by_failure.iter().map(|(key, count)| vec![key.clone(), count.to_string()]).collect();
        let caption = "What was not met first".to_owned();
        let head = vec!["expectation".to_owned(), "runs".to_owned()];
        tables.push(ReportTable { caption, head, rows, words: false });
    }
    let unmet: Vec<&RunRow> = summary.worst.iter().filter(|row| !row.met).collect();
    if !unmet.is_empty() {
        let rows = unmet.iter().map(|row| vec![worst_line(row), again(experiment, row)]).collect();
        let caption = "The worst runs, and how each is made again".to_owned();
        let head = vec!["run".to_owned(), "command".to_owned()];
        tables.push(ReportTable { caption, head, rows, words: true });
    }
    tables
}

/// A field of a CSV file.
pub(super) fn field(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// `summary.csv`.
pub(super) fn csv(experiment: &Experiment, summary: &StudySummary) -> String {
    let parameters = &experiment.study().parameters;
    let mut text = String::from("cell");
    for parameter in parameters {
        let _ = write!(text, ",{}", field(&parameter.key));
    }
    text.push_str(",runs,met,share,share_low,share_high,with_contacts");
    for measure in &MEASURES {
        for share in ["p05", "p50", "p95"] {
            let _ = write!(text, ",{}_{share}", measure.column);
        }
    }
    text.push('\n');
    for cell in &summary.cells {
        let _ = write!(text, "{}", cell.cell);
        for value in &cell.values {
            let _ = write!(text, ",{}", field(value.trim_matches('"')));
        }
        let [low, high] = cell.interval;
        let _ =
            write!(text, ",{},{},{},{low},{high},{}", cell.runs, cell.met, cell.share, cell.with_contacts);
        for value in cell.quantiles.iter().flatten() {
            let _ = if value.is_finite() { write!(text, ",{value}") } else { write!(text, ",") };
        }
        text.push('\n');
    }
    text
}

/// What was made just now.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SweepEffort {
    /// Runs.
    pub(super) runs: u64,
    /// How long they took together, s of wall time.
    pub(super) wall: f64,
}

/// The result.
pub(super) fn study(
    experiment: &Experiment,
    summary: &StudySummary,
    folder: &Path,
    effort: &SweepEffort,
    args: &ShownArgs,
    more: &[(&str, Value)],
) {
    if args.json {
        let worst: Vec<_> = summary
            .worst
            .iter()
            .filter(|row| !row.met)
            .map(|row| {
                json!({
                    "index": row.point.index, "status": row.status, "failed": row.failed, "reason": row.reason,
                    "digest": row.digest, "again": again(experiment, row),
                })
            })
            .collect();
        let mut told = json!({
            "folder": folder.display().to_string(), "fingerprint": experiment.fingerprint(), "summary": summary,
            "measures": MEASURES.iter().map(|measure| measure.column).collect::<Vec<_>>(),
            "worst": worst, "made": effort.runs, "wall_seconds": effort.wall,
        });
        for (key, value) in more {
            told[*key] = value.clone();
        }
        json(&told);
        return;
    }
    if args.quiet {
        return;
    }
    say(&format!("{}\n{}\n", experiment.study().title, lead(experiment, summary)));
    let shown = &summary.cells[..summary.cells.len().min(MOST_CELLS)];
    let table = cells(experiment, shown);
    let widths: Vec<usize> = (0..table.head.len())
        .map(|k| {
            let cells = table.rows.iter().map(|row| &row[k]).chain([&table.head[k]]);
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        })
        .collect();
    let line = |row: &Vec<String>| {
        let cells: Vec<String> =
            row.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}")).collect();
        cells.join("  ")
    };
    say(&line(&table.head));
    table.rows.iter().for_each(|row| say(&line(row)));
    if summary.cells.len() > shown.len() {
        say(&format!("… {} in all", counted(summary.cells.len(), "cell")));
    }
    for (key, count) in &summary.by_failure {
        say(&format!("\nnot met first: {key} in {}", counted(*count, "run")));
    }
    for row in summary.worst.iter().filter(|row| !row.met).take(MOST_WORST) {
        say(&format!("\n{}\n    {}", worst_line(row), again(experiment, row)));
    }
    let SweepEffort { runs, wall } = *effort;
    let speed = if runs == 0 {
        String::new()
    } else {
        format!(
            "; {} made in {wall:.1} s, {:.0} a second",
            counted(runs, "run"),
            runs as f64 / wall.max(1e-9)
        )
    };
    say(&format!("\n{}: rows in runs.parquet, report.html{speed}", folder.display()));
}
