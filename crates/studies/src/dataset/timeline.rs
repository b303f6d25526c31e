//! A run at growing times, and a little before each of them.

use crate::Error;
use simulation::Simulation;
use std::collections::VecDeque;
use vocabulary::Snapshot;

/// Times closer together than this are one, s.
const INSTANT: f64 = 1e-9;

/// A simulation that is asked for growing times and remembers its last moments.
pub(crate) struct Timeline {
    simulation: Simulation,
    /// Old to new; the last is the first that is not before the time asked for.
    past: VecDeque<Snapshot>,
    /// How far back it remembers, s.
    memory: f64,
}

impl Timeline {
    pub(crate) fn new(simulation: Simulation, memory: f64) -> Self {
        Self { simulation, past: VecDeque::new(), memory }
    }

    /// Lets the run go on to `time`; false where it has ended before that, or `go_on` says no.
    pub(crate) fn reach(&mut self, time: f64, go_on: &dyn Fn() -> bool) -> Result<bool, Error> {
        while self.past.back().is_none_or(|last| last.time < time - INSTANT) {
            if !go_on() {
                return Ok(false);
            }
            let Some(record) = self.simulation.next_record() else {
                let fault = self.simulation.fault();
                return fault.map_or(Ok(false), |fault| Err(fault.into()));
            };
            self.past.push_back(record.snapshot.clone());
            while self.past.get(1).is_some_and(|second| second.time <= time - self.memory) {
                self.past.pop_front();
            }
        }
        Ok(true)
    }

    /// Everything as it was at `time`, which has been reached: between two control samples on the straight line.
    pub(crate) fn at(&self, time: f64) -> Option<Snapshot> {
        between(&self.past, time)
    }
}

/// Everything at `time`, from what is remembered; the first or last of it where that does not reach as far.
fn between(past: &VecDeque<Snapshot>, time: f64) -> Option<Snapshot> {
    let after = past.iter().position(|snapshot| snapshot.time >= time - INSTANT);
    let (first, last) = (past.front()?, past.back()?);
    let Some(after) = after else { return Some(last.clone()) };
    let Some((a, b)) = after.checked_sub(1).and_then(|k| Some((past.get(k)?, past.get(after)?))) else {
        return Some(first.clone());
    };
    let share = ((time - a.time) / (b.time - a.time).max(INSTANT)).clamp(0.0, 1.0);
    Some(Snapshot::between(a, b, share))
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::RobotState;

    #[test]
    fn times_between_samples_are_on_the_line_and_others_are_held() {
        let snapshot = |time: f64| {
            let mut robot = RobotState::default();
            robot.motion.pose.x = 10.0 * time;
            Snapshot { time, robots: vec![robot], props: vec![] }
        };
        let past: VecDeque<Snapshot> = [0.1, 0.2, 0.3].map(snapshot).into();
        for (time, x) in [(0.0, 1.0), (0.1, 1.0), (0.15, 1.5), (0.2, 2.0), (0.29, 2.9), (0.4, 3.0)] {
            let got = between(&past, time).expect("remembered").robots[0].motion.pose.x;
            assert!((got - x).abs() < 1e-9, "{time}: {got}");
        }
        assert_eq!(between(&VecDeque::new(), 0.0), None);
    }
}
