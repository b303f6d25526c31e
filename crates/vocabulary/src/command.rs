//! What a control law asks of a robot.

/// The command [dv/dt, ω] of a robot (eq 13).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Command {
    /// Rate of change of the forward speed, m/s².
    pub acceleration: f64,
    /// Turn rate, rad/s, counter-clockwise.
    pub turn_rate: f64,
}
