//! The effort of a follower's commands, above all in the observer's transient.

use vocabulary::Command;

/// Commands of one edge; every pair is [acceleration, turn rate].
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct CommandEffort {
    /// Largest |command asked for| in the transient, before limits, [m/s², rad/s].
    pub peak_asked: [f64; 2],
    /// Largest |command applied| in the transient, [m/s², rad/s].
    pub peak_applied: [f64; 2],
    /// ∫|command asked for| dt over the transient, [m/s, rad].
    pub transient_asked: [f64; 2],
    /// ∫|command applied| dt over the transient, [m/s, rad].
    pub transient_applied: [f64; 2],
    /// ∫|command applied| dt over the run, [m/s, rad].
    pub applied: [f64; 2],
    /// End of the transient, s.
    pub transient: f64,
}

/// Running sums of an [`CommandEffort`].
#[derive(Debug, Clone, Default)]
pub(crate) struct EffortSums {
    pub(crate) sums: CommandEffort,
    last: Option<(f64, [f64; 2], [f64; 2])>,
}

impl EffortSums {
    pub(crate) fn until(transient: f64) -> Self {
        Self { sums: CommandEffort { transient, ..CommandEffort::default() }, last: None }
    }

    /// Adds a sample. A command holds from its sample to the next one.
    pub(crate) fn push(&mut self, time: f64, asked: Command, applied: Command) {
        let sizes = |c: Command| [c.acceleration.abs(), c.turn_rate.abs()];
        let (asked, applied) = (sizes(asked), sizes(applied));
        let sums = &mut self.sums;
        if let Some((since, asked, applied)) = self.last {
            let all = time - since;
            let early = (time.min(sums.transient) - since).max(0.0);
            for k in [0, 1] {
                sums.applied[k] += applied[k] * all;
                sums.transient_applied[k] += applied[k] * early;
                sums.transient_asked[k] += asked[k] * early;
            }
        }
        if time < sums.transient {
            for k in [0, 1] {
                sums.peak_asked[k] = sums.peak_asked[k].max(asked[k]);
                sums.peak_applied[k] = sums.peak_applied[k].max(applied[k]);
            }
        }
        self.last = Some((time, asked, applied));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_held_between_samples_and_the_transient_ends_when_it_ends() {
        let mut sums = EffortSums::until(0.25);
        for (k, a) in [4.0, -2.0, 1.0, 100.0, 0.0].into_iter().enumerate() {
            let asked = Command { acceleration: a, turn_rate: 2.0 * a };
            let applied = Command { acceleration: 0.5 * a, turn_rate: a };
            sums.push(0.1 * k as f64, asked, applied);
        }
        let found = sums.sums;
        assert_eq!(found.peak_asked, [4.0, 8.0]);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        assert!(near(found.transient_asked[0], 0.4 + 0.2 + 0.05), "{found:?}");
        assert!(near(found.applied[1], 0.4 + 0.2 + 0.1 + 10.0), "{found:?}");
    }
}
