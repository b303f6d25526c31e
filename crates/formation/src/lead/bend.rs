//! Where a curve bends most: what decides whether a robot can follow it.

use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv};
use vocabulary::math;

/// The sharpest bend between two points of a way, when it is passed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bend {
    /// The nearer of the two points, counted from 1.
    pub point: usize,
    /// Where that point is, m.
    pub place: [f64; 2],
    /// 1/m, left and right alike; infinite where the curve turns back on the spot.
    pub curvature: f64,
    /// When it is passed, s.
    pub time: f64,
    /// How fast, m/s.
    pub speed: f64,
}

/// Parts of a piece that are looked at before the sharpest place is searched.
const PARTS: u32 = 32;
/// A point at which a piece stands still but for this share of its length is one at which it turns on the spot.
const STILL: f64 = 1e-4;

/// A radius below this share of a piece's length is that of a turn on the spot.
const ON_THE_SPOT: f64 = 1e-6;

/// Parameter and |curvature|, 1/m, of the sharpest place of a piece.
pub(super) fn sharpest(piece: &CubicBez) -> (f64, f64) {
    let at = |k: u32| f64::from(k) / f64::from(PARTS);
    let bent = |u: f64| bend(piece, u);
    let larger = |a: (f64, f64), b: (f64, f64)| if b.1 > a.1 { b } else { a };
    let top = (0..=PARTS).map(|k| (at(k), bent(at(k)))).fold((0.0, -1.0), larger);
    let (mut low, mut high) = ((top.0 - at(1)).max(0.0), (top.0 + at(1)).min(1.0));
    for _ in 0..40 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if bent(a) < bent(b) { low = a } else { high = b }
    }
    let middle = f64::midpoint(low, high);
    slowest(piece).map(|u| (u, bent(u))).chain([(middle, bent(middle))]).fold(top, larger)
}

/// Parameters inside a piece at which it goes slower than just before and after: a needle's eye of a bend hides there.
fn slowest(piece: &CubicBez) -> impl Iterator<Item = f64> + '_ {
    let gains = |u: f64| {
        let first = piece.deriv();
        first.eval(u).to_vec2().dot(first.deriv().eval(u).to_vec2())
    };
    let at = |k: u32| f64::from(k) / f64::from(PARTS);
    (0..PARTS).filter(move |k| gains(at(*k)) < 0.0 && gains(at(k + 1)) >= 0.0).map(move |k| {
        let (mut low, mut high) = (at(k), at(k + 1));
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            if gains(middle) < 0.0 { low = middle } else { high = middle }
        }
        high
    })
}

/// |curvature| at a parameter, 1/m.
fn bend(piece: &CubicBez, u: f64) -> f64 {
    let first = piece.deriv();
    let (d1, d2) = (first.eval(u).to_vec2(), first.deriv().eval(u).to_vec2());
    let still = d1.hypot() <= STILL * (piece.p3 - piece.p0).hypot();
    // Where it is slowest, what changes its direction is all that there is.
    let bent = if still { d2.hypot() / d1.hypot2() } else { d1.cross(d2).abs() / math::powi(d1.hypot(), 3) };
    let sharp = bent * ON_THE_SPOT * (piece.p3 - piece.p0).hypot() > 1.0;
    if sharp || bent.is_nan() { f64::INFINITY } else { bent }
}
