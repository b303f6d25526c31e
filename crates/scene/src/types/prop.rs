//! Solid things that are no robots.

use super::Path;
use serde::{Serialize, Serializer};
use vocabulary::{Pose, Solid};

/// A solid thing on stage.
#[derive(Debug, Clone, PartialEq)]
pub struct PropSpec {
    /// Unique name, among robots too.
    pub name: String,
    /// Its shape.
    pub solid: Solid,
    /// Of the middle of its foot at the start, [m, m, rad].
    pub pose: Pose,
    /// Of its foot over z = 0 at the start, m.
    pub elevation: f64,
    /// Whether it can move.
    pub motion: PropMotion,
    /// Coefficient of friction of its surface.
    pub friction: f64,
    /// Share of the speed of an impact that it is thrown back with, 0 to 1.
    pub restitution: f64,
}

/// How a prop can move.
#[derive(Debug, Clone, PartialEq)]
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

impl Serialize for PropSpec {
    /// As an entry of `[[props]]`.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct PropEntry<'a> {
            name: &'a str,
            shape: &'a str,
            size: Option<[f64; 3]>,
            radius: Option<f64>,
            height: Option<f64>,
            pose: [f64; 3],
            elevation: f64,
            friction: f64,
            restitution: f64,
            mass: Option<f64>,
            path: Option<&'a Path>,
        }
        let (shape, size, round) = match self.solid {
            Solid::Block { size } => ("block", Some(size), None),
            Solid::Wedge { size } => ("ramp", Some(size), None),
            Solid::Cylinder { radius, height } => ("cylinder", None, Some((radius, height))),
            Solid::Cone { radius, height } => ("cone", None, Some((radius, height))),
        };
        let (mass, path) = match &self.motion {
            PropMotion::Fixed => (None, None),
            PropMotion::Loose { mass } => (Some(*mass), None),
            PropMotion::Guided { path } => (None, Some(path)),
        };
        let entry = PropEntry {
            name: &self.name,
            shape,
            size,
            radius: round.map(|(radius, _)| radius),
            height: round.map(|(_, height)| height),
            pose: [self.pose.x, self.pose.y, self.pose.heading],
            elevation: self.elevation,
            friction: self.friction,
            restitution: self.restitution,
            mass,
            path,
        };
        entry.serialize(serializer)
    }
}
