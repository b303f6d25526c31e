//! Safety filters in the loop.

use scene::Scene;
use simulation::{Simulation, build};
use std::fmt::Write;
use vocabulary::{Constraint, Contact, LawKind, Relative, StepRecord};

/// All records of the scene `text`.
fn run(text: &str) -> Vec<StepRecord> {
    let scene = Scene::parse(text, "test.toml", &[]).expect("a scene").scene;
    let mut run = Simulation::new(build(&scene).expect("a run"));
    let mut records = vec![];
    while let Some(record) = run.next_record() {
        records.push(record.clone());
    }
    records
}

fn touches(records: &[StepRecord]) -> bool {
    records.iter().any(|record| record.contacts.iter().any(Contact::of_robot))
}

/// Two lead robots that drive at each other, a little off the middle.
const HEAD_ON: &str = r#"
schema = 1
title = "Head-on"
[time]
duration = 14.0
[vehicle]
acceleration_max = 3.0
turn_rate_max = 3.0
[proximity]
range = 4.0
[[robots]]
name = "ann"
pose = [0.0, 0.0, 0.0]
path = { kind = "constant", speed = 0.8 }
[[robots]]
name = "bob"
pose = [8.0, 0.05, "180 deg"]
path = { kind = "constant", speed = 0.8 }
"#;

#[test]
fn lead_robots_with_a_filter_pass_each_other_and_return_to_their_paths() {
    assert!(touches(&run(HEAD_ON)));
    let records = run(&format!("{HEAD_ON}\n[safety]\nfilter = true\nleads = true\n"));
    assert!(!touches(&records));
    let last = &records[records.len() - 1];
    let [ann, bob] = [0, 1].map(|k| last.snapshot.robots[k].motion.pose);
    assert!(ann.y.abs() < 0.02 && (bob.y - 0.05).abs() < 0.02, "{} {}", ann.y, bob.y);
    assert!((ann.x - 0.8 * 14.0).abs() < 0.1, "{}", ann.x);
    assert_eq!(last.safety.iter().map(|state| state.robot).collect::<Vec<_>>(), [0, 1]);
    let acted = |record: &StepRecord| record.safety[0].acting.contains(&Constraint::Robot(1));
    assert!(records.iter().any(acted));
}

/// A follower whose place leads it through a pillar.
fn pillar(kind: LawKind) -> String {
    let law = match kind {
        LawKind::FullState => "full-state",
        LawKind::RobustState => "robust-state",
        LawKind::OutputFeedback => "output-feedback",
    };
    format!(
        r#"
schema = 1
title = "Pillar"
[time]
duration = 12.0
[vehicle]
acceleration_max = 3.0
turn_rate_max = 3.0
[law]
kind = "{law}"
[proximity]
range = 4.0
[safety]
filter = true
[[robots]]
name = "ann"
pose = [0.0, 0.0, 0.0]
path = {{ kind = "constant", speed = 0.8 }}
[[robots]]
name = "bob"
pose = [-1.4, -1.4, 0.0]
speed = 0.8
leader = "ann"
distance = 2.0
bearing = "-135 deg"
[[robots]]
name = "cid"
pose = [-2.8, -2.8, 0.0]
speed = 0.8
leader = "bob"
distance = 2.0
bearing = "-135 deg"
[[props]]
name = "pillar"
shape = "cylinder"
radius = 0.2
height = 0.6
pose = [3.0, -1.2, 0.0]
"#
    )
}

/// The observer follows the motion that was applied, not the one that was decided: its rates stay right while the filter
/// moves commands a long way.
#[test]
fn the_observer_is_fed_what_was_applied() {
    let records = run(&pillar(LawKind::OutputFeedback));
    let moved = records.iter().map(|record| record.safety[0].moved).fold(0.0, f64::max);
    assert!(moved > 0.5, "the filter moved a command by {moved} m/s² at most");
    assert!(!touches(&records));
    let mut worst: f64 = 0.0;
    for pair in records.windows(3).skip(100) {
        let rate = |r: [&Relative; 2]| (r[1].distance - r[0].distance) / 0.02;
        let truth = rate([&pair[0].edges[0].relative, &pair[2].edges[0].relative]);
        worst = worst.max((pair[1].edges[0].rates[0] - truth).abs());
    }
    // A central difference of a rate that may bend by some m/s² is right to some 0.02 m/s.
    assert!(worst < 0.05, "an estimate of the rate is {worst} m/s off");
}

/// What is recorded as applied is what the world moved by, for every law; and followers of a filtered robot see it.
#[test]
fn what_is_recorded_as_applied_is_what_the_robot_does() {
    for kind in [LawKind::FullState, LawKind::RobustState, LawKind::OutputFeedback] {
        let records = run(&pillar(kind));
        assert!(!touches(&records), "{kind:?}");
        for pair in records.windows(2) {
            let (edge, after) = (&pair[0].edges[0], &pair[1].snapshot.robots[1].motion);
            let before = &pair[0].snapshot.robots[1].motion;
            let turned = vocabulary::wrap(after.pose.heading - before.pose.heading);
            assert!((turned - 0.01 * edge.applied.turn_rate).abs() < 1e-9, "{kind:?}");
            let state = &pair[0].safety[0];
            if state.moved > 1e-6 {
                assert_eq!(edge.applied.turn_rate, state.applied.turn_rate, "{kind:?}");
                assert!(edge.limited);
            }
        }
    }
}

/// A gate that is narrower than the robot with its margin: it stops in front, and the run goes on.
#[test]
fn barriers_wider_than_a_gate_stop_a_robot_in_front_of_it() {
    let mut text = pillar(LawKind::OutputFeedback);
    for (name, y) in [("left", -1.1), ("right", -1.75)] {
        let _ = write!(
            text,
            "[[props]]\nname = \"{name}\"\nshape = \"cylinder\"\nradius = 0.1\nheight = 0.6\npose = [6.0, {y}, 0.0]\n"
        );
    }
    let records = run(&text.replace("pose = [3.0, -1.2, 0.0]", "pose = [3.0, 9.0, 0.0]"));
    assert!(!touches(&records));
    assert_eq!(records.len(), 1201);
}

#[test]
fn a_robot_stays_in_its_arena() {
    let text = HEAD_ON.replace("pose = [8.0, 0.05", "pose = [8.0, 3.0");
    let filter = "filter = true\nleads = true\narena = [-1.0, -2.0, 9.0, 5.0]\n";
    let records = run(&format!("{text}\n[safety]\n{filter}"));
    for record in &records {
        let [ann, bob] = [0, 1].map(|k| record.snapshot.robots[k].motion.pose.world_from_body(0.135, 0.0));
        assert!(ann[0] + 0.24 < 9.0 && bob[0] - 0.24 > -1.0, "{ann:?} {bob:?}");
    }
    let last = &records[records.len() - 1].safety[0];
    assert!(last.barriers.iter().any(|barrier| barrier.constraint == Constraint::Edge(2)), "{last:?}");
}
