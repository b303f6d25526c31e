//! Robots that change their leader, fail, join and part: what whole runs show.

use metrics::{Metrics, MetricsBuilder};
use scene::{Override, Scene, shipped};
use simulation::{Simulation, build};
use studies::verdict::verdict;
use vocabulary::{Condition, EventKind, EventRecord, Refusal, StepRecord, math};

fn parse(text: &str, sets: &[&str]) -> Scene {
    let sets: Vec<Override> = sets.iter().map(|set| set.parse().expect("an override")).collect();
    Scene::parse(text, "t.toml", &sets).unwrap_or_else(|fault| panic!("{fault}")).scene
}

fn scene(name: &str, sets: &[&str]) -> Scene {
    parse(shipped(name).expect("a shipped scene").text, sets)
}

/// Runs a scene; `visit` sees every moment.
fn run(scene: &Scene, mut visit: impl FnMut(&StepRecord)) -> Metrics {
    let mut simulation = Simulation::new(build(scene).expect("a run"));
    let mut metrics = MetricsBuilder::new(simulation.fleet(), scene.judging());
    while let Some(record) = simulation.next_record() {
        metrics.push(record);
        visit(record);
    }
    assert!(simulation.fault().is_none(), "{:?}", simulation.fault());
    metrics.finish()
}

/// What happened, with its time in s.
fn events(scene: &Scene) -> Vec<(f64, EventRecord)> {
    let mut events = vec![];
    run(scene, |record| events.extend(record.events.iter().map(|event| (record.snapshot.time, *event))));
    events
}

/// A lead robot and three that follow one another on its left, with `events`.
fn chain(events: &str) -> String {
    let follower = |name: &str, leader: &str, [x, y]: [f64; 2]| {
        format!(
            "[[robots]]\nname = \"{name}\"\npose = [{x}, {y}, 0.0]\nleader = \"{leader}\"\ndistance = 2.0\n\
             bearing = \"135 deg\"\nspeed = 0.8\n"
        )
    };
    let robots = [
        follower("ann", "lead", [-1.414, 1.414]),
        follower("bob", "ann", [-2.828, 2.828]),
        follower("cy", "bob", [-4.243, 4.243]),
    ];
    format!(
        "schema = 1\ntitle = \"t\"\n[time]\nduration = 20.0\n[vehicle]\nacceleration_max = 3.0\n[law]\nheading = \
         \"path\"\nstanding = true\n[[robots]]\nname = \"lead\"\npose = [0.0, 0.0, 0.0]\npath = {{ kind = \
         \"constant\", speed = 0.8 }}\n{}{events}",
        robots.concat()
    )
}

#[test]
fn the_shipped_scenes_meet_their_expectations_as_unicycles_and_as_cars() {
    for name in ["hand-over", "lost-robot", "merge-two-columns", "join"] {
        for kind in ["unicycle", "car"] {
            for seed in 1..=3 {
                let scene = scene(name, &[&format!("vehicle.kind={kind}"), &format!("seed={seed}")]);
                let metrics = run(&scene, |_| {});
                for finding in verdict(&scene, &metrics, true) {
                    assert_eq!(finding.met, Some(true), "{name}, {kind}, {seed}: {finding:?}");
                }
            }
        }
    }
}

/// Whoever fails, and whatever is to become of the others: nobody touches anybody, and all who are left are in their places
/// within 12 s.
#[test]
fn a_formation_survives_the_loss_of_any_robot() {
    for robot in ["robot-1", "robot-2", "robot-4", "robot-6"] {
        for recovery in ["graft", "promote", "assign"] {
            for how in ["stop", "coast", "remove"] {
                let sets = [
                    format!("events.0.robot={robot}"),
                    format!("events.0.recovery={recovery}"),
                    format!("events.0.fails={how}"),
                ];
                let scene = scene("lost-robot", &sets.each_ref().map(String::as_str));
                let metrics = run(&scene, |_| {});
                for finding in verdict(&scene, &metrics, true) {
                    assert_eq!(finding.met, Some(true), "{robot} {recovery} {how}: {finding:?}");
                }
                let left = metrics.edges.iter().filter(|edge| edge.ended.is_none()).count();
                assert_eq!(left, 5, "{robot} {recovery} {how}: six are left, one leads");
            }
        }
    }
}

/// A set point that jumps costs a command at its limits; handed over, the command goes on from where it was.
#[test]
fn at_a_hand_over_no_command_jumps() {
    let mut last = None;
    let mut largest = [0.0_f64; 2];
    run(&scene("hand-over", &[]), |record| {
        let applied = record.edges[1].applied;
        if let Some(last) = last.replace(applied)
            && (applied.turn_rate - last.turn_rate).abs() > largest[0]
        {
            largest = [(applied.turn_rate - last.turn_rate).abs(), record.snapshot.time];
        }
    });
    assert!(largest[0] < 0.1, "{} rad/s from one sample to the next at {} s", largest[0], largest[1]);
}

#[test]
fn a_robot_that_stops_brakes_and_stands_and_one_that_is_taken_away_is_gone() {
    for (how, condition) in
        [("stop", Condition::Failed), ("coast", Condition::Failed), ("remove", Condition::Removed)]
    {
        let event = format!("[[events]]\nat = 5.0\nrobot = \"cy\"\nfails = \"{how}\"\n");
        let mut place = None;
        let mut last = StepRecord::default();
        run(&parse(&chain(&event), &[]), |record| {
            if record.snapshot.time >= 5.0 {
                place.get_or_insert(record.snapshot.robots[3].motion.pose);
            }
            last = record.clone();
        });
        let (robot, place) = (&last.snapshot.robots[3], place.expect("it fails"));
        assert_eq!(robot.condition, condition, "{how}");
        assert!(robot.motion.speed < 1e-3, "{how}: {} m/s", robot.motion.speed);
        let gone = math::hypot(robot.motion.pose.x - place.x, robot.motion.pose.y - place.y);
        // v²/2a: 0.8 m/s at 3 and at 0.3 m/s², and nothing.
        let range = match how {
            "stop" => 0.05..0.25,
            "coast" => 0.9..1.15,
            _ => 0.0..0.01,
        };
        assert!(range.contains(&gone), "{how}: {gone} m");
        assert_eq!(last.leaders, [Some(0), Some(1), None]);
    }
}

#[test]
fn what_cannot_be_is_refused_with_its_reason_and_the_run_goes_on() {
    let cases = [
        // A ring, as the events before it have made the formation: at load it cannot be known.
        (
            "[[events]]\nwhen = { robot = \"lead\", reaches = [4.0, 0.0] }\nrobot = \"ann\"\nleader = \"cy\"\n",
            Refusal::Cycle,
        ),
        (
            "[[events]]\nat = 5.0\nrobot = \"bob\"\nleader = \"lead\"\ndistance = 9.0\nbearing = \"135 deg\"\n",
            Refusal::PlaceFar,
        ),
        (
            "[[events]]\nat = 5.0\nrobot = \"bob\"\nleader = \"lead\"\ndistance = 0.3\nbearing = \"135 deg\"\n",
            Refusal::Near,
        ),
        (
            "[[events]]\nat = 5.0\nrobot = \"bob\"\nleader = \"lead\"\ndistance = 2.0\nbearing = \"10 deg\"\n",
            Refusal::Bearing,
        ),
        (
            "[hand_over]\ndistance = [0.5, 2.5]\n[[events]]\nat = 5.0\nrobot = \"cy\"\nleader = \"lead\"\n",
            Refusal::Far,
        ),
        (
            "[[events]]\nat = 4.0\nrobot = \"bob\"\nfails = \"stop\"\nrecovery = \"wait\"\n[[events]]\nwhen = { robot = \
             \"lead\", reaches = [5.0, 0.0] }\nrobot = \"cy\"\nleader = \"bob\"\n",
            Refusal::Leaderless,
        ),
        (
            "[[events]]\nat = 4.0\nrobot = \"cy\"\nfails = \"stop\"\n[[events]]\nwhen = { robot = \"lead\", reaches = [6.0, \
             0.0] }\nrobot = \"cy\"\nleader = \"ann\"\n",
            Refusal::Failed,
        ),
    ];
    for (text, refusal) in cases {
        let found = events(&parse(&chain(text), &[]));
        let refused = found.iter().find(|(_, event)| !event.happened());
        assert_eq!(refused.map(|(_, event)| event.refusal), Some(refusal), "{text}: {found:?}");
    }
    // An event that another one overtakes before it has taken hold.
    let twice = "[[events]]\nat = 5.0\nrobot = \"cy\"\nleader = \"ann\"\n[[events]]\nat = 5.05\nrobot = \"cy\"\npath = { kind = \
                 \"constant\", speed = 0.5 }\n";
    let found = events(&parse(&chain(twice), &["law.kind=output-feedback"]));
    let told: Vec<_> = found.iter().map(|(_, event)| (event.kind, event.refusal, event.event)).collect();
    let expected =
        [(EventKind::Follow, Refusal::Overtaken, Some(0)), (EventKind::Lead, Refusal::None, Some(1))];
    assert_eq!(told, expected, "{found:?}");
    let found = events(&parse(&chain("[[events]]\nat = 5.0\nassign = \"cy\"\n"), &[]));
    let words: Vec<_> = found.iter().map(|(_, event)| (event.kind, event.refusal)).collect();
    assert_eq!(words, [(EventKind::Assign, Refusal::Nothing)]);
    // Only those who look for their leader need to see it.
    let text = chain("[[events]]\nat = 5.0\nrobot = \"bob\"\nleader = \"lead\"\n");
    for (sensing, refusal) in
        [("truth", Refusal::None), ("noise", Refusal::None), ("geometric", Refusal::Hidden)]
    {
        let found = events(&parse(&text, &[&format!("sensing={sensing}")]));
        assert_eq!(
            found.iter().map(|(_, event)| event.refusal).next(),
            Some(refusal),
            "{sensing}: {found:?}"
        );
    }
    // On a tight curve the outer place moves too fast.
    let text = chain(
        "[[events]]\nat = 6.0\nrobot = \"bob\"\nleader = \"lead\"\ndistance = 4.0\nbearing = \"-100 deg\"\n",
    );
    let found = events(&parse(&text, &["robots.lead.path.turn_rate=0.3"]));
    assert_eq!(found.iter().map(|(_, event)| event.refusal).next(), Some(Refusal::Speed), "{found:?}");
}

/// What a scene asks for is judged by what took place, and a formation that is lost meets nothing.
#[test]
fn expectations_hold_events_against_the_scene() {
    let judged = |events: &str, expect: &str| {
        let scene = parse(&format!("{}[expect]\n{expect}\n", chain(events)), &[]);
        let metrics = run(&scene, |_| {});
        verdict(&scene, &metrics, true)
            .into_iter()
            .filter_map(|finding| Some((finding.key, finding.met?)))
            .filter(|(key, _)| *key != "completed")
            .collect::<Vec<_>>()
    };
    let fails = "[[events]]\nat = 4.0\nrobot = \"ann\"\nfails = \"stop\"\n";
    let never =
        "[[events]]\nwhen = { robot = \"lead\", reaches = [0.0, 50.0] }\nrobot = \"cy\"\nleader = \"ann\"\n";
    let all = |events: &str| judged(events, "no_event_refused = true");
    assert_eq!(all(fails), [("no_event_refused", true), ("nobody_left_behind", true)]);
    assert_eq!(all(never), [("no_event_refused", false)]);
    let waits = "[[events]]\nat = 4.0\nrobot = \"ann\"\nfails = \"stop\"\nrecovery = \"wait\"\n[hand_over]\ndistance = [0.5, 2.1]\n";
    assert_eq!(judged(waits, ""), [("nobody_left_behind", false)]);
    assert_eq!(judged(waits, "nobody_left_behind = false"), []);
    // Everybody has gone: nothing is judged as if it had gone well.
    let gone = ["ann", "bob", "cy"].map(|robot| {
        format!("[[events]]\nat = 4.0\nrobot = \"{robot}\"\npath = {{ kind = \"constant\", speed = 0.5 }}\n")
    });
    let found = judged(&gone.concat(), "final_distance_error = 0.1\nsettling_time = 15.0");
    assert_eq!(
        found,
        [("final_distance_error", false), ("settling_time", false), ("nobody_left_behind", true)]
    );
}

/// A robot that drives on its own may stop where its path does, as it may once it has waited.
#[test]
fn a_robot_that_parts_may_stand() {
    let text = chain("[[events]]\nat = 4.0\nrobot = \"ann\"\npath = { kind = \"constant\", speed = 0.0 }\n")
        .replace("standing = true", "standing = false");
    let mut last = StepRecord::default();
    run(&parse(&text, &[]), |record| last = record.clone());
    let speed = last.snapshot.robots[1].motion.speed;
    assert!(speed.abs() < 1e-6, "{speed} m/s");
}

/// Whoever waits tries again, and in the end stays where it is: no recovery is endless, and the others drive on.
#[test]
fn who_finds_no_leader_waits_for_so_long_and_no_longer() {
    // Nobody may be farther away than 1.5 times the farthest place, and the lead robot drives on.
    let text = chain(
        "[hand_over]\npatience = 5.0\ndistance = [0.5, 2.1]\n[[events]]\nat = 4.0\nrobot = \"ann\"\nfails = \"stop\"\n",
    );
    let mut last = StepRecord::default();
    let mut found = vec![];
    run(&parse(&text, &[]), |record| {
        found.extend(record.events.iter().map(|event| (record.snapshot.time, *event)));
        last = record.clone();
    });
    let kinds: Vec<EventKind> =
        found.iter().filter(|(_, event)| event.happened()).map(|(_, event)| event.kind).collect();
    assert_eq!(kinds, [EventKind::Stop, EventKind::Wait, EventKind::GiveUp], "{found:?}");
    let (gives_up, _) = found[found.len() - 1];
    assert!((gives_up - 9.0).abs() < 0.02, "at {gives_up} s");
    // Its own follower has stopped with it, and the lead robot has gone on.
    let speeds: Vec<f64> = last.snapshot.robots.iter().map(|robot| robot.motion.speed).collect();
    assert!(speeds[2] < 1e-3 && speeds[3] < 1e-3 && speeds[0] > 0.79, "{speeds:?}");
}

#[test]
fn triggers_fire_once_at_the_place_and_after_the_time_they_say() {
    let text = chain(
        "[[events]]\nwhen = { robot = \"lead\", reaches = [4.0, 0.0], within = 0.5 }\nrobot = \"cy\"\npath = { kind = \
         \"constant\", speed = 0.4 }\n[[events]]\nwhen = { robot = \"bob\", clearance_below = 9.0 }\nrobot = \"ann\"\n\
         leader = \"lead\"\ndistance = 2.0\nbearing = \"-135 deg\"\n",
    );
    let found = events(&parse(&text, &[]));
    let lead = found.iter().filter(|(_, event)| event.kind == EventKind::Lead);
    let times: Vec<f64> = lead.map(|(time, _)| *time).collect();
    assert_eq!(times.len(), 1);
    assert!((times[0] - 3.5 / 0.8).abs() < 0.02, "{times:?}");
    let moves = found.iter().filter(|(_, event)| event.kind == EventKind::Move).count();
    assert_eq!(moves, 1, "{found:?}");
}

/// A robot that is held up by a wall is blocked, and after a time its follower goes on without it.
#[test]
fn a_blocked_robot_is_left_behind() {
    let text = chain(
        "[proximity]\nrange = 4.0\n[safety]\nfilter = true\n[[props]]\nname = \"wall\"\nshape = \"block\"\nsize = [0.4, 2.0, \
         1.0]\npose = [6.0, 2.8, 0.0]\n[[events]]\nwhen = { robot = \"bob\", blocked_for = 2.0 }\nrobot = \"bob\"\nfails \
         = \"stop\"\n",
    );
    let scene = parse(&text, &["time.duration=40"]);
    let found = events(&scene);
    if let Some((time, event)) = found.first() {
        assert_eq!((event.kind, event.robot), (EventKind::Stop, 2), "{found:?}");
        assert!(*time > 2.0);
    }
    let metrics = run(&scene, |_| {});
    assert_eq!(metrics.contacts, 0);
}

/// Scattered robots take the places that are nearest, together.
#[test]
fn robots_on_each_others_side_take_each_others_places() {
    let text = "schema = 1\ntitle = \"t\"\n[time]\nduration = 20.0\n[vehicle]\nacceleration_max = 3.0\n[law]\nheading = \
         \"path\"\n[proximity]\nrange = 4.0\n[safety]\nfilter = true\n[[robots]]\nname = \"lead\"\npose = [0.0, 0.0, \
         0.0]\npath = { kind = \"constant\", speed = 0.8 }\n[[robots]]\nname = \"left\"\npose = [-1.6, -1.2, 0.0]\nleader = \
         \"lead\"\ndistance = 2.0\nbearing = \"135 deg\"\nspeed = 0.8\n[[robots]]\nname = \"right\"\npose = [-1.6, 1.2, \
         0.0]\nleader = \"lead\"\ndistance = 2.0\nbearing = \"-135 deg\"\nspeed = 0.8\n[[events]]\nat = 0.0\nassign = \
         \"lead\"\n";
    let mut last = StepRecord::default();
    let metrics = run(&parse(text, &[]), |record| last = record.clone());
    assert_eq!(metrics.contacts, 0);
    let sides: Vec<f64> = (1..3).map(|k| last.snapshot.robots[k].motion.pose.y).collect();
    assert!(sides[0] < -1.3 && sides[1] > 1.3, "they stay on the sides that they are on: {sides:?}");
}

/// With sensors a robot sees its new leader after a moment, and takes up its place by what it sees.
#[test]
fn followers_with_sensors_join_too() {
    for sensing in ["noise", "geometric"] {
        let mut seen = vec![];
        let scene = scene("join", &[&format!("sensing={sensing}")]);
        let metrics = run(&scene, |record| {
            if (13.0..14.0).contains(&record.snapshot.time) {
                seen.push(record.edges[2].sight);
            }
        });
        assert_eq!(metrics.contacts, 0, "{sensing}");
        let edge = &metrics.edges[2];
        assert!(edge.final_error[0].abs() < 0.02, "{sensing}: {:?}", edge.final_error);
        assert_eq!(seen.last(), Some(&vocabulary::TrackingState::Tracking), "{sensing}");
    }
}

/// Replayed from a copy in the middle of a hand-over, a run goes on bit for bit.
#[test]
fn a_copy_in_the_middle_of_an_event_goes_on_alike() {
    let scene = scene("lost-robot", &[]);
    let mut run = Simulation::new(build(&scene).expect("a run"));
    let mut copy = None;
    let mut ends = vec![];
    while let Some(record) = run.next_record() {
        let time = record.snapshot.time;
        ends = record.snapshot.robots.clone();
        if time >= 8.5 && copy.is_none() {
            copy = Some(run.save());
        }
    }
    let mut copy = copy.expect("a copy");
    let mut again = vec![];
    while let Some(record) = copy.next_record() {
        again.clone_from(&record.snapshot.robots);
    }
    assert_eq!(ends, again);
}

/// At a gate that is narrower than one robot the followers are held up: who would follow the lead robot gives up, those
/// behind it stop, and the lead robot drives on.
#[test]
fn who_is_held_up_for_too_long_gives_up() {
    let sets = [
        "props.wall-left.from=[9.2, 0.25]",
        "props.wall-right.from=[9.2, -0.25]",
        "hand_over.held_up=4",
        "time.duration=60",
    ];
    let scene = scene("gate-1.2", &sets);
    let mut last = StepRecord::default();
    let mut found = vec![];
    let metrics = run(&scene, |record| {
        let given_up = record.events.iter().filter(|event| event.kind == EventKind::GiveUp);
        found.extend(given_up.map(|event| (event.robot, record.snapshot.time)));
        last = record.clone();
    });
    assert_eq!(metrics.contacts, 0);
    let robots: Vec<usize> = found.iter().map(|(robot, _)| *robot).collect();
    assert!(robots.contains(&1) && robots.contains(&2), "{found:?}");
    assert!((1..7).all(|robot| robots.iter().filter(|other| **other == robot).count() <= 1), "{found:?}");
    assert!(found.iter().all(|(_, time)| *time < 40.0), "it ends: {found:?}");
    let [lead, others @ ..] = &last.snapshot.robots[..] else { panic!("robots") };
    assert!(lead.motion.speed > 0.79 && others.iter().all(|robot| robot.motion.speed < 0.02));
}
