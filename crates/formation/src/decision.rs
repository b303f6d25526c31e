//! What a law decided for its follower, within limits, and what a follower does without its leader.

use vocabulary::{Command, Limits, MotionPhase, SetPoint, wrap};

/// What a law decided on one edge. What it decided for its follower stands on each of the follower's edges.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Decision {
    /// s^d at this instant, [m, rad]: the bearing against the leader's own heading, whatever the law holds it against.
    pub set_point: [f64; 2],
    /// How far the heading that the bearing is held against is behind the leader's own, rad.
    pub behind: f64,
    /// ds^d/dt, [m/s, rad/s], of what the law works on.
    pub set_point_rate: [f64; 2],
    /// Asked for, before limits.
    pub asked: Command,
    /// Within limits: what the robot is told.
    pub commanded: Command,
    /// What takes effect at once: no acceleration outward at a bound of the speed.
    pub applied: Command,
    /// ds/dt as the law took it, [m/s, rad/s].
    pub rates: [f64; 2],
    /// Whether a limit or a filter cut the command.
    pub limited: bool,
    /// Whether the distance was below ℓ_min.
    pub too_close: bool,
    /// What the command is of.
    pub phase: MotionPhase,
    /// How far the place that the follower is driven to is from its set point, m: while it starts again after a stand, or
    /// goes to another place.
    pub displacement: f64,
    /// λ: how far the place is on the way from the set point to the column, 0 to 1.
    pub narrowing: f64,
}

impl Decision {
    /// What becomes of what is asked for at a speed, within limits.
    pub(crate) fn of(asked: Command, set_point: &SetPoint, own_speed: f64, limits: &Limits) -> Self {
        let commanded = limits.saturate(asked, own_speed.max(limits.speed_min));
        let acceleration = limits.admissible(commanded.acceleration, own_speed);
        let applied = Command { acceleration, ..commanded };
        Self {
            set_point: [set_point.value[0], wrap(set_point.value[1])],
            set_point_rate: set_point.rate,
            asked,
            commanded,
            applied,
            limited: applied != asked,
            ..Self::default()
        }
    }

    /// Puts another command in the place of the one that was decided.
    pub(crate) fn divert(&mut self, told: Command, own_speed: f64, limits: &Limits) {
        let acceleration = limits.admissible(told.acceleration, own_speed);
        self.commanded = told;
        self.applied = Command { acceleration, ..told };
        self.limited = true;
    }
}

/// What a follower asks for that has not seen its leader yet: it goes straight on; one that has `lost` it brakes to its
/// slowest speed besides.
pub(crate) fn without_leader(lost: bool, own_speed: f64, limits: &Limits) -> Command {
    let braking = (limits.speed_min - own_speed) / BRAKING;
    Command { acceleration: if lost { braking } else { 0.0 }, turn_rate: 0.0 }
}

/// Time constant with which a follower brakes that has lost its leader, s.
const BRAKING: f64 = 0.5;
