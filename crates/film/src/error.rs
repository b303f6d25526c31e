//! Errors of writing films and pictures: those of the user's input, and those of the machine.

use crate::FilmKind;
use std::path::{Path, PathBuf};

/// Everything this crate can fail with.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] output::Error),
    /// A file could not be read, or is no picture.
    #[error("cannot read {}: {source}", .path.display())]
    Read {
        /// Where.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// An encoder refused a picture.
    #[error("encoding failed: {0}")]
    Encode(String),
    /// An ending that no film has.
    #[error(
        "{} is no name of a film: write NAME.mp4, .m4v or .gif, {}one of {} through ffmpeg",
        .path.display(),
        if *.ffmpeg { "or " } else { "NAME alone for a folder of PNG frames, or " },
        FilmKind::BY_FFMPEG.map(|ending| format!(".{ending}")).join(", ")
    )]
    Ending {
        /// What was named.
        path: PathBuf,
        /// Whether ffmpeg was asked for, which makes no folders.
        ffmpeg: bool,
    },
    /// ffmpeg was asked for and is not there.
    #[error(
        "ffmpeg was not found on PATH; install it (`apt-get install ffmpeg`) or write an .mp4 with the built-in encoder"
    )]
    NoFfmpeg,
    /// A picture size that no film holds.
    #[error("a picture of {width}×{height} cannot be drawn: width and height must be 16 to {most} pixels")]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Largest side of a film.
        most: u32,
    },
    /// H.264 halves the colour planes, so both sides must be even.
    #[error("an H.264 film needs even width and height, not {width}×{height}: use {}×{}", .width & !1, .height & !1)]
    OddSize {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// A frame rate outside what films can hold.
    #[error("{0} frames a second is out of range: use 1 to 240")]
    FrameRate(f64),
    /// A frame rate that browsers would show at a fifth of it.
    #[error(
        "{0} frames a second are too many for a .gif, which browsers then show far too slowly: use at most 50, or an .mp4"
    )]
    GifRate(f64),
    /// A picture that does not fit its film or file.
    #[error("a picture of {got:?} pixels does not fit {want:?}")]
    Mismatch {
        /// Width and height expected.
        want: (u32, u32),
        /// Width and height given.
        got: (u32, u32),
    },
}

impl Error {
    /// Whether the user's input is at fault; otherwise the machine is.
    pub fn is_usage(&self) -> bool {
        match self {
            Self::Output(error) => error.is_usage(),
            Self::Read { .. } | Self::Encode(_) | Self::NoFfmpeg => false,
            _ => true,
        }
    }

    pub(crate) fn write(path: &Path, source: std::io::Error) -> Self {
        output::Error::io("write", path)(source).into()
    }

    pub(crate) fn read(path: &Path, source: std::io::Error) -> Self {
        Self::Read { path: path.to_owned(), source }
    }
}
