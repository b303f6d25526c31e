//! Plans for whole formations: where to go instead of how.
//!
//! A [`Map`] has convex ground and convex obstacles. A [`FormationModel`] has the bodies of all robots and their places at every
//! level, from the shape to the column. [`plan`] finds a way for the lead on which all robots that hold their places stay clear:
//!
//! ```text
//! search    hybrid A* over x, y, heading, level                 search.rs, primitive.rs, heuristic.rs, shot.rs
//! trailing  where followers are, by the law's own equations     trailing.rs
//! smooth    less steering, within all limits                    smooth.rs, sensitivity.rs
//! speed     forwards and backwards over the way                 speed.rs
//! timing    other speeds, or a wait, where something moves       timing.rs, meeting.rs, moving.rs
//! offer     why there is no way, and for whom there is one      offer.rs, gap.rs
//! ```
//!
//! Everything is f64 and SI, x forward, y left, angles counter-clockwise. Nothing reads a clock: effort is counted in steps that
//! are swept, and the same request gives the same plan to the last bit on every machine.

mod convex;
mod dense;
mod dubins;
mod error;
mod field;
mod formation_model;
mod frame;
mod gap;
mod heuristic;
mod leg;
mod limits;
mod map;
mod meeting;
mod mission;
mod moving;
mod offer;
mod plan;
mod planner;
mod primitive;
mod reeds_shepp;
mod rrt;
mod search;
mod search_record;
mod sensitivity;
mod shot;
mod smooth;
mod speed;
mod timing;
mod trailing;
pub mod trial;

pub use convex::{Convex, Nearest};
pub use dubins::{DubinsPath, dubins_paths, shortest_dubins};
pub use error::InputError;
pub use formation_model::{BodyShape, FollowerModel, FormationModel, SteadyRobot};
pub use gap::Gap;
pub use leg::{CurvatureKnot, Leg};
pub use limits::TravelLimits;
pub use map::{Boundary, Map};
pub use meeting::{Meeting, Schedule, first_meeting};
pub use mission::{CostWeights, Mission, PlanGoal, PlanRequest, PlanStart, SearchEffort};
pub use moving::{MovingThing, TrackPoint};
pub use offer::{NoWay, NoWayReason, Offer};
pub use plan::{MotionPlan, PlanPoint};
pub use planner::{PlanError, TourError, plan, plan_tour};
pub use reeds_shepp::{ReedsSheppPart, ReedsSheppPath, shortest_reeds_shepp};
pub use rrt::{RrtEffort, rrt_star};
pub use search_record::SearchRecord;
pub use timing::{Unavoidable, WAITS_MOST, plan_among, timed_among};
