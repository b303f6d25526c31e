//! Where robots drove, with their outlines at marked times.

use super::{Drawn, NAMED, stroke, table};
use crate::trace::Trace;
use crate::words::{digits, round, trimmed};
use figures::{Key, Note, Plan, PlanOutline, PlanPath, Side, Stroke};
use vocabulary::math;
use vocabulary::{Body, Pose};

/// Robots from which on no outlines between start and end are drawn.
const CROWD: usize = 12;
/// How long an outline is on paper at least, mm.
const LEAST: f64 = 3.2;

/// The ways of all robots.
pub(crate) fn trajectories(run: &Trace) -> (Drawn, f64) {
    let crowd = run.fleet.robots.len() > CROWD;
    let mut plan = Plan {
        axes: Some(["x (m)".to_owned(), "y (m)".to_owned()]),
        height: 90.0,
        margin: [9.0; 2],
        ..Plan::default()
    };
    for (robot, motions) in run.robots.iter().enumerate() {
        let leads = run.fleet.robots.get(robot).is_some_and(|m| m.leads);
        plan.tracks.push(PlanPath {
            points: motions.iter().map(|m| [m.pose.x, m.pose.y]).collect(),
            colour: run.robot_colour(robot),
            stroke: if leads || crowd { Stroke::Solid } else { stroke(robot) },
            faint: crowd && !leads,
        });
    }
    let scale = scale(&plan);
    let times = marked(run.times.last().copied().unwrap_or(0.0), crowd);
    let factor = enlargement(run, scale, &times);
    for time in &times {
        mark(run, *time, factor, &mut plan);
    }
    if !crowd {
        for time in &times {
            clock(run, *time, factor * scale * POINTS, &mut plan);
        }
    }
    names(run, &times, scale, factor, &mut plan);
    let columns = run.robots.iter().zip(&run.fleet.robots).flat_map(|(motions, member)| {
        let column = |what: &str, value: fn(&vocabulary::Motion) -> f64| {
            (format!("{} {what}", member.name), motions.iter().map(value).collect())
        };
        [column("x_m", |m| m.pose.x), column("y_m", |m| m.pose.y), column("heading_rad", |m| m.pose.heading)]
    });
    let columns: Vec<(String, Vec<f64>)> = columns.collect();
    (Drawn { svg: plan.svg(), csv: table(&run.times, &columns) }, factor)
}

/// About how long a metre is on paper, mm.
fn scale(plan: &Plan) -> f64 {
    let places = || plan.tracks.iter().flat_map(|t| &t.points);
    let span = |axis: usize| {
        let (low, high) =
            places().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(p[axis]), b.max(p[axis])));
        if high > low { high - low } else { 1.0 }
    };
    (plan.width - 16.0) / span(0).max(span(1))
}

/// How much larger than they are robots have to be drawn to be seen, in steps, and may be without lying over each other.
fn enlargement(run: &Trace, scale: f64, times: &[f64]) -> f64 {
    let length = run.fleet.robots.iter().map(|m| m.body.length).fold(0.0, f64::max).max(1e-3);
    let free = times.iter().map(|time| nearest(run, run.sample_at(*time))).fold(f64::INFINITY, f64::min);
    let most = if run.fleet.robots.len() > CROWD { 2.0 } else { 4.0 };
    let fits = [4.0, 3.0, 2.0, 1.5].into_iter().find(|f| *f <= most && f * length <= 0.75 * free);
    let most = fits.unwrap_or(1.0);
    [1.0, 1.5, 2.0, 3.0, 4.0].into_iter().find(|f| f * length * scale >= LEAST).unwrap_or(most).min(most)
}

/// Least distance of two robots, m.
fn nearest(run: &Trace, sample: usize) -> f64 {
    let poses: Vec<Pose> = (0..run.robots.len()).filter_map(|robot| run.pose(robot, sample)).collect();
    let from = |(k, a): (usize, &Pose)| {
        let apart = poses[k + 1..].iter().map(|b| math::hypot(a.x - b.x, a.y - b.y));
        apart.fold(f64::INFINITY, f64::min)
    };
    poses.iter().enumerate().map(from).fold(f64::INFINITY, f64::min)
}

fn marked(end: f64, crowd: bool) -> Vec<f64> {
    if crowd || end <= 0.0 {
        return vec![0.0, end];
    }
    let step = [round(end / 6.0), 2.5 * round(end / 15.0)].into_iter().fold(0.0, f64::max);
    let count = (end / step + 1e-9).floor() as usize;
    (0..=count).map(|k| k as f64 * step).collect()
}

/// Outlines at a time, and thin lines from leaders to followers.
fn mark(run: &Trace, time: f64, factor: f64, plan: &mut Plan) {
    let sample = run.sample_at(time);
    let pose = |robot: usize| run.pose(robot, sample);
    for edge in &run.fleet.edges {
        if let (Some(a), Some(b)) = (pose(edge.leader), pose(edge.follower)) {
            plan.tracks.push(PlanPath {
                points: vec![[a.x, a.y], [b.x, b.y]],
                colour: [0.45; 3],
                faint: true,
                ..PlanPath::default()
            });
        }
    }
    for (robot, member) in run.fleet.robots.iter().enumerate() {
        let Some(pose) = pose(robot) else { continue };
        let colour = run.robot_colour(robot);
        let filled = if member.leads { 0.85 } else { 0.55 };
        plan.outlines.push(PlanOutline { points: outline(pose, &member.body, factor), colour, filled });
    }
}

/// A body seen from above, its front pointed.
fn outline(pose: Pose, body: &Body, factor: f64) -> Vec<[f64; 2]> {
    let (half, front) = (0.5 * body.width, 0.5 * (body.wheelbase + body.length));
    let back = front - body.length;
    let nose = front - 0.45 * body.length;
    let (sin, cos) = math::sin_cos(pose.heading);
    let corners = [[back, -half], [nose, -half], [front, 0.0], [nose, half], [back, half]];
    let at =
        |[x, y]: [f64; 2]| [pose.x + factor * (x * cos - y * sin), pose.y + factor * (x * sin + y * cos)];
    corners.map(at).to_vec()
}

/// +1 where the guide turns left on the whole, −1 where it turns right.
fn turn(run: &Trace) -> f64 {
    let turned: f64 = run.robots.get(run.guide()).into_iter().flatten().map(|m| m.turn_rate).sum();
    if turned < -1e-9 { -1.0 } else { 1.0 }
}

/// Beside a pose, to its right where `aside` is −1.
fn beside(pose: Pose, aside: f64) -> Side {
    let (sin, cos) = math::sin_cos(pose.heading);
    let [x, y] = [-sin * aside, cos * aside];
    match (x.abs() > y.abs(), x > 0.0, y > 0.0) {
        (true, true, _) => Side::Right,
        (true, false, _) => Side::Left,
        (false, _, true) => Side::Above,
        (false, _, false) => Side::Below,
    }
}

/// From the middle of a body to words beside it, points of print; `magnified` are points for a metre of the body.
fn clear(pose: Pose, body: &Body, side: Side, magnified: f64) -> f64 {
    let (sin, cos) = (math::sin(pose.heading).abs(), math::cos(pose.heading).abs());
    let (along, across) = match side {
        Side::Above | Side::Below => (sin, cos),
        Side::Left | Side::Right => (cos, sin),
    };
    0.5 * magnified * (body.length * along + body.width * across) + 2.2
}

/// Points of print in a millimetre.
const POINTS: f64 = 72.0 / 25.4;

/// The time beside the guide, outside of its turn.
fn clock(run: &Trace, time: f64, magnified: f64, plan: &mut Plan) {
    let robot = run.guide();
    let Some(pose) = run.pose(robot, run.sample_at(time)) else { return };
    let text = if time == 0.0 { "t = 0".to_owned() } else { format!("{} s", plain(time)) };
    let side = beside(pose, -turn(run));
    let body = run.fleet.robots.get(robot).map_or_else(Body::default, |m| m.body);
    let off = clear(pose, &body, side, magnified);
    plan.notes.push(Note { at: [pose.x, pose.y], text, side, off, colour: None });
}

/// A time without digits that are none.
fn plain(time: f64) -> String {
    trimmed(digits(time))
}

/// From where a word begins to its middle, points of print.
const HALF_A_LINE: f64 = 3.5;
/// So far from the guide's way names do not meet the times beside it, mm.
const FREE: f64 = 9.0;

/// Names beside ways, halfway between two marked times, on the inside of the turn; on the outside where the guide's
/// times would be in the way.
fn names(run: &Trace, times: &[f64], scale: f64, factor: f64, plan: &mut Plan) {
    let few = run.fleet.robots.len() < NAMED;
    let end = run.times.last().copied().unwrap_or(0.0);
    let middle = times.len() / 2;
    let at = match times.get(middle).zip(times.get(middle + 1)) {
        Some((a, b)) if times.len() > 3 => 0.5 * (a + b),
        _ => 0.6 * end,
    };
    let sample = run.sample_at(at);
    let pose = |robot: usize| run.pose(robot, sample);
    let Some(first) = pose(run.guide()) else { return };
    let (mut notes, mut astray): (Vec<Note>, bool) = (vec![], false);
    for (robot, member) in run.fleet.robots.iter().enumerate().filter(|(_, m)| few || m.leads) {
        let Some(pose) = pose(robot) else { continue };
        let (sin, cos) = math::sin_cos(first.heading);
        let inward = turn(run) * ((pose.y - first.y) * cos - (pose.x - first.x) * sin) * scale;
        let outside = robot != run.guide() && inward < 0.0 && inward > -FREE;
        let side = beside(pose, if outside { -turn(run) } else { turn(run) });
        // Outlines are not here, but a word may be longer than the way between two of them.
        let off = 0.5 * member.body.width * factor * scale * POINTS + 2.2;
        let colour = run.colours.get(robot).copied();
        // A name that stands nearer to another robot than to its own would be read as that one's.
        let away = (off + HALF_A_LINE) / (scale * POINTS);
        let [dx, dy] = match side {
            Side::Right => [away, 0.0],
            Side::Left => [-away, 0.0],
            Side::Above => [0.0, away],
            Side::Below => [0.0, -away],
        };
        let distance = |other: Pose| math::hypot(pose.x + dx - other.x, pose.y + dy - other.y);
        astray |= (0..run.fleet.robots.len())
            .filter(|other| *other != robot)
            .filter_map(|other| run.pose(other, sample))
            .any(|other| distance(other) < math::hypot(dx, dy));
        notes.push(Note { at: [pose.x, pose.y], text: member.name.clone(), side, off, colour });
    }
    if !astray && !meet(&notes, scale) {
        plan.notes.extend(notes);
        return;
    }
    // One behind the other there is no room beside the ways.
    let strokes = plan.tracks.iter().map(|track| track.stroke);
    plan.keys = notes
        .into_iter()
        .zip(strokes)
        .map(|(note, stroke)| Key { name: note.text, stroke, colour: note.colour, ..Key::default() })
        .collect();
}

/// Whether names are so close that one would cover another.
fn meet(notes: &[Note], scale: f64) -> bool {
    /// A word and a line of text, mm.
    const WORD: [f64; 2] = [15.0, 3.2];
    let side = |note: &Note| if matches!(note.side, Side::Above | Side::Right) { 1.0 } else { -1.0 };
    let close = |a: &Note, b: &Note| {
        let apart = [0, 1].map(|k| (a.at[k] - b.at[k]).abs() * scale);
        apart[0] < WORD[0] && apart[1] < WORD[1] && side(a) * side(b) > 0.0
    };
    notes.iter().enumerate().any(|(k, a)| notes[k + 1..].iter().any(|b| close(a, b)))
}
