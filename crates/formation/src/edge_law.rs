//! The law, observer and set point of one edge, and what surrounds the law: a path's heading, stands, ways to another place.

use crate::column::cartesian;
use crate::custom::Custom;
use crate::hand_over::HandOver;
use crate::law::Law;
use crate::memory::EdgeMemory;
use crate::narrowing::{Narrowing, Outlook};
use crate::observer::{Estimate, Observer};
use crate::set_point::SetPointTrajectory;
use crate::standing::StandingInput;
use crate::tracker::TrackerParameters;
use laws::Knowledge;
use vocabulary::{Observation, SetPoint, TrackingState, math, wrap};

/// Parameters of one edge.
#[derive(Debug, Clone)]
pub struct EdgeLaw {
    /// The law of the follower. Where `custom` takes its place, what counts is its least distance and its heading.
    pub law: Law,
    /// The custom law of the follower. With several leaders it is that of its first edge.
    pub custom: Option<Custom>,
    /// What the [`laws::BatchLaw`] has to know of the leader that decides in the place of both; `None` where none does.
    pub batch: Option<Knowledge>,
    /// Its observer; used where the law knows distance and bearing only.
    pub observer: Observer,
    /// How it makes an estimate from measurements; `None` where it is told the truth.
    pub tracker: Option<TrackerParameters>,
    /// Where it shall be.
    pub set_point: SetPointTrajectory,
    /// Whether [distance, bearing] are left free: nothing is wanted of them, and the set point's are not looked at.
    pub free: [bool; 2],
    /// Whether it stops with its leader and starts again; it then holds its bearing against a path's heading. Without, it
    /// never drives slower than its least speed.
    pub standing: bool,
    /// How it files in where its way is not free; it then holds its bearing against a path's heading.
    pub narrowing: Option<Narrowing>,
}

impl EdgeLaw {
    /// What the follower's law has to know of its leader.
    pub fn knows(&self) -> Knowledge {
        let custom = || self.custom.as_ref().map_or(self.law.knows(), |c| c.law().declaration().knows);
        self.batch.unwrap_or_else(custom)
    }

    /// Whether the follower's law is one of the paper's.
    pub fn is_built_in(&self) -> bool {
        self.custom.is_none() && self.batch.is_none()
    }

    /// Whether the follower's law takes the rates of distance and bearing from its observer.
    pub fn observes(&self) -> bool {
        self.knows() == Knowledge::Output
    }

    /// ds/dt as the law takes it: the observer's `estimate`, or the truth for a law that is told it.
    pub(crate) fn rates_of(&self, estimate: &Estimate, truth: impl FnOnce() -> [f64; 2]) -> [f64; 2] {
        if self.observes() { estimate.rates } else { truth() }
    }

    /// s^d where the follower has filed in, as far as it has.
    pub(crate) fn narrowed(&self, memory: &EdgeMemory, time: f64) -> SetPoint {
        memory.narrowing.moves(&self.set_point.at(time), self.law.distance_min)
    }

    /// s^d against the heading it is held against, as it is while the follower goes to its place.
    pub(crate) fn way(&self, memory: &EdgeMemory, time: f64) -> SetPoint {
        let base = self.narrowed(memory, time);
        let hand_over = memory.hand_over.as_ref();
        hand_over.map_or(base, |hand_over| hand_over.set_point(&base, self.law.distance_min))
    }

    /// s^d against the heading it is held against.
    pub(crate) fn place(&self, memory: &EdgeMemory, time: f64) -> SetPoint {
        let base = self.way(memory, time);
        if self.standing { memory.standing.set_point(&base, self.law.distance_min) } else { base }
    }

    /// [distance, bearing] of a follower in m and rad, against the heading that its bearing is held against.
    pub(crate) fn seen_place(&self, memory: &EdgeMemory, seen: &Observation) -> [f64; 2] {
        let bearing = match memory.heading.filter(|_| self.law.heading.filter().is_some()) {
            Some(heading) => wrap(seen.relative.view_angle + seen.own_heading - heading.heading),
            None => seen.relative.bearing,
        };
        [seen.relative.distance, bearing]
    }

    /// Carries a hand-over on over a period; `rates` are those of what the law works on.
    pub(crate) fn go_over(
        &self,
        memory: &mut EdgeMemory,
        time: f64,
        seen: &Observation,
        [closing, turning]: [f64; 2],
        period: f64,
    ) {
        let (at, goal) = (self.seen_place(memory, seen), self.narrowed(memory, time).value);
        let turns = self.law.heading.filter().zip(memory.heading.as_ref());
        let moving =
            [closing, turning - turns.map_or(0.0, |(filter, heading)| heading.rate(filter, memory.speed))];
        let waits = memory.standing.holds();
        let goes_on = |hand_over: &mut HandOver| hand_over.advance(at, moving, goal, waits, period);
        if memory.hand_over.as_mut().is_some_and(|hand_over| !goes_on(hand_over)) {
            memory.hand_over = None;
        }
    }

    /// Where a follower that narrows looks for room, once it knows how its leader drives.
    pub(crate) fn outlook(&self, memory: &EdgeMemory, time: f64, seen: &Observation) -> Option<Outlook> {
        let (filter, heading) = (self.law.heading.filter()?, memory.heading.filter(|_| !unseen(seen))?);
        // From the leader to the follower.
        let direction = seen.relative.view_angle + seen.own_heading;
        let (sin, cos) = math::sin_cos(direction);
        let distance = seen.relative.distance;
        Some(Outlook {
            wide: cartesian(self.set_point.at(time).value),
            ahead: distance * math::cos(direction - heading.heading),
            leader: [-distance * cos, -distance * sin],
            heading: heading.heading + heading.behind,
            behind: heading.behind,
            curvature: (heading.curvature + filter.gain() * heading.behind).clamp(-1.0, 1.0),
            speed: memory.speed,
        })
    }

    /// s^d as the law takes it: with a path's heading, φ^d = ψ^d + θ̄ in place of ψ^d.
    pub(crate) fn output_set_point(&self, memory: &EdgeMemory, place: &SetPoint) -> SetPoint {
        let (Some(filter), Some(heading)) = (self.law.heading.filter(), &memory.heading) else {
            return *place;
        };
        let mut set_point = *place;
        set_point.value[1] += heading.heading;
        set_point.rate[1] += heading.rate(filter, memory.speed);
        set_point
    }

    /// What the standing rule looks at, where it is on.
    pub(crate) fn standing_input<'a>(
        &self,
        memory: &EdgeMemory,
        place: &'a SetPoint,
        seen: &Observation,
    ) -> Option<StandingInput<'a>> {
        let (filter, heading) = (self.law.heading.filter()?, memory.heading.filter(|_| self.standing)?);
        Some(StandingInput {
            set_point: place,
            frame: [wrap(heading.heading - seen.own_heading), heading.rate(filter, memory.speed)],
            place: self.seen_place(memory, seen),
            own_speed: seen.own_speed,
            leader: [memory.speed, memory.acceleration],
            turns_at_most: f64::INFINITY,
        })
    }

    /// Carries the standing rule on over a period; `turn_rate` rad/s is what was applied last.
    pub(crate) fn stand(
        &self,
        memory: &mut EdgeMemory,
        time: f64,
        seen: &Observation,
        turn_rate: f64,
        period: f64,
    ) {
        memory.standing.carry(memory.speed, period);
        let (base, place) = (self.way(memory, time), self.place(memory, time));
        if let Some(input) = self.standing_input(memory, &place, seen) {
            memory.standing.switch(&base, &input, turn_rate, period);
        }
    }
}

/// Whether a follower does not know where its leader is.
pub(crate) fn unseen(seen: &Observation) -> bool {
    matches!(seen.sight, TrackingState::Waiting | TrackingState::Lost)
}
