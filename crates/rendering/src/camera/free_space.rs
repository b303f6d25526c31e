//! The part of a view in which robots are not hidden by words, and how a camera keeps them there.

use glam::{DVec2, DVec3};

/// A bound of the picture that a point keeps: `across`·x + `up`·y ≤ `most`, x and y from −1 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bound {
    pub(crate) across: f64,
    pub(crate) up: f64,
    pub(crate) most: f64,
}

/// What words leave of a tile.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FreeSpace {
    /// Pixels across and down.
    size: [f64; 2],
    /// Rectangles that are taken: left, top, width, height; pixels from the tile's upper left corner.
    taken: Vec<[f64; 4]>,
    /// Of text and lines.
    scale: f64,
}

/// Whatever is taken, this share of the height is left in the middle.
const MIDDLE: f64 = 0.25;

impl FreeSpace {
    pub(crate) fn new(size: [f64; 2], taken: Vec<[f64; 4]>, scale: f64) -> Self {
        Self { size, taken, scale }
    }

    /// How many times as wide as high it is.
    pub(crate) fn aspect(&self) -> f64 {
        self.size[0] / self.size[1]
    }

    /// Whether a rectangle at the top reaches so far down that a formation has to stay beside it.
    fn bulky(&self, [_, top, _, height]: [f64; 4]) -> bool {
        top + 0.5 * height < 0.5 * self.size[1] && top + height > 0.3 * self.size[1]
    }

    /// The lowest and the highest normalised height (−1 bottom, 1 top) between which words leave all of the width, but for
    /// those of [`FreeSpace::corners`].
    pub(crate) fn rows(&self) -> [f64; 2] {
        let mut rows = [-1.0_f64, 1.0];
        for taken in self.taken.iter().filter(|taken| !self.bulky(**taken)) {
            let [top, bottom] = [taken[1], taken[1] + taken[3]].map(|y| 1.0 - 2.0 * y / self.size[1]);
            if top + bottom > 0.0 {
                rows[1] = rows[1].min(bottom);
            } else {
                rows[0] = rows[0].max(top);
            }
        }
        [rows[0].min(-MIDDLE), rows[1].max(MIDDLE)]
    }

    /// Bounds that keep out of large pictures in the corners.
    pub(crate) fn corners(&self) -> impl Iterator<Item = Bound> {
        self.taken.iter().filter(|taken| self.bulky(**taken)).filter_map(|taken| {
            let (normal, far) = self.away(*taken)?;
            let half = [0.5 * self.size[0], 0.5 * self.size[1]];
            Some(Bound { across: normal.x * half[0], up: -normal.y * half[1], most: far })
        })
    }

    /// The direction from the middle of the tile to the nearest point of a rectangle, and how far that is, pixels.
    fn away(&self, [left, top, width, height]: [f64; 4]) -> Option<(DVec2, f64)> {
        let middle = DVec2::from_array(self.size) * 0.5;
        let nearest = middle.clamp(DVec2::new(left, top), DVec2::new(left + width, top + height));
        let far = nearest.distance(middle);
        (far > 0.1 * middle.min_element()).then(|| ((nearest - middle) / far, far))
    }

    /// The largest disc that lies in the tile and under no words: its middle, normalised, and its radius as a share of
    /// half the height.
    pub(crate) fn disc(&self) -> ([f64; 2], f64) {
        let half = DVec2::from_array(self.size) * 0.5;
        let edge = 10.0 * self.scale;
        let edges = [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y]
            .map(|normal| (normal, normal.abs().dot(half) - edge));
        let words = self.taken.iter().filter_map(|taken| self.away(*taken));
        // A disc of radius r keeps r from every bound; the cone of heights over the plane is the same for any point.
        let planes = edges.into_iter().chain(words).map(|(normal, far)| [-normal.x, -normal.y, 1.0, -far]);
        let [x, y, radius] = highest(&planes.collect::<Vec<_>>(), f64::INFINITY, 0.5);
        ([x / half.x, -y / half.y], radius.max(1.0) / half.y)
    }
}

/// The place of the eye nearest to `points` (right, up and forward from anywhere, m), and at least `nearest` m from all of
/// them, from which they keep the bounds of a camera whose half tangents are `half`; `low` of the freedom that is left goes
/// below, the rest above.
pub(crate) fn eye(points: &[DVec3], half: DVec2, bounds: &[Bound], nearest: f64, low: f64) -> DVec3 {
    let Some(first) = points.first().copied() else { return DVec3::ZERO };
    let points: Vec<_> = points.iter().map(|point| *point - first).collect();
    // Each bound of the picture is a plane through the eye, and the outermost point beyond it bounds the eye.
    let plane = |bound: &Bound| {
        let (a, b, c) = (bound.across / half.x, bound.up / half.y, bound.most);
        [a, b, c, points.iter().map(|p| a * p.x + b * p.y - c * p.z).fold(f64::NEG_INFINITY, f64::max)]
    };
    let near = points.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let planes: Vec<_> = bounds.iter().map(plane).collect();
    first + DVec3::from_array(highest(&planes, near - nearest, low))
}

/// How far apart the ends of a search may be in the end, as a share of where it began.
const FINE: f64 = 1e-12;

/// Of all points (x, y, z) with a·x + b·y − c·z ≥ d for every plane [a, b, c, d], c > 0, and z ≤ `most`, one that is highest;
/// of several the middle across, and from the lowest on `low` of the way to the highest y.
fn highest(planes: &[[f64; 4]], most: f64, low: f64) -> [f64; 3] {
    let fits = |z: f64| section(planes, z);
    let scale = planes.iter().map(|plane| plane[3].abs()).fold(1.0, f64::max);
    let mut top = if most.is_finite() { most } else { 4.0 * scale };
    let mut step = 1e-3 * scale;
    let mut bottom = top;
    while fits(bottom).is_empty() {
        if step > 1e9 * scale {
            return [0.0, 0.0, bottom];
        }
        top = bottom;
        bottom -= step;
        step *= 2.0;
    }
    let fine = FINE * scale;
    while top - bottom > fine {
        let middle = 0.5 * (top + bottom);
        if fits(middle).is_empty() {
            top = middle;
        } else {
            bottom = middle;
        }
        if middle == top && middle == bottom {
            break;
        }
    }
    let polygon = fits(bottom);
    let range = |of: &mut dyn Iterator<Item = f64>| {
        of.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)])
    };
    let [left, right] = range(&mut polygon.iter().map(|p| p.x));
    let x = 0.5 * (left + right);
    // Where the upright line through x leaves the polygon.
    let edges = (0..polygon.len()).map(|k| (polygon[k], polygon[(k + 1) % polygon.len()]));
    let crossing = |(a, b): (DVec2, DVec2)| {
        let (first, last) = (a.x.min(b.x), a.x.max(b.x));
        let share = if last > first { ((x - a.x) / (b.x - a.x)).clamp(0.0, 1.0) } else { 0.5 };
        (first <= x && x <= last).then_some(a.y + (b.y - a.y) * share)
    };
    let [under, over] = range(&mut edges.filter_map(crossing));
    [x, under + (over - under) * low, bottom]
}

/// The polygon of all (x, y) that keep the planes at height z.
fn section(planes: &[[f64; 4]], z: f64) -> Vec<DVec2> {
    const FAR: f64 = 1e7;
    let mut polygon =
        vec![DVec2::new(-FAR, -FAR), DVec2::new(FAR, -FAR), DVec2::new(FAR, FAR), DVec2::new(-FAR, FAR)];
    for [a, b, c, d] in planes {
        let over = |p: &DVec2| a * p.x + b * p.y - c * z - d;
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (k, p) in polygon.iter().enumerate() {
            let next = polygon[(k + 1) % polygon.len()];
            let (here, there) = (over(p), over(&next));
            if here >= 0.0 {
                kept.push(*p);
            }
            if (here >= 0.0) != (there >= 0.0) {
                kept.push(*p + (next - *p) * (here / (here - there)));
            }
        }
        polygon = kept;
        if polygon.is_empty() {
            break;
        }
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::math;

    fn bounds(side: f64, [bottom, top]: [f64; 2]) -> [Bound; 4] {
        let bound = |across: f64, up: f64, most: f64| Bound { across, up, most };
        [bound(1.0, 0.0, side), bound(-1.0, 0.0, side), bound(0.0, 1.0, top), bound(0.0, -1.0, -bottom)]
    }

    #[test]
    fn the_eye_is_as_near_as_the_bounds_let_it() {
        let half = DVec2::new(0.8, 0.45);
        let points: Vec<_> = (0..40)
            .map(|k| {
                let k = f64::from(k);
                DVec3::new(4e4 + 3.0 * math::sin(1.7 * k), 1.5 * math::cos(2.3 * k), 0.8 * math::sin(0.9 * k))
            })
            .collect();
        let corner = Bound { across: 0.6, up: 0.8, most: 0.35 };
        for all in [bounds(0.7, [-0.5, 0.3]).to_vec(), [&bounds(0.9, [-0.4, 0.6])[..], &[corner]].concat()] {
            let eye = eye(&points, half, &all, 0.5, 0.5);
            let seen: Vec<_> = points
                .iter()
                .map(|p| {
                    let p = *p - eye;
                    DVec2::new(p.x, p.y) / p.z / half
                })
                .collect();
            let slack = |bound: &Bound| {
                let reach = |p: &DVec2| bound.most - bound.across * p.x - bound.up * p.y;
                seen.iter().map(reach).fold(f64::INFINITY, f64::min)
            };
            let least = all.iter().map(slack).fold(f64::INFINITY, f64::min);
            assert!(least.abs() < 1e-6, "{least}");
            // Two opposite bounds, or three, hold it.
            assert!(all.iter().filter(|bound| slack(bound) < 1e-6).count() >= 2);
        }
        // One that is near enough comes no nearer.
        let one = [DVec3::new(0.0, 0.0, 0.0)];
        assert!((eye(&one, half, &bounds(0.7, [-0.5, 0.3]), 2.6, 0.5).z + 2.6).abs() < 1e-9);
    }

    #[test]
    fn the_disc_lies_beside_the_words() {
        let panel = [930.0, 520.0, 340.0, 190.0];
        let title = [20.0, 20.0, 500.0, 50.0];
        for size in [[1280.0, 720.0], [720.0, 1280.0], [640.0, 720.0]] {
            let (plain, free) = FreeSpace::new(size, vec![], 1.0).disc();
            assert!(plain[0].abs() < 1e-9 && plain[1].abs() < 1e-9);
            assert!((free * 0.5 * size[1] - (0.5 * size[0].min(size[1]) - 10.0)).abs() < 1e-6);
            let taken = vec![panel.map(|v| v * size[0] / 1280.0), title.map(|v| v * size[0] / 1280.0)];
            let (middle, radius) = FreeSpace::new(size, taken.clone(), 1.0).disc();
            assert!(radius <= free && radius > 0.6 * free, "{radius} of {free}");
            let [x, y] = [0.5 * size[0] * (1.0 + middle[0]), 0.5 * size[1] * (1.0 - middle[1])];
            for [left, top, width, height] in taken {
                let nearest = DVec2::new(x.clamp(left, left + width), y.clamp(top, top + height));
                assert!(nearest.distance(DVec2::new(x, y)) > radius * 0.5 * size[1] - 1e-6);
            }
        }
    }

    #[test]
    fn words_at_the_top_and_at_the_bottom_leave_rows() {
        let room = FreeSpace::new(
            [1280.0, 720.0],
            vec![[10.0, 10.0, 600.0, 62.0], [900.0, 504.0, 370.0, 206.0]],
            1.0,
        );
        let [bottom, top] = room.rows();
        assert!((bottom + 0.4).abs() < 1e-9 && (top - 0.8).abs() < 1e-9);
        assert_eq!(room.corners().count(), 0);
        // A large picture in a corner is passed aslant.
        let room = FreeSpace::new([1280.0, 720.0], vec![[872.0, 24.0, 384.0, 288.0]], 1.0);
        assert_eq!(room.rows(), [-1.0, 1.0]);
        let [corner] = room.corners().collect::<Vec<_>>()[..] else { panic!("no corner") };
        assert!(corner.across > 0.0 && corner.up > 0.0 && corner.most > 0.0);
        let at = [(872.0 - 640.0) / 640.0, (360.0 - 312.0) / 360.0];
        assert!((corner.across * at[0] + corner.up * at[1] - corner.most).abs() < 1e-9);
    }
}
