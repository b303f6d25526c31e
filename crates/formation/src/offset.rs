//! A place beside a set point that moves smoothly: a second-order filter with bounded speed and acceleration.

use crate::set_point::displaced;
use vocabulary::{SetPoint, math};

/// How far a follower's place is from its set point, [forward, left] in m along the heading its bearing is held against,
/// with the first and second derivative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Offset {
    /// m.
    pub value: [f64; 2],
    /// m/s.
    pub rate: [f64; 2],
    /// m/s².
    pub acceleration: [f64; 2],
}

/// How an offset may move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OffsetBounds {
    /// m/s.
    pub rate: f64,
    /// m/s².
    pub acceleration: f64,
    /// Time constant with which the acceleration sets in, s; 0 where it may jump.
    pub onset: f64,
}

/// Both roots of the filter, 1/s.
const ROOT: f64 = 2.0;

impl Offset {
    /// An offset at rest.
    pub(crate) fn at(value: [f64; 2]) -> Self {
        Self { value, ..Self::default() }
    }

    /// Carries it on over a period: towards `goal`, or to rest where there is none.
    pub(crate) fn carry(&mut self, goal: Option<[f64; 2]>, bounds: OffsetBounds, period: f64) {
        // The speed that leads to the goal is bounded, so that the acceleration does not jump where the bound is reached.
        let leads = goal.map_or([0.0; 2], |goal| [0, 1].map(|i| 0.5 * ROOT * (goal[i] - self.value[i])));
        let leads = bounded(leads, bounds.rate);
        let wanted = [0, 1].map(|i| 2.0 * ROOT * leads[i] - 2.0 * ROOT * self.rate[i]);
        let wanted = bounded(wanted, bounds.acceleration);
        let share = if bounds.onset > 0.0 { 1.0 - math::exp(-period / bounds.onset) } else { 1.0 };
        let wanted = if share < 1.0 {
            [0, 1].map(|i| self.acceleration[i] + share * (wanted[i] - self.acceleration[i]))
        } else {
            wanted
        };
        // One that starts faster than it may move only slows down.
        let most = bounds.rate.max(math::hypot(self.rate[0], self.rate[1]));
        let next = bounded([0, 1].map(|i| self.rate[i] + wanted[i] * period), most);
        self.acceleration = [0, 1].map(|i| (next[i] - self.rate[i]) / period);
        self.rate = next;
        self.value = [0, 1].map(|i| self.value[i] + next[i] * period);
    }

    /// s^d moved by this offset; its distance stays at least `distance_min` m.
    pub(crate) fn displaces(&self, base: &SetPoint, distance_min: f64) -> SetPoint {
        if *self == Self::default() {
            return *base;
        }
        displaced(base, &[self.value, self.rate, self.acceleration], distance_min)
    }
}

fn bounded(vector: [f64; 2], most: f64) -> [f64; 2] {
    let size = math::hypot(vector[0], vector[1]);
    if size > most { vector.map(|x| x * most / size) } else { vector }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: OffsetBounds = OffsetBounds { rate: 0.4, acceleration: 0.5, onset: 0.15 };

    #[test]
    fn it_reaches_its_goal_within_its_bounds_and_without_going_beyond() {
        let mut offset = Offset::at([3.0, -1.0]);
        for _ in 0..2000 {
            offset.carry(Some([0.5, 0.0]), BOUNDS, 0.01);
            assert!(math::hypot(offset.rate[0], offset.rate[1]) <= 0.4 + 1e-12);
            assert!(math::hypot(offset.acceleration[0], offset.acceleration[1]) <= 0.5 + 1e-9);
            assert!(offset.value[0] > 0.45 && offset.value[1] < 0.05, "{offset:?}");
        }
        assert!((offset.value[0] - 0.5).abs() < 1e-6 && offset.value[1].abs() < 1e-6, "{offset:?}");
    }

    #[test]
    fn without_a_goal_it_comes_to_rest() {
        let mut offset = Offset { rate: [0.3, 0.0], ..Offset::at([1.0, 0.0]) };
        for _ in 0..1000 {
            offset.carry(None, BOUNDS, 0.01);
        }
        assert!(offset.rate[0].abs() < 1e-9 && offset.value[0] > 1.0, "{offset:?}");
    }
}
