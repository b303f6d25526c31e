//! Ways that are known beforehand.

use crate::maps::{block, empty, no_way, vee_plan, with};
use crate::walk::{Walk, walked, within_limits};
use planning::{
    BodyShape, Convex, FormationModel, InputError, Mission, NoWayReason, PlanError, PlanGoal, PlanRequest,
    PlanStart, TravelLimits, plan, plan_tour, trial,
};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use vocabulary::{Pose, math};

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
    assert!(matches!(refused.reason, NoWayReason::HeadingUnreachable { .. }), "{refused}");
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
