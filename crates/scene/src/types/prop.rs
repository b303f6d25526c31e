//! Solid things that are no robots.

use super::{Path, robot::pose_as_list};
use serde::Serialize;
use vocabulary::{Pose, Solid};

/// A solid thing on stage; it is written as an entry of `[[props]]`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PropSpec {
    /// Unique name, among robots too.
    pub name: String,
    /// Its shape.
    #[serde(flatten)]
    pub solid: Solid,
    /// Of the middle of its foot at the start, [m, m, rad].
    #[serde(serialize_with = "pose_as_list")]
    pub pose: Pose,
    /// Of its foot over z = 0 at the start, m.
    pub elevation: f64,
    /// Coefficient of friction of its surface.
    pub friction: f64,
    /// Share of the speed of an impact that it is thrown back with, 0 to 1.
    pub restitution: f64,
    /// Whether plans know of it from the start; otherwise proximity sensors find it.
    pub known: bool,
    /// Whether it can move.
    #[serde(flatten)]
    pub motion: PropMotion,
}

/// How a prop can move.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum PropMotion {
    /// Never.
    Fixed,
    /// It can be pushed, and falls.
    Loose {
        /// kg, above 0.
        mass: f64,
    },
    /// It goes its own way and nothing stops it.
    Guided {
        /// Its way, from its pose on.
        path: Path,
    },
}
