//! How robots moved during the last step of a world, for those who look at it continuously.

use crate::Motion;

/// The stretch of time a world advanced last.
pub trait StepInterpolant {
    /// How long it was, s; zero before the first step.
    fn duration(&self) -> f64;

    /// The motion of `robot` at `elapsed` s from the start of the stretch, 0 to [`StepInterpolant::duration`].
    fn during(&self, robot: usize, elapsed: f64) -> Motion;

    /// When, in s from the start, the acceleration of `robot` jumped because its speed met a bound.
    fn saturation_time(&self, robot: usize) -> Option<f64>;
}
