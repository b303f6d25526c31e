//! Plans to goals, as messages.

use super::record::{FieldValue, Fields, Record};
use vocabulary::{PlannedPath, PlannedPoint, Pose};

impl Record for PlannedPath {
    const NAME: &'static str = "Plan";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let mut robots: Vec<f64> = self.robots.iter().map(|robot| *robot as f64).collect();
        f.field("robot_indices", FieldValue::Series(&mut robots))?;
        let of = |value: fn(&PlannedPoint) -> f64| self.points.iter().map(value).collect::<Vec<f64>>();
        let (mut times, mut speeds) = (of(|point| point.time), of(|point| point.speed));
        let mut narrowings = of(|point| point.narrowing);
        let poses = self.points.iter().flat_map(|point| &point.poses);
        // Of all robots at the first point, then of all at the next.
        let mut poses: Vec<f64> = poses.flat_map(|pose| [pose.x, pose.y, pose.heading]).collect();
        f.field("due_s", FieldValue::Series(&mut times))?;
        f.field("lead_speed_m_s", FieldValue::Series(&mut speeds))?;
        f.field("narrowing", FieldValue::Series(&mut narrowings))?;
        f.field("x_m_y_m_heading_rad", FieldValue::Series(&mut poses))?;
        let whole = |x: &f64| x.fract() == 0.0 && (0.0..1e9).contains(x);
        let fits = robots.iter().all(whole)
            && !robots.is_empty()
            && [speeds.len(), narrowings.len()] == [times.len(); 2]
            && poses.len() == 3 * robots.len() * times.len();
        fits.then_some(())?;
        self.robots = robots.iter().map(|robot| *robot as usize).collect();
        let mut rows = poses.chunks_exact(3 * robots.len());
        let points = times.iter().zip(&speeds).zip(&narrowings).map(|((time, speed), narrowing)| {
            let pose = |own: &[f64]| Pose { x: own[0], y: own[1], heading: own[2] };
            Some(PlannedPoint {
                time: *time,
                speed: *speed,
                narrowing: *narrowing,
                poses: rows.next()?.chunks_exact(3).map(pose).collect(),
            })
        });
        self.points = points.collect::<Option<_>>()?;
        Some(())
    }
}
