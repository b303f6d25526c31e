//! Every shipped scene runs as it ran before: its digest is the one written down in `digests.txt`.
//!
//! A digest depends on how the platform computes sines and the like, so the file also holds a digest of its mathematics. On
//! another platform, runs are compared by where the robots end.

use metrics::Digest;
use scene::{SHIPPED, Scene};
use simulation::{Simulation, build};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use vocabulary::{RobotState, Snapshot, StepRecord};

/// Longest part of a scene that is run, s: long enough for every law to settle and every vehicle to meet what is in its way.
const LONGEST: f64 = 12.0;
/// How far robots may end from where they ended on another platform, m.
const APART: f64 = 1e-2;

/// A scene and what is set in it.
struct Case {
    name: &'static str,
    sensing: Option<&'static str>,
}

/// Every scene with truth or noise as it is; cameras as their geometry, which needs no graphics adapter.
fn cases() -> Vec<Case> {
    let mut cases: Vec<Case> = SHIPPED
        .iter()
        .map(|shipped| {
            let sensing = shipped.name.starts_with("vision-").then_some("geometric");
            Case { name: shipped.name, sensing }
        })
        .collect();
    cases.extend(["seven-v", "cars-line-three"].map(|name| Case { name, sensing: Some("noise") }));
    cases.extend(["circle-three", "cars-yard"].map(|name| Case { name, sensing: Some("geometric") }));
    cases
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_path_buf()
}

/// Runs a case and gives its line: name, sensing, seconds, digest, where the first and the last robot end.
fn line(case: &Case) -> String {
    let path = folder().join("../scenes").join(format!("{}.toml", case.name));
    let mut overrides: Vec<_> = case
        .sensing
        .iter()
        .map(|kind| format!("sensing.kind={kind}").parse().expect("an override"))
        .collect();
    let whole = Scene::load(&path, &overrides).expect("a shipped scene").scene.time.duration;
    let duration = whole.min(LONGEST);
    overrides.push(format!("time.duration={duration}").parse().expect("an override"));
    let scene = Scene::load(&path, &overrides).expect("a shorter scene").scene;
    let mut simulation = Simulation::new(build(&scene).expect("a formation"));
    let (mut digest, mut ends) = (Digest::default(), String::new());
    while let Some(record) = simulation.next_record() {
        digest.push(record);
        let robots = &record.snapshot.robots;
        ends.clear();
        for robot in [&robots[0], &robots[robots.len() - 1]] {
            write!(ends, " {:.6} {:.6}", robot.motion.pose.x, robot.motion.pose.y).expect("a string");
        }
    }
    format!("{} {} {duration} {}{ends}", case.name, case.sensing.unwrap_or("own"), digest.text())
}

/// A digest of the functions that platforms compute differently in the last bit.
fn platform() -> String {
    let functions: [fn(f64) -> f64; 8] = [
        f64::sin,
        f64::cos,
        f64::tan,
        f64::exp,
        f64::tanh,
        |x| x.atan2(0.7),
        |x| x.hypot(0.3),
        |x| x.abs().powf(1.7),
    ];
    let mut digest = Digest::default();
    for k in 0..4000 {
        let x = -7.0 + 0.003_512_3 * f64::from(k);
        for function in functions {
            let mut robot = RobotState::default();
            robot.motion.pose.x = function(x);
            let snapshot = Snapshot { time: x, robots: vec![robot], props: vec![] };
            digest.push(&StepRecord { snapshot, ..StepRecord::default() });
        }
    }
    digest.text()
}

/// The lines of `digests.txt`: `UPDATE_DIGESTS=1` writes them anew.
#[test]
fn shipped_scenes_run_as_before() {
    let cases = cases();
    let lines: Vec<String> = std::thread::scope(|scope| {
        let part = |part| scope.spawn(move || <[Case]>::iter(part).map(line).collect::<Vec<_>>());
        let work: Vec<_> = cases.chunks(cases.len().div_ceil(2)).map(part).collect();
        work.into_iter().flat_map(|thread| thread.join().expect("it ran")).collect()
    });
    let platform = format!("platform {}", platform());
    let path = folder().join("digests.txt");
    if std::env::var_os("UPDATE_DIGESTS").is_some() {
        std::fs::write(&path, format!("{platform}\n{}\n", lines.join("\n"))).expect("digests.txt");
    }
    let text = std::fs::read_to_string(&path).expect("digests.txt");
    let written: Vec<&str> = text.lines().collect();
    assert_eq!(written.len(), lines.len() + 1, "another number of scenes than in digests.txt");
    for (before, now) in written[1..].iter().zip(&lines) {
        if written[0] == platform {
            assert_eq!(before, now);
        } else {
            assert_alike(before, now);
        }
    }
}

/// The same scene, and robots that end at nearly the same places.
fn assert_alike(before: &str, now: &str) {
    let (before, now): (Vec<&str>, Vec<&str>) = (before.split(' ').collect(), now.split(' ').collect());
    assert_eq!(before[..3], now[..3]);
    assert_eq!(before.len(), now.len());
    for (a, b) in before[4..].iter().zip(&now[4..]) {
        let [a, b] = [a, b].map(|text| text.parse::<f64>().expect("a number"));
        assert!((a - b).abs() < APART, "{before:?}\n{now:?}");
    }
}
