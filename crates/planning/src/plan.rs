//! A plan: the way of the lead with curvature, level, speed and time, and where all robots are along it.

use crate::leg::Leg;
use crate::mission::PlanRequest;
use crate::search::cost_of;
use crate::search_record::SearchRecord;
use crate::speed::{PieceBound, level_ramps, speeds};
use crate::trailing::{STEP, Sweep, Trailing};
use vocabulary::{Pose, wrap};

/// A point of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanPoint {
    /// Way gone, m.
    pub way: f64,
    /// s from the beginning.
    pub time: f64,
    /// Of the lead.
    pub pose: Pose,
    /// 1/m, positive to the left.
    pub curvature: f64,
    /// Of the lead, m/s; negative backwards.
    pub speed: f64,
    /// Of the formation: 0 the shape, the last the column.
    pub level: f64,
    /// The level to hand out here: the narrowest within [`MotionPlan::ahead`] from here.
    pub early_level: f64,
    /// Of all robots that hold their places, the lead first.
    pub robots: Vec<Pose>,
}

/// A way from start to goal.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionPlan {
    /// Points at most 0.125 m apart. Where the lead stops on the way to turn about there are two in one place.
    pub points: Vec<PlanPoint>,
    /// The way between its stops.
    pub legs: Vec<Leg>,
    /// What it costs, see [`CostWeights`](crate::CostWeights).
    pub cost: f64,
    /// What it cost before it was smoothed.
    pub searched_cost: f64,
    /// Steps that were swept for it.
    pub expansions: usize,
    /// Whether smoothing changed it.
    pub smoothed: bool,
    /// How much way ahead levels are handed out, m: as far as all robots stay clear that are narrower so early.
    pub ahead: f64,
    /// Whether the speed at the start can be held: not where something bounds it that is too near to brake.
    pub brakes_in_time: bool,
    /// θ̄ in rad and κ̄ in 1/m of the headings that followers are held against at the end, for [`PlanRequest::held`].
    pub held: Vec<[f64; 2]>,
    /// What the search looked at, if its effort asks for it.
    pub record: SearchRecord,
}

/// How much way ahead levels are handed out where there is room, m, and shares of it that are tried where there is not.
const AHEAD: f64 = 2.5;
const SHARES: [f64; 4] = [1.0, 0.6, 0.3, 0.0];
/// Pieces of a leg at least: a leg begins and ends at rest.
const PIECES_LEAST: f64 = 8.0;

impl MotionPlan {
    /// m.
    pub fn length(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.way)
    }

    /// s.
    pub fn duration(&self) -> f64 {
        self.points.last().map_or(0.0, |point| point.time)
    }

    /// The plan at a time in s, between its points; at rest at its end afterwards. Points are so near that what lies between is
    /// linear, but for the way, which is gained or braked evenly.
    pub fn at_time(&self, time: f64) -> Option<PlanPoint> {
        let after = self.points.partition_point(|point| point.time <= time);
        let b = self.points.get(after.min(self.points.len().checked_sub(1)?))?;
        let a = self.points.get(after.checked_sub(1)?)?;
        let span = b.time - a.time;
        let t = if span > 0.0 { ((time - a.time) / span).clamp(0.0, 1.0) } else { 0.0 };
        let gone = t * span * (a.speed.abs() + 0.5 * t * (b.speed.abs() - a.speed.abs()));
        let share = if b.way > a.way { (gone / (b.way - a.way)).clamp(0.0, 1.0) } else { t };
        Some(PlanPoint {
            time: a.time + t * span,
            speed: a.speed + t * (b.speed - a.speed),
            ..a.between(b, share)
        })
    }

    /// The plan after a way in m, between its points.
    pub fn at_way(&self, way: f64) -> Option<PlanPoint> {
        let after = self.points.partition_point(|point| point.way <= way);
        let b = self.points.get(after.min(self.points.len().checked_sub(1)?))?;
        let a = self.points.get(after.saturating_sub(1))?;
        let share = if b.way > a.way { ((way - a.way) / (b.way - a.way)).clamp(0.0, 1.0) } else { 0.0 };
        let square = |point: &PlanPoint| point.speed * point.speed;
        let speed = (square(a) + share * (square(b) - square(a))).sqrt();
        let mean = 0.5 * (a.speed.abs() + speed);
        let time = a.time + if mean > 0.0 { share * (b.way - a.way) / mean } else { 0.0 };
        let side = if a.speed + b.speed < 0.0 { -1.0 } else { 1.0 };
        Some(PlanPoint { time, speed: side * speed, ..a.between(b, share) })
    }

    /// The plan from `time` s on, with `braking` m/s² to a stand; `None` after its end. It has no legs: it leads to no goal.
    pub fn stopped(&self, time: f64, braking: f64) -> Option<Self> {
        let first = self.at_time(time)?;
        let end = (first.way + first.speed * first.speed / (2.0 * braking)).min(self.length());
        let side = if first.speed < 0.0 { -1.0 } else { 1.0 };
        let between =
            self.points.iter().filter(|point| point.way > first.way + 1e-9 && point.way < end - 1e-9);
        let mut points: Vec<PlanPoint> = std::iter::once(first.clone()).chain(between.cloned()).collect();
        points.extend(self.at_way(end));
        for point in &mut points {
            let gone = point.way - first.way;
            let speed = (first.speed * first.speed - 2.0 * braking * gone).max(0.0).sqrt();
            // v = v₀ − b t.
            point.time = (first.speed.abs() - speed) / braking;
            point.speed = side * speed;
            point.way = gone;
        }
        if let Some(last) = points.last_mut() {
            last.speed = 0.0;
        }
        Some(Self { points, legs: vec![], held: vec![], record: SearchRecord::default(), ..self.clone() })
    }

    /// Puts another plan aside for this one: its way, and what its search looked at, are kept for pictures if those are recorded.
    pub fn reject(&mut self, other: &Self) {
        if self.record != SearchRecord::default() {
            self.record.extend(&other.record);
            self.record.reject(&other.legs);
        }
    }

    /// A number that two plans share only if they are the same to the last bit.
    pub fn digest(&self) -> u64 {
        let points = self.points.iter().flat_map(|point| {
            let own = [
                point.way,
                point.time,
                point.pose.x,
                point.pose.y,
                point.pose.heading,
                point.curvature,
                point.speed,
                point.level,
                point.early_level,
            ];
            own.into_iter().chain(point.robots.iter().flat_map(|pose| [pose.x, pose.y]))
        });
        let all = points.chain([self.cost, self.ahead, self.expansions as f64]);
        // FNV-1a by words.
        all.fold(0xcbf2_9ce4_8422_2325, |digest, value| {
            (digest ^ value.to_bits()).wrapping_mul(0x0100_0000_01b3)
        })
    }

    /// The plan along legs that have been found clear.
    pub(crate) fn along(request: &PlanRequest<'_>, trailing: &Trailing, legs: Vec<Leg>) -> Self {
        let mut points = vec![];
        let start = request.mission.start;
        let mut convoy = trailing.begin(request, start.level);
        let mut speed = start.speed;
        for leg in &legs {
            let mut course = Course::new(trailing, leg, &mut convoy);
            course.drive(request, leg, speed);
            let steers =
                points.last().zip(course.points.first()).map_or(0.0, |(a, b): (&PlanPoint, &PlanPoint)| {
                    (b.curvature - a.curvature).abs() / request.limits.steering
                });
            let before = points.last().map_or([0.0; 2], |point: &PlanPoint| [point.way, point.time + steers]);
            points.extend(course.points.into_iter().map(|point| PlanPoint {
                way: point.way + before[0],
                time: point.time + before[1],
                ..point
            }));
            speed = 0.0;
        }
        let first = points.first().map_or(0.0, |point: &PlanPoint| point.speed.abs());
        let brakes_in_time = first >= start.speed - 1e-9;
        let cost = cost_of(&legs, request.model.levels(), &request.costs);
        let mut plan = Self {
            points,
            legs,
            cost,
            searched_cost: cost,
            expansions: 0,
            smoothed: false,
            ahead: 0.0,
            brakes_in_time,
            held: trailing.held_of_followers(&convoy),
            record: SearchRecord::default(),
        };
        plan.hand_out_early(request, trailing);
        plan
    }

    /// Hands levels out as far ahead as robots stay clear that are narrower so early.
    fn hand_out_early(&mut self, request: &PlanRequest<'_>, trailing: &Trailing) {
        for share in SHARES {
            let ahead = share * AHEAD;
            let levels = self.narrowest(ahead);
            if share == 0.0 || self.is_clear_at(request, trailing, &levels) {
                self.ahead = ahead;
                for (point, level) in self.points.iter_mut().zip(levels) {
                    point.early_level = level;
                }
                return;
            }
        }
    }

    /// The narrowest level within a way ahead, for every point. It begins as that of the formation does, and rises no more
    /// steeply than that: a lead that sets out is slow, and places would move aside faster than it drives.
    fn narrowest(&self, ahead: f64) -> Vec<f64> {
        let pairs =
            || self.points.windows(2).map(|pair| (pair[1].way - pair[0].way, pair[1].level - pair[0].level));
        let steepest =
            pairs().filter(|(way, _)| *way > 1e-6).fold(0.0, |most: f64, (way, rise)| most.max(rise / way));
        let mut levels: Vec<f64> = vec![];
        for (k, point) in self.points.iter().enumerate() {
            let within = self.points[k..].iter().take_while(|other| other.way <= point.way + ahead);
            let narrowest = within.map(|other| other.level).fold(point.level, f64::max);
            let most = match levels.last() {
                None => point.level,
                Some(last) => last + steepest * (point.way - self.points[k - 1].way),
            };
            levels.push(narrowest.min(most).max(point.level));
        }
        levels
    }

    fn is_clear_at(&self, request: &PlanRequest<'_>, trailing: &Trailing, levels: &[f64]) -> bool {
        let Some(first) = levels.first() else { return true };
        let mut sweep = Sweep::new(request.map, trailing, &request.limits);
        let mut convoy = trailing.begin(request, *first);
        let mut number = 0;
        sweep.begin(&convoy).is_ok()
            && self.legs.iter().all(|leg| {
                number += 1;
                leg.pieces(piece_length(leg)).all(|mut piece| {
                    piece.level = levels[number];
                    number += 1;
                    sweep.piece(&mut convoy, &piece).is_ok()
                })
            })
    }
}

/// Length of the pieces of a leg, m.
fn piece_length(leg: &Leg) -> f64 {
    STEP.min((leg.length() / PIECES_LEAST).max(1e-6))
}

impl PlanPoint {
    /// Between this point and another; time and speed are this one's.
    pub(crate) fn between(&self, other: &Self, share: f64) -> Self {
        let mix = |a: f64, b: f64| a + share * (b - a);
        let pose = |a: &Pose, b: &Pose| Pose {
            x: mix(a.x, b.x),
            y: mix(a.y, b.y),
            heading: wrap(a.heading + share * wrap(b.heading - a.heading)),
        };
        Self {
            way: mix(self.way, other.way),
            time: self.time,
            pose: pose(&self.pose, &other.pose),
            curvature: mix(self.curvature, other.curvature),
            speed: self.speed,
            level: mix(self.level, other.level),
            early_level: mix(self.early_level, other.early_level),
            robots: self.robots.iter().zip(&other.robots).map(|(a, b)| pose(a, b)).collect(),
        }
    }
}

/// Points of one leg, with what bounds the speed between them.
struct Course {
    points: Vec<PlanPoint>,
    bounds: Vec<PieceBound>,
}

impl Course {
    /// The way of all robots over a leg; the convoy goes with it.
    fn new(trailing: &Trailing, leg: &Leg, convoy: &mut crate::trailing::Convoy) -> Self {
        let robots = |convoy: &crate::trailing::Convoy| {
            (0..trailing.robots()).map(|robot| convoy.pose(robot)).collect::<Vec<_>>()
        };
        let first = leg.knots[0];
        let point = |way: f64, pose: Pose, curvature: f64, level: f64, robots: Vec<Pose>| PlanPoint {
            way,
            time: 0.0,
            pose: Pose { heading: wrap(pose.heading), ..pose },
            curvature,
            speed: 0.0,
            level,
            early_level: level,
            robots,
        };
        let mut points = vec![point(0.0, leg.start, first.curvature, first.level, robots(convoy))];
        let mut bounds = vec![];
        let mut curvature = first.curvature;
        // Length of the piece before, and every robot's speed per speed of the lead over it.
        let mut before = 0.0;
        let mut ratios = vec![1.0; trailing.robots()];
        for piece in leg.pieces(piece_length(leg)) {
            for robot in 0..trailing.robots() {
                trailing.step(convoy, robot, &piece);
            }
            points.push(point(piece.way, piece.end, piece.curvature, piece.level, robots(convoy)));
            // From the middle of the piece before to that of this one.
            let span = 0.5 * (before + piece.length);
            let [mut turn, mut change] = [0.0_f64; 2];
            for (robot, last) in ratios.iter_mut().enumerate().skip(1) {
                let ratio = convoy.moved[robot] / piece.length;
                turn = turn.max(convoy.turned(robot).abs() / span);
                if before > 0.0 {
                    change = change.max((ratio - *last).abs() / span);
                }
                *last = ratio;
            }
            before = piece.length;
            bounds.push(PieceBound {
                length: piece.length,
                curvature: curvature.abs().max(piece.curvature.abs()),
                sharpness: (piece.curvature - curvature).abs() / piece.length,
                ratio: ratios.iter().skip(1).copied().fold(0.0, f64::max),
                turn,
                change,
                places: f64::INFINITY,
            });
            curvature = piece.curvature;
        }
        Self { points, bounds }
    }

    /// Followers' speeds are means over pieces: within one they are larger by about half of what they change by to the next.
    fn raise_ratios(&mut self) {
        let means: Vec<f64> = self.bounds.iter().map(|bound| bound.ratio).collect();
        for (k, bound) in self.bounds.iter_mut().enumerate() {
            let [before, after] = [means[k.saturating_sub(1)], means[(k + 1).min(means.len() - 1)]];
            bound.ratio += 0.5 * (before - means[k]).abs().max((after - means[k]).abs());
        }
    }

    /// Fills in speeds and times.
    fn drive(&mut self, request: &PlanRequest<'_>, leg: &Leg, start: f64) {
        for ramp in level_ramps(&leg.knots, request.model, &request.limits) {
            for (bound, end) in self.bounds.iter_mut().zip(&self.points[1..]) {
                if end.way > ramp.from + 1e-9 && end.way - bound.length < ramp.to - 1e-9 {
                    bound.places = bound.places.min(ramp.speed);
                }
            }
        }
        self.raise_ratios();
        let found = speeds(&self.bounds, &request.limits, start);
        let mut time = 0.0;
        for (k, speed) in found.iter().enumerate() {
            if k > 0 {
                time += 2.0 * self.bounds[k - 1].length / (found[k - 1] + speed);
            }
            self.points[k].time = time;
            self.points[k].speed = leg.direction() * speed;
        }
    }
}
