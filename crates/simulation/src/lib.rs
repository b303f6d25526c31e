//! The loop itself: the only place that knows the order of a step.
//!
//! [`build`] turns a checked scene into a [`Setup`]; [`Simulation`] runs it, one [`StepRecord`](vocabulary::StepRecord) per
//! control sample.

mod batch;
mod build;
mod caption;
mod chase;
mod continuous;
mod drivable;
mod error;
mod events;
mod fault;
mod filing;
mod gates;
mod goals;
mod in_line;
mod parameters;
mod plant;
mod record;
mod safety;
mod sensing;
mod setup;
mod simulation;
mod stage;
mod standstill;
mod step;

pub use batch::BatchError;
pub use build::{build, build_change, edge_law, recorded_plans};
pub use caption::{caption, short};
pub use drivable::Undrivable;
pub use error::BuildError;
pub use events::{EventAction, EventPlan, HandOverRules, Holds, PlannedEvent, Recovery, Trigger};
pub use fault::{Fault, NotFinite};
pub use gates::{Gate, gates, narrowest};
pub use goals::{GoalWish, Goals, PlannedMotion, PlannedPart};
pub use in_line::in_line;
pub use parameters::{ParameterSet, ScheduledChange};
pub use planning::{MotionPlan, PlanPoint, SearchRecord};
pub use safety::SafetyConfig;
pub use setup::Setup;
pub use simulation::Simulation;
pub use standstill::too_slow_leads;
