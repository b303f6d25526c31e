//! What plans promise, over random maps.

use crate::maps::{moved, vee_plan};
use crate::walk::{Walk, reaches, walked, walked_near, within_limits};
use planning::{
    BodyShape, Convex, FollowerModel, FormationModel, Mission, PlanGoal, PlanRequest, PlanStart,
    TravelLimits, plan, trial,
};
use std::f64::consts::{FRAC_PI_4, PI};
use vocabulary::{Pose, math, wrap};

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
fn ten_thousand_obstacles_are_planned_among() {
    let map = trial::spread(1, 10_000, 400.0);
    let found = vee_plan(&map).expect("a plan");
    let [least, _] = walked_near(&map, &found);
    assert!(least >= trial::CLEARANCE, "{least}");
}
