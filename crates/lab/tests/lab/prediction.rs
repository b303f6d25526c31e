//! What will come if nobody changes anything is what comes, and trouble on the way is seen before it is met.

use crate::common::{THREE, scene, with};
use lab::session::prediction::{Prediction, Predictor, Trouble};
use simulation::Simulation;
use std::time::Duration;
use vocabulary::{EntityId, Relative, math};

/// A run of a scene, `samples` samples old.
fn run(text: &str, samples: u64) -> Simulation {
    let mut run = Simulation::new(simulation::build(&scene(text)).expect("a run"));
    run.extend_to(1e6);
    while run.sample() < samples {
        run.next_record().expect("a moment");
    }
    run
}

fn ahead(run: &Simulation, seconds: f64) -> Prediction {
    let (predictor, predictions) = Predictor::start(|| ());
    predictor.look(3, run.save(), seconds);
    let prediction = predictions.recv_timeout(Duration::from_mins(1)).expect("a forecast");
    assert_eq!(prediction.branch, 3);
    prediction
}

/// The worst on the way of a robot.
fn worst(prediction: &Prediction, robot: usize) -> Trouble {
    prediction.paths[robot].iter().map(|place| place.trouble).max().expect("a path")
}

#[test]
fn a_settled_formation_ends_at_its_set_points() {
    let run = run(include_str!("../../../../scenes/line-three.toml"), 500);
    let prediction = ahead(&run, 4.0);
    let edges = &run.fleet().edges;
    for ((edge, late), record) in edges.iter().zip(&prediction.late_error).zip(&run.record().edges) {
        assert!(late[0] < 0.0036 && late[1] < 1e-4, "{late:?}");
        let end = Relative::between(prediction.end[edge.leader], prediction.end[edge.follower]);
        assert!((end.distance - record.set_point[0]).abs() < 0.0036, "{end:?}");
        assert!((end.bearing - record.set_point[1]).abs() < 1e-4, "{end:?}");
    }
    assert_eq!((prediction.contact, prediction.limited), (None, None));
    assert!((0..3).all(|robot| worst(&prediction, robot) == Trouble::None));
}

#[test]
fn what_is_foreseen_is_what_comes() {
    let noisy = with(THREE, &[("sensing", "{ kind = \"noise\", latency = 0.05 }")]);
    let cars = with(THREE, &[("vehicle", "car")]);
    for (text, seconds) in [(THREE, 3.0), (&noisy, 1.0), (&cars, 2.0), (THREE, 0.004)] {
        let mut run = run(text, 120);
        let prediction = ahead(&run, seconds);
        let (samples, period) = ((seconds / 0.01_f64).round().max(1.0) as u64, run.period());
        assert_eq!(prediction.span, [120.0 * period, (120 + samples) as f64 * period]);
        let mut there = vec![];
        let mut late = vec![[0.0_f64; 2]; 2];
        for k in 0..samples {
            let record = run.next_record().expect("a moment");
            there.push(record.clone());
            if k as f64 >= 0.9 * samples as f64 {
                for (late, state) in late.iter_mut().zip(&record.edges) {
                    *late = [late[0].max(state.error[0].abs()), late[1].max(state.error[1].abs())];
                }
            }
        }
        assert_eq!(prediction.late_error, late);
        let last = &there[there.len() - 1].snapshot.robots;
        assert_eq!(prediction.end, last.iter().map(|robot| robot.motion.pose).collect::<Vec<_>>());
        for (robot, (path, motions)) in prediction.paths.iter().zip(&prediction.motions).enumerate() {
            assert!((1..=161).contains(&path.len()) && path.len() == motions.len(), "{} places", path.len());
            let mut way = there.iter().map(|record| record.snapshot.robots[robot].motion);
            for (place, motion) in path.iter().zip(motions) {
                let found = way.find(|real| {
                    [real.pose.x, real.pose.y] == place.at && [real.speed, real.turn_rate] == *motion
                });
                assert!(found.is_some(), "robot {robot} never comes to {place:?}");
            }
        }
    }
}

#[test]
fn a_filter_is_foreseen() {
    let mut run = run(include_str!("../../../../scenes/pillar.toml"), 400);
    let prediction = ahead(&run, 8.0);
    let place = |robot: &vocabulary::RobotState| [robot.motion.pose.x, robot.motion.pose.y];
    let mut driven: Vec<_> = run.record().snapshot.robots.iter().map(|robot| vec![place(robot)]).collect();
    let mut filtered = 0;
    for _ in 0..800 {
        let record = run.next_record().expect("a moment");
        filtered += record.safety.iter().filter(|state| state.moved > 0.1).count();
        for (driven, robot) in driven.iter_mut().zip(&record.snapshot.robots) {
            driven.push(place(robot));
        }
    }
    assert!(filtered > 50, "a filter moves {filtered} commands");
    for (path, driven) in prediction.paths.iter().zip(&driven) {
        let off = path.iter().map(|point| {
            let off = |place: &[f64; 2]| math::hypot(place[0] - point.at[0], place[1] - point.at[1]);
            driven.iter().map(off).fold(f64::INFINITY, f64::min)
        });
        assert!(path.len() > 100 && off.fold(0.0, f64::max) < 1e-3);
    }
    for (end, driven) in prediction.end.iter().zip(&driven) {
        assert_eq!([end.x, end.y], driven[800]);
    }
}

#[test]
fn a_contact_is_seen_before_it_is_made() {
    let crash = include_str!("../../../../scenes/cars-crash.toml");
    for (what, text) in [
        ("bodies with weight", crash.to_owned()),
        ("a run that stops there", with(crash, &[("physics.on_contact", "stop")])),
        ("bodies without weight", with(crash, &[("vehicle", "unicycle")])),
    ] {
        let run = run(&text, 20);
        let prediction = ahead(&run, 2.5);
        let (time, things) = prediction.contact.expect("a contact");
        // 5 m apart at 3 m/s, less half a vehicle at either end.
        assert!((1.2..1.75).contains(&time), "{what}: at {time} s");
        assert_eq!(things.iter().filter(|thing| matches!(thing, EntityId::Robot(_))).count(), 2, "{what}");
        for robot in 0..2 {
            assert_eq!(worst(&prediction, robot), Trouble::Contact, "{what}: robot {robot}");
            assert_eq!(prediction.paths[robot][0].trouble, Trouble::None, "{what}: not here and now");
        }
        assert_eq!(prediction.end.len(), 2, "{what}: everybody is somewhere in the end");
        assert!(ahead(&run, 0.5).contact.is_none(), "{what}: not so soon");
    }
}

#[test]
fn a_limit_is_seen_before_it_cuts() {
    // A follower that has settled is sent elsewhere at 6 s, at a jump.
    let line = include_str!("../../../../scenes/line-three.toml");
    let text = format!("{line}\n[[changes]]\nat = 6.0\nset = [\"robots.follower-1.distance=4.0\"]\n");
    let run = run(&text, 500);
    let prediction = ahead(&run, 1.5);
    let (time, edge) = prediction.limited.expect("a limit");
    assert!((6.0..6.2).contains(&time) && edge == 0, "{time} s, edge {edge}");
    assert_eq!((worst(&prediction, 1), worst(&prediction, 2)), (Trouble::Limited, Trouble::None));
    assert!(prediction.late_error[0][0] > 0.1, "it is not there in time: {:?}", prediction.late_error[0]);
    assert!(ahead(&run, 0.9).limited.is_none(), "not so soon");
}

#[test]
fn who_sees_by_pictures_is_told_the_truth_ahead() {
    let text = include_str!("../../../../scenes/vision-line-three.toml");
    let blind = run(text, 0);
    assert!(blind.needs_cameras());
    let prediction = ahead(&blind, 2.0);
    assert!((prediction.end[0].x - 2.0).abs() < 0.02, "the whole way: {:?}", prediction.end);
    assert!(prediction.paths.iter().all(|path| path.len() > 80));
    assert!(prediction.late_error.iter().all(|late| late[0] < 0.2), "{:?}", prediction.late_error);
}

#[test]
fn the_newest_question_is_answered() {
    let (predictor, predictions) = Predictor::start(|| ());
    let run = run(THREE, 10);
    for branch in 0..20 {
        predictor.look(branch, run.save(), 1.0);
    }
    let mut last = None;
    while last != Some(19) {
        let prediction = predictions.recv_timeout(Duration::from_mins(1)).expect("a forecast");
        assert!(last < Some(prediction.branch), "in the order of the questions");
        last = Some(prediction.branch);
    }
    assert!(predictions.try_recv().is_err(), "one answer each, at most");
}
