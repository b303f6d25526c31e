//! Events as they are written, and what can be wrong about them before a run.

use crate::{
    Event, Failure, HandOver, Happening, Holds, Joining, Path, Place, Recovery, Role, Trigger, When,
    graph::check_known,
    leaders::{check_count, keeps_its_leaders},
    names::NameForm,
    narrowing::fault,
    path_form::PATH,
    robots::{Defaults, RobotDraft, check_distance, check_path},
    text::{Couple, Found, Node, Reporter, Span, keys, keys::one_of, number, table, words::word},
    types::{BearingForm, DistanceForm, LawPart, NarrowingPart, ObserverPart, SensingForm, SensingPart},
};
use std::collections::{HashMap, HashSet};
use vocabulary::{ScalarTrajectory, TimeMode};

keys! {
    /// Something that happens to a robot while the run goes, once: it follows another (`leader`), drives on its own
    /// (`path`), fails (`fails`), or all who follow it take their places anew (`assign`).
    struct EventKeys {
        /// When it happens: the first control sample at or after this, s; or give `when`.
        at: f64 = number("s").from(0.0).up_to(1e5), optional;
        /// What has to hold for it to happen; or give `at`.
        when: WhenKeys = table::<WhenKeys>(), optional;
        /// Name of the robot it happens to.
        robot: String = NameForm::WHOLE, optional;
        /// Name of the robot that it follows from now on.
        leader: String = NameForm::WHOLE, optional;
        /// Wanted distance from that leader, m; with `bearing`. Without both it keeps the place that it has then.
        distance: ScalarTrajectory = DistanceForm, optional;
        /// Wanted bearing, seen from that leader's heading, left positive; with `distance`.
        bearing: ScalarTrajectory = BearingForm, optional;
        /// Control law of a robot that does not follow from the start, where it differs from the scene's `law`.
        law: LawPart = table::<LawPart>(), optional;
        /// Observer of a robot that does not follow from the start, where it differs from the scene's `observer`.
        observer: ObserverPart = table::<ObserverPart>(), optional;
        /// What such a robot knows of its leader, where it differs from the scene's `sensing`.
        sensing: SensingPart = SensingForm, optional;
        /// Whether and how such a robot files in, where it differs from the scene's `narrowing`.
        narrowing: NarrowingPart = table::<NarrowingPart>(), optional;
        /// Its motion from now on, from where it is then.
        path: Path = PATH, optional;
        /// How it fails.
        fails: Failure = word::<Failure>(), optional;
        /// What becomes of those who follow it, with `fails`.
        recovery: Recovery = word::<Recovery>(), optional;
        /// Name of a robot whose followers, and those who follow them, take the places that are there anew.
        assign: String = NameForm::WHOLE, optional;
    }
}

keys! {
    /// What has to hold of a robot for an event to happen: `reaches`, `clearance_below`, `lost_for` or `blocked_for`.
    struct WhenKeys {
        /// Name of the robot.
        robot: String = NameForm::WHOLE, required;
        /// It has come near this place, [x, y] in m.
        reaches: [f64; 2] = Couple(number("m"), number("m")), optional;
        /// How near, with `reaches`, m.
        within: f64 = number("m").above(0.0).up_to(1e5), optional;
        /// Something is nearer than this to the circle around its body, m.
        clearance_below: f64 = number("m").from(0.0).up_to(1e5), optional;
        /// It has not known for this long where its leader is, s.
        lost_for: f64 = number("s").from(0.0).up_to(1e5), optional;
        /// It has stood for this long while its leader drove, s.
        blocked_for: f64 = number("s").from(0.0).up_to(1e5), optional;
    }
}

/// Near enough to a place where nothing is said, m.
const WITHIN: f64 = 1.0;

/// The checked events of a scene, in the order of the file.
pub(crate) fn events(
    items: &[EventKeys],
    root: &Node,
    mode: Option<&Found<TimeMode>>,
    drafts: &[RobotDraft],
    defaults: &Defaults,
    reporter: &mut Reporter,
) -> Vec<Event> {
    let mut events: Vec<(Event, Span)> = vec![];
    for (keys, node) in items.iter().zip(root.items("events")) {
        let draft = EventDraft { keys, node, drafts, defaults };
        let trigger = draft.trigger(reporter);
        let happening = draft.happening(reporter);
        if let (Some(trigger), Some(happening)) = (trigger, happening) {
            events.push((Event { trigger, happening }, node.span));
        }
    }
    if let (Some(mode), false) = (mode.filter(|mode| mode.value == TimeMode::Continuous), items.is_empty()) {
        let message = "mode `continuous` has no control samples at which events could happen; use `sampled` or `measured`";
        reporter.report(mode.span, message);
    }
    check_order(&events, drafts, reporter);
    events.into_iter().map(|(event, _)| event).collect()
}

/// Reports bounds of a hand-over that leave no place.
pub(crate) fn check_hand_over(hand_over: &Found<HandOver>, reporter: &mut Reporter) {
    let [nearest, farthest] = hand_over.value.distance;
    if nearest >= farthest {
        let message = format!(
            "`distance` of `hand_over` leaves no place: {nearest} m at the nearest, {farthest} m at the farthest"
        );
        reporter.report(hand_over.span, message);
    }
}

/// One event as it is written, and what it is read with.
struct EventDraft<'a> {
    keys: &'a EventKeys,
    node: &'a Node,
    drafts: &'a [RobotDraft],
    defaults: &'a Defaults,
}

impl EventDraft<'_> {
    fn trigger(&self, reporter: &mut Reporter) -> Option<Trigger> {
        let at = self.keys.at.clone().map(|at| Found { span: at.span, value: Trigger::At { at: at.value } });
        let when = self.keys.when.as_ref().and_then(|when| {
            let value = Trigger::When { when: self.when(&when.value, when.span, reporter)? };
            Some(Found { span: when.span, value })
        });
        if self.keys.when.is_some() && when.is_none() {
            return None;
        }
        Some(one_of(self.node, ["at", "when"], [at, when], reporter)?.0.value)
    }

    fn when(&self, keys: &WhenKeys, span: Span, reporter: &mut Reporter) -> Option<When> {
        let robot = keys.robot.as_ref()?;
        self.known(robot, reporter);
        let within = keys.within.as_ref().map(|found| found.value);
        let given = [
            keys.reaches
                .as_ref()
                .map(|found| Holds::Reaches { reaches: found.value, within: within.unwrap_or(WITHIN) }),
            keys.clearance_below.as_ref().map(|found| Holds::ClearanceBelow { clearance_below: found.value }),
            keys.lost_for.as_ref().map(|found| Holds::LostFor { lost_for: found.value }),
            keys.blocked_for.as_ref().map(|found| Holds::BlockedFor { blocked_for: found.value }),
        ];
        let mut given = given.into_iter().flatten();
        let (Some(holds), None) = (given.next(), given.next()) else {
            let named = ["reaches", "clearance_below", "lost_for", "blocked_for"];
            // What is given, and wrong, has been told.
            let node = self.node.get("when");
            if named.iter().filter(|key| node.is_some_and(|node| node.get(key).is_some())).count() == 1 {
                return None;
            }
            let message =
                "give one of `reaches`, `clearance_below`, `lost_for` and `blocked_for` here, and no more";
            reporter.report(span, message);
            return None;
        };
        if let (Some(found), false) = (&keys.within, matches!(holds, Holds::Reaches { .. })) {
            reporter.report(found.span, "`within` is for events with `reaches`");
        }
        if matches!(holds, Holds::LostFor { .. } | Holds::BlockedFor { .. }) && !self.follows(&robot.value) {
            let message = format!("`{}` leads from the start: it has no leader to lose", robot.value);
            reporter.report(robot.span, message);
        }
        Some(When { robot: robot.value.clone(), holds })
    }

    fn happening(&self, reporter: &mut Reporter) -> Option<Happening> {
        let EventKeys { leader, path, fails, assign, robot, .. } = self.keys;
        let given: Vec<_> = ["leader", "path", "fails", "assign"]
            .into_iter()
            .filter(|key| self.node.get(key).is_some())
            .collect();
        let [kind] = given[..] else {
            let message = match given[..] {
                [] => "say what happens: `leader`, `path`, `fails` or `assign` is missing".to_owned(),
                _ => format!("one event is one thing: give only one of `{}`", given.join("` and `")),
            };
            reporter.report(self.node.span, message);
            return None;
        };
        self.check_keys(kind, reporter);
        if let Some(leader) = assign {
            self.known(leader, reporter);
            if let Some(robot) = self.several_behind(&leader.value) {
                let message = format!(
                    "`{}` follows `{}` and has several leaders: nobody can take its place, nor it that of others",
                    robot.name, leader.value
                );
                reporter.report(leader.span, message);
            }
            return Some(Happening::Assign { assign: leader.value.clone() });
        }
        if kind == "assign" {
            return None;
        }
        let Some(robot) = robot else {
            if self.node.get("robot").is_none() {
                reporter.report(self.node.span, "`robot` is missing: say to which robot it happens");
            }
            return None;
        };
        self.known(robot, reporter);
        let name = robot.value.clone();
        if let Some(leader) = leader {
            return self.follow(name, leader, reporter);
        }
        if let Some(path) = path {
            if path.value.is_planned() {
                reporter.report(path.span, "ways to goals are planned before a run begins: give the path of an event as it is driven");
                return None;
            }
            if let Some(robot) = self.robot(&name) {
                check_path(path, &robot.vehicle, reporter);
            }
            return Some(Happening::Lead { robot: name, path: path.value.clone() });
        }
        let fails = fails.as_ref()?.value;
        let recovery = self.keys.recovery.as_ref().map_or_else(Recovery::default, |found| found.value);
        Some(Happening::Fail { robot: name, fails, recovery })
    }

    /// Reports keys that mean nothing for an event of this kind.
    fn check_keys(&self, kind: &str, reporter: &mut Reporter) {
        let fits: &[&str] = match kind {
            "leader" => {
                &["robot", "leader", "distance", "bearing", "law", "observer", "sensing", "narrowing"]
            }
            "path" => &["robot", "path"],
            "fails" => &["robot", "fails", "recovery"],
            _ => &["assign"],
        };
        for (key, span) in crate::text::Keys::spans(self.keys) {
            if !fits.contains(&key) && !matches!(key, "at" | "when") {
                reporter.report(span, format!("`{key}` means nothing for an event with `{kind}`"));
            }
        }
    }

    fn follow(&self, name: String, leader: &Found<String>, reporter: &mut Reporter) -> Option<Happening> {
        self.known(leader, reporter);
        if name == leader.value {
            reporter.report(leader.span, format!("`{name}` cannot follow itself"));
            return None;
        }
        let EventKeys { distance, bearing, law, observer, sensing, narrowing, .. } = self.keys;
        let place = match (distance, bearing) {
            (Some(distance), Some(bearing)) => {
                Some(Place { distance: distance.value.clone(), bearing: bearing.value.clone() })
            }
            (Some(found), None) => {
                reporter.report(found.span, "`bearing` is missing: a place has a `distance` and a `bearing`");
                None
            }
            (None, Some(found)) => {
                reporter
                    .report(found.span, "`distance` is missing: a place has a `distance` and a `bearing`");
                None
            }
            (None, None) => None,
        };
        let robot = self.robot(&name)?;
        if let Some(message) = keeps_its_leaders(robot) {
            reporter.report(leader.span, message);
        }
        let mut joins = None;
        let mut distance_min = robot.role.follow().map(|follow| follow.law.distance_min);
        if robot.role.follow().is_some() {
            let own = [
                ("law", law.as_ref().map(|found| found.span)),
                ("observer", observer.as_ref().map(|found| found.span)),
                ("sensing", sensing.as_ref().map(|found| found.span)),
                ("narrowing", narrowing.as_ref().map(|found| found.span)),
            ];
            for (key, span) in own.into_iter().filter_map(|(key, span)| Some((key, span?))) {
                let message = format!("`{name}` follows from the start and keeps its `{key}`; give it there");
                reporter.report(span, message);
            }
        } else {
            let law = law.clone().map_or_else(LawPart::default, |found| found.value);
            let law = self.defaults.law(&law, robot.vehicle.kind, self.node.span, reporter);
            let observer = observer.clone().map_or_else(ObserverPart::default, |found| found.value);
            let observer = self.defaults.observer(&observer, &robot.vehicle);
            let sensing = sensing.clone().map_or_else(SensingPart::default, |found| found.value);
            let sensing = self.defaults.sensing(&sensing);
            distance_min = Some(law.distance_min);
            let narrowing = narrowing.clone().map_or_else(NarrowingPart::default, |found| found.value);
            let narrowing = self.defaults.narrowing(&narrowing);
            if let Some(message) = fault(robot, &narrowing, &law) {
                reporter.report(self.node.span, message);
            }
            check_count(&name, 1, &law, self.node.span, reporter);
            joins = Some(Box::new(Joining { law, observer, sensing, narrowing }));
        }
        if let (Some(least), Some(found)) = (distance_min, distance) {
            check_distance(found.value.range()[0], least, found.span, reporter);
        }
        Some(Happening::Follow { robot: name, leader: leader.value.clone(), place, joins })
    }

    fn known(&self, name: &Found<String>, reporter: &mut Reporter) {
        check_known(&name.value, name.span, self.drafts.iter().map(|draft| &draft.named), reporter);
    }

    fn robot(&self, name: &str) -> Option<&crate::Robot> {
        self.drafts.iter().filter_map(|draft| draft.robot.as_ref()).find(|robot| robot.name == name)
    }

    /// A robot with several leaders that follows `head` at the start, directly or through others.
    fn several_behind(&self, head: &str) -> Option<&crate::Robot> {
        let robots: Vec<_> = self.drafts.iter().filter_map(|draft| draft.robot.as_ref()).collect();
        let several =
            |robot: &&crate::Robot| robot.role.follow().is_some_and(|follow| follow.leaders.are_several());
        if !robots.iter().any(several) {
            return None;
        }
        let mut behind = HashSet::from([head]);
        let follows = |robot: &crate::Robot, behind: &HashSet<&str>| {
            robot
                .role
                .follow()
                .is_some_and(|follow| follow.leaders.iter().any(|leader| behind.contains(&*leader.name)))
        };
        let mut before = 0;
        while std::mem::replace(&mut before, behind.len()) < behind.len() {
            let more: Vec<&str> =
                robots.iter().filter(|robot| follows(robot, &behind)).map(|robot| &*robot.name).collect();
            behind.extend(more);
        }
        robots.into_iter().find(|robot| several(robot) && behind.contains(&*robot.name))
    }

    /// Whether a robot follows at the start, or may follow later.
    fn follows(&self, name: &str) -> bool {
        self.robot(name).is_none_or(|robot| robot.role.follow().is_some())
    }
}

/// From leader to leader, from `from` to `to`, both included; `None` where no way leads there.
fn chain<'a>(leaders: &'a HashMap<String, Vec<String>>, from: &'a str, to: &str) -> Option<Vec<&'a str>> {
    let mut reached: HashMap<&str, Option<&str>> = HashMap::from([(from, None)]);
    let mut open = vec![from];
    while let Some(name) = open.pop() {
        if name == to {
            let mut chain: Vec<_> =
                std::iter::successors(Some(name), |name| reached.get(name).copied().flatten()).collect();
            chain.reverse();
            return Some(chain);
        }
        for next in leaders.get(name).into_iter().flatten() {
            reached.entry(next).or_insert_with(|| {
                open.push(next);
                Some(name)
            });
        }
    }
    None
}

/// Reports events that cannot both be, as far as their times tell: what happens to a robot after it has failed, two
/// things at one time, and followers in a ring.
fn check_order(events: &[(Event, Span)], drafts: &[RobotDraft], reporter: &mut Reporter) {
    let timed = |(event, span): &(Event, Span)| match event.trigger {
        Trigger::At { at } => Some((at, event.happening.clone(), *span)),
        Trigger::When { .. } => None,
    };
    let mut timed: Vec<_> = events.iter().filter_map(timed).collect();
    timed.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut failed: HashMap<String, f64> = HashMap::new();
    let mut last: HashMap<String, f64> = HashMap::new();
    let mut leaders: HashMap<String, Vec<String>> = HashMap::new();
    for robot in drafts.iter().filter_map(|draft| draft.robot.as_ref()) {
        if let Role::Follow(follow) = &robot.role {
            let names = follow.leaders.iter().map(|leader| leader.name.clone());
            leaders.insert(robot.name.clone(), names.collect());
        }
    }
    // Whoever recovers from a failure follows whom it can.
    let mut sure = true;
    for (at, happening, span) in &timed {
        for (_, name) in happening.robots() {
            if let Some(since) = failed.get(name).filter(|since| *since < at) {
                let message = format!("`{name}` fails at {since} s: nothing can happen to it at {at} s");
                reporter.report(*span, message);
                return;
            }
        }
        let Some((_, subject)) = happening.robots().first().copied() else { continue };
        if last.insert(subject.to_owned(), *at) == Some(*at) {
            reporter.report(*span, format!("two things happen to `{subject}` at {at} s: only one can"));
            return;
        }
        match happening {
            Happening::Fail { robot, .. } => {
                failed.insert(robot.clone(), *at);
                sure = false;
            }
            Happening::Lead { robot, .. } => drop(leaders.remove(robot)),
            Happening::Assign { .. } => sure = false,
            Happening::Follow { robot, leader, .. } => {
                let chain = chain(&leaders, leader, robot);
                if let Some(chain) = chain.filter(|_| sure) {
                    let ring: Vec<_> =
                        [robot.as_str()].iter().chain(&chain).map(|name| format!("`{name}`")).collect();
                    let message =
                        format!("at {at} s the followers would form a cycle: {}", ring.join(" follows "));
                    reporter.report(*span, message);
                    return;
                }
                leaders.insert(robot.clone(), vec![leader.clone()]);
            }
        }
    }
}
