//! The theorems' statements for the selected follower so far, above their curves.

use super::nothing;
use crate::action::Action;
use crate::app_state::AppState;
use crate::panels::curves;
use crate::quantities::PlotQuantity;
use eframe::egui::{RichText, Ui};
use studies::certify::{Premise, StatementFinding, StatementOutcome, so_far};

/// Maximum number of moments that are checked.
const MOST: usize = 2000;

/// Statements, then curves.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some(findings) = findings(app_state) else { return nothing(ui, "There is no follower.") };
    ui.horizontal_wrapped(|ui| {
        for finding in &findings {
            let mark = match finding.outcome() {
                StatementOutcome::Holds => "✓",
                StatementOutcome::Violated(_) => "✗",
                StatementOutcome::PremiseNotMet => "–",
            };
            let text = RichText::new(format!("{mark} {}", finding.statement.source())).small();
            ui.label(text).on_hover_text(words(finding));
        }
    });
    curves::show(ui, app_state, &[PlotQuantity::RobustMargin, PlotQuantity::Lyapunov], out);
}

/// The theorems' statements for the selected follower, or else for the first.
fn findings(app_state: &AppState) -> Option<Vec<StatementFinding>> {
    let (history, scene) = (app_state.history.as_ref()?, app_state.scene_now()?);
    let chosen = app_state.chosen_robot();
    let edges = &history.fleet().edges;
    let index = edges.iter().position(|edge| Some(edge.follower) == chosen).unwrap_or(0);
    let (edge, (_, _, follow)) = (*edges.get(index)?, app_state.follower(index)?);
    let records = history.between(app_state.branch, [0.0, f64::INFINITY], MOST);
    Some(so_far(&records, index, edge, follow, scene).0)
}

/// A finding in words.
fn words(finding: &StatementFinding) -> String {
    let outcome = match (finding.outcome(), finding.against) {
        (StatementOutcome::Holds, _) => "holds so far".to_owned(),
        (StatementOutcome::Violated(from), Some(spell)) => {
            format!("violated from {from:.2} s, last at {:.2} s", spell.last)
        }
        (StatementOutcome::Violated(from), None) => format!("violated from {from:.2} s"),
        (StatementOutcome::PremiseNotMet, _) => {
            let reasons: Vec<String> = finding.unmet.iter().map(Premise::words).collect();
            format!("premise not met:\n{}", reasons.join("\n"))
        }
    };
    format!("{} ({})\n{outcome}", finding.statement.symbols(), finding.statement.source())
}
