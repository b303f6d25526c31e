//! However the run is paced, by steps or in strides, with or without somebody who listens, it is the same run.

use crate::common::{BranchSummary, Rig, THREE, checked, run, scene, with};
use lab::action::Action;
use lab::session::branches::script;
use lab::session::runner::{Fork, RunEvent, RunRequest};

/// Runs on at a pace until a branch has more than `samples` samples, then stands.
fn stride(rig: &mut Rig, pace: f64, samples: u64) {
    rig.runner.request(RunRequest::Pace(pace));
    rig.runner.request(RunRequest::Play(true));
    loop {
        let run_event = rig.next();
        let there = match &run_event {
            RunEvent::Records(_, records) => {
                records.last().is_some_and(|m| m.snapshot.time > samples as f64 * 0.01)
            }
            _ => false,
        };
        rig.app_state.handle_event(run_event);
        if there {
            break;
        }
    }
    rig.runner.request(RunRequest::Play(false));
    rig.settle();
}

/// 60 samples, other gains, 60 more: at a pace, going back to the very samples.
fn in_strides(text: &str, changed: &str, paces: [f64; 2]) -> BranchSummary {
    let mut rig = Rig::new(text);
    stride(&mut rig, paces[0], 70);
    rig.runner.request(RunRequest::Fork { from: 0, sample: 60, name: "back".to_owned() });
    rig.runner.request(RunRequest::Change(checked(changed)));
    stride(&mut rig, paces[1], 130);
    rig.runner.request(RunRequest::Fork { from: 1, sample: 120, name: "end".to_owned() });
    rig.told(2)
}

fn by_steps(text: &str, changed: &str) -> BranchSummary {
    let mut rig = Rig::new(text);
    // Opening a scene gives its first sample.
    rig.steps(59);
    rig.runner.request(RunRequest::Change(checked(changed)));
    rig.steps(60);
    rig.told(0)
}

#[test]
fn pace_does_not_matter() {
    let noisy = with(THREE, &[("sensing", "{ kind = \"noise\", latency = 0.05, drop = 0.1 }")]);
    let cars = with(THREE, &[("vehicle", "car")]);
    for text in [THREE, &noisy, &cars] {
        let changed = with(text, &[("law.k", "5.0"), ("robots.left.distance", "1.7")]);
        let steps = by_steps(text, &changed);
        assert_eq!((steps.samples, steps.changes.len()), (120, 1));
        for paces in [[50.0, 7.0], [3.0, 50.0]] {
            let strides = in_strides(text, &changed, paces);
            assert_eq!((strides.samples, &strides.digest), (120, &steps.digest), "at paces {paces:?}");
            assert_eq!(strides.changes[0].sample, 60);
        }
        let script = script(text, &[], &steps.changes, 1.19).expect("a script");
        assert_eq!(run(&script), (120, steps.digest));
    }
}

#[test]
fn a_branch_is_told_where_it_begins() {
    let mut rig = Rig::new(THREE);
    rig.steps(50);
    rig.runner.request(RunRequest::Fork { from: 0, sample: 37, name: "back".to_owned() });
    let RunEvent::Forked(Fork { branch: 1, from: 0, sample: 37, name, changes }) = rig.next() else {
        panic!("no branch")
    };
    assert!(name == "back" && changes.is_empty());
    let RunEvent::Records(1, records) = rig.next() else { panic!("no moment") };
    let history = rig.app_state.history.as_ref().expect("a history");
    assert_eq!(records, [vocabulary::StepRecord::clone(&history.at(0, 0.36).expect("a moment"))]);
}

#[test]
fn looking_ahead_does_not_matter() {
    let digest = |ahead: f64| {
        let mut rig = Rig::new(THREE);
        rig.act(&[Action::Ahead(ahead)]);
        rig.steps(80);
        rig.told(0).digest
    };
    assert_eq!(digest(5.0), digest(0.0));
}

#[test]
fn a_run_that_is_over_says_why_and_stands() {
    let crash = include_str!("../../../../scenes/cars-crash.toml");
    let mut rig = Rig::new(&with(crash, &[("physics.on_contact", "stop")]));
    rig.app_state.playing = true;
    rig.runner.request(RunRequest::Pace(50.0));
    rig.runner.request(RunRequest::Play(true));
    while rig.app_state.playing {
        let run_event = rig.next();
        rig.app_state.handle_event(run_event);
    }
    let notice = rig.app_state.notice.clone().expect("a notice");
    assert!(notice.contains("touched"), "{notice}");
    assert!((1.2..1.8).contains(&rig.app_state.end()), "{} s", rig.app_state.end());
}

#[test]
fn a_scene_that_cannot_run_is_refused() {
    let mut rig = Rig::new(THREE);
    rig.runner.request(RunRequest::Change(checked(&with(THREE, &[("seed", "8")]))));
    rig.settle();
    let notice = rig.app_state.notice.take().expect("a notice");
    assert!(notice.contains("`seed` cannot change while a run goes"), "{notice}");
    // Cameras need an adapter, and there is none here.
    let eyes = include_str!("../../../../scenes/vision-line-three.toml");
    rig.runner.request(RunRequest::Open { scene: scene(eyes), until: 0.0 });
    rig.settle();
    let notice = rig.app_state.notice.take().expect("a notice");
    assert!(notice.contains("adapter"), "{notice}");
    rig.steps(3);
    assert_eq!(rig.told(0).samples, 4, "the run before goes on");
}

#[test]
fn opening_brings_a_run_to_where_the_last_one_was() {
    let mut rig = Rig::new(THREE);
    rig.runner.request(RunRequest::Open { scene: scene(THREE), until: 0.5 });
    rig.settle();
    assert_eq!(rig.told(0).samples, 51);
    assert_eq!(rig.app_state.end(), 0.5);
}
