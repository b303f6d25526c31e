//! Scene files: text to a checked experiment.
//!
//! [`Scene::load`] reads a TOML file, applies overrides, reports everything that is wrong with it at once, and hands
//! out a [`Scene`] in which every default is filled in. Nothing behind that door checks a scene again.

mod diagnostics;
mod load;
mod overrides;
mod types;

pub use diagnostics::{Diagnostic, Diagnostics};
pub use load::{Loaded, schema};
pub use overrides::{Override, OverrideError};
pub use types::*;
