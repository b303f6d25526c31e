//! Followers that keep two distances, and stand in line with both leaders: there the distances say nothing of the way across.

use crate::simulation::Simulation;
use formation::column::cartesian;
use vocabulary::{Relative, math};

/// Nearer to a line than this, rad, two distances say little of the way across it.
const IN_LINE: f64 = 10.0 / 180.0 * std::f64::consts::PI;

/// A cosine may be larger than 1 by this.
const ROUNDING: f64 = 1e-9;

/// Every follower of two leaders whose bearings are both left free and that starts, or is to be, in line with them, in words;
/// also those whose two distances do not meet.
pub fn in_line(simulation: &Simulation) -> Vec<String> {
    let (formation, fleet) = (simulation.formation(), simulation.fleet());
    let (edges, laws) = (formation.edges(), formation.laws());
    let robots = &simulation.record().snapshot.robots;
    let name = |robot: usize| &fleet.robots[robot].name;
    let mut words = vec![];
    for robot in 0..fleet.robots.len() {
        let ranging = |edge: &&usize| laws[**edge].free == [false, true];
        let own: Vec<usize> = formation.graph().edges_of(robot).iter().filter(ranging).copied().collect();
        for (k, a) in own.iter().enumerate() {
            for b in &own[k + 1..] {
                let [one, other] = [edges[*a].leader, edges[*b].leader];
                let who =
                    format!("`{}` keeps its distances to `{}` and `{}`", name(robot), name(one), name(other));
                let poses = [one, other, robot].map(|robot| robots[robot].motion.pose);
                let away = |from: usize, to: usize| Relative::between(poses[from], poses[to]).distance;
                let start = angle([away(0, 2), away(1, 2)], away(0, 1));
                if let Some(angle) = start.filter(|angle| flat(*angle)) {
                    words.push(told(&who, "starts", angle));
                }
                let apart = wanted_apart(simulation, [one, other]).unwrap_or_else(|| away(0, 1));
                let wanted = [*a, *b].map(|edge| laws[edge].set_point.at(0.0).value[0]);
                match angle(wanted, apart) {
                    None => words.push(format!(
                        "{who} of {} and {} m, which do not meet where these are {apart:.2} m apart",
                        wanted[0], wanted[1]
                    )),
                    Some(angle) if flat(angle) => words.push(told(&who, "is to be", angle)),
                    Some(_) => {}
                }
            }
        }
    }
    words
}

fn flat(angle: f64) -> bool {
    !(IN_LINE..=std::f64::consts::PI - IN_LINE).contains(&angle)
}

fn told(who: &str, when: &str, angle: f64) -> String {
    format!(
        "{who} and {when} nearly in line with them, {:.0}° between its lines of sight: there two distances say nothing of the \
         way across; keep it between 10° and 170°",
        angle.to_degrees()
    )
}

/// The angle at which a robot sees two others from these distances that are `apart` from each other, all in m; `None` where
/// there is no such place.
fn angle([a, b]: [f64; 2], apart: f64) -> Option<f64> {
    let cosine = (a * a + b * b - apart * apart) / (2.0 * a * b);
    (cosine.abs() <= 1.0 + ROUNDING).then(|| math::acos(cosine.clamp(-1.0, 1.0)))
}

/// How far two robots are to be from each other, m, once all are at their set points behind one head and drive straight on;
/// `None` where the set points do not say it.
fn wanted_apart(simulation: &Simulation, pair: [usize; 2]) -> Option<f64> {
    let formation = simulation.formation();
    let graph = formation.graph();
    let place = |robot: usize| {
        let (mut at, mut robot) = ([0.0; 2], robot);
        while let Some(edge) = graph.edge_of(robot) {
            if graph.edges_of(robot).len() > 1 {
                return None;
            }
            let [x, y] = cartesian(formation.laws()[edge].set_point.at(0.0).value);
            (at, robot) = ([at[0] + x, at[1] + y], formation.edges()[edge].leader);
        }
        Some((at, robot))
    };
    let [([ax, ay], a), ([bx, by], b)] = [place(pair[0])?, place(pair[1])?];
    (a == b).then(|| math::hypot(ax - bx, ay - by))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn an_angle_between_lines_of_sight() {
        assert!((angle([3.0, 4.0], 5.0).expect("a place") - FRAC_PI_2).abs() < 1e-12);
        assert_eq!(angle([1.0, 1.0], 2.1), None);
        assert!(flat(angle([1.0, 1.0], 1.999).expect("a place")));
        assert!(flat(angle([1.0, 2.0], 1.001).expect("a place")));
        assert!(!flat(FRAC_PI_2));
    }
}
