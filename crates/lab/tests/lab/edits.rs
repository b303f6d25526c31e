//! Edits while the run goes, and in its past: branches, the text that holds on each, and the scene that runs alike.

use crate::commands::{gains, point, set, tune};
use crate::common::{Rig, THREE, app_state, run, scene, with};
use lab::action::Action;
use lab::app_state::AppState;
use lab::session::branches::{BranchChange, Branches};
use lab::session::checked_scene::builds;
use lab::session::runner::{RunEvent, RunRequest};
use lab::session::scene_draft::Effect;
use simulation::Simulation;
use std::sync::Arc;
use vocabulary::math;

#[test]
fn an_edit_in_the_past_makes_another_future() {
    let mut rig = Rig::new(THREE);
    rig.steps(99);
    let trunk = rig.told(0);
    rig.act(&[Action::Seek(0.4), tune("law.k", "6.0"), Action::Release]);
    assert_eq!((rig.app_state.branches.len(), rig.app_state.branch, rig.app_state.cursor), (2, 1, None));
    assert_eq!(rig.app_state.branches[1].parent, Some((0, 0.4)));
    assert_eq!(rig.app_state.end(), 0.4, "it goes on from where one looked");
    rig.steps(59);
    let told = rig.told(1);
    assert_eq!((told.samples, told.changes.len()), (100, 1));
    assert_ne!(told.digest, trunk.digest);
    assert_eq!(run(&rig.app_state.script().expect("a script")), (100, told.digest));
    assert_eq!(rig.told(0).digest, trunk.digest);
    // Back on the trunk the text is the trunk's.
    rig.act(&[Action::Branch(0)]);
    assert_eq!((rig.text(), rig.app_state.branch), (THREE, 0));
    rig.act(&[Action::Branch(1)]);
    assert!(rig.text().contains("k = 6.0 # not too stiff"));
    assert_eq!(gains(&rig.app_state), [6.0; 2]);
}

#[test]
fn a_drag_in_the_past_makes_one_branch_however_long_the_run_takes_for_it() {
    let mut rig = Rig::new(THREE);
    rig.steps(99);
    rig.act(&[Action::Seek(0.4)]);
    for step in 1..=8 {
        // Nobody has heard of the branch yet.
        rig.app_state.act(&point(0, 2.0 - 0.05 * f64::from(step), 135.0));
        rig.send();
    }
    rig.app_state.act(&Action::Release);
    rig.settle();
    assert_eq!((rig.app_state.branches.len(), rig.app_state.branch), (2, 1));
    assert_eq!(rig.app_state.set_point(0).map(|[d, _]| d), Some(1.6));
    rig.steps(20);
    let told = rig.told(1);
    assert_eq!(run(&rig.app_state.script().expect("a script")), (told.samples, told.digest));
    // The next look back makes the next branch.
    rig.act(&[Action::Seek(0.2), tune("law.k", "5.0")]);
    assert_eq!((rig.app_state.branches.len(), rig.app_state.branches[2].parent), (3, Some((1, 0.2))));
    assert_eq!(rig.app_state.set_point(0).map(|[d, _]| d), Some(2.0), "before the drag it was not dragged");
}

#[test]
fn going_back_brings_the_text_that_held_there() {
    let mut rig = Rig::new(THREE);
    let mut texts = vec![THREE.to_owned()];
    for (k, gain) in ["4.0", "5.0", "6.0"].into_iter().enumerate() {
        rig.steps(20);
        // One more edit is on its way before the run has taken the one before.
        rig.app_state.act(&tune("law.beta", &format!("1.{k}")));
        rig.send();
        rig.app_state.act(&tune("law.k", gain));
        rig.settle();
        texts.push(rig.text().to_owned());
    }
    rig.steps(20);
    // Changes hold from 0.21, 0.41, 0.61 s on.
    for (time, text) in [(0.1, 0), (0.2, 0), (0.21, 1), (0.4, 1), (0.5, 2), (0.61, 3), (0.7, 3)] {
        rig.act(&[Action::Branch(0), Action::Seek(time), Action::Fork]);
        assert_eq!(rig.text(), texts[text], "at {time} s");
        assert_eq!(rig.app_state.branches[rig.app_state.branch].changes.len(), text, "at {time} s");
    }
}

#[test]
fn edits_that_the_run_takes_one_by_one_are_remembered_one_by_one() {
    let mut app_state = app_state(THREE, 60);
    let mut changes = vec![];
    for (sample, gain) in [(60, "4.0"), (61, "5.0")] {
        app_state.act(&tune("law.k", gain));
        let Some(RunRequest::Change(changed)) = app_state.requests.pop() else { panic!("no change") };
        let mut branches = Branches::open(scene(THREE), |_| ()).expect("a run");
        let change = branches.change(0, &changed).expect("a change").expect("something new");
        let time = sample as f64 * 0.01;
        changes.push(BranchChange { sample, time, ..change });
    }
    // The window hears of both when both are made.
    for change in changes {
        app_state.handle_event(RunEvent::Changed(0, change));
    }
    app_state.act(&Action::Fork);
    let at = |app_state: &AppState| gains(app_state)[0];
    assert_eq!(at(&app_state), 3.0, "before both");
    let records = {
        let mut run = Simulation::new(simulation::build(&scene(THREE)).expect("a run"));
        (0..62).map(|_| run.next_record().expect("a moment").clone()).collect::<Vec<_>>()
    };
    app_state.handle_event(RunEvent::Records(0, records[60..].to_vec()));
    app_state.act(&Action::Seek(0.6));
    app_state.act(&Action::Fork);
    assert_eq!(at(&app_state), 4.0, "between them");
}

#[test]
fn there_and_back_while_the_run_stands_is_no_change() {
    let mut rig = Rig::new(THREE);
    rig.steps(30);
    rig.act(&[tune("law.k", "5.0"), Action::Release]);
    assert_eq!(rig.app_state.branches[0].changes.len(), 1);
    rig.act(&[Action::Undo]);
    assert!(rig.app_state.branches[0].changes.is_empty());
    rig.steps(30);
    let told = rig.told(0);
    assert!(told.changes.is_empty());
    let script = rig.app_state.script().expect("a script");
    assert!(!script.contains("changes"), "{script}");
    assert_eq!(run(&script), (told.samples, told.digest));
}

#[test]
fn a_scene_with_changes_of_its_own_is_tuned_as_it_goes() {
    let mut rig = Rig::new(include_str!("../../../../scenes/change-places.toml"));
    rig.steps(20);
    // What is expected is expected of the whole run.
    let told = rig.told(0);
    assert_eq!(run(&rig.app_state.script().expect("a script")), (told.samples, told.digest));
    rig.act(&[point(0, 2.2, -120.0), tune("law.k", "6.0"), Action::Release]);
    assert_eq!(
        (rig.app_state.end(), rig.app_state.branches[0].changes.len()),
        (0.2, 1),
        "{:?}",
        rig.app_state.log
    );
    rig.steps(20);
    let told = rig.told(0);
    assert_eq!(run(&rig.app_state.script().expect("a script")), (told.samples, told.digest));
    // What is past has become what is, and what is to come still comes.
    rig.steps(620);
    rig.act(&[tune("law.beta", "3.0"), Action::Release]);
    assert_eq!(
        (rig.app_state.branches[0].changes.len(), rig.app_state.scene().expect("a scene").changes.len()),
        (2, 2)
    );
    rig.steps(20);
    let told = rig.told(0);
    assert_eq!(run(&rig.app_state.script().expect("a script")), (told.samples, told.digest));
    rig.act(&[set("title", "\"Another title\"")]);
    assert_eq!(rig.app_state.branches[0].changes.len(), 2, "another title is the same run");
    // Other changes of its own are another run.
    let text = rig.text().replace("at = 21.0", "at = 20.0");
    let effect = rig.app_state.draft.as_mut().map(|draft| draft.replace("Script", text));
    assert!(matches!(effect, Some(Ok(Effect::Restart(_)))), "{effect:?}");
}

/// Undo in the past took back what was done last in the present.
#[test]
fn undo_in_the_past_takes_back_what_holds_there() {
    let mut rig = Rig::new(THREE);
    rig.steps(30);
    rig.act(&[tune("law.k", "6.0"), Action::Release]);
    rig.steps(30);
    rig.act(&[tune("law.k", "9.0"), Action::Release]);
    rig.steps(30);
    let trunk = rig.told(0);
    let text = rig.text().to_owned();
    // Before the first change there is nothing to take back.
    rig.act(&[Action::Seek(0.1)]);
    assert_eq!(rig.app_state.undoes(), None);
    rig.act(&[Action::Undo]);
    assert_eq!((rig.app_state.branches.len(), rig.text()), (1, &*text));
    // Between the two it is the first.
    rig.act(&[Action::Seek(0.45)]);
    assert_eq!(rig.app_state.undoes().as_deref(), Some("Gain of all"));
    rig.act(&[Action::Undo]);
    assert_eq!(
        (rig.app_state.branches.len(), rig.app_state.branch, gains(&rig.app_state)),
        (2, 1, gains(&app_state(THREE, 0)))
    );
    assert_eq!(rig.app_state.end(), 0.45, "it goes on from where one looked");
    rig.steps(20);
    let told = rig.told(1);
    assert_eq!(run(&rig.app_state.script().expect("a script")), (told.samples, told.digest));
    // The present is as it was, and what was taken back can be done again.
    assert_eq!(rig.told(0).digest, trunk.digest);
    rig.act(&[Action::Undo]);
    assert_eq!(gains(&rig.app_state), [6.0; 2]);
    rig.act(&[Action::Branch(0)]);
    assert_eq!(rig.text(), text);
}

/// The window checked what a hand moved by building it, and the run built it again.
#[test]
fn a_value_that_is_dragged_is_built_once() {
    let mut app_state = app_state(THREE, 60);
    let first = app_state.scene().cloned().expect("a scene");
    let mut branches = Branches::open(Arc::clone(&first), |_| ()).expect("a run");
    for (drag, distance) in (1..).zip([2.1, 2.2, 2.3]) {
        branches.advance(0).expect("a sample");
        let before = builds();
        app_state.act(&Action::SetPoint { edge: 0, distance, bearing: 2.3 });
        let Some(RunRequest::Change(checked)) = app_state.requests.pop() else { panic!("no change") };
        let change = branches.change(0, &checked).expect("a change").expect("something new");
        assert_eq!(builds() - before, 1, "at {distance} m");
        // What was compared when it was checked is what the run would find.
        let earlier = branches.list()[0].changes.iter().rev().nth(1).map_or(&first, |change| &change.scene);
        assert_eq!(earlier.sets_to(&change.scene).as_ref(), Ok(&change.set));
        assert_eq!(branches.list()[0].changes.len(), drag);
        app_state.handle_event(RunEvent::Changed(0, change));
    }
    // In the past, too, where it makes a branch.
    app_state.act(&Action::Seek(0.3));
    let before = builds();
    app_state.act(&Action::SetPoint { edge: 0, distance: 3.0, bearing: 2.3 });
    assert!(matches!(app_state.requests.as_slice(), [.., RunRequest::Fork { .. }, RunRequest::Change(_)]));
    assert_eq!(builds() - before, 1);
}

/// A ring lies where its follower is driven to, and a drag gives the key the value that puts it there.
#[test]
fn a_set_point_against_a_path_is_where_the_follower_is_driven_to() {
    let text = with(THREE, &[("law.heading", "\"path\""), ("law.heading_lag", "0.5")]);
    let mut rig = Rig::new(&text);
    rig.steps(900);
    let rings = |rig: &Rig| {
        let record = rig.app_state.shown().expect("a moment");
        rendering::set_points(rig.app_state.history.as_ref().expect("a run").fleet(), &record)
    };
    let record = rig.app_state.record().expect("a moment");
    let (state, follower) = (record.edges[0], record.snapshot.robots[1].motion.pose);
    // On a circle of 3.33 m.
    assert!((state.behind - 0.5 * 0.3).abs() < 2e-3, "{}", state.behind);
    let ring = rings(&rig)[0].expect("a ring");
    assert!(math::hypot(ring[0] - follower.x, ring[1] - follower.y) < 0.02, "{ring:?} {follower:?}");
    let leader = record.snapshot.robots[0].motion.pose;
    let rigid = leader.polar(2.0, 135f64.to_radians());
    assert!(math::hypot(rigid[0] - follower.x, rigid[1] - follower.y) > 0.25);
    // Before the run has taken it over, and after; keys are written to a hundredth of a degree.
    let place = [ring[0] + 0.3, ring[1] - 0.2];
    let [distance, bearing] = rig.app_state.set_point_at(&record, 0, place).expect("a set point");
    rig.app_state.act(&Action::SetPoint { edge: 0, distance, bearing });
    let near = |ring: Option<[f64; 2]>| {
        ring.is_some_and(|at| math::hypot(at[0] - place[0], at[1] - place[1]) < 5e-4)
    };
    assert!(near(rings(&rig)[0]), "{:?}", rings(&rig));
    rig.steps(1);
    let moved = rings(&rig)[0].expect("a ring");
    let travelled = 0.012 + 0.01;
    assert!(math::hypot(moved[0] - place[0], moved[1] - place[1]) < travelled, "{moved:?}");
}
