//! Plans for seven in a V over random maps: how many are found, how fast, and how good they are, beside the widest footprint alone
//! and RRT*. `cargo run --release --locked -p planning --example maps [MAPS]`

use planning::{
    FormationModel, MotionPlan, PlanError, PlanRequest, RrtEffort, TravelLimits, plan, rrt_star, trial,
};
use std::time::Instant;

/// What one planner did on one kind of maps.
#[derive(Default)]
struct Row {
    seconds: Vec<f64>,
    plans: Vec<MotionPlan>,
    errors: Vec<PlanError>,
}

impl Row {
    fn plan(&mut self, request: &PlanRequest<'_>) {
        let begun = Instant::now();
        let found = plan(request, &mut |_| false);
        self.seconds.push(begun.elapsed().as_secs_f64());
        match found {
            Ok(plan) => self.plans.push(plan),
            Err(error) => self.errors.push(error),
        }
    }

    fn print(&self, name: &str) {
        let n = self.plans.len();
        let mean = |of: &dyn Fn(&MotionPlan) -> f64| self.plans.iter().map(of).sum::<f64>() / n as f64;
        let mut sorted = self.seconds.clone();
        sorted.sort_by(f64::total_cmp);
        let [median, worst] = [sorted.len() / 2, sorted.len() - 1].map(|k| 1e3 * sorted[k]);
        print!("  {name:<26} {n:>3} of {:<3}  {median:>6.1} ms, at most {worst:>6.1} ms", sorted.len());
        if n > 0 {
            print!("  cost {:>5.1}", mean(&|plan| plan.cost));
            print!("  {:>5.1} m", mean(&MotionPlan::length));
            print!("  {:>5.1} s", mean(&MotionPlan::duration));
            print!("  smoothed {}", self.plans.iter().filter(|plan| plan.smoothed).count());
        }
        println!();
    }
}

/// Plans over the maps of one number of obstacles.
fn over(maps: u64, count: usize, model: &FormationModel, smooths: bool) -> Row {
    let mut row = Row::default();
    for seed in 0..maps {
        let map = trial::map(seed, count);
        let mut request = PlanRequest::new(&map, model, TravelLimits::default(), trial::mission());
        request.effort.smooths = smooths;
        row.plan(&request);
    }
    row
}

/// The same with RRT*.
fn over_with_rrt(maps: u64, count: usize, model: &FormationModel) -> Row {
    let mut row = Row::default();
    for seed in 0..maps {
        let map = trial::map(seed, count);
        let request = PlanRequest::new(&map, model, TravelLimits::default(), trial::mission());
        let begun = Instant::now();
        let found = rrt_star(&request, &RrtEffort { seed, ..RrtEffort::default() });
        row.seconds.push(begun.elapsed().as_secs_f64());
        row.plans.extend(found);
    }
    row
}

/// How long it takes to build a map of 400 m by 400 m with ten thousand obstacles, and to plan over it.
fn ten_thousand(model: &FormationModel) {
    let begun = Instant::now();
    let map = trial::spread(1, 10_000, 400.0);
    println!(
        "10000 obstacles on 400 m by 400 m, drawn and indexed in {:.0} ms",
        1e3 * begun.elapsed().as_secs_f64()
    );
    let mut row = Row::default();
    let mut mission = trial::mission();
    row.plan(&PlanRequest::new(&map, model, TravelLimits::default(), mission));
    row.print("33 m");
    let mut row = Row::default();
    mission.goal.position = [370.0, 370.0];
    mission.goal.level = None;
    row.plan(&PlanRequest::new(&map, model, TravelLimits::default(), mission));
    row.print("510 m");
    row.errors.iter().for_each(|error| println!("    {error}"));
}

fn main() {
    let maps = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(100);
    let vee = trial::vee();
    for count in [20, 50, 100] {
        println!("{count} obstacles on 40 m by 40 m");
        let found = over(maps, count, &vee, true);
        found.print("all levels");
        over(maps, count, &vee, false).print("all levels, not smoothed");
        over(maps, count, &vee.with_levels(0..1), true).print("the widest only");
        over_with_rrt(maps.min(20), count, &vee).print("RRT*");
        found.errors.iter().for_each(|error| println!("    {error}"));
    }
    println!("250 obstacles on 40 m by 40 m: most have no way");
    let found = over(maps, 250, &vee, true);
    found.print("all levels");
    found.errors.iter().take(5).for_each(|error| println!("    {error}"));
    ten_thousand(&vee);
}
