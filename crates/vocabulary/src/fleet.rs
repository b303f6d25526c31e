//! Who is on stage: everything about a run that does not change while it runs and that a picture needs.

use crate::{CameraModel, CameraMount, Edge, EntityId, Prop, Shell, Surface, Terrain, math};
use std::sync::Arc;

/// Outer measures of a robot's body, for drawing and clearance.
///
/// A robot's pose is the ground point under the middle of its rear axle; the body reaches as far beyond the rear axle
/// as it does beyond the front one, so its middle lies half a wheelbase ahead of the pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Bumper to bumper, m.
    pub length: f64,
    /// m.
    pub width: f64,
    /// Ground to roof, m.
    pub height: f64,
    /// Between the axles, m.
    pub wheelbase: f64,
    /// Between the wheels of an axle, m.
    pub track: f64,
    /// m.
    pub wheel_radius: f64,
}

impl Body {
    /// Of the circle around its outline, m; its middle is that of the body, half a wheelbase ahead of the pose.
    pub fn radius(&self) -> f64 {
        0.5 * math::hypot(self.length, self.width)
    }
}

impl Default for Body {
    /// The 1/10 class vehicle of the pictures: 0.42 m long.
    fn default() -> Self {
        Self { length: 0.42, width: 0.24, height: 0.22, wheelbase: 0.27, track: 0.20, wheel_radius: 0.045 }
    }
}

/// One robot on stage.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RobotInfo {
    /// Unique name.
    pub name: String,
    /// Whether it follows nobody.
    pub leads: bool,
    /// Outer measures.
    pub body: Body,
    /// What its followers recognise it by; `None` for a robot that carries nothing.
    pub shell: Option<Shell>,
    /// Where its camera sits.
    pub camera_mount: CameraMount,
    /// What its camera sees.
    pub camera_model: CameraModel,
}

impl RobotInfo {
    /// A robot with the shell and camera that fit its body, the shell blank.
    pub fn new(name: impl Into<String>, leads: bool, body: Body) -> Self {
        let (shell, camera_model) = (Some(Shell::fitting(&body)), CameraModel::default());
        Self {
            name: name.into(),
            leads,
            body,
            shell,
            camera_mount: CameraMount::fitting(&body),
            camera_model,
        }
    }
}

/// Sun and air, for pictures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Height of the sun over the horizon, rad in (0, π/2].
    pub sun_elevation: f64,
    /// Direction to the sun, rad from the world's x axis, counter-clockwise.
    pub sun_azimuth: f64,
    /// Distance at which haze sets in, m; positive.
    pub haze_from: f64,
}

impl Default for Light {
    /// An afternoon sun over the left shoulder of a robot that heads along x, and clear air.
    fn default() -> Self {
        Self { sun_elevation: 38_f64.to_radians(), sun_azimuth: 118_f64.to_radians(), haze_from: 30.0 }
    }
}

/// Robots, edges, surroundings and words of a run.
#[derive(Debug, Clone, PartialEq, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a table and a topic of its own")]
pub struct FleetInfo {
    /// Title of the scene.
    pub title: String,
    /// Law and gains in one line.
    pub caption: String,
    /// Length of the run, s.
    pub duration: f64,
    /// Sun and air.
    pub light: Light,
    /// In the order of the snapshots.
    pub robots: Vec<RobotInfo>,
    /// In the order of the edge states. A robot with several leaders has several edges, one after the other.
    pub edges: Vec<Edge>,
    /// Whether [distance, bearing] of each edge are left free: nothing is wanted of them. Empty where all are wanted.
    pub free: Vec<[bool; 2]>,
    /// Whether any follower measures with a sensor instead of knowing the truth.
    pub has_sensors: bool,
    /// Whether any robot's commands may pass through a safety filter.
    pub has_safety: bool,
    /// Whether any follower may have a custom law.
    pub has_laws: bool,
    /// Whether robots may change leaders, fail or join while the run goes.
    pub has_events: bool,
    /// Whether any lead robot has goals, to which ways are planned.
    pub has_plans: bool,
    /// Solid things that are no robots, in the order of the snapshots.
    pub props: Vec<Prop>,
    /// The lie of the land; flat at z = 0 where there is none.
    pub terrain: Option<Arc<Terrain>>,
}

impl FleetInfo {
    /// Whether [distance, bearing] of edge number `index` are left free.
    pub fn free(&self, index: usize) -> [bool; 2] {
        self.free.get(index).copied().unwrap_or_default()
    }

    /// Numbers of the edges by which `robot` follows at the start, or may follow later.
    pub fn edges_of(&self, robot: usize) -> impl Iterator<Item = usize> {
        let own = self.edges.iter().enumerate().filter(move |(_, edge)| edge.follower == robot);
        own.map(|(index, _)| index)
    }

    /// Whether `robot` follows several robots at once.
    pub fn has_several_leaders(&self, robot: usize) -> bool {
        self.edges_of(robot).nth(1).is_some()
    }

    /// Whether each robot follows several robots at once.
    pub fn several_leaders(&self) -> Vec<bool> {
        let mut counts = vec![0_usize; self.robots.len()];
        for edge in &self.edges {
            counts.get_mut(edge.follower).into_iter().for_each(|count| *count += 1);
        }
        counts.into_iter().map(|count| count > 1).collect()
    }

    /// Names of the leader and the follower of an edge.
    pub fn pair(&self, edge: Edge) -> [&str; 2] {
        [edge.leader, edge.follower].map(|robot| self.name(EntityId::Robot(robot)))
    }

    /// Name of a robot or prop; "ground", or empty for an index out of range.
    pub fn name(&self, thing: EntityId) -> &str {
        match thing {
            EntityId::Robot(index) => self.robots.get(index).map_or("", |member| &member.name),
            EntityId::Prop(index) => self.props.get(index).map_or("", |prop| &prop.name),
            EntityId::Ground => "ground",
        }
    }

    /// The ground under (x, y), m; props do not count.
    pub fn surface(&self, x: f64, y: f64) -> Surface {
        self.terrain.as_ref().map_or(Surface::FLAT, |terrain| terrain.at(x, y))
    }
}
