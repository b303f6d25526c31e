//! The words all other crates share: poses, edges, commands, observations, snapshots.
//!
//! Everything is f64 and SI. Frames follow REP-103: x forward, y left, z up, angles counter-clockwise in
//! (−π, π]. Nothing here does input or output, and nothing here knows how a robot moves or is drawn.

mod angle;
mod cast;
mod codes;
pub mod colours;
mod command;
mod contact;
mod edge;
mod eyes;
mod gravity;
mod judging;
mod lens;
mod limits;
mod moment;
mod numeral;
mod observation;
mod passage;
mod picture;
mod pose;
mod profile;
mod prop;
mod rigid;
mod shell;
mod sight;
mod snapshot;
mod terrain;

pub use angle::{nearest_turn, wrap};
pub use cast::{Body, Cast, Light, Member};
pub use command::Command;
pub use contact::{Contact, Thing};
pub use edge::{Edge, Relative, SetPoint};
pub use eyes::{Eyes, Grey, Mount, Shot};
pub use gravity::GRAVITY;
pub use judging::Judging;
pub use lens::{Lens, Region};
pub use limits::Limits;
pub use moment::{EdgeState, Moment};
pub use numeral::{counted, readable};
pub use observation::{EdgeSample, Observation, TRACK_NODES, Track};
pub use passage::Passage;
pub use picture::Picture;
pub use pose::Pose;
pub use profile::{Drive, Profile};
pub use prop::{Mobility, Placement, Prop, Solid};
pub use rigid::Rigid;
pub use shell::{FACE_DIRECTIONS, FACES, Shell, TAG_CELLS, TAGS, tag_cell, tag_code};
pub use sight::{Frame, Outcome, Sight, Sighting};
pub use snapshot::{Attitude, Condition, Motion, RobotState, Snapshot, Wheel};
pub use terrain::{Surface, Terrain};
