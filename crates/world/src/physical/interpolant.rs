//! The motion of the vehicles through the current advance, for observers that look at it continuously.

use super::bodies::{Bodies, Knot};
use super::car::Car;
use vocabulary::{Motion, Pose, nearest_turn, wrap};

/// Knots of all vehicles, step by step.
#[derive(Debug, Clone)]
pub(super) struct MotionHistory {
    cars: usize,
    knots: Vec<Knot>,
    step: f64,
}

impl MotionHistory {
    pub(super) fn new(cars: &[Car], bodies: &Bodies) -> Self {
        let knots = cars.iter().map(|car| bodies.knot(car.body)).collect();
        Self { cars: cars.len(), knots, step: 1.0 }
    }

    /// Begins anew at the last knots, with steps of `h` s.
    pub(super) fn begin(&mut self, h: f64) {
        self.knots.drain(..self.knots.len() - self.cars);
        self.step = h;
    }

    /// Notes where all vehicles are after a step of `h` s.
    pub(super) fn note(&mut self, cars: &[Car], bodies: &Bodies, h: f64) {
        for car in cars {
            let before = self.knots[self.knots.len() - self.cars];
            let mut knot = bodies.knot(car.body);
            knot.motion.acceleration = (knot.motion.speed - before.motion.speed) / h;
            self.knots.push(knot);
        }
    }

    /// The motion of the vehicle in `slot` now.
    pub(super) fn last(&self, slot: usize) -> Motion {
        self.knots[self.knots.len() - self.cars + slot].motion
    }

    /// The motion `elapsed` s after the advance began: cubic Hermite curves between the knots.
    pub(super) fn during(&self, slot: usize, elapsed: f64) -> Motion {
        let steps = self.knots.len() / self.cars - 1;
        if steps == 0 {
            return self.last(slot);
        }
        let along = (elapsed / self.step).clamp(0.0, steps as f64);
        let k = (along.floor() as usize).min(steps - 1);
        let u = along - k as f64;
        let [from, to] = [k, k + 1].map(|k| &self.knots[k * self.cars + slot]);
        let (a, b) = (&from.motion, &to.motion);
        let curve = |p: f64, dp: f64, q: f64, dq: f64| {
            let (v, h) = (1.0 - u, self.step);
            v * v * (1.0 + 2.0 * u) * p + u * u * (3.0 - 2.0 * u) * q + u * v * h * (v * dp - u * dq)
        };
        let mix = |p: f64, q: f64| p + (q - p) * u;
        let turned = nearest_turn(b.pose.heading, a.pose.heading);
        Motion {
            pose: Pose {
                x: curve(a.pose.x, from.velocity[0], b.pose.x, to.velocity[0]),
                y: curve(a.pose.y, from.velocity[1], b.pose.y, to.velocity[1]),
                heading: wrap(curve(a.pose.heading, a.turn_rate, turned, b.turn_rate)),
            },
            speed: mix(a.speed, b.speed),
            acceleration: mix(a.acceleration, b.acceleration),
            turn_rate: mix(a.turn_rate, b.turn_rate),
        }
    }
}
