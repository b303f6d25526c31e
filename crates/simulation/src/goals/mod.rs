//! Lead robots that have goals: the way of each is planned for all robots that follow it, before the run begins, and again
//! where something is found in the way.
//!
//! ```text
//! goal_formation  a lead and its followers, as planning sees them
//! known_things    what stands and moves around them
//! navigator       one lead: its goals, its plan, what it is up to
//! motion          the plan as a motion
//! replan          what is found on the way, and what is done about it
//! plan_names      why there is no way, in the names of the scene
//! ```

mod goal_formation;
mod known_things;
mod motion;
mod navigator;
mod plan_names;
mod replan;

pub use motion::{PlannedMotion, PlannedPart};
pub use navigator::GoalWish;
pub(crate) use navigator::PlanPurpose;
pub(crate) use replan::navigate;

use crate::error::BuildError;
use formation::{EdgeLaw, Graph};
use goal_formation::GoalFormation;
use known_things::KnownThings;
use navigator::{Departure, GOALS_MOST, Navigator, Phase, PlanTask};
use plan_names::PlanNames;
use planning::{PlanGoal, PlanStart};
use scene::{Path, Robot, Role, Scene, Vehicle};
use std::sync::Arc;
use vocabulary::{EntityId, PlannedPath};

/// All lead robots of a run that have goals.
#[derive(Debug, Clone, Default)]
pub struct Goals {
    navigators: Vec<Navigator>,
    surroundings: Arc<KnownThings>,
    vehicles: Arc<Vec<Vehicle>>,
    /// What the safety filter of each robot keeps free beside its body, m.
    rooms: Arc<Vec<f64>>,
    /// When it is time to look round again, s.
    looks: f64,
    /// How many plans have been made since the run began.
    version: u64,
    /// Plans that no record has yet.
    pub(crate) told: Vec<Arc<PlannedPath>>,
}

impl Goals {
    /// Whether no robot has goals.
    pub fn is_empty(&self) -> bool {
        self.navigators.is_empty()
    }

    /// The motions of all lead robots that have goals, by their numbers, in the order in which they were planned: who comes later
    /// yields to those before.
    pub fn motions(&self) -> impl Iterator<Item = (usize, &Arc<PlannedMotion>)> {
        self.navigators.iter().map(|navigator| (navigator.lead, &navigator.motion))
    }

    /// What all of them want.
    pub(crate) fn wishes(&self) -> Vec<(usize, Arc<GoalWish>)> {
        self.navigators.iter().map(|navigator| (navigator.lead, navigator.wish.clone())).collect()
    }

    /// They want something else from now on, and look for a way at the next sample.
    pub(crate) fn adopt(&mut self, wishes: &[(usize, Arc<GoalWish>)]) {
        for (lead, wish) in wishes {
            let Some(navigator) = self.navigators.iter_mut().find(|own| own.asked == *lead) else { continue };
            if navigator.wish != *wish {
                navigator.wants(wish.clone());
                self.looks = 0.0;
            }
        }
    }

    /// The motion of a lead robot, if it has goals.
    pub fn motion_of(&self, robot: usize) -> Option<&Arc<PlannedMotion>> {
        self.motions().find(|(lead, _)| *lead == robot).map(|(_, motion)| motion)
    }
}

/// Plans for all lead robots that have goals.
///
/// # Errors
/// There is no way to a goal: with the reason, and with what there is a way for.
pub(crate) fn goals(
    scene: &Scene,
    graph: &Graph,
    laws: &[EdgeLaw],
    purpose: PlanPurpose,
) -> Result<Goals, BuildError> {
    let mut asked = wishes(&scene.robots);
    if asked.is_empty() {
        return Ok(Goals::default());
    }
    // Of the same priority those come first that the scene names first.
    asked.sort_by_key(|(lead, wish)| (std::cmp::Reverse(wish.travel.priority), *lead));
    let robot_of = |lead: usize| scene.robots[lead].name.clone();
    let invalid = |lead: usize, error: &planning::InputError| BuildError::Plan {
        robot: robot_of(lead),
        why: error.to_string(),
    };
    let surroundings = KnownThings::of(scene).map_err(|error| invalid(asked[0].0, &error))?;
    let vehicles: Vec<Vehicle> = scene.robots.iter().map(|robot| robot.vehicle).collect();
    let rooms: Vec<f64> = scene.robots.iter().map(room_beside).collect();
    let standing = surroundings.standing_at_first();
    let mut moving = surroundings.moving(|index| surroundings.things[index].known);
    let mut navigators: Vec<Navigator> = vec![];
    for (lead, wish) in asked {
        if wish.goals.len() > GOALS_MOST {
            let goals = wish.goals.len();
            let why = format!(
                "{goals} goals over all rounds: at most {GOALS_MOST} are planned before a run begins"
            );
            return Err(BuildError::Plan { robot: robot_of(lead), why });
        }
        let formation = GoalFormation::of(graph, laws, lead, 0.0);
        let model = formation.model(&vehicles).map_err(|error| invalid(lead, &error))?;
        let limits = formation.limits(&vehicles, &wish.travel);
        let filtered = formation.robots.iter().any(|robot| rooms[*robot] > 0.0);
        let task = PlanTask {
            model: &model,
            limits,
            standing: &standing,
            moving: &moving,
            filtered,
            purpose,
            explains: true,
        };
        let departure = Departure { start: PlanStart::at(scene.robots[lead].pose), held: None, time: 0.0 };
        let parts = wish.parts(&task, &departure, 0, wish.clearance(&rooms, &formation.robots)).map_err(
            |(goal, error)| {
                let name = |whose: EntityId| match whose {
                    EntityId::Robot(index) => robot_of(index),
                    EntityId::Prop(index) => scene.props[index].name.clone(),
                    EntityId::Ground => "the ground".to_owned(),
                };
                let moving: Vec<EntityId> = moving.iter().map(|(whose, _)| *whose).collect();
                let names = PlanNames {
                    name: &name,
                    robots: &formation.robots,
                    standing: &standing,
                    moving: &moving,
                    from: goal.checked_sub(1).and_then(|before| wish.on_tour(before)),
                };
                let to = wish.on_tour(goal).map_or_else(String::new, |goal| format!("to {goal}: "));
                let why = format!("{to}{}", names.why(&error));
                BuildError::Plan { robot: robot_of(lead), why }
            },
        )?;
        let navigator = Navigator {
            lead,
            asked: lead,
            wish,
            motion: Arc::new(PlannedMotion { parts, robots: formation.robots, levels: model.levels() }),
            phase: Phase::Drives,
            knows: surroundings.things.iter().map(|thing| thing.known).collect(),
            places: surroundings.things.iter().map(|thing| thing.pose).collect(),
            replans: false,
            version: 0,
            reached: 0,
            since: 0,
        };
        moving.extend(navigator.tracks(&vehicles));
        navigators.push(navigator);
    }
    let told = navigators.iter().map(|navigator| Arc::new(navigator.motion.path(0.0))).collect();
    Ok(Goals {
        version: 0,
        told,
        navigators,
        surroundings: Arc::new(surroundings),
        vehicles: Arc::new(vehicles),
        rooms: Arc::new(rooms),
        looks: 0.0,
    })
}

/// What the safety filter of a robot keeps free beside its body, m: it takes the body for a circle, and keeps that of the point
/// ahead; 0 without a filter.
fn room_beside(robot: &Robot) -> f64 {
    let (body, safety) = (robot.vehicle.body(), &robot.safety);
    if !safety.acts(matches!(robot.role, Role::Lead { .. })) {
        return 0.0;
    }
    let ahead = safety.point_ahead_of(robot.vehicle.kind, body.length);
    body.radius() + safety.margin_of(body.length) + ahead - 0.5 * body.width
}

/// What lead robots with goals want, by their numbers.
pub(crate) fn wishes(robots: &[Robot]) -> Vec<(usize, Arc<GoalWish>)> {
    let of = |(lead, robot): (usize, &Robot)| match &robot.role {
        Role::Lead { path } => Some((lead, Arc::new(wish(path)?))),
        Role::Follow(_) => None,
    };
    robots.iter().enumerate().filter_map(of).collect()
}

/// What a path asks for; `None` where it says how to go instead of where.
fn wish(path: &Path) -> Option<GoalWish> {
    let (goals, pause, rounds, travel) = match path {
        Path::Goal { pose, travel } => (std::slice::from_ref(pose), 0.0, 1, travel),
        Path::Tour { goals, pause, rounds, travel } => (goals.as_slice(), *pause, *rounds, travel),
        _ => return None,
    };
    let round = goals.len();
    let goals = (0..rounds)
        .flat_map(|_| goals)
        .map(|goal| PlanGoal { heading: goal.heading, ..PlanGoal::to(goal.position) })
        .collect();
    Some(GoalWish { goals, round, pause, travel: *travel })
}
