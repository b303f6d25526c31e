//! What a run keeps in memory does not grow with its length: bytes that live, counted by the allocator.

use cap::Cap;
use recording::{Recorder, RunOptions};
use scene::Scene;
use simulation::{Simulation, build};
use std::alloc::System;
use studies::certify::Examiner;
use studies::run_options;

#[global_allocator]
static ALLOCATOR: Cap<System> = Cap::new(System, usize::MAX);

/// Samples between two looks: tables close a part as often.
const STRETCH: usize = 1500;

#[test]
fn a_run_that_goes_on_takes_no_more_memory() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/figure-eight-seven.toml");
    let scene =
        Scene::load(path, &["time.duration=150".parse().expect("an override")]).expect("a scene").scene;
    let mut simulation = Simulation::new(build(&scene).expect("a run"));
    let folder = tempfile::tempdir().expect("a folder");
    let options = RunOptions { no_log: true, ..run_options(&scene) };
    let mut recorder =
        Recorder::create(&folder.path().join("run"), simulation.fleet(), options).expect("a recorder");
    let mut examiner = Examiner::new(&scene, &simulation, false);
    let mut stretch = || {
        for _ in 0..STRETCH {
            recorder.push(simulation.next_record().expect("a moment")).expect("recorded");
            examiner.push(&simulation);
        }
        ALLOCATOR.allocated()
    };
    let settled = (0..4).map(|_| stretch()).max().expect("stretches");
    let later = (0..5).map(|_| stretch()).max().expect("stretches");
    // Kept samples would be 7500 times 6 edges times some 100 bytes: more than 4 MB.
    assert!(later < settled + 100_000, "{settled} bytes, then {later}");
}
