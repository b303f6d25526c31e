//! Plans for seven in a V over random maps: how many are found, how fast, and how good they are, beside the widest footprint alone
//! and RRT*. `cargo run --release --locked -p planning --example maps [MAPS]`

use planning::{PlanRequest, RrtEffort, TravelLimits, plan, rrt_star, trial};
use std::time::Instant;

/// What one planner did on one kind of maps.
#[derive(Default)]
struct Row {
    seconds: Vec<f64>,
    costs: Vec<f64>,
    lengths: Vec<f64>,
    durations: Vec<f64>,
    expansions: Vec<f64>,
    smoothed: usize,
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

impl Row {
    fn print(&self, name: &str, maps: u64) {
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
        let most = self.seconds.iter().copied().fold(0.0, f64::max);
        println!(
            "  {name:<22} {:>3} of {maps}  median {:>6.1} ms  worst {:>6.1} ms  cost {:>5.1}  length {:>5.1} m  {:>5.1} s  {:>6.0} steps  smoothed {}",
            self.costs.len(),
            1e3 * median(&self.seconds),
            1e3 * most,
            mean(&self.costs),
            mean(&self.lengths),
            mean(&self.durations),
            median(&self.expansions),
            self.smoothed,
        );
    }
}

fn main() {
    let maps = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(100);
    let vee = trial::vee();
    let widest = vee.with_levels(0..1);
    for count in [20, 50, 100] {
        println!("{count} obstacles, {maps} maps");
        let variants = [
            ("all levels", &vee, true),
            ("all levels, no smoothing", &vee, false),
            ("the shape only", &widest, true),
        ];
        for (name, model, smooths) in variants {
            let mut row = Row::default();
            for seed in 0..maps {
                let map = trial::map(seed, count);
                let mut request = PlanRequest::new(&map, model, TravelLimits::default(), trial::mission());
                request.effort.smooths = smooths;
                let begun = Instant::now();
                let found = plan(&request, &mut |_| false);
                row.seconds.push(begun.elapsed().as_secs_f64());
                match found {
                    Ok(plan) => {
                        row.costs.push(plan.cost);
                        row.lengths.push(plan.length());
                        row.durations.push(plan.duration());
                        row.expansions.push(plan.expansions as f64);
                        row.smoothed += usize::from(plan.smoothed);
                    }
                    Err(error) if name == "all levels" => println!("  seed {seed}: {error}"),
                    Err(_) => {}
                }
            }
            row.print(name, maps);
        }
        let mut row = Row::default();
        let few = maps.min(20);
        for seed in 0..few {
            let map = trial::map(seed, count);
            let request = PlanRequest::new(&map, &vee, TravelLimits::default(), trial::mission());
            let begun = Instant::now();
            let found = rrt_star(&request, &RrtEffort { seed, ..RrtEffort::default() });
            row.seconds.push(begun.elapsed().as_secs_f64());
            if let Some(plan) = found {
                row.costs.push(plan.cost);
                row.lengths.push(plan.length());
                row.durations.push(plan.duration());
                row.expansions.push(plan.expansions as f64);
            }
        }
        row.print("RRT*", few);
    }
}
