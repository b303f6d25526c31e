//! The benchmark's results as text and as JSON.

use metrics::RootMeanSquare;
use serde_json::{Value, json};
use std::iter;
use studies::accuracy::{AccuracyBin, BINS, STAGES, readable_rms, targets};

/// Titles of the two ways to look, in the order of the times.
const WAYS: [&str; 2] = ["part that is tracked", "whole picture"];

/// Columns of the first table but the first one, and their widths.
const COLUMNS: [(&str, usize); 11] = [
    ("poses", 7),
    ("1 face", 9),
    ("found", 9),
    ("whole", 9),
    ("2 faces", 9),
    ("found", 9),
    ("whole", 9),
    ("wrong", 7),
    ("strayed", 9),
    ("flips", 7),
    ("ambiguous", 11),
];

/// Medians of every stage, ms, for the tracked part and the whole picture.
pub(crate) type Medians = [[Option<f64>; 4]; 2];

/// Everything as lines.
pub(crate) fn text(bins: &[AccuracyBin], times: &Medians) -> Vec<String> {
    let mut lines = vec![row("distance", COLUMNS.iter().map(|(head, _)| (*head).to_owned()))];
    for (bounds, bin) in BINS.iter().zip(bins) {
        let found = (0..2).flat_map(|k| {
            let of = |count: u32| share(count, bin.views[k]);
            [bin.views[k].to_string(), of(bin.seen[k]), of(bin.seen_whole[k])]
        });
        let faults = [bin.wrong, bin.strayed, bin.flips as usize, bin.ambiguous as usize];
        let cells = iter::once(bin.poses.to_string()).chain(found);
        lines.push(row(&metres(bounds), cells.chain(faults.map(|count| count.to_string()))));
    }
    lines.push(String::new());
    lines.push("RMS error of range %, bearing °, heading °".into());
    lines.push(format!(
        "{:<10}{:>5}  {:<20}{:<20}{:<20}{:<9}{:<20}{:>5}  {:<20}",
        "distance", "views", "2 faces or more", "must", "stretch", "", "POSIT alone", "views", "1 face"
    ));
    for (index, (bounds, bin)) in BINS.iter().zip(bins).enumerate() {
        let wanted = targets(index);
        let target = |k: usize| wanted.map_or_else(|| "–".to_owned(), |both| triple(Some(both[k])));
        lines.push(format!(
            "{:<10}{:>5}  {:<20}{:<20}{:<20}{:<9}{:<20}{:>5}  {:<20}",
            metres(bounds),
            bin.refined.count(),
            triple(readable_rms(&bin.refined)),
            target(0),
            target(1),
            verdict(&bin.refined, wanted),
            triple(readable_rms(&bin.raw)),
            bin.single.count(),
            triple(readable_rms(&bin.single))
        ));
    }
    lines.push(String::new());
    let heads = STAGES.map(|stage| format!("{stage:>20}")).concat();
    lines.push(format!("{:<22}{heads}{:>20}", "median ms", "without drawing"));
    for (way, times) in WAYS.iter().zip(times) {
        let cells = times.map(|time| format!("{:>20}", number(time))).concat();
        let rest = times[1..].iter().copied().sum::<Option<f64>>();
        lines.push(format!("{way:<22}{cells}{:>20}", number(rest)));
    }
    lines
}

/// A line of the first table.
fn row(first: &str, cells: impl Iterator<Item = String>) -> String {
    let cells = cells.zip(COLUMNS).map(|(cell, (_, width))| format!("{cell:>width$}"));
    format!("{first:<10}{}", cells.collect::<String>())
}

fn metres([low, high]: &[f64; 2]) -> String {
    format!("{low}–{high} m")
}

fn share(count: u32, of: u32) -> String {
    if of == 0 { "–".into() } else { format!("{:.1} %", 100.0 * f64::from(count) / f64::from(of)) }
}

fn triple(values: Option<[f64; 3]>) -> String {
    values.map_or_else(|| "–".into(), |[a, b, c]| format!("{a:.3} {b:.4} {c:.3}"))
}

fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "–".into(), |v| format!("{v:.2}"))
}

/// What has been reached: nothing yet, not what must be, what must be, or more.
fn verdict(rms: &RootMeanSquare<3>, wanted: Option<[[f64; 3]; 2]>) -> &'static str {
    let (Some(got), Some([must, stretch])) = (readable_rms(rms), wanted) else { return "" };
    let within = |most: [f64; 3]| got.iter().zip(most).all(|(a, b)| *a <= b);
    match (within(stretch), within(must)) {
        (true, _) => "stretch",
        (false, true) => "must",
        (false, false) => "missed",
    }
}

/// Everything for machines.
pub(crate) fn as_json(bins: &[AccuracyBin], times: &Medians) -> Value {
    let rms = |rms: &RootMeanSquare<3>| {
        let values = readable_rms(rms);
        json!({
            "views": rms.count(), "range_percent": values.map(|v| v[0]),
            "bearing_degrees": values.map(|v| v[1]), "heading_degrees": values.map(|v| v[2]),
        })
    };
    let rows: Vec<Value> = BINS
        .iter()
        .zip(bins)
        .enumerate()
        .map(|(index, (bounds, bin))| {
            json!({
                "distance": bounds, "poses": bin.poses,
                "one_face": { "views": bin.views[0], "found": bin.seen[0], "found_whole": bin.seen_whole[0] },
                "two_faces": { "views": bin.views[1], "found": bin.seen[1], "found_whole": bin.seen_whole[1] },
                "wrong": bin.wrong, "strayed": bin.strayed, "flips": bin.flips, "ambiguous": bin.ambiguous,
                "refined": rms(&bin.refined), "raw_posit": rms(&bin.raw), "single": rms(&bin.single),
                "targets": targets(index).map(|[must, stretch]| json!({ "must": must, "stretch": stretch })),
                "verdict": verdict(&bin.refined, targets(index)),
            })
        })
        .collect();
    let stages = |times: &[Option<f64>; 4]| {
        Value::Object(STAGES.iter().zip(times).map(|(s, t)| ((*s).replace(' ', "_"), json!(t))).collect())
    };
    json!({
        "bins": rows,
        "milliseconds": { "tracked": stages(&times[0]), "whole": stages(&times[1]) },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use studies::accuracy::PoseSample;

    fn bin(range: f64) -> AccuracyBin {
        let mut bin = AccuracyBin::default();
        bin.add(&PoseSample {
            distance: 1.5,
            readable: 2,
            seen: 2,
            refined: Some([range, 1e-5, 1e-4]),
            ..PoseSample::default()
        });
        bin
    }

    #[test]
    fn a_verdict_tells_what_was_reached() {
        let wanted = targets(1);
        let of = |range: f64| verdict(&bin(range).refined, wanted);
        assert_eq!([0.0002, 0.0008, 0.002].map(of), ["stretch", "must", "missed"]);
        assert_eq!(verdict(&RootMeanSquare::default(), wanted), "");
        assert_eq!(verdict(&bin(0.0).refined, None), "");
    }

    #[test]
    fn every_bin_has_its_lines_and_its_rows() {
        let bins = vec![bin(0.0002); BINS.len()];
        let times = [[Some(1.0); 4], [None; 4]];
        let lines = text(&bins, &times);
        assert_eq!(lines.iter().filter(|line| line.starts_with("1–2 m")).count(), 2);
        assert!(lines.iter().any(|line| line.contains("100.0 %")), "{lines:#?}");
        let value = as_json(&bins, &times);
        assert_eq!(value["bins"].as_array().map(Vec::len), Some(BINS.len()));
        assert_eq!(value["bins"][1]["verdict"], "stretch");
        assert_eq!(value["milliseconds"]["tracked"]["detect_and_sharpen"], 1.0);
        assert!(value["bins"][5]["targets"].is_null());
    }
}
