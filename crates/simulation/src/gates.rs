//! Whether formations fit through the gates on their leads' paths, as they are and filed in.

use crate::caption::short;
use crate::simulation::Simulation;
use formation::column::{cartesian, half_widths};
use perception::proximity::gap_to;
use vocabulary::{Mobility, MotionInput, Pose, Prop, Trajectory};

/// A place on a path with props on both sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gate {
    /// Of the lead, m.
    pub at: [f64; 2],
    /// What is free beside the path, [right, left] in m.
    pub free: [f64; 2],
}

impl Gate {
    /// m.
    pub fn width(&self) -> f64 {
        self.free[0] + self.free[1]
    }

    /// What is free beyond `needed` [right, left], m, on the side where that is less; below zero where it does not fit.
    pub fn room(&self, needed: [f64; 2]) -> f64 {
        (self.free[0] - needed[0]).min(self.free[1] - needed[1])
    }
}

/// Places on a path that are looked at are this far apart, m.
const STRIDE: f64 = 0.05;
/// Instants of a motion that is integrated.
const INSTANTS: u32 = 20_000;
/// A prop this near is touched, m.
const TOUCHES: f64 = 1e-3;

/// The narrowest gate between fixed `props` on the path of a lead from `start` on, within `duration` s; what is farther from
/// the path than `reach` [right, left], m, does not count. `height` m is that of the middle of the lead's body.
pub fn narrowest(
    trajectory: &dyn Trajectory,
    start: Pose,
    duration: f64,
    props: &[Prop],
    reach: [f64; 2],
    height: f64,
) -> Option<Gate> {
    let fixed: Vec<&Prop> = props.iter().filter(|prop| prop.mobility == Mobility::Fixed).collect();
    if fixed.is_empty() {
        return None;
    }
    let gap = |place: [f64; 2]| {
        let gaps = fixed.iter().filter_map(|prop| gap_to(&prop.solid, &prop.placement, place, height));
        gaps.map(|(_, distance)| distance).fold(f64::INFINITY, f64::min)
    };
    // From the path outward, by steps that reach nothing.
    let free = |pose: &Pose, side: f64, reach: f64| {
        let mut out = 0.0;
        while out < reach {
            let step = gap(pose.world_from_body(0.0, side * out));
            if step < TOUCHES {
                // A path through a solid is over it.
                return (out > 0.0).then_some(out);
            }
            out += step;
        }
        None
    };
    let (mut pose, mut since, mut found) = (start, f64::INFINITY, None::<Gate>);
    let step = duration / f64::from(INSTANTS);
    for k in 0..=INSTANTS {
        if since >= STRIDE {
            since = 0.0;
            if let (Some(right), Some(left)) = (free(&pose, -1.0, reach[0]), free(&pose, 1.0, reach[1])) {
                let gate = Gate { at: [pose.x, pose.y], free: [right, left] };
                if found.is_none_or(|least| gate.width() < least.width() - TOUCHES) {
                    found = Some(gate);
                }
            }
        }
        let MotionInput { speed, turn_rate, .. } = trajectory.at((f64::from(k) + 0.5) * step);
        pose.heading += 0.5 * turn_rate * step;
        let [x, y] = pose.world_from_body(speed * step, 0.0);
        pose = Pose { x, y, heading: pose.heading + 0.5 * turn_rate * step };
        since += speed.abs() * step;
    }
    found
}

/// What is to be said of every formation with a gate on its way, and of sensors that tell of one too late.
pub fn gates(simulation: &Simulation, duration: f64) -> Vec<String> {
    simulation
        .formation()
        .leads()
        .iter()
        .flat_map(|(lead, path)| told(simulation, *lead, &**path, duration))
        .collect()
}

fn told(simulation: &Simulation, lead: usize, path: &dyn Trajectory, duration: f64) -> Vec<String> {
    let (formation, fleet) = (simulation.formation(), simulation.fleet());
    let graph = formation.graph();
    let wide: Vec<_> = formation.laws().iter().map(|law| cartesian(law.set_point.at(0.0).value)).collect();
    let filed = |level: u8| -> Vec<[f64; 2]> {
        let laws = formation.laws().iter().zip(&wide);
        laws.map(|(law, wide)| law.narrowing.map_or(*wide, |rule| rule.place(*wide, level))).collect()
    };
    let column = filed(formation::Narrowing::COLUMN);
    let edges = formation.edges();
    let follows = |index: &usize| graph.is_in_force(*index) && graph.head_of(edges[*index].follower) == lead;
    let followers: Vec<usize> = (0..edges.len()).filter(follows).collect();
    if followers.is_empty() {
        return vec![];
    }
    let kept = |index: &usize| simulation.room_beside(edges[*index].follower);
    // A follower files in for what it would like to be free beside it; that is more than its filter keeps.
    let liked = |index: &usize| {
        formation.laws()[*index].narrowing.map_or(0.0, |rule| rule.half_width).max(kept(index))
    };
    let of_lead = simulation.room_beside(lead);
    let least = followers.iter().map(kept).fold(of_lead, f64::max);
    let beside = followers.iter().map(liked).fold(of_lead, f64::max);
    let needed = |places: &[[f64; 2]]| half_widths(graph, places, lead).map(|side| side + beside);
    let at_least = |places: &[[f64; 2]]| half_widths(graph, places, lead).map(|side| side + least);
    let body = &fleet.robots[lead].body;
    let start = simulation.record().snapshot.robots[lead].motion.pose;
    let of_wide = needed(&wide);
    let gate = narrowest(
        path,
        start,
        duration,
        &fleet.props,
        [1.5 * of_wide[0].max(of_wide[1]); 2],
        0.5 * body.height,
    );
    let Some(gate) = gate else { return vec![] };
    let metres = |[right, left]: [f64; 2]| format!("{:.2} m", right + left);
    let width = |places: &[[f64; 2]]| metres(needed(places));
    let mut words = vec![];
    let [x, y] = gate.at;
    let who = match followers.len() {
        1 => "its follower take".to_owned(),
        count => format!("its {count} followers take"),
    };
    let opening = format!(
        "a gate of {:.2} m at ({x:.1}, {:.1}) on the path of `{}`: it and {who} {}, margins included,",
        gate.width(),
        y + 0.0,
        fleet.robots[lead].name,
        width(&wide),
    );
    let narrows = followers.iter().any(|index| formation.laws()[*index].narrowing.is_some());
    let short_of = |places: &[[f64; 2]]| format!("{:.2} m too much", -gate.room(needed(places)));
    let single = filed(formation::Narrowing::FILE);
    words.push(if gate.room(of_wide) >= 0.0 {
        format!("{opening} and fit")
    } else if !narrows {
        format!(
            "{opening} {} on one side; with `narrowing = {{ narrows = true }}` they file in",
            short_of(&wide)
        )
    } else if gate.room(needed(&column)) >= 0.0 {
        format!("{opening} and do not fit; as a column they take {} and do", width(&column))
    } else if gate.room(needed(&single)) >= 0.0 {
        format!("{opening} and do not fit; in single file they take {} and do", width(&single))
    } else if gate.room(at_least(&single)) >= 0.0 {
        format!(
            "{opening} and do not fit; in single file they take {}, {} at the least: it is close",
            width(&single),
            metres(at_least(&single))
        )
    } else {
        let missing = -gate.room(at_least(&single));
        let single = metres(at_least(&single));
        format!("{opening} and do not fit, nor in single file: {single}, {missing:.2} m too much on one side")
    });
    let ahead = followers.iter().map(|index| simulation.looks_ahead(edges[*index].follower));
    let ahead = ahead.fold(simulation.looks_ahead(lead), f64::max);
    if narrows && (-ahead..0.0).contains(&gate.room(at_least(&single))) {
        let point = short(ahead);
        words.push(format!(
            "of that a filter's `point_ahead` of {point} m takes {point} m on each side: a smaller one may do"
        ));
    }
    if gate.room(of_wide) < 0.0 {
        words.extend(short_sighted(simulation, &followers, path, duration));
    }
    words
}

/// The follower whose sensor reaches least, where it tells of a gate too late.
fn short_sighted(
    simulation: &Simulation,
    followers: &[usize],
    path: &dyn Trajectory,
    duration: f64,
) -> Option<String> {
    let formation = simulation.formation();
    let speeds = (0..=1000).map(|k| path.at(duration * f64::from(k) / 1000.0).speed);
    let speed = speeds.fold(0.0, f64::max);
    let lacks = followers.iter().filter_map(|index| {
        let (law, follower) = (&formation.laws()[*index], formation.edges()[*index].follower);
        let (rule, range) = (law.narrowing.as_ref()?, simulation.senses(follower)?);
        let wide = cartesian(law.set_point.at(0.0).value);
        let needed = rule.foresight(wide, speed) - wide[0];
        (needed > range).then_some((follower, range, needed))
    });
    let (follower, range, needed) = lacks.max_by(|a, b| (a.2 - a.1).total_cmp(&(b.2 - b.1)))?;
    Some(format!(
        "`{}` senses {} m, and at {} m/s it has to see {needed:.1} m ahead to file in in time: a larger `range` of its \
         `proximity`, or a larger `rate` of its `narrowing`",
        simulation.fleet().robots[follower].name,
        short(range),
        short(speed),
    ))
}
