//! Corners to a few hundredths of a pixel: the picture of a tag whose code is known is fitted to the pixels, all of its
//! edges at once.
//!
//! A pixel that shows the point (u, v) of the tag is as bright as the tag blurred there: A + (B + Cu + Dv)·Σ cᵢⱼ Wᵢ(u) Wⱼ(v),
//! with cᵢⱼ the cells and W a cell's share in a bell curve. Unknown are the eight numbers of the mapping from tag to picture,
//! the four of the light, since no face is lit evenly, and how wide the blur is: told wrong, either would make tags larger or
//! smaller. Along straight edges this is what the lens does; at corners of cells seen aslant it is off
//! by less than noise. With noise of one strength in all pixels the fit is the most likely one (Gauss-Newton).

mod bell;

use super::Tag;
use crate::imaging::Optics;
use crate::pose::homography;
use bell::EdgeProfile;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use vocabulary::{CameraModel, Grey, Region, TAG_CELLS, math, tag_cell};

/// Corners of the black square, in cells from the middle of the tag, x right and y down.
const SQUARE: [[f64; 2]; 4] = [[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]];

/// Variance of a pixel's own square, pixels².
const PIXEL: f64 = 1.0 / 12.0;

/// Of a large tag no more pixels than about this are looked at.
const PIXELS: f64 = 1200.0;

const ROUNDS: usize = 8;

/// Standard deviation of corners that could not be sharpened, pixels.
const GUESS: f64 = 1.5;

/// Half a tag's side, cells.
const HALF: f64 = 0.5 * TAG_CELLS as f64;

/// Corners that move by less, pixels, have settled.
const SETTLED: f64 = 2e-3;

/// Corners that move further than this from where the detector saw them, pixels, have gone astray.
const ASTRAY: f64 = 2.5;

/// Pixels off by more than this many standard deviations count less.
const FAR: f64 = 3.0;

/// Numbers of the mapping, of the light and of the blur.
const UNKNOWN: usize = 13;

/// Number of the blur among them.
const BLUR: usize = UNKNOWN - 1;

/// The blur is within about this factor of what it is said to be, its natural logarithm.
const BLUR_KNOWN: f64 = 0.4;

type Cells = [[f64; TAG_CELLS]; TAG_CELLS];
type Normal = SMatrix<f64, UNKNOWN, UNKNOWN>;
type Row = SVector<f64, UNKNOWN>;

/// Moves corners of `tags`, which are pixels of a `picture` of `region`, to where their code fits best. Tags whose fit
/// comes to nothing stay where they are, their corners guesses.
pub fn sharpen(picture: &Grey, region: Region, optics: &Optics, tags: &mut [Tag]) {
    if picture.values.len() != picture.width as usize * picture.height as usize {
        return;
    }
    let view = TagView {
        picture,
        camera_model: &optics.camera_model,
        corner: [f64::from(region.x), f64::from(region.y)],
    };
    let blur = if optics.blur.is_finite() { optics.blur.clamp(0.0, 4.0) } else { 0.0 };
    for tag in tags {
        match fitted(&view, (blur * blur + PIXEL).sqrt(), tag) {
            Some((corners, deviation)) => (tag.corners, tag.deviation) = (corners, deviation),
            // Something stands in front of it, or it is hardly there: its corners are a guess.
            None => tag.deviation = tag.deviation.max(GUESS),
        }
    }
}

/// A picture and how its pixels lie in the ideal one.
struct TagView<'a> {
    picture: &'a Grey,
    camera_model: &'a CameraModel,
    corner: [f64; 2],
}

impl TagView<'_> {
    fn ideal(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        if !self.camera_model.distorts() {
            return [x, y];
        }
        let direction = self.camera_model.direction([x + self.corner[0], y + self.corner[1]]);
        [0, 1].map(|k| self.camera_model.centre[k] + self.camera_model.focal * direction[k] - self.corner[k])
    }

    fn seen(&self, ideal: [f64; 2]) -> Option<[f64; 2]> {
        if !self.camera_model.distorts() {
            return Some(ideal);
        }
        let [x, y] = [0, 1]
            .map(|k| (ideal[k] + self.corner[k] - self.camera_model.centre[k]) / self.camera_model.focal);
        let [u, v] = self.camera_model.project([x, y, 1.0])?;
        Some([u - self.corner[0], v - self.corner[1]])
    }
}

/// A pixel, in units of the tag's size from the tag's middle, and its light.
struct PixelSample {
    at: [f64; 2],
    light: f64,
}

/// Corners, and the deviation they should have.
fn fitted(view: &TagView<'_>, blur: f64, tag: &Tag) -> Option<([[f64; 2]; 4], f64)> {
    let cells = cells(tag.id)?;
    let start = tag.corners.map(|c| view.ideal(c));
    let middle = [0, 1].map(|k| start.iter().map(|c| c[k]).sum::<f64>() / 4.0);
    let size = start.iter().map(|c| math::hypot(c[0] - middle[0], c[1] - middle[1])).sum::<f64>() / 4.0;
    if !(size.is_finite() && size > 4.0) {
        return None;
    }
    let normal = |c: [f64; 2]| [0, 1].map(|k| (c[k] - middle[k]) / size);
    let mut h = homography(&SQUARE, &start.map(normal))?;
    let samples = samples(view, &h, &tag.corners, normal)?;
    let told = blur / size;
    let mut blur = told;
    let [black, white] = contrast(&samples, &h, &cells, blur)?;
    let mut light = [black, white, 0.0, 0.0];
    let mut spread = f64::INFINITY;
    let (mut corners, mut deviation) = (start, 0.0);
    for _ in 0..ROUNDS {
        let round = round(&samples, &h, &cells, [blur, told], light, spread)?;
        h += round.step;
        light = std::array::from_fn(|k| light[k] + round.light[k]);
        spread = round.spread;
        // A pixel is never sharper than its own square.
        blur = (blur * math::exp(round.blur.clamp(-0.3, 0.3))).max(PIXEL.sqrt() / size);
        let next = placed(&h)?.map(|c| [0, 1].map(|k| c[k] * size + middle[k]));
        let moved = |a: &[[f64; 2]; 4], b: &[[f64; 2]; 4]| {
            a.iter().zip(b).map(|(p, q)| math::hypot(p[0] - q[0], p[1] - q[1])).fold(0.0, f64::max)
        };
        if moved(&next, &start) > ASTRAY {
            return None;
        }
        deviation = size * round.deviation;
        let settled = moved(&next, &corners) < SETTLED;
        corners = next;
        if settled {
            break;
        }
    }
    // A tenth of the contrast between black and white is no noise: something else is there.
    if !(light[1] > 4.0 && spread < 0.15 * light[1] + 4.0) {
        return None;
    }
    let [a, b, c, d] = corners.map(|c| view.seen(c));
    Some(([a?, b?, c?, d?], deviation))
}

/// Cells of a tag, 1 for white, rows from the top.
fn cells(id: u16) -> Option<Cells> {
    tag_cell(id, 0, 0)?;
    let cell = |row, column| if tag_cell(id, column, row) == Some(true) { 1.0 } else { 0.0 };
    Some(std::array::from_fn(|row| std::array::from_fn(|column| cell(row, column))))
}

/// Corners of the black square under a mapping.
fn placed(h: &Matrix3<f64>) -> Option<[[f64; 2]; 4]> {
    let corners = SQUARE.map(|[u, v]| {
        let p = h * Vector3::new(u, v, 1.0);
        [p.x / p.z, p.y / p.z]
    });
    corners.iter().flatten().all(|x| x.is_finite()).then_some(corners)
}

/// Pixels that show the tag, `corners` being where it is in the picture.
fn samples(
    view: &TagView<'_>,
    h: &Matrix3<f64>,
    corners: &[[f64; 2]; 4],
    normal: impl Fn([f64; 2]) -> [f64; 2],
) -> Option<Vec<PixelSample>> {
    let back = h.try_inverse()?;
    let span = |k: usize, size: u32| {
        let at = corners.map(|c| c[k]);
        let (low, high) = at.iter().fold((f64::INFINITY, -f64::INFINITY), |(l, h), x| (l.min(*x), h.max(*x)));
        // The margin is an eighth of the black square; perspective makes it a little more.
        let more = 0.2 * (high - low);
        let clamp = |x: f64| x.clamp(0.0, f64::from(size));
        (clamp((low - more).floor()) as usize, clamp((high + more).ceil() + 1.0) as usize)
    };
    let ((left, right), (top, bottom)) = (span(0, view.picture.width), span(1, view.picture.height));
    let count = (right.saturating_sub(left) * bottom.saturating_sub(top)) as f64;
    let every = (count / PIXELS).ceil().max(1.0) as usize;
    let mut samples = Vec::with_capacity(count as usize / every + 1);
    for y in top..bottom {
        // Shifted from row to row, so that no column is left out.
        for x in (left..right).filter(|x| (x + y * 7).is_multiple_of(every)) {
            let at = normal(view.ideal([x as f64, y as f64]));
            let p = back * Vector3::new(at[0], at[1], 1.0);
            let inside = (p.x / p.z).abs().max((p.y / p.z).abs()) < 0.5 * TAG_CELLS as f64 + 0.5;
            if inside && p.z > 0.0 {
                let light = f64::from(*view.picture.values.get(y * view.picture.width as usize + x)?);
                samples.push(PixelSample { at, light });
            }
        }
    }
    (samples.len() >= 50).then_some(samples)
}

/// A point's place on the tag, how bright the tag is there and how that changes with the point's place in the picture.
struct Shade {
    tag: [f64; 2],
    value: f64,
    slope: [f64; 2],
    /// How the brightness changes with the logarithm of the blur.
    widen: f64,
}

/// `None` for points whose blur reaches beyond the tag's margin.
fn shade(back: &Matrix3<f64>, cells: &Cells, blur: f64, [x, y]: [f64; 2]) -> Option<Shade> {
    let p = back * Vector3::new(x, y, 1.0);
    let tag = [p.x / p.z, p.y / p.z];
    let change = [0, 1].map(|k| [0, 1].map(|c| (back[(k, c)] - tag[k] * back[(2, c)]) / p.z));
    let soft = change.map(|row| blur * math::hypot(row[0], row[1]));
    let limit = |soft: f64| (0.5 * TAG_CELLS as f64 - 2.0 * soft).max(4.3);
    if !(tag[0].abs() < limit(soft[0]) && tag[1].abs() < limit(soft[1])) {
        return None;
    }
    let (across, down) = (EdgeProfile::new(tag[0], soft[0]), EdgeProfile::new(tag[1], soft[1]));
    let (mut value, mut by_u, mut by_v, mut widen) = (0.0, 0.0, 0.0, 0.0);
    for (row, [weight, change, widened]) in down.shares() {
        let mut line = [0.0; 3];
        for (column, shares) in across.shares() {
            for (sum, share) in line.iter_mut().zip(shares) {
                *sum += share * cells[row][column];
            }
        }
        value += weight * line[0];
        by_u += weight * line[1];
        by_v += change * line[0];
        widen += weight * line[2] + widened * line[0];
    }
    let slope = [0, 1].map(|c| by_u * change[0][c] + by_v * change[1][c]);
    Some(Shade { tag, value, slope, widen })
}

/// Light of black and what white has more, by a straight line through pixels and tag.
fn contrast(samples: &[PixelSample], h: &Matrix3<f64>, cells: &Cells, blur: f64) -> Option<[f64; 2]> {
    let back = h.try_inverse()?;
    let mut sums = [0.0; 5];
    for sample in samples.iter().step_by(3) {
        if let Some(Shade { value, .. }) = shade(&back, cells, blur, sample.at) {
            let terms = [1.0, value, sample.light, value * value, value * sample.light];
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += term;
            }
        }
    }
    let [n, m, l, mm, ml] = sums;
    let gain = (n * ml - m * l) / (n * mm - m * m);
    (gain > 4.0 && gain.is_finite()).then(|| [(l - gain * m) / n, gain])
}

/// What a round of Gauss-Newton changes.
struct Round {
    step: Matrix3<f64>,
    light: [f64; 4],
    /// Of the blur, its logarithm.
    blur: f64,
    /// Standard deviation of what is left, grey levels.
    spread: f64,
    /// Of a corner in one direction, from how well the pixels determine it: root of the mean variance.
    deviation: f64,
}

fn round(
    samples: &[PixelSample],
    h: &Matrix3<f64>,
    cells: &Cells,
    [blur, told]: [f64; 2],
    light: [f64; 4],
    spread: f64,
) -> Option<Round> {
    let far = FAR * spread;
    let back = h.try_inverse()?;
    let mut curvature = Normal::zeros();
    let mut slope = Row::zeros();
    let (mut squares, mut count) = (0.0, 0.0);
    for sample in samples {
        let Some(Shade { tag: [u, v], value, slope: [sx, sy], widen }) = shade(&back, cells, blur, sample.at)
        else {
            continue;
        };
        let (across, down) = (u / HALF, v / HALF);
        let contrast = light[1] + light[2] * across + light[3] * down;
        let off = sample.light - light[0] - contrast * value;
        let weight = if off.abs() > far { far / off.abs() } else { 1.0 };
        // The mapping shifts what is seen here; the tag's brightness goes with it.
        let depth = h[(2, 0)] * u + h[(2, 1)] * v + h[(2, 2)];
        let (gx, gy) = (-contrast * sx / depth, -contrast * sy / depth);
        let along = -(gx * sample.at[0] + gy * sample.at[1]);
        let row = Row::from([
            gx * u,
            gx * v,
            gx,
            gy * u,
            gy * v,
            gy,
            along * u,
            along * v,
            1.0,
            value,
            value * across,
            value * down,
            contrast * widen,
        ]);
        curvature.ger(weight, &row, &row, 1.0);
        slope.axpy(weight * off, &row, 1.0);
        squares += weight * off * off;
        count += 1.0;
    }
    if count < 30.0 {
        return None;
    }
    let known = math::powi(spread.min(20.0) / BLUR_KNOWN, 2);
    curvature[(BLUR, BLUR)] += known;
    slope[BLUR] += known * math::ln(told / blur);
    let factors = curvature.cholesky()?;
    let d = factors.solve(&slope);
    let spread = (squares / (count - UNKNOWN as f64)).sqrt().max(0.5);
    let step = Matrix3::new(d[0], d[1], d[2], d[3], d[4], d[5], d[6], d[7], 0.0);
    let finite = d.iter().all(|x| x.is_finite());
    finite.then(|| Round {
        step,
        light: [d[8], d[9], d[10], d[11]],
        blur: d[BLUR],
        spread,
        deviation: spread * corner_variance(h, &factors.inverse()).max(0.0).sqrt(),
    })
}

/// Mean variance of the corners' coordinates for a covariance of the mapping's numbers.
fn corner_variance(h: &Matrix3<f64>, covariance: &Normal) -> f64 {
    let one = |[u, v]: [f64; 2]| {
        let p = h * Vector3::new(u, v, 1.0);
        let (x, y) = (p.x / p.z, p.y / p.z);
        let row = |a: [f64; 8]| Row::from_fn(|k, _| a.get(k).copied().unwrap_or_default()) / p.z;
        let across = row([u, v, 1.0, 0.0, 0.0, 0.0, -x * u, -x * v]);
        let down = row([0.0, 0.0, 0.0, u, v, 1.0, -y * u, -y * v]);
        across.dot(&(covariance * across)) + down.dot(&(covariance * down))
    };
    SQUARE.into_iter().map(one).sum::<f64>() / 8.0
}
