//! Whom a robot follows, and where it keeps to each.

use serde::ser::{Serialize, SerializeMap, Serializer};
use vocabulary::ScalarTrajectory;

/// A robot that is followed, and where its follower shall be.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Leader {
    /// Its name; the robot exists, and following never comes round in a circle.
    pub name: String,
    /// Wanted distance, m; `None` where it is left free, which it is for robots with several leaders only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<ScalarTrajectory>,
    /// Wanted bearing, rad: direction to the follower seen from the leader's heading, left positive; `None` as with the
    /// distance, never both.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bearing: Option<ScalarTrajectory>,
}

/// The leaders of a robot: one, or several for a law that looks at several.
#[derive(Debug, Clone, PartialEq)]
pub struct Leaders {
    /// The first. Of a single leader both distance and bearing are wanted.
    pub first: Leader,
    /// All others.
    pub also: Vec<Leader>,
}

impl Leaders {
    /// One leader, with a whole place.
    pub fn one(name: String, distance: ScalarTrajectory, bearing: ScalarTrajectory) -> Self {
        Self { first: Leader { name, distance: Some(distance), bearing: Some(bearing) }, also: vec![] }
    }

    /// All of them, in the order of the file.
    pub fn iter(&self) -> impl Iterator<Item = &Leader> {
        std::iter::once(&self.first).chain(&self.also)
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        1 + self.also.len()
    }

    /// Whether there are several.
    pub fn are_several(&self) -> bool {
        !self.also.is_empty()
    }

    /// Whether one of them is called `name`.
    pub fn include(&self, name: &str) -> bool {
        self.iter().any(|leader| leader.name == name)
    }
}

impl Serialize for Leaders {
    /// As a file has it: `leader`, `distance` and `bearing` of one, a list `leaders` of several.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        if self.are_several() {
            map.serialize_entry("leaders", &self.iter().collect::<Vec<_>>())?;
        } else {
            map.serialize_entry("leader", &self.first.name)?;
            map.serialize_entry("distance", &self.first.distance)?;
            map.serialize_entry("bearing", &self.first.bearing)?;
        }
        map.end()
    }
}
