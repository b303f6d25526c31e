//! What must hold for any bytes whatsoever. Each function takes bytes as a fuzzer makes them and panics where something is
//! not as it should be; `scripts/fuzz` runs them by the million, `tests/corpus.rs` on what was found before.

mod law_files;
mod law_modules;
mod links;
mod log;
mod motion;
mod scenes;

pub use law_files::law_file;
pub use law_modules::law_module;
pub use links::links;
pub use log::mcap_log;
pub use motion::way_points;
pub use scenes::{csv_table, overrides, scene_text, storyboard};

/// A target: the name of its corpus, and what is done with bytes.
pub type Target = (&'static str, fn(&[u8]));

/// All targets.
pub const TARGETS: [Target; 9] = [
    ("scene_text", scene_text),
    ("overrides", overrides),
    ("csv_table", csv_table),
    ("mcap_log", mcap_log),
    ("storyboard", storyboard),
    ("way_points", way_points),
    ("links", links),
    ("law_file", law_file),
    ("law_module", law_module),
];
