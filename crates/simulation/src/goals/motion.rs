//! The motion of a lead robot along its plans.

use planning::{MotionPlan, PlanPoint};
use vocabulary::{MotionInput, PlannedPath, PlannedPoint, Trajectory};

/// A motion along plans, one after the other, with stops between.
#[derive(Debug, Clone)]
pub struct PlannedMotion {
    pub(super) parts: Vec<PlannedPart>,
    /// The robots that the plans hold for, by their numbers in the run, the lead first.
    pub robots: Vec<usize>,
    /// Levels of the formation, from its shape to its column.
    pub levels: usize,
}

/// A plan, and when it begins.
#[derive(Debug, Clone)]
pub struct PlannedPart {
    /// s.
    pub begins: f64,
    /// Number of the goal that it leads to, over all rounds of a tour; `None` where the formation only comes to a stand.
    pub goal: Option<usize>,
    /// When another takes its place, s; infinite where none does.
    pub until: f64,
    /// The plan.
    pub plan: MotionPlan,
}

impl PlannedMotion {
    /// The plans in the order of time.
    pub fn parts(&self) -> &[PlannedPart] {
        &self.parts
    }

    /// When the lead is at its last goal, s.
    pub fn ends(&self) -> f64 {
        self.parts.last().map_or(0.0, PlannedPart::ends)
    }

    /// The part that is driven at a time in s: the last that has begun.
    pub fn part_at(&self, time: f64) -> Option<&PlannedPart> {
        let begun = self.parts.partition_point(|part| part.begins <= time);
        self.parts.get(begun.checked_sub(1)?)
    }

    /// Where the lead and all who follow it are by the plan at a time in s.
    pub fn point_at(&self, time: f64) -> Option<PlanPoint> {
        let part = self.part_at(time).or(self.parts.first())?;
        part.plan.at_time((time - part.begins).max(0.0))
    }

    /// What is left of it at a time in s.
    pub(super) fn path(&self, time: f64) -> PlannedPath {
        let column = self.levels.saturating_sub(1).max(1) as f64;
        let left = self.parts.iter().filter(|part| part.ends() > time && part.until > time);
        let points = left.flat_map(|part| {
            let own = part.plan.points.iter().take_while(|point| part.begins + point.time < part.until);
            own.map(move |point| PlannedPoint {
                time: part.begins + point.time,
                speed: point.speed,
                narrowing: point.level / column,
                poses: point.robots.clone(),
            })
        });
        PlannedPath { robots: self.robots.clone(), points: points.collect() }
    }

    /// The same until `time` s, and `parts` from then on.
    pub(super) fn then(&self, time: f64, parts: Vec<PlannedPart>) -> Self {
        let before = self.parts.iter().filter(|part| part.begins < time);
        let cut = before.map(|part| PlannedPart { until: part.until.min(time), ..part.clone() });
        Self { parts: cut.chain(parts).collect(), ..self.clone() }
    }
}

impl PlannedPart {
    /// When it is at its end, or another takes its place, s.
    pub fn ends(&self) -> f64 {
        self.arrives().min(self.until)
    }

    /// When it is at its end, s, if none takes its place before.
    pub fn arrives(&self) -> f64 {
        self.begins + self.plan.duration()
    }
}

impl Trajectory for PlannedMotion {
    fn at(&self, time: f64) -> MotionInput {
        self.part_at(time)
            .map_or_else(MotionInput::default, |part| motion(&part.plan.points, time - part.begins))
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
