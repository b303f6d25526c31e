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

mod animation;
mod error;
mod ffmpeg;
mod film;
mod film_kind;
mod frame_sink;
mod h264;
mod kept_frames;
mod mp4;
pub mod png;
mod sequence;
mod video_format;

pub use error::Error;
pub use film::Film;
pub use film_kind::FilmKind;
