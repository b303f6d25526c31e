//! When a formation goes along its way among things that move: the way stays, and the speed is chosen in time (K. Kant,
//! S. W. Zucker, Toward efficient trajectory planning: the path-velocity decomposition, IJRR 1986).
//!
//! Time goes in steps of T, in each of which the lead gains a T, keeps its speed, or loses a T. So it is always at a multiple
//! of a T²/2 of the way with a multiple of a T of speed, and what can be reached is a graph. A* finds the earliest arrival in
//! it; the estimate is the time that the way takes where nothing moves.

use crate::meeting::{MOMENT, Meeting, Schedule, TimedStretch, Traffic, meeting_of};
use crate::mission::PlanRequest;
use crate::moving::MovingThing;
use crate::plan::{MotionPlan, PlanPoint};
use crate::planner::{PlanError, plan};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap, HashSet};
use thiserror::Error;

/// A formation that would meet something wherever and whenever it goes.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("it meets what moves {:.1} s after it sets out, and cannot wait until that is gone", .0.time)]
pub struct Unavoidable(pub Meeting);

/// Longest step in time, s.
const STEP_MOST: f64 = 0.5;
/// Longest that is waited on the way, s.
pub const WAITS_MOST: f64 = 120.0;
/// A change of speed costs as much as this share of a step: where two ways of waiting are as long, the calmer one is taken.
const CALM: f64 = 0.05;
/// States that are looked at, at most.
const STATES_MOST: usize = 400_000;

/// Plans a way among `things` that move, for a formation with a schedule. It goes at other speeds, or waits, where it would
/// meet them, on the way or at its end; or it goes around where it would, if it arrives earlier by that.
///
/// # Errors
/// As [`plan`]. Where there is a way but no time for it: [`PlanError::Meets`].
pub fn plan_among(
    request: &PlanRequest<'_>,
    things: &[MovingThing],
    schedule: Schedule,
    stop: &mut dyn FnMut(usize) -> bool,
) -> Result<MotionPlan, PlanError> {
    let straight = plan(request, stop)?;
    let Some(meeting) = meeting_of(&straight, request, things, schedule) else { return Ok(straight) };
    let longest = straight.duration();
    let waits = timed_among(&straight, request, things, schedule);
    if let Ok(timed) = &waits
        && timed.duration() <= SOON * longest
    {
        return waits.map_err(Into::into);
    }
    let around = around(request, things, schedule, &meeting, stop);
    let (mut chosen, aside) = match (waits, around) {
        (Ok(waits), Some(around)) if around.duration() < waits.duration() => (around, Some(waits)),
        (Ok(waits), around) => (waits, around),
        (Err(_), Some(around)) => (around, Some(straight)),
        (Err(error), None) => return Err(error.into()),
    };
    if let Some(aside) = aside {
        chosen.reject(&aside);
    }
    Ok(chosen)
}

/// A wait that takes no more than this much of the way's time is taken without looking further.
const SOON: f64 = 1.1;
/// How often a way is planned around where it meets something.
const TRIES: usize = 4;
/// What a thing takes up for so long before and after a meeting stands in the way then, s.
const WINDOW: f64 = 4.0;

/// A way around where things would be met.
fn around(
    request: &PlanRequest<'_>,
    things: &[MovingThing],
    schedule: Schedule,
    meeting: &Meeting,
    stop: &mut dyn FnMut(usize) -> bool,
) -> Option<MotionPlan> {
    let mut map = request.map.clone();
    let mut meeting = *meeting;
    for _ in 0..TRIES {
        let time = schedule.begins + meeting.time;
        map = map.with(things[meeting.thing].swept(time - WINDOW, time + WINDOW));
        let request = PlanRequest { map: &map, ..*request };
        let found = plan(&request, stop).ok()?;
        match meeting_of(&found, &request, things, schedule) {
            None => return Some(found),
            Some(next) => {
                if let Ok(timed) = timed_among(&found, &request, things, schedule) {
                    return Some(timed);
                }
                meeting = next;
            }
        }
    }
    None
}

/// The same way at other times, among `things` that move. Where one of them comes by its end, the formation arrives after that.
///
/// # Errors
/// It meets something wherever it waits.
pub fn timed_among(
    plan: &MotionPlan,
    request: &PlanRequest<'_>,
    things: &[MovingThing],
    schedule: Schedule,
) -> Result<MotionPlan, Unavoidable> {
    let Some(meeting) = meeting_of(plan, request, things, schedule) else { return Ok(plan.clone()) };
    let clearance = request.map.clearance();
    let traffic = Traffic::new(plan, request.model, &request.limits, clearance, things, schedule.begins);
    // It may not arrive before all that comes by has gone, unless it leaves before.
    let at_the_end = |stays: f64| traffic.meetings_at_the_end(plan.duration(), stays);
    let comes_by = at_the_end(schedule.stays).next().and_then(|_| at_the_end(f64::INFINITY).last());
    if comes_by.is_some_and(|last| last.time >= traffic.rests_at()) {
        // What is there stays there.
        return Err(Unavoidable(meeting));
    }
    let free = comes_by.map_or(0.0, |last| last.time + MOMENT);
    let mut points: Vec<PlanPoint> = vec![];
    let (mut time, mut stood) = (0.0, 0.0);
    let ranges = between_stops(&plan.points);
    let last = ranges.len().checked_sub(1).ok_or(Unavoidable(meeting))?;
    for (number, range) in ranges.into_iter().enumerate() {
        let part = &plan.points[range];
        // Wheels turn where the lead stands.
        time += part[0].time - stood;
        stood = part[part.len() - 1].time;
        let lattice = SpeedLattice::new(part, request).ok_or(Unavoidable(meeting))?;
        let stretches = lattice
            .search(part, &traffic, time, if number == last { free } else { 0.0 })
            .ok_or(Unavoidable(meeting))?;
        time = stretches.last().map_or(time, |last| last.time + last.lasts);
        points.extend(at_the_times_of(part, &stretches));
    }
    Ok(MotionPlan { points, ..plan.clone() })
}

/// Parts of the points of a plan between stops of the lead.
fn between_stops(points: &[PlanPoint]) -> Vec<std::ops::Range<usize>> {
    let last = points.len().saturating_sub(1);
    let mut from = 0;
    let mut parts = vec![];
    for k in 1..=last {
        if points[k].speed == 0.0 && k > from {
            parts.push(from..k + 1);
            // Where it turns about there are two points in one place.
            from = if k < last && points[k + 1].way == points[k].way { k + 1 } else { k };
        }
    }
    parts.retain(|part| part.len() > 1);
    parts
}

/// Rounds in which units and lead-in are fitted to each other.
const FITTINGS: usize = 8;
/// Units of a part of the way, at most.
const UNITS_MOST: f64 = 1e6;

/// What can be reached along a part of the way.
struct SpeedLattice {
    /// Step in time, s.
    step: f64,
    /// Unit of the way, m: a T²/2.
    unit: f64,
    /// Unit of the speed, m/s: a T.
    speed: f64,
    /// m/s², down to the first unit of speed.
    braking: f64,
    /// Units of the whole way after the lead-in.
    length: usize,
    /// Way of the lead-in, in which the speed at the start comes down to a unit, m.
    lead_in: f64,
    /// Speed at the start, m/s and in units.
    start: f64,
    start_units: usize,
    /// Largest speed in units at every unit of the way.
    most: Vec<f64>,
    /// Time that is left where nothing moves, s, at every unit of the way.
    left: Vec<f64>,
}

/// Number of a step in time, units of way, units of speed.
type State = (u32, u32, u32);

impl SpeedLattice {
    fn new(part: &[PlanPoint], request: &PlanRequest<'_>) -> Option<Self> {
        let (first, last) = (part.first()?, part.last()?);
        let limits = &request.limits;
        let acceleration = limits.acceleration.min(limits.braking);
        let fastest = part.iter().map(|point| point.speed.abs()).fold(0.0, f64::max);
        let levels = (fastest / (acceleration * STEP_MOST)).ceil().max(1.0);
        let step = fastest / (acceleration * levels);
        let speed = acceleration * step;
        let start = first.speed.abs();
        let start_units = (start / speed + 1e-9).floor();
        // Units are stretched so that the way is a whole number of them, and with them the speed that the lead-in ends at.
        let (mut unit, mut units, mut lead_in) = (0.5 * acceleration * step * step, 0.0, 0.0);
        for _ in 0..FITTINGS {
            let low = start_units * 2.0 * unit / step;
            lead_in = ((start * start - low * low) / (2.0 * limits.braking)).max(0.0);
            let length = last.way - first.way - lead_in;
            if units == 0.0 {
                let wanted = (length / unit).ceil();
                // A lead that is at rest again has gone an even number of units.
                let odd = (wanted - start_units).rem_euclid(2.0);
                units = (wanted + odd).max(start_units * start_units).max(2.0);
            }
            unit = length / units;
        }
        if !(unit > 0.0 && step > 0.0 && units < UNITS_MOST) {
            return None;
        }
        let speed = 2.0 * unit / step;
        let at = |k: usize| first.way + lead_in + unit * k as f64;
        let known: Vec<(f64, f64)> = (0..=units as usize).map(|k| profile(part, at(k))).collect();
        Some(Self {
            step,
            unit,
            speed,
            braking: limits.braking,
            length: units as usize,
            lead_in,
            start,
            start_units: start_units as usize,
            most: known.iter().map(|(bound, _)| bound / speed * (1.0 + 1e-6) + 1e-6).collect(),
            left: known.iter().map(|(_, time)| last.time - time).collect(),
        })
    }

    /// The earliest arrival after `free` s that meets nothing, from `begins` s of the plan on.
    fn search(
        &self,
        part: &[PlanPoint],
        traffic: &Traffic<'_>,
        begins: f64,
        free: f64,
    ) -> Option<Vec<TimedStretch>> {
        let from = part.first()?.way;
        let low = self.start_units as f64 * self.speed;
        let lead_in = TimedStretch {
            way: from,
            speed: self.start,
            acceleration: if self.lead_in > 0.0 { -self.braking } else { 0.0 },
            time: begins,
            lasts: if self.lead_in > 0.0 { 2.0 * self.lead_in / (self.start + low) } else { 0.0 },
        };
        let mut cursor = 0;
        if self.lead_in > 0.0 && traffic.meets(&lead_in, &mut cursor).is_some() {
            return None;
        }
        let begins = begins + lead_in.lasts;
        let horizon = ((self.left[0] + WAITS_MOST) / self.step).ceil() as u32;
        let stretch = |(m, n, k): State, change: i32| TimedStretch {
            way: from + self.lead_in + self.unit * f64::from(n),
            speed: self.speed * f64::from(k),
            acceleration: f64::from(change) * self.speed / self.step,
            time: begins + self.step * f64::from(m),
            lasts: self.step,
        };
        // From when on everything stands, time makes no difference.
        let rests = ((traffic.rests_at() - begins) / self.step).ceil().max(0.0) as u32;
        let cell = |(m, n, k): State| (m.min(rests), n, k);
        // Cost, and the state before.
        let mut known: HashMap<State, (f64, Option<State>)> = HashMap::new();
        let mut done = HashSet::new();
        let mut queue = BinaryHeap::new();
        let start: State = (0, 0, self.start_units as u32);
        known.insert(cell(start), (0.0, None));
        queue.push((Reverse(key(self.left[0])), start));
        while let Some((_, state)) = queue.pop() {
            let (m, n, k) = state;
            if n as usize == self.length && k == 0 && begins + self.step * f64::from(m) >= free {
                let mut states = vec![state];
                while let Some((_, Some(before))) = known.get(&cell(states[states.len() - 1])) {
                    states.push(*before);
                }
                states.reverse();
                // Each state is a step after the one before.
                let steps = states.windows(2).enumerate().map(|(m, pair)| {
                    let [(_, n, k), (_, _, next)] = [pair[0], pair[1]];
                    stretch((m as u32, n, k), next as i32 - k as i32)
                });
                let first = (self.lead_in > 0.0).then_some(lead_in);
                return Some(first.into_iter().chain(steps).collect());
            }
            if !done.insert(cell(state)) || m >= horizon {
                continue;
            }
            if done.len() > STATES_MOST {
                return None;
            }
            let cost = known[&cell(state)].0;
            for change in [1, 0, -1] {
                let Some(next) = self.after(state, change) else { continue };
                let asked = cost + self.step * (1.0 + CALM * f64::from(change.abs()));
                if known.get(&cell(next)).is_some_and(|(known, _)| *known <= asked)
                    || traffic.meets(&stretch(state, change), &mut cursor).is_some()
                {
                    continue;
                }
                known.insert(cell(next), (asked, Some(state)));
                queue.push((Reverse(key(asked + self.left[next.1 as usize])), next));
            }
        }
        None
    }

    /// The state after a step, if all bounds of the speed hold over it.
    fn after(&self, (m, n, k): State, change: i32) -> Option<State> {
        let next = k.checked_add_signed(change)?;
        let gone = k + next;
        let end = n + gone;
        if end as usize > self.length {
            return None;
        }
        // v² is linear in the way.
        let [from, to] = [k, next].map(|k| f64::from(k * k));
        let holds = |j: u32| {
            let share = if gone > 0 { f64::from(j) / f64::from(gone) } else { 0.0 };
            (from + share * (to - from)).sqrt() <= self.most[(n + j) as usize]
        };
        (0..=gone).all(holds).then_some((m + 1, end, next))
    }
}

/// Numbers in the order of what they stand for: none is negative.
fn key(cost: f64) -> u64 {
    cost.max(0.0).to_bits()
}

/// Speed in m/s and time in s after a way.
fn profile(part: &[PlanPoint], way: f64) -> (f64, f64) {
    let after = part.partition_point(|point| point.way < way).clamp(1, part.len() - 1);
    let (a, b) = (&part[after - 1], &part[after]);
    let share = if b.way > a.way { ((way - a.way) / (b.way - a.way)).clamp(0.0, 1.0) } else { 0.0 };
    let square = |point: &PlanPoint| point.speed * point.speed;
    let speed = (square(a) + share * (square(b) - square(a))).sqrt();
    let mean = 0.5 * (a.speed.abs() + speed);
    let time = a.time + if mean > 0.0 { share * (b.way - a.way) / mean } else { 0.0 };
    (speed, time)
}

/// The points of a part with the times and speeds of stretches, and points where stretches begin and end.
fn at_the_times_of(part: &[PlanPoint], stretches: &[TimedStretch]) -> Vec<PlanPoint> {
    let side = part.iter().map(|point| point.speed).find(|speed| *speed != 0.0).unwrap_or(1.0).signum();
    let mut timed = vec![];
    let mut next = 0;
    for stretch in stretches {
        let end_speed = (stretch.speed + stretch.acceleration * stretch.lasts).max(0.0);
        let end = stretch.way + 0.5 * (stretch.speed + end_speed) * stretch.lasts;
        let begins = at_way(part, stretch.way);
        timed.push(PlanPoint { time: stretch.time, speed: side * stretch.speed, ..begins });
        while next < part.len() && part[next].way <= stretch.way + NEAR {
            next += 1;
        }
        while next < part.len() && part[next].way < end - NEAR {
            let gone = part[next].way - stretch.way;
            let speed = (stretch.speed * stretch.speed + 2.0 * stretch.acceleration * gone).max(0.0).sqrt();
            let time = stretch.time + 2.0 * gone / (stretch.speed + speed);
            timed.push(PlanPoint { time, speed: side * speed, ..part[next].clone() });
            next += 1;
        }
    }
    if let (Some(last), Some(stretch)) = (part.last(), stretches.last()) {
        timed.push(PlanPoint { time: stretch.time + stretch.lasts, speed: 0.0, ..last.clone() });
    }
    timed
}

/// Points that are nearer to each other than this, m, are one.
const NEAR: f64 = 1e-6;

fn at_way(part: &[PlanPoint], way: f64) -> PlanPoint {
    let after = part.partition_point(|point| point.way < way).clamp(1, part.len() - 1);
    let (a, b) = (&part[after - 1], &part[after]);
    let share = if b.way > a.way { ((way - a.way) / (b.way - a.way)).clamp(0.0, 1.0) } else { 0.0 };
    a.between(b, share)
}

impl From<Unavoidable> for PlanError {
    fn from(error: Unavoidable) -> Self {
        Self::Meets(error)
    }
}
