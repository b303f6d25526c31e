//! The lab: a window in which set points and gains are tuned while a formation drives.
//!
//! [`open`] shows it. Every command is an [`Action`](action::Action), whether it comes from a panel, a key or
//! the view. The [`AppState`](app_state::AppState) carries it out. The run has a thread of its own ([`session`]), and
//! so have predictions, pictures and films. The window never waits for the run, nor the run for the window: results depend
//! on neither frame rate nor mouse.

pub mod action;
mod app;
pub mod app_state;
pub mod autosave;
pub mod exporter;
mod file_watcher;
mod frame_timings;
pub mod gallery;
pub mod kept_run;
pub mod keys;
pub mod numbers;
pub mod panels;
pub mod panes;
pub mod quantities;
pub mod session;
pub mod symbols;
pub mod theme;
pub mod view;
mod window;
mod window_guard;

pub use window::{Options, open};

/// Why the window ended early.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// There is no window system, no adapter, or it was lost.
    #[error("{0}")]
    Window(String),
    /// The program was terminated from outside.
    #[error("the window is closed; what was not saved is offered at the next start")]
    Interrupted,
}
