//! What there is no plan for, and why.

use crate::maps::{block, empty, no_way, with};
use crate::walk::walked;
use planning::{
    BodyShape, Boundary, Convex, FormationModel, InputError, Map, Mission, NoWayReason, PlanError, PlanGoal,
    PlanRequest, PlanStart, TravelLimits, plan, plan_tour, trial,
};
use std::f64::consts::PI;
use vocabulary::Pose;

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
        "the goal is 4000 m away, but may be 2000 m away at most: make a tour of goals that are nearer to each other"
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
    let request = PlanRequest::new(&map, &model, limits, mission);
    let found = no_way(plan(&request, &mut |_| false));
    let NoWayReason::HeadingUnreachable { heading, other } = found.reason else { panic!("{found}") };
    assert!((heading, found.gap) == (PI, None) && other.abs() < 0.5 * PI, "{found}");
    let told = found.to_string();
    let right = "the goal can be reached, but not with heading 180 deg: there is no room to turn; there is a way with";
    assert!(told.starts_with(right), "{told}");
    // What is offered is there.
    let other = Mission { goal: PlanGoal::at(Pose::new(39.4, 20.0, other)), ..mission };
    assert!(plan(&PlanRequest { mission: other, ..request }, &mut |_| false).is_ok());
}

/// The way on from a goal at a wall, heading for it: the ground is wide, and there is no room to turn.
#[test]
fn a_heading_that_leads_nowhere_is_said_to_be_the_reason() {
    let (map, limits) = (empty(40.0), TravelLimits { outer: 0.8, ..TravelLimits::default() });
    let model = FormationModel::alone(BodyShape::Disc { radius: 0.2 }).expect("a robot");
    let start = PlanStart::at(Pose::new(20.0, 20.0, 0.0));
    let goals = [PlanGoal::at(Pose::new(39.4, 20.0, 0.0)), PlanGoal::to([20.0, 20.0])];
    let request = PlanRequest::new(&map, &model, limits, Mission { start, goal: goals[0] });
    let error = plan_tour(&request, &goals, &mut |_| false).expect_err("no way back");
    assert_eq!(error.goal, 1);
    let found = no_way(Err(error.error));
    let NoWayReason::StartHeading { heading, other } = found.reason else { panic!("{found}") };
    assert!(heading.abs() < 0.1 && other.abs() > 3.0 && found.gap.is_none(), "{found}");
    // Where there is room on one side, nothing is wrong with the heading.
    let start = PlanStart::at(Pose::new(39.4, 20.0, other));
    let back = Mission { start, goal: goals[1] };
    assert!(plan(&PlanRequest { mission: back, ..request }, &mut |_| false).is_ok());
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
            follower_turn_rate: (k % 3 == 0).then(|| draw(2.0)),
            follower_acceleration: (k % 7 == 0).then(|| draw(1.0)),
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
