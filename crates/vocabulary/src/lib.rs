//! The words all other crates share: poses, edges, commands, observations, snapshots.
//!
//! Everything is f64 and SI. Frames follow REP-103: x forward, y left, z up, angles counter-clockwise in
//! (−π, π]. Nothing here does input or output, and nothing here knows how a robot moves or is drawn.

mod angle;
mod camera;
mod camera_model;
mod codes;
pub mod colours;
mod command;
mod contact;
mod edge;
mod event;
mod fleet;
mod gravity;
mod judging;
mod law;
mod law_state;
mod limits;
pub mod math;
mod measurement;
mod numeral;
mod observation;
mod path_filter;
mod picture;
mod planned_path;
mod pose;
mod prop;
mod rigid;
mod round_step;
mod safety;
mod scalar_trajectory;
mod shell;
mod snapshot;
mod step_interpolant;
mod step_record;
mod terrain;
mod trajectory;
mod words;

#[doc(hidden)]
pub use serde;

pub use angle::{nearest_turn, wrap};
pub use camera::{CameraMount, CameraRenderer, Grey, Shot};
pub use camera_model::{CameraModel, Region};
pub use command::Command;
pub use contact::{Contact, EntityId};
pub use edge::{Edge, Relative, SetPoint};
pub use event::{EventKind, EventRecord, Refusal, TourGoal};
pub use fleet::{Body, FleetInfo, Light, RobotInfo};
pub use gravity::GRAVITY;
pub use judging::Judging;
pub use law::{HeadingReference, LawKind, MotionPhase, ObserverKind, ObserverStart, TimeMode};
pub use law_state::{LawQuantity, LawState};
pub use limits::Limits;
pub use measurement::{Measurement, MeasurementRecord, Outcome, TrackingState};
pub use numeral::{counted, readable};
pub use observation::{EdgeSample, Observation, TRACK_NODES, Track};
pub use path_filter::PathFilter;
pub use picture::Picture;
pub use planned_path::{PlannedPath, PlannedPoint};
pub use pose::Pose;
pub use prop::{Mobility, Placement, Prop, Solid};
pub use rigid::Rigid;
pub use round_step::round_step;
pub use safety::{BarrierState, Constraint, SafetyState};
pub use scalar_trajectory::{Ramp, ScalarTrajectory};
pub use shell::{FACE_DIRECTIONS, FACES, Shell, TAG_CELLS, TAGS, tag_cell, tag_code};
pub use snapshot::{Attitude, Condition, Motion, RobotState, Snapshot, Wheel};
pub use step_interpolant::StepInterpolant;
pub use step_record::{EdgeState, StepRecord};
pub use terrain::{Surface, Terrain};
pub use trajectory::{MotionInput, Trajectory};
pub use words::Word;
