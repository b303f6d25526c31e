//! Events: what they say, and what cannot be.

mod common;

use common::START;
use scene::{Event, Failure, Happening, Holds, Override, Recovery, Scene, Trigger};

/// On top of the two that all tests have: one that follows in a chain, and one that leads on its own.
const MORE: &str = r#"[[robots]]
name = "cy"
pose = [-4.0, -2.0, 0.0]
leader = "bob"
distance = 2.0
bearing = "-135 deg"
[[robots]]
name = "dan"
pose = [0.0, 6.0, 0.0]
path = { kind = "constant" }
"#;

fn load(events: &str) -> Scene {
    common::load(&format!("{START}{MORE}{events}"))
}

fn fault(events: &str) -> String {
    common::fault(&format!("{START}{MORE}{events}"))
}

#[test]
fn an_event_is_a_trigger_and_what_happens() {
    let scene = load(
        "[[events]]\nat = 3.0\nrobot = \"cy\"\nleader = \"ann\"\n[[events]]\nwhen = { robot = \"ann\", reaches = [4.0, 0.5] \
         }\nrobot = \"bob\"\nfails = \"coast\"\n[[events]]\nwhen = { robot = \"cy\", blocked_for = 2.0 }\nrobot = \
         \"cy\"\npath = { kind = \"circle\", speed = 0.5, turn_rate = 0.1 }\n[[events]]\nat = 9.0\nassign = \"ann\"\n",
    );
    let [follow, fail, lead, assign] = &scene.events[..] else { panic!("{:?}", scene.events) };
    assert_eq!(follow.trigger, Trigger::At { at: 3.0 });
    assert!(
        matches!(&follow.happening, Happening::Follow { robot, leader, place: None, joins: None } if robot == "cy" && leader == "ann")
    );
    let Event { trigger: Trigger::When { when }, happening } = fail else { panic!("{fail:?}") };
    assert_eq!((&*when.robot, when.holds), ("ann", Holds::Reaches { reaches: [4.0, 0.5], within: 1.0 }));
    let graft = Recovery::Graft;
    assert_eq!(*happening, Happening::Fail { robot: "bob".into(), fails: Failure::Coast, recovery: graft });
    assert!(matches!(lead.happening, Happening::Lead { .. }));
    assert_eq!(assign.happening, Happening::Assign { assign: "ann".into() });
}

/// A robot that leads at the start is told how to follow: by the scene's law, unless the event has its own.
#[test]
fn whoever_joins_follows_by_the_scenes_law_or_the_events() {
    let event =
        "[[events]]\nat = 3.0\nrobot = \"dan\"\nleader = \"ann\"\ndistance = 2.0\nbearing = \"90 deg\"\n";
    let scene = load(&format!("{event}law = {{ beta = 2.0 }}\n[law]\nk = 3.0\n"));
    let [(name, follow)] = &scene.joining()[..] else { panic!("one joins") };
    assert_eq!((*name, &*follow.leaders.first.name), ("dan", "ann"));
    assert_eq!((follow.law.k, follow.law.beta), ([3.0; 2], [2.0; 2]));
    assert!(load("").joining().is_empty());
}

#[test]
fn what_cannot_be_is_said_where_it_stands() {
    for (events, words) in [
        ("[[events]]\nat = 3.0\nrobot = \"bob\"\n", "say what happens"),
        ("[[events]]\nat = 3.0\nleader = \"ann\"\n", "`robot` is missing"),
        ("[[events]]\nrobot = \"bob\"\nleader = \"dan\"\n", "give either `at` or `when`"),
        (
            "[[events]]\nat = 1.0\nwhen = { robot = \"ann\", lost_for = 1.0 }\nrobot = \"bob\"\nleader = \"dan\"\n",
            "give either `at` or `when`",
        ),
        (
            "[[events]]\nat = 3.0\nrobot = \"bob\"\nleader = \"ann\"\nfails = \"stop\"\n",
            "one event is one thing",
        ),
        ("[[events]]\nat = 3.0\nrobot = \"bob\"\nleader = \"bob\"\n", "cannot follow itself"),
        ("[[events]]\nat = 3.0\nrobot = \"bob\"\nleader = \"dann\"\n", "there is no robot called `dann`"),
        ("[[events]]\nat = 3.0\nrobot = \"eve\"\nleader = \"ann\"\n", "no robot called `eve`"),
        (
            "[[events]]\nat = 3.0\nrobot = \"bob\"\nleader = \"cy\"\n",
            "would form a cycle: `bob` follows `cy` follows `bob`",
        ),
        ("[[events]]\nat = 3.0\nrobot = \"bob\"\nleader = \"dan\"\ndistance = 2.0\n", "`bearing` is missing"),
        (
            "[[events]]\nat = 3.0\nrobot = \"bob\"\nleader = \"dan\"\ndistance = 0.01\nbearing = 3.0\n",
            "below the law's `distance_min`",
        ),
        ("[[events]]\nat = 3.0\nrobot = \"bob\"\nleader = \"dan\"\nlaw = { k = 2.0 }\n", "keeps its `law`"),
        ("[[events]]\nat = 3.0\nrobot = \"bob\"\nfails = \"explode\"\n", "`stop`, `coast`, `remove`"),
        (
            "[[events]]\nat = 3.0\nrobot = \"bob\"\nfails = \"stop\"\npatience = 3.0\n",
            "unknown key `patience`",
        ),
        (
            "[[events]]\nat = 3.0\nrobot = \"bob\"\nfails = \"stop\"\ndistance = 3.0\n",
            "`distance` means nothing",
        ),
        (
            "[[events]]\nat = 3.0\nrobot = \"bob\"\nfails = \"stop\"\n[[events]]\nat = 5.0\nrobot = \"bob\"\nleader = \
             \"dan\"\n",
            "`bob` fails at 3 s: nothing can happen to it at 5 s",
        ),
        (
            "[[events]]\nat = 3.0\nrobot = \"bob\"\nleader = \"dan\"\n[[events]]\nat = 3.0\nrobot = \"bob\"\npath = { kind = \
             \"constant\" }\n",
            "two things happen to `bob` at 3 s",
        ),
        (
            "[[events]]\nwhen = { robot = \"bob\" }\nrobot = \"bob\"\nfails = \"stop\"\n",
            "give one of `reaches`",
        ),
        (
            "[[events]]\nwhen = { robot = \"ann\", lost_for = 2.0 }\nrobot = \"ann\"\nfails = \"stop\"\n",
            "has no leader to lose",
        ),
        (
            "[[events]]\nwhen = { robot = \"bob\", lost_for = 2.0, within = 1.0 }\nrobot = \"bob\"\nfails = \"stop\"\n",
            "`within` is for events with `reaches`",
        ),
        ("[hand_over]\ndistance = [3.0, 2.0]\n", "leaves no place"),
        (
            "[[events]]\nat = 3.0\nrobot = \"bob\"\nfails = \"stop\"\n[time]\nmode = \"continuous\"\n",
            "no control samples at which events could happen",
        ),
    ] {
        let found = fault(events);
        assert!(found.contains(words), "{events}: {found}");
    }
    let place =
        "[[events]]\nwhen = { robot = \"bob\", reaches = [nan, 0.0] }\nrobot = \"bob\"\nfails = \"stop\"\n";
    let found = fault(place);
    assert!(found.contains("reaches") && !found.contains("give one of"), "{found}");
}

#[test]
fn events_may_come_on_top_while_a_run_goes_but_not_others() {
    let first = "[[events]]\nat = 3.0\nrobot = \"cy\"\nleader = \"ann\"\n";
    let (before, after) =
        (load(first), load(&format!("{first}[[events]]\nat = 5.0\nrobot = \"cy\"\nfails = \"stop\"\n")));
    assert_eq!(before.sets_to(&after), Ok(vec![]));
    assert!(after.sets_to(&before).is_err(), "what was to happen does not go");
    let set: Override = "events.0.at=4".parse().expect("an override");
    let text = format!("{START}{MORE}{first}");
    let changed = Scene::parse(&text, "t.toml", &[set]).expect("a scene").scene;
    assert_eq!(changed.events[0].trigger, Trigger::At { at: 4.0 });
    assert!(before.sets_to(&changed).is_err());
}
