//! Plans for seven in a hexagon through the forest of Swarm-Formation's `normal_hexagon.launch`, and says how much of the hexagon is
//! left on the way by the measure of that project. `cargo run --release --locked -p planning --example hexagon [SEEDS]`
//!
//! L. Quan, L. Yin, C. Xu, F. Gao, *Distributed Swarm Trajectory Optimization for Formation Flight in Dense Environments*, ICRA 2022,
//! arXiv 2109.07682. Numbers are those of github.com/ZJU-FAST-Lab/Swarm-Formation at commit 967a4bd: `normal_hexagon.launch`,
//! `run_in_sim.launch`, `normal_hexagon.yaml`, `random_forest_sensing.cpp`, `swarm_graph.cpp`.

use planning::trial::Draws;
use planning::{
    BodyShape, Convex, FollowerModel, FormationModel, Map, Mission, MotionPlan, PlanGoal, PlanPoint,
    PlanRequest, PlanStart, TravelLimits, plan,
};
use std::time::Instant;
use vocabulary::{PathFilter, Pose, math};

/// The forest, m: cylinders and rings stand on so much ground, in the middle of that on which robots move.
const FOREST: [f64; 2] = [34.0, 15.0];
const GROUND: [f64; 2] = [70.0, 30.0];
const CYLINDERS: usize = 60;
const RINGS: usize = 20;
/// Where robots start and end: the middle of the hexagon, ahead of the forest and behind it, m.
const ENDS: [f64; 2] = [-26.0, 26.0];
/// The height at which they fly, and how far above and below it they reach, m.
const HEIGHT: f64 = 0.5;
const TALL: f64 = 0.25;
/// Of the points that obstacles are drawn by, m: how thick a ring is.
const RESOLUTION: f64 = 0.1;
/// How near to obstacles the middles of robots may come, m, and the part of it that is the robot. Their planner pushes robots away
/// from 0.5 m on (`obstacle_clearance`), and takes obstacles to be larger by 0.1 m (`obstacles_inflation`).
const PUSHED: [f64; 2] = [0.5, 0.25];
const INFLATED: [f64; 2] = [0.1, 0.1];
/// Levels from the hexagon to the column: over fewer, and so over less way, robots would have to move too fast.
const STEPS: usize = 8;
/// Places of robots 1 to 6 in the hexagon, [forward, left] of robot 0, m.
const HEXAGON: [[f64; 2]; 6] = [[2.6, -1.5], [0.0, -3.0], [-2.6, -1.5], [-2.6, 1.5], [0.0, 3.0], [2.6, 1.5]];

/// What of a ring stands in the way of robots that cannot rise.
#[derive(Clone, Copy, PartialEq)]
enum Rings {
    /// What of it is at the height at which they fly.
    AtHeight,
    /// Its whole width, as if it were a wall.
    Walls,
}

/// A way of posing the problem.
struct ForestCase {
    name: &'static str,
    /// Width of the ground, m.
    width: f64,
    rings: Rings,
    /// [`PUSHED`] or [`INFLATED`].
    near: [f64; 2],
    levels: usize,
}

/// As their generator draws it: cylinders 0.8 m apart at least, upright rings that look along x within 0.5 rad.
fn forest(seed: u64, case: &ForestCase) -> Map {
    let mut draws = Draws::new(seed);
    let snapped = |value: f64| ((value / RESOLUTION).floor() + 0.5) * RESOLUTION;
    let mut middles: Vec<[f64; 2]> = vec![];
    let mut obstacles = vec![];
    while middles.len() < CYLINDERS {
        let [x, y] = FOREST.map(|size| draws.between(-0.5 * size, 0.5 * size));
        let radius = 0.5 * 0.5 * draws.between(0.5, 1.5);
        if middles.iter().any(|at| math::hypot(at[0] - x, at[1] - y) < 0.8) {
            continue;
        }
        middles.push([x, y]);
        obstacles.push(Convex::disc([snapped(x), snapped(y)], radius));
    }
    for _ in 0..RINGS {
        let [x, y] = FOREST.map(|size| snapped(draws.between(-0.5 * size, 0.5 * size)));
        let z = snapped(draws.between(0.7, 3.0));
        let pose = Pose::new(x, y, draws.between(-0.5, 0.5));
        let [across, upright] = [(); 2].map(|()| draws.between(1.0, 1.2));
        for [from, to] in crossed(case.rings, z, across, upright) {
            let [x, y] = pose.world_from_body(0.0, 0.5 * (from + to));
            let half = [0.5 * RESOLUTION, 0.5 * (to - from + RESOLUTION)];
            obstacles.push(Convex::rectangle(Pose::new(x, y, pose.heading), half));
        }
    }
    let obstacles = obstacles.into_iter().collect::<Result<_, _>>();
    let ground = Convex::rectangle(Pose::default(), [0.5 * GROUND[0], 0.5 * case.width]);
    let map = obstacles.and_then(|obstacles| Map::new(ground?, obstacles, case.near[0] - case.near[1]));
    map.unwrap_or_else(|error| unreachable!("{error}"))
}

/// From where to where a ring stands in the way, along its width from its middle, m.
fn crossed(rings: Rings, middle: f64, across: f64, upright: f64) -> Vec<[f64; 2]> {
    // Half the width of the ring at a height, none above and below it.
    let wide = |height: f64| {
        let share = (height - middle) / upright;
        (share.abs() <= 1.0).then(|| across * (1.0 - share * share).sqrt())
    };
    let [low, high] = [HEIGHT - TALL, HEIGHT + TALL];
    // Rings hang so high that they are widest at the top of these heights, or within them.
    match (rings, wide(low), wide(high)) {
        (Rings::Walls, ..) => vec![[-across, across]],
        (_, Some(low), Some(high)) => {
            let most = if middle < HEIGHT + TALL { across } else { high };
            let least = low.min(high);
            vec![[-most, -least], [least, most]]
        }
        (_, None, Some(high)) => vec![[-high, high]],
        _ => vec![],
    }
}

/// Robot 0 leads in the middle. In the column two drive ahead of it, and four behind, of which the last follows the one before it.
fn hexagon(radius: f64) -> FormationModel {
    let body = BodyShape::Disc { radius };
    let gap = 2.0 * radius + 0.7;
    // Robot, number of its leader, how many gaps it is ahead of that in the column.
    let order = [(5, 0, -1.0), (2, 0, -2.0), (4, 0, -3.0), (3, 3, -1.0), (6, 0, 1.0), (1, 0, 2.0)];
    let follower = |(robot, leader, ahead): (usize, usize, f64)| {
        let at = |robot: usize| if robot == 0 { [0.0; 2] } else { HEXAGON[robot - 1] };
        let from = at(if leader == 0 { 0 } else { order[leader - 1].0 });
        let wide = [0, 1].map(|k| at(robot)[k] - from[k]);
        FollowerModel::narrowing(leader, [wide, [ahead * gap, 0.0]], STEPS, body)
            .with_heading(Some(PathFilter { length: 1.0, lag: 1.0 }))
    };
    let followers = order.into_iter().map(follower).collect();
    FormationModel::new(body, followers).unwrap_or_else(|error| unreachable!("{error}"))
}

/// Theirs of speed; the others are those of ground robots.
fn limits() -> TravelLimits {
    TravelLimits {
        speed: 1.5,
        outer: 1.5,
        turning: 0.75,
        acceleration: 1.0,
        braking: 1.0,
        place_rate: 0.5,
        place_acceleration: 0.8,
        ..TravelLimits::default()
    }
}

fn squared(value: f64) -> f64 {
    value * value
}

/// The symmetric normalized Laplacian, edges weighted by squared distances: `SwarmGraph::calcMatrices`.
fn laplacian(places: &[[f64; 2]]) -> Vec<Vec<f64>> {
    let square = |a: &[f64; 2], b: &[f64; 2]| squared(a[0] - b[0]) + squared(a[1] - b[1]);
    let degrees: Vec<f64> = places.iter().map(|a| places.iter().map(|b| square(a, b)).sum()).collect();
    let entry = |i: usize, j: usize| {
        let weight = square(&places[i], &places[j]);
        if i == j { 1.0 } else { -weight / (degrees[i] * degrees[j]).sqrt() }
    };
    (0..places.len()).map(|i| (0..places.len()).map(|j| entry(i, j)).collect()).collect()
}

/// ‖L̂ − L̂_des‖²: `SwarmGraph::calcFNorm2`. Nothing for a shape that is moved, turned, mirrored or scaled.
fn similarity_error(places: &[[f64; 2]], desired: &[[f64; 2]]) -> f64 {
    let (found, wanted) = (laplacian(places), laplacian(desired));
    found.iter().flatten().zip(wanted.iter().flatten()).map(|(a, b)| squared(a - b)).sum()
}

/// How far robots are off the shape, moved and turned to fit best, root mean square, m.
fn distance_error(places: &[[f64; 2]], desired: &[[f64; 2]]) -> f64 {
    let n = places.len() as f64;
    let centred = |all: &[[f64; 2]]| {
        let mean = [0, 1].map(|k| all.iter().map(|at| at[k]).sum::<f64>() / n);
        all.iter().map(|at| [at[0] - mean[0], at[1] - mean[1]]).collect::<Vec<_>>()
    };
    let (a, b) = (centred(places), centred(desired));
    let squares = |all: &[[f64; 2]]| all.iter().map(|[x, y]| x * x + y * y).sum::<f64>();
    let sum = |of: &dyn Fn([f64; 2], [f64; 2]) -> f64| a.iter().zip(&b).map(|(a, b)| of(*a, *b)).sum::<f64>();
    let along = sum(&|a, b| a[0] * b[0] + a[1] * b[1]);
    let across = sum(&|a, b| a[0] * b[1] - a[1] * b[0]);
    ((squares(&a) + squares(&b) - 2.0 * math::hypot(along, across)).max(0.0) / n).sqrt()
}

/// Mean over time, and largest, of a measure along a plan.
fn over_time(plan: &MotionPlan, of: &dyn Fn(&[[f64; 2]]) -> f64) -> [f64; 2] {
    let places = |point: &PlanPoint| point.robots.iter().map(|pose| [pose.x, pose.y]).collect::<Vec<_>>();
    let values: Vec<f64> = plan.points.iter().map(|point| of(&places(point))).collect();
    let spans = plan.points.windows(2).map(|pair| pair[1].time - pair[0].time);
    let area: f64 = spans.zip(values.windows(2)).map(|(span, pair)| span * 0.5 * (pair[0] + pair[1])).sum();
    [area / plan.duration(), values.iter().copied().fold(0.0, f64::max)]
}

/// Least distance between two robots, from middle to middle, m.
fn nearest(places: &[[f64; 2]]) -> f64 {
    let mut least = f64::INFINITY;
    for (k, a) in places.iter().enumerate() {
        for b in &places[..k] {
            least = least.min(math::hypot(a[0] - b[0], a[1] - b[1]));
        }
    }
    least
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Plans over all forests and prints a row of the table.
fn row(case: &ForestCase, seeds: u64) {
    let model = hexagon(case.near[1]).with_levels(0..case.levels);
    let desired: Vec<[f64; 2]> = model.places(0);
    let start = PlanStart::at(Pose::new(ENDS[0], 0.0, 0.0));
    let mission = Mission { start, goal: PlanGoal::at(Pose::new(ENDS[1], 0.0, 0.0)).at_level(0) };
    let (mut plans, mut seconds) = (vec![], vec![]);
    for seed in 1..=seeds {
        let map = forest(seed, case);
        let request = PlanRequest::new(&map, &model, limits(), mission);
        let begun = Instant::now();
        let found = plan(&request, &mut |_| false);
        seconds.push(1e3 * begun.elapsed().as_secs_f64());
        plans.extend(found);
    }
    let similarity: Vec<_> =
        plans.iter().map(|plan| over_time(plan, &|places| similarity_error(places, &desired))).collect();
    let distance: Vec<_> =
        plans.iter().map(|plan| over_time(plan, &|places| distance_error(places, &desired))).collect();
    let least = plans.iter().map(|plan| -over_time(plan, &|places| 1e3 - nearest(places))[1] + 1e3);
    let least = least.fold(f64::INFINITY, f64::min);
    let aside = |plan: &MotionPlan| plan.points.iter().map(|point| point.pose.y.abs()).fold(0.0, f64::max);
    let round = plans.iter().filter(|plan| aside(plan) > 0.5 * FOREST[1]).count();
    let worst = seconds.iter().copied().fold(0.0, f64::max);
    print!("| {} | {} of {seeds} | {round} ", case.name, plans.len());
    print!("| {:.0} ms, {worst:.0} ms ", median(seconds.into_iter()));
    if plans.is_empty() {
        println!("| | | | | |");
        return;
    }
    print!("| {:.1} m ", median(plans.iter().map(MotionPlan::length)));
    print!("| {:.1} s ", median(plans.iter().map(MotionPlan::duration)));
    for (errors, digits, unit) in [(&similarity, 4, ""), (&distance, 2, " m")] {
        let [mean, most] = [0, 1].map(|k| median(errors.iter().map(|error| error[k])));
        print!("| {mean:.digits$}{unit}, {most:.digits$}{unit} ");
    }
    println!("| {least:.2} m |");
}

fn main() {
    let seeds = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(20);
    let model = hexagon(PUSHED[1]);
    let (column, desired) = (model.places(STEPS), model.places(0));
    println!(
        "Column instead of hexagon: similarity error {:.4}, {:.2} m off it\n",
        similarity_error(&column, &desired),
        distance_error(&column, &desired)
    );
    let case = |name, width, rings, near, levels| ForestCase { name, width, rings, near, levels };
    let [wide, narrow] = [GROUND[1], FOREST[1]];
    let all = STEPS + 1;
    let cases = [
        case("as launched", wide, Rings::AtHeight, PUSHED, all),
        case("as launched, hexagon only", wide, Rings::AtHeight, PUSHED, 1),
        case("no way around", narrow, Rings::AtHeight, PUSHED, all),
        case("no way around, hexagon only", narrow, Rings::AtHeight, PUSHED, 1),
        case("no way around, rings are walls", narrow, Rings::Walls, PUSHED, all),
        case("no way around, 0.1 m", narrow, Rings::AtHeight, INFLATED, all),
        case("no way around, 0.1 m, hexagon only", narrow, Rings::AtHeight, INFLATED, 1),
        case("no way around, 0.1 m, rings are walls", narrow, Rings::Walls, INFLATED, all),
    ];
    println!(
        "| forest | found | go around | computing | length | duration | similarity error | off the hexagon | apart |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for case in &cases {
        row(case, seeds);
    }
}
