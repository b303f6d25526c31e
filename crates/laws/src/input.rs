//! What a law is told at an instant: what its follower may know, and nothing else.

use crate::noise::Noise;
use crate::unit::Unit;
use vocabulary::{MotionInput, Relative, SetPoint};

/// The most leaders that a law looks at.
pub const LEADERS_MAX: usize = 4;

/// What a law is told at an instant.
#[derive(Debug, Clone, Copy)]
pub struct Input<'a> {
    /// Time since the start of the run, s.
    pub time: f64,
    /// Control period, s.
    pub period: f64,
    /// The follower's speed v_j, m/s, kept above the least that laws divide by.
    pub own_speed: f64,
    /// dv/dt that was applied last, m/s².
    pub own_acceleration: f64,
    /// ω that was applied last, rad/s.
    pub own_turn_rate: f64,
    /// One entry per leader, as many as the law declares.
    pub leaders: &'a [LeaderInput],
    /// Random numbers.
    pub noise: Noise,
}

/// What a law is told of one leader.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LeaderInput {
    /// Measured ℓ, ψ and γ; ℓ is kept above `law.distance_min`. With `heading = "path"`, "bearing" means the direction φ of
    /// the line in the world.
    pub relative: Relative,
    /// d[ℓ, ψ]/dt, [m/s, rad/s]: the truth or the observer's estimate, see [`crate::Knowledge`].
    pub rates: [f64; 2],
    /// s^d with two derivatives.
    pub wanted: SetPoint,
    /// Its motion; told to laws that know it.
    pub motion: MotionInput,
    /// [dχ/dt, d²χ/dt²] of the heading χ from which the bearing is taken, [rad/s, rad/s²]: the leader's own turn rate, or 0
    /// with `heading = "path"`. Told to laws that know the leader's motion.
    pub frame: [f64; 2],
    /// The leader's own heading, counted from χ, rad: 0, or its heading in the world with `heading = "path"`. Told to laws that
    /// know the leader's motion: what the motion does to distance and bearing depends on it.
    pub heading: f64,
}

/// One of the numbers of an [`Input`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum InputKind {
    /// `time`.
    Time,
    /// `period`.
    Period,
    /// `own.speed`.
    OwnSpeed,
    /// `own.acceleration`.
    OwnAcceleration,
    /// `own.turn_rate`.
    OwnTurnRate,
    /// `leader.distance`.
    Distance,
    /// `leader.bearing`.
    Bearing,
    /// `leader.view_angle`.
    ViewAngle,
    /// `leader.distance_rate`.
    DistanceRate,
    /// `leader.bearing_rate`.
    BearingRate,
    /// `wanted.distance`.
    WantedDistance,
    /// `wanted.bearing`.
    WantedBearing,
    /// `wanted.distance_rate`.
    WantedDistanceRate,
    /// `wanted.bearing_rate`.
    WantedBearingRate,
    /// `wanted.distance_acceleration`.
    WantedDistanceAcceleration,
    /// `wanted.bearing_acceleration`.
    WantedBearingAcceleration,
    /// `leader.speed`.
    LeaderSpeed,
    /// `leader.acceleration`.
    LeaderAcceleration,
    /// `leader.turn_rate`.
    LeaderTurnRate,
    /// `leader.turn_acceleration`.
    LeaderTurnAcceleration,
    /// `leader.heading`.
    LeaderHeading,
    /// `frame.turn_rate`.
    FrameTurnRate,
    /// `frame.turn_acceleration`.
    FrameTurnAcceleration,
}

use InputKind as K;

/// Every number that a law may read: what it is, its name in law files, its unit, and one line about it. Names with a dot
/// take a number before it where there are several leaders, as in `leader2.distance`.
pub const INPUTS: [(InputKind, &str, Unit, &str); 23] = [
    (K::Time, "time", Unit::new(0, 1), "time since the start of the run"),
    (K::Period, "period", Unit::new(0, 1), "control period"),
    (K::OwnSpeed, "own.speed", Unit::new(1, -1), "the follower's speed"),
    (K::OwnAcceleration, "own.acceleration", Unit::new(1, -2), "the acceleration that was applied last"),
    (K::OwnTurnRate, "own.turn_rate", Unit::new(0, -1).angular(), "the turn rate that was applied last"),
    (K::Distance, "leader.distance", Unit::new(1, 0), "measured distance ℓ to the leader"),
    (
        K::Bearing,
        "leader.bearing",
        Unit::ANGLE,
        "measured bearing ψ: the follower, seen from the leader's heading",
    ),
    (
        K::ViewAngle,
        "leader.view_angle",
        Unit::ANGLE,
        "measured view angle γ: the leader stands at γ − π from the own heading",
    ),
    (K::DistanceRate, "leader.distance_rate", Unit::new(1, -1), "rate of the distance"),
    (K::BearingRate, "leader.bearing_rate", Unit::new(0, -1).angular(), "rate of the bearing"),
    (K::WantedDistance, "wanted.distance", Unit::new(1, 0), "set point of the distance"),
    (K::WantedBearing, "wanted.bearing", Unit::ANGLE, "set point of the bearing"),
    (
        K::WantedDistanceRate,
        "wanted.distance_rate",
        Unit::new(1, -1),
        "rate of the set point of the distance",
    ),
    (
        K::WantedBearingRate,
        "wanted.bearing_rate",
        Unit::new(0, -1).angular(),
        "rate of the set point of the bearing",
    ),
    (
        K::WantedDistanceAcceleration,
        "wanted.distance_acceleration",
        Unit::new(1, -2),
        "second derivative of the set point of the distance",
    ),
    (
        K::WantedBearingAcceleration,
        "wanted.bearing_acceleration",
        Unit::new(0, -2).angular(),
        "second derivative of the set point of the bearing",
    ),
    (K::LeaderSpeed, "leader.speed", Unit::new(1, -1), "the leader's speed"),
    (K::LeaderAcceleration, "leader.acceleration", Unit::new(1, -2), "the leader's acceleration"),
    (K::LeaderTurnRate, "leader.turn_rate", Unit::new(0, -1).angular(), "the leader's turn rate"),
    (
        K::LeaderTurnAcceleration,
        "leader.turn_acceleration",
        Unit::new(0, -2).angular(),
        "rate of the leader's turn rate",
    ),
    (
        K::LeaderHeading,
        "leader.heading",
        Unit::ANGLE,
        "the leader's own heading, counted from the heading that the bearing is taken from",
    ),
    (
        K::FrameTurnRate,
        "frame.turn_rate",
        Unit::new(0, -1).angular(),
        "turn rate of the heading that the bearing is taken from",
    ),
    (
        K::FrameTurnAcceleration,
        "frame.turn_acceleration",
        Unit::new(0, -2).angular(),
        "rate of that turn rate",
    ),
];

impl InputKind {
    /// Whether there is one for each leader.
    pub fn is_per_leader(self) -> bool {
        self >= Self::Distance
    }

    /// For what is wanted: of the distance, 0, or the bearing, 1.
    pub fn wanted(self) -> Option<usize> {
        match self {
            K::WantedDistance | K::WantedDistanceRate | K::WantedDistanceAcceleration => Some(0),
            K::WantedBearing | K::WantedBearingRate | K::WantedBearingAcceleration => Some(1),
            _ => None,
        }
    }

    /// Whether only laws that know their leader's motion may read it.
    pub fn is_motion(self) -> bool {
        self >= Self::LeaderSpeed
    }
}

impl Input<'_> {
    /// One of its numbers; that of leader number `leader`, counted from 0, where there is one for each. 0 for a leader that is
    /// not there.
    pub fn value(&self, leader: usize, kind: InputKind) -> f64 {
        match kind {
            K::Time => self.time,
            K::Period => self.period,
            K::OwnSpeed => self.own_speed,
            K::OwnAcceleration => self.own_acceleration,
            K::OwnTurnRate => self.own_turn_rate,
            _ => self.leaders.get(leader).map_or(0.0, |leader| leader.value(kind)),
        }
    }
}

impl LeaderInput {
    fn value(&self, kind: InputKind) -> f64 {
        let wanted = &self.wanted;
        match kind {
            K::Time | K::Period | K::OwnSpeed | K::OwnAcceleration | K::OwnTurnRate => 0.0,
            K::Distance => self.relative.distance,
            K::Bearing => self.relative.bearing,
            K::ViewAngle => self.relative.view_angle,
            K::DistanceRate => self.rates[0],
            K::BearingRate => self.rates[1],
            K::WantedDistance => wanted.value[0],
            K::WantedBearing => wanted.value[1],
            K::WantedDistanceRate => wanted.rate[0],
            K::WantedBearingRate => wanted.rate[1],
            K::WantedDistanceAcceleration => wanted.acceleration[0],
            K::WantedBearingAcceleration => wanted.acceleration[1],
            K::LeaderSpeed => self.motion.speed,
            K::LeaderAcceleration => self.motion.acceleration,
            K::LeaderTurnRate => self.motion.turn_rate,
            K::LeaderTurnAcceleration => self.motion.turn_acceleration,
            K::LeaderHeading => self.heading,
            K::FrameTurnRate => self.frame[0],
            K::FrameTurnAcceleration => self.frame[1],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_every_input_once_in_order() {
        assert!(INPUTS.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert_eq!(INPUTS.last().map(|last| last.0), Some(K::FrameTurnAcceleration));
        assert!(INPUTS.iter().all(|(kind, name, ..)| kind.is_per_leader()
            == ["leader.", "wanted.", "frame."].iter().any(|head| name.starts_with(head))));
    }
}
