//! The text under work: what is one step back, and what never happens to it.

use crate::common::{THREE, with};
use lab::session::scene_draft::{Effect, SceneDraft};
use std::path::{Path, PathBuf};

fn draft() -> SceneDraft {
    SceneDraft::new(THREE.to_owned(), None, Path::new("t.toml")).expect("a scene")
}

fn set(draft: &mut SceneDraft, what: &str, path: &str, value: &str) -> Result<Effect, String> {
    draft.edit(what, |text| text.set(path, value).map_err(|error| error.to_string()))
}

#[test]
fn what_goes_on_under_a_hand_is_one_step() {
    let mut draft = draft();
    for k in 1..30 {
        let effect = set(&mut draft, "Gain…", "law.k", &format!("{k}.5"));
        assert_eq!(effect, Ok(Effect::Retune));
    }
    assert_eq!(draft.undoes(), Some("Gain"));
    let dragged = draft.text().to_owned();
    assert_eq!(draft.undo(), Some(("Gain…".to_owned(), Effect::Retune)));
    assert_eq!((draft.text(), draft.undoes(), draft.redoes()), (THREE, None, Some("Gain")));
    assert_eq!(draft.redo(), Some(("Gain…".to_owned(), Effect::Retune)));
    assert_eq!(draft.text(), dragged);
    assert_eq!(draft.redo(), None);
}

#[test]
fn a_hand_that_lets_go_ends_the_step() {
    let mut draft = draft();
    for k in ["4.0", "5.0"] {
        set(&mut draft, "Gain…", "law.k", k).expect("an edit");
        draft.rest();
    }
    draft.undo();
    assert!(draft.text().contains("k = 4.0"));
    // Another hand, or a step that does not go on, is a step of its own.
    set(&mut draft, "Beta…", "law.beta", "3.0").expect("an edit");
    set(&mut draft, "Gain…", "law.k", "6.0").expect("an edit");
    for word in ["7.0", "8.0"] {
        set(&mut draft, "Gain", "law.k", word).expect("an edit");
    }
    let mut steps = 0;
    while draft.undo().is_some() {
        steps += 1;
    }
    assert_eq!((steps, draft.text()), (5, THREE));
}

#[test]
fn a_hand_on_what_was_before_is_a_step_of_its_own() {
    let mut draft = draft();
    set(&mut draft, "Gain…", "law.k", "4.0").expect("an edit");
    let first = draft.text().to_owned();
    set(&mut draft, "Beta…", "law.beta", "3.0").expect("an edit");
    draft.undo();
    set(&mut draft, "Gain…", "law.k", "5.0").expect("an edit");
    draft.undo();
    assert_eq!(draft.text(), first);
}

#[test]
fn other_changes_of_a_scene_are_another_run() {
    let scripted = |k: &str, at: &str, set: &str| {
        format!("{}\n[[changes]]\nat = {at}\nset = [\"{set}\"]\n", with(THREE, &[("law.k", k)]))
    };
    let effect = |text: String| {
        let before = scripted("3.0", "2.0", "law.beta=5");
        SceneDraft::new(before, None, Path::new("t.toml")).expect("a scene").replace("File", text)
    };
    assert_eq!(effect(scripted("4.0", "2.0", "law.beta=5")), Ok(Effect::Retune));
    for other in [
        scripted("3.0", "2.5", "law.beta=5"),
        scripted("3.0", "2.0", "law.beta=6"),
        scripted("4.0", "2.5", "law.beta=5"),
    ] {
        assert!(matches!(effect(other.clone()), Ok(Effect::Restart(_))), "{other}");
    }
}

#[test]
fn a_new_edit_forgets_what_could_be_done_again() {
    let mut draft = draft();
    set(&mut draft, "Gain…", "law.k", "4.0").expect("an edit");
    draft.undo();
    set(&mut draft, "Gain…", "law.k", "5.0").expect("an edit");
    assert_eq!((draft.redoes(), draft.undoes()), (None, Some("Gain")));
    draft.undo();
    assert_eq!(draft.text(), THREE);
}

#[test]
fn bad_text_keeps_everything() {
    let mut draft = draft();
    set(&mut draft, "Gain", "law.k", "4.0").expect("an edit");
    set(&mut draft, "Gain", "law.k", "5.0").expect("an edit");
    draft.undo();
    let (text, scene) = (draft.text().to_owned(), draft.scene().clone());
    for bad in [
        String::new(),
        "schema = ".to_owned(),
        with(THREE, &[("law.k", "-3.0")]),
        with(THREE, &[("robots.left.leader", "\"nobody\"")]),
        THREE.replace("name = \"right\"", "name = \"left\""),
    ] {
        let fault = draft.replace("Bad", bad).expect_err("a fault");
        assert!(fault.contains("t.toml"), "{fault}");
        assert_eq!((draft.text(), draft.scene()), (&*text, &scene));
        assert_eq!((draft.undoes(), draft.redoes()), (Some("Gain"), Some("Gain")));
    }
    assert!(draft.edit("Bad", |_| Err("no".to_owned())).is_err_and(|fault| fault == "no"));
    assert!(SceneDraft::new("schema = 1".to_owned(), None, Path::new("t.toml")).is_err());
}

#[test]
fn an_edit_means_what_it_means_for_the_run() {
    let mut draft = draft();
    assert_eq!(set(&mut draft, "Same", "law.k", "3.0"), Ok(Effect::None));
    assert_eq!(draft.undoes(), None, "nothing to take back");
    assert_eq!(draft.replace("Comment", format!("# More\n{THREE}")), Ok(Effect::None));
    assert_eq!(set(&mut draft, "Gain", "law.k", "4.0"), Ok(Effect::Retune));
    assert_eq!(set(&mut draft, "Title", "title", "\"Other\""), Ok(Effect::Dress));
    assert_eq!(set(&mut draft, "Sun", "environment.sun_elevation", "\"20 deg\""), Ok(Effect::Dress));
    for (path, value) in [("seed", "8"), ("time.period", "0.02"), ("robots.left.pose", "[-3.0, 1.0, 0.0]")] {
        let effect = set(&mut draft, "Start", path, value);
        let last = path.split('.').next_back().expect("a key");
        assert!(
            matches!(&effect, Ok(Effect::Restart(why)) if why.contains(last) || why.contains("time")),
            "{effect:?}"
        );
    }
}

#[test]
fn steps_are_kept_in_hundreds_but_not_for_ever() {
    let mut draft = draft();
    for k in 0..700 {
        set(&mut draft, "Gain", "law.k", &format!("{}.25", k + 1)).expect("an edit");
    }
    let steps = std::iter::from_fn(|| draft.undo()).count();
    assert_eq!(steps, 500);
    assert!(draft.text().contains("k = 200.25"), "the newest are kept");
}

#[test]
fn what_is_saved_is_known() {
    let mut draft = draft();
    assert!(!draft.unsaved() && draft.path.is_none());
    set(&mut draft, "Gain", "law.k", "4.0").expect("an edit");
    assert!(draft.unsaved());
    draft.saved_to(PathBuf::from("/tmp/x.toml"));
    assert_eq!((draft.unsaved(), draft.home()), (false, Path::new("/tmp/x.toml")));
    draft.undo();
    assert!(draft.unsaved(), "taking back what is saved is not saved");
    draft.redo();
    assert!(!draft.unsaved());
}
