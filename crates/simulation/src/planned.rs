//! Lead robots that have goals: the way of each is planned for all robots that follow it, before the run begins.

use crate::caption::short;
use crate::error::BuildError;
use formation::column::{cartesian, column};
use formation::{EdgeLaw, Graph, Heading};
use planning::{
    BodyShape, Boundary, Convex, FollowerModel, FormationModel, HeadingLag, Map, Mission, MotionPlan, NoWay,
    NoWayReason, PlanError, PlanGoal, PlanPoint, PlanRequest, PlanStart, TravelLimits, plan_tour,
};
use scene::{Path, PropMotion, Role, Scene, Travel};
use std::collections::BTreeMap;
use std::sync::Arc;
use vocabulary::{MotionInput, Pose, Solid, Trajectory, math};

/// A motion along plans, one after the other, with stops between.
#[derive(Debug, Clone)]
pub struct PlannedMotion {
    parts: Vec<Part>,
    /// The robots that the plans hold for, by their numbers in the run, the lead first.
    pub robots: Vec<usize>,
    /// Levels of the formation, from its shape to its column.
    pub levels: usize,
}

/// A plan, and when it begins, s.
#[derive(Debug, Clone)]
struct Part {
    begins: f64,
    plan: MotionPlan,
}

impl PlannedMotion {
    /// The plans, each with when it begins, s.
    pub fn plans(&self) -> impl Iterator<Item = (f64, &MotionPlan)> {
        self.parts.iter().map(|part| (part.begins, &part.plan))
    }

    /// When the lead is at its last goal, s.
    pub fn ends(&self) -> f64 {
        self.parts.last().map_or(0.0, |part| part.begins + part.plan.duration())
    }
}

impl Trajectory for PlannedMotion {
    fn at(&self, time: f64) -> MotionInput {
        let begun = self.parts.partition_point(|part| part.begins <= time);
        let Some(part) = begun.checked_sub(1).and_then(|index| self.parts.get(index)) else {
            return MotionInput::default();
        };
        motion(&part.plan.points, time - part.begins)
    }
}

/// Between two points of a plan the lead gains speed or brakes evenly, and its curvature changes evenly with its way.
fn motion(points: &[PlanPoint], time: f64) -> MotionInput {
    let after = points.partition_point(|point| point.time <= time);
    let (Some(a), Some(b)) = (after.checked_sub(1).and_then(|index| points.get(index)), points.get(after))
    else {
        return MotionInput::default();
    };
    let (span, way) = (b.time - a.time, b.way - a.way);
    let acceleration = (b.speed - a.speed) / span;
    let since = time - a.time;
    let speed = a.speed + acceleration * since;
    let gone = (a.speed + 0.5 * acceleration * since).abs() * since;
    let sharpness = if way > 0.0 { (b.curvature - a.curvature) / way } else { 0.0 };
    let curvature = a.curvature + sharpness * gone;
    MotionInput {
        speed,
        acceleration,
        turn_rate: curvature * speed,
        turn_acceleration: curvature * acceleration + sharpness * speed.abs() * speed,
    }
}

/// The motions of all lead robots that have goals, by their numbers.
///
/// # Errors
/// There is no way to a goal: with the reason, and with what there is a way for.
pub(crate) fn planned(
    scene: &Scene,
    graph: &Graph,
    laws: &[EdgeLaw],
) -> Result<BTreeMap<usize, Arc<PlannedMotion>>, BuildError> {
    let mut found = BTreeMap::new();
    for (lead, robot) in scene.robots.iter().enumerate() {
        let Role::Lead { path } = &robot.role else { continue };
        let (goals, pause, rounds, travel) = match path {
            Path::Goal { pose, travel } => (std::slice::from_ref(pose), 0.0, 1, travel),
            Path::Tour { goals, pause, rounds, travel } => (goals.as_slice(), *pause, *rounds, travel),
            _ => continue,
        };
        let goals: Vec<PlanGoal> = (0..rounds)
            .flat_map(|_| goals)
            .map(|goal| PlanGoal { heading: goal.heading, ..PlanGoal::to(goal.position) })
            .collect();
        let convoy = Convoy::of(scene, graph, laws, lead);
        let invalid = |error: planning::InputError| BuildError::Plan {
            robot: robot.name.clone(),
            why: error.to_string(),
        };
        let model = convoy.model(scene).map_err(invalid)?;
        let (map, props) = map(scene, robot.pose, &goals, &model, travel).map_err(invalid)?;
        let limits = convoy.limits(scene, travel);
        let start = PlanStart::at(robot.pose);
        let mission = Mission { start, goal: goals[0] };
        let request = PlanRequest::new(&map, &model, limits, mission);
        let plans = plan_tour(&request, &goals, &mut |_| false).map_err(|error| {
            let at = if goals.len() > 1 { format!("to goal {}: ", error.goal + 1) } else { String::new() };
            let why = match &error.error {
                PlanError::Input(error) => error.to_string(),
                PlanError::NoWay(no_way) => told(no_way, scene, &convoy.robots, &props),
            };
            BuildError::Plan { robot: robot.name.clone(), why: format!("{at}{why}") }
        })?;
        let mut begins = 0.0;
        let parts = plans.into_iter().map(|plan| {
            let part = Part { begins, plan };
            begins += part.plan.duration() + pause;
            part
        });
        found.insert(
            lead,
            Arc::new(PlannedMotion { parts: parts.collect(), robots: convoy.robots, levels: model.levels() }),
        );
    }
    Ok(found)
}

/// A lead robot and all that follow it.
struct Convoy {
    /// Numbers of its robots in the scene, each after the one that it follows.
    robots: Vec<usize>,
    followers: Vec<ConvoyMember>,
}

/// A follower of a convoy.
struct ConvoyMember {
    /// Place of its leader in the convoy.
    leader: usize,
    /// [forward, left] of its leader in the shape and in the column, m; only the first where it does not file in.
    places: [Option<[f64; 2]>; 2],
    heading: Option<HeadingLag>,
    /// How fast its place moves, m/s, and how strongly that changes, m/s².
    moves: Option<[f64; 2]>,
}

impl Convoy {
    fn of(scene: &Scene, graph: &Graph, laws: &[EdgeLaw], lead: usize) -> Self {
        let wide: Vec<[f64; 2]> = laws.iter().map(|law| cartesian(law.set_point.at(0.0).value)).collect();
        let filings: Vec<_> = laws.iter().map(|law| law.narrowing.as_ref().map(|rule| rule.filing)).collect();
        let filed = column(graph, &wide, &filings);
        let mut place_of = vec![None; scene.robots.len()];
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
                Heading::Path(filter) => Some(HeadingLag { length: filter.length, lag: filter.lag }),
                Heading::Leader => None,
            };
            followers.push(ConvoyMember {
                leader,
                places: [Some(wide[index]), law.narrowing.as_ref().map(|_| filed[index])],
                heading,
                moves: law.narrowing.as_ref().map(|rule| [rule.rate, rule.acceleration]),
            });
        }
        Self { robots, followers }
    }

    /// As planning sees it. Who does not file in keeps its place while others do.
    fn model(&self, scene: &Scene) -> Result<FormationModel, planning::InputError> {
        let narrows = self.followers.iter().any(|follower| follower.moves.is_some());
        let steps = if narrows { LEVELS } else { 0 };
        let body = |robot: usize| shape(&scene.robots[robot]);
        let followers = self.followers.iter().zip(&self.robots[1..]).map(|(follower, robot)| {
            let [wide, column] = follower.places;
            let wide = wide.unwrap_or_default();
            let ends = [wide, column.unwrap_or(wide)];
            FollowerModel::narrowing(follower.leader, ends, steps, body(*robot))
                .with_heading(follower.heading)
        });
        FormationModel::new(body(self.robots[0]), followers.collect())
    }

    fn limits(&self, scene: &Scene, travel: &Travel) -> TravelLimits {
        let usual = TravelLimits::default();
        let vehicles = || self.robots.iter().map(|robot| &scene.robots[*robot].vehicle);
        let lead = &scene.robots[self.robots[0]].vehicle;
        let limits = lead.limits();
        let long = vehicles().map(|vehicle| vehicle.body().length).fold(0.0, f64::max);
        // A vehicle of another size turns as much on its own length.
        let scale = USUAL_LENGTH / long;
        let curvature = (usual.curvature * scale).min(STEERING_USED * limits.curvature_max);
        let steering = (usual.steering * scale).min(if lead.kind.steers() {
            STEERING_USED * lead.steering_rate / lead.wheelbase
        } else {
            f64::INFINITY
        });
        let followers = || vehicles().skip(1).map(scene::Vehicle::limits);
        let outer = followers().map(|limits| limits.speed_max).fold(f64::INFINITY, f64::min).min(FASTEST);
        let speed = travel.speed.min(limits.speed_max);
        let outer = if self.robots.len() > 1 { SPEED_USED * outer } else { speed.max(usual.outer) };
        let tightest = followers().map(|limits| limits.curvature_max).fold(f64::INFINITY, f64::min);
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
/// Nobody is taken to be faster, m/s.
const FASTEST: f64 = 1000.0;
/// What a formation may go around, m, besides its own size.
const AROUND: f64 = 10.0;

/// A body's middle is half a wheelbase ahead of the pose.
fn shape(robot: &scene::Robot) -> BodyShape {
    let body = robot.vehicle.body();
    BodyShape::Rectangle {
        front: 0.5 * (body.length + body.wheelbase),
        back: 0.5 * (body.length - body.wheelbase),
        half_width: 0.5 * body.width,
    }
}

/// What stands and is in the way of the highest robot, with its names. The ground is what the formation may need around
/// its start, its goals and all of that.
fn map(
    scene: &Scene,
    start: Pose,
    goals: &[PlanGoal],
    model: &FormationModel,
    travel: &Travel,
) -> Result<(Map, Vec<String>), planning::InputError> {
    let height = scene.robots.iter().map(|robot| robot.vehicle.body().height).fold(0.0, f64::max);
    let standing = scene
        .props
        .iter()
        .filter(|prop| !matches!(prop.motion, PropMotion::Guided { .. }) && prop.elevation < height);
    let (mut obstacles, mut names) = (vec![], vec![]);
    for prop in standing {
        obstacles.push(match prop.solid {
            Solid::Cylinder { radius, .. } | Solid::Cone { radius, .. } => {
                Convex::disc([prop.pose.x, prop.pose.y], radius)?
            }
            Solid::Block { size } | Solid::Wedge { size } => {
                Convex::rectangle(prop.pose, [0.5 * size[0], 0.5 * size[1]])?
            }
        });
        names.push(prop.name.clone());
    }
    let around = AROUND
        + (0..model.levels())
            .flat_map(|level| model.places(level))
            .fold(0.0, |most: f64, place| most.max(math::hypot(place[0], place[1])));
    let places = [[start.x, start.y]].into_iter().chain(goals.iter().map(|goal| goal.position));
    let things = obstacles.iter().flat_map(|thing| {
        let ([x, y], reach) = (thing.centre(), thing.reach());
        [[x - reach, y - reach], [x + reach, y + reach]]
    });
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for place in places.chain(things) {
        for k in 0..2 {
            low[k] = low[k].min(place[k] - around);
            high[k] = high[k].max(place[k] + around);
        }
    }
    let ground = Convex::polygon(&[low, [high[0], low[1]], high, [low[0], high[1]]])?;
    Ok((Map::new(ground, obstacles, travel.clearance)?, names))
}

/// Why there is no way, with the names of the scene.
fn told(no_way: &NoWay, scene: &Scene, robots: &[usize], props: &[String]) -> String {
    let thing = |boundary: &Boundary| match boundary {
        Boundary::Obstacle(index) => {
            props.get(*index).map_or_else(|| boundary.to_string(), |name| format!("`{name}`"))
        }
        Boundary::Ground(_) => "the edge of the map".to_owned(),
    };
    let robot = |index: usize| {
        robots
            .get(index)
            .map_or_else(|| format!("robot {index}"), |robot| format!("`{}`", scene.robots[*robot].name))
    };
    let mut text = match &no_way.reason {
        NoWayReason::StartBlocked { robot: index, by } => {
            format!(
                "{} starts too near to {}: move it, or ask for less `clearance`",
                robot(*index),
                thing(by)
            )
        }
        NoWayReason::GoalBlocked { by } => {
            format!("at its goal it is too near to {}: move the goal, or ask for less `clearance`", thing(by))
        }
        reason => reason.to_string(),
    };
    if let Some(gap) = &no_way.gap {
        let [a, b] = &gap.between;
        let [x, y] = gap.at.map(|value| short((10.0 * value).round() / 10.0));
        let width = short((100.0 * gap.width).round() / 100.0);
        text += &format!(
            "; what is in the way is the gap of {width} m between {} and {} at [{x}, {y}]",
            thing(a),
            thing(b)
        );
    }
    if let Some(offer) = &no_way.offer {
        text += &format!("; there is {offer}");
    }
    text
}
