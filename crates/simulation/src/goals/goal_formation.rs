//! A lead robot and all that follow it, as planning sees them.

use formation::column::{cartesian, column};
use formation::{EdgeLaw, Graph, Heading};
use planning::{BodyShape, FollowerModel, FormationModel, InputError, TravelLimits};
use scene::{Travel, Vehicle};
use vocabulary::{Limits, PathFilter};

/// A lead robot and all that follow it.
pub(super) struct GoalFormation {
    /// Numbers of its robots in the scene, each after the one that it follows.
    pub(super) robots: Vec<usize>,
    pub(super) followers: Vec<FormationMember>,
}

/// A follower in the formation.
pub(super) struct FormationMember {
    /// Number of its edge.
    pub(super) edge: usize,
    /// Place of its leader among the robots.
    leader: usize,
    /// [forward, left] of its leader in the shape and in the column, m; only the first where it does not file in.
    places: [Option<[f64; 2]>; 2],
    pub(super) heading: Option<PathFilter>,
    /// How fast its place moves, m/s, and how strongly that changes, m/s².
    moves: Option<[f64; 2]>,
}

impl GoalFormation {
    /// That of `lead` in a graph as it is, with set points as at `time` s.
    pub(super) fn of(graph: &Graph, laws: &[EdgeLaw], lead: usize, time: f64) -> Self {
        let wide: Vec<[f64; 2]> = laws.iter().map(|law| cartesian(law.set_point.at(time).value)).collect();
        let filings: Vec<_> = laws.iter().map(|law| law.narrowing.as_ref().map(|rule| rule.filing)).collect();
        let filed = column(graph, &wide, &filings);
        let mut place_of = vec![None; graph.robots()];
        place_of[lead] = Some(0);
        let (mut robots, mut followers) = (vec![lead], vec![]);
        for &index in graph.evaluation_order() {
            let (edge, law) = (graph.edges()[index], &laws[index]);
            // Of two leaders the first counts.
            let Some(leader) = place_of[edge.leader].filter(|_| place_of[edge.follower].is_none()) else {
                continue;
            };
            place_of[edge.follower] = Some(robots.len());
            robots.push(edge.follower);
            let heading = match law.law.heading {
                Heading::Path(filter) => Some(filter),
                Heading::Leader => None,
            };
            followers.push(FormationMember {
                edge: index,
                leader,
                places: [Some(wide[index]), law.narrowing.as_ref().map(|_| filed[index])],
                heading,
                moves: law.narrowing.as_ref().map(|rule| [rule.rate, rule.acceleration]),
            });
        }
        Self { robots, followers }
    }

    /// As planning sees it. Who does not file in keeps its place while others do.
    ///
    /// # Errors
    /// Bodies or places that make no sense.
    pub(super) fn model(&self, vehicles: &[Vehicle]) -> Result<FormationModel, InputError> {
        let narrows = self.followers.iter().any(|follower| follower.moves.is_some());
        let steps = if narrows { LEVELS } else { 0 };
        let body = |robot: usize| shape(&vehicles[robot]);
        let followers = self.followers.iter().zip(&self.robots[1..]).map(|(follower, robot)| {
            let [wide, column] = follower.places;
            let wide = wide.unwrap_or_default();
            let ends = [wide, column.unwrap_or(wide)];
            FollowerModel::narrowing(follower.leader, ends, steps, body(*robot))
                .with_heading(follower.heading)
        });
        FormationModel::new(body(self.robots[0]), followers.collect())
    }

    /// How sharply and how fast it may drive.
    pub(super) fn limits(&self, vehicles: &[Vehicle], travel: &Travel) -> TravelLimits {
        let usual = TravelLimits::default();
        let members = || self.robots.iter().map(|robot| &vehicles[*robot]);
        let lead = &vehicles[self.robots[0]];
        let limits = lead.limits();
        let long = members().map(|vehicle| vehicle.body().length).fold(0.0, f64::max);
        // A vehicle of another size turns as much on its own length.
        let scale = USUAL_LENGTH / long;
        let curvature = (usual.curvature * scale).min(STEERING_USED * limits.curvature_max);
        let steering = (usual.steering * scale).min(if lead.kind.steers() {
            STEERING_USED * lead.steering_rate / lead.wheelbase
        } else {
            f64::INFINITY
        });
        let followers = || members().skip(1).map(Vehicle::limits);
        let outer = followers().map(|limits| limits.speed_max).fold(f64::INFINITY, f64::min).min(FASTEST);
        let speed = travel.speed.min(limits.speed_max);
        let outer = if self.robots.len() > 1 { SPEED_USED * outer } else { speed.max(usual.outer) };
        let tightest = followers().map(|limits| limits.curvature_max).fold(f64::INFINITY, f64::min);
        let least =
            |of: fn(&Limits) -> f64| followers().map(|limits| of(&limits)).fold(f64::INFINITY, f64::min);
        let turn_rate = least(|limits| limits.turn_rate_max);
        let gains = least(|limits| limits.acceleration_max);
        let moves = |k: usize, otherwise: f64| {
            let own = self.followers.iter().filter_map(|follower| Some(follower.moves?[k]));
            own.min_by(f64::total_cmp).unwrap_or(otherwise)
        };
        let acceleration = travel.acceleration.min(limits.acceleration_max);
        TravelLimits {
            curvature,
            sharpness: usual.sharpness * scale * scale,
            steering,
            speed,
            acceleration,
            braking: acceleration,
            lateral: usual.lateral.min(STEERING_USED * limits.lateral_acceleration_max),
            outer,
            turning: speed.min(outer),
            follower_curvature: tightest.is_finite().then_some(STEERING_USED * tightest),
            follower_turn_rate: turn_rate.is_finite().then_some(STEERING_USED * turn_rate),
            follower_acceleration: gains.is_finite().then_some(CHANGES_USED * gains),
            place_rate: moves(0, usual.place_rate),
            place_acceleration: moves(1, usual.place_acceleration),
            reverses: false,
        }
    }
}

/// Levels from the shape to the column.
const LEVELS: usize = 4;
/// Length of the robots for which the usual limits of planning are meant, m.
const USUAL_LENGTH: f64 = 0.42;
/// What a plan uses of what wheels can do: the rest is for keeping to it.
const STEERING_USED: f64 = 0.8;
/// The same of the speed of followers.
const SPEED_USED: f64 = 0.9;
/// What a plan uses of what followers can gain and brake, where their places on a curve ask for it. Lead and law ask for more.
const CHANGES_USED: f64 = 0.5;
/// Nobody is taken to be faster, m/s.
const FASTEST: f64 = 1000.0;
/// A body's middle is half a wheelbase ahead of the pose.
pub(super) fn shape(vehicle: &Vehicle) -> BodyShape {
    let body = vehicle.body();
    BodyShape::Rectangle {
        front: 0.5 * (body.length + body.wheelbase),
        back: 0.5 * (body.length - body.wheelbase),
        half_width: 0.5 * body.width,
    }
}
