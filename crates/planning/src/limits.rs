//! How sharply and how fast a formation may drive.

use crate::error::{InputError, checked};

/// Limits of the way, and of the speed along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TravelLimits {
    /// Largest |κ| of the lead's way, 1/m: that of its turning circle.
    pub curvature: f64,
    /// Largest |dκ/ds|, 1/m².
    pub sharpness: f64,
    /// Largest |dκ/dt|, 1/(m s): how fast it steers.
    pub steering: f64,
    /// Speed of the lead at most, m/s.
    pub speed: f64,
    /// How it gains speed, m/s².
    pub acceleration: f64,
    /// How it brakes, m/s².
    pub braking: f64,
    /// Largest κ v² of the lead, m/s².
    pub lateral: f64,
    /// Fastest that any follower drives, m/s.
    pub outer: f64,
    /// Speed that the lead keeps in its tightest turns, m/s: turns in which the outermost follower would have to be faster
    /// than `outer` for that are not planned.
    pub turning: f64,
    /// Largest curvature of followers, 1/m, on steered wheels.
    pub follower_curvature: Option<f64>,
    /// How fast followers turn, rad/s.
    pub follower_turn_rate: Option<f64>,
    /// How strongly they change their speed where their places on a curve ask for it, m/s².
    pub follower_acceleration: Option<f64>,
    /// How fast a follower's place moves from level to level, m/s.
    pub place_rate: f64,
    /// How strongly it is sped up for that, m/s².
    pub place_acceleration: f64,
    /// Whether a robot that is alone may reverse.
    pub reverses: bool,
}

impl Default for TravelLimits {
    /// Those of unicycles of 0.42 m at 0.8 m/s.
    fn default() -> Self {
        Self {
            curvature: 0.9,
            sharpness: 0.3,
            steering: 0.5,
            speed: 0.8,
            acceleration: 0.3,
            braking: 0.3,
            lateral: 1.0,
            outer: 1.6,
            turning: 0.8,
            follower_curvature: None,
            follower_turn_rate: None,
            follower_acceleration: None,
            place_rate: 0.25,
            place_acceleration: 0.4,
            reverses: false,
        }
    }
}

impl TravelLimits {
    /// Checks every number.
    ///
    /// # Errors
    /// One that is not positive, or a speed in turns above one of its bounds.
    pub fn check(&self) -> Result<(), InputError> {
        let positive = [
            ("the curvature", self.curvature, "positive, 1/m"),
            ("the sharpness", self.sharpness, "positive, 1/m²"),
            ("the steering rate", self.steering, "positive, 1/(m s)"),
            ("the speed", self.speed, "positive, m/s"),
            ("the acceleration", self.acceleration, "positive, m/s²"),
            ("the braking", self.braking, "positive, m/s²"),
            ("the lateral acceleration", self.lateral, "positive, m/s²"),
            ("the followers' speed", self.outer, "positive, m/s"),
            ("the speed in turns", self.turning, "positive, m/s"),
            ("the followers' curvature", self.follower_curvature.unwrap_or(1.0), "positive, 1/m"),
            ("the followers' turn rate", self.follower_turn_rate.unwrap_or(1.0), "positive, rad/s"),
            ("the followers' acceleration", self.follower_acceleration.unwrap_or(1.0), "positive, m/s²"),
            ("the rate of places", self.place_rate, "positive, m/s"),
            ("the acceleration of places", self.place_acceleration, "positive, m/s²"),
        ];
        for (what, value, range) in positive {
            checked(value, value > 0.0, || what.into(), range)?;
        }
        let most = self.speed.min(self.outer);
        let range = "at most the lead's speed and the followers'";
        checked(self.turning, self.turning <= most, || "the speed in turns".into(), range)?;
        Ok(())
    }

    /// The largest speed of a follower per speed of the lead.
    pub(crate) fn fastest_share(&self) -> f64 {
        self.outer / self.turning
    }
}
