//! The control core: who follows whom, where they are, and what the laws ask of them.
//!
//! Numeric code here is infallible: it is given checked parameters and returns finite numbers for every input.
//! Only building a [`Graph`] or a curve can fail. Equation numbers are those of Orqueda, Zhang, Fierro:
//! *An output feedback nonlinear decentralized controller for unmanned vehicle co-ordination* (2007).
//!
//! Read in the order of the data: [`graph`], [`relative`], [`set_point`], [`lead`], [`law`], [`observer`], [`tracker`],
//! and [`formation`], which puts them together.

mod agent_action;
pub mod assignment;
pub mod certificate;
pub mod closed_loop;
pub mod column;
mod custom;
pub mod decision;
pub mod edge_law;
mod edge_view;
pub mod energy;
pub mod feasible;
pub mod formation;
pub mod graph;
mod hand_over;
pub mod law;
pub mod lead;
mod matrix_exponential;
mod memory;
pub mod narrowing;
pub mod observer;
mod offset;
pub mod path_heading;
pub mod relative;
pub mod set_point;
mod standing;
pub mod tracker;

pub use agent_action::AgentAction;
pub use custom::{Custom, CustomState};
pub use decision::Decision;
pub use edge_law::EdgeLaw;
pub use formation::{Formation, FormationState};
pub use graph::{Graph, GraphError};
pub use hand_over::{HandOver, HandOverParameters};
pub use law::{Law, LawInput, Switching};
pub use memory::EdgeMemory;
pub use narrowing::Narrowing;
pub use observer::{Estimate, Observer};
pub use path_heading::{Heading, PathHeading};
pub use set_point::SetPointTrajectory;
pub use tracker::{Own, Tracker, TrackerParameters};
pub use vocabulary::PathFilter;
