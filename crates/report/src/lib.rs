//! Figures of runs, with claims that are checked.
//!
//! [`paper_runs`] names the runs behind the figures of Orqueda, Zhang and Fierro (2007), [`scene_runs`] those behind the
//! same figures of any scene. Whoever runs them hands every moment to a [`Tracer`]; of the [`Trace`]s that come out,
//! [`paper`] and [`of_scene`] make a [`Report`]: figures (SVG), tables (CSV) and [`FigureClaim`]s with measured values and a
//! verdict. [`Rasterizer`] turns figures into PNG and PDF, [`page`] binds all of it into one file. Pictures and films are drawn elsewhere and come
//! in as bytes; nothing here reads a clock or writes a file.

mod claim;
mod draw;
mod effort;
mod figure;
mod laws;
mod page;
mod paper;
mod picture;
mod planned_run;
mod rasterizer;
mod scene_set;
mod tables;
mod trace;
mod variant;
mod words;

pub use claim::{
    ClaimSubject, ClaimValue, Compared, FigureClaim, faster_observers_cost, faster_observers_err_less,
    knowing_less_costs, knowing_less_errs,
};
pub use effort::CommandEffort;
pub use figure::{Report, ReportFigure, ReportFilm, ReportTable};
pub use page::page;
pub use paper::paper;
pub use picture::{ReportPicture, add_picture};
pub use planned_run::{Case, FinishedRun, PlannedRun, find, paper_runs, scene_runs};
pub use rasterizer::{Rasterizer, RasterizerError};
pub use scene_set::of_scene;
pub use trace::{EdgeRow, Trace, Tracer};
pub use variant::Variant;
