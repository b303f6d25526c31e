//! Which set points followers can hold while their leader drives its path: the set of (distance, bearing) within limits.

use formation::Heading;
use formation::feasible::{Infeasible, held, infeasible};
use scene::Scene;
use simulation::{BuildError, Simulation, build};
use vocabulary::{Limits, MotionInput, ScalarTrajectory, math};

/// Bearings that are looked at.
const BEARINGS: usize = 180;
/// Distances that are looked at on the way out, before the border is searched.
const DISTANCES: u32 = 80;
/// Instants of the leader's path that are looked at.
const INSTANTS: u32 = 240;

/// The set points of one edge that can be held.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach {
    /// Index of the edge.
    pub edge: usize,
    /// In the order of bearings from −π on.
    pub rays: Vec<ReachRay>,
    /// The set point of the scene, [m, rad], and what stands against it, if anything does.
    pub set_point: [f64; 2],
    /// What stands against the set point.
    pub refused: Option<Infeasible>,
    /// Distance to which was looked, m.
    pub far: f64,
}

/// One bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReachRay {
    /// rad.
    pub bearing: f64,
    /// Every distance from the least one to this can be held, m.
    pub distance: f64,
    /// What ends it; `None` where nothing does up to the distance looked to.
    pub end: Option<Infeasible>,
}

/// The set points that can be held, of every edge whose follower has one leader; leaders that follow are taken to hold their
/// own, those with several the one behind their first.
///
/// # Errors
/// [`BuildError`] where the scene cannot run.
pub fn reach(scene: &Scene) -> Result<Vec<Reach>, BuildError> {
    let simulation = Simulation::new(build(scene)?);
    let formation = simulation.formation();
    let robots = simulation.fleet().robots.len();
    let times: Vec<f64> =
        (0..=INSTANTS).map(|k| scene.time.duration * f64::from(k) / f64::from(INSTANTS)).collect();
    let mut paths: Vec<Vec<MotionInput>> = vec![Vec::new(); robots];
    for (robot, trajectory) in formation.leads() {
        paths[*robot] = times.iter().map(|time| trajectory.at(*time)).collect();
    }
    let mut all: Vec<Option<Reach>> = vec![None; formation.edges().len()];
    for &index in formation.graph().evaluation_order() {
        let (edge, law) = (formation.edges()[index], &formation.laws()[index]);
        let several = formation.graph().edges_of(edge.follower);
        if several[0] != index {
            continue;
        }
        let path = &paths[edge.leader];
        let own: Vec<MotionInput> = path
            .iter()
            .zip(&times)
            .map(|(leader, time)| {
                let [distance, bearing] = law.set_point.at(*time).value;
                held(place([distance, bearing - behind(&law.law.heading, leader)]), leader)
            })
            .collect();
        if several.len() > 1 {
            paths[edge.follower] = own;
            continue;
        }
        let value = law.set_point.at(0.0).value;
        let far = (3.0 * value[0]).max(4.0);
        let distance_min = law.law.distance_min;
        // A path without what repeats itself.
        let mut distinct = path.clone();
        distinct.dedup();
        let limits = *formation.limits(edge.follower);
        let judge = Judge { path: distinct, limits, distance_min, heading: law.law.heading };
        let rays = (0..=BEARINGS).map(|k| {
            let bearing = std::f64::consts::TAU * (k as f64 / BEARINGS as f64 - 0.5);
            judge.ray(bearing, far)
        });
        all[index] = Some(Reach {
            edge: index,
            rays: rays.collect(),
            set_point: value,
            refused: judge.against(value[0], value[1]),
            far,
        });
        paths[edge.follower] = own;
    }
    Ok(all.into_iter().flatten().collect())
}

/// Whether a scene's set points move, so that one of them does not stand for all.
pub fn moving(scene: &Scene) -> bool {
    let still = |channel: &ScalarTrajectory| matches!(channel, ScalarTrajectory::Constant(_));
    let moves = |wanted: &Option<ScalarTrajectory>| wanted.as_ref().is_some_and(|wanted| !still(wanted));
    scene.edges().any(|(_, _, leader)| moves(&leader.distance) || moves(&leader.bearing))
}

fn place([distance, bearing]: [f64; 2]) -> [f64; 2] {
    [distance * math::cos(bearing), distance * math::sin(bearing)]
}

/// How far the heading that a bearing is held against is behind a leader's that drives steadily on its circle, rad.
fn behind(heading: &Heading, leader: &MotionInput) -> f64 {
    heading.filter().map_or(0.0, |filter| filter.steady(leader.speed, leader.turn_rate))
}

struct Judge {
    path: Vec<MotionInput>,
    limits: Limits,
    distance_min: f64,
    heading: Heading,
}

impl Judge {
    fn against(&self, distance: f64, bearing: f64) -> Option<Infeasible> {
        self.path.iter().find_map(|leader| {
            let place = place([distance, bearing - behind(&self.heading, leader)]);
            infeasible(place, leader, &self.limits, self.distance_min)
        })
    }

    fn ray(&self, bearing: f64, far: f64) -> ReachRay {
        // The least distance itself can be held by rounding only.
        let near = self.distance_min * (1.0 + 1e-9);
        let at = |k: u32| near + (far - near) * f64::from(k) / f64::from(DISTANCES);
        let mut good = near;
        for k in 0..=DISTANCES {
            if self.against(at(k), bearing).is_none() {
                good = at(k);
                continue;
            }
            let (mut low, mut high) = (good, at(k));
            for _ in 0..30 {
                let middle = f64::midpoint(low, high);
                if self.against(middle, bearing).is_none() { low = middle } else { high = middle }
            }
            return ReachRay { bearing, distance: low, end: self.against(high, bearing) };
        }
        ReachRay { bearing, distance: far, end: None }
    }
}
