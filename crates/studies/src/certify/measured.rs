//! What a run shows of an edge whatever its law: how its error fell, how often bounds cut its commands, and what they cost.

use vocabulary::{EdgeState, math};

/// What holds for any law, measured over a stretch.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeasuredTracking {
    /// Samples.
    pub samples: u64,
    /// ‖e‖ = |[distance error, distance · bearing error]| at the first sample, m.
    pub first: f64,
    /// At the last, m.
    pub last: f64,
    /// The largest, m.
    pub largest: f64,
    /// Samples at which ‖e‖ was smaller than at the sample before.
    pub falls: u64,
    /// Samples at which a bound or a filter cut the command.
    pub limited: u64,
    /// ∫ (dv/dt)² + (v ω)² dt of the commands that were applied, m²/s³.
    pub effort: f64,
}

impl MeasuredTracking {
    /// Takes in a sample `period` s after the last, of a follower that drives at `speed` m/s.
    pub fn push(&mut self, edge: &EdgeState, speed: f64, period: f64) {
        let error = math::hypot(edge.error[0], edge.relative.distance * edge.error[1]);
        if self.samples == 0 {
            self.first = error;
        } else if error < self.last {
            self.falls += 1;
        }
        self.samples += 1;
        self.last = error;
        self.largest = self.largest.max(error);
        self.limited += u64::from(edge.limited);
        let across = speed * edge.applied.turn_rate;
        self.effort += (edge.applied.acceleration * edge.applied.acceleration + across * across) * period;
    }

    /// In one line.
    pub fn words(&self) -> String {
        let steps = self.samples.saturating_sub(1).max(1) as f64;
        let share = |count: u64, of: f64| 100.0 * count as f64 / of;
        format!(
            "‖e‖ {:.4} → {:.4} m, at most {:.4} m, falls at {:.0} % of the samples; commands cut at {:.0} %; effort {:.3} m²/s³",
            self.first,
            self.last,
            self.largest,
            share(self.falls, steps),
            share(self.limited, self.samples.max(1) as f64),
            self.effort
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Command, Relative};

    #[test]
    fn falls_cuts_and_effort_are_counted() {
        let mut measured = MeasuredTracking::default();
        for (error, limited) in [([0.3, 0.2], true), ([0.3, 0.0], false), ([0.0, 0.2], false)] {
            let edge = EdgeState {
                error,
                limited,
                relative: Relative { distance: 2.0, ..Relative::default() },
                applied: Command { acceleration: 2.0, turn_rate: 1.5 },
                ..EdgeState::default()
            };
            measured.push(&edge, 2.0, 0.1);
        }
        assert_eq!((measured.first, measured.last, measured.largest), (0.5, 0.4, 0.5));
        assert_eq!((measured.samples, measured.falls, measured.limited), (3, 1, 1));
        assert!((measured.effort - 3.9).abs() < 1e-12, "{}", measured.effort);
    }
}
