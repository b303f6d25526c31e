//! What a run showed, for people and for machines.

use crate::cameras::DrawingCost;
use crate::print::{json, note, say};
use metrics::{EventSummary, JudgedExpectation, Metrics};
use scene::{Role, Scene};
use serde_json::json;
use std::path::PathBuf;
use studies::link::LinkComparison;
use vocabulary::counted;

/// A run that reached its end.
pub(crate) struct Summary<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) metrics: &'a Metrics,
    pub(crate) findings: &'a [JudgedExpectation],
    pub(crate) digest: String,
    /// The run held against the link that led to it.
    pub(crate) linked: Option<LinkComparison>,
    pub(crate) folder: Option<PathBuf>,
    /// s of wall time, simulation and recording.
    pub(crate) wall: f64,
    /// What of it went into the pictures of the robots' cameras.
    pub(crate) drawn: DrawingCost,
    pub(crate) steps: u64,
}

impl Summary<'_> {
    /// Whether no expectation failed, and the run is that of the link.
    pub(crate) fn met(&self) -> bool {
        let differs = self.linked.as_ref().is_some_and(|linked| linked.same() == Some(false));
        !differs && !self.findings.iter().any(JudgedExpectation::failed)
    }
}

/// Edges a summary lists one by one.
const MOST_EDGES: usize = 12;

pub(crate) fn as_text(summary: &Summary<'_>) {
    let Summary { scene, metrics, .. } = summary;
    say(&format!("{}\n{}\n", scene.title, studies::caption(scene)));
    events(metrics);
    edges(scene, metrics);
    plans(scene, metrics);
    if let (Some(clearance), Some(time), Some([a, b])) =
        (metrics.clearance_min, metrics.clearance_min_time, &metrics.clearance_min_robots)
    {
        say(&format!("least clearance {clearance:.3} m, between {a} and {b} at {time:.2} s"));
    }
    measurements(metrics);
    contacts(metrics);
    let speed = metrics.duration / summary.wall.max(1e-9);
    let speed = if speed < 10.0 { format!("{speed:.2}") } else { format!("{speed:.0}") };
    say(&format!("{:.2} s in {}, {speed} times real time", metrics.duration, counted(summary.steps, "step")));
    if summary.drawn.pictures() > 0 {
        let (pictures, seconds) = (summary.drawn.pictures(), summary.drawn.seconds());
        say(&format!(
            "{} of cameras, drawn in {seconds:.1} s of {:.1} s, {:.2} ms each",
            counted(pictures, "picture"),
            summary.wall,
            seconds / pictures as f64 * 1e3
        ));
    }
    say(&format!("digest {}", summary.digest));
    if let Some(linked) = &summary.linked {
        say(&linked.words());
    }
    if let Some(folder) = &summary.folder {
        say(&format!("recorded in {}", folder.display()));
    }
    expectations(summary);
}

/// How well lead robots kept to their plans.
fn plans(scene: &Scene, metrics: &Metrics) {
    let leads = scene.robots.iter().filter(|robot| matches!(robot.role, Role::Lead { .. }));
    for lead in leads {
        let kept = metrics.robots.iter().find(|robot| robot.robot == lead.name).and_then(|robot| robot.plan);
        if let Some(plan) = kept {
            let left = match plan.time_left {
                0.0 => String::new(),
                left => format!("; {left:.1} s of it are left at the end of the run"),
            };
            say(&format!(
                "{} keeps to its plan within {:.3} m, root mean square {:.3} m{left}",
                lead.name, plan.error_max, plan.error_rms
            ));
        }
    }
}

/// Contacts, and robots in trouble, that a summary lists one by one.
const MOST_CONTACTS: usize = 6;

fn contacts(metrics: &Metrics) {
    for contact in metrics.first_contacts.iter().take(MOST_CONTACTS) {
        let ([a, b], [x, y, _]) = (&contact.between, contact.place);
        let (begin, impulse, length) = (contact.begin, contact.impulse, contact.end - contact.begin);
        say(&format!(
            "contact of {a} and {b} at {begin:.2} s, at ({x:.2}, {y:.2}) m: {impulse:.2} N s in {length:.2} s"
        ));
    }
    if metrics.contacts > MOST_CONTACTS {
        say(&format!(
            "… and {} more contacts, all in the table of contacts",
            metrics.contacts - MOST_CONTACTS
        ));
    }
    let unable: Vec<_> = metrics.robots.iter().filter(|robot| robot.condition != "able").collect();
    for robot in unable.iter().take(MOST_CONTACTS) {
        let trouble = match &*robot.condition {
            "failed" => "has failed",
            "removed" => "was taken away",
            other => &format!("is {other}"),
        };
        say(&format!("{} {trouble}", robot.robot));
    }
    if unable.len() > MOST_CONTACTS {
        say(&format!("… and {} more robots that cannot drive", unable.len() - MOST_CONTACTS));
    }
}

/// Events that are listed.
const MOST_EVENTS: usize = 20;

/// What happened to the formation.
fn events(metrics: &Metrics) {
    for event in metrics.events.iter().take(MOST_EVENTS) {
        let EventSummary { time, words, .. } = event;
        say(&format!("{time:>7.2} s  {words}"));
    }
    if metrics.events.len() > MOST_EVENTS {
        say(&format!("… and {} more events, all in metrics.json", metrics.events.len() - MOST_EVENTS));
    }
    if !metrics.events.is_empty() {
        say("");
    }
}

fn edges(scene: &Scene, metrics: &Metrics) {
    if metrics.edges.is_empty() {
        return;
    }
    let width = metrics.edges.iter().map(|e| e.leader.len() + e.follower.len() + 3).max().unwrap_or(0).max(4);
    say(&format!(
        "{:width$}  {:>23}  {:>23}  {:>9}  {:>7}",
        "edge", "final error", "rms error", "settled", "limited"
    ));
    // Edges of robots that join are not left free.
    let free = scene.edges().map(|(_, _, leader)| [leader.distance.is_none(), leader.bearing.is_none()]);
    let free = free.chain(std::iter::repeat([false; 2]));
    let channel = |e: [f64; 2], free: [bool; 2]| {
        let said = |text: String, free: bool| if free { "free".to_owned() } else { text };
        let distance = said(format!("{:.4} m", e[0]), free[0]);
        let bearing = said(format!("{:.3}°", e[1].to_degrees()), free[1]);
        format!("{distance:>12} {bearing:>9}")
    };
    // An edge that was never in force says nothing.
    let edges = metrics.edges.iter().zip(free).filter(|(edge, _)| edge.ended.is_none_or(|end| end > 0.0));
    for (edge, free) in edges.take(MOST_EDGES) {
        let name = format!("{} → {}", edge.leader, edge.follower);
        let settled = match edge.ended {
            Some(time) => format!("to {time:.2} s"),
            None => edge.settling_time.map_or("never".to_owned(), |t| format!("{t:.2} s")),
        };
        let (last, rms) = (channel(edge.final_error, free), channel(edge.rms_error, free));
        let limited = format!("{:.1} %", edge.limited * 100.0);
        say(&format!("{name:width$}  {last:>23}  {rms:>23}  {settled:>9}  {limited:>7}"));
    }
    if metrics.edges.len() > MOST_EDGES {
        say(&format!("… and {} more edges, all in metrics.json", metrics.edges.len() - MOST_EDGES));
    }
    let band = metrics.settling_band;
    say(&format!(
        "limited: samples at which a bound on speed, turn rate or acceleration cut the command\nsettled: within ±{} m and ±{:.2}° to the end\n",
        band[0],
        band[1].to_degrees()
    ));
}

/// How followers with sensors measured their leaders.
fn measurements(metrics: &Metrics) {
    let measurements = || metrics.edges.iter().filter_map(|edge| Some((edge, edge.measurements.as_ref()?)));
    if measurements().next().is_none() {
        return;
    }
    let width = measurements().map(|(e, _)| e.leader.len() + e.follower.len() + 3).max().unwrap_or(0).max(12);
    say(&format!(
        "{:width$}  {:>6}  {:>8}  {:>7}  {:>29}  {:>29}  {:>6}",
        "measurements",
        "taken",
        "in view",
        "refused",
        "rms error (ℓ, ψ, γ)",
        "of what the law was told",
        "gap"
    ));
    let three = |e: Option<[f64; 3]>| {
        let told =
            |e: [f64; 3]| format!("{:>9.4} m {:>7.3}° {:>7.3}°", e[0], e[1].to_degrees(), e[2].to_degrees());
        e.map_or("none".to_owned(), told)
    };
    for (edge, measured) in measurements().take(MOST_EDGES) {
        let name = format!("{} → {}", edge.leader, edge.follower);
        let (errors, told) = (three(measured.rms_error), three(measured.rms_estimate_error));
        let (view, refused) =
            (format!("{:.2} %", measured.in_view * 100.0), measured.rejected + measured.ambiguous);
        say(&format!(
            "{name:width$}  {:>6}  {view:>8}  {refused:>7}  {errors:>29}  {told:>29}  {:>4.2} s",
            measured.taken, measured.longest_gap
        ));
        if measured.lost > 0.0 {
            say(&format!("  {} had lost its leader for {:.2} s", edge.follower, measured.lost));
        }
        if measured.in_view == 0.0 {
            say(&format!("  {} never saw its leader", edge.follower));
        }
    }
    say(
        "refused: too far from the prediction, or explained alike by two poses; gap: longest time without a measurement\n",
    );
}

fn expectations(summary: &Summary<'_>) {
    if summary.findings.is_empty() {
        return;
    }
    say("\nexpectations");
    for finding in summary.findings {
        let mark = match finding.met {
            Some(true) => "met   ",
            Some(false) => "FAILED",
            None => "not judged",
        };
        say(&format!("  {mark} {:22} {}, found {}", finding.key, finding.wanted, finding.found));
    }
}

/// What failed, on standard error.
pub(crate) fn failures(summary: &Summary<'_>) {
    for finding in summary.findings.iter().filter(|f| f.failed()) {
        note(&format!("expectation failed: {} {}, found {}", finding.key, finding.wanted, finding.found));
    }
    if let Some(linked) = summary.linked.as_ref().filter(|linked| linked.same() == Some(false)) {
        note(&linked.words());
    }
}

pub(crate) fn as_json(summary: &Summary<'_>) {
    json(&json!({
        "title": summary.scene.title,
        "seed": summary.scene.seed,
        "steps": summary.steps,
        "wall_seconds": summary.wall,
        "camera_pictures": summary.drawn.pictures(),
        "camera_seconds": summary.drawn.seconds(),
        "digest": summary.digest,
        "link": summary.linked.as_ref().map(|linked| json!({ "same": linked.same(), "verdict": linked.words() })),
        "folder": summary.folder.as_ref().map(|f| f.display().to_string()),
        "metrics": summary.metrics,
        "expectations": summary.findings,
        "met": summary.met(),
    }));
}
