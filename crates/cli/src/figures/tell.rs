//! What the command prints: what was made, and above all what is not so.

use super::FiguresArgs;
use super::folder::{Folder, found};
use super::meter::films;
use crate::print::{json, say};
use report::{FinishedRun, Report};
use serde_json::json;
use vocabulary::counted;

pub(super) fn tell(args: &FiguresArgs, report: &Report, runs: &[FinishedRun], folder: &Folder, wall: f64) {
    if args.json {
        let mut value = serde_json::Value::Object(found(report, runs));
        value["folder"] = json!(folder.path().display().to_string());
        value["wall_seconds"] = json!(wall);
        return json(&value);
    }
    if args.quiet {
        return;
    }
    let (claims, holding) = (report.claims().count(), report.claims().filter(|c| c.holds).count());
    if claims > 0 {
        say(&format!("{holding} of {} about the figures hold", counted(claims, "statement")));
    }
    for claim in report.claims().filter(|claim| !claim.holds) {
        say(&format!("NOT SO  {}: {}", claim.figure, claim.claim));
        let found = claim.found();
        let colon = if found.is_empty() { "" } else { ": " };
        say(&format!("        {}{colon}{found}", claim.quantity));
    }
    for text in &report.left_out {
        say(&format!("left out: {text}"));
    }
    let films = films(report.films.len());
    let runs = if runs.len() == 1 { "a run".to_owned() } else { format!("{} runs", runs.len()) };
    say(&format!("{}{films} and a report of {runs}, in {wall:.1} s", counted(report.items.len(), "figure")));
    say(&folder.path().join("report.html").display().to_string());
}
