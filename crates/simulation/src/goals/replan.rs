//! What lead robots with goals find on their way, and what they do about it: they stop in time, take another way, or wait for
//! one, but not for ever.

use super::goal_formation::{GoalFormation, shape};
use super::known_things::above;
use super::motion::{PlannedMotion, PlannedPart};
use super::navigator::{Departure, Navigator, Phase, PlanPurpose, PlanTask};
use crate::events::let_stand;
use crate::simulation::Simulation;
use planning::{
    Convex, FormationModel, Meeting, MovingThing, NoWayReason, PlanError, PlanStart, TrackPoint,
    TravelLimits, first_meeting,
};
use std::sync::Arc;
use vocabulary::{EntityId, EventKind, EventRecord, Motion, Pose, TimeMode, Trajectory, math};

/// Time between two looks, s.
const LOOKS: f64 = 0.1;
/// Time between two tries to find a way, s.
const RETRIES: f64 = 1.0;
/// What moves slower than this stands, m/s.
const STANDS: f64 = 0.05;
/// A loose thing that has moved by less, m, stands where it stood.
const MOVED: f64 = 0.05;
/// What moves in an unknown way is taken to go on straight for so long, s.
const GOES_ON: f64 = 2.0;
/// Shares of the clearance that are kept: a plan holds as long as the first is left, and where nothing else is possible a
/// plan may begin with the others.
const KEPT: f64 = 0.6;
const BEGINS_WITH: [f64; 3] = [1.0, 0.5, 0.1];
/// A lead that is farther from its plan, m, plans from where it is.
const OFF: f64 = 0.3;
/// A formation that stops for something does so this much sooner than it would meet it, m.
const SPARE: f64 = 0.15;

/// Lead robots with goals look round, where it is time to.
pub(crate) fn navigate(run: &mut Simulation, time: f64) {
    if run.goals.is_empty() || run.mode == TimeMode::Continuous || time + 1e-9 < run.goals.looks {
        return;
    }
    run.goals.looks = time + LOOKS;
    for index in 0..run.goals.navigators.len() {
        let mut navigator = run.goals.navigators[index].clone();
        let version = run.goals.version;
        look(run, &mut navigator, time);
        hand_out(run, &navigator, time);
        navigator.version = version;
        run.goals.navigators[index] = navigator;
    }
}

fn look(run: &mut Simulation, navigator: &mut Navigator, time: f64) {
    if navigator.phase == Phase::Stays {
        return;
    }
    let Some(succeeded) = find_lead(run, navigator) else {
        navigator.phase = Phase::Stays;
        return;
    };
    arrive(run, navigator, time);
    let formation = GoalFormation::of(run.formation.graph(), run.formation.laws(), navigator.lead, time);
    let found = Sightings::by(run, navigator, &formation, time);
    let others = |robots: &[usize]| {
        let mut robots = robots.to_vec();
        robots.sort_unstable();
        robots
    };
    let changed = succeeded || others(&formation.robots) != others(&navigator.motion.robots);
    let has_goals = navigator.reached < navigator.wish.goals.len();
    match navigator.phase {
        Phase::Waits { since, tried }
            if time - tried >= RETRIES - 1e-9 && time >= navigator.motion.ends() =>
        {
            navigator.phase = Phase::Waits { since, tried: time };
            if plan_again(run, navigator, &formation, &found, time).is_ok() {
                run.events.tell(EventRecord::done(EventKind::Reroute, navigator.lead, None));
            } else if time - since > navigator.wish.travel.patience {
                navigator.phase = Phase::Stays;
                run.events.tell(EventRecord::done(EventKind::GiveUp, navigator.lead, None));
            }
        }
        Phase::Drives if has_goals || navigator.replans => {
            let meeting = found.meeting(run, navigator, &formation, time);
            let blocked = meeting.as_ref().map(|(whose, _)| *whose);
            if !changed && !navigator.replans && blocked.is_none() {
                return;
            }
            navigator.replans = false;
            let told = |kind: EventKind| EventRecord {
                obstacle: blocked,
                ..EventRecord::done(kind, navigator.lead, None)
            };
            let (reroutes, halts) = (told(EventKind::Reroute), told(EventKind::Halt));
            if plan_again(run, navigator, &formation, &found, time).is_ok() {
                run.events.tell(reroutes);
            } else {
                halt(run, navigator, meeting.map(|(_, meeting)| meeting), time);
                run.events.tell(halts);
            }
        }
        _ => {}
    }
}

/// Hands out to followers how far they are to file in.
fn hand_out(run: &mut Simulation, navigator: &Navigator, time: f64) {
    let column = navigator.motion.levels.saturating_sub(1).max(1) as f64;
    let level = navigator.motion.point_at(time).map(|point| point.early_level / column);
    let level = level.filter(|_| navigator.phase != Phase::Stays);
    for robot in &navigator.motion.robots {
        for edge in run.formation.graph().edges_of(*robot) {
            run.state.memories[*edge].narrowing.hand_out(level);
        }
    }
}

/// Whether another robot leads by the plan now, since the one that did has failed; `None` where nobody does.
fn find_lead(run: &Simulation, navigator: &mut Navigator) -> Option<bool> {
    let lead = navigator.lead;
    if run.events.drives(lead) && run.formation.graph().edge_of(lead).is_none() {
        return Some(false);
    }
    let plan = Arc::as_ptr(&navigator.motion).cast::<()>();
    let leads = run.formation.leads().iter();
    let next = leads
        .filter(|(_, motion)| Arc::as_ptr(motion).cast::<()>() == plan)
        .map(|(robot, _)| *robot)
        .next()?;
    navigator.lead = next;
    Some(next != lead)
}

/// Counts the goals that have been reached.
fn arrive(run: &mut Simulation, navigator: &mut Navigator, time: f64) {
    let there = |part: &&PlannedPart| part.goal.is_some() && part.arrives() <= time.min(part.until);
    let parts = navigator.motion.parts().get(navigator.since..).unwrap_or_default();
    let reached = parts.iter().rfind(there).and_then(|part| part.goal).map_or(0, |goal| goal + 1);
    for goal in navigator.reached..reached {
        let goal = navigator.wish.on_tour(goal);
        run.events.tell(EventRecord { goal, ..EventRecord::done(EventKind::Arrive, navigator.lead, None) });
    }
    navigator.reached = navigator.reached.max(reached);
}

/// What a formation knows of what is around it.
struct Sightings {
    standing: Vec<(EntityId, Convex)>,
    moving: Vec<(EntityId, MovingThing)>,
    /// What plans did not know of before the run, or not there.
    new: Vec<(EntityId, Convex)>,
    /// What moves in a way that no plan knows.
    strange: Vec<(EntityId, MovingThing)>,
    /// What goes by a track that plans did not know of: props, and robots that have other plans than before.
    changed: Vec<(EntityId, MovingThing)>,
}

impl Sightings {
    /// Looks round with the proximity sensors of all robots of a formation.
    fn by(run: &Simulation, navigator: &mut Navigator, formation: &GoalFormation, time: f64) -> Self {
        let snapshot = run.snapshot();
        let place = |robot: usize| snapshot.robots[robot].motion.pose;
        let senses = |body: &Convex| {
            formation.robots.iter().any(|robot| {
                let pose = place(*robot);
                run.senses(*robot).is_some_and(|range| body.distance([pose.x, pose.y]) <= range)
            })
        };
        let things = &run.goals.surroundings.things;
        let mut found =
            Self { standing: vec![], moving: vec![], new: vec![], strange: vec![], changed: vec![] };
        for (number, thing) in things.iter().enumerate().filter(|(_, thing)| !thing.overhead) {
            if let Some(track) = &thing.moving {
                navigator.knows[number] |= senses(&track.body_at(time));
                // A plan that was made without it is held against where it goes.
                if navigator.knows[number] && !thing.known {
                    found.changed.push((EntityId::Prop(number), track.clone()));
                }
                continue;
            }
            if navigator.knows[number] && !thing.loose {
                let body = thing.body.moved(thing.pose);
                if !thing.known {
                    found.new.push((EntityId::Prop(number), body.clone()));
                }
                found.standing.push((EntityId::Prop(number), body));
                continue;
            }
            let now = above(&snapshot.props[number]);
            if senses(&thing.body.moved(now)) {
                navigator.knows[number] = true;
                navigator.places[number] = now;
            }
            if navigator.knows[number] {
                let body = thing.body.moved(navigator.places[number]);
                let moved = apart(navigator.places[number], thing.pose) > MOVED;
                if !thing.known || moved {
                    found.new.push((EntityId::Prop(number), body.clone()));
                }
                found.standing.push((EntityId::Prop(number), body));
            }
        }
        found.moving = run.goals.surroundings.moving(|thing| navigator.knows[thing]);
        found.see_robots(run, navigator, formation, &senses, time);
        found
    }

    /// Robots of other formations: those that keep to a plan go by that, the others as they are seen to.
    fn see_robots(
        &mut self,
        run: &Simulation,
        navigator: &Navigator,
        formation: &GoalFormation,
        senses: &dyn Fn(&Convex) -> bool,
        time: f64,
    ) {
        let vehicles = &run.goals.vehicles;
        let others = run.goals.navigators.iter().filter(|other| other.asked != navigator.asked);
        let tracks: Vec<_> = others.flat_map(|other| other.tracks(vehicles)).collect();
        for (robot, state) in run.snapshot().robots.iter().enumerate() {
            if formation.robots.contains(&robot) || !state.is_present() {
                continue;
            }
            let whose = EntityId::Robot(robot);
            let motion = &state.motion;
            let planned = tracks
                .iter()
                .find(|(other, thing)| *other == whose && apart(thing.at(time), motion.pose) < OFF);
            if let Some(track) = planned {
                self.moving.push(track.clone());
                if navigator.version != run.goals.version {
                    self.changed.push(track.clone());
                }
                continue;
            }
            let body = shape(&vehicles[robot]);
            let now = body.at(motion.pose);
            if !senses(&now) {
                continue;
            }
            if motion.speed.abs() < STANDS {
                self.new.push((whose, now.clone()));
                self.standing.push((whose, now));
                continue;
            }
            let (sin, cos) = math::sin_cos(motion.pose.heading);
            let way = motion.speed * GOES_ON;
            let then = Pose { x: motion.pose.x + way * cos, y: motion.pose.y + way * sin, ..motion.pose };
            let track =
                vec![TrackPoint { time, pose: motion.pose }, TrackPoint { time: time + GOES_ON, pose: then }];
            if let Ok(thing) = MovingThing::new(body.at(Pose::default()), track) {
                self.strange.push((whose, thing.clone()));
                self.moving.push((whose, thing));
            }
        }
    }

    /// What is met first on the plan of a navigator, of what it was not made for.
    fn meeting(
        &self,
        run: &Simulation,
        navigator: &Navigator,
        formation: &GoalFormation,
        time: f64,
    ) -> Option<(EntityId, Meeting)> {
        if self.new.is_empty() && self.strange.is_empty() && self.changed.is_empty() {
            return None;
        }
        let vehicles = &run.goals.vehicles;
        let (model, limits) =
            (formation.model(vehicles).ok()?, formation.limits(vehicles, &navigator.wish.travel));
        if model.robots() != navigator.motion.robots.len() {
            return None;
        }
        let robots = &navigator.motion.robots;
        let clearance = KEPT * navigator.wish.clearance(&run.goals.rooms, robots);
        let mut whose = vec![];
        let mut things = vec![];
        for (owner, body) in &self.new {
            let stands = vec![TrackPoint { time: 0.0, pose: Pose::default() }];
            things.extend(MovingThing::new(body.clone(), stands).ok());
            whose.push(*owner);
        }
        let first = |things: &[MovingThing]| {
            let parts = navigator.motion.parts().iter().filter(|part| part.ends() > time);
            parts.clone().find_map(|part| {
                let from = (time - part.begins).max(0.0);
                let met = first_meeting(&part.plan, &model, &limits, clearance, things, part.begins, from)?;
                Some(Meeting { time: met.time + part.begins, ..met })
            })
        };
        for (owner, thing) in &self.changed {
            things.push(thing.clone());
            whose.push(*owner);
        }
        let known = first(&things).map(|met| (whose[met.thing], met));
        let (owners, moving): (Vec<_>, Vec<_>) = self.strange.iter().cloned().unzip();
        let moving =
            first(&moving).filter(|met| met.time < time + GOES_ON).map(|met| (owners[met.thing], met));
        match (known, moving) {
            (Some(a), Some(b)) => Some(if b.1.time < a.1.time { b } else { a }),
            (a, b) => a.or(b),
        }
    }
}

/// Plans to the goals that are left, and drives by that from now on.
fn plan_again(
    run: &mut Simulation,
    navigator: &mut Navigator,
    formation: &GoalFormation,
    found: &Sightings,
    time: f64,
) -> Result<(), PlanError> {
    let vehicles = run.goals.vehicles.clone();
    let model = formation.model(&vehicles)?;
    let limits = formation.limits(&vehicles, &navigator.wish.travel);
    let filtered = formation.robots.iter().any(|robot| run.goals.rooms[*robot] > 0.0);
    let (standing, moving) = (&found.standing, &found.moving);
    let purpose = PlanPurpose::Driving;
    let task = PlanTask { model: &model, limits, standing, moving, filtered, purpose, explains: false };
    let departure = departure(run, navigator, formation, &model, &limits, time);
    let wish = navigator.wish.clone();
    let clearance = wish.clearance(&run.goals.rooms, &formation.robots);
    let mut last = None;
    for share in BEGINS_WITH {
        match wish.parts(&task, &departure, navigator.reached, share * clearance) {
            Ok(parts) => {
                let (robots, levels, new) = (formation.robots.clone(), model.levels(), parts.len());
                let motion = PlannedMotion { robots, levels, ..navigator.motion.then(departure.time, parts) };
                if navigator.since == usize::MAX {
                    navigator.since = motion.parts().len() - new;
                }
                navigator.motion = Arc::new(motion);
                navigator.phase = Phase::Drives;
                take(run, navigator, &departure.start, time);
                return Ok(());
            }
            Err((_, error)) => {
                let starts = matches!(&error, PlanError::NoWay(found) if matches!(found.reason, NoWayReason::StartBlocked { .. }));
                last = Some(error);
                if !starts {
                    break;
                }
            }
        }
    }
    last.map_or(Ok(()), Err)
}

/// Where and how a formation is: on its plan, if it keeps to that.
fn departure(
    run: &Simulation,
    navigator: &Navigator,
    formation: &GoalFormation,
    model: &FormationModel,
    limits: &TravelLimits,
    time: f64,
) -> Departure {
    let now = run.snapshot().robots[navigator.lead].motion;
    let last = (model.levels() - 1) as f64;
    let narrowing = |edge: usize| run.decision(edge).narrowing.clamp(0.0, 1.0);
    let narrowest = formation.followers.iter().map(|follower| narrowing(follower.edge)).fold(0.0, f64::max);
    let planned = navigator.motion.point_at(time).filter(|point| {
        navigator.motion.robots.first() == Some(&navigator.lead) && apart(point.pose, now.pose) < OFF
    });
    let turning = if now.speed > STANDS { now.turn_rate / now.speed } else { 0.0 };
    let (pose, speed, curvature, level) = match planned {
        Some(point) => (point.pose, point.speed.abs(), point.curvature, point.level),
        None => (now.pose, now.speed, turning, narrowest * last),
    };
    let memories = &run.state.memories;
    let held = formation.followers.iter().map(|follower| {
        match (&follower.heading, memories[follower.edge].heading) {
            (None, _) => Some([0.0; 2]),
            (Some(_), heading) => heading.map(|heading| [heading.heading, heading.curvature]),
        }
    });
    // A plan that is to begin later does.
    let waits = navigator.motion.parts().iter().find(|part| part.goal == Some(navigator.reached));
    let begins = waits.filter(|_| speed == 0.0).map_or(time, |part| part.begins.max(time));
    Departure {
        start: PlanStart {
            pose,
            level: level.clamp(0.0, last),
            curvature: curvature.clamp(-limits.curvature, limits.curvature),
            speed: speed.clamp(0.0, limits.speed),
        },
        held: held.collect(),
        time: begins,
    }
}

/// A lead robot drives by its new plan from now on, from where that begins.
fn take(run: &mut Simulation, navigator: &Navigator, start: &PlanStart, time: f64) {
    let lead = navigator.lead;
    run.goals.version += 1;
    run.goals.told.push(Arc::new(navigator.motion.path(time)));
    let motion: Arc<dyn Trajectory> = navigator.motion.clone();
    run.plant.world_mut().release(lead);
    run.chases.end(lead);
    run.formation.set_lead(lead, Some(motion.clone()));
    let_stand(run, lead);
    let ideal = Motion { pose: start.pose, speed: start.speed, ..Motion::default() };
    let limits = *run.formation.limits(lead);
    run.chases.begin(lead, &ideal, limits, &run.fleet.robots[lead], motion, time);
}

/// A formation comes to a stand on its way, before it meets something if that is possible, and waits.
fn halt(run: &mut Simulation, navigator: &mut Navigator, meeting: Option<Meeting>, time: f64) {
    navigator.phase = Phase::Waits { since: time, tried: time };
    let vehicles = &run.goals.vehicles;
    let most = vehicles[navigator.lead].limits().acceleration_max;
    let usual = navigator.wish.travel.acceleration.min(most);
    let Some(part) = navigator.motion.part_at(time).cloned() else { return };
    let Some(point) = part.plan.at_time(time - part.begins) else { return };
    let braking = meeting.map_or(usual, |meeting| {
        let room = (meeting.way - point.way - SPARE).max(1e-3);
        (0.5 * point.speed * point.speed / room).clamp(usual, most)
    });
    let Some(plan) = part.plan.stopped(time - part.begins, braking) else { return };
    let start =
        PlanStart { pose: point.pose, level: point.level, curvature: point.curvature, speed: point.speed };
    let parts = vec![PlannedPart { begins: time, goal: None, until: f64::INFINITY, plan }];
    navigator.motion = Arc::new(navigator.motion.then(time, parts));
    take(run, navigator, &start, time);
}

fn apart(a: Pose, b: Pose) -> f64 {
    math::hypot(a.x - b.x, a.y - b.y)
}
