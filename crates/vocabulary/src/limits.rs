//! What a robot's actuators can do.

use crate::Command;

/// Bounds on speed, turn rate and acceleration. `0 ≤ speed_min < speed_max`, the others positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// m/s; above zero, since the laws are singular at rest (det g = v/ℓ), but for a follower that may stand.
    pub speed_min: f64,
    /// m/s.
    pub speed_max: f64,
    /// rad/s, either direction.
    pub turn_rate_max: f64,
    /// m/s², either direction; infinite where unbounded.
    pub acceleration_max: f64,
    /// Tightest turn, 1/m: |ω| ≤ |v| × this, as steered wheels have it (tan δ_max / L); infinite for a unicycle.
    pub curvature_max: f64,
    /// Largest |v ω|, m/s², before tyres slide; infinite where they never do.
    pub lateral_acceleration_max: f64,
}

impl Limits {
    /// Those of the paper's simulations: unicycles from 0.01 to 1.6 m/s that turn up to 11.5 rad/s.
    pub const PAPER: Self = Self {
        speed_min: 0.01,
        speed_max: 1.6,
        turn_rate_max: 11.5,
        acceleration_max: f64::INFINITY,
        curvature_max: f64::INFINITY,
        lateral_acceleration_max: f64::INFINITY,
    };

    /// `command` within the bounds on acceleration and turn rate at a speed (the sat{} of eq 42); zero where not a
    /// number.
    pub fn saturate(&self, command: Command, speed: f64) -> Command {
        Command {
            acceleration: clamp(command.acceleration, self.acceleration_max),
            turn_rate: clamp(command.turn_rate, self.turn_rate_at(speed)),
        }
    }

    /// Largest |turn rate| at `speed`, rad/s.
    pub fn turn_rate_at(&self, speed: f64) -> f64 {
        let speed = speed.abs();
        // At rest an infinite bound gives no number, which `min` passes over.
        self.turn_rate_max.min(speed * self.curvature_max).min(self.lateral_acceleration_max / speed)
    }

    /// The acceleration that takes effect at `speed`: none outward where the speed stands at a bound.
    pub fn admissible(&self, acceleration: f64, speed: f64) -> f64 {
        let outward = (speed >= self.speed_max && acceleration > 0.0)
            || (speed <= self.speed_min && acceleration < 0.0);
        if outward { 0.0 } else { acceleration }
    }

    /// `speed` within its bounds, m/s.
    pub fn clamp_speed(&self, speed: f64) -> f64 {
        speed.max(self.speed_min).min(self.speed_max)
    }
}

/// Largest acceleration that is ever passed on, m/s²: keeps an unbounded law finite next to its singularities.
const ACCELERATION_CEILING: f64 = 1e6;

fn clamp(value: f64, bound: f64) -> f64 {
    let bound = bound.min(ACCELERATION_CEILING);
    if value.is_nan() { 0.0 } else { value.clamp(-bound, bound) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits::PAPER;

    #[test]
    fn saturation_is_finite_for_any_command() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -3.0] {
            let cut = LIMITS.saturate(Command { acceleration: value, turn_rate: value }, 1.0);
            assert!(cut.acceleration.is_finite() && cut.turn_rate.abs() <= 11.5, "{value} gave {cut:?}");
        }
    }

    #[test]
    fn steered_wheels_turn_with_the_speed_and_slide_at_a_bound() {
        let car = Limits { curvature_max: 2.0, lateral_acceleration_max: 4.0, ..LIMITS };
        let turns = |speed| car.saturate(Command { acceleration: 0.0, turn_rate: -9.0 }, speed).turn_rate;
        assert_eq!((turns(0.0), turns(0.5), turns(4.0)), (0.0, -1.0, -1.0));
        assert_eq!(LIMITS.turn_rate_at(0.0), 11.5);
    }

    #[test]
    fn a_speed_at_its_bound_moves_inward_only() {
        assert_eq!(LIMITS.admissible(2.0, 1.6), 0.0);
        assert_eq!(LIMITS.admissible(-2.0, 1.6), -2.0);
        assert_eq!(LIMITS.admissible(-2.0, 0.01), 0.0);
    }
}
