//! Runs that were recorded are looked through in the window, without simulating.

use crate::common::{Rig, THREE, run, scene};
use lab::action::Action;
use recording::log::{FILE, Log, Roll};
use recording::{Judging, Recorder, RunOptions, Status};
use simulation::Simulation;
use std::path::Path;

/// Records a scene; its folder.
fn record(text: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene(text);
    let mut run = Simulation::new(simulation::build(&scene).expect("a run"));
    let options = RunOptions {
        csv: false,
        no_log: false,
        roll: Roll::default(),
        force: false,
        scene: scene.to_toml(),
        program: "a test".to_owned(),
        commit: None,
        seed: scene.seed,
        period: scene.time.period,
        judging: Judging { settling_band: [0.02; 2], settled_after: 0.0 },
    };
    let mut recorder = Recorder::create(folder.path(), run.cast(), options).expect("a recorder");
    while let Some(moment) = run.next_moment() {
        recorder.push(moment).expect("recorded");
    }
    recorder.finish(Status::Complete).expect("finished");
    folder
}

fn opened(folder: &Path) -> Rig {
    let mut rig = Rig::new(THREE);
    let log = Log::open(&folder.join(FILE)).expect("a log");
    rig.desk.open_recorded(log, &folder.join("scene.toml")).expect("a scene");
    rig.send();
    while rig.desk.end() < 9.0 {
        let news = rig.next();
        rig.desk.hear(news);
    }
    rig
}

#[test]
fn a_recorded_run_is_all_there_and_stands_where_one_looks() {
    let folder = record(THREE);
    let mut rig = opened(folder.path());
    assert!(rig.desk.recorded && rig.desk.cursor == Some(0.0) && !rig.desk.playing);
    let mut digest = recording::Digest::default();
    let history = rig.desk.history.as_ref().expect("a past");
    let all = history.between(0, [0.0, 20.0], usize::MAX);
    for moment in &all {
        digest.push(moment);
    }
    assert_eq!((all.len() as u64, digest.text()), run(THREE));
    assert!(rig.desk.act(&Action::Seek(4.5)));
    assert_eq!(rig.desk.moment().expect("a moment").snapshot.time, 4.5);
    assert!(rig.desk.act(&Action::Step));
    assert!((rig.desk.time() - 4.51).abs() < 1e-9);
}

#[test]
fn it_plays_by_the_clock_to_its_end_and_from_there_anew() {
    let folder = record(THREE);
    let mut rig = opened(folder.path());
    assert!(rig.desk.act(&Action::Toggle) && rig.desk.roll(1.0));
    assert!((rig.desk.time() - 1.0).abs() < 1e-12);
    assert!(rig.desk.act(&Action::Pace(4.0)) && rig.desk.roll(1.0));
    assert!((rig.desk.time() - 5.0).abs() < 1e-12);
    assert!(!rig.desk.roll(2.0) && rig.desk.cursor.is_none() && !rig.desk.playing);
    assert!(rig.desk.act(&Action::Toggle) && rig.desk.roll(0.1) && rig.desk.time() < 1.0);
}

#[test]
fn whoever_changes_something_runs_the_scene_anew() {
    let folder = record(THREE);
    let mut rig = opened(folder.path());
    assert!(rig.desk.act(&Action::Seek(2.0)) && rig.desk.act(&Action::Fork));
    assert!(rig.desk.notice.as_ref().is_some_and(|notice| notice.contains("no branches")));
    let set = Action::SetPoint { edge: 0, distance: 1.5, bearing: 2.356 };
    rig.act(&[set]);
    assert!(!rig.desk.recorded && rig.text().contains("1.5"));
    assert!((rig.desk.end() - 2.0).abs() < 0.05, "{}", rig.desk.end());
    rig.steps(3);
    assert!((rig.desk.end() - 2.03).abs() < 0.05);
}
