//! `echelon diff`: are two recorded runs the same, and where do they part?

use crate::args::within;
use crate::failure::Failure;
use crate::print::{json, say};
use crate::progress::Progress;
use crate::recorded::Recorded;
use crate::{Outcome, interrupt};
use clap::Args;
use recording::log::{Comparison, compare};
use serde_json::{Value, json};
use std::path::PathBuf;
use studies::STRIDE;
use studies::diff::differing_keys;
use vocabulary::counted;

#[derive(Debug, Args)]
pub(crate) struct DiffArgs {
    /// Run folder or log.mcap
    #[arg(value_name = "A")]
    a: PathBuf,
    /// Run folder or log.mcap to compare with
    #[arg(value_name = "B")]
    b: PathBuf,
    /// Absolute tolerance for numbers, in their units; words and flags have to be equal
    #[arg(long, value_name = "NUMBER", default_value_t = 0.0, value_parser = within(0.0..=f64::MAX, "write a number from 0 on, such as 1e-9"))]
    tolerance: f64,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    /// Print errors only; the exit code is the result
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

/// What two runs have and have not in common.
struct Diff {
    names: [String; 2],
    /// Keys of the resolved scenes that differ, with both values; `None` where a run has no scene.
    keys: Option<Vec<(String, [String; 2])>>,
    /// Which runs have none.
    bare: [bool; 2],
    /// Robots and edges, where they are not the same.
    casts: Option<[String; 2]>,
    digests: [Option<String>; 2],
    /// Of the moments, where both have logs and the same robots.
    records: Option<Comparison>,
}

pub(crate) fn diff(args: &DiffArgs) -> Outcome {
    let [a, b] = [Recorded::open(&args.a)?, Recorded::open(&args.b)?];
    for run in [&a, &b] {
        run.needs_the_start("a comparison")?;
    }
    let names = [&a, &b].map(|run| run.path.display().to_string());
    let who = [&a, &b].map(|run| (run.manifest.robots.clone(), run.manifest.edges.clone()));
    let casts = (who[0] != who[1]).then(|| who.map(|(robots, edges)| told(&robots, &edges)));
    // Others' logs may hold no scene.
    let bare = [&a, &b].map(|run| run.scene.1.is_empty());
    let keys = (bare == [false; 2]).then(|| keys(&a, &b));
    let digests = [&a, &b].map(|run| run.manifest.digest.clone());
    let records = match (a.records(), b.records()) {
        (Some(left), Some(right)) if casts.is_none() => {
            let steps = a.manifest.samples.max(b.manifest.samples);
            let what = format!("Comparing {} with {}", names[0], names[1]);
            let progress = Progress::begin(&what, steps, args.quiet || args.json);
            let found = compare([left, right], args.tolerance, |sample| {
                if sample % STRIDE == 0 {
                    progress.at(sample);
                }
                !interrupt::asked()
            })?;
            drop(progress);
            if interrupt::asked() {
                return Err(Failure::Interrupted(format!("after {}", counted(found.samples, "sample"))));
            }
            Some(found)
        }
        _ => None,
    };
    // Without logs, digests tell whether, but not where.
    if records.is_none() && casts.is_none() && (digests[0].is_none() || digests[1].is_none()) {
        a.log()?;
        b.log()?;
    }
    let diff = Diff { names, keys, bare, casts, digests, records };
    if args.json {
        diff.as_json();
    } else if !args.quiet {
        diff.as_text();
    }
    if diff.same() { Ok(()) } else { Err(Failure::Expectation) }
}

fn told(robots: &[String], edges: &[[String; 2]]) -> String {
    let edges: Vec<String> =
        edges.iter().map(|[leader, follower]| format!("{leader} → {follower}")).collect();
    let (some, all) = (counted(robots.len(), "robot"), counted(edges.len(), "edge"));
    format!("{some}: {}; {all}: {}", robots.join(", "), edges.join(", "))
}

/// Keys of the resolved scenes that differ; one that cannot be read here is compared as a whole.
fn keys(a: &Recorded, b: &Recorded) -> Vec<(String, [String; 2])> {
    if a.scene.1 == b.scene.1 {
        return vec![];
    }
    let trees = [a, b].map(|run| run.scene().ok().and_then(|scene| serde_json::to_value(scene).ok()));
    let [Some(left), Some(right)] = trees else {
        return vec![("scene.toml".to_owned(), ["one text".to_owned(), "another".to_owned()])];
    };
    let text = |value: Option<String>| value.unwrap_or_else(|| "not there".to_owned());
    differing_keys([&left, &right]).into_iter().map(|found| (found.key, found.values.map(text))).collect()
}

/// A field's name without its unit, and the unit.
fn unit(field: &str) -> (String, &'static str) {
    let units = [
        ("_rad_s", "rad/s"),
        ("_m_s2", "m/s²"),
        ("_m_s", "m/s"),
        ("_n_s", "N s"),
        ("_rad", "rad"),
        ("_px", "px"),
        ("_m", "m"),
        ("_s", "s"),
    ];
    let found = units.iter().find_map(|(end, unit)| field.strip_suffix(end).map(|name| (name, *unit)));
    let (name, unit) = found.unwrap_or((field, ""));
    (name.replace('_', " "), unit)
}

impl Diff {
    fn same(&self) -> bool {
        self.casts.is_none()
            && match &self.records {
                Some(found) => found.same(),
                None => self.digests[0].is_some() && self.digests[0] == self.digests[1],
            }
    }

    fn as_text(&self) {
        let [a, b] = &self.names;
        if let Some([left, right]) = &self.casts {
            say(&format!("other robots or edges\n  {a}: {left}\n  {b}: {right}"));
        }
        for name in self.names.iter().zip(self.bare).filter_map(|(name, bare)| bare.then_some(name)) {
            say(&format!("{name}: the log has no scene to compare"));
        }
        if let Some(keys) = self.keys.as_ref().filter(|keys| !keys.is_empty()) {
            say(&format!("{} the scene:", differing(keys.len())));
            for (key, [left, right]) in keys.iter().take(20) {
                say(&format!("  {key}: {left} | {right}"));
            }
            if keys.len() > 20 {
                say(&format!("  and {} more; --json lists all", keys.len() - 20));
            }
        }
        match &self.records {
            Some(found) => records(found, self.same(), &self.names),
            None if self.casts.is_some() => say("DIFFERENT"),
            None => {
                let verdict =
                    if self.same() { "same: by their digests" } else { "DIFFERENT: by their digests" };
                say(&format!("{verdict}; there are not two logs to look into"));
            }
        }
    }

    fn as_json(&self) {
        let pair = |[a, b]: &[String; 2]| json!({ "a": a, "b": b });
        let key = |(key, [a, b]): &(String, [String; 2])| json!({ "key": key, "a": a, "b": b });
        let keys = self.keys.as_ref().map(|keys| keys.iter().map(key).collect::<Vec<_>>());
        let finite = |value: f64| if value.is_finite() { json!(value) } else { Value::Null };
        let records = self.records.as_ref().map(|found| {
            let first = found.first.as_ref().map(|first| {
                let (name, unit) = unit(first.quantity);
                json!({
                    "sample": first.sample, "time": first.time, "of": first.of, "quantity": name, "unit": unit,
                    "field": first.quantity, "a": first.values[0], "b": first.values[1],
                })
            });
            let largest = found.peaks.iter().map(|peak| {
                let (name, unit) = unit(peak.quantity);
                json!({
                    "quantity": name, "unit": unit, "field": peak.quantity, "difference": finite(peak.most),
                    "of": peak.of, "time": peak.time,
                })
            });
            json!({
                "samples": found.samples, "differing": found.differing,
                "more": { "a": found.more[0], "b": found.more[1] },
                "first": first, "largest": largest.collect::<Vec<_>>(),
            })
        });
        json(&json!({
            "same": self.same(),
            "runs": pair(&self.names),
            "casts": self.casts.as_ref().map(pair),
            "scene": keys,
            "digests": { "a": self.digests[0], "b": self.digests[1] },
            "records": records,
        }));
    }
}

fn differing(count: usize) -> String {
    if count == 1 { "1 key differs in".to_owned() } else { format!("{count} keys differ in") }
}

/// What became of the moments.
fn records(found: &Comparison, same: bool, names: &[String; 2]) {
    if same {
        let exact = if found.peaks.is_empty() && found.differing == 0 { "same: bit for bit" } else { "same" };
        say(&format!("{exact}, {}", counted(found.samples, "sample")));
        return;
    }
    say(&format!("DIFFERENT in {} of {}", found.differing, counted(found.samples, "sample")));
    for (more, name) in found.more.iter().zip(names).filter(|(more, _)| **more > 0) {
        say(&format!("{name} goes on for {} more", counted(more, "sample")));
    }
    if let Some(first) = &found.first {
        let (name, unit) = unit(first.quantity);
        let [a, b] = &first.values;
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        say(&format!(
            "first at {:.3} s, sample {}: {name} of {}\n  {a}{unit}\n  {b}{unit}",
            first.time, first.sample, first.of
        ));
    }
    if !found.peaks.is_empty() {
        say("largest difference of each quantity");
    }
    for peak in &found.peaks {
        let (name, unit) = unit(peak.quantity);
        let most =
            if peak.most.is_finite() { format!("{:.3e} {unit}", peak.most) } else { "other".to_owned() };
        say(&format!("  {name:<22} {most:<18} {} at {:.3} s", peak.of, peak.time));
    }
}
