//! A comparison as tables for people.

use crate::print::say;
use studies::budget::{Budget, BudgetCase, EdgeErrors, Growth, MeasuredRun, ObserverChoice, SensingLevel};
use vocabulary::counted;

/// Edges that are listed, at most.
const MOST_EDGES: usize = 12;

pub(crate) fn print(budget: &Budget<'_>) {
    say(&format!("{}\n{}", budget.scene.title, studies::caption(budget.scene)));
    say(&format!(
        "seed {}, errors are root mean squares from {} s on",
        budget.scene.seed, budget.settled_after
    ));
    match &budget.camera {
        Ok(adapter) => say(&format!("cameras drawn with {adapter}")),
        Err(why) => say(why),
    }
    for index in 0..budget.fleet.edges.len().min(MOST_EDGES) {
        let [leader, follower] = budget.edge(index);
        say(&format!("\n{leader} → {follower}"));
        if budget.constants { constants(budget, index) } else { levels(budget, index) }
    }
    if budget.fleet.edges.len() > MOST_EDGES {
        let more = budget.fleet.edges.len() - MOST_EDGES;
        say(&format!("\n… and {more} more edges, all in what --json prints and -o writes"));
    }
    say("");
    for (case, run) in &budget.runs {
        trouble(budget, case, run);
    }
    if !budget.constants {
        say(
            "measurements: those used; told: what the law was told; tracking: set point minus truth; refused: not believed, or \
             ambiguous",
        );
    }
}

/// What went wrong in a run, in a line.
fn trouble(budget: &Budget<'_>, case: &BudgetCase, run: &MeasuredRun) {
    let name = format!("{}, {}", case.level.name(), case.observer.name());
    if run.contacts > 0 {
        say(&format!("{name}: {}", counted(run.contacts, "contact")));
    }
    if run.duration + 1.5 * budget.scene.time.period < budget.scene.time.duration {
        say(&format!("{name}: ended at {:.2} s with a contact", run.duration));
    }
}

fn degrees(value: f64) -> String {
    format!("{:.3}", value.to_degrees())
}

/// Distance in mm and angles in degrees; a dash where there is nothing.
fn three(values: Option<[f64; 3]>) -> String {
    values.map_or_else(
        || format!("{:>8} {:>7} {:>7}", "-", "-", "-"),
        |[l, p, g]| format!("{:>8.2} {:>7} {:>7}", l * 1e3, degrees(p), degrees(g)),
    )
}

fn percent(share: Option<f64>, decimals: usize) -> String {
    share.map_or_else(|| "-".to_owned(), |s| format!("{:.decimals$}", s * 100.0))
}

fn levels(budget: &Budget<'_>, index: usize) {
    say(&format!(
        "{:17} {:9} {:>32}  {:>24}  {:>16} {:>7} {:>7}",
        "", "", "measurements", "told", "tracking", "in view", "refused"
    ));
    say(&format!(
        "{:17} {:9} {:>8} {:>7} {:>7} {:>7}  {:>8} {:>7} {:>7}  {:>8} {:>7} {:>7}",
        "sensing", "observer", "ℓ mm", "ψ °", "γ °", "ℓ %", "ℓ mm", "ψ °", "γ °", "ℓ mm", "ψ °", "%"
    ));
    for (case, run) in &budget.runs {
        let Some(edge) = run.edges.get(index) else { continue };
        let observer = if case.level == SensingLevel::Truth { "-".to_owned() } else { case.observer.name() };
        say(&format!(
            "{:17} {observer:9} {} {:>7}  {}  {:>8.2} {:>7} {:>7} {:>7}",
            case.level.name(),
            three(edge.measurements),
            percent(edge.measurements_relative, 3),
            three(if case.level == SensingLevel::Truth { None } else { edge.told }),
            edge.tracking[0] * 1e3,
            degrees(edge.tracking[1]),
            percent(edge.in_view, 1),
            if edge.taken > 0 { edge.refused.to_string() } else { "-".to_owned() },
        ));
    }
    growth(budget, index);
    let (each, all) = budget.camera_as_pixels(index);
    if budget.run(SensingLevel::Camera, ObserverChoice::HighGain).is_some() {
        let tried = budget.pixels();
        let one = |noise: Option<f64>| noise.map_or_else(|| "outside".to_owned(), |n| format!("{n:.3} px"));
        let [l, p, g] = each.map(one);
        say(&format!(
            "the camera's measurements err as corners do with {} (by ℓ {l}, by ψ {p}, by γ {g}; tried {} to {} px)",
            one(all),
            tried.first().copied().unwrap_or_default(),
            tried.last().copied().unwrap_or_default()
        ));
    }
}

/// How errors grow with the noise of corners.
fn growth(budget: &Budget<'_>, index: usize) {
    let fit = |observer: ObserverChoice, value: &dyn Fn(&EdgeErrors) -> Option<f64>| {
        Growth::fit(&budget.curve(index, observer, value))
    };
    let one = |fit: Option<Growth>, scale: f64, unit: &str| {
        fit.map_or_else(
            || "-".to_owned(),
            |g| format!("{:.3} {unit} ⊕ {:.3} {unit}/px", g.floor * scale, g.slope * scale),
        )
    };
    let angle = 1_f64.to_degrees();
    let triple = |value: fn(&EdgeErrors) -> Option<[f64; 3]>| {
        [0, 1, 2].map(|c| fit(ObserverChoice::HighGain, &|m| Some(value(m)?[c])))
    };
    let rows: [(&str, ObserverChoice, [Option<Growth>; 3]); 4] = [
        ("measurements", ObserverChoice::HighGain, triple(|m| m.measurements)),
        ("told", ObserverChoice::HighGain, triple(|m| m.told)),
        ("tracking", ObserverChoice::HighGain, tracking(&fit, ObserverChoice::HighGain)),
        ("tracking", ObserverChoice::Unscented, tracking(&fit, ObserverChoice::Unscented)),
    ];
    if rows.iter().all(|(.., fits)| fits.iter().all(Option::is_none)) {
        return;
    }
    say("error = floor ⊕ slope · pixels (⊕: root of the sum of squares)");
    for (what, observer, [l, p, g]) in rows {
        let observer = if what == "measurements" { String::new() } else { observer.name() };
        let (l, p) = (one(l, 1e3, "mm"), one(p, angle, "°"));
        let g = if what == "tracking" { String::new() } else { format!("γ {}", one(g, angle, "°")) };
        say(format!("  {what:12} {observer:9}  ℓ {l:28}  ψ {p:26}  {g}").trim_end());
    }
}

/// How a measure of an observer's runs grows with the noise of the corners.
type Fit<'a> = dyn Fn(ObserverChoice, &dyn Fn(&EdgeErrors) -> Option<f64>) -> Option<Growth> + 'a;

fn tracking(fit: &Fit<'_>, observer: ObserverChoice) -> [Option<Growth>; 3] {
    [fit(observer, &|m| Some(m.tracking[0])), fit(observer, &|m| Some(m.tracking[1])), None]
}

fn constants(budget: &Budget<'_>, index: usize) {
    say(&format!(
        "{:12} {:>16}  {:>18}  {:>18} {:>9} {:>7} {:>7}",
        "", "tracking", "told", "error of rates", "limited", "refused", "lost"
    ));
    say(&format!(
        "{:12} {:>8} {:>7}  {:>9} {:>8}  {:>9} {:>8} {:>9} {:>7} {:>7}",
        "observer", "ℓ mm", "ψ °", "ℓ mm", "ψ °", "ℓ mm/s", "ψ °/s", "%", "", "%"
    ));
    for (case, run) in &budget.runs {
        let Some(edge) = run.edges.get(index) else { continue };
        let told = edge.told.map_or_else(
            || format!("{:>9} {:>8}", "-", "-"),
            |[l, p, _]| format!("{:>9.2} {:>8}", l * 1e3, degrees(p)),
        );
        say(&format!(
            "{:12} {:>8.2} {:>7}  {told}  {:>9.2} {:>8} {:>9} {:>7} {:>7}",
            case.observer.name(),
            edge.tracking[0] * 1e3,
            degrees(edge.tracking[1]),
            edge.rate_error[0] * 1e3,
            degrees(edge.rate_error[1]),
            percent(Some(edge.limited), 1),
            edge.refused,
            percent(Some(edge.lost), 1),
        ));
    }
}
