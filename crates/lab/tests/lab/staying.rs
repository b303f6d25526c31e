//! What stays as it is while much changes: what is selected, what can be undone, what held at a time.

use crate::common::{Rig, THREE};
use lab::action::Action;
use lab::app_state::Selection;

#[test]
fn what_is_selected_stays_so_by_its_name() {
    let mut rig = Rig::new(THREE);
    rig.act(&[Action::Select(Selection::Robot(2))]);
    rig.act(&[Action::RenameRobot("right".to_owned(), "tail".to_owned())]);
    assert_eq!(rig.app_state.selection, Selection::Robot(2));
    rig.act(&[Action::Select(Selection::Edge(1)), Action::AddProp("pillar", [9.0, 9.0])]);
    assert_eq!(rig.app_state.selection, Selection::Edge(1));
}

#[test]
fn undo_stays_on_its_branch_and_the_past_shows_what_held_then() {
    let mut rig = Rig::new(THREE);
    rig.steps(50);
    let gain = |value: &str| Action::Tune {
        what: "Gain".to_owned(),
        key: "law.k".into(),
        value: Some(value.to_owned()),
    };
    rig.act(&[gain("7.0")]);
    rig.steps(20);
    let now = |rig: &Rig| rig.app_state.follower(0).map(|(_, _, follow)| follow.law.k[0]);
    assert_eq!(now(&rig), Some(7.0));
    rig.act(&[Action::Seek(0.2)]);
    let before = now(&rig);
    assert!(before.is_some() && before != Some(7.0), "{before:?}");
    rig.act(&[gain("9.0")]);
    rig.steps(5);
    rig.act(&[Action::Branch(0)]);
    let trunk = rig.app_state.draft.as_ref().map(|draft| draft.text().to_owned());
    rig.act(&[Action::Undo]);
    assert_eq!(
        rig.app_state.draft.as_ref().map(|draft| draft.text().to_owned()),
        trunk,
        "nothing to undo here"
    );
}
