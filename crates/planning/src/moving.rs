//! Things that move in a known way: other formations, carts on paths.

use crate::convex::{Convex, apart};
use crate::error::{InputError, checked};
use vocabulary::{Pose, wrap};

/// A body on a known track.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingThing {
    /// About its reference point.
    body: Convex,
    track: Vec<TrackPoint>,
    /// Radius of the circle around the reference point that holds the body, m.
    reach: f64,
    /// m/s, at the rim of that circle.
    fastest: f64,
}

/// Where a thing is at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackPoint {
    /// s.
    pub time: f64,
    /// Where it is.
    pub pose: Pose,
}

impl MovingThing {
    /// Between the points of its track a thing goes straight and turns evenly; before the first and after the last it stands.
    ///
    /// # Errors
    /// No points, times that do not rise, or a number that is not finite.
    pub fn new(body: Convex, track: Vec<TrackPoint>) -> Result<Self, InputError> {
        let range = "one point or more";
        checked(track.len() as f64, !track.is_empty(), || "the length of a track".into(), range)?;
        for point in &track {
            for value in [point.time, point.pose.x, point.pose.y, point.pose.heading] {
                checked(value, value.is_finite(), || "a number of a track".into(), "finite")?;
            }
        }
        for pair in track.windows(2) {
            let rises = pair[0].time < pair[1].time;
            checked(pair[1].time, rises, || "a time of a track".into(), "later than the one before, s")?;
        }
        let [x, y] = body.centre();
        let reach = (x * x + y * y).sqrt() + body.reach();
        let speed = |pair: &[TrackPoint]| {
            let [a, b] = [pair[0], pair[1]];
            let turn = wrap(b.pose.heading - a.pose.heading).abs();
            (apart([a.pose.x, a.pose.y], [b.pose.x, b.pose.y]) + turn * reach) / (b.time - a.time)
        };
        let fastest = track.windows(2).map(speed).fold(0.0, f64::max);
        Ok(Self { body, track, reach, fastest })
    }

    /// Where its reference point is at a time in s.
    pub fn at(&self, time: f64) -> Pose {
        let after = self.track.partition_point(|point| point.time <= time);
        let (Some(a), Some(b)) =
            (after.checked_sub(1).and_then(|k| self.track.get(k)), self.track.get(after))
        else {
            let end = if after == 0 { self.track.first() } else { self.track.last() };
            return end.map(|point| point.pose).unwrap_or_default();
        };
        let share = (time - a.time) / (b.time - a.time);
        Pose {
            x: a.pose.x + share * (b.pose.x - a.pose.x),
            y: a.pose.y + share * (b.pose.y - a.pose.y),
            heading: wrap(a.pose.heading + share * wrap(b.pose.heading - a.pose.heading)),
        }
    }

    /// What it takes up at a time in s.
    pub fn body_at(&self, time: f64) -> Convex {
        self.body.moved(self.at(time))
    }

    /// From when on it stands, s.
    pub fn rests_at(&self) -> f64 {
        self.track.last().map_or(0.0, |point| point.time)
    }

    /// Bound on the speed of each of its points, m/s.
    pub fn fastest(&self) -> f64 {
        self.fastest
    }

    /// Radius of the circle around its reference point that holds it, m.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// What it takes up from one time to another, s: the hull of where it is every quarter of a second.
    pub(crate) fn swept(&self, from: f64, to: f64) -> Convex {
        let steps = ((to - from) / SWEPT).ceil().max(1.0);
        let times = (0..=steps as usize).map(|k| from + (to - from) * k as f64 / steps);
        let bodies: Vec<Convex> = times.map(|time| self.body_at(time)).collect();
        let points: Vec<[f64; 2]> = bodies.iter().flat_map(Convex::corners).collect();
        let radius = self.body.radius();
        let corners = hull(&points);
        let whole = Convex::polygon(&corners).map(|hull| hull.corners().collect());
        // What is as thin as a line has no area.
        Convex::new(&whole.unwrap_or(corners), radius)
    }
}

/// s.
const SWEPT: f64 = 0.25;

/// The corners of the convex hull of some points, counter-clockwise (Andrew's monotone chain).
fn hull(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut points = points.to_vec();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = vec![];
        for c in points {
            while let [.., a, b] = chain.as_slice() {
                let cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
                if cross > 1e-12 {
                    break;
                }
                chain.pop();
            }
            chain.push(c);
        }
        chain.pop();
        chain
    };
    if points.len() < 3 {
        return points;
    }
    let mut corners = half(&mut points.iter().copied());
    corners.extend(half(&mut points.iter().rev().copied()));
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thing_is_between_its_points_and_stands_before_and_after() {
        let point = |time: f64, x: f64, heading: f64| TrackPoint { time, pose: Pose::new(x, 0.0, heading) };
        let body = Convex::rectangle(Pose::default(), [0.5, 0.2]).expect("a box");
        let thing =
            MovingThing::new(body, vec![point(1.0, 0.0, 3.0), point(3.0, 4.0, -3.0)]).expect("a thing");
        assert_eq!(thing.at(0.0).x, 0.0);
        assert_eq!(thing.at(9.0).x, 4.0);
        let middle = thing.at(2.0);
        assert_eq!(middle.x, 2.0);
        assert!((middle.heading.abs() - std::f64::consts::PI).abs() < 1e-12, "{}", middle.heading);
        assert!(thing.fastest() > 2.0 && thing.fastest() < 2.2);
        let swept = thing.swept(1.0, 3.0);
        for k in 0..=20 {
            let at = thing.at(1.0 + 0.1 * f64::from(k));
            assert!(swept.distance([at.x, at.y]) < 0.0);
        }
    }

    #[test]
    fn tracks_that_make_no_sense_are_refused() {
        let body = Convex::disc([0.0; 2], 0.3).expect("a disc");
        let at = |time: f64| TrackPoint { time, pose: Pose::default() };
        assert!(MovingThing::new(body.clone(), vec![]).is_err());
        assert!(MovingThing::new(body.clone(), vec![at(1.0), at(1.0)]).is_err());
        assert!(MovingThing::new(body, vec![at(f64::NAN)]).is_err());
    }
}
