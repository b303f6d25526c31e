//! Smoothing: a leg with less and slower steering, that ends where it ended and touches as little.
//!
//! The curvatures κ_k at knots and the length L are moved so that
//!
//! ```text
//! J = L + a ∫ κ'² ds + b ∫ κ² ds + Σ penalties
//! ```
//!
//! falls. Penalties are squares of what is missing to a band inside each limit: of curvature, of sharpness, of clearance of
//! every robot. A step is that of Gauss and Newton with the end held: with H ≈ ∂²J, g = ∂J and A = ∂(end),
//!
//! ```text
//! H x + g = Aᵀ ν     A x = what the end is off
//! ```
//!
//! damped after Levenberg and Marquardt. What is taken has to end at the same pose, to be within all limits, to be swept clear,
//! and to have a lower J: every way on the way is one that can be driven, and the way that came from the search, whose
//! curvature is continuous and within its limits too, stays where no step is taken.

use crate::dense::{Symmetric, dot};
use crate::leg::{CurvatureKnot, Leg};
use crate::map::Map;
use crate::mission::PlanRequest;
use crate::sensitivity::Sensitivity;
use crate::trailing::{Convoy, Sweep};
use vocabulary::{Pose, wrap};

/// Weight a of steering, m³, and b of curvature, m.
const STEERING: f64 = 10.0;
const CURVATURE: f64 = 10.0;
/// Penalty per m on a limit, where the band inside it begins as a share of it, and that of clearance, m.
const ON_LIMIT: f64 = 40.0;
const INSIDE: f64 = 0.85;
const CLEARANCE_BAND: f64 = 0.12;
const ON_OBSTACLE: f64 = 10.0;
/// Knots and pieces are at most this long, m.
const KNOTS: f64 = 1.0;
const PIECES: f64 = 0.25;
/// Steps that are taken at most, and tries without success.
const STEPS: usize = 8;
const TRIES: usize = 3;
/// A step that lowers J by less than this share is the last.
const ENOUGH: f64 = 5e-3;
/// Damping: at first, after success, after a try without.
const DAMPING: f64 = 50.0;
const EASES: f64 = 0.25;
const STIFFENS: f64 = 10.0;
/// The end is held to this, m and rad.
const HELD: f64 = 1e-8;
/// Steps after which the end is farther off, m, are not mended.
const FARTHEST_OFF: f64 = 5.0;
/// Limits are held to this share.
const ROUNDING: f64 = 1e-9;

/// A smoother leg from where a convoy is, if one was found.
pub(crate) fn smoothed(
    request: &PlanRequest<'_>,
    sweep: &mut Sweep<'_>,
    convoy: &Convoy,
    leg: &Leg,
) -> Option<Leg> {
    if leg.knots.len() < 2 {
        return None;
    }
    let mut smoother = Smoother::new(request, sweep, convoy, leg);
    let mut damping = DAMPING;
    let mut tries = 0;
    let mut taken = 0;
    while taken < STEPS && tries < TRIES {
        let Some(model) = smoother.local_model(damping) else { break };
        let before = smoother.merit;
        if let Some((leg, merit)) = smoother.step(&model) {
            (smoother.leg, smoother.merit) = (leg, merit);
            (damping, tries, taken) = (damping * EASES, 0, taken + 1);
            if before - merit < ENOUGH * before {
                break;
            }
        } else {
            (damping, tries) = (damping * STIFFENS, tries + 1);
        }
    }
    (taken > 0).then_some(smoother.leg)
}

struct Smoother<'a, 'b> {
    map: &'a Map,
    sweep: &'a mut Sweep<'b>,
    convoy: &'a Convoy,
    leg: Leg,
    end: Pose,
    /// At every knot, 1/m.
    largest: Vec<f64>,
    /// 1/m².
    sharpness: f64,
    merit: f64,
}

/// J near a leg, and how its end moves.
struct LocalModel {
    /// By which all columns change.
    step: Vec<f64>,
    /// H⁻¹ of how x, y and heading of the end change.
    solved: [Vec<f64>; 3],
    inverse: [[f64; 3]; 3],
}

impl<'a, 'b> Smoother<'a, 'b> {
    fn new(request: &'a PlanRequest<'_>, sweep: &'a mut Sweep<'b>, convoy: &'a Convoy, leg: &Leg) -> Self {
        let leg = leg.refined(KNOTS);
        let of_level = sweep.trailing().largest();
        let largest = leg.knots.iter().map(|knot| {
            let [below, above] =
                [knot.level.floor(), knot.level.ceil()].map(|level| of_level[level.max(0.0) as usize]);
            // A start may be beyond, and stays.
            below.min(above)
        });
        let largest = largest.collect();
        let end = leg.end();
        let sharpness = request.limits.sharpness;
        let mut smoother = Self { map: request.map, sweep, convoy, leg, end, largest, sharpness, merit: 0.0 };
        smoother.merit = smoother.merit_of(&smoother.leg.clone());
        smoother
    }

    /// Columns: the length, and the curvatures of all knots.
    fn columns(&self) -> usize {
        self.leg.knots.len() + 1
    }

    /// J of a leg.
    fn merit_of(&self, leg: &Leg) -> f64 {
        let mut merit = leg.length();
        for (k, pair) in leg.knots.windows(2).enumerate() {
            let [a, b] = [pair[0], pair[1]];
            let span = b.way - a.way;
            let change = b.curvature - a.curvature;
            merit += STEERING * change * change / span;
            merit += CURVATURE
                * span
                * (a.curvature * a.curvature + a.curvature * b.curvature + b.curvature * b.curvature)
                / 3.0;
            merit += span * penalty(change.abs() / span, self.sharpness);
            merit += span * penalty(b.curvature.abs(), self.largest[k + 1]);
        }
        let mut convoy = self.convoy.clone();
        for piece in leg.pieces(PIECES) {
            for robot in 0..self.sweep.trailing().robots() {
                self.sweep.trailing().step(&mut convoy, robot, &piece);
                let missing = (CLEARANCE_BAND - self.sweep.room_of(&convoy, robot)).max(0.0) / CLEARANCE_BAND;
                merit += ON_OBSTACLE * piece.length * missing * missing;
            }
        }
        merit
    }

    /// H, g and A at the present leg, solved.
    fn local_model(&self, damping: f64) -> Option<LocalModel> {
        let n = self.columns();
        let mut h = Symmetric::zero(n);
        let mut g = vec![0.0; n];
        self.add_course(&mut h, &mut g);
        let ends = self.add_clearance(&mut h, &mut g);
        h.add_diagonal(damping);
        // The first and the last curvature stay.
        for fixed in [1, n - 1] {
            h.add(fixed, fixed, 1e12);
        }
        let factor = h.factor()?;
        let solved = [0, 1, 2].map(|i| factor.solve(&ends[i]));
        let mut moves = [[0.0; 3]; 3];
        for i in 0..3 {
            for k in 0..3 {
                moves[i][k] = dot(&ends[i], &solved[k]);
            }
        }
        let inverse = inverted(moves)?;
        let free = factor.solve(&g);
        let off = [0, 1, 2].map(|i| dot(&ends[i], &free));
        let multipliers = inverse.map(|row| dot(&row, &off));
        let step = (0..n).map(|k| -free[k] + (0..3).map(|i| solved[i][k] * multipliers[i]).sum::<f64>());
        Some(LocalModel { step: step.collect(), solved, inverse })
    }

    /// Length, steering, curvature and their limits.
    fn add_course(&self, h: &mut Symmetric, g: &mut [f64]) {
        g[0] += self.leg.length();
        for (k, pair) in self.leg.knots.windows(2).enumerate() {
            let [a, b] = [pair[0], pair[1]];
            let (span, i, j) = (b.way - a.way, k + 1, k + 2);
            let change = b.curvature - a.curvature;
            let (bound, sharp) = (INSIDE * self.sharpness, change.abs() / span);
            let over = if sharp > bound { ON_LIMIT / square((1.0 - INSIDE) * self.sharpness) } else { 0.0 };
            let stiff = 2.0 * (STEERING + over) / span;
            let pull = 2.0 * (STEERING * change / span + over * (sharp - bound).max(0.0).copysign(change));
            g[i] -= pull;
            g[j] += pull;
            h.add(i, i, stiff);
            h.add(j, j, stiff);
            h.add(i, j, -stiff);
            // Longer pieces steer more slowly and curve for longer.
            g[0] -= STEERING * change * change / span;
            let third = CURVATURE * span / 3.0;
            g[i] += third * (2.0 * a.curvature + b.curvature);
            g[j] += third * (2.0 * b.curvature + a.curvature);
            h.add(i, i, 2.0 * third);
            h.add(j, j, 2.0 * third);
            h.add(i, j, third);
            g[0] +=
                third * (a.curvature * a.curvature + a.curvature * b.curvature + b.curvature * b.curvature);
            let (size, most) = (b.curvature.abs(), self.largest[k + 1]);
            if most > 0.0 && size > INSIDE * most {
                let weight = 2.0 * span * ON_LIMIT / square((1.0 - INSIDE) * most);
                g[j] += weight * (size - INSIDE * most).copysign(b.curvature);
                h.add(j, j, weight);
            }
        }
        h.add(0, 0, 2.0 * self.leg.length());
    }

    /// Clearances of all robots; returns how the end moves.
    fn add_clearance(&self, h: &mut Symmetric, g: &mut [f64]) -> [Vec<f64>; 3] {
        let trailing = self.sweep.trailing();
        let mut convoy = self.convoy.clone();
        let mut sensitivity = Sensitivity::new(trailing, &self.leg);
        let mut row = vec![0.0; self.columns()];
        for piece in self.leg.pieces(PIECES) {
            sensitivity.piece(&mut convoy, &piece);
            for robot in 0..trailing.robots() {
                let room = self.sweep.room_of(&convoy, robot);
                if room >= CLEARANCE_BAND {
                    continue;
                }
                let (nearest, _) = self.map.nearest(convoy.positions[robot]);
                let ([x, y], active) = (sensitivity.position(robot), sensitivity.active());
                for k in 0..active {
                    row[k] = nearest.direction[0] * x[k] + nearest.direction[1] * y[k];
                }
                let weight = 2.0 * ON_OBSTACLE * piece.length / (CLEARANCE_BAND * CLEARANCE_BAND);
                let missing = CLEARANCE_BAND - room;
                for k in 0..active {
                    g[k] -= weight * missing * row[k];
                }
                h.add_square(&row, active, weight);
            }
        }
        let [x, y] = sensitivity.position(0);
        [x.to_vec(), y.to_vec(), sensitivity.heading().to_vec()]
    }

    /// The leg after a step, or after a part of it, with its J, if it holds and is better.
    fn step(&mut self, model: &LocalModel) -> Option<(Leg, f64)> {
        [1.0, 0.4].into_iter().find_map(|share| {
            let by: Vec<f64> = model.step.iter().map(|value| share * value).collect();
            let leg = self.closed(model, &by)?;
            let merit = self.merit_of(&leg);
            (merit < self.merit && self.holds(&leg)).then_some((leg, merit))
        })
    }

    fn moved(&self, by: &[f64]) -> Leg {
        let scale = 1.0 + by[0].clamp(-0.2, 0.2);
        let knots = self.leg.knots.iter().zip(&by[1..]).map(|(knot, change)| CurvatureKnot {
            way: knot.way * scale,
            curvature: knot.curvature + change,
            ..*knot
        });
        let mut knots: Vec<_> = knots.collect();
        // They are fixed to the last bit.
        let last = knots.len() - 1;
        for k in [0, last] {
            knots[k].curvature = self.leg.knots[k].curvature;
        }
        Leg { knots, ..self.leg.clone() }
    }

    /// The leg after a step, led back to the end.
    fn closed(&self, model: &LocalModel, by: &[f64]) -> Option<Leg> {
        let mut by = by.to_vec();
        for _ in 0..8 {
            let leg = self.moved(&by);
            let end = leg.end();
            let off = [self.end.x - end.x, self.end.y - end.y, wrap(self.end.heading - end.heading)];
            let size = off.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
            if size < HELD {
                return Some(leg);
            }
            if size.is_nan() || size > FARTHEST_OFF {
                return None;
            }
            let multipliers = model.inverse.map(|row| dot(&row, &off));
            for (k, value) in by.iter_mut().enumerate() {
                *value += (0..3).map(|i| model.solved[i][k] * multipliers[i]).sum::<f64>();
            }
        }
        None
    }

    /// Whether a leg is within all limits and swept clear.
    fn holds(&mut self, leg: &Leg) -> bool {
        let last = leg.knots.len() - 1;
        let bent = (1..last).all(|k| leg.knots[k].curvature.abs() <= self.largest[k] * (1.0 + ROUNDING));
        let sharp = leg.knots.windows(2).all(|pair| {
            (pair[1].curvature - pair[0].curvature).abs()
                <= self.sharpness * (pair[1].way - pair[0].way) * (1.0 + ROUNDING)
        });
        if !bent || !sharp {
            return false;
        }
        let mut convoy = self.convoy.clone();
        self.sweep.begin(&convoy).is_ok() && self.sweep.leg(&mut convoy, leg).is_ok()
    }
}

/// The square of what a value is beyond the band of a limit, 0 within.
fn penalty(value: f64, limit: f64) -> f64 {
    if limit <= 0.0 {
        return 0.0;
    }
    let over = ((value / limit - INSIDE) / (1.0 - INSIDE)).max(0.0);
    ON_LIMIT * over * over
}

fn square(value: f64) -> f64 {
    value * value
}

fn inverted(m: [[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let cofactor = |r: usize, c: usize| {
        let [r1, r2, c1, c2] = [(r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3];
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let det: f64 = (0..3).map(|k| m[0][k] * cofactor(0, k)).sum();
    let inverse = [0, 1, 2].map(|r| [0, 1, 2].map(|c| cofactor(c, r) / det));
    inverse.iter().flatten().all(|value| value.is_finite()).then_some(inverse)
}
