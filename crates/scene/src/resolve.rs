//! From the keys of a file to the checked scene: defaults filled in, groups expanded, everything held against
//! everything else.

use crate::{
    Expect, Film, Follow, Mode, Path, Prop, PropMotion, Robot, Role, Scene, Time, Vehicle, Views,
    document::{Document, GroupKeys, RobotKeys},
    graph::{Named, check_graph, check_known},
    ground::ground,
    groups::{Group, expand},
    props::{Placed, Stage},
    start::check_start,
    text::{Found, Node, Part, Place, Reading},
    types::{
        EnvironmentPart, ExpectPart, FOLLOW, FilmPart, LawPart, ObserverPart, PhysicsPart, SensingPart,
        TimePart, VehiclePart, ViewsPart,
    },
    vehicle::{Written, check_meaning, usual_kind, vehicle},
};
use std::collections::HashSet;
use vocabulary::Pose;

/// What holds for every robot that says nothing else.
pub(crate) struct Defaults {
    pub(crate) vehicle: VehiclePart,
    pub(crate) law: LawPart,
    pub(crate) observer: ObserverPart,
    /// Step of the physics, s.
    pub(crate) step: f64,
    /// Where that is said.
    pub(crate) step_place: Option<Place>,
}

impl Defaults {
    /// The vehicle of a robot or group that says `own` of it and stands at `place`.
    pub(crate) fn vehicle(
        &self,
        own: Option<&Found<VehiclePart>>,
        place: Place,
        reading: &mut Reading,
    ) -> Vehicle {
        let nothing = VehiclePart::default();
        let own = own.map_or(&nothing, |found| &found.value);
        let place = self.step_place.unwrap_or(place);
        vehicle(&Written { own, scene: &self.vehicle, step: self.step, place }, reading)
    }
}

/// A robot as far as it could be made out, and where it came from.
pub(crate) struct Draft {
    pub(crate) named: Named,
    /// `None` after a note.
    pub(crate) robot: Option<Robot>,
}

/// The checked scene, or `None` after notes.
pub(crate) fn resolve(document: Document, root: &Node, reading: &mut Reading) -> Option<Scene> {
    // Another version may mean anything.
    document.schema?;
    let seed = document.seed?.value;
    let physics = document.physics?.value;
    let defaults = Defaults {
        vehicle: document.vehicle?.value,
        law: document.law?.value,
        observer: document.observer?.value,
        step: physics.complete(&PhysicsPart::default()).step,
        step_place: physics.step.as_ref().map(|found| found.place),
    };
    check_meaning(&defaults.vehicle, usual_kind(&defaults.vehicle), reading);
    let time_part = document.time?.value;
    let time = time(&time_part, reading);
    let (robots, groups) = (document.robots?.value, document.groups?.value);
    let ground = match (root.get("ground"), &document.ground) {
        // It is there, and has its note.
        (Some(_), None) => None,
        (_, keys) => ground(keys.as_ref().map(|found| &found.value), seed, reading),
    };
    let drafts = drafts(&robots, &groups, root, seed, &defaults, reading);
    check_graph(drafts.iter().map(|draft| &draft.named), reading);
    let (props, patterns) = (document.props?.value, document.patterns?.value);
    let standing: Vec<_> = drafts.iter().filter_map(|draft| draft.robot.as_ref()).collect();
    let stage = Stage { ground: ground.as_ref(), robots: &standing, seed };
    let props = stage.props(&props, &patterns, root, reading);
    check_names(&drafts, &props, reading);
    check_continuous(&time_part, &drafts, &props, reading);
    if let Some(ground) = &ground
        && reading.is_clean()
    {
        let robots =
            drafts.iter().filter_map(|draft| Some((draft.named.name.as_ref()?.place, draft.robot.as_ref()?)));
        check_start(robots, &props, ground, reading);
    }
    let views = views(&document.views?.value, &drafts, reading);
    let film = film(&document.film?.value, &drafts, reading);
    Some(Scene {
        title: document.title?.value,
        description: document.description?.value,
        seed,
        time,
        physics: physics.complete(&PhysicsPart::default()),
        ground: ground?,
        props: props.into_iter().map(|placed| placed.value).collect(),
        sensing: document.sensing?.value.complete(&SensingPart::default()),
        robots: drafts.into_iter().map(|draft| draft.robot).collect::<Option<_>>()?,
        environment: document.environment?.value.complete(&EnvironmentPart::default()),
        views,
        film,
        expect: expect(&document.expect?.value, &time, reading),
    })
}

fn expect(part: &ExpectPart, time: &Time, reading: &mut Reading) -> Expect {
    let expect = part.complete(&ExpectPart::default());
    match (&part.settled_error_at_most, &part.settled_after) {
        (Some(error), None) => {
            reading.note(error.place, "`settled_after` is missing: from when on, in s, does this hold?");
        }
        (None, Some(after)) => {
            reading
                .note(after.place, "`settled_after` needs `settled_error_at_most`, which holds from then on");
        }
        (_, Some(after)) if expect.settled_after.is_some_and(|after| after >= time.duration) => {
            let message = format!("`settled_after` must be before the end of the run at {} s", time.duration);
            reading.note(after.place, message);
        }
        _ => {}
    }
    let ranges =
        [("speed_within", &part.speed_within), ("contact_impulse_within", &part.contact_impulse_within)];
    for (key, found) in ranges {
        if let Some(Found { place, value: Some([low, high]) }) = found
            && low > high
        {
            reading.note(*place, format!("`{key}` is [least, most], and {low} is more than {high}"));
        }
    }
    expect
}

/// Notes props that are called as a robot or another prop.
fn check_names(drafts: &[Draft], props: &[Placed], reading: &mut Reading) {
    let robots: HashSet<_> =
        drafts.iter().filter_map(|draft| Some(&draft.named.name.as_ref()?.value)).collect();
    let mut seen = HashSet::new();
    for Placed { place, value: Prop { name, .. } } in props {
        if robots.contains(name) {
            reading.note(*place, format!("there are a robot and a prop called `{name}`"));
        } else if !seen.insert(name) {
            reading.note(*place, format!("there are two props called `{name}`"));
        }
    }
}

/// Notes what continuous time cannot carry.
fn check_continuous(part: &TimePart, drafts: &[Draft], props: &[Placed], reading: &mut Reading) {
    let Some(mode) = part.mode.as_ref().filter(|mode| mode.value == Mode::Continuous) else { return };
    let mut robots = drafts.iter().filter_map(|draft| draft.robot.as_ref());
    let wheels =
        robots.find(|robot| robot.vehicle.kind.has_wheels()).map(|robot| (&robot.name, "has wheels"));
    let mut moving = props.iter().map(|prop| &prop.value).filter(|prop| prop.motion != PropMotion::Fixed);
    if let Some((name, why)) = wheels.or_else(|| moving.next().map(|prop| (&prop.name, "can move"))) {
        let message = format!(
            "mode `continuous` is for unicycles and props that stand, but `{name}` {why}; \
             use `sampled` or `measured`"
        );
        reading.note(mode.place, message);
    }
}

/// All robots, those of groups after those that stand alone.
fn drafts(
    robots: &[RobotKeys],
    groups: &[GroupKeys],
    root: &Node,
    seed: u64,
    defaults: &Defaults,
    reading: &mut Reading,
) -> Vec<Draft> {
    let nodes = root.items("robots");
    let mut drafts: Vec<_> =
        robots.iter().zip(nodes).map(|(keys, node)| draft(keys, node, defaults, reading)).collect();
    for (index, (keys, node)) in groups.iter().zip(root.items("groups")).enumerate() {
        let group = Group { keys, node, index: index as u64 };
        // A group that cannot be read has its notes already.
        let _ = expand(&group, seed, defaults, &mut drafts, reading);
    }
    if ["robots", "groups"].iter().all(|key| root.items(key).is_empty()) {
        reading.note(root.place.first(), "a scene needs at least one robot: write [[robots]] or [[groups]]");
    }
    drafts
}

/// More control steps than this are a slip of the pen.
const MOST_STEPS: f64 = 1e8;

fn time(part: &TimePart, reading: &mut Reading) -> Time {
    let time = part.complete(&TimePart::default());
    // The key that was written is the one to point at; the defaults fit each other.
    let Some(place) = part.period.as_ref().map(|f| f.place).or(part.duration.as_ref().map(|f| f.place))
    else {
        return time;
    };
    if time.period > time.duration {
        let Time { period, duration, .. } = time;
        reading.note(place, format!("`period` of {period} s is larger than `duration` of {duration} s"));
    } else if time.duration / time.period > MOST_STEPS {
        let steps = time.duration / time.period;
        reading.note(place, format!("{steps:.0} control periods in the run; the most are {MOST_STEPS:.0}"));
    }
    time
}

fn draft(keys: &RobotKeys, node: &Node, defaults: &Defaults, reading: &mut Reading) -> Draft {
    let named = Named { name: keys.name.clone(), leader: keys.leader.clone() };
    Draft { named, robot: robot(keys, node, defaults, reading) }
}

fn robot(keys: &RobotKeys, node: &Node, defaults: &Defaults, reading: &mut Reading) -> Option<Robot> {
    let vehicle = defaults.vehicle(keys.vehicle.as_ref(), node.place, reading);
    let role = role(keys, node, &vehicle, defaults, reading);
    let path = keys.path.as_ref().map(|path| &path.value);
    let pose = match (node.get("pose"), &keys.pose) {
        // It is there, and has its note.
        (Some(_), None) => None,
        (_, pose) => start_pose(pose.as_ref(), path, node.place, reading),
    };
    Some(Robot { name: keys.name.as_ref()?.value.clone(), pose: pose?, vehicle, role: role? })
}

fn role(
    keys: &RobotKeys,
    node: &Node,
    vehicle: &Vehicle,
    defaults: &Defaults,
    reading: &mut Reading,
) -> Option<Role> {
    let name = keys.name.as_ref()?;
    match (node.get("path"), node.get("leader")) {
        (Some(_), None) => lead(keys, node, vehicle, reading),
        (None, Some(_)) => follow(keys, node, vehicle, defaults, reading).map(Role::Follow),
        (Some(_), Some(leader)) => {
            let message = format!("`{}` has a `path` and a `leader`; a robot leads or follows", name.value);
            reading.note(leader.place, message);
            None
        }
        (None, None) => {
            let message = format!(
                "robot `{}` is not connected: it needs a `path` to lead, or a `leader` to follow",
                name.value
            );
            reading.note(name.place, message);
            None
        }
    }
}

fn lead(keys: &RobotKeys, node: &Node, vehicle: &Vehicle, reading: &mut Reading) -> Option<Role> {
    let name = &keys.name.as_ref()?.value;
    for entry in
        ["distance", "bearing", "speed", "law", "observer"].into_iter().filter_map(|key| node.entry(key))
    {
        reading.note(entry.place, format!("`{}` is for robots that follow, but `{name}` leads", entry.key));
    }
    let path = keys.path.as_ref()?;
    check_path(path, vehicle, reading);
    Some(Role::Lead { path: path.value.clone() })
}

fn follow(
    keys: &RobotKeys,
    node: &Node,
    vehicle: &Vehicle,
    defaults: &Defaults,
    reading: &mut Reading,
) -> Option<Follow> {
    for key in ["distance", "bearing"] {
        if node.get(key).is_none() {
            reading.note(
                keys.leader.as_ref()?.place,
                format!("`{key}` is missing: a robot that follows needs it"),
            );
        }
    }
    let law =
        keys.law.as_ref().map_or_else(LawPart::default, |found| found.value.clone()).complete(&defaults.law);
    let observer = keys.observer.as_ref().map_or_else(ObserverPart::default, |found| found.value.clone());
    let speed = start_speed(keys.speed.as_ref(), vehicle, reading);
    let (distance, bearing) = (keys.distance.as_ref()?, keys.bearing.as_ref()?);
    check_distance(distance.value.least(), law.distance_min, distance.place, reading);
    Some(Follow {
        leader: keys.leader.as_ref()?.value.clone(),
        speed,
        distance: distance.value.clone(),
        bearing: bearing.value.clone(),
        law,
        observer: observer.complete(&defaults.observer),
    })
}

/// A follower's speed at the start, m/s.
pub(crate) fn start_speed(speed: Option<&Found<f64>>, vehicle: &Vehicle, reading: &mut Reading) -> f64 {
    let Some(speed) = speed else { return vehicle.speed_min };
    let Vehicle { speed_min, speed_max, .. } = *vehicle;
    if !(speed_min..=speed_max).contains(&speed.value) {
        let message = format!(
            "`speed` of {} m/s is outside the vehicle's limits, {speed_min} to {speed_max} m/s",
            speed.value
        );
        reading.note(speed.place, message);
    }
    speed.value
}

/// Notes a wanted distance (m) that falls below the least one the law divides by.
pub(crate) fn check_distance(least: f64, distance_min: f64, place: Place, reading: &mut Reading) {
    if least < distance_min {
        let message =
            format!("`distance` falls to {least} m, below the law's `distance_min` of {distance_min} m");
        reading.note(place, message);
    }
}

/// Notes a path that its robot cannot drive.
pub(crate) fn check_path(path: &Found<Path>, vehicle: &Vehicle, reading: &mut Reading) {
    let (speed, turn_rate) = path.value.peaks();
    if speed > vehicle.speed_max {
        let message = format!(
            "`path` reaches {speed} m/s, above the vehicle's `speed_max` of {} m/s",
            vehicle.speed_max
        );
        reading.note(path.place, message);
    }
    if let Some(turn_rate) = turn_rate.filter(|rate| *rate > vehicle.turn_rate_max) {
        let most = vehicle.turn_rate_max;
        reading.note(
            path.place,
            format!("`path` turns at {turn_rate} rad/s, above `turn_rate_max` of {most} rad/s"),
        );
    }
    if let Path::Constant { speed, turn_rate } | Path::Circle { speed, turn_rate } = path.value {
        let curvature = vehicle.limits().curvature_max;
        if speed > 0.0 && turn_rate.abs() > speed * curvature {
            let message = format!(
                "`path` turns tighter than the vehicle can: {turn_rate} rad/s at {speed} m/s is a circle of {:.3} m, and \
                 `steering_max` allows {:.3} m",
                speed / turn_rate.abs(),
                1.0 / curvature
            );
            reading.note(path.place, message);
        }
    }
}

/// Where a robot starts: its `pose`, or the start of its path; a note if they contradict each other or are missing.
pub(crate) fn start_pose(
    pose: Option<&Found<[f64; 3]>>,
    path: Option<&Path>,
    place: Place,
    reading: &mut Reading,
) -> Option<Pose> {
    let start = path.and_then(Path::start);
    let Some(pose) = pose else {
        if start.is_none() {
            reading.note(place, "`pose` is missing: write [x, y, heading]");
        }
        return start;
    };
    let [x, y, heading] = pose.value;
    if let Some(start) = start.filter(|start| (x - start.x).hypot(y - start.y) > 1e-6) {
        let message =
            format!("`pose` must start at the first of the path's points, [{}, {}]", start.x, start.y);
        reading.note(pose.place, message);
    }
    Some(Pose::new(x, y, heading))
}

fn views(part: &ViewsPart, drafts: &[Draft], reading: &mut Reading) -> Views {
    check_view(part.default.as_ref().map(|found| (found.place, found.value.as_str())), drafts, reading);
    part.complete(&ViewsPart::default())
}

fn film(part: &FilmPart, drafts: &[Draft], reading: &mut Reading) -> Film {
    let view = part.view.as_ref().and_then(|found| Some((found.place, found.value.as_deref()?)));
    check_view(view, drafts, reading);
    if let Some(size) = part.size.as_ref().filter(|size| size.value.iter().any(|side| side % 2 == 1)) {
        reading.note(size.place, "`size` must be even both ways, as video needs it");
    }
    part.complete(&FilmPart::default())
}

/// Notes a view that follows a robot which is not there.
fn check_view(view: Option<(Place, &str)>, drafts: &[Draft], reading: &mut Reading) {
    if let Some((place, view)) = view
        && let Some(name) = view.strip_prefix(FOLLOW)
    {
        check_known(name, place, drafts.iter().map(|draft| &draft.named), reading);
    }
}
