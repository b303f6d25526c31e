//! How followers trail behind a lead: where they are all along its way, and whether they stay clear.
//!
//! A follower's place c is held against the heading θ̄ of its leader, filtered along the leader's way u with e = θ_i − θ̄:
//!
//! ```text
//! p_j = p_i + R(θ̄) c(λ)      dθ̄/du = κ̄ + (2λ − τ)/λ² e      dκ̄/du = (1 − τ/λ)² e/λ² − τ/λ² κ̄
//! ```
//!
//! So a lead's way alone decides where all are that hold their places. Steps are short and of second order: within one a
//! leader's heading is that of its chord. Between two steps a robot is on the chord up to a sagitta that is part of what it
//! is held clear by, and along a chord distances change by at most the way: [`Sweep`] halves it until that decides.

use crate::convex::{Convex, apart, corners};
use crate::formation_model::{BodyShape, FormationModel, SLOWEST_SHARE};
use crate::leg::{Leg, Piece};
use crate::limits::TravelLimits;
use crate::map::Map;
use crate::mission::PlanRequest;
use vocabulary::{PathFilter, Pose, math, wrap};

/// A formation made ready: who is held against which heading.
#[derive(Debug, Clone)]
pub(crate) struct Trailing {
    /// Leader and number of the held heading of every robot; those of the lead are not used.
    follows: Vec<[usize; 2]>,
    /// Held headings: whose, and how filtered. A robot's stand together.
    frames: Vec<HeldHeading>,
    /// Which of the held headings are a robot's: from, to.
    of_robot: Vec<[usize; 2]>,
    /// [level][robot], [forward, left] in m.
    places: Vec<Vec<[f64; 2]>>,
    bodies: Vec<BodyShape>,
    /// Whether the direction in which a robot drives matters.
    courses: Vec<bool>,
    /// Largest curvature of every level, 1/m.
    largest: Vec<f64>,
    /// By how much a robot's way may be off its chords, m.
    between: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct HeldHeading {
    leader: usize,
    filter: Option<PathFilter>,
}

/// Where all robots of a formation are, and what their headings remember.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Convoy {
    /// m.
    pub positions: Vec<[f64; 2]>,
    /// Direction in which each robot drove in the last step, rad, of those for which it matters; the lead's heading.
    pub courses: Vec<f64>,
    /// By how much that changed in the last step, rad.
    turns: Vec<f64>,
    /// θ̄, and κ̄ or, without a filter, the leader's course before, of every held heading.
    held: Vec<[f64; 2]>,
    /// sin and cos of θ̄.
    axes: Vec<[f64; 2]>,
    /// Ways gone in the last step, m.
    pub moved: Vec<f64>,
}

impl Trailing {
    pub(crate) fn new(model: &FormationModel, limits: &TravelLimits) -> Self {
        let robots = model.robots();
        let mut frames: Vec<HeldHeading> = vec![];
        let mut of_robot = vec![];
        for robot in 0..robots {
            let from = frames.len();
            for follower in model.followers().iter().filter(|follower| follower.leader == robot) {
                let frame = HeldHeading { leader: robot, filter: follower.heading };
                if !frames[from..].contains(&frame) {
                    frames.push(frame);
                }
            }
            of_robot.push([from, frames.len()]);
        }
        let number = |leader: usize, filter: Option<PathFilter>| {
            frames.iter().position(|frame| *frame == HeldHeading { leader, filter }).unwrap_or(0)
        };
        let of_follower = model.followers().iter().map(|f| [f.leader, number(f.leader, f.heading)]);
        let follows: Vec<_> = std::iter::once([0, 0]).chain(of_follower).collect();
        let places = (0..model.levels())
            .map(|level| {
                let followers = model.followers().iter().map(|follower| follower.places[level]);
                std::iter::once([0.0; 2]).chain(followers).collect()
            })
            .collect();
        let bodies: Vec<_> = (0..robots).map(|robot| model.body(robot)).collect();
        let courses = (0..robots)
            .map(|robot| {
                let leads = of_robot[robot][1] > of_robot[robot][0];
                leads
                    || matches!(bodies[robot], BodyShape::Rectangle { .. })
                    || limits.follower_curvature.is_some()
            })
            .collect();
        let largest: Vec<f64> =
            (0..model.levels()).map(|level| model.largest_curvature(level, limits)).collect();
        // On a circle of a follower |p″| = κ r, with r its speed per speed of the lead; a chord of length l is off by |p″| l²/8.
        let bends = largest.iter().enumerate().map(|(level, curvature)| {
            let robots =
                [*curvature, -curvature].into_iter().flat_map(|curvature| model.steady(level, curvature));
            curvature * robots.map(|robot| robot.ratio).fold(1.0, f64::max)
        });
        let between = TRANSITIONS * bends.fold(0.0, f64::max) * STEP * STEP / 8.0;
        Self { follows, frames, of_robot, places, bodies, courses, largest, between }
    }

    /// By how much robots of the column keep to either side of the lead's track, on the side on which they do so less, m.
    pub(crate) fn column_half_width(&self) -> f64 {
        let straight = self.steady(Pose::default(), 0.0, (self.levels() - 1) as f64);
        let sides = straight
            .positions
            .iter()
            .fold([0.0_f64; 2], |[right, left], [_, y]| [right.max(-y), left.max(*y)]);
        sides[0].min(sides[1])
    }

    /// Largest curvature of every level, 1/m.
    pub(crate) fn largest(&self) -> &[f64] {
        &self.largest
    }

    pub(crate) fn robots(&self) -> usize {
        self.bodies.len()
    }

    pub(crate) fn levels(&self) -> usize {
        self.places.len()
    }

    /// How many held headings there are.
    pub(crate) fn frames(&self) -> usize {
        self.frames.len()
    }

    /// Numbers of the headings that are held against a robot.
    pub(crate) fn frames_of(&self, robot: usize) -> std::ops::Range<usize> {
        self.of_robot[robot][0]..self.of_robot[robot][1]
    }

    /// [θ̄, κ̄] of every follower.
    pub(crate) fn held_of_followers(&self, convoy: &Convoy) -> Vec<[f64; 2]> {
        let of = |[_, frame]: &[usize; 2]| [wrap(convoy.held[*frame][0]), convoy.held[*frame][1]];
        self.follows.iter().skip(1).map(of).collect()
    }

    /// Those headings with their memories.
    pub(crate) fn held_of(&self, convoy: &Convoy, robot: usize) -> Vec<[f64; 2]> {
        convoy.held[self.frames_of(robot)].to_vec()
    }

    /// How θ̄ and κ̄ after a step change with [the course, θ̄, κ̄ before, the way]; `None` without a filter.
    pub(crate) fn filter_slopes(
        &self,
        frame: usize,
        before: [f64; 2],
        course: f64,
        way: f64,
    ) -> Option<[[f64; 4]; 2]> {
        self.frames[frame].filter.map(|filter| filter_slopes(&filter, before, course, way))
    }

    /// Who follows whom: the leader of a follower and its held heading.
    pub(crate) fn follows(&self, robot: usize) -> [usize; 2] {
        self.follows[robot]
    }

    /// The formation behind a lead that has driven a curve of `curvature` 1/m for long, at a level.
    pub(crate) fn steady(&self, lead: Pose, curvature: f64, level: f64) -> Convoy {
        self.held_at(lead, curvature, level, None)
    }

    /// The formation at a request's start, but for its level.
    pub(crate) fn begin(&self, request: &PlanRequest<'_>, level: f64) -> Convoy {
        let start = request.mission.start;
        self.held_at(start.pose, start.curvature, level, request.held)
    }

    /// As [`Trailing::steady`], with [θ̄, κ̄] of every follower where they are known.
    fn held_at(&self, lead: Pose, curvature: f64, level: f64, held: Option<&[[f64; 2]]>) -> Convoy {
        let n = self.robots();
        let mut convoy = Convoy {
            positions: vec![[lead.x, lead.y]; n],
            courses: vec![lead.heading; n],
            turns: vec![0.0; n],
            held: vec![[0.0; 2]; self.frames.len()],
            axes: vec![[0.0, 1.0]; self.frames.len()],
            moved: vec![0.0; n],
        };
        for robot in 0..n {
            let mut own = curvature;
            if robot > 0 {
                let [leader, frame] = self.follows[robot];
                convoy.positions[robot] = convoy.place(leader, frame, self.place(robot, level));
                let [dx, dy] = [0, 1].map(|k| convoy.positions[robot][k] - convoy.positions[0][k]);
                let (sin, cos) = math::sin_cos(lead.heading);
                let [x, y] = [cos * dx + sin * dy, cos * dy - sin * dx];
                let velocity = [1.0 - curvature * y, curvature * x];
                let ratio = math::hypot(velocity[0], velocity[1]);
                own = if ratio > 0.0 { curvature / ratio } else { 0.0 };
                convoy.courses[robot] = lead.heading + math::atan2(velocity[1], velocity[0]);
            }
            let [from, to] = self.of_robot[robot];
            for frame in from..to {
                convoy.held[frame] = match self.frames[frame].filter {
                    Some(PathFilter { length, lag }) => {
                        let left = 1.0 - lag / length;
                        [convoy.courses[robot] - lag * own, left * left * own]
                    }
                    None => [convoy.courses[robot]; 2],
                };
                let of_follower = self.follows.iter().skip(1).position(|[_, own]| *own == frame);
                if let (Some(held), Some(follower), Some(_)) = (held, of_follower, self.frames[frame].filter)
                {
                    convoy.held[frame] = held[follower];
                }
                convoy.turn_axis(frame);
            }
        }
        convoy
    }

    /// Place of a follower at a level between two, [forward, left] in m.
    fn place(&self, robot: usize, level: f64) -> [f64; 2] {
        let below = (level.max(0.0) as usize).min(self.places.len() - 1);
        let share = level - below as f64;
        let wide = self.places[below][robot];
        if share <= 0.0 || below + 1 == self.places.len() {
            return wide;
        }
        let narrow = self.places[below + 1][robot];
        [0, 1].map(|k| wide[k] + share * (narrow[k] - wide[k]))
    }

    /// Moves robot number `robot` on, of whose leader that has been done: `piece` is a short piece of the lead's way.
    pub(crate) fn step(&self, convoy: &mut Convoy, robot: usize, piece: &Piece) {
        let before = convoy.positions[robot];
        let (to, length, course) = if robot == 0 {
            ([piece.end.x, piece.end.y], piece.length, piece.middle)
        } else {
            let [leader, frame] = self.follows[robot];
            let to = convoy.place(leader, frame, self.place(robot, piece.level));
            let [x, y] = [to[0] - before[0], to[1] - before[1]];
            let length = (x * x + y * y).sqrt();
            let still = length < 1e-9 || !self.courses[robot];
            (to, length, if still { convoy.courses[robot] } else { math::atan2(y, x) })
        };
        convoy.turns[robot] = if robot == 0 { 0.0 } else { wrap(course - convoy.courses[robot]) };
        convoy.positions[robot] = to;
        convoy.moved[robot] = length;
        let [from, end] = self.of_robot[robot];
        for frame in from..end {
            let [held, memory] = convoy.held[frame];
            convoy.held[frame] = match self.frames[frame].filter {
                Some(filter) => advanced(&filter, [held, memory], course, length),
                // The course is that in the middle of the step; half a step's turn is added.
                None if robot == 0 => [piece.end.heading; 2],
                None => [course + 0.5 * wrap(course - memory), course],
            };
            convoy.turn_axis(frame);
        }
        convoy.courses[robot] = if robot == 0 { piece.end.heading } else { course };
    }

    /// Adds the numbers that a convoy remembers beside the lead's pose and level, for a search that keeps many.
    pub(crate) fn remember(&self, convoy: &Convoy, memory: &mut Vec<f64>) {
        memory.extend(convoy.held.iter().flatten());
        let needed = (1..self.robots()).filter(|robot| self.courses[*robot]);
        memory.extend(needed.map(|robot| convoy.courses[robot]));
    }

    /// How many numbers that are.
    pub(crate) fn memory_size(&self) -> usize {
        2 * self.frames.len() + self.courses.iter().skip(1).filter(|needed| **needed).count()
    }

    /// Puts a convoy back to what it remembered.
    pub(crate) fn recall(&self, convoy: &mut Convoy, lead: Pose, level: f64, memory: &[f64]) {
        for (frame, pair) in memory.chunks_exact(2).take(self.frames.len()).enumerate() {
            convoy.held[frame] = [pair[0], pair[1]];
            convoy.turn_axis(frame);
        }
        let mut courses = memory[2 * self.frames.len()..].iter();
        convoy.positions[0] = [lead.x, lead.y];
        convoy.courses[0] = lead.heading;
        for robot in 1..self.robots() {
            let [leader, frame] = self.follows[robot];
            convoy.positions[robot] = convoy.place(leader, frame, self.place(robot, level));
            if self.courses[robot] {
                convoy.courses[robot] = courses.next().copied().unwrap_or(lead.heading);
            }
        }
        convoy.turns.fill(0.0);
    }
}

/// Derivatives of [`advanced`].
fn filter_slopes(filter: &PathFilter, [held, kappa]: [f64; 2], heading: f64, way: f64) -> [[f64; 4]; 2] {
    let (root, gain, [rise, fall]) = (1.0 / filter.length, filter.gain(), filter.curvature_gains());
    let (e, decay) = (wrap(heading - held), math::exp(-root * way));
    let [drive, bend] = [(root - gain) * e - kappa, rise * e + (root - fall) * kappa];
    let behind = decay * (1.0 + way * (root - gain));
    let behind_way = decay * (drive - root * (e + way * drive));
    let kappa_way = decay * (bend - root * (kappa + way * bend));
    let kappa_e = decay * way * rise;
    [
        [1.0 - behind, behind, decay * way, -behind_way],
        [kappa_e, -kappa_e, decay * (1.0 + way * (root - fall)), kappa_way],
    ]
}

/// A step of the filter for a heading that is held.
fn advanced(filter: &PathFilter, [held, kappa]: [f64; 2], heading: f64, way: f64) -> [f64; 2] {
    let [behind, kappa] = filter.step([wrap(heading - held), kappa], way);
    [heading - behind, kappa]
}

impl Convoy {
    fn turn_axis(&mut self, frame: usize) {
        let (sin, cos) = math::sin_cos(self.held[frame][0]);
        self.axes[frame] = [sin, cos];
    }

    fn place(&self, leader: usize, frame: usize, [forward, left]: [f64; 2]) -> [f64; 2] {
        let ([sin, cos], [x, y]) = (self.axes[frame], self.positions[leader]);
        [x + cos * forward - sin * left, y + sin * forward + cos * left]
    }

    /// By how much the direction in which a robot drives changed in the last step, rad; 0 where it does not matter.
    pub(crate) fn turned(&self, robot: usize) -> f64 {
        self.turns[robot]
    }

    /// Poses of all robots, those of whom the direction matters with it.
    pub(crate) fn pose(&self, robot: usize) -> Pose {
        let [x, y] = self.positions[robot];
        Pose { x, y, heading: wrap(self.courses[robot] + 0.5 * self.turns[robot]) }
    }
}

/// Moves a convoy along a lead's way and holds every robot clear of a map, and within its limits.
#[derive(Debug)]
pub(crate) struct Sweep<'a> {
    map: &'a Map,
    trailing: &'a Trailing,
    limits: TravelLimits,
    /// How far each robot can go on for sure, m.
    slack: Vec<f64>,
    /// The level at the end of the last piece, and whether it changed over the last piece and the one before.
    level: f64,
    shifting: [bool; 2],
}

/// Why a sweep ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Blocked {
    /// A robot comes too near to something.
    Touches {
        /// Its number.
        robot: usize,
        /// Way gone, m.
        way: f64,
    },
    /// A follower would have to be too fast, too slow, or to turn too sharply.
    Drives {
        /// Its number.
        robot: usize,
    },
}

/// Pieces in which ways are swept, m.
pub(crate) const STEP: f64 = 0.16;
/// Chords shorter than this, m, are not halved any more.
const SHORTEST: f64 = 1e-3;
/// Curvatures of followers in transitions may be this much above those on circles.
const TRANSITIONS: f64 = 2.0;

impl<'a> Sweep<'a> {
    pub(crate) fn new(map: &'a Map, trailing: &'a Trailing, limits: &TravelLimits) -> Self {
        let slack = vec![0.0; trailing.robots()];
        Self { map, trailing, limits: *limits, slack, level: 0.0, shifting: [true; 2] }
    }

    pub(crate) fn trailing(&self) -> &'a Trailing {
        self.trailing
    }

    /// How far robot number `robot` has to be off everything, from its reference point if it is round, m.
    fn need(&self, robot: usize) -> f64 {
        let wanted = self.map.clearance() + self.trailing.between;
        match self.trailing.bodies[robot] {
            BodyShape::Disc { radius } => radius + wanted,
            BodyShape::Rectangle { .. } => wanted,
        }
    }

    /// Distance of a robot to everything less than what it needs, m; for a rectangle exact near that only.
    fn room(&self, robot: usize, at: Pose) -> f64 {
        let need = self.need(robot);
        let middle = self.map.distance([at.x, at.y]);
        let BodyShape::Rectangle { front, back, half_width } = self.trailing.bodies[robot] else {
            return middle - need;
        };
        let reach = self.trailing.bodies[robot].reach();
        if middle - reach >= need || middle < self.trailing.bodies[robot].core() + need {
            return middle - reach - need;
        }
        let body = Convex::new(&corners(at, [-back, front], half_width), 0.0);
        self.map.distance_of(&body, need + reach) - need
    }

    /// Room of a robot of a convoy, m.
    pub(crate) fn room_of(&self, convoy: &Convoy, robot: usize) -> f64 {
        self.room(robot, convoy.pose(robot))
    }

    /// Whether all robots of a convoy stand clear; it has to be asked before a sweep begins.
    pub(crate) fn begin(&mut self, convoy: &Convoy) -> Result<(), Blocked> {
        for robot in 0..self.trailing.robots() {
            self.slack[robot] = self.room(robot, convoy.pose(robot));
            if self.slack[robot] < 0.0 {
                return Err(Blocked::Touches { robot, way: 0.0 });
            }
        }
        Ok(())
    }

    /// Begins anew with a convoy that has been found clear.
    pub(crate) fn resume(&mut self) {
        self.slack.fill(0.0);
        self.shifting = [true; 2];
    }

    /// Moves all robots over a piece of the lead's way.
    pub(crate) fn piece(&mut self, convoy: &mut Convoy, piece: &Piece) -> Result<(), Blocked> {
        self.shifting = [piece.level != self.level, self.shifting[0]];
        self.level = piece.level;
        for robot in 0..self.trailing.robots() {
            let before = convoy.pose(robot);
            let course = convoy.courses[robot];
            self.trailing.step(convoy, robot, piece);
            if robot > 0 {
                self.drives(convoy, robot, [before.x, before.y], course, piece.length)?;
            }
            self.clear(robot, before, convoy.pose(robot), piece.way)?;
        }
        Ok(())
    }

    /// Moves all robots over a leg.
    pub(crate) fn leg(&mut self, convoy: &mut Convoy, leg: &Leg) -> Result<(), Blocked> {
        leg.pieces(STEP).try_for_each(|piece| self.piece(convoy, &piece))
    }

    /// Holds a follower's last step against its limits.
    fn drives(
        &self,
        convoy: &Convoy,
        robot: usize,
        before: [f64; 2],
        course: f64,
        length: f64,
    ) -> Result<(), Blocked> {
        let [_, frame] = self.trailing.follows[robot];
        let ([sin, cos], to, moved) = (convoy.axes[frame], convoy.positions[robot], convoy.moved[robot]);
        let forward = cos * (to[0] - before[0]) + sin * (to[1] - before[1]);
        let turns = wrap(convoy.courses[robot] - course).abs();
        // Tiny pieces at knots say nothing of a turn, nor do those at which places begin or end to move.
        let tells = moved > 0.5 * STEP && self.shifting == [false; 2];
        let sharp =
            self.limits.follower_curvature.is_some_and(|own| tells && turns > own * moved * FOLLOWS_LOOSELY);
        if moved > self.limits.fastest_share() * length * (1.0 + 1e-9) + 1e-12
            || forward < SLOWEST_SHARE * length - 1e-12
            || sharp
        {
            return Err(Blocked::Drives { robot });
        }
        Ok(())
    }

    /// Holds a robot clear on its way from one pose to another.
    fn clear(&mut self, robot: usize, from: Pose, to: Pose, way: f64) -> Result<(), Blocked> {
        let goes = self.goes(robot, from, to);
        let left = self.slack[robot] - goes;
        if left >= 0.0 {
            self.slack[robot] = left;
            return Ok(());
        }
        let room = self.room(robot, to);
        let held = self.slack[robot];
        self.slack[robot] = room;
        if room >= 0.0
            && (held + room >= goes
                || self.between_is_clear(robot, [from, to], [self.room(robot, from), room]))
        {
            return Ok(());
        }
        Err(Blocked::Touches { robot, way })
    }

    /// The farthest that a point of a robot goes between two poses, m.
    fn goes(&self, robot: usize, from: Pose, to: Pose) -> f64 {
        let way = apart([from.x, from.y], [to.x, to.y]);
        match self.trailing.bodies[robot] {
            BodyShape::Disc { .. } => way,
            body @ BodyShape::Rectangle { .. } => way + body.reach() * wrap(to.heading - from.heading).abs(),
        }
    }

    /// Rooms change by at most the way that a robot goes: with a at one end and b at the other it is (a + b − way)/2 at the
    /// least in between.
    fn between_is_clear(&self, robot: usize, ends: [Pose; 2], rooms: [f64; 2]) -> bool {
        let [from, to] = ends;
        let goes = self.goes(robot, from, to);
        if rooms[0] + rooms[1] >= goes {
            return true;
        }
        if goes < SHORTEST {
            return false;
        }
        let turn = wrap(to.heading - from.heading);
        let middle =
            Pose { x: 0.5 * (from.x + to.x), y: 0.5 * (from.y + to.y), heading: from.heading + 0.5 * turn };
        let room = self.room(robot, middle);
        room >= 0.0
            && self.between_is_clear(robot, [from, middle], [rooms[0], room])
            && self.between_is_clear(robot, [middle, to], [room, rooms[1]])
    }
}

/// Followers' courses swing about those on circles by this share where curves begin.
const FOLLOWS_LOOSELY: f64 = 1.25;
