//! What the theorems say of the follower that is chosen, so far, over the curves they speak of.

use super::nothing;
use crate::action::Action;
use crate::desk::Desk;
use crate::panels::curves;
use crate::quantities::Quantity;
use eframe::egui::{RichText, Ui};
use studies::certify::{Finding, Outcome, Premise, so_far};

/// Moments that are looked at, at most.
const MOST: usize = 2000;

/// Statements, then curves.
pub fn show(ui: &mut Ui, desk: &Desk, out: &mut Vec<Action>) {
    let Some(findings) = findings(desk) else { return nothing(ui, "Nobody follows anybody.") };
    ui.horizontal_wrapped(|ui| {
        for finding in &findings {
            let mark = match finding.outcome() {
                Outcome::Holds => "✓",
                Outcome::Violated(_) => "✗",
                Outcome::PremiseNotMet => "–",
            };
            let text = RichText::new(format!("{mark} {}", finding.statement.source())).small();
            ui.label(text).on_hover_text(words(finding));
        }
    });
    curves::show(ui, desk, &[Quantity::RobustMargin, Quantity::Lyapunov], out);
}

/// What the theorems say of the follower that is chosen, or else of the first.
fn findings(desk: &Desk) -> Option<Vec<Finding>> {
    let (history, scene) = (desk.history.as_ref()?, desk.scene_now()?);
    let chosen = desk.chosen_robot();
    let edges = &history.fleet().edges;
    let index = edges.iter().position(|edge| Some(edge.follower) == chosen).unwrap_or(0);
    let (edge, (_, _, follow)) = (*edges.get(index)?, desk.follower(index)?);
    let records = history.between(desk.branch, [0.0, f64::INFINITY], MOST);
    Some(so_far(&records, index, edge, follow, scene).0)
}

/// A finding in words.
fn words(finding: &Finding) -> String {
    let outcome = match (finding.outcome(), finding.against) {
        (Outcome::Holds, _) => "holds so far".to_owned(),
        (Outcome::Violated(from), Some(spell)) => {
            format!("violated from {from:.2} s, last at {:.2} s", spell.last)
        }
        (Outcome::Violated(from), None) => format!("violated from {from:.2} s"),
        (Outcome::PremiseNotMet, _) => {
            let reasons: Vec<String> = finding.unmet.iter().map(Premise::words).collect();
            format!("premise not met:\n{}", reasons.join("\n"))
        }
    };
    format!("{} ({})\n{outcome}", finding.statement.words(), finding.statement.source())
}
