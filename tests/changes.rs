//! Changes while a run goes: written in the scene or adopted on the way, they make the same run bit for bit.

use metrics::Digest;
use scene::{Override, Scene};
use simulation::{Simulation, build};
use vocabulary::StepRecord;

const THREE: &str = "\
schema = 1
title = \"Three\"
time = { duration = 3.0, period = 0.01 }
[[robots]]
name = \"leader\"
pose = [0.0, 0.0, 0.0]
path = { kind = \"circle\", speed = 1.0, turn_rate = 0.3 }
[[robots]]
name = \"left\"
pose = [-2.0, 1.0, 0.0]
speed = 0.8
leader = \"leader\"
distance = 2.0
bearing = \"135 deg\"
[[robots]]
name = \"last\"
pose = [-3.5, 2.5, 0.0]
speed = 0.8
leader = \"left\"
distance = 2.0
bearing = \"170 deg\"
";

/// Set points, gains, an observer, limits.
const CHANGE: &str = "\
[[changes]]
at = 1.1
set = [
    \"robots.left.distance=1.7\", \"robots.last.bearing=-170 deg\", \"law.k=4\", \"observer.epsilon=0.015\",
    \"vehicle.speed_max=1.45\", \"vehicle.speed_min=0.25\", \"robots.last.law.slope=[9.0, 12.0]\",
]
";

fn scene(text: &str, sets: &[&str]) -> Scene {
    let sets: Vec<Override> = sets.iter().map(|set| set.parse().expect("an override")).collect();
    Scene::parse(text, "t.toml", &sets).unwrap_or_else(|fault| panic!("{fault}")).scene
}

fn simulation(scene: &Scene) -> Simulation {
    Simulation::new(build(scene).expect("a run"))
}

/// The digest of all that is left of a run, and what of it was true at `at` s.
fn finish(run: &mut Simulation, at: f64) -> (String, Option<StepRecord>) {
    let (mut sum, mut there) = (Digest::default(), None);
    while let Some(record) = run.next_record() {
        sum.push(record);
        if (record.snapshot.time - at).abs() < 1e-9 {
            there = Some(record.clone());
        }
    }
    (sum.text(), there)
}

/// The digest of the run of `start` that adopts what `scene` changes at the samples at which it does.
fn adopting(start: &Scene, scene: &Scene) -> String {
    let (mut run, mut sum) = (simulation(start), Digest::default());
    loop {
        for change in &scene.changes {
            if run.sample() == (change.at / run.period()).round() as u64 {
                run.apply_parameters(&build(&change.then).expect("a run"));
            }
        }
        let Some(record) = run.next_record() else { break };
        sum.push(record);
    }
    sum.text()
}

/// Every way of running: by samples, by measured samples, in continuous time, on wheels, by noisy measurements, among
/// props.
fn ways() -> Vec<(&'static str, Vec<&'static str>, &'static str)> {
    let mixed =
        "[[props]]\nname = \"post\"\nshape = \"cylinder\"\nradius = 0.1\nheight = 0.5\npose = [5, 5, 0]\n";
    vec![
        ("sampled", vec![], ""),
        ("measured", vec!["time.mode=measured"], ""),
        ("continuous", vec!["time.mode=continuous", "observer.epsilon=0.004"], ""),
        ("cars", vec!["vehicle=car"], ""),
        ("differential", vec!["robots.left.vehicle=differential"], ""),
        ("unicycles among props", vec![], mixed),
        ("noise", vec!["sensing={ kind = \"noise\", latency = 0.05 }"], ""),
        ("unscented", vec!["sensing=noise", "observer.kind=unscented"], ""),
    ]
}

#[test]
fn a_change_of_the_scene_and_one_adopted_make_the_same_run() {
    for (way, sets, more) in ways() {
        let start = scene(&format!("{THREE}{more}"), &sets);
        let changed = scene(&format!("{THREE}{more}{CHANGE}"), &sets);
        let (digest, there) = finish(&mut simulation(&changed), 1.1);
        assert_eq!(adopting(&start, &changed), digest, "{way}");
        assert_ne!(finish(&mut simulation(&start), 1.1).0, digest, "{way}");
        let resolved = scene(&changed.to_toml(), &[]);
        assert_eq!(finish(&mut simulation(&resolved), 1.1).0, digest, "{way}, resolved");
        let there = there.expect("a moment at the change");
        assert_eq!(there.edges[0].set_point[0], 1.7, "{way}: it shows at once");
        assert!(there.snapshot.robots.iter().all(|robot| robot.motion.pose.x.is_finite()));
    }
}

#[test]
fn a_copy_of_a_run_has_the_changes_that_are_to_come() {
    let changed = scene(&format!("{THREE}{CHANGE}"), &[]);
    let mut run = simulation(&changed);
    for _ in 0..50 {
        run.next_record().expect("a moment");
    }
    let mut copy = run.save();
    assert_eq!(finish(&mut copy, 1.1), finish(&mut run, 1.1));
}

#[test]
fn every_parameter_that_may_change_changes_the_run() {
    let first = "robots.left.law.kind=robust-state";
    for (set, start) in [
        ("robots.left.law.kind=full-state", ""),
        ("robots.left.law.kind=output-feedback", first),
        ("robots.left.law.beta=1", ""),
        ("robots.left.law.switching=sign", ""),
        ("robots.left.observer.alpha1=3", ""),
        ("robots.left.observer.alpha2=0.7", ""),
        ("vehicle.turn_rate_max=0.6", ""),
        ("vehicle.acceleration_max=0.5", ""),
        ("robots.last.distance={ mean = 2, amplitude = 0.2, rate = 2 }", ""),
        ("robots.last.bearing={ from = \"170 deg\", to = \"150 deg\", start = 0.5, over = 1 }", ""),
    ] {
        let sets: Vec<&str> =
            [start, "robots.last.distance=1.8"].into_iter().filter(|set| !set.is_empty()).collect();
        let text = format!("{THREE}[[changes]]\nat = 0.5\nset = ['{set}']\n");
        let (start, changed) = (scene(THREE, &sets), scene(&text, &sets));
        let (digest, _) = finish(&mut simulation(&changed), 0.0);
        assert_ne!(finish(&mut simulation(&start), 0.0).0, digest, "{set}");
        assert_eq!(adopting(&start, &changed), digest, "{set}");
    }
}

/// An observer that has slept starts at what it measures, not where it fell asleep.
#[test]
fn an_observer_that_wakes_starts_at_the_measurement() {
    let text = format!(
        "{THREE}[[changes]]\nat = 2.0\nset = ['law.kind=output-feedback', 'observer.epsilon=0.01']\n"
    );
    let scene = scene(&text, &["law.kind=robust-state"]);
    let mut run = simulation(&scene);
    let mut peak: f64 = 0.0;
    while let Some(record) = run.next_record() {
        if record.snapshot.time >= 2.0 {
            peak = record.edges.iter().fold(peak, |peak, edge| peak.max(edge.rates[0].abs()));
        }
    }
    assert!(peak < 1.0, "rates peak at {peak} m/s");
}

#[test]
fn a_speed_beyond_new_limits_comes_within_them() {
    for sets in [vec![], vec!["time.mode=continuous"], vec!["vehicle=differential"]] {
        let text = format!("{THREE}[[changes]]\nat = 1.5\nset = ['robots.left.vehicle.speed_max=0.5']\n");
        let mut run = simulation(&scene(&text, &sets));
        let mut last = 0.0;
        while let Some(record) = run.next_record() {
            last = record.snapshot.robots[1].motion.speed;
        }
        assert!(last < 0.53, "{sets:?}: {last} m/s");
    }
}

#[test]
fn a_run_can_be_extended_and_its_changes_replaced() {
    let changed = scene(&format!("{THREE}{CHANGE}"), &[]);
    let (mut long, mut short) =
        (simulation(&scene(&changed.to_toml(), &["time.duration=4"])), simulation(&scene(THREE, &[])));
    short.extend_to(4.0);
    assert_eq!((short.len(), short.sample()), (401, 0));
    for _ in 0..20 {
        assert_eq!(short.next_record(), long.next_record());
    }
    short.reschedule(&build(&changed).expect("a run"));
    assert_eq!(finish(&mut short, 1.1), finish(&mut long, 1.1));
}

#[test]
fn runs_move_between_threads() {
    fn is_send<T: Send>() {}
    is_send::<Simulation>();
    is_send::<simulation::Setup>();
}

/// A run lasts as long as it says, also where its end is no control sample.
#[test]
fn a_run_ends_with_the_first_sample_at_or_after_its_duration() {
    for (duration, period, samples) in [(1.0, 0.3, 5), (1.0, 0.1, 11), (0.3, 0.1, 4), (15.0, 0.01, 1501)] {
        let text = format!(
            "schema = 1\ntitle = \"t\"\ntime = {{ duration = {duration}, period = {period} }}\n[[robots]]\n\
             name = \"a\"\npose = [0, 0, 0]\npath = {{ kind = \"constant\" }}\n"
        );
        let scene = scene::Scene::parse(&text, "t.toml", &[]).expect("a scene").scene;
        let mut run = simulation::Simulation::new(simulation::build(&scene).expect("a run"));
        assert_eq!(run.len(), samples);
        while run.next_record().is_some() {}
        assert!(run.record().snapshot.time >= duration - 1e-9, "{} s", run.record().snapshot.time);
    }
}
