//! Motions prescribed in time: what lead robots do.

/// Speed and turn rate at an instant, each with its time derivative.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotionInput {
    /// v, m/s.
    pub speed: f64,
    /// dv/dt, m/s².
    pub acceleration: f64,
    /// ω, rad/s.
    pub turn_rate: f64,
    /// dω/dt, rad/s².
    pub turn_acceleration: f64,
}

/// A motion prescribed as a function of time.
pub trait Trajectory: std::fmt::Debug + Send + Sync {
    /// The motion at `time` in s from the start of the run; finite for every finite time.
    fn at(&self, time: f64) -> MotionInput;

    /// The motion at every time, where it is always the same.
    fn steady(&self) -> Option<MotionInput> {
        None
    }

    /// [least, largest] speed in m/s and turn rate in rad/s at any time, where they are known without a search.
    fn ranges(&self) -> Option<[[f64; 2]; 2]> {
        None
    }
}
