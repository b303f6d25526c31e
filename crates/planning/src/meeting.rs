//! Where a formation on its plan comes too near to something that moves.

use crate::convex::{Convex, apart};
use crate::formation_model::{BodyShape, FormationModel};
use crate::limits::TravelLimits;
use crate::mission::PlanRequest;
use crate::moving::MovingThing;
use crate::plan::{MotionPlan, PlanPoint};
use vocabulary::Pose;

/// A robot comes too near to a thing that moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Number of the thing.
    pub thing: usize,
    /// Number of the robot, 0 for the lead.
    pub robot: usize,
    /// s from the beginning of the plan.
    pub time: f64,
    /// Way gone, m.
    pub way: f64,
}

/// The first time, from `from` s after its beginning on, at which a robot of a plan that begins at `begins` s is nearer than
/// `clearance` m to one of `things`. Things are looked at until the plan ends.
pub fn first_meeting(
    plan: &MotionPlan,
    model: &FormationModel,
    limits: &TravelLimits,
    clearance: f64,
    things: &[MovingThing],
    begins: f64,
    from: f64,
) -> Option<Meeting> {
    if things.is_empty() {
        return None;
    }
    let traffic = Traffic::new(plan, model, limits, clearance, things, begins);
    let mut cursor = 0;
    plan.points.windows(2).filter(|pair| pair[1].time > from).find_map(|pair| {
        let [a, b] = [&pair[0], &pair[1]];
        let span = b.time - a.time;
        let acceleration = if span > 0.0 { (b.speed.abs() - a.speed.abs()) / span } else { 0.0 };
        let stretch =
            TimedStretch { way: a.way, speed: a.speed.abs(), acceleration, time: a.time, lasts: span };
        traffic.meets(&stretch, &mut cursor)
    })
}

/// When a plan begins, and how long the formation stays at its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// s.
    pub begins: f64,
    /// s; infinite where it stays for good.
    pub stays: f64,
}

impl Schedule {
    /// A plan that begins at `begins` s, at whose end the formation stays.
    pub fn at(begins: f64) -> Self {
        Self { begins, stays: f64::INFINITY }
    }
}

/// The same, of a request's formation and with its map's clearance, on the way and while it stays at the end.
pub(crate) fn meeting_of(
    plan: &MotionPlan,
    request: &PlanRequest<'_>,
    things: &[MovingThing],
    schedule: Schedule,
) -> Option<Meeting> {
    let (model, limits, clearance) = (request.model, &request.limits, request.map.clearance());
    first_meeting(plan, model, limits, clearance, things, schedule.begins, 0.0).or_else(|| {
        let traffic = Traffic::new(plan, model, limits, clearance, things, schedule.begins);
        traffic.meetings_at_the_end(plan.duration(), schedule.stays).next()
    })
}

/// A stretch of the way that is driven with one acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimedStretch {
    /// Way at which it begins, m.
    pub way: f64,
    /// m/s there.
    pub speed: f64,
    /// m/s².
    pub acceleration: f64,
    /// When it begins, s from the beginning of the plan.
    pub time: f64,
    /// s.
    pub lasts: f64,
}

/// A plan among things that move.
pub(crate) struct Traffic<'a> {
    points: &'a [PlanPoint],
    things: &'a [MovingThing],
    bodies: Vec<BodyShape>,
    begins: f64,
    clearance: f64,
    /// Radius of a circle around the lead that holds all robots at every point, m.
    around: f64,
    /// Bound on the speed of every robot, m/s.
    robots_fastest: f64,
}

/// A formation that stays is looked at in stretches of this, s.
pub(crate) const MOMENT: f64 = 0.5;
/// Where distances do not decide, they are looked at again after this share of a stretch.
const LEAST_SHARE: f64 = 1.0 / 16.0;

impl<'a> Traffic<'a> {
    pub(crate) fn new(
        plan: &'a MotionPlan,
        model: &FormationModel,
        limits: &TravelLimits,
        clearance: f64,
        things: &'a [MovingThing],
        begins: f64,
    ) -> Self {
        let bodies: Vec<BodyShape> = (0..model.robots()).map(|robot| model.body(robot)).collect();
        let mut around: f64 = 0.0;
        for point in &plan.points {
            for (pose, body) in point.robots.iter().zip(&bodies) {
                around = around.max(apart(place(pose), place(&point.pose)) + body.reach());
            }
        }
        let robots_fastest = limits.speed.max(limits.outer);
        Self { points: &plan.points, things, bodies, begins, clearance, around, robots_fastest }
    }

    /// From when on all things stand, s from the beginning of the plan.
    pub(crate) fn rests_at(&self) -> f64 {
        self.things.iter().map(MovingThing::rests_at).fold(0.0, f64::max) - self.begins
    }

    /// The first meeting on a stretch. `cursor` is a place among the points from which the way is looked for.
    pub(crate) fn meets(&self, stretch: &TimedStretch, cursor: &mut usize) -> Option<Meeting> {
        let lead = |way: f64, cursor: &mut usize| {
            let (a, b, share) = self.around_way(way, cursor)?;
            Some([a.pose.x + share * (b.pose.x - a.pose.x), a.pose.y + share * (b.pose.y - a.pose.y)])
        };
        let first = lead(stretch.way, cursor)?;
        let near: Vec<usize> = (0..self.things.len())
            .filter(|index| {
                let thing = &self.things[*index];
                let away = apart(first, place(&thing.at(self.begins + stretch.time)));
                let closing = (self.robots_fastest + thing.fastest()) * stretch.lasts;
                away < self.around + thing.reach() + self.clearance + closing
            })
            .collect();
        if near.is_empty() {
            return None;
        }
        let mut gone = 0.0;
        loop {
            let way = stretch.way + gone * (stretch.speed + 0.5 * stretch.acceleration * gone);
            let time = stretch.time + gone;
            let mut free = f64::INFINITY;
            for index in &near {
                let (distance, robot) = self.distance(*index, way, time, cursor);
                if distance < self.clearance {
                    return Some(Meeting { thing: *index, robot, time, way });
                }
                let closing = self.robots_fastest + self.things[*index].fastest();
                free = free.min((distance - self.clearance) / closing);
            }
            if gone >= stretch.lasts {
                return None;
            }
            gone = (gone + free.max(LEAST_SHARE * stretch.lasts)).min(stretch.lasts);
        }
    }

    /// Meetings of a formation that stays at the end of the way from `from` s on for `stays` s, moment by moment, until everything
    /// stands.
    pub(crate) fn meetings_at_the_end(&self, from: f64, stays: f64) -> impl Iterator<Item = Meeting> {
        let way = self.points.last().map_or(0.0, |point| point.way);
        let until = self.rests_at().max(from).min(from + stays);
        let moments = if self.things.is_empty() { 0 } else { ((until - from) / MOMENT).ceil() as usize + 1 };
        (0..moments).filter_map(move |k| {
            let time = from + MOMENT * k as f64;
            let stretch = TimedStretch { way, speed: 0.0, acceleration: 0.0, time, lasts: MOMENT };
            self.meets(&stretch, &mut self.points.len())
        })
    }

    /// Distance of the formation to a thing, m, and the robot that is nearest. What is farther than needs be known is a bound
    /// from below.
    fn distance(&self, thing: usize, way: f64, time: f64, cursor: &mut usize) -> (f64, usize) {
        let Some((a, b, share)) = self.around_way(way, cursor) else { return (f64::INFINITY, 0) };
        let thing = &self.things[thing];
        let at = place(&thing.at(self.begins + time));
        let mut body: Option<Convex> = None;
        let mut found = (f64::INFINITY, 0);
        for (robot, shape) in self.bodies.iter().enumerate() {
            let pose = between(&a.robots[robot], &b.robots[robot], share);
            let bound = apart(place(&pose), at) - shape.reach() - thing.reach();
            if bound >= found.0 {
                continue;
            }
            let distance = if bound > self.clearance + FAR {
                bound
            } else {
                let body = body.get_or_insert_with(|| thing.body_at(self.begins + time));
                body.distance_to(&shape.at(pose))
            };
            if distance < found.0 {
                found = (distance, robot);
            }
        }
        found
    }

    /// The points before and after a way, and where between them it is.
    fn around_way(&self, way: f64, cursor: &mut usize) -> Option<(&PlanPoint, &PlanPoint, f64)> {
        let last = self.points.len().checked_sub(1)?;
        let mut after = (*cursor).clamp(1.min(last), last);
        while after < last && self.points[after].way < way {
            after += 1;
        }
        while after > 1 && self.points[after - 1].way > way {
            after -= 1;
        }
        *cursor = after;
        let (a, b) = (&self.points[after.saturating_sub(1)], &self.points[after]);
        let share = if b.way > a.way { ((way - a.way) / (b.way - a.way)).clamp(0.0, 1.0) } else { 0.0 };
        Some((a, b, share))
    }
}

/// Nearer than this beyond the clearance, distances are exact, m.
const FAR: f64 = 0.5;

fn place(pose: &Pose) -> [f64; 2] {
    [pose.x, pose.y]
}

/// Between two points of a plan everybody goes straight and turns evenly.
fn between(a: &Pose, b: &Pose, share: f64) -> Pose {
    Pose {
        x: a.x + share * (b.x - a.x),
        y: a.y + share * (b.y - a.y),
        heading: a.heading + share * vocabulary::wrap(b.heading - a.heading),
    }
}
