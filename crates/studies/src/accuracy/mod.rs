//! How well leaders are found and located, over random poses that are drawn as cameras see them.

mod bench;
mod poses;
mod tally;

pub use bench::{STAGES, Times};
pub use poses::BINS;
pub use tally::{AccuracyBin, PoseSample, readable_rms, targets};

use crate::pace::Clock;
use crate::{Error, RendererFactory};
use bench::LocalisationBench;
use metrics::median;
use poses::{FOLLOWER, place};
use tally::bin_of;
use vocabulary::{FACES, TAGS};

/// How many leaders with different tags take turns, at most.
const LEADERS: u64 = 12;

/// What came of the poses that were tried.
#[derive(Debug, Clone)]
pub struct Accuracy {
    /// By distance, as [`BINS`] has them.
    pub bins: [AccuracyBin; BINS.len()],
    /// Medians of every stage of [`STAGES`], ms, of the part that is tracked and of the whole picture.
    pub medians: [[Option<f64>; STAGES.len()]; 2],
    /// Poses that were tried.
    pub poses: u64,
}

/// Tries `poses` poses of a leader; `clock` times the stages, and `go_on` gets the number of poses that are done and says
/// whether there are to be more.
///
/// # Errors
/// [`Error::Camera`] where a picture cannot be drawn.
pub fn accuracy(
    poses: u64,
    seed: u64,
    renderer: RendererFactory<'_>,
    clock: Clock<'_>,
    mut go_on: impl FnMut(u64) -> bool,
) -> Result<Accuracy, Error> {
    let mut bins = [AccuracyBin::default(); BINS.len()];
    let mut times: [Vec<Times>; 2] = [vec![], vec![]];
    let each = poses.div_ceil(LEADERS).max(BINS.len() as u64);
    let mut bench = None;
    let mut done = 0;
    while done < poses && go_on(done) {
        if done % each == 0 {
            bench = Some(LocalisationBench::new(&mut *renderer, number(seed, done / each), seed)?);
        }
        let Some(bench) = bench.as_mut() else { break };
        let snapshot = place(seed, done, &bench.fleet.robots[FOLLOWER]);
        let (sample, took) = bench.try_pose(&snapshot, done, clock)?;
        bins[bin_of(sample.distance)].add(&sample);
        for (all, one) in times.iter_mut().zip(took) {
            all.push(one);
        }
        done += 1;
    }
    Ok(Accuracy { bins, medians: times.map(|all| medians(&all)), poses: done })
}

/// The number on the shell of the `turn`th leader: spread over the whole family.
fn number(seed: u64, turn: u64) -> usize {
    let robots = (TAGS / FACES) as u64;
    // Any step that shares no divisor with the number of robots meets all of them.
    (seed.wrapping_add(turn.wrapping_mul(41)) % robots) as usize
}

/// Median of every stage, ms.
fn medians(times: &[Times]) -> [Option<f64>; STAGES.len()] {
    std::array::from_fn(|stage| median(&mut times.iter().map(|t| t[stage]).collect::<Vec<_>>()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaders_carry_different_tags_of_the_family() {
        let numbers: Vec<usize> = (0..LEADERS).map(|turn| number(1, turn)).collect();
        assert!(numbers.iter().all(|n| FACES * n + FACES <= TAGS), "{numbers:?}");
        let mut sorted = numbers.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(sorted.len(), numbers.len());
        assert!(number(u64::MAX, u64::MAX) < TAGS / FACES);
    }

    #[test]
    fn stages_have_their_own_medians() {
        assert_eq!(
            medians(&[[1.0, 10.0, 0.0, 0.5], [3.0, 30.0, 0.0, 0.5], [2.0, 20.0, 0.0, 0.5]]),
            [Some(2.0), Some(20.0), Some(0.0), Some(0.5)]
        );
        assert_eq!(medians(&[]), [None; 4]);
    }
}
