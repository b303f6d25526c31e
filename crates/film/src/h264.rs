//! H.264 by the built-in encoder. Frames go to a file as they come, so that memory stays flat.

use crate::Error;
use crate::frame_sink::FrameSink;
use crate::kept_frames::{FilmJournal, KeptFrames};
use crate::mp4::Mp4Track;
use crate::video_format::VideoFormat;
use openh264::encoder::{
    Complexity, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, RateControlMode, UsageType,
    VuiConfig,
};
use openh264::formats::YUVSlices;
use openh264::{OpenH264API, Timestamp};
use output::Draft;
use std::fs::File;
use std::io::{BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use vocabulary::Picture;

/// Encoder, frames so far, and where they are.
pub(crate) struct H264 {
    encoder: Option<Encoder>,
    planes: Planes,
    format: VideoFormat,
    store: Store,
    goal: PathBuf,
    track: Mp4Track,
}

/// Where frames wait for the end of the film.
enum Store {
    /// In a file without a name, so that nothing is left of it however the program ends.
    Hidden(BufWriter<File>),
    /// In files from which a later program can go on.
    Kept(Box<KeptFrames>),
}

/// Seconds of a group of frames: playing can start at each, and so can going on with a film.
const GROUP: f64 = 2.0;

impl H264 {
    pub(crate) fn create(path: &Path, format: VideoFormat) -> Result<Self, Error> {
        let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let file = tempfile::tempfile_in(folder).map_err(|e| Error::write(path, e))?;
        let store = Store::Hidden(BufWriter::with_capacity(1 << 18, file));
        Ok(Self::with(path, format, store, FilmJournal::default()))
    }

    /// Continues a film made from the same source; also returns how many frames there are.
    pub(crate) fn resume(path: &Path, format: VideoFormat, made_of: &str) -> Result<(Self, u64), Error> {
        let VideoFormat { width, height, rate } = format;
        // A film goes on only with the colours that it began with.
        let made_of = format!("{width}x{height} {rate} BT.709 {made_of}");
        let (kept, found) = KeptFrames::open(path, &made_of, group(rate))?;
        let frames = found.sizes.len() as u64;
        Ok((Self::with(path, format, Store::Kept(Box::new(kept)), found), frames))
    }

    fn with(path: &Path, format: VideoFormat, store: Store, found: FilmJournal) -> Self {
        let planes = Planes::new(format.width as usize, format.height as usize);
        let track = Mp4Track::new(format, found);
        Self { encoder: None, planes, format, store, goal: path.to_owned(), track }
    }

    /// Writes the film with the frames so far.
    fn write(&mut self) -> Result<(), Error> {
        let goal = &self.goal;
        let failed = |e: std::io::Error| Error::write(goal, e);
        let mut film = Draft::new(goal)?;
        let mut out = BufWriter::new(film.file());
        out.write_all(&self.track.head()).map_err(failed)?;
        match &mut self.store {
            Store::Hidden(samples) => {
                samples.flush().map_err(failed)?;
                let mut file = samples.get_ref();
                file.rewind().map_err(failed)?;
                std::io::copy(&mut file, &mut out).map_err(failed)?;
            }
            Store::Kept(kept) => {
                std::io::copy(&mut kept.read_all()?, &mut out).map_err(failed)?;
            }
        }
        out.flush().map_err(failed)?;
        drop(out);
        Ok(film.keep()?)
    }
}

/// Frames of a group in a film of `rate` frames a second.
pub(crate) fn group(rate: f64) -> usize {
    (GROUP * rate).round().max(1.0) as usize
}

fn encoder(format: &VideoFormat) -> Result<Encoder, Error> {
    let config = EncoderConfig::new()
        .max_frame_rate(FrameRate::from_hz(format.rate as f32))
        .rate_control_mode(RateControlMode::Off)
        .usage_type(UsageType::CameraVideoRealTime)
        .complexity(Complexity::Low)
        // One group, one encoder.
        .intra_frame_period(IntraFramePeriod::from_num_frames(group(format.rate) as u32))
        // The scene is steady and the quality constant: analysing pictures first would only cost time.
        .scene_change_detect(false)
        .background_detection(false)
        .adaptive_quantization(false)
        .skip_frames(false)
        .num_threads(1)
        .vui(VuiConfig::bt709());
    Encoder::with_api_config(OpenH264API::from_source(), config).map_err(|e| refused(&e))
}

fn refused(error: &openh264::Error) -> Error {
    Error::Encode(format!("H.264: {error}"))
}

impl FrameSink for H264 {
    fn add(&mut self, picture: &Picture) -> Result<(), Error> {
        let number = self.track.journal.sizes.len();
        // The first of a group is encoded as if it were the first of all, so that a film can go on there.
        if number.is_multiple_of(group(self.format.rate)) {
            self.encoder = None;
        }
        let encoder = match &mut self.encoder {
            Some(encoder) => encoder,
            none => none.insert(encoder(&self.format)?),
        };
        self.planes.fill(&picture.rgba);
        let millis = (number % group(self.format.rate)) as f64 * 1000.0 / self.format.rate;
        let stream = encoder
            .encode_at(&self.planes.slices(), Timestamp::from_millis(millis.round() as u64))
            .map_err(|e| refused(&e))?;
        let key = matches!(stream.frame_type(), FrameType::IDR | FrameType::I);
        let frame = self.track.add(&stream.to_vec(), key);
        if frame.is_empty() {
            return Err(Error::Encode("H.264: the encoder skipped a picture".into()));
        }
        match &mut self.store {
            Store::Hidden(samples) => samples.write_all(&frame).map_err(|e| Error::write(&self.goal, e)),
            Store::Kept(kept) => {
                if number == 0 {
                    kept.parameters(&self.track.journal.parameters)?;
                }
                kept.add(&frame, key)?;
                let last = (number + 1).is_multiple_of(group(self.format.rate));
                if last { kept.close_group() } else { Ok(()) }
            }
        }
    }

    fn pause(mut self: Box<Self>) -> Result<(), Error> {
        self.write()
    }

    fn finish(mut self: Box<Self>) -> Result<(), Error> {
        self.write()?;
        if let Store::Kept(kept) = self.store {
            kept.remove();
        }
        Ok(())
    }
}

/// Brightness, and colour at half the size, after BT.709 with video range.
struct Planes {
    width: usize,
    height: usize,
    y: Vec<u8>,
    u: Vec<u8>,
    v: Vec<u8>,
}

impl Planes {
    fn new(width: usize, height: usize) -> Self {
        let quarter = vec![0; width * height / 4];
        Self { width, height, y: vec![0; width * height], u: quarter.clone(), v: quarter }
    }

    fn slices(&self) -> YUVSlices<'_> {
        let half = self.width / 2;
        YUVSlices::new((&self.y, &self.u, &self.v), (self.width, self.height), (self.width, half, half))
    }

    fn fill(&mut self, rgba: &[u8]) {
        let width = self.width;
        for (out, row) in self.y.chunks_exact_mut(width).zip(rgba.chunks_exact(4 * width)) {
            for (y, p) in out.iter_mut().zip(row.chunks_exact(4)) {
                let [r, g, b] = [p[0], p[1], p[2]].map(u32::from);
                // Weights in 1/256 add up to 219/255 of the full range.
                *y = ((47 * r + 157 * g + 16 * b + 128 + (16 << 8)) >> 8) as u8;
            }
        }
        let half = width / 2;
        let colour = self.u.chunks_exact_mut(half).zip(self.v.chunks_exact_mut(half));
        for ((u_row, v_row), rows) in colour.zip(rgba.chunks_exact(8 * width)) {
            let (upper, lower) = rows.split_at(4 * width);
            let blocks = upper.chunks_exact(8).zip(lower.chunks_exact(8));
            for ((u, v), (a, b)) in u_row.iter_mut().zip(v_row).zip(blocks) {
                let mean = |k: usize| {
                    (i32::from(a[k]) + i32::from(a[k + 4]) + i32::from(b[k]) + i32::from(b[k + 4]) + 2) / 4
                };
                let [r, g, b] = [mean(0), mean(1), mean(2)];
                *u = ((-26 * r - 86 * g + 112 * b + 128 + (128 << 8)) >> 8) as u8;
                *v = ((112 * r - 102 * g - 10 * b + 128 + (128 << 8)) >> 8) as u8;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Planes;

    #[test]
    fn colours_have_their_video_levels() {
        for (rgb, yuv) in
            [([255, 255, 255], [235, 128, 128]), ([0, 0, 0], [16, 128, 128]), ([255, 0, 0], [63, 102, 240])]
        {
            let mut planes = Planes::new(2, 2);
            planes.fill(&[rgb[0], rgb[1], rgb[2], 255].repeat(4));
            assert_eq!([planes.y[3], planes.u[0], planes.v[0]], yuv);
        }
    }
}
