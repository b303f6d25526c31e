//! From the keys of a file to the checked scene: parts put together and held against each other.

use crate::{
    Expect, Film, PropSpec, Robot, Scene, Shot, Time, Views,
    document::{Document, GroupKeys, RobotKeys},
    events::{check_hand_over, events},
    graph::{Named, check_graph, check_known},
    ground::ground,
    groups::{Group, expand},
    narrowing::check_narrowing,
    props::{Placed, PropStage},
    robots::{Defaults, RobotDraft, draft},
    safety::check_safety,
    sight::{Said, check_sight, number},
    start::check_start,
    text::{Found, Keys, Node, Part, Reporter, Span},
    types::{
        EnvironmentPart, ExpectPart, FilmPart, HandOverPart, PhysicsPart, ROBOT_VIEWS, TimePart, ViewsPart,
        VisionPart,
    },
    vehicle::{check_meaning, kind_is_lost, usual_kind},
};
use std::collections::HashSet;
use vocabulary::TimeMode;

/// The checked scene, or `None` after reporting errors.
pub(crate) fn resolve(document: Document, root: &Node, reporter: &mut Reporter) -> Option<Scene> {
    // Keys of another version may mean something else.
    document.schema.as_ref()?;
    let seed = document.seed.as_ref()?.value;
    let defaults = defaults(&document, root, reporter)?;
    let physics = document.physics?.value;
    let time_part = document.time?.value;
    let time = time(&time_part, reporter);
    let (robots, groups) = (document.robots?.value, document.groups?.value);
    let ground = match (root.get("ground"), &document.ground) {
        // The key is there; its error is reported already.
        (Some(_), None) => None,
        (_, keys) => ground(keys.as_ref().map(|found| &found.value), seed, reporter),
    };
    let mut drafts = drafts(&robots, &groups, root, seed, &defaults, reporter);
    number(&mut drafts, reporter);
    check_graph(drafts.iter().map(|draft| &draft.named), reporter);
    let (props, patterns) = (document.props?.value, document.patterns?.value);
    let standing: Vec<_> = drafts.iter().filter_map(|draft| draft.robot.as_ref()).collect();
    let stage = PropStage { ground: ground.as_ref(), robots: &standing, seed };
    let props = stage.props(&props, &patterns, root, reporter);
    check_names(&drafts, &props, reporter);
    let vision_part = document.vision?.value;
    let vision = vision_part.complete(&VisionPart::default());
    check_sight(&Said { time: &time_part, part: &vision_part, vision: &vision }, &drafts, reporter);
    check_safety(&time_part, &drafts, reporter);
    check_narrowing(&drafts, reporter);
    let level = ground.as_ref().is_none_or(|ground| ground.terrain.is_none());
    check_continuous(&time_part, &drafts, &props, level, reporter);
    if let Some(ground) = &ground
        && reporter.is_clean()
    {
        let robots = drafts.iter().filter_map(|draft| Some((draft.start?, draft.robot.as_ref()?)));
        check_start(robots, &props, ground, reporter);
    }
    let listed = document.events?.value;
    let events = events(&listed, root, time_part.mode.as_ref(), &drafts, &defaults, reporter);
    let hand_over = document.hand_over?;
    let hand_over = Found { span: hand_over.span, value: hand_over.value.complete(&HandOverPart::default()) };
    check_hand_over(&hand_over, reporter);
    let views = views(&document.views?.value, &drafts, reporter);
    let film = film(&document.film?.value, time.duration, &drafts, reporter);
    Some(Scene {
        title: document.title?.value,
        description: document.description?.value,
        seed,
        time,
        physics: physics.complete(&PhysicsPart::default()),
        ground: ground?,
        props: props.into_iter().map(|placed| placed.value).collect(),
        vision,
        robots: drafts.into_iter().map(|draft| draft.robot).collect::<Option<_>>()?,
        changes: vec![],
        events,
        hand_over: hand_over.value,
        environment: document.environment?.value.complete(&EnvironmentPart::default()),
        views,
        film,
        expect: expect(&document.expect?.value, reporter),
    })
}

/// What holds for every robot that says nothing else.
fn defaults(document: &Document, root: &Node, reporter: &mut Reporter) -> Option<Defaults> {
    let physics = &document.physics.as_ref()?.value;
    if kind_is_lost(root.get("vehicle"), document.vehicle.as_ref()) {
        return None;
    }
    let vehicle = document.vehicle.as_ref()?.value.clone();
    check_meaning(&vehicle, usual_kind(&vehicle), reporter);
    Some(Defaults {
        vehicle,
        law: document.law.as_ref()?.value.clone(),
        observer: document.observer.as_ref()?.value.clone(),
        sensing: document.sensing.as_ref()?.value.clone(),
        narrowing: document.narrowing.as_ref()?.value.clone(),
        safety: document.safety.as_ref()?.value.clone(),
        proximity: document.proximity.as_ref()?.value.clone(),
        step: physics.complete(&PhysicsPart::default()).step,
        step_span: physics.step.as_ref().map(|found| found.span),
    })
}

/// The robots of a document alone, or `None` after reporting errors. For what has changed since a scene was resolved.
pub(crate) fn resolve_robots(
    document: &Document,
    root: &Node,
    reporter: &mut Reporter,
) -> Option<Vec<Robot>> {
    let seed = document.seed.as_ref()?.value;
    let defaults = defaults(document, root, reporter)?;
    let (robots, groups) = (&document.robots.as_ref()?.value, &document.groups.as_ref()?.value);
    let mut drafts = drafts(robots, groups, root, seed, &defaults, reporter);
    number(&mut drafts, reporter);
    let (time, part) = (&document.time.as_ref()?.value, &document.vision.as_ref()?.value);
    let vision = part.complete(&VisionPart::default());
    check_sight(&Said { time, part, vision: &vision }, &drafts, reporter);
    check_safety(time, &drafts, reporter);
    check_narrowing(&drafts, reporter);
    drafts.into_iter().map(|draft| draft.robot).collect()
}

fn expect(part: &ExpectPart, reporter: &mut Reporter) -> Expect {
    let expect = part.complete(&ExpectPart::default());
    let bound = part.settled_error_at_most.as_ref().or(part.settled_rms_at_most.as_ref());
    match (bound, &part.settled_after) {
        (Some(error), None) => {
            reporter.report(error.span, "`settled_after` is missing: from when on, in s, does this hold?");
        }
        (None, Some(after)) => {
            let message = "`settled_after` needs `settled_error_at_most` or `settled_rms_at_most`, which hold from then on";
            reporter.report(after.span, message);
        }
        _ => {}
    }
    let ranges =
        [("speed_within", &part.speed_within), ("contact_impulse_within", &part.contact_impulse_within)];
    for (key, found) in ranges {
        if let Some(Found { span, value: Some([low, high]) }) = found
            && low > high
        {
            reporter.report(*span, format!("`{key}` is [least, most], and {low} is more than {high}"));
        }
    }
    expect
}

/// Reports props that are called as a robot or another prop.
fn check_names(drafts: &[RobotDraft], props: &[Placed], reporter: &mut Reporter) {
    let robots: HashSet<_> =
        drafts.iter().filter_map(|draft| Some(&draft.named.name.as_ref()?.value)).collect();
    let mut seen = HashSet::new();
    for Placed { span, value: PropSpec { name, .. } } in props {
        if robots.contains(name) {
            reporter.report(*span, format!("there are a robot and a prop called `{name}`"));
        } else if !seen.insert(name) {
            reporter.report(*span, format!("there are two props called `{name}`"));
        }
    }
}

/// Reports what continuous time cannot carry.
fn check_continuous(
    part: &TimePart,
    drafts: &[RobotDraft],
    props: &[Placed],
    level: bool,
    reporter: &mut Reporter,
) {
    let Some(mode) = part.mode.as_ref().filter(|mode| mode.value == TimeMode::Continuous) else { return };
    let mut robots = drafts.iter().filter_map(|draft| draft.robot.as_ref());
    let wheels =
        robots.find(|robot| robot.vehicle.kind.has_wheels()).map(|robot| (&robot.name, "has wheels"));
    let prop = props.first().map(|prop| (&prop.value.name, "is in their way"));
    let hindrance = wheels.or(prop).map(|(name, why)| format!("`{name}` {why}"));
    if let Some(why) = hindrance.or_else(|| (!level).then(|| "`ground` is not bare and level".to_owned())) {
        let message = format!(
            "mode `continuous` is for unicycles on empty ground, but {why}; use `sampled` or `measured`"
        );
        reporter.report(mode.span, message);
    }
}

/// All robots, those of groups after those that stand alone.
fn drafts(
    robots: &[RobotKeys],
    groups: &[GroupKeys],
    root: &Node,
    seed: u64,
    defaults: &Defaults,
    reporter: &mut Reporter,
) -> Vec<RobotDraft> {
    let nodes = root.items("robots");
    let mut drafts: Vec<_> =
        robots.iter().zip(nodes).map(|(keys, node)| draft(keys, node, defaults, reporter)).collect();
    for (index, (keys, node)) in groups.iter().zip(root.items("groups")).enumerate() {
        let group = Group { keys, node, index: index as u64 };
        if expand(&group, seed, defaults, &mut drafts, reporter).is_none() {
            // Its errors are reported already; a robot that is not known may be one of its.
            let named = Named { name: None, leaders: vec![] };
            drafts.push(RobotDraft { named, start: None, number: None, robot: None });
        }
    }
    if ["robots", "groups"].iter().all(|key| root.items(key).is_empty()) {
        reporter
            .report(root.span.first(), "a scene needs at least one robot: write [[robots]] or [[groups]]");
    }
    drafts
}

/// A run with more control steps than this is taken for a typing error.
const MOST_STEPS: f64 = 1e8;

fn time(part: &TimePart, reporter: &mut Reporter) -> Time {
    let time = part.complete(&TimePart::default());
    // The key that was written is the one to point at; the defaults fit each other.
    let Some(span) = part.span_of("period").or_else(|| part.span_of("duration")) else { return time };
    if time.period > time.duration {
        let Time { period, duration, .. } = time;
        reporter.report(span, format!("`period` of {period} s is larger than `duration` of {duration} s"));
    } else if time.duration / time.period > MOST_STEPS {
        let steps = time.duration / time.period;
        reporter.report(span, format!("{steps:.0} control periods in the run; the most are {MOST_STEPS:.0}"));
    }
    time
}

fn views(part: &ViewsPart, drafts: &[RobotDraft], reporter: &mut Reporter) -> Views {
    check_view(part.default.as_ref().map(|found| (found.span, found.value.as_str())), drafts, reporter);
    part.complete(&ViewsPart::default())
}

fn film(part: &FilmPart, duration: f64, drafts: &[RobotDraft], reporter: &mut Reporter) -> Film {
    let view = part.view.as_ref().and_then(|found| Some((found.span, found.value.as_deref()?)));
    check_view(view, drafts, reporter);
    if let Some(size) = part.size.as_ref().filter(|size| size.value.iter().any(|side| side % 2 == 1)) {
        reporter.report(size.span, "`size` must be even both ways, as video needs it");
    }
    let mut film = part.complete(&FilmPart::default());
    if let Some(span) = part.shots.as_ref().map(|found| found.span) {
        shots(&mut film.shots, span, duration, drafts, reporter);
    }
    film
}

/// Gives every shot its beginning and end. Whether the run is long enough matters once it is filmed: [`Film::beyond`].
fn shots(shots: &mut [Shot], span: Span, duration: f64, drafts: &[RobotDraft], reporter: &mut Reporter) {
    let begins: Vec<Option<f64>> = shots.iter().map(|shot| shot.from).collect();
    let mut now = 0.0;
    for (k, shot) in shots.iter_mut().enumerate() {
        let from = shot.from.unwrap_or(now);
        let said = shot.to.or(begins.get(k + 1).copied().flatten());
        let to = said.unwrap_or(duration.max(from));
        let name = format!("shot {} of the film", k + 1);
        if from < now {
            let message = format!("{name} begins at {from} s, before the one before it ends, at {now} s");
            reporter.report(span, message);
        } else if said.is_some_and(|to| to <= from) {
            let message = format!("{name} has no length: it begins at {from} s and ends at {to} s");
            reporter.report(span, message);
        }
        for part in shot.view.iter().flat_map(|view| view.split('+')) {
            check_view(Some((span, part.trim())), drafts, reporter);
        }
        // A shot that begins after the run has no end of its own, also where the scene is written out.
        (shot.from, shot.to) = (Some(from), (to > from).then_some(to));
        now = to;
    }
}

/// Reports a view of a robot which is not there.
fn check_view(view: Option<(Span, &str)>, drafts: &[RobotDraft], reporter: &mut Reporter) {
    if let Some((span, view)) = view
        && let Some(name) = ROBOT_VIEWS.iter().find_map(|start| view.strip_prefix(start))
    {
        check_known(name, span, drafts.iter().map(|draft| &draft.named), reporter);
    }
}
