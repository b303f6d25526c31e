//! Events by hand: what happens to a robot now is part of the run, and of the scene that repeats it.

use crate::common::{Rig, THREE, run, scene, with};
use lab::action::{Action, Happens};
use lab::session::branches::script;
use scene::Failure;
use vocabulary::{Condition, EventKind, EventRecord, Refusal};

/// Lets the run go on to this time, s.
fn to(rig: &mut Rig, time: f64) {
    let missing = (time - rig.app_state.end()) / 0.01;
    rig.steps(missing.round() as usize);
}

/// Three robots that drive straight on, whose followers may be anywhere beside their leader.
fn straight() -> String {
    let path = "{ kind = \"constant\", speed = 1.0 }";
    with(THREE, &[("robots.leader.path", path), ("hand_over.bearing_max", "180 deg")])
}

fn events(rig: &Rig) -> Vec<(f64, EventRecord)> {
    rig.app_state.history.as_ref().expect("a run").events(rig.app_state.branch).to_vec()
}

/// What is kept of the branch is the same run.
fn kept(base: &str, rig: &mut Rig) -> String {
    let summary = rig.told(rig.app_state.branch);
    let duration = (summary.samples - 1) as f64 * 0.01;
    let text = script(base, &[], &summary.changes, duration).expect("a script");
    assert_eq!(run(&text), (summary.samples, summary.digest), "{text}");
    text
}

#[test]
fn a_hand_over_by_hand_happens_at_the_next_sample_and_is_kept() {
    let text = straight();
    let mut rig = Rig::new(&text);
    to(&mut rig, 1.0);
    rig.act(&[Action::Happen { robot: 2, what: Happens::Follows(1) }]);
    to(&mut rig, 1.5);
    let found = events(&rig);
    let [(time, event)] = found[..] else { panic!("{found:?}") };
    // The new observer settles for a tenth of a second.
    assert!((time - 1.11).abs() < 1e-9, "{found:?}");
    assert_eq!((event.kind, event.robot, event.leader), (EventKind::Follow, 2, Some(1)));
    let record = rig.app_state.record().expect("a record");
    assert_eq!(record.leaders, [Some(0), Some(1)]);
    let repeats = kept(&text, &mut rig);
    assert_eq!(scene(&repeats).events.len(), 1, "{repeats}");
    // Back to before it, another thing happens on another branch.
    rig.act(&[Action::Seek(0.5)]);
    rig.act(&[Action::Happen { robot: 1, what: Happens::Fails(Failure::Stop) }]);
    assert_eq!(rig.app_state.branch, 1);
    to(&mut rig, 1.5);
    let found = events(&rig);
    let [(time, event)] = found[..] else { panic!("{found:?}") };
    assert!((time - 0.51).abs() < 1e-9 && event.kind == EventKind::Stop, "{found:?}");
    let record = rig.app_state.record().expect("a record");
    assert_eq!(record.snapshot.robots[1].condition, Condition::Failed);
    kept(&text, &mut rig);
    // Forked after it, it has happened.
    rig.act(&[Action::Seek(1.2)]);
    rig.act(&[Action::Fork]);
    to(&mut rig, 1.4);
    assert_eq!(events(&rig).len(), 1);
    kept(&text, &mut rig);
}

#[test]
fn what_cannot_be_is_refused_and_the_run_goes_on() {
    let text = straight();
    let mut rig = Rig::new(&text);
    to(&mut rig, 0.5);
    // A ring is known before the run is asked.
    rig.act(&[Action::Happen { robot: 2, what: Happens::Follows(1) }]);
    to(&mut rig, 1.0);
    rig.act(&[Action::Happen { robot: 1, what: Happens::Follows(2) }]);
    let notice = rig.app_state.notice.clone().expect("a refusal");
    assert!(notice.contains("cycle"), "{notice}");
    // What only the run can know is refused there.
    rig.act(&[Action::Happen { robot: 1, what: Happens::Fails(Failure::Coast) }]);
    to(&mut rig, 2.0);
    let refused: Vec<Refusal> = events(&rig)
        .iter()
        .map(|(_, event)| event.refusal)
        .filter(|refusal| *refusal != Refusal::None)
        .collect();
    assert!(refused.len() <= 1, "{refused:?}");
    to(&mut rig, 2.5);
    kept(&text, &mut rig);
}

/// A robot that leads comes to follow: it gets an edge, so the run starts anew, to the same time.
#[test]
fn a_lead_robot_may_come_to_follow_by_hand() {
    let text = format!(
        "{THREE}\n[[robots]]\nname = \"other\"\npose = [-4.0, 0.0, 0.0]\npath = {{ kind = \"circle\", speed = 1.0, turn_rate \
         = 0.25 }}\n"
    );
    let mut rig = Rig::new(&text);
    to(&mut rig, 1.0);
    rig.act(&[Action::Happen { robot: 3, what: Happens::Follows(2) }]);
    to(&mut rig, 1.5);
    let record = rig.app_state.record().expect("a record");
    assert_eq!(record.leaders, [Some(0), Some(0), Some(2)], "{:?}", events(&rig));
}

/// After a hand-over the handle is where the follower is driven to, beside its new leader, and can be dragged there.
#[test]
fn the_place_of_a_robot_that_has_changed_its_leader_can_be_moved() {
    let text = straight();
    let mut rig = Rig::new(&text);
    to(&mut rig, 1.0);
    rig.act(&[Action::Happen { robot: 2, what: Happens::Follows(1) }]);
    to(&mut rig, 2.0);
    let record = rig.app_state.record().expect("a record");
    let place = record.edges[1].set_point;
    let found = rig.app_state.set_point(1).expect("a set point");
    assert!((found[0] - place[0]).abs() < 1e-9 && (found[1] - place[1]).abs() < 1e-9, "{found:?} {place:?}");
    rig.act(&[Action::SetPoint { edge: 1, distance: 1.5, bearing: -2.0 }]);
    let found = rig.app_state.set_point(1).expect("a set point");
    assert!((found[0] - 1.5).abs() < 1e-9 && (found[1] + 2.0).abs() < 1e-4, "{found:?}");
    to(&mut rig, 14.0);
    let record = rig.app_state.record().expect("a record");
    let state = record.edges[1];
    assert!((state.set_point[0] - 1.5).abs() < 0.01 && (state.set_point[1] + 2.0).abs() < 0.01, "{state:?}");
    assert_eq!(record.leaders[1], Some(1));
    kept(&text, &mut rig);
}

/// A link carries what happened by hand: others come to the same run.
#[test]
fn a_link_leads_to_what_happened_by_hand() {
    let text = straight();
    let mut rig = Rig::new(&text);
    to(&mut rig, 1.0);
    rig.act(&[Action::Happen { robot: 2, what: Happens::Fails(Failure::Stop) }]);
    to(&mut rig, 2.0);
    let summary = rig.told(0);
    let link = rig.app_state.link_to(summary.samples, &summary.digest, "snake").expect("a link");
    let there = link.open().expect("a scene").scene;
    let mut other = simulation::Simulation::new(simulation::build(&there).expect("a run"));
    let mut digest = metrics::Digest::default();
    for _ in 0..summary.samples {
        digest.push(other.next_record().expect("a moment"));
    }
    assert_eq!(digest.text(), summary.digest, "{}", there.to_toml());
}

#[test]
fn a_goal_that_is_moved_is_planned_to_from_where_the_formation_is_and_kept() {
    let text = scene::shipped("two-formations").expect("a scene").text;
    let mut rig = Rig::new(text);
    to(&mut rig, 5.0);
    for place in [[9.0, 1.0], [8.0, 3.0]] {
        rig.act(&[Action::Goal { robot: 0, number: 0, place }]);
    }
    rig.act(&[Action::Release]);
    to(&mut rig, 40.0);
    let found = events(&rig);
    let notice = rig.app_state.notice.clone();
    let again = found
        .iter()
        .find(|(_, event)| event.kind == EventKind::Reroute)
        .unwrap_or_else(|| panic!("{notice:?} {found:?}"));
    assert!((again.0 - 5.01).abs() < 0.02 && again.1.robot == 0, "{found:?}");
    let lead = rig.app_state.record().expect("a record").snapshot.robots[0].motion;
    let away = vocabulary::math::hypot(lead.pose.x - 8.0, lead.pose.y - 3.0);
    assert!(away < 0.2 && lead.speed < 1e-3, "{away} m away at {} m/s", lead.speed);
    let repeats = kept(text, &mut rig);
    assert!(repeats.contains("path.pose"), "{repeats}");
}
