//! Figures of runs, and whether they show what they are said to show.
//!
//! [`paper_jobs`] names the runs behind the figures of Orqueda, Zhang and Fierro (2007), [`scene_jobs`] those behind the
//! same figures of any scene. Whoever runs them hands every moment to a [`Tracer`]; of the [`Trace`]s that come out,
//! [`paper`] and [`of_scene`] make a [`Report`]: sheets (SVG), tables (CSV) and [`Claim`]s with measured values and a
//! verdict. [`Rasterizer`] prints sheets, [`page`] binds all of it into one file. Pictures and films are drawn elsewhere and come
//! in as bytes; nothing here reads a clock or writes a file.

mod claim;
mod draw;
mod effort;
mod item;
mod job;
mod laws;
mod page;
mod paper;
mod picture;
mod rasterizer;
mod scene_set;
mod tables;
mod trace;
mod variant;
mod words;

pub use claim::{
    Claim, Compared, Value, faster_observers_cost, faster_observers_err_less, knowing_less_costs,
    knowing_less_errs,
};
pub use effort::Effort;
pub use item::{Film, Item, Report, Table};
pub use job::{Case, Job, Ran, find, paper_jobs, scene_jobs};
pub use page::page;
pub use paper::paper;
pub use picture::{Shot, add_picture};
pub use rasterizer::{PressError, Rasterizer};
pub use scene_set::of_scene;
pub use trace::{EdgeRow, Trace, Tracer};
pub use variant::Variant;
