//! Animated GIF, frame by frame, each with a palette of its own.

use crate::Error;
use crate::frame_sink::FrameSink;
use crate::video_format::VideoFormat;
use output::Draft;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use vocabulary::Picture;

/// How coarsely the palette's network samples a picture, 1 to 30: from about 10 on the eye sees no gain.
const SPEED: i32 = 12;

/// The encoder and its file.
pub(crate) struct Animation {
    encoder: gif::Encoder<BufWriter<File>>,
    file: Draft,
    rate: f64,
    count: u32,
}

impl Animation {
    pub(crate) fn create(path: &Path, format: VideoFormat) -> Result<Self, Error> {
        let mut file = Draft::new(path)?;
        let out = BufWriter::new(file.file().try_clone().map_err(|e| Error::write(path, e))?);
        let failed = |e| failed(&file, e);
        let mut encoder =
            gif::Encoder::new(out, format.width as u16, format.height as u16, &[]).map_err(failed)?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(failed)?;
        Ok(Self { encoder, file, rate: format.rate, count: 0 })
    }

    /// When frame `k` begins, in hundredths of a second: rounding the ends keeps the whole film in time.
    fn begins(&self, k: u32) -> u64 {
        (f64::from(k) * 100.0 / self.rate).round() as u64
    }
}

fn failed(file: &Draft, error: gif::EncodingError) -> Error {
    match error {
        gif::EncodingError::Io(source) => Error::write(file.goal(), source),
        other => Error::Encode(other.to_string()),
    }
}

impl FrameSink for Animation {
    fn add(&mut self, picture: &Picture) -> Result<(), Error> {
        let mut rgba = picture.rgba.clone();
        let mut frame =
            gif::Frame::from_rgba_speed(picture.width as u16, picture.height as u16, &mut rgba, SPEED);
        frame.delay = (self.begins(self.count + 1) - self.begins(self.count)) as u16;
        self.count += 1;
        self.encoder.write_frame(&frame).map_err(|e| failed(&self.file, e))
    }

    fn finish(self: Box<Self>) -> Result<(), Error> {
        let Self { encoder, file, .. } = *self;
        let mut out = encoder.into_inner().map_err(|e| failed(&file, e))?;
        out.flush().map_err(|e| Error::write(file.goal(), e))?;
        Ok(file.keep()?)
    }
}
