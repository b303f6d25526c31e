//! Who follows whom, where a follower is, and where it should be.

/// A leader-follower pair; both are indices of robots in a snapshot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Edge {
    /// Index of the robot that is followed (robot i of the paper).
    pub leader: usize,
    /// Index of the robot that follows (robot j of the paper).
    pub follower: usize,
}

/// Where a follower is relative to its leader (eqs 2-4).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Relative {
    /// Distance between the two, m (ℓ).
    pub distance: f64,
    /// Direction to the follower seen from the leader's heading, rad (ψ); positive is to the left.
    pub bearing: f64,
    /// The leader stands at this angle minus π from the follower's heading, rad (γ).
    pub view_angle: f64,
}

/// Wanted [distance in m, bearing in rad] of an edge at an instant, with first and second time derivative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SetPoint {
    /// [m, rad].
    pub value: [f64; 2],
    /// [m/s, rad/s].
    pub rate: [f64; 2],
    /// [m/s², rad/s²].
    pub acceleration: [f64; 2],
}
