//! The numbers of all runs, side by side.

use crate::figure::ReportTable;
use crate::paper::constants;
use crate::planned_run::{Case, FinishedRun, find};
use crate::trace::Trace;
use crate::variant::Variant;
use crate::words::{digits, quantity};
use vocabulary::LawKind;

fn words(first: &[&str], then: &[&str]) -> Vec<String> {
    first.iter().chain(then).map(|word| (*word).to_owned()).collect()
}

/// One follower under all laws and observer constants.
pub(crate) fn laws(runs: &[FinishedRun], cases: &[Case], edge: usize) -> ReportTable {
    let laws = [LawKind::FullState, LawKind::RobustState].map(Variant::law);
    let variants: Vec<Variant> = laws.into_iter().chain(constants()).collect();
    let traces = cases.iter().flat_map(|case| variants.iter().filter_map(|v| find(runs, *case, *v)));
    let transient = runs.first().and_then(|ran| ran.trace.efforts.get(edge)).map_or(0.0, |e| e.transient);
    let first = format!("first {}", quantity(transient, "s"));
    ReportTable {
        words: false,
        caption: format!(
            "Follower 1 under every law and observer constant. Settled: root mean square over the last fifth of the run. \
             Settles: time from which the error stays within the band of the scene. Asked for: before limits, over the {first}."
        ),
        head: words(&["run", "settled distance error", "settled bearing error", "(∫‖e‖² dt)^½"], &COSTS),
        rows: traces.filter_map(|trace| law_row(trace, edge)).collect(),
    }
}

fn law_row(trace: &Trace, edge: usize) -> Option<Vec<String>> {
    let [distance, bearing] = trace.metrics.edges.get(edge)?.late_rms_error;
    let errors = [quantity(distance, "m"), quantity(bearing, "rad")];
    let whole = trace.over_the_run(edge).map_or_else(String::new, digits);
    Some([&[trace.name.clone()][..], &errors, &[whole], &costs(trace, edge)?].concat())
}

/// Names of the cells that [`costs`] makes.
const COSTS: [&str; 4] = ["settles", "peak |dv/dt| asked for", "∫|dv/dt| dt", "∫|ω| dt"];

/// When an edge settles, and what its commands cost.
fn costs(trace: &Trace, edge: usize) -> Option<[String; 4]> {
    let (metrics, effort) = (trace.metrics.edges.get(edge)?, trace.efforts.get(edge)?);
    Some([
        metrics.settling_time.map_or_else(|| "never".to_owned(), |t| quantity(t, "s")),
        quantity(effort.peak_asked[0], "m/s²"),
        quantity(effort.applied[0], "m/s"),
        // Turned in all, not an angle that is small.
        format!("{} rad", digits(effort.applied[1])),
    ])
}

/// Edges that a table lists one by one.
const LISTED: usize = 24;

/// All edges of a run; of many, those whose errors stay largest.
pub(crate) fn edges(run: &Trace) -> ReportTable {
    let mut order: Vec<usize> = (0..run.fleet.edges.len()).collect();
    if order.len() > LISTED {
        order.sort_by(|a, b| run.settled(*b).unwrap_or(0.0).total_cmp(&run.settled(*a).unwrap_or(0.0)));
        order.truncate(LISTED);
    }
    let row = |edge: usize| {
        let metrics = run.metrics.edges.get(edge)?;
        let name = format!("{} → {}", metrics.leader, metrics.follower);
        let errors = [quantity(metrics.final_error[0], "m"), quantity(metrics.final_error[1], "rad")];
        Some([&[name][..], &errors, &costs(run, edge)?].concat())
    };
    ReportTable {
        words: false,
        caption: if run.fleet.edges.len() > LISTED {
            format!("The {LISTED} of {} edges whose errors stay largest.", run.fleet.edges.len())
        } else {
            "All edges.".to_owned()
        },
        head: words(&["edge", "final distance error", "final bearing error"], &COSTS),
        rows: order.into_iter().filter_map(row).collect(),
    }
}

/// Which runs these were, to the last bit.
pub(crate) fn digests(runs: &[FinishedRun]) -> ReportTable {
    let row = |ran: &FinishedRun| {
        let trace = &ran.trace;
        let (length, seed) = (quantity(trace.metrics.duration, "s"), trace.scene.seed.to_string());
        vec![trace.name.clone(), length, seed, trace.digest.clone()]
    };
    ReportTable {
        words: false,
        caption: "Digest of every run: the same scene, seed and build give the same one.".to_owned(),
        head: words(&["run", "length", "seed", "digest"], &[]),
        rows: runs.iter().map(row).collect(),
    }
}
