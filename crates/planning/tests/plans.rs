//! Plans for formations over random maps, held against an independent simulation and against the properties that they promise.

use planning::{
    BodyShape, Boundary, Convex, FollowerModel, FormationModel, InputError, Leg, Map, Mission, MotionPlan,
    NoWayReason, PlanError, PlanGoal, PlanRequest, PlanStart, TravelLimits, plan, plan_tour, trial,
};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use vocabulary::{Pose, math, wrap};

fn vee_plan(map: &Map) -> Result<MotionPlan, PlanError> {
    plan(&PlanRequest::new(map, &trial::vee(), TravelLimits::default(), trial::mission()), &mut |_| false)
}

fn no_way(found: Result<MotionPlan, PlanError>) -> planning::NoWay {
    match found {
        Err(PlanError::NoWay(no_way)) => *no_way,
        Err(error) => panic!("{error}"),
        Ok(plan) => panic!("a plan of {} m", plan.length()),
    }
}

/// A walk over legs by small steps: the lead by its curvature, followers by the differential equations of their held headings, with
/// the velocity of every robot for its heading. Nothing of the planner's own walk is used.
struct Walk {
    lead: Pose,
    /// θ̄ and κ̄ of every follower.
    held: Vec<[f64; 2]>,
    positions: Vec<[f64; 2]>,
    /// Velocity per speed of the lead.
    velocities: Vec<[f64; 2]>,
    /// Way of the lead in a step, m.
    step: f64,
}

impl Walk {
    fn new(model: &FormationModel, lead: Pose) -> Self {
        let n = model.robots();
        let held = vec![[lead.heading, 0.0]; n - 1];
        Self { lead, held, positions: vec![[0.0; 2]; n], velocities: vec![[0.0; 2]; n], step: 0.0 }
    }

    fn place(&mut self, model: &FormationModel, level: f64, rate: f64) {
        let (sin, cos) = math::sin_cos(self.lead.heading);
        self.positions[0] = [self.lead.x, self.lead.y];
        self.velocities[0] = [cos, sin];
        for (k, follower) in model.followers().iter().enumerate() {
            let below = (level as usize).min(model.levels() - 1);
            let [a, b] = [below, (below + 1).min(model.levels() - 1)].map(|level| follower.places[level]);
            let share = level - below as f64;
            let [x, y] = [0, 1].map(|i| a[i] + share * (b[i] - a[i]));
            let [dx, dy] = [0, 1].map(|i| rate * (b[i] - a[i]));
            let turn = self.turn(model, k);
            let (sin, cos) = math::sin_cos(self.held[k][0]);
            let [px, py] = [cos * x - sin * y, sin * x + cos * y];
            let leader = follower.leader;
            self.positions[k + 1] = [self.positions[leader][0] + px, self.positions[leader][1] + py];
            let own = [cos * dx - sin * dy - turn * py, sin * dx + cos * dy + turn * px];
            self.velocities[k + 1] = [0, 1].map(|i| self.velocities[leader][i] + own[i]);
        }
    }

    /// dθ̄ per metre of the lead. Without a filter θ̄ is the direction in which the leader drives.
    fn turn(&mut self, model: &FormationModel, follower: usize) -> f64 {
        let of = &model.followers()[follower];
        if of.heading.is_some() {
            return self.held_rate(model, follower)[0];
        }
        let [vx, vy] = self.velocities[of.leader];
        let (before, now) = (self.held[follower][0], math::atan2(vy, vx));
        self.held[follower][0] = now;
        if self.step > 0.0 { wrap(now - before) / self.step } else { 0.0 }
    }

    /// dθ̄ and dκ̄ per metre of the lead.
    fn held_rate(&self, model: &FormationModel, follower: usize) -> [f64; 2] {
        let of = &model.followers()[follower];
        let Some(filter) = of.heading else { return [0.0; 2] };
        let [vx, vy] = self.velocities[of.leader];
        let (length, lag) = (filter.length, filter.lag);
        let speed = math::hypot(vx, vy);
        let [held, kappa] = self.held[follower];
        let e = wrap(math::atan2(vy, vx) - held);
        let share = 1.0 - lag / length;
        let turn = kappa + (2.0 * length - lag) / (length * length) * e;
        [speed * turn, speed * (share * share * e - lag * kappa) / (length * length)]
    }

    /// Walks a leg and visits every step, with the curvature and the way gone.
    fn leg(&mut self, model: &FormationModel, leg: &Leg, visit: &mut dyn FnMut(&Self, f64)) {
        for pair in leg.knots.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let span = b.way - a.way;
            let steps = (span / 2e-3).ceil();
            let step = span / steps;
            self.step = step;
            for k in 0..steps as usize {
                let share = (k as f64 + 0.5) / steps;
                let curvature = a.curvature + share * (b.curvature - a.curvature);
                let level = a.level + share * share * (3.0 - 2.0 * share) * (b.level - a.level);
                let rate = 6.0 * share * (1.0 - share) * (b.level - a.level) / span;
                let direction = leg.direction();
                let heading = self.lead.heading + 0.5 * direction * step * curvature;
                let (sin, cos) = math::sin_cos(heading);
                self.lead.x += direction * step * cos;
                self.lead.y += direction * step * sin;
                self.lead.heading += direction * step * curvature;
                self.place(model, level, rate);
                for follower in 0..self.held.len() {
                    let rate = self.held_rate(model, follower);
                    for (value, rate) in self.held[follower].iter_mut().zip(rate) {
                        *value += step * rate;
                    }
                }
                visit(self, step);
            }
        }
    }
}

fn clearance(map: &Map, model: &FormationModel, walk: &Walk) -> f64 {
    let of = |robot: usize| {
        let BodyShape::Disc { radius } = model.body(robot) else { panic!("discs only") };
        let point = walk.positions[robot];
        let obstacles = map.obstacles().iter().map(|obstacle| obstacle.distance(point));
        obstacles.fold(-map.ground().distance(point), f64::min) - radius
    };
    (0..model.robots()).map(of).fold(f64::INFINITY, f64::min)
}

/// Least clearance and the largest speed of a follower, m/s, on the way of a plan.
fn walked(map: &Map, model: &FormationModel, plan: &MotionPlan) -> [f64; 2] {
    let mut walk = Walk::new(model, plan.legs[0].start);
    let (mut least, mut fastest) = (f64::INFINITY, 0.0_f64);
    let (mut count, mut gone) = (0, 0.0);
    for leg in &plan.legs {
        walk.leg(model, leg, &mut |walk, step| {
            count += 1;
            let speed = plan.at_way(gone + 0.5 * step).map_or(0.0, |point| point.speed.abs());
            gone += step;
            if count % 10 == 0 {
                least = least.min(clearance(map, model, walk));
            }
            let followers = walk.velocities[1..].iter();
            fastest = followers.fold(fastest, |most, [x, y]| most.max(speed * math::hypot(*x, *y)));
        });
    }
    [least, fastest]
}

#[test]
fn nothing_is_touched_and_no_limit_exceeded() {
    let (model, limits) = (trial::vee(), TravelLimits::default());
    for (seed, count, smooths) in [
        (0, 20, true),
        (1, 50, true),
        (2, 50, false),
        (3, 100, true),
        (4, 100, true),
        (5, 100, false),
        (6, 100, false),
        (7, 100, false),
        (8, 100, true),
    ] {
        let map = trial::map(seed, count);
        let mut request = PlanRequest::new(&map, &model, limits, trial::mission());
        request.effort.smooths = smooths;
        let plan = plan(&request, &mut |_| false).unwrap_or_else(|error| panic!("{seed} {count}: {error}"));
        assert!(plan.smoothed == smooths, "{seed} {count}");
        let [least, fastest] = walked(&map, &model, &plan);
        println!("{seed} {count}: clearance {least:.4} m, fastest {fastest:.3} m/s");
        assert!(least >= trial::CLEARANCE, "{seed} {count}: {least}");
        assert!(fastest <= limits.outer, "{seed} {count}: {fastest}");
        within_limits(&plan, &limits);
        reaches(&plan, &trial::mission());
    }
}

/// Curvature, sharpness, speeds and accelerations of a plan.
fn within_limits(plan: &MotionPlan, limits: &TravelLimits) {
    for leg in &plan.legs {
        for pair in leg.knots.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let sharpness = (b.curvature - a.curvature).abs() / (b.way - a.way);
            assert!(sharpness <= limits.sharpness * (1.0 + 1e-6), "{sharpness}");
            assert!(b.curvature.abs() <= limits.curvature * (1.0 + 1e-9));
        }
    }
    for pair in plan.points.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let way = b.way - a.way;
        if way <= 0.0 {
            continue;
        }
        let rise = (b.speed * b.speed - a.speed * a.speed) / (2.0 * way);
        assert!(rise <= limits.acceleration + 1e-9 && rise >= -limits.braking - 1e-9, "{rise}");
        let speed = a.speed.abs().max(b.speed.abs());
        assert!(speed <= limits.speed + 1e-12);
        let steering = (b.curvature - a.curvature).abs() / way * speed;
        assert!(steering <= limits.steering * (1.0 + 1e-9), "{steering}");
        assert!(a.curvature.abs().max(b.curvature.abs()) * speed * speed <= limits.lateral * (1.0 + 1e-9));
        let moved = |robot: usize| {
            let [p, q] = [a.robots[robot], b.robots[robot]];
            math::hypot(q.x - p.x, q.y - p.y)
        };
        // Followers' ways are chords of at most an eighth of a metre of the lead.
        let outer = (1..a.robots.len()).map(moved).fold(0.0, f64::max) / way * speed;
        assert!(outer <= limits.outer * (1.0 + 1e-6), "{outer}");
        assert!(b.time > a.time);
    }
}

fn reaches(plan: &MotionPlan, mission: &Mission) {
    let (first, last) = (&plan.points[0], &plan.points[plan.points.len() - 1]);
    let start = mission.start.pose;
    assert_eq!([first.pose.x, first.pose.y, first.pose.heading], [start.x, start.y, start.heading]);
    let goal = mission.goal;
    assert!(math::hypot(last.pose.x - goal.position[0], last.pose.y - goal.position[1]) <= goal.tolerance);
    if let Some(heading) = goal.heading {
        assert!(wrap(last.pose.heading - heading).abs() <= goal.heading_tolerance);
    }
    if let Some(level) = goal.level {
        assert_eq!(last.level, level as f64);
    }
    assert_eq!(last.speed, 0.0);
}

/// A map with everything on it, moved by turning it about the origin and then shifting it.
fn moved(map: &Map, by: Pose) -> Map {
    let obstacles = map.obstacles().iter().map(|obstacle| obstacle.moved(by)).collect();
    Map::new(map.ground().moved(by), obstacles, map.clearance()).expect("a map")
}

#[test]
fn who_moves_and_turns_the_map_moves_the_plan() {
    let model = trial::vee();
    for (seed, by) in
        [(1, Pose::new(3.0, -7.0, 0.0)), (2, Pose::new(-11.3, 4.2, 1.234)), (3, Pose::new(0.1, 0.2, -2.5))]
    {
        let map = trial::map(seed, 50);
        let here = vee_plan(&map).expect("a plan");
        let mission = trial::mission();
        let there = |[x, y]: [f64; 2]| by.world_from_body(x, y);
        let pose = mission.start.pose;
        let [x, y] = there([pose.x, pose.y]);
        let start = PlanStart::at(Pose::new(x, y, wrap(pose.heading + by.heading)));
        let [x, y] = there(mission.goal.position);
        let goal = PlanGoal::at(Pose::new(x, y, wrap(FRAC_PI_4 + by.heading))).at_level(0);
        let elsewhere = moved(&map, by);
        let request = PlanRequest::new(&elsewhere, &model, TravelLimits::default(), Mission { start, goal });
        let found = plan(&request, &mut |_| false).expect("a plan");
        // The search's cells lie along the start: the plan is the same but for rounding.
        assert_eq!(found.expansions, here.expansions);
        assert!((found.length() - here.length()).abs() < 1e-6, "{} {}", found.length(), here.length());
        assert!((found.cost - here.cost).abs() < 1e-6);
        for (a, b) in here.points.iter().zip(&found.points) {
            let [x, y] = there([a.pose.x, a.pose.y]);
            assert!(math::hypot(x - b.pose.x, y - b.pose.y) < 1e-6);
        }
    }
}

/// A search by the weight w costs at most w times the best of its lattice. With an obstacle less that best is no dearer, and the
/// way of before is still there.
#[test]
fn without_an_obstacle_a_plan_costs_no_more_than_the_weight_allows() {
    for seed in [1, 4, 7] {
        let map = trial::map(seed, 60);
        let before = vee_plan(&map).expect("a plan");
        for obstacle in [0, 13, 29, 47] {
            let after = vee_plan(&map.without(obstacle)).expect("a plan");
            let weight = planning::SearchEffort::default().weights[0];
            assert!(after.searched_cost <= weight * before.searched_cost, "{seed} {obstacle}");
        }
    }
}

#[test]
fn the_same_request_gives_the_same_plan() {
    let digests: Vec<u64> = [(1, 20), (2, 100)]
        .iter()
        .map(|(seed, count)| {
            let map = trial::map(*seed, *count);
            let [first, second] = [vee_plan(&map), vee_plan(&map.clone())].map(|plan| plan.expect("a plan"));
            assert_eq!(first, second);
            first.digest()
        })
        .collect();
    assert_eq!(digests.iter().map(|digest| format!("{digest:016x}")).collect::<Vec<_>>(), DIGESTS);
}

/// Computed on x86-64; every other machine has to find the same.
const DIGESTS: [&str; 2] = ["85165c1f7ab52e7f", "cfb64fc2cfd80711"];

fn empty(side: f64) -> Map {
    let ground = Convex::rectangle(Pose::new(0.5 * side, 0.5 * side, 0.0), [0.5 * side; 2]).expect("a box");
    Map::new(ground, vec![], 0.25).expect("a map")
}

fn with(map: &Map, more: Vec<Convex>) -> Map {
    let obstacles = map.obstacles().iter().cloned().chain(more).collect();
    Map::new(map.ground().clone(), obstacles, map.clearance()).expect("a map")
}

fn block(x: [f64; 2], y: [f64; 2]) -> Convex {
    let middle = Pose::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 0.0);
    Convex::rectangle(middle, [0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0])]).expect("a box")
}

#[test]
fn over_empty_ground_the_way_is_straight() {
    let map = empty(40.0);
    let found = vee_plan(&map).expect("a plan");
    assert!((found.length() - 25.0 * 2.0_f64.sqrt()).abs() < 1e-6, "{}", found.length());
    assert!(found.points.iter().all(|point| point.level == 0.0 && point.curvature.abs() < 1e-9));
    let middle = found.at_time(0.5 * found.duration()).expect("a point");
    assert!((middle.way - 0.5 * found.length()).abs() < 1e-3 && (middle.speed - 0.8).abs() < 1e-9);
    assert_eq!(found.at_time(1e9).expect("a point").speed, 0.0);
    assert!((found.at_way(3.0).expect("a point").pose.x - 8.0 - 3.0 / 2.0_f64.sqrt()).abs() < 1e-9);
}

/// Two walls with a gate: seven file in through it and are in their V again behind it.
#[test]
fn a_formation_files_in_through_a_gate() {
    let map = with(&empty(40.0), vec![block([20.0, 20.4], [0.0, 19.2]), block([20.0, 20.4], [20.8, 40.0])]);
    let start = PlanStart::at(Pose::new(8.0, 20.0, 0.0));
    let goal = PlanGoal::at(Pose::new(35.0, 20.0, 0.0)).at_level(0);
    let (model, limits) = (trial::vee(), TravelLimits::default());
    let request = PlanRequest::new(&map, &model, limits, Mission { start, goal });
    let found = plan(&request, &mut |_| false).expect("a plan");
    let narrowest = found.points.iter().map(|point| point.level).fold(0.0, f64::max);
    assert!(narrowest >= 3.0, "{narrowest}");
    let [least, _] = walked(&map, &model, &found);
    assert!(least >= 0.25, "{least}");
    assert!(found.ahead > 0.0 && found.points.iter().all(|point| point.early_level >= point.level));
    within_limits(&found, &limits);
}

#[test]
fn what_is_wrong_with_the_ends_is_said() {
    let (map, model) = (empty(40.0), trial::vee());
    let ask = |map: &Map, start: Pose, goal: PlanGoal| {
        let mission = Mission { start: PlanStart::at(start), goal };
        plan(&PlanRequest::new(map, &model, TravelLimits::default(), mission), &mut |_| false)
    };
    let (here, there) = (Pose::new(10.0, 20.0, 0.0), PlanGoal::at(Pose::new(30.0, 20.0, 0.0)));
    assert_eq!(no_way(ask(&map, Pose::new(-1.0, 0.0, 0.0), there)).reason, NoWayReason::StartOutside);
    assert_eq!(no_way(ask(&map, here, PlanGoal::to([41.0, 3.0]))).reason, NoWayReason::GoalOutside);
    let rock = with(&map, vec![Convex::disc([30.1, 20.0], 0.5).expect("a disc")]);
    let found = no_way(ask(&rock, here, there));
    assert_eq!(found.reason, NoWayReason::GoalBlocked { by: Boundary::Obstacle(0) });
    assert_eq!(found.to_string(), "at the goal the lead is too near to obstacle 0");
    // A wing stands on a rock: in the column it would be free.
    let rock = with(
        &map,
        vec![Convex::disc([10.0 - 3.0 * 2.0_f64.sqrt(), 20.0 + 3.0 * 2.0_f64.sqrt()], 0.5).expect("a disc")],
    );
    let found = no_way(ask(&rock, here, there));
    assert_eq!(found.reason, NoWayReason::StartBlocked { robot: 5, by: Boundary::Obstacle(0) });
    assert_eq!(found.offer.expect("an offer").robots, 7);
}

#[test]
fn a_closed_ring_is_said_to_be_closed() {
    let ring = [
        block([25.0, 35.0], [14.0, 14.4]),
        block([25.0, 35.0], [26.0, 26.4]),
        block([25.0, 25.4], [14.0, 26.4]),
        block([34.6, 35.0], [14.0, 26.4]),
    ];
    let map = with(&empty(40.0), ring.to_vec());
    let mission =
        Mission { start: PlanStart::at(Pose::new(10.0, 20.0, 0.0)), goal: PlanGoal::to([30.0, 20.0]) };
    let model = trial::vee();
    let found =
        no_way(plan(&PlanRequest::new(&map, &model, TravelLimits::default(), mission), &mut |_| false));
    assert_eq!((found.reason, found.gap, found.expansions), (NoWayReason::LeadUnreachable, None, 0));
    // With a gap for nobody it is found and measured.
    let [low, high, left, right] = ring;
    drop(left);
    let gate = [low, high, right, block([25.0, 25.4], [14.0, 19.8]), block([25.0, 25.4], [20.2, 26.4])];
    let map = with(&empty(40.0), gate.to_vec());
    let found =
        no_way(plan(&PlanRequest::new(&map, &model, TravelLimits::default(), mission), &mut |_| false));
    let gap = found.gap.expect("a gap");
    assert_eq!(found.reason, NoWayReason::LeadUnreachable);
    assert!((gap.width - 0.4).abs() < 1e-9, "{gap:?}");
    let mut between = gap.between;
    between.sort_by_key(|boundary| if let Boundary::Obstacle(k) = boundary { *k } else { 0 });
    assert_eq!(between, [Boundary::Obstacle(3), Boundary::Obstacle(4)]);
}

#[test]
fn input_that_makes_no_sense_is_refused() {
    let (map, model) = (empty(40.0), trial::vee());
    let ask = |mission: Mission, limits: TravelLimits| {
        plan(&PlanRequest::new(&map, &model, limits, mission), &mut |_| false)
            .expect_err("refused")
            .to_string()
    };
    let mission = trial::mission();
    let limits = TravelLimits::default();
    let at = |goal: PlanGoal| Mission { goal, ..mission };
    assert_eq!(ask(at(PlanGoal::to([f64::NAN, 0.0])), limits), "the goal's x is not a finite number");
    assert_eq!(
        ask(at(mission.goal.at_level(7)), limits),
        "the goal asks for level 7, but the formation has levels 0 to 4"
    );
    assert_eq!(
        ask(at(PlanGoal::to([8.0, 4008.0])), limits),
        "the distance to the goal in m is 4000, but has to be at most 2000 m: set goals between"
    );
    let reverses = TravelLimits { reverses: true, ..limits };
    assert_eq!(
        ask(mission, reverses),
        "a formation of 7 robots cannot reverse: leave `reverses` to a robot alone"
    );
    let stands = TravelLimits { speed: 0.0, ..limits };
    assert_eq!(ask(mission, stands), "the speed is 0, but has to be positive, m/s");
    let request = PlanRequest::new(&map, &model, limits, mission);
    let tour = plan_tour(&request, &[], &mut |_| false).expect_err("refused");
    assert_eq!(tour.error, PlanError::Input(InputError::NoGoals));
}

#[test]
fn a_tour_stops_at_each_of_its_goals() {
    let (map, model) = (trial::map(11, 20), trial::vee());
    let request = PlanRequest::new(&map, &model, TravelLimits::default(), trial::mission());
    let goals = [PlanGoal::to([20.0, 20.0]), PlanGoal::at(Pose::new(33.0, 33.0, FRAC_PI_4))];
    let plans = plan_tour(&request, &goals, &mut |_| false).expect("plans");
    assert_eq!(plans.len(), 2);
    let end = plans[0].points.last().expect("a point");
    assert!(math::hypot(end.pose.x - 20.0, end.pose.y - 20.0) < 0.1);
    assert_eq!(plans[1].points[0].pose, end.pose);
}

/// A lane that ends: a robot alone drives in and parks by reversing; what only drives forwards cannot turn there.
#[test]
fn a_lone_car_reverses_where_it_may() {
    let map = with(&empty(20.0), vec![block([0.0, 20.0], [0.0, 9.0]), block([0.0, 20.0], [11.8, 20.0])]);
    let car = BodyShape::Rectangle { front: 0.5, back: 0.1, half_width: 0.15 };
    let model = FormationModel::alone(car).expect("a car");
    let limits = TravelLimits { curvature: 0.8, sharpness: 1.0, outer: 0.8, ..TravelLimits::default() };
    let start = PlanStart::at(Pose::new(10.0, 10.4, 0.0));
    let goal = PlanGoal::at(Pose::new(15.0, 10.4, PI));
    let ask = |limits: TravelLimits| {
        let mut request = PlanRequest::new(&map, &model, limits, Mission { start, goal });
        (request.effort.step, request.effort.cell) = (0.5, 0.25);
        plan(&request, &mut |_| false)
    };
    let found = ask(TravelLimits { reverses: true, ..limits }).expect("a plan");
    assert!(found.legs.len() >= 2 && found.legs.iter().any(|leg| leg.backwards));
    within_limits(&found, &limits);
    for point in &found.points {
        let body = Convex::rectangle(
            Pose {
                heading: point.pose.heading,
                ..Pose::new(
                    point.pose.world_from_body(0.2, 0.0)[0],
                    point.pose.world_from_body(0.2, 0.0)[1],
                    0.0,
                )
            },
            [0.3, 0.15],
        )
        .expect("a box");
        let least =
            map.obstacles().iter().map(|obstacle| obstacle.distance_to(&body)).fold(f64::INFINITY, f64::min);
        assert!(least >= 0.25, "{least}");
    }
    let stops = found.points.iter().filter(|point| point.speed == 0.0).count();
    assert!(stops > found.legs.len());
    let refused = no_way(ask(limits));
    assert!(matches!(refused.reason, NoWayReason::HeadingUnreachable), "{refused}");
}

/// A lane with a wall behind the start: a column of five fits in, one of seven does not.
#[test]
fn in_a_dead_end_a_smaller_formation_is_offered() {
    let lane = vec![block([0.0, 20.0], [0.0, 18.6]), block([0.0, 20.0], [21.4, 40.0])];
    let map = with(&empty(40.0), lane);
    let mission = Mission {
        start: PlanStart { level: 4.0, ..PlanStart::at(Pose::new(5.0, 20.0, 0.0)) },
        goal: PlanGoal::at(Pose::new(32.0, 20.0, 0.0)),
    };
    let (model, limits) = (trial::vee(), TravelLimits::default());
    let found = no_way(plan(&PlanRequest::new(&map, &model, limits, mission), &mut |_| false));
    assert!(
        matches!(found.reason, NoWayReason::StartBlocked { robot: 5 | 6, by: Boundary::Ground(_) }),
        "{found}"
    );
    assert_eq!(found.to_string(), "robot 5 starts too near to side 3 of the ground; one for a column of 5");
    let offer = found.offer.expect("an offer");
    let request = PlanRequest::new(&map, &offer.model, limits, offer.mission);
    let taken = plan(&request, &mut |_| false).expect("what is offered is there");
    let [least, _] = walked(&map, &offer.model, &taken);
    assert!(least >= 0.25, "{least}");
}

/// Nobody gets through a gate that is too narrow for the lead, and whoever asks for the shape in a lane is offered the column.
#[test]
fn where_the_shape_has_no_room_the_column_is_offered_with_the_gap() {
    let map = with(&empty(40.0), vec![block([20.0, 40.0], [0.0, 18.6]), block([20.0, 40.0], [21.4, 40.0])]);
    let mission = Mission {
        start: PlanStart::at(Pose::new(8.0, 20.0, 0.0)),
        goal: PlanGoal::at(Pose::new(36.0, 20.0, 0.0)).at_level(0),
    };
    let model = trial::vee();
    let request = PlanRequest::new(&map, &model, TravelLimits::default(), mission);
    let found = no_way(plan(&request, &mut |_| false));
    assert!(matches!(found.reason, NoWayReason::TooWide { robots: 7, .. }), "{found}");
    assert_eq!(found.offer.as_ref().map(|offer| offer.robots), Some(7), "{found}");
    assert_eq!(
        found.to_string(),
        "no way for 7 robots was found: the search used up its effort; the gap of 2.80 m between obstacle 0 and obstacle 1 at \
         (19.5, 20.0); one for a column of 7"
    );
    let gap = found.gap.expect("a gap");
    assert!((gap.width - 2.8).abs() < 1e-9, "{gap:?}");
    // A search takes some 5 µs for each step that it sweeps: two seconds are far away.
    assert!(found.expansions < 150_000, "{}", found.expansions);
}

/// The lead turns, at speed, and followers hold what they held: the plan goes on from there.
#[test]
fn a_plan_begins_in_the_middle_of_another() {
    let map = trial::map(3, 50);
    let (model, limits) = (trial::vee(), TravelLimits::default());
    let first = vee_plan(&map).expect("a plan");
    let mut walk = Walk::new(&model, first.legs[0].start);
    let mut gone = 0.0;
    let mut held = None;
    walk.leg(&model, &first.legs[0], &mut |walk, step| {
        gone += step;
        if gone > 6.3 && held.is_none() {
            held = Some((walk.held.clone(), walk.positions.clone(), gone));
        }
    });
    let (held, positions, gone) = held.expect("far enough");
    let here = first.at_way(gone).expect("a point");
    let start =
        PlanStart { pose: here.pose, level: here.level, curvature: here.curvature, speed: here.speed };
    let mission = Mission { start, ..trial::mission() };
    let request = PlanRequest { held: Some(&held), ..PlanRequest::new(&map, &model, limits, mission) };
    let second = plan(&request, &mut |_| false).expect("a plan");
    let holds = (second.points[0].speed - here.speed).abs() < 1e-9;
    assert!(second.points[0].speed <= here.speed && holds == second.brakes_in_time);
    assert_eq!(second.points[0].curvature, here.curvature);
    assert!(here.level > here.level.floor(), "between two levels");
    for (robot, position) in second.points[0].robots.iter().zip(&positions) {
        let off = math::hypot(robot.x - position[0], robot.y - position[1]);
        assert!(off < 0.02, "{off}");
    }
    within_limits(&second, &limits);
    let few = [[0.0; 2]; 2];
    let request = PlanRequest { held: Some(&few), ..request };
    let refused = plan(&request, &mut |_| false).expect_err("refused");
    assert_eq!(refused, PlanError::Input(InputError::WrongCount { found: 2, expected: 6 }));
}

/// Places that are held against leaders' own headings: every turn is passed on at once. Nobody files in so.
#[test]
fn followers_without_filters_stay_clear() {
    let three = (0..4).fold(trial::vee(), |model, _| model.without_last().expect("more than one"));
    let (model, limits) = (trial::without_filters(&three).with_levels(0..1), TravelLimits::default());
    for (seed, smooths) in [(1, true), (2, false), (3, false), (4, true)] {
        let map = trial::map(seed, 30);
        let mut request = PlanRequest::new(&map, &model, limits, trial::mission());
        request.effort.smooths = smooths;
        let found = plan(&request, &mut |_| false).unwrap_or_else(|error| panic!("{seed}: {error}"));
        let [least, _] = walked(&map, &model, &found);
        println!("{seed}: {least:.4} m");
        assert!(least >= trial::CLEARANCE, "{seed}: {least}");
        within_limits(&found, &limits);
    }
}

/// From anywhere to anywhere, at any heading and level: whatever is found can be driven.
#[test]
fn plans_between_random_poses_hold_what_they_promise() {
    let (model, limits) = (trial::vee(), TravelLimits::default());
    let mut draws = trial::Draws::new(77);
    let mut found = 0;
    for seed in 0..24 {
        let map = trial::map(100 + seed, 25);
        let mut pose =
            || Pose::new(draws.between(3.0, 37.0), draws.between(3.0, 37.0), draws.between(-PI, PI));
        let (from, to) = (pose(), pose());
        let start = PlanStart { level: (seed % 5) as f64, ..PlanStart::at(from) };
        let mut goal = if seed % 3 == 0 { PlanGoal::to([to.x, to.y]) } else { PlanGoal::at(to) };
        goal.level = (seed % 4 == 1).then_some(4 - seed as usize % 5);
        let mission = Mission { start, goal };
        let mut request = PlanRequest::new(&map, &model, limits, mission);
        request.effort.expansions = 8000;
        let Ok(plan) = plan(&request, &mut |_| false) else { continue };
        found += 1;
        let [least, _] = walked(&map, &model, &plan);
        assert!(least >= trial::CLEARANCE, "{seed}: {least}");
        within_limits(&plan, &limits);
        reaches(&plan, &mission);
    }
    println!("{found} plans");
    assert!(found >= 8, "{found}");
}

/// At a wall, heading away from it: there is no room to turn.
#[test]
fn a_heading_that_no_turning_circle_reaches_is_said_to_be_so() {
    let map = empty(40.0);
    let model = FormationModel::alone(BodyShape::Disc { radius: 0.2 }).expect("a robot");
    let mission = Mission {
        start: PlanStart::at(Pose::new(20.0, 20.0, 0.0)),
        goal: PlanGoal::at(Pose::new(39.4, 20.0, PI)),
    };
    let limits = TravelLimits { outer: 0.8, ..TravelLimits::default() };
    let found = no_way(plan(&PlanRequest::new(&map, &model, limits, mission), &mut |_| false));
    assert_eq!(found.reason, NoWayReason::HeadingUnreachable);
}

/// Whatever numbers are given, there is an answer.
#[test]
fn nothing_that_is_asked_brings_the_planner_down() {
    let extremes =
        [0.0, -0.0, 1e-300, 1e-9, 0.3, 1.0, 7.0, 1e9, 1e300, -1.0, -1e300, f64::INFINITY, f64::NAN];
    let mut draws = trial::Draws::new(5);
    let map = trial::map(1, 30);
    let model = trial::vee();
    let alone = FormationModel::alone(BodyShape::Disc { radius: 0.2 }).expect("a robot");
    for k in 0..400 {
        let mut draw = |usual: f64| {
            let index = draws.between(0.0, 5.0 * extremes.len() as f64) as usize;
            extremes.get(index).copied().unwrap_or(usual)
        };
        let limits = TravelLimits {
            curvature: draw(0.9),
            sharpness: draw(0.3),
            steering: draw(0.5),
            speed: draw(0.8),
            acceleration: draw(0.3),
            braking: draw(0.3),
            lateral: draw(1.0),
            outer: draw(1.6),
            turning: draw(0.8),
            follower_curvature: (k % 5 == 0).then(|| draw(0.9)),
            place_rate: draw(0.25),
            place_acceleration: draw(0.4),
            reverses: k % 4 == 0,
        };
        let pose = Pose::new(draw(8.0), draw(8.0), draw(0.8));
        let start = PlanStart { pose, level: draw(f64::from(k % 5)), curvature: draw(0.0), speed: draw(0.0) };
        let mut goal = PlanGoal::at(Pose::new(draw(20.0), draw(20.0), draw(1.0)));
        (goal.tolerance, goal.heading_tolerance) = (draw(0.1), draw(0.1));
        let who = if k % 2 == 0 { &alone } else { &model };
        let mut request = PlanRequest::new(&map, who, limits, Mission { start, goal });
        request.effort.expansions = 60;
        request.effort.improvement = 20;
        (request.effort.step, request.effort.cell) = (draw(1.25), draw(0.6));
        if let Ok(plan) = plan(&request, &mut |_| false) {
            assert!(
                plan.points.iter().all(|point| point.pose.x.is_finite() && point.time.is_finite()),
                "{k}"
            );
        }
    }
}

/// Cars of 0.6 m by 0.3 m: every corner stays clear, and none turns more sharply than its wheels do.
#[test]
fn rectangles_are_held_clear_as_they_are() {
    let body = BodyShape::Rectangle { front: 0.5, back: 0.1, half_width: 0.15 };
    let followers =
        trial::vee().followers().iter().map(|follower| FollowerModel { body, ..follower.clone() }).collect();
    let model = FormationModel::new(body, followers).expect("a formation");
    let limits = TravelLimits { follower_curvature: Some(0.9), ..TravelLimits::default() };
    for seed in [1, 2, 3] {
        let map = trial::map(seed, 60);
        let found = plan(&PlanRequest::new(&map, &model, limits, trial::mission()), &mut |_| false);
        let found = found.unwrap_or_else(|error| panic!("{seed}: {error}"));
        let mut walk = Walk::new(&model, found.legs[0].start);
        let (mut least, mut count) = (f64::INFINITY, 0);
        walk.leg(&model, &found.legs[0], &mut |walk, _| {
            count += 1;
            if count % 20 > 0 {
                return;
            }
            for ([x, y], [vx, vy]) in walk.positions.iter().zip(&walk.velocities) {
                let pose = Pose::new(*x, *y, math::atan2(*vy, *vx));
                let [x, y] = pose.world_from_body(0.2, 0.0);
                let car = Convex::rectangle(Pose::new(x, y, pose.heading), [0.3, 0.15]).expect("a box");
                least =
                    map.obstacles().iter().map(|obstacle| obstacle.distance_to(&car)).fold(least, f64::min);
            }
        });
        println!("{seed}: {least:.4} m");
        assert!(least >= trial::CLEARANCE, "{seed}: {least}");
        within_limits(&found, &limits);
    }
}

#[test]
fn steps_of_the_search_are_recorded_if_asked_for() {
    let (map, model) = (trial::map(2, 50), trial::vee());
    let mut request = PlanRequest::new(&map, &model, TravelLimits::default(), trial::mission());
    let without = plan(&request, &mut |_| false).expect("a plan");
    request.effort.records = true;
    let with = plan(&request, &mut |_| false).expect("a plan");
    assert!(without.record.tried.is_empty() && without.record.rejected.is_empty());
    assert_eq!(with.record.tried.len(), with.expansions);
    assert_eq!(with.digest(), without.digest());
}

#[test]
fn a_stop_from_outside_is_obeyed() {
    let map = trial::map(3, 100);
    let model = trial::vee();
    let request = PlanRequest::new(&map, &model, TravelLimits::default(), trial::mission());
    let found = no_way(plan(&request, &mut |_| true));
    assert_eq!(found.reason, NoWayReason::Stopped);
}

#[test]
fn a_search_that_is_stopped_later_has_the_plan_that_it_found() {
    let map = trial::map(3, 100);
    let model = trial::vee();
    let request = PlanRequest::new(&map, &model, TravelLimits::default(), trial::mission());
    let whole = plan(&request, &mut |_| false).expect("a plan");
    let mut found = 0;
    for most in [500, 1000, 2000, 4000] {
        match plan(&request, &mut |swept| swept >= most) {
            Ok(plan) => {
                found += 1;
                assert!(
                    plan.expansions <= most.max(64) + 64 && plan.searched_cost >= whole.searched_cost - 1e-9
                );
            }
            Err(error) => assert_eq!(error.to_string(), "the search was stopped before it found a way"),
        }
    }
    assert!(found > 0);
}

#[test]
fn ten_thousand_obstacles_are_planned_among() {
    let map = trial::spread(1, 10_000, 400.0);
    let found = vee_plan(&map).expect("a plan");
    let [least, _] = walked_near(&map, &found);
    assert!(least >= trial::CLEARANCE, "{least}");
}

/// As [`walked`], with obstacles near the way only.
fn walked_near(map: &Map, plan: &MotionPlan) -> [f64; 2] {
    let near: Vec<Convex> = map
        .obstacles()
        .iter()
        .filter(|obstacle| {
            plan.points.iter().any(|point| obstacle.distance([point.pose.x, point.pose.y]) < 12.0)
        })
        .cloned()
        .collect();
    let map = Map::new(map.ground().clone(), near, map.clearance()).expect("a map");
    walked(&map, &trial::vee(), plan)
}

#[test]
fn a_half_turn_is_planned_with_the_footprint_in_the_turn() {
    let (map, model) = (empty(60.0), trial::vee());
    let start = PlanStart::at(Pose::new(20.0, 20.0, FRAC_PI_2));
    let goal = PlanGoal::at(Pose::new(40.0, 20.0, -FRAC_PI_2)).at_level(0);
    let limits = TravelLimits::default();
    let found = plan(&PlanRequest::new(&map, &model, limits, Mission { start, goal }), &mut |_| false)
        .expect("a plan");
    within_limits(&found, &limits);
    let [least, fastest] = walked(&map, &model, &found);
    assert!(least >= 0.25 && fastest <= limits.outer, "{least} {fastest}");
}
