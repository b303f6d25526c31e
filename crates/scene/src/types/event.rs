//! What happens to the formation while a run goes: robots change their leader, fail, join and part.

use super::{Law, Narrowing, Observer, Path, Sensing};
use crate::text::{Couple, Optional, angle_within, number, settings};
use serde::Serialize;
use std::f64::consts::PI;
use vocabulary::{ScalarTrajectory, words};

/// An event: once its trigger holds, it happens, or is refused with a reason and the run goes on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Event {
    /// When.
    #[serde(flatten)]
    pub trigger: Trigger,
    /// What.
    #[serde(flatten)]
    pub happening: Happening,
}

/// When an event happens.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Trigger {
    /// At a time.
    At {
        /// The first control sample at or after this, s.
        at: f64,
    },
    /// Once something holds.
    When {
        /// What.
        when: When,
    },
}

/// What has to hold of a robot for an event to happen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct When {
    /// Name of the robot.
    pub robot: String,
    /// What has to hold.
    #[serde(flatten)]
    pub holds: Holds,
}

/// What has to hold for an event to happen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Holds {
    /// The robot has come near a place.
    Reaches {
        /// [x, y], m.
        reaches: [f64; 2],
        /// Distance from it, m.
        within: f64,
    },
    /// Something is nearer than that.
    ClearanceBelow {
        /// Between the circle around its body and what is nearest, m.
        clearance_below: f64,
    },
    /// It has lost sight of its leader.
    LostFor {
        /// For that long, s.
        lost_for: f64,
    },
    /// It stands while its leader drives.
    BlockedFor {
        /// For that long, s.
        blocked_for: f64,
    },
}

/// What happens to a robot.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Happening {
    /// It follows another robot from now on.
    Follow {
        /// Name of the robot.
        robot: String,
        /// Name of the robot that it follows.
        leader: String,
        /// Its place, m and rad; the one that it has at that moment where there is none.
        #[serde(flatten)]
        place: Option<Place>,
        /// How it follows, where it does not follow from the start.
        #[serde(flatten)]
        joins: Option<Box<Joining>>,
    },
    /// It follows nobody from now on and drives on its own.
    Lead {
        /// Name of the robot.
        robot: String,
        /// Its way, from where it is at that moment.
        path: Path,
    },
    /// It fails.
    Fail {
        /// Name of the robot.
        robot: String,
        /// How.
        fails: Failure,
        /// What becomes of those who follow it.
        recovery: Recovery,
    },
    /// Those who follow a robot, directly or through others, take the places that are there anew, so that they go the least
    /// way.
    Assign {
        /// Name of the robot.
        assign: String,
    },
}

/// A place behind a leader.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Place {
    /// m.
    pub distance: ScalarTrajectory,
    /// rad.
    pub bearing: ScalarTrajectory,
}

/// How a robot follows that leads at the start.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Joining {
    /// Control law.
    pub law: Law,
    /// Its observer.
    pub observer: Observer,
    /// What it knows of its leader.
    pub sensing: Sensing,
    /// Whether and how it files in where there is no room.
    #[serde(skip_serializing_if = "Narrowing::is_usual")]
    pub narrowing: Narrowing,
}

words! {
    /// How a robot fails.
    pub enum Failure {
        /// It brakes to a stand, and stays there.
        Stop = "stop",
        /// It rolls to a stand, and stays there.
        Coast = "coast",
        /// It is not there any more.
        Remove = "remove",
    }
}

words! {
    /// What becomes of those who follow a robot that fails. Where that cannot be, the next is tried.
    pub enum Recovery = Graft {
        /// They follow its leader, and keep their places.
        Graft = "graft",
        /// The nearest of them takes its place, the nearest of whose followers takes that one's, and so on.
        Promote = "promote",
        /// All robots of the formation take the places that are left, so that they go the least way.
        Assign = "assign",
        /// They wait.
        Wait = "wait",
    }
}

settings! {
    /// How robots change their leader, and what is asked of the new one.
    #[derive(Copy)]
    pub struct HandOver from HandOverPart {
        /// The place of a robot that has changed its leader moves no faster than this towards its new one, m/s.
        pub speed: f64 = 0.4, number("m/s").above(0.0).up_to(100.0);
        /// And no more suddenly than this, m/s².
        pub acceleration: f64 = 0.5, number("m/s²").above(0.0).up_to(100.0);
        /// Time constant with which the difference between its command before and after fades, s.
        pub fade: f64 = 0.5, number("s").from(0.001).up_to(100.0);
        /// [nearest, farthest] that a place may be from its leader, m; the leader itself may be half as far again.
        pub distance: [f64; 2] = [0.5, 4.1], Couple(number("m").from(0.0), number("m").above(0.0));
        /// Farthest that the leader may be off straight ahead, seen from the place.
        pub bearing_max: f64 = 105.0 * PI / 180.0, angle_within(0.0, PI);
        /// How often a robot that waits tries to follow again, s.
        pub retry: f64 = 1.0, number("s").above(0.0).up_to(1e5);
        /// How long it waits before it stays where it is, s.
        pub patience: f64 = 10.0, number("s").from(0.0).up_to(1e5);
        /// How long a follower may be held up, standing while the robot that it follows drives, before it stays where it is and
        /// those behind it follow on without it, s; for ever if left out.
        pub held_up: Option<f64> = None, Optional(number("s").above(0.0).up_to(1e5));
    }
}

impl Event {
    /// The lines of its table in a scene file, without their head.
    pub fn to_lines(&self) -> String {
        // What has been read from TOML can be written as TOML.
        let table = toml::Table::try_from(self).unwrap_or_default();
        table.iter().map(|(key, value)| format!("{key} = {value}\n")).collect::<Vec<_>>().concat()
    }

    /// What shall happen, in a few words.
    pub fn words(&self) -> String {
        match &self.happening {
            Happening::Follow { robot, leader, .. } => format!("{robot} follows {leader}"),
            Happening::Lead { robot, .. } => format!("{robot} drives on its own"),
            Happening::Fail { robot, fails, .. } => match fails {
                Failure::Stop => format!("{robot} fails and stops"),
                Failure::Coast => format!("{robot} fails and rolls to a stand"),
                Failure::Remove => format!("{robot} is taken away"),
            },
            Happening::Assign { assign } => format!("those behind {assign} take their places anew"),
        }
    }
}

impl Happening {
    /// Names of the robots that it is about, and the keys that name them.
    pub fn robots(&self) -> Vec<(&'static str, &str)> {
        match self {
            Self::Follow { robot, leader, .. } => vec![("robot", robot), ("leader", leader)],
            Self::Lead { robot, .. } | Self::Fail { robot, .. } => vec![("robot", robot)],
            Self::Assign { assign } => vec![("assign", assign)],
        }
    }
}

impl HandOver {
    pub(crate) fn is_usual(&self) -> bool {
        *self == Self::default()
    }
}
