//! Robots and their roles.

use super::{Law, Leaders, Narrowing, Observer, Path, Proximity, Safety, Sensing, Vehicle};
use crate::vehicle::written;
use serde::{Serialize, Serializer};
use vocabulary::{Limits, Pose};

/// One robot.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Robot {
    /// Unique name.
    pub name: String,
    /// Where it starts, [m, m, rad].
    #[serde(serialize_with = "pose_as_list")]
    pub pose: Pose,
    /// Number on its shell; unique.
    pub number: usize,
    /// What it is and what it can do.
    #[serde(serialize_with = "written")]
    pub vehicle: Vehicle,
    /// Whether and how its commands are filtered.
    #[serde(skip_serializing_if = "Safety::is_usual")]
    pub safety: Safety,
    /// What it senses near it.
    #[serde(skip_serializing_if = "Proximity::is_usual")]
    pub proximity: Proximity,
    /// Whether it leads or follows.
    #[serde(flatten)]
    pub role: Role,
}

impl Robot {
    /// Bounds on speed, turn rate and acceleration. A follower that stands with its leader has no least speed.
    pub fn limits(&self) -> Limits {
        let limits = self.vehicle.limits();
        let stands = self.role.follow().is_some_and(|follow| follow.law.standing);
        if stands { Limits { speed_min: 0.0, ..limits } } else { limits }
    }
}

/// Whether a robot leads or follows.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Role {
    /// Goes its own way.
    Lead {
        /// Its way.
        path: Path,
    },
    /// Keeps a place relative to another robot.
    Follow(Box<Follow>),
}

impl Role {
    /// How a robot follows; `None` for one that leads.
    pub fn follow(&self) -> Option<&Follow> {
        match self {
            Self::Lead { .. } => None,
            Self::Follow(follow) => Some(follow),
        }
    }
}

/// How a robot follows. Each of its leaders is an edge of the formation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Follow {
    /// Whom it follows, and where it keeps to each.
    #[serde(flatten)]
    pub leaders: Leaders,
    /// Speed at the start, m/s, within the vehicle's limits.
    pub speed: f64,
    /// Control law.
    pub law: Law,
    /// Observer; used by the output-feedback law only.
    pub observer: Observer,
    /// What it knows of its leaders.
    pub sensing: Sensing,
    /// Whether and how it files in where there is no room.
    #[serde(skip_serializing_if = "Narrowing::is_usual")]
    pub narrowing: Narrowing,
}

pub(super) fn pose_as_list<S: Serializer>(pose: &Pose, serializer: S) -> Result<S::Ok, S::Error> {
    [pose.x, pose.y, pose.heading].serialize(serializer)
}
