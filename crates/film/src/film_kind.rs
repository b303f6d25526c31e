//! In which format a film is stored, and which file name asks for it.

use crate::Error;
use std::path::Path;

/// How a film is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilmKind {
    /// H.264 in an .mp4 by the built-in encoder.
    Mp4,
    /// An animated .gif, for small pictures.
    Gif,
    /// A folder of `frame-00000.png`, `frame-00001.png`, …
    PngSequence,
    /// Through an ffmpeg on PATH, in the format of the file's ending.
    Ffmpeg,
}

impl FilmKind {
    /// The kind that a file's ending asks for: `.mp4`, `.m4v` and `.gif` are built in, those of [`FilmKind::BY_FFMPEG`] go
    /// through ffmpeg, and without an ending it is a folder of pictures. With `ffmpeg`, all endings go through that.
    ///
    /// # Errors
    /// [`Error::Ending`] for any other, for an ending without a name, and with `ffmpeg` for none.
    pub fn of(path: &Path, ffmpeg: bool) -> Result<Self, Error> {
        let low = |text: &std::ffi::OsStr| text.to_string_lossy().to_lowercase();
        let refused = || Error::Ending { path: path.to_owned(), ffmpeg };
        let kind = match path.extension().map(low).as_deref() {
            // `.mp4` alone is a hidden file to the system, and a slip to us.
            None => {
                let name = path.file_name().map(low).unwrap_or_default();
                let known =
                    |ending: &str| Self::BUILT_IN.contains(&ending) || Self::BY_FFMPEG.contains(&ending);
                let slip = name.strip_prefix('.').is_some_and(known);
                return if slip || ffmpeg { Err(refused()) } else { Ok(Self::PngSequence) };
            }
            Some("gif") => Self::Gif,
            Some(ending) if Self::BUILT_IN.contains(&ending) => Self::Mp4,
            Some(ending) if Self::BY_FFMPEG.contains(&ending) => Self::Ffmpeg,
            Some(_) => return Err(refused()),
        };
        Ok(if ffmpeg { Self::Ffmpeg } else { kind })
    }

    /// Endings of films by the built-in encoders.
    pub const BUILT_IN: [&str; 3] = ["mp4", "m4v", "gif"];
    /// Endings of films that go through ffmpeg, which knows by them what to write.
    pub const BY_FFMPEG: [&str; 10] = ["webm", "mkv", "mov", "avi", "mpg", "mpeg", "ogv", "ts", "flv", "wmv"];
}
