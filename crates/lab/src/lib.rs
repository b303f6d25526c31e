//! The lab: a window in which set points and gains are tuned while a formation drives.
//!
//! [`open`] shows it. What a person asks for is an [`Action`](action::Action), whether it comes from a panel, a key or
//! the view; the [`Desk`](desk::Desk) decides what it means; the run goes on a thread of its own ([`session`]), and so do
//! looks ahead, pictures and films. The window never waits for the run, nor the run for the window: results depend on
//! neither frame rate nor mouse.

pub mod action;
mod app;
pub mod deeds;
pub mod desk;
mod files;
pub mod futures;
pub mod gallery;
pub mod keep;
pub mod kept;
pub mod keys;
pub mod look;
mod lost;
mod over;
pub mod panels;
pub mod panes;
mod past;
pub mod quantities;
mod recorded;
pub mod session;
mod shots;
pub mod studio;
pub mod symbols;
pub mod tidy;
mod timing;
pub mod view;
mod watch;
mod window;

pub use window::{Options, open};

/// Why the window ended before its time.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// There is no window system, no adapter, or it was lost.
    #[error("{0}")]
    Window(String),
    /// The program was told to end.
    #[error("the window is closed; what was not saved is offered at the next start")]
    Interrupted,
}
