//! What can go wrong while drawing, told apart by who can mend it: the user's words or the machine.

use crate::FilmKind;
use std::path::{Path, PathBuf};

/// Everything this crate can fail with.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No graphics adapter fits.
    #[error(
        "no graphics adapter{}; {found}. A software one comes with `apt-get install mesa-vulkan-drivers` (Debian, Ubuntu)",
        .wanted.as_ref().map_or(String::new(), |w| format!(" matches {w:?}"))
    )]
    NoAdapter {
        /// What was asked for by name, if anything.
        wanted: Option<String>,
        /// What the machine has.
        found: String,
    },
    /// The graphics device refused or was lost.
    #[error("the graphics device failed: {0}")]
    Device(String),
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
    /// Another program writes the same film.
    #[error("another program is making {} just now; wait for it, or choose another file with -o", .0.display())]
    Busy(PathBuf),
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
    /// A view that does not exist.
    #[error("unknown view {given:?}{}; views are {valid}, and several joined by '+'", .nearest.as_ref().map_or(String::new(), |n| format!(" (did you mean {n:?}?)")))]
    View {
        /// What was asked for.
        given: String,
        /// The valid name nearest to it.
        nearest: Option<String>,
        /// All valid forms.
        valid: String,
    },
    /// More views than a picture is split into.
    #[error("{0} views are too many for one picture: join at most four")]
    TooManyViews(usize),
    /// An element of the picture that does not exist.
    #[error("unknown element {given:?}{}; elements are {valid}", .nearest.as_ref().map_or(String::new(), |n| format!(" (did you mean {n:?}?)")))]
    Element {
        /// What was asked for.
        given: String,
        /// The valid name nearest to it.
        nearest: Option<String>,
        /// All valid names.
        valid: String,
    },
    /// A picture size that cannot be drawn.
    #[error("a picture of {width}×{height} cannot be drawn: width and height must be 16 to {most} pixels")]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Largest side this adapter draws.
        most: u32,
    },
    /// Samples per pixel that adapters do not offer.
    #[error("{0} samples a pixel are not offered: use 4, or 1 for speed")]
    Samples(u32),
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
    /// A moment whose robots or edges are not those of the cast.
    #[error("the moment has {got} {what}, the cast {want}")]
    FleetInfo {
        /// Robots or edges.
        what: &'static str,
        /// In the moment.
        got: usize,
        /// In the cast.
        want: usize,
    },
}

impl Error {
    /// Whether other words on the command line would mend it; otherwise the machine is to blame.
    pub fn is_usage(&self) -> bool {
        if let Self::Output(error) = self {
            return error.is_usage();
        }
        matches!(
            self,
            Self::View { .. }
                | Self::Busy(_)
                | Self::Ending { .. }
                | Self::TooManyViews(_)
                | Self::Element { .. }
                | Self::Size { .. }
                | Self::Samples(_)
                | Self::OddSize { .. }
                | Self::FrameRate(_)
                | Self::GifRate(_)
                | Self::Mismatch { .. }
                | Self::FleetInfo { .. }
        )
    }

    pub(crate) fn write(path: &Path, source: std::io::Error) -> Self {
        output::Error::io("write", path)(source).into()
    }

    pub(crate) fn read(path: &Path, source: std::io::Error) -> Self {
        Self::Read { path: path.to_owned(), source }
    }
}

/// The name among `valid` nearest to `given`, if one is near enough to be meant.
pub(crate) fn nearest<'a>(given: &str, valid: impl IntoIterator<Item = &'a str>) -> Option<String> {
    valid
        .into_iter()
        .map(|name| (strsim::jaro_winkler(given, name), name))
        .filter(|(score, _)| *score > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name.to_owned())
}
