//! `echelon accuracy`: how well leaders are found and located, over random poses that are drawn as cameras see them.

mod bench;
mod poses;
mod table;
mod tally;

use crate::Outcome;
use crate::args::AccuracyArgs;
use crate::failure::Failure;
use crate::interrupt;
use crate::print;
use crate::progress::Progress;
use bench::{Bench, Times};
use poses::{BINS, FOLLOWER, place};
use rendering::{AdapterChoice, Gpu};
use serde_json::json;
use std::time::Instant;
use tally::{Bin, bin_of, median};
use vocabulary::{FACES, TAGS, counted};

/// How many leaders with different tags take turns, at most.
const LEADERS: u64 = 12;

pub(crate) fn accuracy(args: &AccuracyArgs) -> Outcome {
    let began = Instant::now();
    interrupt::watch();
    let gpu = Gpu::open(&AdapterChoice::from(args.adapter.as_str()))?;
    let what = format!("Locating a leader in {}", counted(args.poses, "pose"));
    let progress = Progress::begin(&what, args.poses, args.json);
    let mut bins = [Bin::default(); BINS.len()];
    let mut times: [Vec<Times>; 2] = [vec![], vec![]];
    let each = args.poses.div_ceil(LEADERS).max(BINS.len() as u64);
    let mut bench = None;
    let mut done = 0;
    while done < args.poses && !interrupt::asked() {
        if done % each == 0 {
            bench = Some(Bench::new(&gpu, number(args.seed, done / each), args.seed)?);
        }
        let Some(bench) = bench.as_mut() else { break };
        let snapshot = place(args.seed, done, &bench.fleet.robots[FOLLOWER]);
        let (sample, took) = bench.try_pose(&snapshot, done)?;
        bins[bin_of(sample.distance)].add(&sample);
        for (all, one) in times.iter_mut().zip(took) {
            all.push(one);
        }
        done += 1;
        progress.at(done);
    }
    progress.end();
    let medians = times.map(|all| medians(&all));
    let seconds = began.elapsed().as_secs_f64();
    let adapter = gpu.description();
    if args.json {
        let mut value = table::as_json(&bins, &medians);
        value["poses"] = json!(done);
        value["seed"] = json!(args.seed);
        value["adapter"] = json!(adapter);
        value["wall_seconds"] = json!(seconds);
        print::json(&value);
    } else {
        let poses = counted(done, "pose");
        print::say(&format!("{poses}, seed {}, drawn in {seconds:.1} s with {adapter}\n", args.seed));
        for line in table::text(&bins, &medians) {
            print::say(&line);
        }
    }
    if done < args.poses {
        return Err(Failure::Interrupted(format!(
            "after {done} of {}; they are printed",
            counted(args.poses, "pose")
        )));
    }
    Ok(())
}

/// The number on the shell of the `turn`th leader: spread over the whole family.
fn number(seed: u64, turn: u64) -> usize {
    let robots = (TAGS / FACES) as u64;
    // Any step that shares no divisor with the number of robots meets all of them.
    (seed.wrapping_add(turn.wrapping_mul(41)) % robots) as usize
}

/// Median of every stage, ms.
fn medians(times: &[Times]) -> [Option<f64>; 4] {
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
