//! Custom laws in the lab: chosen, edited while they drive, undone, kept and replayed.

use crate::common::{Rig, THREE, run, with};
use lab::action::{Action, LawChoice};
use lab::app_state::{AppState, Selection};
use laws::TEMPLATE;
use vocabulary::{LawKind, LawState};

/// What the follower's law carries and shows at the present.
fn law(app_state: &AppState, robot: usize) -> Option<LawState> {
    app_state.record()?.laws.iter().find(|law| law.robot == robot).cloned()
}

fn choose(text: &str) -> Action {
    Action::ChooseLaw(LawChoice::Text(text.to_owned()))
}

fn edit(text: &str) -> Action {
    Action::EditLaw(text.to_owned())
}

/// The template with a memory that counts samples.
fn counting() -> String {
    let memory = "memory sum = 0 [m s]\nsum' = e.x\n";
    assert!(TEMPLATE.contains(memory));
    TEMPLATE.replace(memory, "memory n = 0\nn = n + 1\n")
}

#[test]
fn a_law_is_chosen_for_all_or_for_one_and_takes_hold_at_the_next_sample() {
    let mut rig = Rig::new(&with(THREE, &[("robots.left.law.k", "4.0")]));
    rig.steps(20);
    rig.act(&[Action::ChooseLaw(LawChoice::Shipped("robust-state"))]);
    rig.steps(5);
    assert!(rig.text().contains("file = \"robust-state\"") && rig.text().contains("k = 3.0 # not too stiff"));
    assert_eq!([1, 2].map(|robot| law(&rig.app_state, robot).is_some()), [true; 2]);
    // One of them goes back to a law of the paper.
    rig.act(&[
        Action::Select(Selection::Robot(1)),
        Action::ForAll(false),
        Action::ChooseLaw(LawChoice::BuiltIn(LawKind::FullState)),
    ]);
    rig.steps(5);
    assert_eq!([1, 2].map(|robot| law(&rig.app_state, robot).is_some()), [false, true]);
    assert!(rig.text().contains("kind = \"full-state\""), "{}", rig.text());
    assert_eq!(rig.told(0).samples, 31, "the run goes on");
}

#[test]
fn what_compiles_takes_hold_with_the_memory_before_and_what_does_not_leaves_the_law() {
    let mut rig = Rig::new(THREE);
    rig.act(&[choose(&counting())]);
    rig.steps(30);
    let value = |rig: &Rig, name: &str| law(&rig.app_state, 1).and_then(|law| law.value(name));
    assert_eq!(value(&rig, "n"), Some(30.0));
    // Another number, and another quantity to show; what it has counted goes on.
    let other = counting().replace("n = n + 1", "n = n + 2\nlet twice = 2 * n");
    rig.act(&[edit(&other)]);
    rig.steps(10);
    assert_eq!((value(&rig, "n"), value(&rig, "twice")), (Some(50.0), Some(100.0)));
    // Half a word is no law: the law before drives on, and the text is there to be gone on with.
    let half = other.replace("let twice = 2 * n", "let twice = 2 * nn + leader.distance");
    rig.act(&[edit(&half)]);
    rig.steps(10);
    assert_eq!(value(&rig, "twice"), Some(140.0));
    let shown = rig.app_state.law_edit().expect("a text");
    assert_eq!((shown.text.as_str(), shown.mistakes.len()), (half.as_str(), 1), "{:?}", shown.mistakes);
    assert!(rig.app_state.notice.is_none(), "a mistake is told in the panel");
    // Undo is that of the last law that was one.
    rig.act(&[Action::Release, Action::Undo]);
    rig.steps(10);
    assert_eq!((value(&rig, "n"), value(&rig, "twice")), (Some(80.0), None));
    assert_eq!(rig.app_state.law_edit().expect("a text").text, counting().trim());
}

#[test]
fn a_module_has_sliders_and_signals_and_no_text() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../laws/tests/modules/integral.wasm");
    let mut rig = Rig::new(&with(THREE, &[("law.file", file)]));
    rig.steps(20);
    let names = |rig: &Rig| {
        let state = law(&rig.app_state, 1).expect("a law");
        state.quantities.iter().map(|own| own.name.clone()).collect::<Vec<_>>()
    };
    assert_eq!(names(&rig)[..2], ["sum_distance", "sum_bearing"]);
    assert!(rig.app_state.law_edit().is_none());
    rig.act(&[Action::Tune {
        what: "T".to_owned(),
        key: "law.parameters.T".into(),
        value: Some("2.5".to_owned()),
    }]);
    rig.steps(10);
    let values = rig.app_state.tuned_follower().map(|(.., follow)| follow.law.values());
    assert_eq!(values, Some(vec![5.0, 5.0, 2.5]));
    // A branch of it is a scene that replays, and another law takes its place.
    let (branch, script) = (rig.told(0), rig.app_state.script().expect("a scene"));
    assert_eq!(run(&script), (branch.samples, branch.digest), "{script}");
    rig.act(&[choose(&counting())]);
    rig.steps(5);
    assert_eq!(names(&rig)[0], "n");
}

#[test]
fn parameters_keep_their_values_while_the_text_has_them() {
    let mut rig = Rig::new(THREE);
    let tune = |name: &str, value: &str| Action::Tune {
        what: name.to_owned(),
        key: format!("law.parameters.{name}").into(),
        value: Some(value.to_owned()),
    };
    rig.act(&[choose(TEMPLATE), tune("k", "4.5"), tune("d", "1.5")]);
    let values = |rig: &Rig| rig.app_state.tuned_follower().map(|(.., follow)| follow.law.values());
    assert_eq!(values(&rig), Some(vec![4.5, 1.5]));
    rig.act(&[edit(&TEMPLATE.replace("in 0.2 .. 10", "in 0.2 .. 4"))]);
    assert_eq!(values(&rig), Some(vec![2.0, 1.5]), "what no longer fits is back at its default");
    let renamed = TEMPLATE.replace("parameter d", "parameter damping").replace("* d *", "* damping *");
    rig.act(&[edit(&renamed)]);
    assert_eq!(values(&rig), Some(vec![2.0, 0.8]));
    assert!(!rig.text().contains("d = 1.5"), "{}", rig.text());
}

#[test]
fn what_was_typed_is_kept_with_the_run_and_replays_bit_for_bit() {
    let mut rig = Rig::new(THREE);
    rig.steps(10);
    rig.act(&[choose(&counting())]);
    rig.steps(20);
    rig.act(&[edit(&counting().replace("k^2 * e.x", "2 * k^2 * e.x"))]);
    rig.steps(20);
    let branch = rig.told(0);
    let script = rig.app_state.script().expect("a scene");
    assert_eq!(run(&script), (branch.samples, branch.digest), "{script}");
    // Going back to the middle and on again is exact, memory included.
    let counted = law(&rig.app_state, 1).expect("a law").values;
    rig.act(&[Action::Seek(0.25), Action::Fork]);
    rig.steps(25);
    assert_eq!(law(&rig.app_state, 1).expect("a law").values[0], counted[0]);
}
