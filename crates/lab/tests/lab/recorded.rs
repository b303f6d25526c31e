//! Runs that were recorded are looked through in the window, without simulating.

use crate::common::{Rig, THREE, run, scene};
use lab::action::Action;
use recording::log::{FILE, Log, Roll};
use recording::{Recorder, RunOptions, Status};
use simulation::Simulation;
use std::path::Path;
use vocabulary::Judging;

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
    let mut recorder = Recorder::create(folder.path(), run.fleet(), options).expect("a recorder");
    while let Some(record) = run.next_record() {
        recorder.push(record).expect("recorded");
    }
    recorder.finish(Status::Complete).expect("finished");
    folder
}

fn opened(folder: &Path) -> Rig {
    let mut rig = Rig::new(THREE);
    let log = Log::open(&folder.join(FILE)).expect("a log");
    rig.app_state.open_recorded(log, &folder.join("scene.toml")).expect("a scene");
    rig.send();
    while rig.app_state.end() < 9.0 {
        let run_event = rig.next();
        rig.app_state.handle_event(run_event);
    }
    rig
}

#[test]
fn a_recorded_run_is_all_there_and_stands_where_one_looks() {
    let folder = record(THREE);
    let mut rig = opened(folder.path());
    assert!(rig.app_state.recorded && rig.app_state.cursor == Some(0.0) && !rig.app_state.playing);
    let mut digest = metrics::Digest::default();
    let history = rig.app_state.history.as_ref().expect("a past");
    let all = history.between(0, [0.0, 20.0], usize::MAX);
    for record in &all {
        digest.push(record);
    }
    assert_eq!((all.len() as u64, digest.text()), run(THREE));
    assert!(rig.app_state.act(&Action::Seek(4.5)));
    assert_eq!(rig.app_state.record().expect("a moment").snapshot.time, 4.5);
    assert!(rig.app_state.act(&Action::Step));
    assert!((rig.app_state.time() - 4.51).abs() < 1e-9);
}

#[test]
fn it_plays_by_the_clock_to_its_end_and_from_there_anew() {
    let folder = record(THREE);
    let mut rig = opened(folder.path());
    assert!(rig.app_state.act(&Action::Toggle) && rig.app_state.roll(1.0));
    assert!((rig.app_state.time() - 1.0).abs() < 1e-12);
    assert!(rig.app_state.act(&Action::Pace(4.0)) && rig.app_state.roll(1.0));
    assert!((rig.app_state.time() - 5.0).abs() < 1e-12);
    assert!(!rig.app_state.roll(2.0) && rig.app_state.cursor.is_none() && !rig.app_state.playing);
    assert!(rig.app_state.act(&Action::Toggle) && rig.app_state.roll(0.1) && rig.app_state.time() < 1.0);
}

/// A branch leaves the recording where one looks; the recording stays beside it.
#[test]
fn a_recorded_run_has_branches() {
    let folder = record(THREE);
    let mut rig = opened(folder.path());
    let (samples, digest) = run(THREE);
    let set = Action::SetPoint { edge: 0, distance: 1.5, bearing: 2.356 };
    assert!(rig.app_state.act(&Action::Seek(2.0)));
    rig.act(&[set]);
    assert!(!rig.app_state.recorded && rig.text().contains("1.5"));
    assert_eq!((rig.app_state.branches.len(), rig.app_state.branch), (2, 1));
    assert_eq!(rig.app_state.branches[1].parent, Some((0, 2.0)));
    assert!(
        rig.app_state.log.iter().any(|event| event.text.contains("bit for bit")),
        "{:?}",
        rig.app_state.log
    );
    assert!((rig.app_state.end() - 2.0).abs() < 0.05, "{}", rig.app_state.end());
    rig.steps(30);
    let told = rig.told(1);
    assert_eq!(run(&rig.app_state.script().expect("a script")), (told.samples, told.digest));
    // What was recorded is still there, and goes on.
    let trunk = rig.told(0);
    assert_eq!((trunk.samples, trunk.digest), (samples, digest));
    rig.act(&[Action::Branch(0)]);
    let end = rig.app_state.end();
    rig.steps(3);
    assert!((rig.app_state.end() - end - 0.03).abs() < 1e-9);
    rig.act(&[Action::Seek(1.0), Action::Fork]);
    assert_eq!(rig.app_state.branches[2].parent, Some((0, 1.0)));
}

/// A recording that does not come out again is not branched from: the scene begins anew.
#[test]
fn a_recording_of_another_program_begins_anew() {
    let folder = record(THREE);
    let mut rig = opened(folder.path());
    rig.app_state
        .draft
        .as_mut()
        .expect("a draft")
        .edit("other", |text| text.set("robots.left.law.k", "2.0").map_err(|e| e.to_string()))
        .expect("edited");
    assert!(rig.app_state.act(&Action::Seek(2.0)));
    rig.act(&[Action::Fork]);
    rig.settle();
    assert!(
        rig.app_state.notice.as_ref().is_some_and(|notice| notice.contains("run differs from the recording"))
    );
    assert_eq!(rig.app_state.branches.len(), 1);
    assert!(rig.app_state.end() < 3.0);
}
