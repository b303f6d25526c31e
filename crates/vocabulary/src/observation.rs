//! What a follower knows of its leader: the only thing a law may use.

use crate::{Motion, Relative, TrackingState};

/// What one follower knows of its leader at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Observation {
    /// Relative position as sensed (eqs 2-4).
    pub relative: Relative,
    /// The follower's own forward speed, m/s.
    pub own_speed: f64,
    /// The follower's own heading by its gyro, rad, against a direction that stays.
    pub own_heading: f64,
    /// The leader's forward speed, m/s, where it is known (state feedback); cameras do not tell it.
    pub leader_speed: Option<f64>,
    /// How well the follower knows where its leader is.
    pub sight: TrackingState,
}

impl Observation {
    /// The truth about a leader and its follower.
    pub fn true_of([leader, follower]: [&Motion; 2]) -> Self {
        Self {
            relative: Relative::between(leader.pose, follower.pose),
            own_speed: follower.speed,
            own_heading: follower.pose.heading,
            leader_speed: Some(leader.speed),
            ..Self::default()
        }
    }
}

/// What an edge was at one instant inside a control period.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EdgeSample {
    /// Relative position; the bearing may exceed (−π, π] so as to be continuous along a track.
    pub relative: Relative,
    /// The follower's speed, m/s.
    pub own_speed: f64,
    /// The follower's acceleration as applied, m/s².
    pub acceleration: f64,
    /// The follower's turn rate as applied, rad/s.
    pub turn_rate: f64,
}

/// Samples of a smooth stretch of time.
pub const TRACK_NODES: usize = 6;

/// An edge over a smooth stretch of time, at Chebyshev-Lobatto nodes from its start to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Track {
    /// Length of the stretch, s.
    pub duration: f64,
    /// Samples in the order of time.
    pub samples: [EdgeSample; TRACK_NODES],
}

impl Track {
    /// Where the samples lie, as fractions of the duration: (1 − cos(kπ/5))/2.
    pub const NODES: [f64; TRACK_NODES] = [
        0.0,
        0.095_491_502_812_526_29,
        0.345_491_502_812_526_3,
        0.654_508_497_187_473_7,
        0.904_508_497_187_473_7,
        1.0,
    ];
}
