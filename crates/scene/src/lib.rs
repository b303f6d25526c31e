//! Scene files: text to a checked experiment.
//!
//! [`Scene::load`] reads a TOML file, applies overrides, reports everything that is wrong with it at once, and hands
//! out a [`Scene`] in which every default is filled in. Nothing behind that door checks a scene again.
//!
//! text → tree with places (`text::node`) → overrides → keys (`document`) → robots (`robots`, `groups`), ground and props
//! (`ground`, `props`) → everything held against everything (`resolve`) → what changes as the run goes (`changes`) →
//! [`Scene`].

mod changes;
mod diagnostics;
mod document;
mod edit;
mod events;
mod files;
mod graph;
mod ground;
mod groups;
mod heights_file;
mod law_file;
mod leaders;
mod link;
mod load;
mod names;
mod narrowing;
mod outline;
mod overrides;
mod packed;
mod path_form;
mod patterns;
mod prop_form;
mod props;
mod random;
mod relief;
mod resolve;
mod robots;
mod safety;
mod sets;
mod shape;
mod shipped;
mod sight;
mod start;
mod study;
mod table_file;
mod text;
mod types;
mod units;
mod unused;
mod vehicle;

pub use diagnostics::{Diagnostic, Diagnostics};
pub use edit::{ChangeText, EditError, SceneText, toml_text};
pub use law_file::{LAW_CHOICE, load_law};
pub use link::{Link, LinkError, LinkOrigin, LinkProof, LinkedScene, TimedOverride};
pub use load::{Loaded, schema};
pub use overrides::{Override, OverrideError};
pub use shipped::{SHIPPED, Shipped, nearest_shipped, scene_name, shipped};
pub use study::{
    Distribution, FollowerScatter, MOST_RUNS, Sampling, Study, StudyFault, StudyParameter, ValueScale,
    Values, ValuesError, WrittenNumber, value_text,
};
pub use text::node::composed;
pub use types::{
    Change, Compensation, Environment, Event, Expect, Failure, Film, Follow, Goal, Ground, HandOver,
    Happening, Holds, Joining, Law, LawSource, Leader, Leaders, Narrowing, Noise, Observer, OnContact, Patch,
    Path, Physics, Place, Plot, PropMotion, PropSpec, Proximity, Recovery, Relief, Robot, Role, Safety,
    Scene, Sensing, SensingKind, Shot, SpeedProfile, SwitchingKind, Time, Travel, Trigger, Vehicle,
    VehicleKind, Views, Vision, When, WrittenLaw,
};
pub use units::unit;
