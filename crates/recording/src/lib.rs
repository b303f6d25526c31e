//! Run folders: what a run leaves behind.
//!
//! ```text
//! manifest.json     what ran, how it ended, the digest of its trajectory
//! scene.toml        the scene with every default written out
//! metrics.json      errors, effort, clearance, contacts, certificates, expectations
//! log.mcap          all of it in one file, for other tools and for redrawing: see [`log`]
//! tables/           robots, edges, contacts and, where any can move, props as .parquet; also .csv where asked for
//! ```
//!
//! Rows reach the disk as the run goes, in parts that are each complete, so a run that is cut short leaves what it
//! had; its manifest then says `running` or `interrupted`, never `complete`.

mod column;
mod columns;
mod error;
pub mod log;
mod manifest;
mod numbers;
mod parquet_file;
mod run;
mod table;

pub use column::{Column, NamedColumn};
pub use error::Error;
pub use manifest::Manifest;
pub use metrics::Status;
pub use numbers::{edge_columns, edge_numbers, robot_columns, robot_numbers};
pub use parquet_file::{ParquetWriter, append_bytes, append_columns, parquet_bytes, read_mark, read_whole};
pub use run::{Finished, Recorder, RunOptions, metrics_text};
pub use table::{TableBuilder, TableKind, read_table};
