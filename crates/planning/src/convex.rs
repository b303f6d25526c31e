//! Convex bodies seen from above: obstacles, and robots that are not round. Distances are exact.

use crate::error::{InputError, checked};
use vocabulary::{Pose, math};

/// The convex hull of some corners, grown by a radius: a disc has one corner, a box four and no radius.
#[derive(Debug, Clone, PartialEq)]
pub struct Convex {
    sides: Vec<Side>,
    radius: f64,
    centre: [f64; 2],
    reach: f64,
}

/// A side of a polygon, counter-clockwise; that of a point has no length.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Side {
    from: [f64; 2],
    along: [f64; 2],
    length: f64,
}

/// The nearest point of something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// m; negative inside.
    pub distance: f64,
    /// Unit vector in which the distance grows fastest: from the nearest point, for a point outside.
    pub direction: [f64; 2],
}

/// Sides shorter than this share of the polygon are no sides.
const SHORT: f64 = 1e-9;

impl Convex {
    /// A disc of `radius` m around `centre`.
    ///
    /// # Errors
    /// A number is not finite, or the radius is not positive.
    pub fn disc(centre: [f64; 2], radius: f64) -> Result<Self, InputError> {
        finite(&[centre], "the middle of a disc")?;
        checked(radius, radius > 0.0, || "the radius of a disc".into(), "positive, m")?;
        Ok(Self::new(&[centre], radius))
    }

    /// A rectangle around `middle`, `half` = [half its length along the heading, half its width], m.
    ///
    /// # Errors
    /// A number is not finite, or a half is not positive.
    pub fn rectangle(middle: Pose, half: [f64; 2]) -> Result<Self, InputError> {
        finite(&[[middle.x, middle.y], [middle.heading, 0.0]], "the middle of a box")?;
        for size in half {
            checked(size, size > 0.0, || "half the size of a box".into(), "positive, m")?;
        }
        Ok(Self::new(&corners(middle, [-half[0], half[0]], half[1]), 0.0))
    }

    /// A polygon by its corners in either sense, m.
    ///
    /// # Errors
    /// A number is not finite, there is no area, or it is not convex.
    pub fn polygon(corners: &[[f64; 2]]) -> Result<Self, InputError> {
        let what = "a polygon";
        finite(corners, what)?;
        let mut corners = corners.to_vec();
        let size = size(&corners);
        corners.dedup_by(|b, a| apart(*a, *b) <= SHORT * size);
        while corners.len() > 1 && apart(corners[0], corners[corners.len() - 1]) <= SHORT * size {
            corners.pop();
        }
        let area = area(&corners);
        if corners.len() < 3 || area.abs() <= SHORT * size * size {
            return Err(InputError::NoArea { what: what.into(), corners: corners.len() });
        }
        if area < 0.0 {
            corners.reverse();
        }
        convex(&corners, size).map_err(|corner| InputError::NotConvex { what: what.into(), corner })?;
        Ok(Self::new(&corners, 0.0))
    }

    /// A body of checked corners, counter-clockwise.
    pub(crate) fn new(corners: &[[f64; 2]], radius: f64) -> Self {
        let n = corners.len();
        let sides: Vec<Side> = (0..n).map(|k| Side::between(corners[k], corners[(k + 1) % n])).collect();
        let [low, high] = box_of(corners);
        let centre = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
        let reach = corners.iter().map(|corner| apart(*corner, centre)).fold(0.0, f64::max) + radius;
        Self { sides, radius, centre, reach }
    }

    /// A point within, m: a circle of [`Convex::reach`] around it holds the body.
    pub fn centre(&self) -> [f64; 2] {
        self.centre
    }

    /// Radius of a circle around the centre that holds the body, m.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// By how much the hull of the corners is grown, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The corners, counter-clockwise, m; one for a disc.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = [f64; 2]> + '_ {
        self.sides.iter().map(|side| side.from)
    }

    /// The body turned by `heading` about the origin and then moved, m.
    #[must_use]
    pub fn moved(&self, by: Pose) -> Self {
        let corners: Vec<_> = self.corners().map(|[x, y]| by.world_from_body(x, y)).collect();
        Self::new(&corners, self.radius)
    }

    /// Signed distance of a point, m: negative inside.
    pub fn distance(&self, point: [f64; 2]) -> f64 {
        if let [only] = self.sides.as_slice() {
            return apart(point, only.from) - self.radius;
        }
        let (mut plane, mut square) = (f64::NEG_INFINITY, f64::INFINITY);
        for side in &self.sides {
            let (d, [x, y]) = (side.relative(point), side.beyond(point));
            plane = plane.max(d);
            square = square.min(x * x + y * y);
        }
        if self.is_flat() || plane > 0.0 { square.sqrt() - self.radius } else { plane - self.radius }
    }

    /// Signed distance of a point with the direction in which it grows.
    pub fn nearest(&self, point: [f64; 2]) -> Nearest {
        let (mut plane, mut normal) = (f64::NEG_INFINITY, [1.0, 0.0]);
        let (mut square, mut away) = (f64::INFINITY, [1.0, 0.0]);
        for side in &self.sides {
            let (d, [x, y]) = (side.relative(point), side.beyond(point));
            if d > plane && side.length > 0.0 {
                (plane, normal) = (d, side.normal());
            }
            if x * x + y * y < square {
                (square, away) = (x * x + y * y, [x, y]);
            }
        }
        if square == 0.0 || (!self.is_flat() && plane <= 0.0) {
            let within = if self.is_flat() { 0.0 } else { plane.min(0.0) };
            return Nearest { distance: within - self.radius, direction: normal };
        }
        let distance = square.sqrt();
        Nearest { distance: distance - self.radius, direction: away.map(|x| x / distance) }
    }

    /// Number of the side beyond or next to which a point lies.
    pub(crate) fn side_towards(&self, point: [f64; 2]) -> usize {
        let last = |found: usize, k: usize| {
            if self.sides[k].relative(point) > self.sides[found].relative(point) { k } else { found }
        };
        (0..self.sides.len()).fold(0, last)
    }

    /// For every side the distance of a point inside, with the direction inwards.
    pub(crate) fn sides_from_inside(&self, point: [f64; 2]) -> impl Iterator<Item = Nearest> + '_ {
        self.sides.iter().map(move |side| Nearest {
            distance: -side.relative(point),
            direction: side.normal().map(|x| -x),
        })
    }

    /// How far a body is inside one of our sides, m.
    pub(crate) fn inside_of(&self, side: usize, body: &Self) -> f64 {
        let corners = body.corners().map(|corner| -self.sides[side].relative(corner));
        corners.fold(f64::INFINITY, f64::min) - body.radius
    }

    /// Distance to another body, m. Where they overlap, minus the least way that parts their hulls.
    pub fn distance_to(&self, other: &Self) -> f64 {
        let radii = self.radius + other.radius;
        let apart = self.separation(other).max(other.separation(self));
        if apart <= 0.0 && !(self.is_flat() && other.is_flat()) {
            return apart - radii;
        }
        let squares = self.corners_square(other).min(other.corners_square(self));
        squares.sqrt() - radii
    }

    /// Largest distance along a normal of ours at which all of `other` lies; −∞ for what has no normals.
    fn separation(&self, other: &Self) -> f64 {
        let beyond =
            |side: &Side| other.sides.iter().map(|o| side.relative(o.from)).fold(f64::INFINITY, f64::min);
        if self.is_flat() {
            return f64::NEG_INFINITY;
        }
        self.sides.iter().map(beyond).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Least squared distance of a corner of `other` to a side of ours.
    fn corners_square(&self, other: &Self) -> f64 {
        let mut least = f64::INFINITY;
        for side in &self.sides {
            for corner in &other.sides {
                let [x, y] = side.beyond(corner.from);
                least = least.min(x * x + y * y);
            }
        }
        least
    }

    /// Whether the hull has no inside: a point.
    fn is_flat(&self) -> bool {
        self.sides.len() < 3
    }
}

impl Side {
    fn between(from: [f64; 2], to: [f64; 2]) -> Self {
        let length = apart(from, to);
        let along = if length > 0.0 { [0, 1].map(|k| (to[k] - from[k]) / length) } else { [1.0, 0.0] };
        Self { from, along, length }
    }

    /// Outward.
    fn normal(&self) -> [f64; 2] {
        [self.along[1], -self.along[0]]
    }

    /// Distance of a point to the line of this side, positive outside; 0 for a point's.
    fn relative(&self, point: [f64; 2]) -> f64 {
        let [x, y] = [point[0] - self.from[0], point[1] - self.from[1]];
        x * self.along[1] - y * self.along[0]
    }

    /// From the nearest point of this side to a point.
    fn beyond(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = [point[0] - self.from[0], point[1] - self.from[1]];
        let t = (x * self.along[0] + y * self.along[1]).clamp(0.0, self.length);
        [x - t * self.along[0], y - t * self.along[1]]
    }
}

/// Corners of a rectangle from `ends[0]` to `ends[1]` along the heading of `pose`, `half_width` to either side.
pub(crate) fn corners(pose: Pose, ends: [f64; 2], half_width: f64) -> [[f64; 2]; 4] {
    let [back, front] = ends;
    [[back, -half_width], [front, -half_width], [front, half_width], [back, half_width]]
        .map(|[x, y]| pose.world_from_body(x, y))
}

pub(crate) fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [x, y] = [a[0] - b[0], a[1] - b[1]];
    (x * x + y * y).sqrt()
}

/// Lower left and upper right corner of the box around some points.
pub(crate) fn box_of(points: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    points.iter().fold(start, |[low, high], p| {
        [[low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])]]
    })
}

fn size(points: &[[f64; 2]]) -> f64 {
    let [low, high] = box_of(points);
    if points.is_empty() { 0.0 } else { apart(low, high) }
}

/// Positive counter-clockwise, m².
fn area(corners: &[[f64; 2]]) -> f64 {
    let n = corners.len();
    let cross = |k: usize| corners[k][0] * corners[(k + 1) % n][1] - corners[(k + 1) % n][0] * corners[k][1];
    0.5 * (0..n).map(cross).sum::<f64>()
}

/// Checks that corners turn left everywhere and go around once; else the first that does not.
fn convex(corners: &[[f64; 2]], size: f64) -> Result<(), usize> {
    let n = corners.len();
    let mut turned = 0.0;
    for k in 0..n {
        let [a, b, c] = [corners[(k + n - 1) % n], corners[k], corners[(k + 1) % n]];
        let [u, v] = [[b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]];
        let cross = u[0] * v[1] - u[1] * v[0];
        if cross < -SHORT * size * size {
            return Err(k);
        }
        turned += math::atan2(cross, u[0] * v[0] + u[1] * v[1]);
    }
    if turned > 1.5 * std::f64::consts::TAU { Err(0) } else { Ok(()) }
}

fn finite(points: &[[f64; 2]], what: &str) -> Result<(), InputError> {
    let all = points.iter().flatten().all(|value| value.is_finite());
    if all { Ok(()) } else { Err(InputError::NotFinite { what: what.into() }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn square() -> Convex {
        Convex::rectangle(Pose::new(1.0, 2.0, 0.0), [1.0, 0.5]).expect("a box")
    }

    /// The boundary of a body by points a given step apart, an independent way to its distances.
    fn boundary(body: &Convex, step: f64) -> Vec<[f64; 2]> {
        let corners: Vec<_> = body.corners().collect();
        let n = corners.len();
        let mut points = vec![];
        for k in 0..n {
            let (a, b) = (corners[k], corners[(k + 1) % n]);
            let parts = (apart(a, b) / step).ceil().max(1.0);
            points.extend((0..parts as usize).map(|i| {
                let t = i as f64 / parts;
                [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
            }));
        }
        points
    }

    #[test]
    fn distances_of_points() {
        let body = square();
        assert_eq!(body.distance([3.0, 2.0]), 1.0);
        assert_eq!(body.distance([1.0, 2.0]), -0.5);
        assert!((body.distance([2.3, 2.9]) - 0.5).abs() < 1e-12);
        let disc = Convex::disc([0.0, 0.0], 0.5).expect("a disc");
        assert_eq!(disc.distance([2.0, 0.0]), 1.5);
        assert_eq!(disc.nearest([0.0, 3.0]), Nearest { distance: 2.5, direction: [0.0, 1.0] });
        assert_eq!(disc.nearest([0.0, 0.0]).distance, -0.5);
        assert_eq!(disc.distance_to(&body), 2.25_f64.sqrt() - 0.5);
    }

    #[test]
    fn what_is_no_convex_polygon_is_refused() {
        let bent = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.5], [1.0, 2.0]];
        assert_eq!(
            Convex::polygon(&bent).unwrap_err().to_string(),
            "a polygon is not convex at corner 2: split it into convex parts"
        );
        let star = |k| math::sin_cos(0.4 * std::f64::consts::TAU * f64::from(k));
        let pentagram: Vec<_> = (0..5).map(star).map(|(sin, cos)| [cos, sin]).collect();
        assert!(matches!(Convex::polygon(&pentagram), Err(InputError::NotConvex { .. })));
        let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]];
        assert!(matches!(Convex::polygon(&line), Err(InputError::NoArea { .. })));
        assert!(matches!(Convex::polygon(&[]), Err(InputError::NoArea { .. })));
        assert!(matches!(Convex::disc([0.0, f64::NAN], 1.0), Err(InputError::NotFinite { .. })));
        assert!(matches!(Convex::disc([0.0, 0.0], 0.0), Err(InputError::OutOfRange { .. })));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn distances_are_those_of_dense_points(
            x in -3.0..3.0, y in -3.0..3.0, turn in -3.0..3.0, a in 0.1..1.0, b in 0.1..1.0, px in -4.0..4.0, py in -4.0..4.0
        ) {
            let body = Convex::rectangle(Pose::new(x, y, turn), [a, b]).expect("a box");
            let other = square();
            let (ours, theirs) = (boundary(&body, 0.02), boundary(&other, 0.02));
            let to = |p: [f64; 2], of: &[[f64; 2]]| of.iter().map(|q| apart(p, *q)).fold(f64::INFINITY, f64::min);
            let found = body.nearest([px, py]);
            prop_assert!((found.distance.abs() - to([px, py], &ours)).abs() < 0.011);
            prop_assert_eq!(found.distance, body.distance([px, py]));
            // Against the direction by its distance lies the boundary.
            let foot = [0, 1].map(|k| [px, py][k] - found.distance * found.direction[k]);
            prop_assert!(body.distance(foot).abs() < 1e-9);
            let between = body.distance_to(&other);
            prop_assert!((between - other.distance_to(&body)).abs() < 1e-12);
            let dense = ours.iter().map(|p| to(*p, &theirs)).fold(f64::INFINITY, f64::min);
            let inside = other.distance([x, y]) < 0.0 || body.distance([1.0, 2.0]) < 0.0 || ours.iter().any(|p| other.distance(*p) < -1e-9) || theirs.iter().any(|p| body.distance(*p) < -1e-9);
            if inside { prop_assert!(between < 0.0) } else { prop_assert!((between - dense).abs() < 0.015, "{} {}", between, dense) }
        }
    }
}
