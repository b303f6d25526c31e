//! Everything that a run starts from.

use crate::events::EventPlan;
use crate::goals::Goals;
use crate::parameters::ScheduledChange;
use crate::safety::SafetyConfig;
use formation::Formation;
use perception::sensors::SensorConfig;
use std::sync::Arc;
use vocabulary::{FleetInfo, ObserverStart, TimeMode};
use world::{Unicycle, WorldSetup};

/// A run put together, before its first step.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Names, bodies and edges.
    pub fleet: FleetInfo,
    /// Graph, laws, set points, lead motions.
    pub formation: Formation,
    /// Robots, props and ground at the start.
    pub stage: WorldSetup,
    /// Where observers start: added to the first measurement [m, rad], or in its place.
    pub observer_starts: Vec<ObserverStart>,
    /// How followers sense their leaders; `None` where all observe the true state.
    pub sensor_config: Option<Arc<SensorConfig>>,
    /// What is to happen to the formation.
    pub events: Arc<EventPlan>,
    /// Lead robots that go by commands, and the motions that they chase.
    pub chased: Vec<(usize, Unicycle)>,
    /// Lead robots that have goals, and how they get there.
    pub goals: Goals,
    /// What safety filters go by; `None` where no robot senses what is near it.
    pub safety_config: Option<Arc<SafetyConfig>>,
    /// Barriers, per robot; `None` where its filter is off.
    pub filters: Vec<Option<safety::Parameters>>,
    /// How law and observer act in time.
    pub mode: TimeMode,
    /// Whether the run ends where bodies touch.
    pub stop_at_contact: bool,
    /// Control period, s.
    pub period: f64,
    /// Length of the run, s.
    pub duration: f64,
    /// What changes on the way, in the order of time.
    pub changes: Vec<ScheduledChange>,
}
