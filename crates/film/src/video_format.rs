//! Size and rate of a film, and what each kind of film can hold of them.

use crate::{Error, FilmKind};

/// Size and rate of a film.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VideoFormat {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Frames a second.
    pub(crate) rate: f64,
}

/// A .gif counts in hundredths of a second, and what is shown for less than two of them browsers show for ten.
const FASTEST_GIF: f64 = 50.0;

impl VideoFormat {
    /// Refuses what a film of `kind` cannot hold.
    pub(crate) fn check(self, kind: FilmKind) -> Result<(), Error> {
        let Self { width, height, rate } = self;
        let most = 8192;
        let fine = |side: u32| (16..=most).contains(&side);
        if !fine(width) || !fine(height) {
            return Err(Error::Size { width, height, most });
        }
        if !(1.0..=240.0).contains(&rate) {
            return Err(Error::FrameRate(rate));
        }
        if kind == FilmKind::Gif && rate > FASTEST_GIF {
            return Err(Error::GifRate(rate));
        }
        let halved = matches!(kind, FilmKind::Mp4 | FilmKind::Ffmpeg);
        if halved && (width % 2 == 1 || height % 2 == 1) {
            return Err(Error::OddSize { width, height });
        }
        Ok(())
    }
}
