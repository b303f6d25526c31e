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
mod background;
pub mod exporter;
mod file_watcher;
mod frame_timings;
pub mod gallery;
#[cfg(not(target_family = "wasm"))]
pub mod kept_run;
pub mod keys;
pub mod numbers;
mod options;
mod outlet;
#[cfg(target_family = "wasm")]
mod page;
pub mod panels;
pub mod panes;
pub mod quantities;
pub mod session;
pub mod symbols;
pub mod theme;
pub mod view;
#[cfg(not(target_family = "wasm"))]
mod window;
#[cfg(not(target_family = "wasm"))]
mod window_guard;

pub use options::Options;
#[cfg(target_family = "wasm")]
pub use page::open_on_page;
#[cfg(not(target_family = "wasm"))]
pub use window::open;

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
