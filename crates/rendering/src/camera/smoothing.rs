//! What cameras follow: headings and the formation's extent, filtered so that a picture never jumps.

use vocabulary::math;
use vocabulary::{Condition, Pose, RobotState, StepRecord, nearest_turn};

/// Time constant of headings, s: calm in curves, and a first order filter cannot overshoot.
const HEADING_LAG: f64 = 0.8;
/// Time constant of the extent, s.
const EXTENT_LAG: f64 = 1.0;
/// Fastest change of size, 1/s: a zoom slower than 15% a second goes unnoticed.
const ZOOM_RATE: f64 = 0.13;

/// The formation's outline along a heading: a rectangle with its corners cut off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extent {
    /// Its origin is the lead robot, its heading the filtered one.
    pub(crate) frame: Pose,
    /// Rearmost and foremost, m.
    pub(crate) forward: [f64; 2],
    /// Rightmost and leftmost, m.
    pub(crate) left: [f64; 2],
    /// How far each corner is cut off along both sides, m; in the order of [`CORNERS`].
    pub(crate) cuts: [f64; 4],
    /// To the left of the lead robot, where the rear of the formation is, m.
    pub(crate) rear: f64,
    /// Lowest and highest ground under a robot, m.
    pub(crate) ground: [f64; 2],
    /// How many times as large as the default body the largest is; 1 or more.
    pub(crate) size: f64,
}

impl Extent {
    /// Its middle in the world, m.
    pub(crate) fn middle(&self) -> [f64; 2] {
        let [forward, left] = [self.forward, self.left].map(|[low, high]| 0.5 * (low + high));
        self.frame.world_from_body(forward, left)
    }

    /// Radius of the circle around it, `margin` wider on all sides, m: a view of that does not zoom where it turns.
    pub(crate) fn radius(&self, margin: f64) -> f64 {
        let Self { forward, left, .. } = self.grown(margin);
        0.5 * math::hypot(forward[1] - forward[0], left[1] - left[0])
    }

    /// The eight corners of the outline, `margin` wider on all sides, in the frame, m.
    pub(crate) fn outline(&self, margin: f64) -> Vec<[f64; 2]> {
        let grown = self.grown(margin);
        let side = |[low, high]: [f64; 2], sign: f64| if sign > 0.0 { high } else { low };
        let corners = CORNERS.iter().zip(&self.cuts).flat_map(|([f, l], cut)| {
            let (forward, left) = (side(grown.forward, *f), side(grown.left, *l));
            [[forward - f * cut, left], [forward, left - l * cut]]
        });
        corners.collect()
    }

    pub(crate) fn grown(&self, margin: f64) -> Self {
        let grow = |[low, high]: [f64; 2]| [low - margin, high + margin];
        Self { forward: grow(self.forward), left: grow(self.left), ..*self }
    }
}

/// Signs of forward and left at each corner.
const CORNERS: [[f64; 2]; 4] = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];

/// Filtered headings and extent.
#[derive(Debug, Clone, Default)]
pub(crate) struct SmoothedFormation {
    lead: usize,
    /// When the last moment was, s.
    pub(crate) time: Option<f64>,
    size: f64,
    headings: Vec<f64>,
    heights: Vec<f64>,
    extent: Option<Extent>,
}

impl SmoothedFormation {
    /// For robots of which the largest is `size` times as large as the default body.
    pub(crate) fn new(lead: usize, size: f64) -> Self {
        Self { lead, size: size.max(1.0), ..Self::default() }
    }

    /// Takes in a moment together with the set points on the ground.
    pub(crate) fn push(&mut self, record: &StepRecord, set_points: &[[f64; 2]]) {
        let time = record.snapshot.time;
        // The first moment is taken as it is.
        let step = self.time.map_or(f64::INFINITY, |before| (time - before).max(0.0));
        self.time = Some(time);
        self.turn(record, step);
        self.look_for_lead(record);
        let Some(wanted) = self.measure(record, set_points) else { return };
        let old = self.extent.unwrap_or(wanted);
        self.extent = Some(approach(&old, &wanted, step));
    }

    /// Goes over to another lead robot where the one that was followed has failed; what is framed stays.
    fn look_for_lead(&mut self, record: &StepRecord) {
        let robots = &record.snapshot.robots;
        let fails = |robot: usize| robots.get(robot).is_none_or(|robot| !in_formation(robot));
        if record.leaders.is_empty() || !fails(self.lead) {
            return;
        }
        // Who is followed, or the first that drives.
        let followed = record.leaders.iter().flatten().copied().find(|robot| !fails(*robot));
        let Some(next) = followed.or_else(|| (0..robots.len()).find(|robot| !fails(*robot))) else { return };
        if let Some(extent) = &mut self.extent {
            let Pose { x, y, .. } = robots[next].motion.pose;
            let [ahead, aside] = extent.frame.body_from_world(x, y);
            extent.forward = extent.forward.map(|place| place - ahead);
            extent.left = extent.left.map(|place| place - aside);
            extent.rear -= aside;
        }
        self.lead = next;
    }

    /// The filtered heading of a robot, rad, not wrapped.
    pub(crate) fn heading(&self, robot: usize) -> Option<f64> {
        self.headings.get(robot).copied()
    }

    /// The filtered height of a robot, m.
    pub(crate) fn height(&self, robot: usize) -> f64 {
        self.heights.get(robot).copied().unwrap_or_default()
    }

    /// The formation as the camera sees it.
    pub(crate) fn formation(&self) -> Extent {
        self.extent.unwrap_or(Extent {
            frame: Pose::default(),
            forward: [-1.0, 1.0],
            left: [-1.0, 1.0],
            cuts: [0.0; 4],
            rear: 0.0,
            ground: [0.0; 2],
            size: self.size.max(1.0),
        })
    }

    fn turn(&mut self, record: &StepRecord, step: f64) {
        let share = 1.0 - math::exp(-step / HEADING_LAG);
        let robots = &record.snapshot.robots;
        self.headings.resize(robots.len(), f64::NAN);
        for (kept, robot) in self.headings.iter_mut().zip(robots) {
            let heading = robot.motion.pose.heading;
            *kept =
                if kept.is_nan() { heading } else { *kept + share * (nearest_turn(heading, *kept) - *kept) };
        }
        self.heights.resize(robots.len(), f64::NAN);
        for (kept, robot) in self.heights.iter_mut().zip(robots) {
            let height = robot.attitude.height;
            *kept = if kept.is_nan() { height } else { *kept + share * (height - *kept) };
        }
    }

    fn measure(&self, record: &StepRecord, set_points: &[[f64; 2]]) -> Option<Extent> {
        let robots = &record.snapshot.robots;
        let lead = robots.get(self.lead)?.motion.pose;
        let frame = Pose { heading: self.heading(self.lead)?, ..lead };
        let local = |[x, y]: [f64; 2]| frame.body_from_world(x, y);
        let present = robots.iter().enumerate().filter(|(k, robot)| *k == self.lead || in_formation(robot));
        let poses = present.map(|(_, r)| [r.motion.pose.x, r.motion.pose.y]);
        let points: Vec<_> = poses.chain(set_points.iter().copied()).map(local).collect();
        let range = |k: usize| {
            points
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p[k]), high.max(p[k])])
        };
        let (forward, left) = (range(0), range(1));
        // Weighing softly keeps the place steady while robots take turns at being last.
        let weigh = |p: &[f64; 2]| math::exp(-(p[0] - forward[0]) / 0.3);
        let total: f64 = points.iter().map(weigh).sum();
        let rear = points.iter().map(|p| weigh(p) * p[1]).sum::<f64>() / total;
        let cuts = CORNERS.map(|[f, l]| {
            let most = points.iter().map(|p| f * p[0] + l * p[1]).fold(f64::NEG_INFINITY, f64::max);
            let pick = |[low, high]: [f64; 2], sign: f64| if sign > 0.0 { high } else { -low };
            (pick(forward, f) + pick(left, l) - most).max(0.0)
        });
        // What falls out of the world does not take the camera along.
        let standing = || robots.iter().filter(|r| r.condition != Condition::Fallen);
        let heights = || standing().map(|r| r.attitude.height).filter(|h| h.is_finite());
        let ground = [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
        let ground = if ground[0] <= ground[1] { ground } else { [0.0; 2] };
        Some(Extent { frame, forward, left, cuts, rear, ground, size: self.size.max(1.0) })
    }
}

/// Whether a robot is one that the camera keeps in sight: who has failed stays behind.
fn in_formation(robot: &RobotState) -> bool {
    !matches!(robot.condition, Condition::Failed | Condition::Removed)
}

fn approach(old: &Extent, wanted: &Extent, step: f64) -> Extent {
    let share = 1.0 - math::exp(-step / EXTENT_LAG);
    let mix = |a: f64, b: f64| a + share * (b - a);
    // Sizes below a metre do not drive the zoom, so they may change faster.
    let range = |a: [f64; 2], b: [f64; 2]| {
        let (size, goal) = (a[1] - a[0], b[1] - b[0]);
        let most = ZOOM_RATE * step * size.max(1.0);
        let grown = size + (mix(size, goal) - size).clamp(-most, most);
        let middle = mix(0.5 * (a[0] + a[1]), 0.5 * (b[0] + b[1]));
        [middle - 0.5 * grown, middle + 0.5 * grown]
    };
    if step.is_infinite() {
        return *wanted;
    }
    Extent {
        frame: wanted.frame,
        forward: range(old.forward, wanted.forward),
        left: range(old.left, wanted.left),
        cuts: std::array::from_fn(|k| mix(old.cuts[k], wanted.cuts[k])),
        rear: mix(old.rear, wanted.rear),
        ground: std::array::from_fn(|k| mix(old.ground[k], wanted.ground[k])),
        size: wanted.size,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{RobotState, Snapshot};

    fn record(time: f64, places: &[[f64; 3]]) -> StepRecord {
        let robot = |p: &[f64; 3]| {
            let mut robot = RobotState::default();
            robot.motion.pose = Pose::new(p[0], p[1], p[2]);
            robot
        };
        let robots = places.iter().map(robot).collect();
        StepRecord { snapshot: Snapshot { time, robots, ..Snapshot::default() }, ..StepRecord::default() }
    }

    #[test]
    fn a_turn_is_followed_without_overshoot() {
        let mut smoothed = SmoothedFormation::new(0, 1.0);
        smoothed.push(&record(0.0, &[[0.0, 0.0, 3.0]]), &[]);
        let mut last = 3.0;
        for k in 1..800 {
            smoothed.push(&record(f64::from(k) * 0.01, &[[0.0, 0.0, -3.0]]), &[]);
            let heading = smoothed.heading(0).unwrap();
            assert!(heading >= last && heading <= std::f64::consts::TAU - 3.0);
            last = heading;
        }
        assert!((last - (std::f64::consts::TAU - 3.0)).abs() < 1e-3);
    }

    #[test]
    fn a_stray_robot_zooms_slowly() {
        let mut smoothed = SmoothedFormation::new(0, 1.0);
        smoothed.push(&record(0.0, &[[0.0; 3], [-2.0, -2.0, 0.0]]), &[]);
        let size = |s: &SmoothedFormation| s.formation().left[1] - s.formation().left[0];
        let before = size(&smoothed);
        for k in 1..=100 {
            smoothed.push(&record(f64::from(k) * 0.01, &[[0.0; 3], [-2.0, -20.0, 0.0]]), &[]);
        }
        assert!(size(&smoothed) / before < 1.15);
    }
}
