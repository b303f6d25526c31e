//! What becomes of copies is what becomes of runs.

use super::*;
use metrics::Digest;

#[derive(Default)]
struct DigestSink(Digest);

impl CopySink for DigestSink {
    fn take(&mut self, record: &StepRecord) {
        self.0.push(record);
    }
}

fn scene() -> Scene {
    let sets = ["expect={}".parse().expect("a set"), "time.duration=1".parse().expect("a set")];
    Scene::load(std::path::Path::new("circle-three"), &sets).expect("a scene").scene
}

fn config(scene: &Scene, residual: bool, scatter: f64) -> CopyConfig {
    let robots = ["follower-1", "follower-2"].map(|name| scene.index_of(name).expect("a robot"));
    let scale = Command { acceleration: 2.0, turn_rate: 1.0 };
    let agents = robots.iter().enumerate().map(|(edge, &robot)| Agent { robot, edge, scale }).collect();
    CopyConfig {
        agents,
        columns: vec!["error.distance".parse().expect("a column"), "own.speed".parse().expect("a column")],
        residual,
        samples: 1,
        scatter: StartScatter { robots: robots.to_vec(), position: scatter, heading: 0.0 },
        caption: None,
    }
}

/// Drives `count` copies by the same actions; their digests, and the last observations of the first.
fn drive(config: &CopyConfig, count: usize, steps: usize, action: f64) -> (Vec<String>, Vec<f64>) {
    let mut copies = Copies::new(scene(), config.clone(), count, None, |_| DigestSink::default());
    let episode = |copy: usize| Some(Episode { seed: copy as u64, number: 0 });
    copies.reset(&(0..count).map(episode).collect::<Vec<_>>()).expect("starts");
    let (agents, columns) = (config.agents.len(), config.columns.len());
    let mut observations = vec![0.0; count * agents * columns];
    let mut signals = vec![0.0; count * agents * SIGNALS.len()];
    let mut progress = vec![CopyStatus::Blank; count];
    for _ in 0..steps {
        let outcome =
            Outcome { observations: &mut observations, signals: &mut signals, progress: &mut progress };
        copies.step(&vec![action; count * agents * ACTION], &vec![false; count], outcome).expect("a step");
    }
    let digest = |copy| copies.copy(copy).expect("a copy").1.0.text();
    ((0..count).map(digest).collect(), observations[..agents * columns].to_vec())
}

#[test]
fn corrections_of_nothing_leave_the_run_of_the_scene() {
    let scene = scene();
    let mut simulation = Simulation::new(build(&scene).expect("a setup"));
    let mut digest = Digest::default();
    for _ in 0..50 {
        digest.push(simulation.next_record().expect("a record"));
    }
    let (digests, _) = drive(&config(&scene, true, 0.0), 1, 50, 0.0);
    assert_eq!(digests, [digest.text()]);
    assert_ne!(drive(&config(&scene, true, 0.0), 1, 50, 0.1).0, [digest.text()]);
}

#[test]
fn a_step_in_halves_is_a_step_and_a_half_is_done_once() {
    let setup = || build(&scene()).expect("a setup");
    let (mut whole, mut halves) = (Simulation::new(setup()), Simulation::new(setup()));
    for _ in 0..100 {
        assert!(halves.sense() && halves.sense());
        let mut other = halves.save();
        assert!(halves.act([]) && whole.next_record().is_some() && other.next_record().is_some());
        assert_eq!(halves.record(), whole.record());
        assert_eq!(other.record(), whole.record());
    }
}

#[test]
fn a_copy_is_the_same_among_few_and_many() {
    let config = config(&scene(), false, 0.3);
    let (many, seen) = drive(&config, 3 * SHARED_FROM, 20, 0.05);
    let (few, also) = drive(&config, 2, 20, 0.05);
    assert_eq!((&many[..2], seen), (&few[..], also));
    assert_ne!(many[0], many[1]);
}

#[test]
fn a_fault_is_told_with_its_copy_and_without() {
    let scene = scene();
    let mut copies =
        Copies::new(scene.clone(), config(&scene, false, 0.0), 2, None, |_| DigestSink::default());
    let told = copies.told().expect_err("no episode");
    assert_eq!(told.to_string(), "copy 0: its episode has not begun: reset it first");
    let mut actions = vec![0.0; 2 * 2 * ACTION];
    actions[7] = f64::NAN;
    let outcome = Outcome { observations: &mut [], signals: &mut [], progress: &mut [] };
    let error = copies.step(&actions, &[false; 2], outcome).expect_err("no number");
    assert_eq!((error.copy, matches!(error.fault, CopyFault::NotFinite { .. })), (1, true));
    let fault = "the turn rate of `follower-2` is NaN: an action is a finite number, −1 to 1";
    assert_eq!((error.fault.to_string(), error.to_string()), (fault.to_owned(), format!("copy 1: {fault}")));
}
