//! Whether what a path asks for can be driven: turn rate and speed, all along it, held against limits.

use crate::caption::short;
use crate::error::BuildError;
use formation::lead::SplinePath;
use std::fmt;
use vocabulary::{Limits, MotionInput, Trajectory};

/// A motion along a path.
#[derive(Debug, Clone)]
pub(crate) enum PathMotion {
    /// Along a curve.
    SplinePath(std::sync::Arc<SplinePath>),
    /// Any other.
    Free(std::sync::Arc<dyn Trajectory>),
}

impl PathMotion {
    /// Speed and turn rate over time.
    pub(crate) fn trajectory(&self) -> std::sync::Arc<dyn Trajectory> {
        match self {
            Self::SplinePath(way) => way.clone(),
            Self::Free(trajectory) => trajectory.clone(),
        }
    }
}

/// A demand of a path that exceeds the limits.
#[derive(Debug, Clone, PartialEq)]
pub struct Undrivable {
    /// s.
    pub time: f64,
    /// Number, from 1, and place of the way-point at which it is asked; `None` on other paths.
    pub point: Option<(usize, [f64; 2])>,
    /// m/s.
    pub speed: f64,
    /// rad/s, left and right alike; infinite where the path turns back on the spot.
    pub turn_rate: f64,
    /// What it is held against.
    pub limits: Limits,
    /// What bounds the turn rate, where it is not the vehicle.
    pub step: Option<f64>,
}

/// Instants of a path that are looked at, besides the bends of a curve.
const INSTANTS: u32 = 4096;
/// What rounding may add.
const SLACK: f64 = 1.0 + 1e-9;

/// Holds a motion against `limits` between two times, s.
pub(crate) fn undrivable(motion: &PathMotion, limits: &Limits, [from, to]: [f64; 2]) -> Option<Undrivable> {
    let judge = |time: f64, point: Option<(usize, [f64; 2])>, speed: f64, turn_rate: f64| {
        let bound = limits.turn_rate_at(speed) * SLACK;
        // What is not a number is not within a bound either.
        let fits = turn_rate <= bound && speed <= limits.speed_max * SLACK;
        (!fits).then_some(Undrivable { time, point, speed, turn_rate, limits: *limits, step: None })
    };
    if let PathMotion::SplinePath(way) = motion {
        let bends = way.bends(to).into_iter().filter(|bend| bend.time >= from && bend.speed > 0.0);
        let worst = bends.filter_map(|bend| {
            judge(bend.time, Some((bend.point, bend.place)), bend.speed, bend.speed * bend.curvature)
        });
        if let Some(found) = worst.max_by(|a, b| a.excess().total_cmp(&b.excess())) {
            return Some(found);
        }
    }
    let trajectory = motion.trajectory();
    // A turn rate that fits the slowest and the fastest speed fits those between: the bound rises, then falls.
    if let Some([[slowest, fastest], turns]) = trajectory.ranges() {
        let turn_rate = turns[0].abs().max(turns[1].abs());
        if slowest >= 0.0
            && [slowest, fastest].iter().all(|speed| judge(from, None, *speed, turn_rate).is_none())
        {
            return None;
        }
    }
    let instants = (0..=INSTANTS).filter_map(|k| {
        let time = from + (to - from) * f64::from(k) / f64::from(INSTANTS);
        let MotionInput { speed, turn_rate, .. } = trajectory.at(time);
        judge(time, None, speed, turn_rate.abs())
    });
    instants.max_by(|a, b| a.excess().total_cmp(&b.excess()))
}

impl Undrivable {
    /// As a fault of the path of robot or prop `name`.
    pub(crate) fn of(self, name: &str) -> BuildError {
        BuildError::Undrivable { robot: name.to_owned(), found: Box::new(self) }
    }

    /// What is asked for over what can be had, of speed or turn rate.
    fn excess(&self) -> f64 {
        let turn = self.turn_rate / self.limits.turn_rate_at(self.speed);
        turn.max(self.speed / self.limits.speed_max)
    }

    /// 1/m.
    fn curvature(&self) -> f64 {
        self.turn_rate / self.speed
    }

    /// The tightest circle at this speed, m.
    fn radius(&self) -> f64 {
        self.speed / self.limits.turn_rate_at(self.speed)
    }

    /// The speed up to which the bend can be driven, m/s; `None` where there is none.
    fn slower(&self) -> Option<f64> {
        let (limits, curvature) = (&self.limits, self.curvature());
        let speed =
            (limits.turn_rate_max / curvature).min((limits.lateral_acceleration_max / curvature).sqrt());
        (curvature <= limits.curvature_max && speed > 1e-3).then_some(speed)
    }

    /// What bounds the turn rate.
    fn bound(&self) -> String {
        if let Some(step) = self.step {
            return format!("a physics step of {} s", short(step));
        }
        let (limits, most) = (&self.limits, self.limits.turn_rate_at(self.speed));
        if most == limits.turn_rate_max {
            "`turn_rate_max`"
        } else if most == self.speed * limits.curvature_max {
            "`steering_max`"
        } else {
            "what its tyres hold"
        }
        .to_owned()
    }
}

impl fmt::Display for Undrivable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = match self.point {
            Some((number, [x, y])) => format!("at point {number}, [{x}, {y}]"),
            None => format!("at {:.2} s", self.time),
        };
        let (speed, most) = (short(self.speed), short(self.limits.turn_rate_at(self.speed)));
        if self.speed > self.limits.speed_max {
            return write!(f, "{place} it goes at {speed} m/s, above {} m/s", short(self.limits.speed_max));
        }
        if self.turn_rate.is_finite() {
            let (turn_rate, bound) = (rounded(self.turn_rate), self.bound());
            write!(
                f,
                "{place} it turns at {turn_rate} rad/s while it goes at {speed} m/s, and {bound} allows {most} rad/s"
            )?;
        } else {
            write!(f, "{place} it turns back on the spot, which no turn rate does")?;
        }
        let needed = rounded(self.radius());
        if self.point.is_some() {
            // An infinite curvature gives a radius of 0.
            let radius = self.curvature().recip();
            let apart = if radius > 0.0 { "move the points apart, or " } else { "" };
            write!(
                f,
                ": the curve through the points has a radius of {} m there and needs at least {needed} m; {apart}add \
                 points that lead round",
                rounded(radius)
            )?;
        } else {
            write!(f, ": bend it along a radius of at least {needed} m")?;
        }
        self.slower()
            .map_or(Ok(()), |speed| write!(f, ", or go at no more than {} m/s there", rounded(speed)))
    }
}

/// Three significant digits.
fn rounded(value: f64) -> String {
    format!("{value:.2e}").parse::<f64>().unwrap_or(value).to_string()
}
