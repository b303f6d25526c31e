//! Pictures and films of a run: which moments they show, from where, and with what beside them.
//!
//! [`capture`] draws pictures at given times, [`shoot`] makes a film by the storyboard of a scene or a [`Preset`]. A
//! [`Playback`] gives a run at any time, whether it is simulated or was recorded. Whoever waits for them is an [`Audience`]: it
//! hears how far they are, and may stop them.

mod audience;
mod capture;
mod draw_job;
mod error;
mod filming;
mod playback;
mod render_setup;
pub mod times;

pub use audience::Audience;
pub use capture::{CaptureJob, Captured, capture};
pub use draw_job::{DrawJob, PictureOptions, parse_size};
pub use error::Error;
pub use filming::{FilmJob, Filmed, Preset, captions, shoot};
pub use playback::Playback;
pub use render_setup::RenderSetup;
