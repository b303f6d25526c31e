//! Leads that go slower than their followers can.

use crate::caption::short;
use crate::simulation::Simulation;

/// Instants of a lead's motion that are looked at.
const INSTANTS: u32 = 4096;

/// Every lead that goes slower, before `duration` s, than those who follow it can, in words.
pub fn too_slow_leads(simulation: &Simulation, duration: f64) -> Vec<String> {
    let (formation, fleet) = (simulation.formation(), simulation.fleet());
    let mut heads: Vec<usize> = (0..fleet.robots.len()).collect();
    for &edge in formation.graph().evaluation_order() {
        let edge = formation.edges()[edge];
        heads[edge.follower] = heads[edge.leader];
    }
    let mut words = vec![];
    for (lead, trajectory) in formation.leads() {
        let mut followers: Vec<(f64, usize)> = formation
            .edges()
            .iter()
            .map(|edge| (formation.limits(edge.follower).speed_min, edge.follower))
            .filter(|(speed_min, follower)| heads[*follower] == *lead && *speed_min > 0.0)
            .collect();
        followers.sort_by(|a, b| b.0.total_cmp(&a.0));
        let Some(&(speed_min, follower)) = followers.first() else { continue };
        let at = |k: u32| duration * f64::from(k) / f64::from(INSTANTS);
        let slow = |time: &f64| trajectory.at(*time).speed < speed_min * (1.0 - 1e-9);
        let Some(time) = (0..=INSTANTS).map(at).find(slow) else { continue };
        let slowest = (0..=INSTANTS).map(|k| trajectory.at(at(k)).speed).fold(f64::INFINITY, f64::min);
        let more = match followers.len() {
            1 => "drives".to_owned(),
            count => format!("and {} more drive", count - 1),
        };
        words.push(format!(
            "`{}` goes slower than its followers can, {} m/s at the least and below their `speed_min` of {} m/s from {time:.1} s on: \
             `{}` {more} past their places; with `standing = true` in their law they stop with it",
            fleet.robots[*lead].name,
            short(slowest),
            short(speed_min),
            fleet.robots[follower].name,
        ));
    }
    words
}
