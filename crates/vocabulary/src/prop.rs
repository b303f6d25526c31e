//! Solid things that are no robots: walls, pillars, ramps, cones, crates.

use crate::math;
use crate::{Pose, words};
use serde::Serialize;

/// The shape of a solid thing. Its frame has its origin in the middle of its foot, z up; all measures in m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "shape", rename_all = "kebab-case")]
pub enum Solid {
    /// Length along x, width along y, height along z.
    Block {
        /// [length, width, height].
        size: [f64; 3],
    },
    /// Upright.
    Cylinder {
        /// Of its foot.
        radius: f64,
        /// From foot to top.
        height: f64,
    },
    /// Upright, its tip on top.
    Cone {
        /// Of its foot.
        radius: f64,
        /// From foot to tip.
        height: f64,
    },
    /// A ramp: from the ground at its −x end it rises evenly to its full height at its +x end.
    #[serde(rename = "ramp")]
    Wedge {
        /// [length, width, height].
        size: [f64; 3],
    },
}

impl Default for Solid {
    fn default() -> Self {
        Self::Block { size: [0.0; 3] }
    }
}

impl Solid {
    /// Length and width of the box around its foot, and its height, m.
    pub fn extent(&self) -> [f64; 3] {
        match *self {
            Self::Block { size } | Self::Wedge { size } => size,
            Self::Cylinder { radius, height } | Self::Cone { radius, height } => {
                [2.0 * radius, 2.0 * radius, height]
            }
        }
    }

    /// Largest distance from its middle axis to its outline, seen from above, m.
    pub fn reach(&self) -> f64 {
        match *self {
            Self::Block { size } | Self::Wedge { size } => 0.5 * math::hypot(size[0], size[1]),
            Self::Cylinder { radius, .. } | Self::Cone { radius, .. } => radius,
        }
    }
}

/// Where a solid thing's frame is in the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Of the middle of its foot, m.
    pub position: [f64; 3],
    /// Unit quaternion [x, y, z, w] that turns its frame into the world's.
    pub rotation: [f64; 4],
}

impl Default for Placement {
    fn default() -> Self {
        Self { position: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0] }
    }
}

impl Placement {
    /// Upright at a pose, its foot `height` m over z = 0.
    pub fn upright(pose: Pose, height: f64) -> Self {
        let (sin, cos) = math::sin_cos(0.5 * pose.heading);
        Self { position: [pose.x, pose.y, height], rotation: [0.0, 0.0, sin, cos] }
    }

    /// Between two placements at `share` (0 to 1), turned the short way.
    pub fn between(a: &Self, b: &Self, share: f64) -> Self {
        let dot: f64 = a.rotation.iter().zip(&b.rotation).map(|(p, q)| p * q).sum();
        let sign = if dot < 0.0 { -1.0 } else { 1.0 };
        let mix = |p: f64, q: f64| p + (q - p) * share;
        let mut rotation = [0, 1, 2, 3].map(|k| mix(a.rotation[k], sign * b.rotation[k]));
        let norm = rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
        for x in &mut rotation {
            *x /= norm;
        }
        Self { position: [0, 1, 2].map(|k| mix(a.position[k], b.position[k])), rotation }
    }
}

words! {
    /// How a prop can move.
    pub enum Mobility = Fixed {
        /// Never.
        Fixed = "fixed",
        /// It can be pushed, and falls.
        Loose = "loose",
        /// It goes its own way and nothing stops it.
        Guided = "guided",
    }
}

/// A solid thing on stage.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Prop {
    /// Unique name, among robots too.
    pub name: String,
    /// Its shape.
    pub solid: Solid,
    /// Where it starts.
    pub placement: Placement,
    /// Whether it can move.
    pub mobility: Mobility,
}
