//! Bearings against a path's heading, and followers that stop with their leader: what whole runs show.

use metrics::{EdgeMetrics, MetricsBuilder};
use scene::{Override, Scene, shipped};
use simulation::{Simulation, build};
use vocabulary::{MotionPhase, StepRecord, TimeMode, math};

fn scene(name: &str, sets: &[&str]) -> Scene {
    let sets: Vec<Override> = sets.iter().map(|set| set.parse().expect("an override")).collect();
    let text = shipped(name).expect("a shipped scene").text;
    Scene::parse(text, "t.toml", &sets).unwrap_or_else(|fault| panic!("{fault}")).scene
}

fn fault(name: &str, sets: &[&str]) -> String {
    let sets: Vec<Override> = sets.iter().map(|set| set.parse().expect("an override")).collect();
    Scene::parse(shipped(name).expect("a shipped scene").text, "t.toml", &sets)
        .err()
        .map_or_else(String::new, |fault| fault.to_string())
}

/// Runs a scene; `visit` sees every moment.
fn run(scene: &Scene, mut visit: impl FnMut(&StepRecord)) -> Vec<EdgeMetrics> {
    let mut simulation = Simulation::new(build(scene).expect("a run"));
    let mut metrics = MetricsBuilder::new(simulation.fleet(), scene.judging());
    while let Some(record) = simulation.next_record() {
        metrics.push(record);
        visit(record);
    }
    assert!(simulation.fault().is_none(), "{:?}", simulation.fault());
    metrics.finish().edges
}

/// Half the range of every robot's heading once the waves have gone down the chain, rad.
fn swings(sets: &[&str]) -> Vec<f64> {
    let scene = scene("chain-twenty", sets);
    let mut ranges = vec![[f64::INFINITY, f64::NEG_INFINITY]; scene.robots.len()];
    run(&scene, |record| {
        if record.snapshot.time < 35.0 {
            return;
        }
        for (range, robot) in ranges.iter_mut().zip(&record.snapshot.robots) {
            let heading = robot.motion.pose.heading;
            *range = [range[0].min(heading), range[1].max(heading)];
        }
    });
    ranges.into_iter().map(|[low, high]| 0.5 * (high - low)).collect()
}

/// What a follower straight behind does with its leader's swing, in closed form: |1 − d s H(s)| at s = i k, with
/// H = (1 + (2λ − τ) s)/(1 + λ s)²; without filter H = 1.
fn passed_on(k: f64, distance: f64, filter: Option<[f64; 2]>) -> f64 {
    let Some([length, lag]) = filter else { return math::hypot(1.0, distance * k) };
    let top = [
        1.0 - length * length * k * k + distance * (2.0 * length - lag) * k * k,
        (2.0 * length - distance) * k,
    ];
    math::hypot(top[0], top[1]) / (1.0 + length * length * k * k)
}

/// Waves of 0.5 rad/s at 0.8 m/s.
const K: f64 = 0.5 / 0.8;

#[test]
fn in_a_column_of_twenty_no_swing_grows_along_a_path() {
    let swings = swings(&[]);
    let share = passed_on(K, 1.0, Some([1.0, 0.5]));
    assert!(share < 1.0);
    for (k, pair) in swings.windows(2).enumerate() {
        assert!(pair[1] <= pair[0], "robot {} swings wider than the one before: {pair:?}", k + 2);
        let found = pair[1] / pair[0];
        assert!((found - share).abs() < 0.01, "robot {}: ×{found}, in closed form ×{share}", k + 2);
    }
}

#[test]
fn counted_from_the_leaders_own_heading_every_swing_is_wider() {
    let swings = swings(&["law.heading=leader"]);
    let share = passed_on(K, 1.0, None);
    // The closed form is linear: later robots swing by half a radian and more.
    for (k, pair) in swings.windows(2).enumerate().take(5) {
        assert!((pair[1] / pair[0] - share).abs() < 0.04, "robot {}: ×{}", k + 2, pair[1] / pair[0]);
    }
    assert!(swings[20] > 5.0 * swings[0], "{swings:?}");
}

/// Without a lag the swing of long waves grows as it does without a filter: the lag is what a chain needs.
#[test]
fn a_filter_without_lag_lets_long_waves_grow() {
    let swings = swings(&["law.heading_lag=0"]);
    let share = passed_on(K, 1.0, Some([1.0, 0.0]));
    assert!(share > 1.05);
    for (k, pair) in swings.windows(2).enumerate().take(6) {
        assert!(
            (pair[1] / pair[0] - share).abs() < 0.03,
            "robot {}: ×{}, not {share}",
            k + 2,
            pair[1] / pair[0]
        );
    }
}

/// Largest turn rate at a stand in rad/s, and farthest from a set point there, m.
fn standing(edges: &[EdgeMetrics]) -> [f64; 2] {
    edges.iter().fold([0.0, 0.0], |[turn, error], edge| {
        let found = edge.standing.expect("its leader stands");
        [turn.max(found.turn_rate), error.max(found.error)]
    })
}

#[test]
fn seven_stop_with_their_leader_stand_and_start_again() {
    for (name, most) in [("stop-and-go", 0.03), ("stop-and-go-curve", 0.08)] {
        for seed in 0..5 {
            let scene = scene(name, &[&format!("seed={seed}")]);
            let (mut phases, mut at_stop) = (vec![], vec![]);
            let edges = run(&scene, |record| {
                let time = record.snapshot.time;
                if (time - 15.0).abs() < 1e-6 {
                    phases = record.edges.iter().map(|edge| edge.phase).collect();
                    at_stop = record.snapshot.robots.iter().map(|robot| robot.motion.speed).collect();
                }
            });
            assert!(phases.iter().all(|phase| *phase == MotionPhase::Hold), "{name} {seed}: {phases:?}");
            assert!(at_stop.iter().all(|speed| *speed < 1e-6), "{name} {seed}: they creep, {at_stop:?}");
            let [turn, error] = standing(&edges);
            assert!(turn < 1e-3 && error <= most, "{name} {seed}: {turn} rad/s, {error} m");
            assert!(edges.iter().all(|edge| edge.final_error[0].abs() < 0.005), "{name} {seed}");
        }
    }
}

/// The paper's law alone spins: what the rule is for.
#[test]
fn without_the_rule_and_the_filter_followers_spin_at_a_stand() {
    let mut fastest = 0.0_f64;
    run(&scene("stop-and-go-curve", &["law.standing=false", "law.heading=leader"]), |record| {
        if (11.0..15.9).contains(&record.snapshot.time) {
            let turns = record.edges.iter().map(|edge| edge.applied.turn_rate.abs());
            fastest = turns.fold(fastest, f64::max);
        }
    });
    assert!(fastest > 10.0, "{fastest} rad/s");
}

/// Starting again, no command jumps: from sample to sample turn rates change by less than they may at a stand.
#[test]
fn they_start_without_a_jump() {
    let mut last: Vec<f64> = vec![];
    let mut largest = 0.0_f64;
    run(&scene("stop-and-go", &[]), |record| {
        let rates: Vec<f64> = record.edges.iter().map(|edge| edge.applied.turn_rate).collect();
        if record.snapshot.time > 15.9 {
            largest = last.iter().zip(&rates).map(|(a, b)| (a - b).abs()).fold(largest, f64::max);
        }
        last = rates;
    });
    assert!(largest < 0.2, "{largest} rad/s from one sample to the next");
}

/// Measurements with noise: the line's direction comes from the follower's own heading and its sensor.
/// A truck that heads away from its place cannot turn on the spot: it turns round while it drives.
#[test]
fn a_truck_that_heads_the_other_way_turns_round() {
    let text = r#"
schema = 1
title = "The other way"
[time]
duration = 30.0
[vehicle]
kind = "car"
[law]
k = 2.0
beta = 1.5
slope = 8.0
heading = "path"
standing = true
[[robots]]
name = "lead"
pose = [0, 0, 0]
path = { kind = "constant", speed = 0.8 }
[[robots]]
name = "truck"
leader = "lead"
distance = 2.0
bearing = "180 deg"
pose = [-2, 0, "180 deg"]
speed = 0.0
"#;
    let scene = Scene::parse(text, "scene.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let edges = run(&scene, |_| ());
    let [distance, bearing] = edges[0].final_error;
    assert!(distance.abs() < 0.05 && bearing.abs() < 0.05, "{distance} m, {bearing} rad off");
}

#[test]
fn with_noise_they_stand_near_their_places() {
    for observer in ["high-gain", "unscented"] {
        let kind = format!("observer.kind={observer}");
        let edges = run(&scene("stop-and-go", &["sensing=noise", &kind]), |_| {});
        let [turn, error] = standing(&edges);
        assert!(turn < 0.1 && error < 0.25, "{observer}: {turn} rad/s, {error} m");
    }
}

/// All laws, and an observer that sees samples only, hold a bearing against a path's heading.
#[test]
fn every_law_and_mode_settles_against_a_paths_heading() {
    let circle = ["law.heading=path", "time.duration=20"];
    for more in
        ["law.kind=full-state", "law.kind=robust-state", "law.kind=output-feedback", "time.mode=measured"]
    {
        let scene = scene("circle-three", &[&circle[..], &[more]].concat());
        assert_ne!(scene.time.mode, TimeMode::Continuous);
        for edge in run(&scene, |_| {}) {
            assert!(edge.final_error[0].abs() < 0.02 && edge.final_error[1].abs() < 0.02, "{more}: {edge:?}");
        }
    }
}

/// The heading may change its reference and the rule may go on while a run goes.
#[test]
fn reference_and_rule_may_change_during_a_run() {
    let text = shipped("stop-and-go")
        .expect("a shipped scene")
        .text
        .replace("standing = true\n", "")
        .replace("heading = \"path\"\n", "")
        + "\n[[changes]]\nat = 4.0\nset = [\"law.heading=path\", \"law.standing=true\"]\n";
    let scene = Scene::parse(&text, "t.toml", &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    let mut late = 0.0_f64;
    let edges = run(&Scene { expect: scene::Expect::default(), ..scene }, |record| {
        if record.snapshot.time > 5.0 && record.snapshot.time < 8.0 {
            late = record.edges.iter().map(|edge| edge.error[0].abs()).fold(late, f64::max);
        }
    });
    let [turn, error] = standing(&edges);
    assert!(late < 0.1, "{late} m after the change");
    assert!(turn < 1e-3 && error < 0.03, "{turn} rad/s, {error} m");
}

#[test]
fn what_cannot_be_is_refused_in_words() {
    let lag = fault("chain-twenty", &["law.heading_lag=2.5"]);
    assert!(lag.contains("`heading_lag` of 2.5 m must be at most twice `heading_length`"), "{lag}");
    let leader = fault("stop-and-go", &["law.heading=leader"]);
    assert!(leader.contains("`standing` needs `heading = \"path\"`"), "{leader}");
    let continuous = scene("chain-twenty", &["time.mode=continuous"]);
    let refused = build(&continuous).err().map(|fault| fault.to_string()).unwrap_or_default();
    assert!(refused.contains("mode \"sampled\""), "{refused}");
}

#[test]
fn a_lead_that_stops_before_followers_that_cannot_is_told_of() {
    let told = |sets: &[&str]| {
        let scene = scene("stop-and-go", sets);
        let simulation = Simulation::new(build(&scene).expect("a run"));
        simulation::too_slow_leads(&simulation, scene.time.duration)
    };
    assert_eq!(told(&[]), Vec::<String>::new());
    let [note] = &told(&["law.standing=false"])[..] else { panic!("one note") };
    for part in
        ["`robot-1`", "0 m/s at the least", "`speed_min` of 0.01 m/s", "8.8 s", "5 more", "`standing = true`"]
    {
        assert!(note.contains(part), "{part} is missing: {note}");
    }
}

/// Up, down and across a slope of 1 in 10, with a filter that has nothing to do.
#[test]
fn trucks_and_differential_drives_stand_on_a_slope() {
    for kind in ["car", "differential"] {
        for slope in [[0.1, 0.0], [-0.1, 0.0], [0.0, 0.1]] {
            let height = |i: u32, j: u32| 8.0 + 2.0 * (slope[0] * f64::from(i) + slope[1] * f64::from(j));
            let rows: Vec<Vec<f64>> = (0..16).map(|j| (0..31).map(|i| height(i, j)).collect()).collect();
            let ground =
                format!("ground={{ kind = \"table\", origin = [-20, -15], cell = 2, heights = {rows:?} }}");
            let vehicle = format!("vehicle.kind={kind}");
            let sets = [&*ground, &*vehicle, "proximity.range=4", "safety.filter=true", "groups.0.count=3"];
            let mut places: Vec<[f64; 2]> = vec![];
            let mut rolled: f64 = 0.0;
            let edges = run(&scene("cars-stop-and-go", &sets), |record| {
                if !(11.0..16.0).contains(&record.snapshot.time) {
                    return;
                }
                // The leader still creeps up to its own place.
                let followers = record.snapshot.robots.iter().skip(1);
                let now = followers.map(|robot| [robot.motion.pose.x, robot.motion.pose.y]);
                if places.is_empty() {
                    places = now.collect();
                } else {
                    let off = now.zip(&places).map(|(a, b)| math::hypot(a[0] - b[0], a[1] - b[1]));
                    rolled = rolled.max(off.fold(0.0, f64::max));
                }
            });
            assert!(rolled < 1e-3, "{kind} on {slope:?}: {rolled} m in 5 s");
            let [turn_rate, error] = standing(&edges);
            assert!(turn_rate < 0.02 && error < 0.15, "{kind} on {slope:?}: {turn_rate} rad/s, {error} m");
        }
    }
}
