//! Robots with sensors: the loop closed on measurements, on any machine, and on pictures where there is an adapter.

use rendering::{AdapterChoice, Gpu, GpuCameraRenderer};
use scene::{Role, Scene, SensingKind};
use simulation::{Simulation, build};
use std::path::Path;
use vocabulary::math;
use vocabulary::{Outcome, StepRecord, TrackingState};

/// A shipped scene, its length and its followers' sensing changed.
fn scene(name: &str, duration: f64, kind: SensingKind) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(format!("{name}.toml"));
    let mut scene = Scene::load(&path, &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    scene.time.duration = duration;
    for robot in &mut scene.robots {
        if let Role::Follow(follow) = &mut robot.role {
            follow.sensing.kind = kind;
        }
    }
    scene
}

fn start(scene: &Scene) -> Simulation {
    Simulation::new(build(scene).expect("a formation"))
}

/// Digest of a run, and what `visit` makes of its moments.
fn play(mut run: Simulation, mut visit: impl FnMut(&StepRecord)) -> String {
    let mut digest = metrics::Digest::default();
    while let Some(record) = run.next_record() {
        digest.push(record);
        visit(record);
    }
    assert_eq!(run.fault(), None);
    digest.text()
}

/// Root mean square errors of the edges [m, rad] from `after` s on, worst edge.
fn worst_rms(records: &[StepRecord], after: f64) -> [f64; 2] {
    let late: Vec<&StepRecord> = records.iter().filter(|m| m.snapshot.time >= after).collect();
    let edges = late.first().map_or(0, |m| m.edges.len());
    let rms = |edge: usize, k: usize| {
        (late.iter().map(|m| math::powi(m.edges[edge].error[k], 2)).sum::<f64>() / late.len() as f64).sqrt()
    };
    [0, 1].map(|k| (0..edges).map(|edge| rms(edge, k)).fold(0.0, f64::max))
}

fn records(run: Simulation) -> Vec<StepRecord> {
    let mut all = vec![];
    play(run, |record| all.push(record.clone()));
    all
}

#[test]
fn formations_hold_on_measurements_at_tags() {
    for name in ["vision-circle-three", "vision-cars-circle-three"] {
        let all = records(start(&scene(name, 20.0, SensingKind::Geometric)));
        let [distance, bearing] = worst_rms(&all, 8.0);
        assert!(distance < 0.03 && bearing.to_degrees() < 1.5, "{name}: {distance} m, {bearing} rad");
        let frames = || all.iter().flat_map(|m| &m.frames);
        assert!(frames().count() > 1100 && frames().all(|frame| frame.outcome.seen()), "{name}");
    }
}

#[test]
fn the_second_estimator_holds_them_too() {
    let mut scene = scene("vision-cars-circle-three", 20.0, SensingKind::Noise);
    for robot in &mut scene.robots {
        if let Role::Follow(follow) = &mut robot.role {
            follow.observer.kind = vocabulary::ObserverKind::Unscented;
        }
    }
    let [distance, bearing] = worst_rms(&records(start(&scene)), 8.0);
    assert!(distance < 0.05 && bearing.to_degrees() < 2.5, "{distance} m, {bearing} rad");
}

#[test]
fn measurements_are_the_same_in_every_run_and_go_on_alike_from_a_copy() {
    let scene = scene("vision-dropout", 6.0, SensingKind::Geometric);
    let whole = play(start(&scene), |_| ());
    assert_eq!(whole, play(start(&scene), |_| ()));
    let mut run = start(&scene);
    let mut digest = metrics::Digest::default();
    for _ in 0..257 {
        digest.push(run.next_record().expect("a moment"));
    }
    let mut saved = run.save();
    while run.next_record().is_some() {}
    while let Some(record) = saved.next_record() {
        digest.push(record);
    }
    assert_eq!(digest.text(), whole);
    let mut other = scene.clone();
    other.seed += 1;
    assert_ne!(play(start(&other), |_| ()), whole);
}

/// Frames that do not fit the control period are taken at their own instants.
#[test]
fn measurements_have_their_own_instants_and_arrive_late() {
    let mut scene = scene("vision-line-three", 3.0, SensingKind::Geometric);
    for robot in &mut scene.robots {
        if let Role::Follow(follow) = &mut robot.role {
            (follow.sensing.rate, follow.sensing.latency) = (37.0, 0.025);
        }
    }
    let all = records(start(&scene));
    let mut count = 0;
    for record in &all {
        for frame in record.frames.iter().filter(|frame| frame.edge == 0) {
            assert!((frame.measurement.stamp - f64::from(count) / 37.0).abs() < 1e-9, "{frame:?}");
            let late = record.snapshot.time - frame.measurement.stamp;
            assert!(late > 0.025 - 1e-9 && late < 0.035 + 1e-9, "{late}");
            let off = frame.measurement.relative.distance - frame.truth.distance;
            assert!(off.abs() < 0.02, "{off}");
            count += 1;
        }
    }
    assert!((110..=111).contains(&count), "{count}");
}

/// A wall hides the leader for so long that it is lost: its follower slows down, searches, finds it and closes up.
#[test]
fn a_leader_that_was_lost_is_found_again() {
    let mut scene = scene("vision-occlusion", 30.0, SensingKind::Geometric);
    for robot in &mut scene.robots {
        if let Role::Follow(follow) = &mut robot.role {
            follow.sensing.hold = 0.3;
        }
    }
    let all = records(start(&scene));
    let states: Vec<TrackingState> = all.iter().map(|m| m.edges[0].sight).collect();
    let lost = states.iter().position(|s| *s == TrackingState::Lost).expect("lost for a while");
    assert!(states[..lost].contains(&TrackingState::Coasting) && states[0] == TrackingState::Waiting);
    let found =
        lost + states[lost..].iter().position(|s| *s == TrackingState::Tracking).expect("found again");
    let speeds = |range: std::ops::Range<usize>| -> Vec<f64> {
        all[range].iter().map(|m| m.snapshot.robots[1].motion.speed).collect()
    };
    let lowest = speeds(lost..found).into_iter().fold(f64::INFINITY, f64::min);
    assert!(lowest < 0.95 * speeds(lost..lost + 1)[0], "it slows down: {lowest}");
    let last = all.last().expect("moments");
    assert!(last.edges[0].error[0].abs() < 0.05 && last.edges[0].sight == TrackingState::Tracking);
    assert!(all.iter().all(|m| m.contacts.is_empty()));
}

#[test]
fn who_never_sees_its_leader_slows_down_and_does_not_fail() {
    let mut scene = scene("vision-line-three", 3.0, SensingKind::Geometric);
    // Both turned away, with cameras that look straight ahead.
    scene.vision.pan_max = 0.0;
    for robot in &mut scene.robots[1..] {
        robot.pose.heading = std::f64::consts::PI;
    }
    let all = records(start(&scene));
    let last = all.last().expect("moments");
    for (edge, robot) in last.edges.iter().zip(&last.snapshot.robots[1..]) {
        assert_eq!(edge.sight, TrackingState::Lost);
        assert!(robot.motion.speed < 0.05, "{}", robot.motion.speed);
    }
    assert!(all.iter().flat_map(|m| &m.frames).all(|frame| frame.outcome == Outcome::Missed));
}

#[test]
fn cameras_without_anyone_to_draw_for_them_say_so() {
    let mut run = start(&scene("vision-line-three", 1.0, SensingKind::Camera));
    assert!(run.needs_cameras());
    assert!(run.next_record().is_none());
    assert!(run.fault().is_some_and(|fault| fault.to_string().contains("pictures")));
}

/// The paper's claim, on pictures: the same digest twice, and a formation that closes up.
#[test]
fn the_loop_closes_on_pictures_and_does_so_alike_every_time() {
    let scene = scene("vision-cars-circle-three", 6.0, SensingKind::Camera);
    let run = || {
        let mut run = start(&scene);
        let gpu = Gpu::open(&AdapterChoice::Auto).expect("an adapter, as for all pictures");
        let eyes = GpuCameraRenderer::new(&gpu, run.fleet()).expect("eyes");
        run.attach_cameras(Box::new(eyes));
        run
    };
    let mut all = vec![];
    let first = play(run(), |record| all.push(record.clone()));
    assert_eq!(first, play(run(), |_| ()));
    let frames: Vec<_> = all.iter().flat_map(|m| &m.frames).collect();
    assert!(frames.len() >= 356, "{}", frames.len());
    // In the first second both close up as fast as they can, and their cameras swing.
    let late: Vec<_> = frames.iter().filter(|frame| frame.measurement.stamp > 1.0).collect();
    let seen = late.iter().filter(|frame| frame.outcome.seen()).count();
    assert!(seen as f64 >= 0.99 * late.len() as f64, "{seen} of {}", late.len());
    for frame in frames.iter().filter(|frame| frame.outcome == Outcome::Used) {
        let off = (frame.measurement.relative.distance - frame.truth.distance).abs();
        assert!(off < 0.01 * frame.truth.distance, "{frame:?}");
    }
    let [before, after] = [&all[0], all.last().expect("moments")].map(|m| m.edges[0].error[0].abs());
    assert!(after < 0.05 && before > 0.2, "{before} {after}");
}
