//! The same figures for any scene: what it can show, and what was left out.

use crate::claim::FigureClaim;
use crate::draw::{EdgeCurve, Magnify, errors, graph, inputs, observer};
use crate::figure::{Report, ReportFigure};
use crate::laws::LawComparison;
use crate::paper::{stands_so, ways};
use crate::planned_run::{Case, FinishedRun, constants, find, plain};
use crate::tables;
use crate::trace::Trace;
use crate::variant::{LAWS, Variant, constants_apart, laws_apart, short};
use crate::words::round;
use scene::{Role, Scene};
use studies::verdict::verdict;

/// All figures but the drawn one of the runs of [`crate::scene_runs`].
pub fn of_scene(scene: &Scene, runs: &[FinishedRun]) -> Report {
    let Some(run) = find(runs, Case::Own, Variant::default()) else { return Report::default() };
    let mut report = Report {
        title: scene.title.clone(),
        lead: scene.description.trim().to_owned(),
        tables: vec![tables::edges(run), tables::digests(runs)],
        ..Report::default()
    };
    // The claims of a scene are its own expectations.
    let mut first = ways("trajectories", run, &scene.title);
    first.claims = expectations(run);
    report.items.push(first);
    if run.fleet.edges.is_empty() {
        report.left_out.push("Inputs, errors, comparisons and graph: nobody follows.".to_owned());
        return report;
    }
    let crowd = if run.fleet.edges.len() < crate::draw::NAMED {
        ""
    } else {
        " By name: the followers with the largest and the smallest error that stays; pale: all others."
    };
    let caption = format!("Inputs of all followers. Grey: beyond the bounds.{crowd}");
    report.items.push(inputs(&EdgeCurve::all(run), Magnify::Start).item("inputs", caption));
    let caption = format!("Tracking errors of all followers.{crowd}");
    report.items.push(errors(&EdgeCurve::all(run), Magnify::No).item("errors", caption));
    report.items.extend(observed(run));
    comparisons(scene, runs, &mut report);
    let caption = "Formation graph at the end: an arrow from each leader to its follower; places follow from the wanted \
                   distances and bearings.";
    let claims = vec![stands_so("graph", run)];
    // In a turn, or where set points move, followers do not have their leader's heading.
    let claims = if straight(run) { claims } else { vec![] };
    report.items.push(graph(run, scene.time.duration).item("graph", caption).with(claims));
    report
}

/// Whether all robots head the same way at the end.
fn straight(run: &Trace) -> bool {
    let mut headings = run.robots.iter().filter_map(|motions| Some(motions.last()?.pose.heading));
    let Some(first) = headings.next() else { return false };
    headings.all(|heading| vocabulary::wrap(heading - first).abs() < 0.01)
}

/// True and estimated rates of the follower by output feedback whose error stays largest.
fn observed(run: &Trace) -> Option<ReportFigure> {
    let observes = |edge: &usize| {
        let robot = run.fleet.edges.get(*edge).and_then(|e| run.scene.robots.get(e.follower));
        matches!(robot.map(|r| &r.role), Some(Role::Follow(f)) if f.law.observes())
    };
    let settled = |edge: &usize| run.settled(*edge).unwrap_or(0.0);
    let edges = (0..run.fleet.edges.len()).filter(|edge| run.follows(*edge)).filter(observes);
    let edge = edges.max_by(|a, b| settled(a).total_cmp(&settled(b)).then(b.cmp(a)))?;
    let caption = format!(
        "What the observer of {} makes of the rates of distance and bearing, beside the true ones; below, the size of the \
         difference.",
        run.follower(edge)
    );
    Some(observer(run, edge, Magnify::Start).item("observer", caption))
}

fn comparisons(scene: &Scene, runs: &[FinishedRun], report: &mut Report) {
    let start = round(scene.time.duration / 30.0);
    if let Some(why) = laws_apart(scene) {
        report.left_out.push(format!("The three laws compared: {why}."));
    } else {
        let all = LAWS.iter().filter_map(|k| Some((short(*k), find(runs, Case::Own, Variant::law(*k))?)));
        let all: Vec<(&str, &Trace)> = all.collect();
        let about = LawComparison { runs: &all, edge: compared(&all), start, of: &scene.title };
        report.items.extend([about.laws_inputs("laws-inputs"), about.laws_errors("laws-errors")]);
    }
    if let Some(why) = constants_apart(scene) {
        report.left_out.push(format!("Observer constants ε compared: {why}."));
    } else {
        let named = |e: f64| Some((format!("ε = {}", plain(e)), find(runs, Case::Own, Variant::epsilon(e))?));
        let names: Vec<(String, &Trace)> = constants(scene).into_iter().filter_map(named).collect();
        let all: Vec<(&str, &Trace)> = names.iter().map(|(name, run)| (name.as_str(), *run)).collect();
        let about = LawComparison { runs: &all, edge: compared(&all), start, of: &scene.title };
        let items = [about.constants_inputs("constants-inputs"), about.constants_errors("constants-errors")];
        report.items.extend(items);
    }
}

/// The first edge whose follower follows at the end of all runs.
fn compared(runs: &[(&str, &Trace)]) -> usize {
    let edges = runs.first().map_or(0, |(_, run)| run.fleet.edges.len());
    (0..edges).find(|edge| runs.iter().all(|(_, run)| run.follows(*edge))).unwrap_or(0)
}

/// What the scene expects of its run, as claims without numbers of their own.
fn expectations(run: &Trace) -> Vec<FigureClaim> {
    let completed = run.times.last().is_some_and(|t| t + run.scene.time.period > run.scene.time.duration);
    verdict(&run.scene, &run.metrics, completed)
        .into_iter()
        .filter(|finding| finding.met.is_some())
        .map(|finding| FigureClaim {
            figure: "trajectories".to_owned(),
            claim: format!("The scene expects {} {}.", finding.key, finding.wanted),
            quantity: format!("found {}", finding.found),
            values: vec![],
            wanted: finding.wanted,
            holds: finding.met == Some(true),
            limit: None,
        })
        .collect()
}
