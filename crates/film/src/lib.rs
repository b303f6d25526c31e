//! Pictures to films and PNG files.
//!
//! ```no_run
//! use film::{Film, FilmKind};
//! # fn filmed(pictures: Vec<vocabulary::Picture>) -> Result<(), film::Error> {
//! let mut film = Film::create("orbit.mp4".as_ref(), FilmKind::Mp4, 1280, 720, 30.0)?;
//! for picture in pictures {
//!     film.push(picture)?;
//! }
//! film.finish()
//! # }
//! ```
//!
//! A [`Film`] encodes on its own thread and keeps memory flat however long it is. An .mp4 that was interrupted can go on
//! where it stopped ([`Film::resume`]), and is the same, byte for byte, in the end. Files take their names when they are
//! complete.
//!
//! On a page there are PNG files alone.

#[cfg(not(target_family = "wasm"))]
mod animation;
mod error;
#[cfg(not(target_family = "wasm"))]
mod ffmpeg;
#[cfg(not(target_family = "wasm"))]
mod film;
mod film_kind;
#[cfg(not(target_family = "wasm"))]
mod frame_sink;
#[cfg(not(target_family = "wasm"))]
mod h264;
#[cfg(not(target_family = "wasm"))]
mod kept_frames;
#[cfg(not(target_family = "wasm"))]
mod mp4;
pub mod png;
#[cfg(not(target_family = "wasm"))]
mod sequence;
#[cfg(not(target_family = "wasm"))]
mod video_format;

pub use error::Error;
#[cfg(not(target_family = "wasm"))]
pub use film::Film;
pub use film_kind::FilmKind;
