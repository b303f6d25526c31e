//! A fact has one home: whichever public path computes it, the same scene gives the same number.

use metrics::{EdgeMetrics, Metrics, MetricsBuilder};
use recording::log::{FILE, Log};
use recording::{Recorder, Status};
use report::Tracer;
use scene::{Scene, VehicleKind};
use std::path::Path;
use studies::SceneRun;
use studies::budget::{Budget, sensing_cases};
use studies::copies::StartScatter;
use studies::tune::TuneEffort;
use vocabulary::GRAVITY;
use vocabulary::math;

/// Two unicycles, and nothing that says from when on errors are judged: that is half time, 2 s.
const TWO: &str = "schema = 1\ntitle = \"t\"\n[time]\nduration = 4.0\n[[robots]]\nname = \"ann\"\npose = [0, 0, 0]\n\
    path = { kind = \"circle\", speed = 1.0, turn_rate = 0.3 }\n[[robots]]\nname = \"bob\"\npose = [-2, -1, 0]\n\
    speed = 0.8\nleader = \"ann\"\ndistance = 2.0\nbearing = \"-135 deg\"\n";

fn parse(text: &str) -> Scene {
    Scene::parse(text, "agreement.toml", &[]).expect("a scene").scene
}

fn run(scene: &Scene) -> SceneRun {
    SceneRun::new(scene.clone()).expect("a run")
}

/// Largest and root mean square error of the one edge, [m, rad], from half time on: by its definition, step by step.
fn late_error(scene: &Scene) -> [[f64; 2]; 2] {
    let mut simulation = run(scene).simulation;
    let mut late: Vec<[f64; 2]> = vec![];
    while let Some(record) = simulation.next_record() {
        if record.snapshot.time >= 0.5 * scene.time.duration {
            late.push(record.edges[0].error);
        }
    }
    assert_eq!(late.len(), 201);
    let peak = |k: usize| late.iter().fold(0.0, |most: f64, error| most.max(error[k].abs()));
    let mean = |k: usize| (late.iter().map(|error| error[k] * error[k]).sum::<f64>() / 201.0).sqrt();
    [[peak(0), peak(1)], [mean(0), mean(1)]]
}

fn of(metrics: &Metrics) -> [[f64; 2]; 2] {
    let EdgeMetrics { late_peak_error, late_rms_error, .. } = metrics.edges[0];
    [late_peak_error, late_rms_error]
}

/// The late error that a folder's `metrics.json` holds.
fn written(folder: &Path) -> [[f64; 2]; 2] {
    let text = std::fs::read_to_string(folder.join("metrics.json")).expect("metrics");
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let pair = |key: &str| [0, 1].map(|k| value["edges"][0][key][k].as_f64().expect("a number"));
    [pair("late_peak_error"), pair("late_rms_error")]
}

/// What `metrics` makes of the records of a log, as films and replays of a recorded run judge it.
fn of_log(log: &Log, scene: &Scene) -> [[f64; 2]; 2] {
    let judging = scene.expect.judging(log.fleet().duration);
    let mut metrics = MetricsBuilder::new(log.fleet(), judging);
    log.records().for_each(|record| metrics.push(&record.expect("a record")));
    of(&metrics.finish())
}

#[test]
fn one_digest_has_one_late_error() {
    let scene = parse(TWO);
    let wanted = late_error(&scene);
    assert!(wanted[0][0] > wanted[1][0] && wanted[1][0] > 0.0);
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);

    // `run`, recorded and not.
    let judged = studies::run::run(run(&scene), None, None, |_| true).expect("a run");
    assert_eq!(of(&judged.metrics), wanted, "run --no-record");
    let options = studies::run_options(&scene);
    let ready = run(&scene);
    let recorder = Recorder::create(&at("run"), ready.simulation.fleet(), options).expect("a recorder");
    let recorded = studies::run::run(ready, Some(recorder), None, |_| true).expect("a run");
    recorded.written.expect("written");
    assert_eq!((of(&recorded.metrics), recorded.status), (wanted, Status::Complete), "run");
    assert_eq!(written(&at("run")), wanted, "metrics.json of run");

    // What films and replays of the recorded run are judged by.
    let log = Log::open(&at("run").join(FILE)).expect("a log");
    assert_eq!(of_log(&log, &parse(log.scene())), wanted, "replay");

    // The lab writes its run down.
    let seen = lab::kept_run::SeenRun { samples: recorded.steps, digest: recorded.digest };
    lab::kept_run::keep(TWO, folder.path(), &at("kept"), &seen, None).expect("the digest that was seen");
    assert_eq!(written(&at("kept")), wanted, "lab");

    // The scene's own gains are the first trial.
    let effort = TuneEffort { most: 1, seeds: 1, scatter: StartScatter::default() };
    let [first, _] = studies::tune::tune(&scene, &effort, |_| false).expect("gains");
    assert_eq!(first.late_error, wanted[0], "tune");

    // The first case of a budget is the scene itself.
    let ready = run(&scene);
    let mut budget = Budget::new(&scene, ready.simulation.fleet().clone(), false);
    let cases = &sensing_cases(&[], false)[..1];
    budget.measure(cases, &mut |_| Err("nobody measures".to_owned()), |_, _| true).expect("a budget");
    assert_eq!(budget.runs[0].1.edges[0].tracking, wanted[1], "budget");

    // Figures.
    let mut simulation = run(&scene).simulation;
    let mut tracer = Tracer::new("t", &scene, &simulation, &[[0.0; 3]; 2], 1.0);
    while let Some(record) = simulation.next_record() {
        tracer.push(record);
    }
    let trace = tracer.finish();
    assert_eq!((of(&trace.metrics), trace.late_from()), (wanted, 2.0), "report");
    assert_eq!(trace.settled(0), Some(math::hypot(wanted[1][0], wanted[1][1])), "report");
}

/// A time that the scene gives takes the place of half time.
#[test]
fn late_errors_count_from_the_time_that_a_scene_gives() {
    let scene = parse(&format!("{TWO}[expect]\nsettled_after = 1.0\nsettled_error_at_most = [1.0, 1.0]\n"));
    assert_eq!(scene.judging().settled_after, 1.0);
    let [peak, _] = of(&studies::run::run(run(&scene), None, None, |_| true).expect("a run").metrics);
    assert!(peak[0] > late_error(&parse(TWO))[0][0], "errors are larger from 1 s on than from half time on");
}

/// What falls in the world falls as fast as the limits of vehicles assume.
#[test]
fn limits_and_the_world_have_one_gravity() {
    let falling = "schema = 1\ntitle = \"t\"\n[time]\nduration = 1.0\n[[robots]]\nname = \"ann\"\npose = [0, 0, 0]\n\
        path = { kind = \"constant\", speed = 1.0 }\n[[props]]\nname = \"crate\"\nshape = \"block\"\n\
        size = [0.2, 0.2, 0.2]\nmass = 1.0\npose = [0, 5, 0]\nelevation = 100.0\n";
    let scene = parse(falling);
    let mut simulation = run(&scene).simulation;
    let mut heights = vec![];
    while let Some(record) = simulation.next_record() {
        heights.push(record.snapshot.props[0].position[2]);
    }
    // Second differences know neither the speed at the start nor the size of a physics step.
    let [first, middle, last] = [heights[20], heights[50], heights[80]];
    let fell = (2.0 * middle - first - last) / math::powi(0.3_f64, 2);
    assert!((fell - GRAVITY).abs() < 1e-6, "{fell} m/s²");

    let car = scene::Vehicle::ready_made(VehicleKind::Car);
    let other = scene::Vehicle { friction: 2.0 * car.friction, ..car };
    let more = other.limits().lateral_acceleration_max - car.limits().lateral_acceleration_max;
    assert!((more / car.friction - 0.8 * GRAVITY).abs() < 1e-12, "0.8 of the grip is used");
}
