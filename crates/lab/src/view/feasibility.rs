//! Ground that is infeasible for the follower of an edge, for shading.

use crate::app_state::AppState;
use crate::session::prediction::Prediction;
use formation::Heading;
use formation::feasible::infeasible;
use vocabulary::math;
use vocabulary::{Limits, MotionInput, Pose, StepRecord};

/// Size of a cell, m.
pub const STEP: f64 = 0.25;
/// Number of cells along a side of the map.
pub const SIDE: usize = 49;
/// Number of the leader's predicted motions that are checked.
const GLANCES: usize = 12;

/// The requirements of an edge on a set point.
#[derive(Debug, Clone)]
pub struct PlaceConstraints {
    /// The follower's limits.
    pub limits: Limits,
    /// Least distance of its law, m.
    pub distance_min: f64,
    /// Sensor range, m, and largest viewing angle, rad; `None` if it senses the truth.
    pub sight: Option<[f64; 2]>,
    /// Against what heading the bearing is held, and how far that is behind the leader's now, rad.
    pub heading: (Heading, f64),
    /// Positions of other robots in the leader's frame, m, and their least distances, m.
    pub others: Vec<([f64; 2], f64)>,
}

impl PlaceConstraints {
    /// Whether a place is infeasible while the leader moves at one of `motions` (m/s, rad/s).
    pub fn refuses(&self, place: [f64; 2], motions: &[[f64; 2]]) -> bool {
        self.others.iter().any(|(at, near)| math::hypot(place[0] - at[0], place[1] - at[1]) < *near)
            || motions.iter().any(|motion| self.refuses_at(place, *motion))
    }

    fn refuses_at(&self, place: [f64; 2], [speed, turn_rate]: [f64; 2]) -> bool {
        let leader = MotionInput { speed, turn_rate, ..MotionInput::default() };
        // A place turns against its leader as its heading's lag changes.
        let (heading, now) = self.heading;
        let lag = heading.filter().map_or(0.0, |filter| now - filter.steady(speed, turn_rate));
        let place = Pose::new(0.0, 0.0, lag).world_from_body(place[0], place[1]);
        if infeasible(place, &leader, &self.limits, self.distance_min).is_some() {
            return true;
        }
        let Some([far, pan]) = self.sight else { return false };
        // The follower's heading, and the leader's direction from it.
        let heading = math::atan2(turn_rate * place[0], speed - turn_rate * place[1]);
        let to_leader = math::atan2(-place[1], -place[0]);
        math::hypot(place[0], place[1]) > far || vocabulary::wrap(to_leader - heading).abs() > pan
    }
}

/// The leader of `edge` and the map around it, as [`shade`] returns it.
pub fn field(app_state: &AppState, edge: usize, record: &StepRecord) -> Option<(Pose, Vec<f32>)> {
    let fleet = app_state.fleet()?;
    let ends = record.edge(fleet, edge)?;
    let (robot, _, follow) = app_state.follower(edge)?;
    if follow.leaders.are_several() {
        // What its law asks of it there is the law's.
        return None;
    }
    let scene = app_state.scene_now()?;
    let leader = record.snapshot.robots.get(ends.leader)?;
    let measures = follow.sensing.kind != scene::SensingKind::Truth;
    let camera_model = &fleet.robots.get(robot)?.camera_model;
    // A cell of a tag must be at least two pixels wide to be read.
    let cell = fleet.robots.get(ends.leader)?.shell.as_ref().map_or(0.015, |shell| shell.cell);
    let far = camera_model.focal * cell / 2.0;
    let half_picture = math::atan(0.5 * f64::from(camera_model.width) / camera_model.focal);
    let body = &fleet.robots[robot].body;
    let reach = math::hypot(body.length, body.width);
    let others = record.pairs(fleet).filter(|(k, other, _)| *k != edge && other.leader == ends.leader);
    let places = others.map(|(_, _, state)| {
        let [distance, bearing] = state.set_point;
        ([distance * math::cos(bearing), distance * math::sin(bearing)], reach)
    });
    let wanted = PlaceConstraints {
        limits: scene.robots.get(robot)?.limits(),
        distance_min: follow.law.distance_min,
        sight: measures.then_some([far, scene.vision.pan_max + half_picture]),
        heading: (
            simulation::edge_law(follow, &follow.leaders.first, [0.0; 2]).law.heading,
            record.edges.get(edge)?.behind,
        ),
        others: places.chain([([0.0; 2], reach)]).collect(),
    };
    let motions =
        motions(app_state.prediction.as_ref(), ends.leader, [leader.motion.speed, leader.motion.turn_rate]);
    Some((leader.motion.pose, shade(&wanted, &motions)))
}

/// The leader's present and predicted motions.
fn motions(prediction: Option<&Prediction>, leader: usize, now: [f64; 2]) -> Vec<[f64; 2]> {
    let ahead = prediction.and_then(|prediction| prediction.motions.get(leader)).map_or(&[][..], |all| all);
    let every = (ahead.len() / GLANCES).max(1);
    [now].into_iter().chain(ahead.iter().step_by(every).copied()).collect()
}

/// The map of infeasible set points in the leader's frame: opacities from 0 to 1, row by row from behind to ahead,
/// each from the right to the left.
pub fn shade(wanted: &PlaceConstraints, motions: &[[f64; 2]]) -> Vec<f32> {
    let half = 0.5 * (SIDE - 1) as f64 * STEP;
    let alpha = |square: usize| {
        let place = [square / SIDE, square % SIDE].map(|k| k as f64 * STEP - half);
        let away = math::hypot(place[0], place[1]) / half;
        // It fades towards its rim, so that the square is not visible.
        let rim = ((1.0 - away) / 0.2).clamp(0.0, 1.0) as f32;
        if wanted.refuses(place, motions) { rim } else { 0.0 }
    };
    (0..SIDE * SIDE).map(alpha).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use formation::PathFilter;

    fn wanted() -> PlaceConstraints {
        PlaceConstraints {
            limits: Limits::PAPER,
            distance_min: 0.1,
            sight: None,
            heading: (Heading::Leader, 0.0),
            others: vec![],
        }
    }

    #[test]
    fn a_straight_way_leaves_all_ground_and_a_bend_takes_the_outside() {
        let free = shade(&wanted(), &[[1.0, 0.0]]);
        let taken = shade(&wanted(), &[[1.0, 0.3]]);
        let count = |alphas: &[f32]| alphas.iter().filter(|a| **a > 0.0).count();
        // Places nearer than the law allows.
        assert_eq!(count(&free), 1);
        assert!(count(&taken) > 300);
    }

    #[test]
    fn who_looks_has_to_see() {
        let measuring = PlaceConstraints { sight: Some([4.0, 2.0]), ..wanted() };
        assert!(measuring.refuses([-4.5, 0.0], &[[1.0, 0.0]]), "too far");
        assert!(measuring.refuses([2.0, 0.0], &[[1.0, 0.0]]), "behind the camera");
        assert!(!measuring.refuses([-2.0, 1.0], &[[1.0, 0.0]]));
    }

    #[test]
    fn a_place_turns_with_its_headings_lag() {
        let filter = PathFilter { length: 1.0, lag: 1.0 };
        let turned = PlaceConstraints { heading: (Heading::Path(filter), 0.0), ..wanted() };
        let bend = [1.0, 0.3];
        let place =
            |distance: f64, bearing: f64| [distance * math::cos(bearing), distance * math::sin(bearing)];
        for bearing in [-2.5, -1.2, 0.4, 2.0] {
            for distance in [1.0, 2.0, 2.6, 3.2] {
                let refused = turned.refuses(place(distance, bearing), &[bend]);
                assert_eq!(refused, wanted().refuses(place(distance, bearing - 0.3), &[bend]));
            }
        }
    }

    #[test]
    fn nobody_stands_where_another_does() {
        let crowded = PlaceConstraints { others: vec![([-1.0, 1.0], 0.5)], ..wanted() };
        assert!(crowded.refuses([-1.2, 1.2], &[[1.0, 0.0]]) && !crowded.refuses([-2.0, 1.0], &[[1.0, 0.0]]));
    }
}
