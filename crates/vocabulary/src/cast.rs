//! Who is on stage: everything about a run that does not change while it runs and that a picture needs.

use crate::Edge;

/// Outer measures of a robot's body, for drawing and clearance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Bumper to bumper, m.
    pub length: f64,
    /// m.
    pub width: f64,
    /// Between the axles, m.
    pub wheelbase: f64,
    /// Between the wheels of an axle, m.
    pub track: f64,
    /// m.
    pub wheel_radius: f64,
}

impl Default for Body {
    /// The 1/10 class vehicle of the pictures: 0.42 m long.
    fn default() -> Self {
        Self { length: 0.42, width: 0.24, wheelbase: 0.27, track: 0.20, wheel_radius: 0.045 }
    }
}

/// One robot on stage.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Unique name.
    pub name: String,
    /// Whether it follows nobody.
    pub leads: bool,
    /// Outer measures.
    pub body: Body,
}

/// Robots, edges and words of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cast {
    /// Title of the scene.
    pub title: String,
    /// Law and gains in one line.
    pub caption: String,
    /// Length of the run, s.
    pub duration: f64,
    /// In the order of the snapshots.
    pub members: Vec<Member>,
    /// In the order of the edge states.
    pub edges: Vec<Edge>,
}
