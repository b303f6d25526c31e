//! Plans among things that move: nobody is met, by distances at every few centimetres and milliseconds.

use planning::{
    BodyShape, Convex, FormationModel, Map, Mission, MotionPlan, MovingThing, PlanError, PlanGoal,
    PlanRequest, PlanStart, Schedule, TrackPoint, TravelLimits, first_meeting, plan, plan_among, trial,
};
use std::f64::consts::PI;
use vocabulary::Pose;

fn open_ground() -> Map {
    let ground =
        Convex::polygon(&[[-5.0, -20.0], [45.0, -20.0], [45.0, 20.0], [-5.0, 20.0]]).expect("ground");
    Map::new(ground, vec![], 0.25).expect("a map")
}

/// A corridor along x, so wide.
fn corridor(width: f64) -> Map {
    let wall = |y: f64| Convex::rectangle(Pose::new(20.0, y, 0.0), [18.0, 0.5]).expect("a wall");
    let ground =
        Convex::polygon(&[[-5.0, -20.0], [45.0, -20.0], [45.0, 20.0], [-5.0, 20.0]]).expect("ground");
    let half = 0.5 * width + 0.5;
    Map::new(ground, vec![wall(half), wall(-half)], 0.25).expect("a map")
}

fn cart(from: [f64; 2], to: [f64; 2], starts: f64, speed: f64) -> MovingThing {
    let way = vocabulary::math::hypot(to[0] - from[0], to[1] - from[1]);
    let heading = vocabulary::math::atan2(to[1] - from[1], to[0] - from[0]);
    let point = |time: f64, [x, y]: [f64; 2]| TrackPoint { time, pose: Pose::new(x, y, heading) };
    let body = Convex::rectangle(Pose::default(), [0.6, 0.3]).expect("a box");
    MovingThing::new(body, vec![point(starts, from), point(starts + way / speed, to)]).expect("a cart")
}

fn mission() -> Mission {
    Mission {
        start: PlanStart::at(Pose::default()),
        goal: PlanGoal::at(Pose::new(30.0, 0.0, 0.0)).at_level(0),
    }
}

/// Least distance of all robots to all things, looked at every 10 ms.
fn least(plan: &MotionPlan, model: &FormationModel, things: &[MovingThing], begins: f64) -> f64 {
    let steps = (plan.duration() / 0.01) as usize;
    let mut least = f64::INFINITY;
    for k in 0..=steps {
        let time = 0.01 * k as f64;
        let point = plan.at_time(time).expect("a point");
        for thing in things {
            let body = thing.body_at(begins + time);
            for (robot, pose) in point.robots.iter().enumerate() {
                least = least.min(body.distance_to(&model.body(robot).at(*pose)));
            }
        }
    }
    least
}

/// Ways are what speeds come to, and speeds what accelerations within bounds come to.
fn check_motion(plan: &MotionPlan, limits: &TravelLimits) {
    for pair in plan.points.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        let span = b.time - a.time;
        assert!(span > -1e-12, "time goes back at {}", a.way);
        let way = 0.5 * (a.speed + b.speed) * span;
        assert!(
            (b.way - a.way - way).abs() < 1e-6,
            "{} m in {span} s at {} and {}",
            b.way - a.way,
            a.speed,
            b.speed
        );
        if span > 1e-6 {
            let acceleration = (b.speed - a.speed) / span;
            assert!(acceleration.abs() < limits.acceleration + 1e-6, "{acceleration} m/s² at {} m", a.way);
        }
        assert!(b.speed <= limits.speed + 1e-9);
    }
    assert_eq!(plan.points.last().expect("an end").speed, 0.0);
}

#[test]
fn a_formation_lets_a_cart_cross() {
    let (map, model, limits) = (open_ground(), trial::vee(), TravelLimits::default());
    let request = PlanRequest::new(&map, &model, limits, mission());
    let alone = plan(&request, &mut |_| false).expect("a way");
    for (starts, speed) in [(5.0, 0.6), (12.0, 0.4), (18.0, 1.5)] {
        let things = [cart([15.0, -12.0], [15.0, 14.0], starts, speed)];
        let met = first_meeting(&alone, &model, &limits, 0.25, &things, 0.0, 0.0);
        let found = plan_among(&request, &things, Schedule::at(0.0), &mut |_| false).expect("a way");
        let near = least(&found, &model, &things, 0.0);
        assert!(near >= 0.25 - 1e-6, "{starts} {speed}: {near} m");
        check_motion(&found, &limits);
        // What says that it meets nothing is right about that, too.
        assert_eq!(met.is_some(), least(&alone, &model, &things, 0.0) < 0.25, "{starts} {speed}");
        assert!(first_meeting(&found, &model, &limits, 0.25 - 1e-6, &things, 0.0, 0.0).is_none());
    }
}

#[test]
fn what_comes_along_a_corridor_is_waited_for_or_told() {
    let model = FormationModel::alone(BodyShape::Disc { radius: 0.22 }).expect("a model");
    let (map, limits) = (corridor(1.6), TravelLimits::default());
    let mut mission = mission();
    mission.start.pose.x = -3.0;
    mission.goal = PlanGoal::to([42.0, 0.0]);
    let request = PlanRequest::new(&map, &model, limits, mission);
    // It comes out of the corridor, and goes on to the side.
    let point = |time: f64, x: f64, y: f64| TrackPoint { time, pose: Pose::new(x, y, PI) };
    let body = Convex::rectangle(Pose::default(), [0.6, 0.3]).expect("a box");
    let away = vec![point(0.0, 30.0, 0.0), point(30.0, 0.5, 0.0), point(40.0, 0.5, 12.0)];
    let thing = MovingThing::new(body.clone(), away).expect("a cart");
    let found =
        plan_among(&request, std::slice::from_ref(&thing), Schedule::at(0.0), &mut |_| false).expect("a way");
    assert!(least(&found, &model, &[thing], 0.0) >= 0.25 - 1e-6);
    check_motion(&found, &limits);
    // It stops in the corridor.
    let stays = vec![point(0.0, 30.0, 0.0), point(12.0, 20.0, 0.0)];
    let thing = MovingThing::new(body, stays).expect("a cart");
    match plan_among(&request, &[thing], Schedule::at(0.0), &mut |_| false) {
        Err(PlanError::Meets(error)) => assert!(error.0.time > 5.0, "{error:?}"),
        Ok(found) => {
            // There is a way outside of the corridor.
            let beside = found.points.iter().map(|point| point.pose.y.abs()).fold(0.0, f64::max);
            assert!(beside > 1.5, "{beside}");
        }
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn two_formations_pass_each_other() {
    let (map, model, limits) = (open_ground(), trial::vee(), TravelLimits::default());
    let first = PlanRequest::new(&map, &model, limits, mission());
    let going = plan(&first, &mut |_| false).expect("a way");
    let things: Vec<MovingThing> = (0..model.robots())
        .map(|robot| {
            let track = going.points.iter().map(|p| TrackPoint { time: p.time, pose: p.robots[robot] });
            let body = Convex::disc([0.0; 2], 0.22).expect("a disc");
            MovingThing::new(body, track.collect()).expect("a robot")
        })
        .collect();
    let back =
        Mission { start: PlanStart::at(Pose::new(15.0, -15.0, 0.5 * PI)), goal: PlanGoal::to([15.0, 15.0]) };
    let second = PlanRequest::new(&map, &model, limits, back);
    let found = plan_among(&second, &things, Schedule::at(0.0), &mut |_| false).expect("a way");
    assert!(least(&found, &model, &things, 0.0) >= 0.25 - 1e-6);
    check_motion(&found, &limits);
    let again = plan_among(&second, &things, Schedule::at(0.0), &mut |_| false).expect("a way");
    assert_eq!(found.digest(), again.digest());
}

#[test]
fn a_lead_that_drives_waits_in_time() {
    let (map, model, limits) = (open_ground(), trial::vee(), TravelLimits::default());
    let mut mission = mission();
    mission.start.speed = 0.71;
    let request = PlanRequest::new(&map, &model, limits, mission);
    let things = [cart([12.0, -14.0], [12.0, 14.0], 0.0, 0.8)];
    let found = plan_among(&request, &things, Schedule::at(0.0), &mut |_| false).expect("a way");
    assert!((found.points[0].speed - 0.71).abs() < 1e-12);
    assert!(least(&found, &model, &things, 0.0) >= 0.25 - 1e-6);
    check_motion(&found, &limits);
}
