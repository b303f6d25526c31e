//! A robot that keeps its distances to two others: what whole runs show.

use metrics::{Digest, Metrics, MetricsBuilder};
use recording::log::{FILE, Log};
use recording::{Recorder, Status};
use scene::{Role, Scene};
use simulation::{Simulation, build, in_line};
use studies::certify::{Examiner, Premise};
use vocabulary::{EventKind, Refusal, ScalarTrajectory, StepRecord};

/// ℓ-ℓ control: both distances have the dynamics of a spring, each as if its leader drove straight on. It knows what its
/// follower measures.
const LAW: &str = r"
leaders 2
parameter k = 2 [1/s] in 0.1 .. 10
let w1 = -k^2 * (leader1.distance - wanted1.distance) - 2 * k * leader1.distance_rate
let w2 = -k^2 * (leader2.distance - wanted2.distance) - 2 * k * leader2.distance_rate
let g1 = (cos(leader1.view_angle), sin(leader1.view_angle))
let g2 = (cos(leader2.view_angle), sin(leader2.view_angle))
let area = g1.x * g2.y - g1.y * g2.x
command = (w1 * g2.y - w2 * g1.y) / area, (g1.x * w2 - g2.x * w1) / area / own.speed
";

/// A diamond: `ann` leads, `bob` and `cy` follow it, `dan` keeps its distances to both.
fn scene(more: &str) -> Scene {
    let text = format!(
        r#"
schema = 1
title = "A diamond"
[time]
duration = 12.0
[law]
heading = "path"
[vehicle]
acceleration_max = 3.0
[[robots]]
name = "ann"
pose = [0.0, 0.0, 0.0]
path = {{ kind = "constant", speed = 0.6 }}
[[robots]]
name = "bob"
pose = [-1.4, 1.5, 0.0]
leader = "ann"
distance = 2.0
bearing = "135 deg"
speed = 0.6
[[robots]]
name = "cy"
pose = [-1.4, -1.4, 0.0]
leader = "ann"
distance = 2.0
bearing = "-135 deg"
speed = 0.6
[[robots]]
name = "dan"
pose = [-3.0, 0.3, 0.0]
speed = 0.6
law = {{ text = """{LAW}""" }}
leaders = [{{ name = "bob", distance = 2.0 }}, {{ name = "cy", distance = 2.0 }}]
{more}
"#
    );
    Scene::parse(&text, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene
}

fn simulation(scene: &Scene) -> Simulation {
    Simulation::new(build(scene).expect("a run"))
}

fn run(scene: &Scene, mut visit: impl FnMut(&StepRecord)) -> (Metrics, String) {
    let mut simulation = simulation(scene);
    let (mut metrics, mut digest) =
        (MetricsBuilder::new(simulation.fleet(), scene.judging()), Digest::default());
    while let Some(record) = simulation.next_record() {
        metrics.push(record);
        digest.push(record);
        visit(record);
    }
    assert!(simulation.fault().is_none(), "{:?}", simulation.fault());
    (metrics.finish(), digest.text())
}

#[test]
fn a_robot_keeps_its_distances_to_two_others() {
    let scene = scene("");
    let fleet = build(&scene).expect("a run").fleet;
    assert_eq!(fleet.free, [[false; 2], [false; 2], [false, true], [false, true]]);
    assert_eq!(fleet.several_leaders(), [false, false, false, true]);
    let (metrics, _) = run(&scene, |record| {
        for (index, state) in record.edges.iter().enumerate().skip(2) {
            assert_eq!((state.error[1], state.set_point[1]), (0.0, state.relative.bearing), "{index}");
        }
        // One decision, on both edges.
        assert_eq!(record.edges[2].applied, record.edges[3].applied);
    });
    let pairs: Vec<_> = metrics.edges.iter().map(|edge| (&*edge.leader, &*edge.follower)).collect();
    assert_eq!(pairs, [("ann", "bob"), ("ann", "cy"), ("bob", "dan"), ("cy", "dan")]);
    for edge in &metrics.edges[2..] {
        assert!(edge.final_error[0].abs() < 2e-3, "{edge:?}");
        assert_eq!((edge.final_error[1], edge.peak_error[1], edge.iae[1]), (0.0, 0.0, 0.0));
        assert!(edge.peak_error[0] > 0.02, "it had a way to go: {edge:?}");
        assert!(edge.settling_time.is_some_and(|time| time < 8.0), "{edge:?}");
    }
    let [first, second] = [&metrics.edges[2], &metrics.edges[3]];
    assert_eq!((first.effort, first.speeds), (second.effort, second.speeds));
}

#[test]
fn runs_are_equal_on_any_thread_and_after_a_save() {
    for sensing in ["\"truth\"", "{ kind = \"noise\", rate = 20.0, distance_noise = 0.01 }"] {
        let scene = scene(&format!("sensing = {sensing}\nobserver = {{ epsilon = 0.05 }}"));
        let here = run(&scene, |_| {}).1;
        let threads: Vec<_> = (0..3)
            .map(|_| {
                let scene = scene.clone();
                std::thread::spawn(move || run(&scene, |_| {}).1)
            })
            .collect();
        for thread in threads {
            assert_eq!(thread.join().expect("it ran"), here, "{sensing}");
        }
        let (mut simulation, mut digest) = (simulation(&scene), Digest::default());
        for _ in 0..500 {
            digest.push(simulation.next_record().expect("a moment"));
        }
        let mut saved = simulation.save();
        drop(simulation);
        while let Some(record) = saved.next_record() {
            digest.push(record);
        }
        assert_eq!(digest.text(), here, "{sensing}");
    }
}

/// Measurements of two leaders have errors of their own, though one robot takes them.
#[test]
fn measurements_of_two_leaders_have_errors_of_their_own() {
    let scene = scene("sensing = { kind = \"noise\", rate = 20.0, distance_noise = 0.01 }");
    let mut errors: [Vec<f64>; 2] = Default::default();
    run(&scene, |record| {
        for frame in record.frames.iter().filter(|frame| frame.edge >= 2) {
            let off = frame.measurement.relative.distance - frame.truth.distance;
            errors[frame.edge - 2].push(off);
        }
    });
    let [a, b] = &errors;
    assert!(a.len() > 200 && a.len() == b.len(), "{} {}", a.len(), b.len());
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let correlation = product(a, b) / (product(a, a) * product(b, b)).sqrt();
    assert!(correlation.abs() < 0.2, "{correlation}");
}

#[test]
fn a_change_of_one_distance_takes_hold() {
    let scene = scene("[[changes]]\nat = 4.0\nset = [\"robots.dan.leaders.bob.distance=1.8\"]");
    assert_eq!(scene.changes[0].set, ["robots.dan.leaders.bob.distance=1.8"]);
    let mut wanted = vec![];
    let (metrics, digest) = run(&scene, |record| wanted.push(record.edges[2].set_point[0]));
    assert_eq!((wanted[399], wanted[400]), (2.0, 1.8));
    assert!(metrics.edges[2].final_error[0].abs() < 5e-3, "{:?}", metrics.edges[2]);
    assert_eq!(run(&scene, |_| {}).1, digest);
}

/// What `leave` makes of the four, and what is told of it.
fn told(events: &str) -> (Vec<(EventKind, usize, Refusal)>, StepRecord) {
    let scene = scene(events);
    let (mut told, mut last) = (vec![], StepRecord::default());
    run(&scene, |record| {
        told.extend(record.events.iter().map(|event| (event.kind, event.robot, event.refusal)));
        last.clone_from(record);
    });
    (told, last)
}

#[test]
fn a_robot_that_loses_one_of_its_leaders_waits_and_then_stays() {
    for recovery in ["graft", "promote", "wait"] {
        let (told, last) = told(&format!(
            "[[events]]\nat = 3.0\nrobot = \"cy\"\nfails = \"stop\"\nrecovery = \"{recovery}\""
        ));
        let of_dan: Vec<_> = told.iter().filter(|(_, robot, _)| *robot == 3).collect();
        let none = Refusal::None;
        assert_eq!(of_dan, [&(EventKind::Wait, 3, none)], "{recovery}: {told:?}");
        assert!(last.snapshot.robots[3].motion.speed.abs() < 1e-3, "{recovery}");
        assert_eq!(last.leaders[1..], [None; 3], "{recovery}");
        assert!(last.snapshot.robots[1].motion.speed > 0.5, "bob goes on");
    }
    let patience = "[hand_over]\npatience = 2.0\n[[events]]\nat = 3.0\nrobot = \"cy\"\nfails = \"stop\"";
    assert!(told(patience).0.contains(&(EventKind::GiveUp, 3, Refusal::None)));
}

#[test]
fn the_lead_robot_is_not_succeeded_by_one_with_several_leaders() {
    let (told, last) = told("[[events]]\nat = 3.0\nrobot = \"ann\"\nfails = \"stop\"\nrecovery = \"graft\"");
    assert!(told.contains(&(EventKind::Lead, 2, Refusal::None)), "{told:?}");
    // Its two leaders are still there: dan goes on behind them.
    assert_eq!(last.leaders[2..], [Some(1), Some(2)]);
    assert!(last.snapshot.robots[3].motion.speed > 0.3);
}

#[test]
fn one_with_several_leaders_may_drive_on_its_own_and_fail() {
    let (told_lead, last) =
        told("[[events]]\nat = 3.0\nrobot = \"dan\"\npath = { kind = \"constant\", speed = 0.4 }");
    assert_eq!(told_lead, [(EventKind::Lead, 3, Refusal::None)]);
    assert_eq!(last.leaders, [Some(0), Some(0), None, None]);
    assert!((last.snapshot.robots[3].motion.speed - 0.4).abs() < 1e-2);
    let (told_fail, last) = told("[[events]]\nat = 3.0\nrobot = \"dan\"\nfails = \"coast\"");
    assert_eq!(told_fail, [(EventKind::Coast, 3, Refusal::None)]);
    assert_eq!(last.leaders[2..], [None; 2]);
}

/// Nobody knows beforehand that the formation of `zoe` will have such a robot in it.
#[test]
fn places_are_not_taken_anew_where_one_has_several_leaders() {
    let zoe =
        "[[robots]]\nname = \"zoe\"\npose = [2.0, 0.0, 0.0]\npath = { kind = \"constant\", speed = 0.6 }\n";
    let follow = "[[events]]\nat = 2.0\nrobot = \"ann\"\nleader = \"zoe\"\n";
    let (told, last) = told(&format!("{zoe}{follow}[[events]]\nat = 6.0\nassign = \"zoe\""));
    assert_eq!(told, [(EventKind::Follow, 0, Refusal::None), (EventKind::Assign, 4, Refusal::Several)]);
    assert_eq!(last.leaders, [Some(0), Some(0), Some(1), Some(2), Some(4)]);
}

#[test]
fn a_log_brings_it_back_bit_for_bit() {
    let scene = scene("");
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path().join("run");
    let mut simulation = simulation(&scene);
    let mut recorder =
        Recorder::create(&at, simulation.fleet(), studies::run_options(&scene)).expect("a recorder");
    let mut records = vec![];
    while let Some(record) = simulation.next_record() {
        recorder.push(record).expect("recorded");
        records.push(record.clone());
    }
    recorder.finish(Status::Complete).expect("finished");
    let log = Log::open(&at.join(FILE)).expect("a log");
    assert_eq!(log.fleet(), simulation.fleet());
    let back: Vec<StepRecord> = log.records().map(|record| record.expect("sound")).collect();
    assert_eq!(back, records);
}

#[test]
fn the_theorems_are_about_one_leader() {
    let scene = scene("");
    let mut simulation = simulation(&scene);
    let mut examiner = Examiner::new(&scene, &simulation, false);
    while simulation.next_record().is_some() {
        examiner.push(&simulation);
    }
    let all = examiner.finish(&simulation);
    assert_eq!(all.len(), 4);
    for certificate in &all {
        let several = certificate.edge >= 2;
        let words: Vec<String> =
            certificate.findings.iter().flat_map(|finding| &finding.unmet).map(Premise::words).collect();
        let told = words.iter().any(|words| words.starts_with("the theorems are about one leader"));
        assert_eq!(told, several, "{words:?}");
        assert!(certificate.unbroken() && (!several || certificate.constants.is_none()));
    }
}

#[test]
fn a_robot_in_line_with_both_leaders_is_told() {
    assert!(in_line(&simulation(&scene(""))).is_empty());
    let mut narrow = scene("");
    let Role::Follow(follow) = &mut narrow.robots[3].role else { panic!("dan follows") };
    follow.leaders.first.distance = Some(ScalarTrajectory::Constant(1.415));
    follow.leaders.also[0].distance = Some(ScalarTrajectory::Constant(1.415));
    let told = in_line(&simulation(&narrow)).join("\n");
    assert!(
        told.contains("`dan` keeps its distances to `bob` and `cy` and is to be nearly in line"),
        "{told}"
    );
    follow_distance(&mut narrow, 1.3);
    let told = in_line(&simulation(&narrow)).join("\n");
    assert!(told.contains("which do not meet where these are 2.83 m apart"), "{told}");
    let mut beside = scene("");
    beside.robots[3].pose = vocabulary::Pose::new(-1.4, 0.0, 0.0);
    let told = in_line(&simulation(&beside)).join("\n");
    assert!(told.contains("and starts nearly in line with them, 180°"), "{told}");
}

fn follow_distance(scene: &mut Scene, distance: f64) {
    let Role::Follow(follow) = &mut scene.robots[3].role else { panic!("dan follows") };
    follow.leaders.first.distance = Some(ScalarTrajectory::Constant(distance));
    follow.leaders.also[0].distance = Some(ScalarTrajectory::Constant(distance));
}
