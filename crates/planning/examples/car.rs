//! Plans for a single car on one of the trial's maps and prints the map with the plan as JSON, for `tests/planners`, where other
//! planners get the same map. `cargo run --release --locked -p planning --example car OBSTACLES SEED [forwards]`

use planning::{
    BodyShape, Convex, FormationModel, MotionPlan, PlanGoal, PlanRequest, TravelLimits, plan, trial,
};
use std::fmt::Write;
use std::time::Instant;
use vocabulary::{Pose, math};

/// The car of PythonRobotics at half its size, m; its reference point is the middle of its rear axle.
const BODY: BodyShape = BodyShape::Rectangle { front: 1.65, back: 0.5, half_width: 0.5 };
const WHEELBASE: f64 = 1.5;
/// How far its wheels steer, rad.
const STEERING: f64 = 0.6;
/// The end is met this well, m and rad: other planners meet it exactly.
const TOLERANCE: f64 = 0.01;
/// Plans are the same every time; the time is the least of so many.
const TIMES: usize = 3;

/// Numbers as JSON, in brackets.
fn list(numbers: &[f64]) -> String {
    let texts: Vec<_> = numbers.iter().map(f64::to_string).collect();
    format!("[{}]", texts.join(","))
}

/// Anything as JSON, in brackets.
fn lists<T>(all: impl IntoIterator<Item = T>, of: impl Fn(T) -> String) -> String {
    let texts: Vec<_> = all.into_iter().map(of).collect();
    format!("[{}]", texts.join(","))
}

fn convex(body: &Convex) -> String {
    let corners = lists(body.corners(), |corner| list(&corner));
    format!("{{\"corners\":{corners},\"radius\":{}}}", body.radius())
}

fn pose(pose: &Pose) -> String {
    list(&[pose.x, pose.y, pose.heading])
}

/// Where the plan goes, and how.
fn found(plan: &MotionPlan) -> String {
    let poses = lists(&plan.points, |point| pose(&point.pose));
    let backwards = lists(&plan.legs, |leg| leg.backwards.to_string());
    format!("{{\"duration\":{},\"backwards\":{backwards},\"poses\":{poses}}}", plan.duration())
}

/// The plan, if there is one, and how long it took, s.
fn timed(request: &PlanRequest<'_>) -> (Result<MotionPlan, String>, f64) {
    let begun = Instant::now();
    let found = plan(request, &mut |_| false).map_err(|error| error.to_string());
    (found, begun.elapsed().as_secs_f64())
}

fn main() {
    let number = |index: usize| std::env::args().nth(index).and_then(|text| text.parse::<u64>().ok());
    let (Some(count), Some(seed)) = (number(1), number(2)) else {
        eprintln!("Usage: car OBSTACLES SEED [forwards]");
        std::process::exit(2);
    };
    let reverses = std::env::args().nth(3).is_none_or(|text| text != "forwards");
    let map = trial::map(seed, usize::try_from(count).unwrap_or(usize::MAX));
    let model = FormationModel::alone(BODY).unwrap_or_else(|error| unreachable!("{error}"));
    let (sin, cos) = math::sin_cos(STEERING);
    let radius = WHEELBASE * cos / sin;
    let limits = TravelLimits { curvature: 1.0 / radius, reverses, ..TravelLimits::default() };
    let mut mission = trial::mission();
    mission.goal = PlanGoal { tolerance: TOLERANCE, heading_tolerance: TOLERANCE, ..mission.goal };
    let request = PlanRequest::new(&map, &model, limits, mission);
    let (answer, mut seconds) = timed(&request);
    for _ in 1..TIMES {
        seconds = timed(&request).1.min(seconds);
    }
    let BodyShape::Rectangle { front, back, half_width } = BODY else { unreachable!("a car is a rectangle") };
    let goal = mission.goal;
    let end = Pose::new(goal.position[0], goal.position[1], goal.heading.unwrap_or_default());
    let mut text = String::new();
    let written = write!(
        text,
        "{{\"count\":{count},\"seed\":{seed},\"clearance\":{},\"front\":{front},\"back\":{back},\
         \"half_width\":{half_width},\"wheelbase\":{WHEELBASE},\"steering\":{STEERING},\"radius\":{radius},\
         \"start\":{},\"goal\":{},\"ground\":{},\"obstacles\":{},\"seconds\":{seconds},\"plan\":{},\"reason\":{:?}}}",
        map.clearance(),
        pose(&mission.start.pose),
        pose(&end),
        lists(map.ground().corners(), |corner| list(&corner)),
        lists(map.obstacles(), convex),
        answer.as_ref().map_or("null".into(), found),
        answer.err().unwrap_or_default(),
    );
    written.unwrap_or_else(|error| unreachable!("{error}"));
    println!("{text}");
}
