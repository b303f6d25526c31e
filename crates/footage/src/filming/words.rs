//! Words of films: cards, and the line at the bottom.

use super::board::FramePlan;
use metrics::{EdgeMetrics, Metrics};
use rendering::{Card, Subtitle};
use vocabulary::{FleetInfo, StepRecord};

/// Set points that are listed, at most.
const MOST_SET_POINTS: usize = 4;

/// Set points in a row.
const IN_A_ROW: usize = 2;

/// Rows of the set points of so many edges.
pub(super) fn set_point_rows(edges: usize) -> usize {
    edges.min(MOST_SET_POINTS).div_ceil(IN_A_ROW)
}

/// The card over a frame, if there is one.
pub(super) fn card(
    frame: &FramePlan<'_>,
    description: &str,
    fleet: &FleetInfo,
    metrics: impl FnOnce() -> Metrics,
) -> Option<Card> {
    let [title, end] = frame.cards;
    if title > 0.0 {
        let about = description.split_whitespace().collect::<Vec<_>>().join(" ");
        let rows = [about, fleet.caption.clone()].into_iter().filter(|row| !row.is_empty()).collect();
        return Some(Card { title: fleet.title.clone(), rows, opacity: title });
    }
    (end > 0.0).then(|| Card { title: fleet.title.clone(), rows: results(&metrics()), opacity: end })
}

/// What the run showed, in a few rows.
fn results(metrics: &Metrics) -> Vec<String> {
    let mut rows = Vec::new();
    let followed: Vec<&EdgeMetrics> = metrics.edges.iter().filter(|edge| edge.ended.is_none()).collect();
    let worst = |value: fn(&EdgeMetrics) -> f64| followed.iter().map(|edge| value(edge)).fold(0.0, f64::max);
    if !followed.is_empty() {
        let followers = followed.len();
        let who = if followers == 1 { "the follower".to_owned() } else { format!("{followers} followers") };
        rows.push(format!(
            "errors of {who} at the end: at most {:.1} mm and {:.2}°",
            1e3 * worst(|edge| edge.final_error[0].abs()),
            worst(|edge| edge.final_error[1].abs()).to_degrees()
        ));
        let settled: Option<f64> =
            followed.iter().map(|edge| edge.settling_time).try_fold(0.0, |most: f64, t| Some(most.max(t?)));
        if let Some(time) = settled {
            let [distance, bearing] = metrics.settling_band;
            rows.push(format!(
                "within {:.0} mm and {:.1}° from {time:.2} s on",
                1e3 * distance,
                bearing.to_degrees()
            ));
        }
    }
    if let Some(clearance) = metrics.clearance_min {
        rows.push(format!("least clearance {clearance:.2} m"));
    }
    rows.push(match metrics.contacts {
        0 => "no contact".to_owned(),
        1 => "one contact".to_owned(),
        many => format!("{many} contacts"),
    });
    rows
}

/// The line at the bottom of a frame, if there is one.
pub(super) fn line(frame: &FramePlan<'_>, fleet: &FleetInfo, record: &StepRecord) -> Option<Subtitle> {
    let mut rows = Vec::new();
    if !frame.line.is_empty() {
        rows.push(frame.line.to_owned());
    }
    if frame.set_points {
        rows.extend(set_points(fleet, record));
    }
    (!rows.is_empty() && frame.line_opacity > 0.0).then_some(Subtitle { rows, opacity: frame.line_opacity })
}

/// Where the followers should be, now.
fn set_points(fleet: &FleetInfo, record: &StepRecord) -> Vec<String> {
    let several = fleet.several_leaders();
    let one = |(index, edge, state): (usize, vocabulary::Edge, &vocabulary::EdgeState)| {
        let [distance, bearing] = state.set_point;
        let degrees = format!("{:.0}°", bearing.to_degrees()).replace('-', "\u{2212}");
        let free = fleet.free(index);
        let [leader, follower] = fleet.pair(edge);
        let who = if several.get(edge.follower) == Some(&true) {
            format!("{leader} → {follower}")
        } else {
            follower.to_owned()
        };
        let parts =
            [Some(who), (!free[0]).then(|| format!("{distance:.2} m")), (!free[1]).then_some(degrees)];
        parts.into_iter().flatten().collect::<Vec<_>>().join("  ")
    };
    let all: Vec<String> = record.pairs(fleet).map(one).collect();
    let more = all.len().saturating_sub(MOST_SET_POINTS);
    let mut rows: Vec<String> = all
        .iter()
        .take(MOST_SET_POINTS)
        .collect::<Vec<_>>()
        .chunks(IN_A_ROW)
        .map(|pair| pair.iter().map(|text| text.as_str()).collect::<Vec<_>>().join("   ·   "))
        .collect();
    if let (true, Some(last)) = (more > 0, rows.last_mut()) {
        *last = format!("{last}   ·   and {more} more");
    }
    rows
}
