//! Groups become robots.

use crate::{
    Follow, Law, Leaders, Narrowing, Observer, Proximity, Robot, Role, Safety, Sensing, Vehicle,
    document::{Follows, GroupKeys, MOST_ROBOTS, MemberKeys},
    graph::{Named, check_known},
    leaders::check_count,
    random::RandomStream,
    robots::{Defaults, RobotDraft, check_distance, check_path, start_pose, start_speed},
    text::{Form, Found, Keys, Node, Part, Reporter, Value, node::Entry, table, words::instead_of},
    types::VehiclePart,
    vehicle::{kind_is_lost, usual_kind},
};
use serde_json::{Value as Json, json};
use vocabulary::{Pose, ScalarTrajectory, math, wrap};

/// What is different about one robot of a group.
#[derive(Debug, Clone)]
pub(crate) struct GroupMember {
    name: Found<String>,
    keys: MemberKeys,
}

/// Robots of a group by their names.
pub(crate) struct MembersForm;

impl Form for MembersForm {
    type Out = Vec<GroupMember>;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Vec<GroupMember>> {
        let expected = || "a table of robots by their names".to_owned();
        let entries = reporter.expect(node.as_table(), node, expected)?;
        let member = |entry: &Entry| {
            let name = Found { span: entry.span, value: entry.key.clone() };
            Some(GroupMember { name, keys: table::<MemberKeys>().read(&entry.node, reporter)? })
        };
        // All items are read before giving up, so that every error is reported.
        let members: Vec<_> = entries.iter().map(member).collect();
        members.into_iter().collect()
    }

    fn schema(&self) -> Json {
        json!({ "type": "object", "additionalProperties": table::<MemberKeys>().schema() })
    }
}

/// Appends the robots of `group`; `None` after reporting an error.
pub(crate) fn expand(
    group: &Group<'_>,
    seed: u64,
    defaults: &Defaults,
    drafts: &mut Vec<RobotDraft>,
    reporter: &mut Reporter,
) -> Option<()> {
    let keys = group.keys;
    if kind_is_lost(group.node.get("vehicle"), keys.vehicle.as_ref()) {
        return None;
    }
    let count = group.count(drafts.len(), reporter)?;
    drafts.reserve(count);
    group.check_members(reporter);
    let usual = group.outfit(None, defaults, reporter)?;
    let speed = start_speed(keys.speed.as_ref(), &usual.vehicle, usual.law.standing, reporter);
    let spacing = keys.distance.as_ref()?;
    check_distance(spacing.value, usual.law.distance_min, spacing.span, reporter);
    let (leader, origin) = group.leader(&usual, defaults, drafts, reporter)?;
    let mut scatter = Scatter::new(keys, group.index, seed)?;
    for (place, spot) in group.spots(count)?.into_iter().enumerate().skip(1) {
        // Drawn for places that stay empty, too: the others start where they do all the same.
        let pose = scatter.around(origin, spot.at);
        let member = group.member(place);
        if member.is_some_and(MemberKeys::is_absent) {
            continue;
        }
        let (mut own, mut speed) = (usual.clone(), speed);
        if member.is_some() {
            own = group.outfit(member, defaults, reporter)?;
            speed = start_speed(keys.speed.as_ref(), &own.vehicle, own.law.standing, reporter);
        }
        let (distance, bearing) = spot.set_point(member);
        if let Some(found) = member.and_then(|keys| keys.distance.as_ref()) {
            check_distance(distance.range()[0], own.law.distance_min, found.span, reporter);
        }
        let Outfit { vehicle, law, observer, sensing, narrowing, safety, proximity } = own;
        let name = group.name(place);
        let told = member.and_then(|keys| keys.leader.clone());
        if told.is_none() {
            group.check_present(spot.follows, &name, reporter);
        }
        let usual = || if spot.follows == 0 { leader.clone() } else { group.name(spot.follows) };
        let followed = told.as_ref().map_or_else(usual, |told| told.value.clone());
        check_count(&name, 1, &law, group.node.span, reporter);
        let leaders = Leaders::one(followed, distance, bearing);
        let follow = Follow { leaders, speed, law, observer, sensing, narrowing };
        let role = Role::Follow(Box::new(follow));
        let robot = Robot { name, pose, number: 0, vehicle, safety, proximity, role };
        group.push(place, robot, told, drafts);
    }
    Some(())
}

impl MemberKeys {
    fn is_absent(&self) -> bool {
        self.absent.as_ref().is_some_and(|absent| absent.value)
    }
}

/// The names that the robots of the group at `node` have by their places.
pub(crate) fn made_by(node: &Node) -> impl Iterator<Item = String> {
    let start = start_of(node).to_owned();
    places(node).map(move |place| format!("{start}-{place}"))
}

/// The name that the robot of the group at `node` which is called `name` has by its place; `None` if there is none.
pub(crate) fn member_called(node: &Node, name: &str) -> Option<String> {
    let other = |key: &str| node.get("members")?.get(key)?.get("name")?.as_text();
    let Some(members) = node.get("members").and_then(Node::as_table) else {
        return makes(node, name).then(|| name.to_owned());
    };
    let renamed = members.iter().find(|entry| other(&entry.key) == Some(name)).map(|entry| entry.key.clone());
    let by_place = || other(name).is_none().then(|| name.to_owned());
    renamed.or_else(by_place).filter(|key| makes(node, key))
}

/// Whether a robot of the group at `node` has that name by its place.
fn makes(node: &Node, key: &str) -> bool {
    let number = key.strip_prefix(start_of(node)).and_then(|rest| rest.strip_prefix('-'));
    let place = number.and_then(|number| number.parse::<usize>().ok().filter(|n| n.to_string() == number));
    place.is_some_and(|place| places(node).contains(&place))
}

fn start_of(node: &Node) -> &str {
    node.get("name").and_then(Node::as_text).unwrap_or("robot")
}

fn places(node: &Node) -> std::ops::RangeInclusive<usize> {
    let count = match node.get("count").map(|count| &count.value) {
        Some(Value::Integer(count)) => usize::try_from(*count).unwrap_or(0).min(MOST_ROBOTS),
        _ => 0,
    };
    // The robot in place 1 is the group's own only if it has a path.
    let first = if node.get("path").is_some() { 1 } else { 2 };
    first..=count
}

/// What a robot of a group is and does.
#[derive(Clone)]
struct Outfit {
    vehicle: Vehicle,
    law: Law,
    observer: Observer,
    sensing: Sensing,
    narrowing: Narrowing,
    safety: Safety,
    proximity: Proximity,
}

/// A place in a group.
struct GroupSpot {
    /// [forward, left] of the group's leader, m.
    at: [f64; 2],
    /// Place that is followed.
    follows: usize,
    /// Distance from there, m.
    distance: f64,
    /// Bearing from there, rad.
    bearing: f64,
}

impl GroupSpot {
    /// Wanted distance and bearing there, of a robot of which `member` may say otherwise.
    fn set_point(&self, member: Option<&MemberKeys>) -> (ScalarTrajectory, ScalarTrajectory) {
        let said = |found: Option<&Found<ScalarTrajectory>>, value| {
            found.map_or(ScalarTrajectory::Constant(value), |found| found.value.clone())
        };
        (
            said(member.and_then(|keys| keys.distance.as_ref()), self.distance),
            said(member.and_then(|keys| keys.bearing.as_ref()), self.bearing),
        )
    }
}

/// A group as it is written, and where.
pub(crate) struct Group<'a> {
    pub(crate) keys: &'a GroupKeys,
    pub(crate) node: &'a Node,
    pub(crate) index: u64,
}

impl Group<'_> {
    /// What is different about the robot in `place`, counted from 0.
    fn member(&self, place: usize) -> Option<&MemberKeys> {
        let key = self.key(place);
        let members = &self.keys.members.as_ref()?.value;
        members.iter().find(|member| member.name.value == key).map(|member| &member.keys)
    }

    /// Reports that `follower` follows the robot in `place`, where that is absent.
    fn check_present(&self, place: usize, follower: &str, reporter: &mut Reporter) {
        if let Some(absent) =
            self.member(place).filter(|keys| keys.is_absent()).and_then(|keys| keys.absent.as_ref())
        {
            let key = self.key(place);
            let message = format!(
                "`{key}` cannot be absent: `{follower}` follows it; give `{follower}` another `leader`"
            );
            reporter.report(absent.span, message);
        }
    }

    /// Reports members that the group does not have.
    fn check_members(&self, reporter: &mut Reporter) {
        for GroupMember { name, .. } in self.keys.members.iter().flat_map(|members| &members.value) {
            if !makes(self.node, &name.value) {
                let names: Vec<_> = made_by(self.node).take(1000).collect();
                let hint = instead_of(&name.value, names.iter().map(String::as_str));
                let message = format!("this group has no robot called `{}`{hint}", name.value);
                reporter.report(name.span, message);
            }
        }
    }

    /// What the robots of the group are and do, those of which `member` says something else.
    fn outfit(
        &self,
        member: Option<&MemberKeys>,
        defaults: &Defaults,
        reporter: &mut Reporter,
    ) -> Option<Outfit> {
        let nothing = MemberKeys::default();
        let (keys, own) = (self.keys, member.unwrap_or(&nothing));
        let vehicle = self.vehicle(own.vehicle.as_ref(), defaults, reporter)?;
        let law = over(own.law.as_ref(), keys.law.as_ref()?);
        let observer = over(own.observer.as_ref(), keys.observer.as_ref()?);
        let sensing = over(own.sensing.as_ref(), keys.sensing.as_ref()?);
        let narrowing = over(own.narrowing.as_ref(), keys.narrowing.as_ref()?);
        let safety = over(own.safety.as_ref(), keys.safety.as_ref()?);
        let proximity = over(own.proximity.as_ref(), keys.proximity.as_ref()?);
        Some(Outfit {
            vehicle,
            law: defaults.law(&law, vehicle.kind, self.node.span, reporter),
            observer: defaults.observer(&observer, &vehicle),
            sensing: defaults.sensing(&sensing),
            narrowing: defaults.narrowing(&narrowing),
            safety: defaults.safety(&safety),
            proximity: defaults.proximity(&proximity),
        })
    }

    /// The vehicle of a robot of the group that says `own` of it; one of another kind takes nothing from the group's.
    fn vehicle(
        &self,
        own: Option<&Found<VehiclePart>>,
        defaults: &Defaults,
        reporter: &mut Reporter,
    ) -> Option<Vehicle> {
        let (group, span) = (self.keys.vehicle.as_ref()?, self.node.span);
        let Some(own) = own else { return Some(defaults.vehicle(Some(group), span, reporter)) };
        let kind_of = |part: &VehiclePart| part.kind.as_ref().map(|found| found.value);
        let usual = kind_of(&group.value).unwrap_or(usual_kind(&defaults.vehicle));
        let same = kind_of(&own.value).is_none_or(|kind| kind == usual);
        let value = if same { own.value.over(&group.value) } else { own.value.clone() };
        Some(defaults.vehicle(Some(&Found { span: own.span, value }), span, reporter))
    }

    /// Number of places, if the shape and the scene, which has `before` robots already, can take them.
    fn count(&self, before: usize, reporter: &mut Reporter) -> Option<usize> {
        let (shape, count) = (self.keys.shape.as_ref()?.value, self.keys.count.as_ref()?);
        let crowd = || format!("this makes more than {MOST_ROBOTS} robots");
        let fault = shape.refuses(count.value).or_else(|| (before + count.value > MOST_ROBOTS).then(crowd));
        if let Some(fault) = fault {
            reporter.report(count.span, fault);
            return None;
        }
        Some(count.value)
    }

    /// All places; the first is the leader's.
    fn spots(&self, count: usize) -> Option<Vec<GroupSpot>> {
        let keys = self.keys;
        let (shape, follows) = (keys.shape.as_ref()?.value, keys.follows.as_ref()?.value);
        let (spacing, angle) = (keys.distance.as_ref()?.value, keys.angle.as_ref()?.value);
        let mut spots = vec![GroupSpot { at: [0.0; 2], follows: 0, distance: 0.0, bearing: 0.0 }];
        for place in 1..count {
            let step = shape.step(place, count, angle);
            let [x, y] = spots.get(step.leader)?.at;
            let (sin, cos) = math::sin_cos(step.bearing);
            let [x, y] = [x + spacing * cos, y + spacing * sin];
            let (follows, distance, bearing) = match follows {
                Follows::Neighbour => (step.leader, spacing, step.bearing),
                Follows::Leader => (0, math::hypot(x, y), wrap(math::atan2(y, x))),
            };
            spots.push(GroupSpot { at: [x, y], follows, distance, bearing });
        }
        Some(spots)
    }

    /// Name by its place of the robot in `place`, counted from 0.
    fn key(&self, place: usize) -> String {
        format!("{}-{}", self.keys.name.as_ref().map_or("robot", |name| &name.value), place + 1)
    }

    /// What the robot in `place`, counted from 0, is called.
    fn name(&self, place: usize) -> String {
        self.own_name(place).map_or_else(|| self.key(place), |name| name.value.clone())
    }

    /// What the robot in `place`, counted from 0, is called other than by its place.
    fn own_name(&self, place: usize) -> Option<&Found<String>> {
        self.member(place)?.name.as_ref()
    }

    /// Appends the robot in `place`, counted from 0.
    fn push(&self, place: usize, robot: Robot, leader: Option<Found<String>>, drafts: &mut Vec<RobotDraft>) {
        let said = self.own_name(place).or(self.keys.name.as_ref());
        let at = said.map_or(self.node.span, |name| name.span);
        let name = Some(Found { span: at, value: robot.name.clone() });
        // Leaders that the shape gives exist, and the one outside has been looked up; one that is written has not.
        let named = Named { name, leaders: leader.into_iter().collect() };
        drafts.push(RobotDraft { named, start: Some(at), number: None, robot: Some(robot) });
    }

    /// What the group's own leader is, after reporting keys that only followers have.
    fn leading(
        &self,
        name: &str,
        usual: &Outfit,
        defaults: &Defaults,
        reporter: &mut Reporter,
    ) -> Option<Outfit> {
        let Some(keys) = self.member(0) else { return Some(usual.clone()) };
        let shared = ["name", "vehicle", "safety", "proximity"];
        for (key, span) in keys.spans().into_iter().filter(|(key, _)| !shared.contains(key)) {
            reporter.report(span, format!("`{key}` is for robots that follow, but `{name}` leads"));
        }
        self.outfit(Some(keys), defaults, reporter)
    }

    /// Name and start pose of the robot in place 1, which is made if it is the group's own.
    fn leader(
        &self,
        usual: &Outfit,
        defaults: &Defaults,
        drafts: &mut Vec<RobotDraft>,
        reporter: &mut Reporter,
    ) -> Option<(String, Pose)> {
        let keys = self.keys;
        match (self.node.get("path"), self.node.get("leader")) {
            (Some(_), None) => {
                let path = keys.path.as_ref()?;
                let name = self.name(0);
                let Outfit { vehicle, safety, proximity, .. } =
                    self.leading(&name, usual, defaults, reporter)?;
                check_path(path, &vehicle, reporter);
                let origin = Found { span: self.node.span, value: [0.0; 3] };
                let given = keys.pose.as_ref().or(path.value.start().is_none().then_some(&origin));
                let pose = start_pose(given, Some(&path.value), self.node.span, reporter)?;
                let role = Role::Lead { path: path.value.clone() };
                let robot = Robot { name: name.clone(), pose, number: 0, vehicle, safety, proximity, role };
                self.push(0, robot, None, drafts);
                Some((name, pose))
            }
            (None, Some(_)) => {
                if let Some(pose) = self.node.entry("pose") {
                    reporter.report(
                        pose.span,
                        "`pose` is for groups with a `path`; this one starts at its leader",
                    );
                }
                let leader = keys.leader.as_ref()?;
                check_known(&leader.value, leader.span, drafts.iter().map(|draft| &draft.named), reporter);
                let is_leader = |robot: &&Robot| robot.name == leader.value;
                let robot = drafts.iter().filter_map(|draft| draft.robot.as_ref()).find(is_leader)?;
                Some((leader.value.clone(), robot.pose))
            }
            _ => {
                reporter.report(
                    self.node.span,
                    "a group needs either a `path` for its own leader, or a `leader`",
                );
                None
            }
        }
    }
}

/// What a robot says, else what its group says.
fn over<P: Part + Clone>(own: Option<&Found<P>>, group: &Found<P>) -> P {
    own.map_or_else(|| group.value.clone(), |own| own.value.over(&group.value))
}

/// Seeded disorder of start poses.
struct Scatter {
    random: RandomStream,
    /// m along each axis.
    distance: f64,
    /// rad.
    heading: f64,
}

impl Scatter {
    fn new(keys: &GroupKeys, index: u64, seed: u64) -> Option<Self> {
        Some(Self {
            random: RandomStream::new(seed, index),
            distance: keys.scatter.as_ref()?.value,
            heading: keys.scatter_heading.as_ref()?.value,
        })
    }

    /// A pose near [forward, left] in m as seen from `origin`.
    fn around(&mut self, origin: Pose, [forward, left]: [f64; 2]) -> Pose {
        let forward = forward + self.distance * self.random.signed();
        let left = left + self.distance * self.random.signed();
        let [x, y] = origin.world_from_body(forward, left);
        Pose::new(x, y, wrap(origin.heading + self.heading * self.random.signed()))
    }
}
