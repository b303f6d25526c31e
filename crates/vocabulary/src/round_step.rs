//! Round numbers for axes and their ticks.

use crate::math;

/// The least of 1, 2 or 5 times a power of ten that is not below `least`; one that is below it by a share of at most
/// `slack` counts. `least` is above 0.
pub fn round_step(least: f64, slack: f64) -> f64 {
    let decade = math::powf(10_f64, math::log10(least).floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * decade);
    steps.into_iter().find(|step| *step >= least * (1.0 - slack)).unwrap_or(least)
}

#[cfg(test)]
mod tests {
    use super::round_step;

    #[test]
    fn steps_are_one_two_and_five() {
        for (least, step) in [(0.011, 0.02), (0.2, 0.2), (0.21, 0.5), (3.0, 5.0), (7.0, 10.0), (100.0, 100.0)]
        {
            assert!((round_step(least, 1e-9) - step).abs() < 1e-12 * step, "{least}");
        }
        // What is above a round number by no more than the slack is that number.
        assert_eq!((round_step(2.001, 0.001), round_step(2.001, 0.0)), (2.0, 5.0));
    }
}
