//! Annotations as decals on the ground.

use crate::gpu::passes::decal::{DecalForm, DecalVertex};
use crate::ground::decal_builder::DecalBuilder;
use crate::palette::{self, Rgb};
use crate::{AnnotationArrow, AnnotationStroke, Annotations, Ring, ShadedArea, StrokePoint};
use glam::DVec2;
use vocabulary::math;

/// A dash and its gap, pixels at scale 1, and the share of the dash.
const DASH: (f64, f32) = (13.0, 0.6);
/// From stripe to stripe, pixels at scale 1, and the share of a stripe.
const STRIPE: (f64, f32) = (15.0, 0.28);
/// By how much a rim is wider than its line, pixels at scale 1, and its share of the opacity.
const RIM: (f64, f32) = (2.2, 0.4);
/// How far a glow reaches, pixels at scale 1.
const GLOW: f64 = 16.0;

impl DecalBuilder<'_> {
    /// All annotations that lie on the ground, where robots are up to `size` times as large as the default one.
    pub(crate) fn annotations(&mut self, annotations: &Annotations, size: f64) {
        for area in &annotations.areas {
            self.area(area);
        }
        for arrow in &annotations.arrows {
            self.pointer(arrow, size);
        }
        for stroke in &annotations.strokes {
            for run in stroke.spots.split(|spot| !sound(spot)) {
                // A dark rim first, without which a bright line is lost on bright ground.
                self.stroke(run, stroke, Some(RIM));
                self.stroke(run, stroke, None);
            }
        }
        for ring in annotations.rings.iter().filter(|r| r.at.iter().all(|x| x.is_finite())) {
            self.handle(ring);
        }
    }

    /// A corner of a spot.
    fn decal(&self, place: DVec2, form: DecalForm, shape: [f32; 2], spot: &StrokePoint) -> DecalVertex {
        self.corner(place, form, shape, spot.colour, spot.alpha.clamp(0.0, 1.0))
    }

    fn stroke(&mut self, run: &[StrokePoint], stroke: &AnnotationStroke, rim: Option<(f64, f32)>) {
        let mut spots = self.thinned(run);
        if let Some((_, alpha)) = rim {
            for spot in &mut spots {
                *spot = StrokePoint { colour: palette::INK, alpha: spot.alpha * alpha, ..*spot };
            }
        }
        let stroke =
            AnnotationStroke { spots: vec![], pixels: stroke.pixels + rim.map_or(0.0, |r| r.0), ..*stroke };
        let Some(middle) = spots.get(spots.len() / 2).filter(|_| spots.len() > 1) else { return };
        let dash = even(DASH.0 * self.stage_scale * self.pixel(place(middle)));
        let form = if stroke.dashed { DecalForm::Dashes(DASH.1) } else { DecalForm::Solid };
        let mut along = 0.0;
        let mut before: Option<[DecalVertex; 2]> = None;
        for k in 0..spots.len() {
            let at = place(&spots[k]);
            let ends = [spots[k.saturating_sub(1)], spots[(k + 1).min(spots.len() - 1)]].map(|s| place(&s));
            let side = (ends[1] - ends[0]).normalize_or(DVec2::X).perp();
            along += at.distance(ends[0]) / dash;
            let half = self.half_width(at, side, &stroke);
            let edge = |u: f64| self.decal(at + side * (half * u), form, [u as f32, along as f32], &spots[k]);
            let now = [edge(-1.0), edge(1.0)];
            if let Some([a, b]) = before {
                self.corners.extend([a, b, now[1], a, now[1], now[0]]);
            }
            before = Some(now);
        }
    }

    /// Half the width of a line on the ground, m, with half a pixel more for its smooth edge.
    fn half_width(&self, at: DVec2, side: DVec2, stroke: &AnnotationStroke) -> f64 {
        let across = self.pixel_across(at, side);
        (0.5 * stroke.metres).max(0.5 * stroke.pixels * self.stage_scale * across) + 0.5 * across
    }

    /// Spots that are more than a pixel apart: less gives a line no direction. The last one stays.
    fn thinned(&self, run: &[StrokePoint]) -> Vec<StrokePoint> {
        let mut kept: Vec<StrokePoint> = Vec::with_capacity(run.len());
        for (k, spot) in run.iter().enumerate() {
            let near = |last: &StrokePoint| {
                let at = place(spot);
                place(last).distance(at) < self.pixel(at).max(1e-3)
            };
            if kept.last().is_none_or(|last| !near(last)) {
                kept.push(*spot);
            } else if k + 1 == run.len() && kept.len() > 1 {
                kept.pop();
                kept.push(*spot);
            }
        }
        kept
    }

    fn handle(&mut self, ring: &Ring) {
        let at = DVec2::from_array(ring.at);
        let pixel = self.pixel(at);
        let scaled = self.stage_scale * pixel;
        let reach = ring.radius.max(ring.least * scaled);
        let mut disc = |reach: f64, form: DecalForm, colour: Rgb, alpha: f32| {
            if alpha > 0.0 && reach.is_finite() {
                self.disc(at, reach, form, colour, alpha.min(1.0));
            }
        };
        let hole = |reach: f64, wide: f64| (1.0 - wide / reach).clamp(0.0, 1.0) as f32;
        // A line and the pixel over which its edge is smooth.
        let wide = ring.pixels * scaled + pixel;
        let glow = reach + GLOW * scaled;
        let bright = mix(ring.colour, palette::PAPER, 0.55 * ring.glow.clamp(0.0, 1.0));
        disc(glow, DecalForm::Glow(((reach - 0.5 * wide) / glow) as f32), ring.colour, ring.glow);
        disc(reach, DecalForm::Ring(0.0), ring.colour, ring.fill);
        // A dark rim here too.
        let rim = reach + 0.5 * RIM.0 * scaled;
        disc(rim, DecalForm::Ring(hole(rim, wide + RIM.0 * scaled)), palette::INK, RIM.1 * ring.alpha);
        disc(reach, DecalForm::Ring(hole(reach, wide)), bright, ring.alpha);
        disc(5.4 * scaled, DecalForm::Ring(0.0), palette::INK, RIM.1 * ring.dot);
        disc(4.2 * scaled, DecalForm::Ring(0.0), bright, ring.dot);
    }

    fn area(&mut self, area: &ShadedArea) {
        let middle = area.corners.len() / 2;
        let Some(first) = area.corners.iter().skip(middle).find(|spot| sound(spot)) else { return };
        let unit = even(STRIPE.0 * self.stage_scale * self.pixel(place(first))) * std::f64::consts::SQRT_2;
        let form = if area.hatched { DecalForm::Stripes(STRIPE.1) } else { DecalForm::Solid };
        // Whole stripes from a place near the robots, so that they stay where they are.
        let start = ((self.origin.x - self.origin.y) / unit).floor();
        let stripe = |at: DVec2| ((at.x - at.y) / unit - start) as f32;
        for triangle in area.corners.chunks_exact(3).filter(|t| t.iter().all(sound)) {
            let corner = |spot: &StrokePoint| {
                let at = place(spot);
                let shape = if area.hatched { [stripe(at), 0.0] } else { [0.0; 2] };
                self.decal(at, form, shape, spot)
            };
            let added = [0, 1, 2].map(|k| corner(&triangle[k]));
            self.corners.extend(added);
        }
    }

    fn pointer(&mut self, arrow: &AnnotationArrow, size: f64) {
        let (from, to) = (DVec2::from_array(arrow.from), DVec2::from_array(arrow.to));
        let length = from.distance(to) - arrow.gaps[0] - arrow.gaps[1];
        if !(length > 0.02 * size && length.is_finite()) {
            return;
        }
        let ahead = (to - from).normalize();
        let ends = [from + ahead * arrow.gaps[0], to - ahead * arrow.gaps[1]];
        let rim = 1.2 * self.stage_scale * self.pixel(ends[1]);
        let alpha = arrow.alpha.clamp(0.0, 1.0);
        self.arrow(ends, size, rim, palette::INK, 0.6 * alpha);
        self.arrow(ends, size, 0.0, arrow.colour, alpha);
    }
}

fn mix(from: Rgb, to: Rgb, share: f32) -> Rgb {
    std::array::from_fn(|k| from[k] + (to[k] - from[k]) * share)
}

fn place(spot: &StrokePoint) -> DVec2 {
    DVec2::from_array(spot.at)
}

fn sound(spot: &StrokePoint) -> bool {
    spot.at.iter().all(|x| x.is_finite()) && spot.colour.iter().chain([&spot.alpha]).all(|x| x.is_finite())
}

/// The power of two nearest to a length, m: patterns keep their place while a camera moves, unless it goes far.
fn even(length: f64) -> f64 {
    math::exp2(math::log2(length.max(1e-3)).round())
}
