//! The formation graph, laid out from the set points.

use super::{Drawn, NAMED, number, quoted};
use crate::trace::Trace;
use figures::{Arrow, Note, Plan, PlanNode, Side};
use std::collections::BTreeMap;
use std::fmt::Write;
use vocabulary::math;

/// Where robots are at a sample in the frame of the guide: x forward, y left, m.
fn seen_from_guide(run: &Trace, sample: usize) -> Vec<Option<[f64; 2]>> {
    let origin = run.pose(run.guide(), sample).unwrap_or_default();
    let (sin, cos) = math::sin_cos(origin.heading);
    let place = |robot: usize| {
        let pose = run.pose(robot, sample)?;
        let d = [pose.x - origin.x, pose.y - origin.y];
        Some([d[0] * cos + d[1] * sin, d[1] * cos - d[0] * sin])
    };
    (0..run.fleet.robots.len()).map(place).collect()
}

/// Places of all robots at a sample if every follower stood at its set point with its leader's heading, in the frame of the
/// guide, m.
pub(crate) fn places(run: &Trace, sample: usize) -> Vec<[f64; 2]> {
    let mut places = seen_from_guide(run, sample);
    for (_, edge) in run.pairs(sample) {
        if let Some(place) = places.get_mut(edge.follower) {
            *place = None;
        }
    }
    // A formation has no rings: every round places the followers of those placed before, one of several leaders in the
    // middle between where each wants it.
    let is_several = run.fleet.several_leaders();
    let mut several: BTreeMap<usize, Vec<Option<[f64; 2]>>> = BTreeMap::new();
    for _ in 0..run.fleet.robots.len() {
        several.clear();
        for (index, edge) in run.pairs(sample) {
            let leader = places.get(edge.leader).copied().flatten();
            let row = run.edges.get(index).and_then(|rows| rows.get(sample));
            let wanted = leader.zip(row).map(|([x, y], row)| {
                let [distance, bearing] = row.set_point;
                [x + distance * math::cos(bearing), y + distance * math::sin(bearing)]
            });
            if is_several.get(edge.follower) == Some(&true) {
                several.entry(edge.follower).or_default().push(wanted);
            } else if let (Some(wanted), Some(place)) = (wanted, places.get_mut(edge.follower)) {
                *place = Some(wanted);
            }
        }
        for (follower, wanted) in &several {
            let sum =
                wanted.iter().try_fold([0.0; 2], |sum, place| place.map(|[x, y]| [sum[0] + x, sum[1] + y]));
            if let (Some(sum), Some(place)) = (sum, places.get_mut(*follower)) {
                *place = Some(sum.map(|sum| sum / wanted.len() as f64));
            }
        }
    }
    places.into_iter().map(Option::unwrap_or_default).collect()
}

/// Largest distance of a robot from where the set points want it, at a sample, in the frame of the guide, m.
pub(crate) fn farthest(run: &Trace, sample: usize) -> Option<f64> {
    let (seen, wanted) = (seen_from_guide(run, sample), places(run, sample));
    seen.iter().zip(wanted).try_fold(0.0, |most: f64, (seen, wanted)| {
        seen.map(|[x, y]| most.max(math::hypot(x - wanted[0], y - wanted[1])))
    })
}

/// Nodes, directed edges, and set points on edges, at a time.
pub(crate) fn graph(run: &Trace, time: f64) -> Drawn {
    let sample = run.sample_at(time);
    let places = places(run, sample);
    // The page is looked at along the leader's heading: forward is up.
    let page: Vec<[f64; 2]> = places.iter().map(|[x, y]| [-y, *x]).collect();
    let count = run.fleet.robots.len();
    let (radius, labels) = match count {
        0..NAMED => (6.5, true),
        NAMED..16 => (5.5, true),
        16..40 => (4.0, false),
        _ => (2.2, false),
    };
    let mut plan =
        Plan { margin: if labels { [46.0, 9.0] } else { [8.0; 2] }, height: 75.0, ..Plan::default() };
    let middle = page.iter().map(|p| p[0]).sum::<f64>() / count.max(1) as f64;
    let mut csv = String::from("leader,follower,distance_m,bearing_rad,bearing_deg\n");
    for (index, edge) in run.pairs(sample) {
        let Some(row) = run.edges.get(index).and_then(|rows| rows.get(sample)) else { continue };
        let [distance, bearing] = row.set_point;
        let name = |robot: usize| run.fleet.robots.get(robot).map_or("", |m| m.name.as_str());
        // Of what is left free nothing is said.
        let free = run.fleet.free(index);
        let said = |value: f64, free: bool| if free { String::new() } else { number(value) };
        let _ = writeln!(
            csv,
            "{},{},{},{},{}",
            quoted(name(edge.leader)),
            quoted(name(edge.follower)),
            said(distance, free[0]),
            said(bearing, free[1]),
            said(bearing.to_degrees(), free[1])
        );
        let (Some(from), Some(to)) = (page.get(edge.leader), page.get(edge.follower)) else { continue };
        plan.arrows.push(Arrow { from: *from, to: *to, free: radius + 1.2, colour: [0.35; 3] });
        if labels {
            let at = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
            let degrees = format!("{:+.0}°", bearing.to_degrees()).replace('-', "−");
            let side = if at[0] > middle { Side::Right } else { Side::Left };
            let parts = [(!free[0]).then(|| format!("{distance:.2} m")), (!free[1]).then_some(degrees)];
            let text = parts.into_iter().flatten().collect::<Vec<_>>().join(", ");
            plan.notes.push(Note { at, text, side, off: 6.0, colour: None });
        }
    }
    let signs = signs(run);
    for (robot, member) in run.fleet.robots.iter().enumerate() {
        let Some(at) = page.get(robot).copied() else { continue };
        plan.nodes.push(PlanNode {
            at,
            name: if labels { signs[robot].clone() } else { String::new() },
            radius,
            colour: run.robot_colour(robot),
            filled: member.leads,
        });
    }
    Drawn { svg: plan.svg(), csv }
}

/// A sign for every robot: the number its name ends with, or the name's first letter; its shell's number where those
/// are not all different.
fn signs(run: &Trace) -> Vec<String> {
    let sign = |name: &str| {
        let digits = name.len() - name.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        match &name[name.len() - digits..] {
            "" => name.chars().next().map_or_else(String::new, |c| c.to_uppercase().collect()),
            number => number.to_owned(),
        }
    };
    let signs: Vec<String> = run.fleet.robots.iter().map(|member| sign(&member.name)).collect();
    let mut different = signs.clone();
    different.sort();
    different.dedup();
    if different.len() == signs.len() {
        return signs;
    }
    let number = |robot: usize| run.scene.robots.get(robot).map_or(robot, |r| r.number).to_string();
    (0..signs.len()).map(number).collect()
}
