//! The keys of a scene file, as they are written.

use crate::text::words::word;
use crate::{
    Path,
    events::EventKeys,
    ground::{GroundForm, GroundKeys},
    groups::{GroupMember, MembersForm},
    names::{NameForm, POSE},
    path_form::PATH,
    patterns::{PatternForm, PatternKeys},
    prop_form::{MOST_PROPS, PropForm, PropKeys},
    text::{Flag, Text, angle_within, form::Number, integer, keys, list, number, table},
    types::{
        BearingForm, DistanceForm, EnvironmentPart, ExpectPart, FilmPart, HandOverPart, LawPart,
        NarrowingPart, ObserverPart, PhysicsPart, ProximityPart, SafetyPart, SensingForm, SensingPart,
        TimePart, VehiclePart, ViewsPart, VisionPart,
    },
    vehicle::VehicleForm,
};
use laws::LEADERS_MAX;
use std::f64::consts::{FRAC_PI_2, PI};
use vocabulary::{ScalarTrajectory, words};

/// Version of the format of scene files.
pub(crate) const SCHEMA_VERSION: u64 = 1;
/// Most robots of a scene.
pub(crate) const MOST_ROBOTS: usize = 10_000;
/// Most changes of a run.
pub(crate) const MOST_CHANGES: usize = 10_000;
/// Most events of a run.
pub(crate) const MOST_EVENTS: usize = 1000;
/// Speed at the start.
const SPEED: Number = number("m/s").from(0.0).up_to(100.0);

keys! {
    /// A scene of Echelon: one experiment with a formation of vehicles. SI units; angles in rad, or as text such as
    /// "135 deg".
    struct Document {
        /// Version of this format.
        schema: u64 = integer::<u64>(SCHEMA_VERSION, SCHEMA_VERSION), required;
        /// Title shown in pictures and reports.
        title: String = Text(200), required;
        /// What the experiment is about.
        description: String = Text(10_000), or(String::new());
        /// Seed of everything random.
        seed: u64 = integer::<u64>(0, i64::MAX as u64), or(1);
        /// Length, control period and mode of the run.
        time: TimePart = table::<TimePart>(), part;
        /// How vehicles with wheels and props that move are carried through time.
        physics: PhysicsPart = table::<PhysicsPart>(), part;
        /// Kind, limits and measures of every robot that says nothing else: a kind alone, or a table.
        vehicle: VehiclePart = VehicleForm, part, Live;
        /// Control law of every follower that says nothing else.
        law: LawPart = table::<LawPart>(), part, Live;
        /// Observer of every follower that says nothing else.
        observer: ObserverPart = table::<ObserverPart>(), part, Live;
        /// What every follower that says nothing else knows of its leader: a kind alone, or a table.
        sensing: SensingPart = SensingForm, part;
        /// How every follower that says nothing else files in where there is no room.
        narrowing: NarrowingPart = table::<NarrowingPart>(), part, Live;
        /// Safety filter of every robot that says nothing else.
        safety: SafetyPart = table::<SafetyPart>(), part, Live;
        /// What every robot that says nothing else senses near it.
        proximity: ProximityPart = table::<ProximityPart>(), part;
        /// Cameras and shells of all robots.
        vision: VisionPart = table::<VisionPart>(), part;
        /// The lie of the land and its grip; flat if left out.
        ground: GroundKeys = GroundForm, optional, Apart;
        /// Robots one by one.
        robots: Vec<RobotKeys> = list(table::<RobotKeys>(), 0, MOST_ROBOTS), part, Live;
        /// Robots in well-known shapes.
        groups: Vec<GroupKeys> = list(table::<GroupKeys>(), 0, 1000), part, Live;
        /// Solid things that are no robots: walls, pillars, ramps, cones, crates.
        props: Vec<PropKeys> = list(PropForm, 0, MOST_PROPS), part, Apart;
        /// Props in well-known arrangements.
        patterns: Vec<PatternKeys> = list(PatternForm, 0, 200), part, Apart;
        /// What changes while the run goes.
        changes: Vec<ChangeKeys> = list(table::<ChangeKeys>(), 0, MOST_CHANGES), part, Apart;
        /// What happens to the formation while the run goes: robots change their leader, fail, join and part.
        events: Vec<EventKeys> = list(table::<EventKeys>(), 0, MOST_EVENTS), part, Apart;
        /// How robots change their leader.
        hand_over: HandOverPart = table::<HandOverPart>(), part, Apart;
        /// Light and air.
        environment: EnvironmentPart = table::<EnvironmentPart>(), part, Apart;
        /// How pictures look at the run.
        views: ViewsPart = table::<ViewsPart>(), part, Apart;
        /// How a film is made when the command line does not say.
        film: FilmPart = table::<FilmPart>(), part, Apart;
        /// What the run has to show.
        expect: ExpectPart = table::<ExpectPart>(), part, Apart;
    }
}

keys! {
    /// One of several leaders of a robot, and where the robot keeps to it. One of `distance` and `bearing` may be left out;
    /// it is free then.
    struct LeaderKeys {
        /// Name of the robot that is followed.
        name: String = NameForm::WHOLE, required;
        /// Wanted distance from it, m: a number, a sinusoid, or smooth passages.
        distance: ScalarTrajectory = DistanceForm, optional, Live;
        /// Wanted bearing, seen from its heading, left positive: an angle, a sinusoid, or smooth passages.
        bearing: ScalarTrajectory = BearingForm, optional, Live;
    }
}

keys! {
    /// A robot: one that leads has a `path`, one that follows has a `leader`, a `distance` and a `bearing`, or `leaders`.
    struct RobotKeys {
        /// Unique name.
        name: String = NameForm::WHOLE, required;
        /// Where it starts: [x in m, y in m, heading]; may be left out with way-points, which say it.
        pose: [f64; 3] = POSE, optional;
        /// Motion of a robot that leads.
        path: Path = PATH, optional, Live;
        /// Name of the robot that is followed.
        leader: String = NameForm::WHOLE, optional;
        /// Robots that are followed by a law that looks at several, in its order.
        leaders: Vec<LeaderKeys> = list(table::<LeaderKeys>(), 2, LEADERS_MAX), optional, Live;
        /// Wanted distance from the leader, m: a number, a sinusoid, or smooth passages.
        distance: ScalarTrajectory = DistanceForm, optional, Live;
        /// Wanted bearing, seen from the leader's heading, left positive: an angle, a sinusoid, or smooth passages.
        bearing: ScalarTrajectory = BearingForm, optional, Live;
        /// Speed of a follower at the start, m/s; its `speed_min` if left out.
        speed: f64 = SPEED, optional;
        /// What differs from the scene's `vehicle`.
        vehicle: VehiclePart = VehicleForm, optional, Live;
        /// What differs from the scene's `law`.
        law: LawPart = table::<LawPart>(), optional, Live;
        /// What differs from the scene's `observer`.
        observer: ObserverPart = table::<ObserverPart>(), optional, Live;
        /// What differs from the scene's `sensing`.
        sensing: SensingPart = SensingForm, optional;
        /// What differs from the scene's `narrowing`.
        narrowing: NarrowingPart = table::<NarrowingPart>(), optional, Live;
        /// What differs from the scene's `safety`.
        safety: SafetyPart = table::<SafetyPart>(), optional, Live;
        /// What differs from the scene's `proximity`.
        proximity: ProximityPart = table::<ProximityPart>(), optional;
        /// Number on its shell, unique: its tags are 5·number to 5·number + 4; the lowest that is free if left out.
        number: usize = integer::<usize>(0, MOST_ROBOTS as u64), optional;
    }
}

keys! {
    /// A group of robots in a well-known shape. Place 1 is its leader's: a robot of the group with a `path`, or the
    /// robot named by `leader`. The robot in place n is called `name-n`; odd and even places take turns between the
    /// wings, right first.
    struct GroupKeys {
        /// Shape of the group.
        shape: Shape = word::<Shape>(), required;
        /// Number of places, the leader's included.
        count: usize = integer::<usize>(2, MOST_ROBOTS as u64), required;
        /// Start of the robots' names.
        name: String = NameForm::START, or("robot".to_owned());
        /// Motion of the group's leader; or give `leader`.
        path: Path = PATH, optional, Live;
        /// Name of a robot outside the group that leads it; or give `path`.
        leader: String = NameForm::WHOLE, optional;
        /// Where the group's leader starts, with a `path`: [x in m, y in m, heading]; the origin, or the path's
        /// first way-point, if left out.
        pose: [f64; 3] = POSE, optional;
        /// Distance between neighbours, m.
        distance: f64 = number("m").above(0.0).up_to(1000.0), or(2.0), Live;
        /// Whom the robots follow.
        follows: Follows = word::<Follows>(), or(Follows::Neighbour);
        /// Bearing of a neighbour in shapes `v` and `diamond`.
        angle: f64 = angle_within(FRAC_PI_2, PI), or(0.75 * PI), Live;
        /// Followers start at most this far from their places along each axis, m, by the scene's seed; 0 starts in
        /// formation.
        scatter: f64 = number("m").from(0.0).up_to(1000.0), or(0.3);
        /// Headings start at most this far from the leader's.
        scatter_heading: f64 = angle_within(0.0, PI), or(10f64.to_radians());
        /// Speed of the followers at the start, m/s; their `speed_min` if left out.
        speed: f64 = SPEED, optional;
        /// What differs from the scene's `vehicle`.
        vehicle: VehiclePart = VehicleForm, part, Live;
        /// What differs from the scene's `law`.
        law: LawPart = table::<LawPart>(), part, Live;
        /// What differs from the scene's `observer`.
        observer: ObserverPart = table::<ObserverPart>(), part, Live;
        /// What differs from the scene's `sensing`.
        sensing: SensingPart = SensingForm, part;
        /// What differs from the scene's `narrowing`.
        narrowing: NarrowingPart = table::<NarrowingPart>(), part, Live;
        /// What differs from the scene's `safety`.
        safety: SafetyPart = table::<SafetyPart>(), part, Live;
        /// What differs from the scene's `proximity`.
        proximity: ProximityPart = table::<ProximityPart>(), part;
        /// Robots of the group that differ from the others, by their names.
        members: Vec<GroupMember> = MembersForm, part, Live;
    }
}

keys! {
    /// What is different about one robot of a group. Where it starts, and how fast, is up to the group.
    struct MemberKeys {
        /// What the robot is called, in place of the name that it has by its place.
        name: String = NameForm::WHOLE, optional;
        /// Whether its place stays empty; who follows that place needs a `leader` of its own then.
        absent: bool = Flag, optional;
        /// Name of the robot that it follows, in place of the shape's.
        leader: String = NameForm::WHOLE, optional;
        /// Wanted distance from the robot it follows, m, in place of the shape's.
        distance: ScalarTrajectory = DistanceForm, optional, Live;
        /// Wanted bearing, in place of the shape's.
        bearing: ScalarTrajectory = BearingForm, optional, Live;
        /// What differs from the group's `vehicle`.
        vehicle: VehiclePart = VehicleForm, optional, Live;
        /// What differs from the group's `law`.
        law: LawPart = table::<LawPart>(), optional, Live;
        /// What differs from the group's `observer`.
        observer: ObserverPart = table::<ObserverPart>(), optional, Live;
        /// What differs from the group's `sensing`.
        sensing: SensingPart = SensingForm, optional;
        /// What differs from the group's `narrowing`.
        narrowing: NarrowingPart = table::<NarrowingPart>(), optional, Live;
        /// What differs from the group's `safety`.
        safety: SafetyPart = table::<SafetyPart>(), optional, Live;
        /// What differs from the group's `proximity`.
        proximity: ProximityPart = table::<ProximityPart>(), optional;
    }
}

keys! {
    /// Something that is set anew while the run goes: set points, laws, observers and limits.
    struct ChangeKeys {
        /// It holds from the first control sample at or after this on, s.
        at: f64 = number("s").from(0.0).up_to(1e5), required;
        /// What is set, as after `--set`, on top of what earlier changes have set: "robots.follower-1.distance=1.5".
        set: Vec<String> = list(Text(10_000), 0, 10_000), required;
    }
}

words! {
    /// Shape of a group.
    pub(crate) enum Shape {
        /// Two wings behind the leader, each robot following the one before it on its wing.
        V = "v",
        /// One behind the other.
        Column = "column",
        /// Side by side, two wings beside the leader.
        Abreast = "abreast",
        /// The sides of a square on its corner, the leader in front; a multiple of four places.
        Diamond = "diamond",
        /// A circle with equal distances between neighbours, the leader in front.
        Circle = "circle",
    }
}

words! {
    /// Whom the robots of a group follow.
    pub(crate) enum Follows {
        /// The one before them on their wing: each keeps its place by what is next to it, and passes on its own errors,
        /// enlarged from robot to robot.
        Neighbour = "neighbour",
        /// The group's leader, every one of them.
        Leader = "leader",
    }
}
