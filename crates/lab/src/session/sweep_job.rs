//! A sweep as threads share it: each takes the next run that nobody has taken.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use sweeps::Experiment;

/// A sweep as threads share it.
#[derive(Debug)]
pub struct SweepJob {
    /// The number of its order.
    pub number: u64,
    /// What is run.
    pub experiment: Experiment,
    taken: AtomicU64,
    stopped: AtomicBool,
}

impl SweepJob {
    /// Of which no run is taken.
    pub(crate) fn new(number: u64, experiment: Experiment) -> Self {
        Self { number, experiment, taken: AtomicU64::new(0), stopped: AtomicBool::new(false) }
    }

    /// The next run; `None` where all are taken, or nobody wants them any more.
    pub(crate) fn claim(&self) -> Option<u64> {
        if self.stopped() {
            return None;
        }
        let study = self.experiment.study();
        let turn = self.taken.fetch_add(1, Relaxed);
        (turn < study.runs()).then(|| run_of_turn(turn, study.cells(), study.runs()))
    }

    /// Nobody wants its runs any more.
    pub(crate) fn stop(&self) {
        self.stopped.store(true, Relaxed);
    }

    /// Whether nobody wants its runs any more.
    pub(crate) fn stopped(&self) -> bool {
        self.stopped.load(Relaxed)
    }
}

/// Which run is made at this turn: first one of every cell, then another of every cell, and cells that lie far apart one after
/// the other, so that a map that is not complete shows its shape.
fn run_of_turn(turn: u64, cells: u64, runs: u64) -> u64 {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let mut stride = ((cells as f64 * GOLDEN).round() as u64).max(1);
    while divisor(stride, cells) > 1 {
        stride += 1;
    }
    let place = u128::from(turn % cells) * u128::from(stride) % u128::from(cells);
    place as u64 * (runs / cells) + turn / cells
}

/// The greatest common divisor.
fn divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_run_has_its_turn_and_every_cell_one_before_any_has_two() {
        for (cells, seeds) in [(1, 1), (1, 7), (2, 3), (9, 1), (81, 4), (100, 2)] {
            let runs = cells * seeds;
            let mut all: Vec<u64> = (0..runs).map(|turn| run_of_turn(turn, cells, runs)).collect();
            let mut first: Vec<u64> = all[..cells as usize].iter().map(|run| run / seeds).collect();
            first.sort_unstable();
            assert_eq!(first, (0..cells).collect::<Vec<_>>());
            all.sort_unstable();
            assert_eq!(all, (0..runs).collect::<Vec<_>>());
        }
    }
}
