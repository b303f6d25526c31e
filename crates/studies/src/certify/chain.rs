//! How errors grow along chains of followers: every edge of a scene linearised about steady motion.

use formation::certificate::chain::{LinearEdge, NotLinear, Response, down_the_chain, frequencies, growth};
use scene::Scene;
use serde::Serialize;
use simulation::{BuildError, Simulation, build};
use vocabulary::MotionInput;

/// Numbers of followers in a row that are told.
pub const LENGTHS: [usize; 4] = [1, 7, 20, 100];

/// What one edge does with what its leader does.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeGain {
    /// Index of the edge.
    pub edge: usize,
    /// Why there is nothing to tell.
    pub missing: Option<NotLinear>,
    /// Whether a deviation dies out.
    pub stable: bool,
    /// Followers from a lead robot to this one.
    pub depth: usize,
    /// Over frequency.
    pub curve: Vec<GainPoint>,
}

/// Gains at one frequency.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GainPoint {
    /// rad/s.
    pub frequency: f64,
    /// |error of distance| per deviation of the own leader's speed, m per m/s.
    pub own_leader: f64,
    /// The same per deviation of the speed of the lead robot at the head of the chain.
    pub lead: f64,
    /// By how much deviations grow from follower to follower at most, in a long chain of edges like this.
    pub growth: f64,
    /// |follower's turn rate| per leader's turn rate.
    pub turn: f64,
    /// |error of distance| of the last of [`LENGTHS`] followers like this, per deviation of the first one's leader's speed,
    /// m per m/s.
    #[serde(rename = "chains")]
    pub lengths: [f64; LENGTHS.len()],
}

impl EdgeGain {
    /// Largest value over frequency, and where, rad/s.
    pub fn peak(&self, value: impl Fn(&GainPoint) -> f64) -> Option<(f64, f64)> {
        self.curve.iter().map(|p| (value(p), p.frequency)).max_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// The gains of every edge, about what the leads do at the end of the run; in the order of the edges.
///
/// # Errors
/// [`BuildError`] where the scene cannot run.
pub fn gains(scene: &Scene) -> Result<Vec<EdgeGain>, BuildError> {
    let simulation = Simulation::new(build(scene)?);
    let formation = simulation.formation();
    let robots = simulation.fleet().robots.len();
    // What every robot does, and how many edges and responses lie above it.
    let mut above: Vec<Option<(MotionInput, Vec<usize>)>> = vec![None; robots];
    for (robot, trajectory) in formation.leads() {
        let drive = trajectory.at(scene.time.duration);
        above[*robot] = Some((MotionInput { acceleration: 0.0, turn_acceleration: 0.0, ..drive }, vec![]));
    }
    let mut edges: Vec<Option<LinearEdge>> = vec![None; formation.edges().len()];
    let mut all: Vec<EdgeGain> = Vec::new();
    for &index in formation.graph().evaluation_order() {
        let edge = formation.edges()[index];
        if formation.graph().edges_of(edge.follower).len() > 1 {
            all.push(EdgeGain::missing(index, NotLinear::SeveralLeaders));
            continue;
        }
        let Some((leader, chain)) = above[edge.leader].clone() else {
            all.push(EdgeGain::missing(index, NotLinear::NoSteadyMotion));
            continue;
        };
        match LinearEdge::about(&formation.laws()[index], &leader) {
            Err(why) => all.push(EdgeGain::missing(index, why)),
            Ok(linear) => {
                let mut chain = chain;
                chain.push(index);
                above[edge.follower] = Some((linear.follower, chain.clone()));
                edges[index] = Some(linear);
                let links: Vec<&LinearEdge> = chain.iter().filter_map(|e| edges[*e].as_ref()).collect();
                all.push(EdgeGain::of(index, &links));
            }
        }
    }
    all.sort_by_key(|gain| gain.edge);
    Ok(all)
}

impl EdgeGain {
    fn missing(edge: usize, why: NotLinear) -> Self {
        Self { edge, missing: Some(why), stable: false, depth: 0, curve: vec![] }
    }

    /// Of the last of `links`, which lead to it from a lead robot.
    fn of(edge: usize, links: &[&LinearEdge]) -> Self {
        let point = |frequency: f64| {
            let responses: Vec<Response> = links.iter().filter_map(|link| link.at(frequency)).collect();
            let own = responses.last()?;
            let last_of = |followers: usize| {
                down_the_chain(&vec![*own; followers]).map_or(f64::NAN, |error| error[(0, 0)].norm())
            };
            Some(GainPoint {
                frequency,
                own_leader: own.error[(0, 0)].norm(),
                lead: down_the_chain(&responses)?[(0, 0)].norm(),
                growth: growth(own),
                turn: own.passed_on[(1, 1)].norm(),
                lengths: LENGTHS.map(last_of),
            })
        };
        let stable = links.iter().all(|link| link.stable());
        let curve = frequencies().filter_map(point).collect();
        Self { edge, missing: None, stable, depth: links.len(), curve }
    }
}
