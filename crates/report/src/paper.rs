//! The figures of section 5 of Orqueda, Zhang and Fierro (2007), by their numbers.

use crate::claim::{ClaimSubject, Compared, FigureClaim, no_contact, takes_up};
use crate::draw::{farthest, graph, trajectories};
use crate::figure::{Report, ReportFigure};
use crate::laws::LawComparison;
use crate::planned_run::{COMPARED, CONSTANTS, Case, FinishedRun, find, plain};
use crate::tables;
use crate::trace::Trace;
use crate::variant::Variant;
use vocabulary::LawKind;

/// Edge of follower 1, whom the paper's figures show.
const FOLLOWER: usize = 0;
/// What is magnified of the start, s.
const START: f64 = 0.5;

/// Name of a figure's files.
pub(crate) fn stem(number: u32) -> String {
    format!("figure-{number:02}")
}

/// All figures but the drawn ones, 13 and 14, of the runs of [`crate::paper_runs`]; figures whose runs are missing are
/// left out.
pub fn paper(runs: &[FinishedRun]) -> Report {
    let mut items = vec![];
    let cases = [(Case::Line, 3, "straight line"), (Case::Circle, 8, "circular path")];
    for (case, first, words) in cases {
        items.extend(case_items(runs, case, first, words));
    }
    let seven = find(runs, Case::Seven, Variant::epsilon(COMPARED[1]));
    items.extend(seven.map(formation));
    Report {
        title: "An output feedback formation controller, run again".to_owned(),
        lead: "Figures 3 to 15 of Orqueda, Zhang and Fierro, An output feedback nonlinear decentralized controller for \
               unmanned vehicle co-ordination (2007), made anew from simulations of the same equations. Every sentence \
               about a figure is held against the runs behind it."
            .to_owned(),
        items,
        tables: vec![
            tables::laws(runs, &[Case::Line, Case::Circle], FOLLOWER),
            tables::digests(runs),
        ],
        ..Report::default()
    }
}

fn case_items(runs: &[FinishedRun], case: Case, first: u32, words: &str) -> Vec<ReportFigure> {
    let of = |variant: Variant| find(runs, case, variant);
    let output = Variant::epsilon(COMPARED[1]);
    let (Some(full), Some(robust), Some(observed), Some(slow)) = (
        of(Variant::law(LawKind::FullState)),
        of(Variant::law(LawKind::RobustState)),
        of(output),
        of(Variant::epsilon(COMPARED[0])),
    ) else {
        return vec![];
    };
    let [large, small] = COMPARED.map(|epsilon| format!("ε = {}", plain(epsilon)));
    let laws: &Compared<'_> = &[("FSFB", full), ("RSFB", robust), ("OFB", observed)];
    let constants: &Compared<'_> = &[(&large, slow), (&small, observed)];
    let about = |runs| LawComparison { runs, edge: FOLLOWER, start: START, of: words };
    vec![
        ways(&stem(first), observed, words),
        about(laws).laws_inputs(&stem(first + 1)),
        about(laws).laws_errors(&stem(first + 2)),
        about(constants).constants_inputs(&stem(first + 3)),
        about(constants).constants_errors(&stem(first + 4)),
    ]
}

/// Trajectories, with the claim that the formation is taken up.
pub(crate) fn ways(stem: &str, run: &Trace, words: &str) -> ReportFigure {
    let (drawn, factor) = trajectories(run);
    let size =
        if factor == 1.0 { String::new() } else { format!(", drawn {factor} times as large as they are") };
    let caption =
        format!("Trajectories, {words}: robots at marked times{size}, thin lines from leaders to followers.");
    drawn.item(stem, caption).with(takes_up(stem, run))
}

/// Figure 15: the graph, and the claim that the robots reach its places.
fn formation(run: &Trace) -> ReportFigure {
    let stem = stem(15);
    let drawn = graph(run, run.scene.time.duration);
    let caption = "Edge specification of the simulation of figure 14: an arrow from each leader to its follower with the \
                   wanted distance and bearing; places follow from the specifications.";
    drawn.item(&stem, caption).with(vec![stands_so(&stem, run)])
}

/// At the end every robot is where the set points of the edges above it place it.
pub(crate) fn stands_so(stem: &str, run: &Trace) -> FigureClaim {
    let last = run.times.len().saturating_sub(1);
    let off = farthest(run, last).unwrap_or(f64::NAN);
    let depth = depth(run);
    let limit = run.metrics.settling_band[0] * depth.max(1) as f64;
    let claim = "At the end the robots stand as the graph says, seen from their lead robot.";
    let quantity = "largest distance of a robot from its place";
    let subject = ClaimSubject::new(stem, claim, quantity, "m");
    FigureClaim::at_most(subject, &[("largest", off)], limit)
}

/// Edges on the longest way from a lead robot.
fn depth(run: &Trace) -> usize {
    let mut depths = vec![0; run.fleet.robots.len()];
    for _ in 0..run.fleet.robots.len() {
        for edge in &run.fleet.edges {
            let above = depths.get(edge.leader).copied().unwrap_or(0);
            if let Some(depth) = depths.get_mut(edge.follower) {
                *depth = (*depth).max(above + 1);
            }
        }
    }
    depths.into_iter().max().unwrap_or(0)
}

/// The claims of figures 13 and 14.
pub(crate) fn drawn_claims(stem: &str, run: &Trace) -> Vec<FigureClaim> {
    let mut claims = takes_up(stem, run);
    claims.push(no_contact(stem, run));
    claims
}

/// All observer constants that ran, for tables.
pub(crate) fn constants() -> impl Iterator<Item = Variant> {
    CONSTANTS.into_iter().map(Variant::epsilon)
}
