//! Links: what is shared opens to the same run, at the same time, and proves it.

use crate::commands::{point, set, tune};
use crate::common::{Rig, THREE};
use lab::action::Action;
use lab::app_state::Selection;
use lab::session::runner::RunEvent;
use scene::{Link, LinkOrigin};

/// Opens a link and lets the run come to its time.
fn open(text: &str) -> Rig {
    let mut rig = Rig::new(THREE);
    rig.app_state.open_link(text).unwrap_or_else(|faults| panic!("{faults}"));
    rig.send();
    loop {
        let run_event = rig.next();
        let there = matches!(run_event, RunEvent::Reached(_));
        rig.app_state.handle_event(run_event);
        if there {
            return rig;
        }
    }
}

/// What *Share* copies.
fn share(rig: &mut Rig) -> Link {
    assert!(rig.app_state.act(&Action::Share));
    rig.send();
    loop {
        match rig.next() {
            RunEvent::Digest { samples, digest, .. } => {
                return rig.app_state.link_to(samples, &digest, "top").expect("a link");
            }
            run_event => rig.app_state.handle_event(run_event),
        }
    }
}

fn status(rig: &Rig) -> (&str, bool) {
    rig.app_state.status.as_ref().map_or(("", false), |status| (&*status.text, status.fault))
}

const SAME: &str = "Link: the same run, bit for bit, up to t = 0.7 s";

#[test]
fn what_is_shared_opens_to_the_same_run() {
    let mut rig = Rig::new(THREE);
    rig.app_state.open_link("#line-three").expect("a link");
    rig.settle();
    rig.steps(50);
    rig.act(&[tune("law.k", "3.5")]);
    rig.steps(30);
    rig.act(&[Action::Fork, point(1, 2.5, -120.0), Action::Select(Selection::Robot(2))]);
    rig.steps(20);
    // At the present, and in the past of a branch.
    let now = share(&mut rig);
    assert_eq!(
        (now.name(), now.time, now.selected.as_deref()),
        ("line-three", Some(1.0), Some("follower-2"))
    );
    assert_eq!(now.branch.as_deref(), Some("branch 1"));
    let changes: Vec<String> =
        now.changes.iter().map(|change| format!("{} {}", change.at, change.set)).collect();
    assert_eq!(changes[0], "0.51 law.k=[3.5,3.5]", "{now}");
    assert!(changes.iter().skip(1).all(|change| change.starts_with("0.81 robots.follower-2.")), "{now}");
    rig.act(&[Action::Seek(0.7)]);
    let past = share(&mut rig);
    assert_eq!((past.time, past.changes.len()), (Some(0.7), 1), "{past}");
    let mut again = open(&past.to_string());
    assert_eq!(status(&again), (SAME, false));
    assert!((again.app_state.time() - 0.7).abs() < 1e-9);
    assert_eq!((again.app_state.chosen_robot(), again.app_state.playing), (Some(2), false));
    // What was opened is shared as it was.
    assert_eq!(share(&mut again), Link { branch: None, ..past });
    let again = open(&now.to_string());
    assert!(status(&again).0.starts_with("Link: the same run"), "{:?}", status(&again));
    assert_eq!(again.app_state.branches[0].name, "branch 1");
}

#[test]
fn a_scene_that_cannot_be_told_is_carried() {
    let mut rig = Rig::new(THREE);
    rig.steps(20);
    rig.act(&[Action::AddProp("pillar", [9.0, 9.0])]);
    rig.act(&[tune("law.k", "3.5")]);
    rig.steps(70);
    rig.act(&[Action::Seek(0.7)]);
    let link = share(&mut rig);
    assert!(matches!(&link.origin, LinkOrigin::Text(text) if text.contains("pillar")), "{link}");
    let again = open(&link.to_string());
    assert_eq!(status(&again), (SAME, false));
    assert!(again.text().contains("# Head of the file."));
}

#[test]
fn a_run_that_parts_or_is_changed_is_not_called_the_same() {
    let apart = open("#line-three?t=0.2&v=0.0.1&d=00000000");
    let (text, fault) = status(&apart);
    assert!(
        fault && text.starts_with("Link: DIFFERENT at t = 0.2 s") && text.contains("echelon 0.0.1"),
        "{text}"
    );
    let mut rig = Rig::new(THREE);
    rig.app_state.open_link("#line-three?t=90000&v=0.0.1&d=00000000").expect("a link");
    assert!(status(&rig).0.starts_with("The run goes to t = 90000 s"), "{:?}", status(&rig));
    rig.act(&[set("law.k", "3.5")]);
    assert!(status(&rig).0.starts_with("Not compared with the link"), "{:?}", status(&rig));
    // Play does not wait for a time that is far off.
    rig.app_state.open_link("#line-three?t=90000").expect("a link");
    assert!(!status(&rig).0.contains("compare"), "{:?}", status(&rig));
    rig.act(&[Action::Toggle]);
    assert!(status(&rig).0.starts_with("Not compared with the link"), "{:?}", status(&rig));
    // Another scene has nothing to do with the link.
    rig.act(&[Action::Restart]);
    assert_eq!(status(&rig).0, "");
}

#[test]
fn a_link_that_is_wrong_changes_nothing() {
    let mut rig = Rig::new(THREE);
    let faults = rig.app_state.open_link("#line-tree").expect_err("no link");
    assert!(faults.contains("did you mean `line-three`"), "{faults}");
    assert!(rig.app_state.open_link("#line-three?law.k=-1").is_err());
    assert!(rig.app_state.requests.is_empty() && rig.text() == THREE);
    // A long one offers a file.
    let link: Link = "#line-three?t=1".parse().expect("a link");
    rig.app_state.shared(&link, 100);
    assert_eq!(status(&rig), ("Link to t = 1.00 s copied, 100 characters", false));
    rig.app_state.shared(&link, 2001);
    assert!(rig.app_state.status.as_ref().is_some_and(|status| status.offers_file));
}
