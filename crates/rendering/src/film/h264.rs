//! H.264 by the built-in encoder. Frames go to a temporary file as they come, so that memory stays flat.

use super::{Format, Sink, mp4};
use crate::Error;
use crate::partial::Partial;
use openh264::encoder::{
    Complexity, Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, RateControlMode, UsageType,
    VuiConfig,
};
use openh264::formats::YUVSlices;
use openh264::{OpenH264API, Timestamp};
use std::fs::File;
use std::io::{BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use vocabulary::Picture;

/// Encoder, frames so far, and where they are.
pub(super) struct H264 {
    encoder: Encoder,
    planes: Planes,
    format: Format,
    samples: BufWriter<File>,
    goal: PathBuf,
    track: mp4::Track,
}

impl H264 {
    pub(super) fn create(path: &Path, format: Format) -> Result<Self, Error> {
        let config = EncoderConfig::new()
            .max_frame_rate(FrameRate::from_hz(format.rate as f32))
            .rate_control_mode(RateControlMode::Off)
            .usage_type(UsageType::CameraVideoRealTime)
            .complexity(Complexity::Low)
            .intra_frame_period(IntraFramePeriod::from_num_frames((2.0 * format.rate).round() as u32))
            // The scene is steady and the quality constant: analysing pictures first would only cost time.
            .scene_change_detect(false)
            .background_detection(false)
            .adaptive_quantization(false)
            .skip_frames(false)
            .num_threads(1)
            .vui(VuiConfig::bt601());
        let encoder =
            Encoder::with_api_config(OpenH264API::from_source(), config).map_err(|e| refused(&e))?;
        // Without a name, so that nothing is left of it however the program ends.
        let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let file = tempfile::tempfile_in(folder).map_err(|e| Error::write(path, e))?;
        let samples = BufWriter::with_capacity(1 << 18, file);
        let planes = Planes::new(format.width as usize, format.height as usize);
        let track = mp4::Track::new(format.width, format.height, format.rate);
        Ok(Self { encoder, planes, format, samples, goal: path.to_owned(), track })
    }
}

fn refused(error: &openh264::Error) -> Error {
    Error::Encode(format!("H.264: {error}"))
}

impl Sink for H264 {
    fn add(&mut self, picture: &Picture) -> Result<(), Error> {
        self.planes.fill(&picture.rgba);
        let millis = self.track.frames() as f64 * 1000.0 / self.format.rate;
        let stream = self
            .encoder
            .encode_at(&self.planes.slices(), Timestamp::from_millis(millis.round() as u64))
            .map_err(|e| refused(&e))?;
        let key = matches!(stream.frame_type(), FrameType::IDR | FrameType::I);
        let frame = self.track.add(&stream.to_vec(), key);
        if frame.is_empty() {
            return Err(Error::Encode("H.264: the encoder skipped a picture".into()));
        }
        self.samples.write_all(&frame).map_err(|e| Error::write(&self.goal, e))
    }

    fn finish(self: Box<Self>) -> Result<(), Error> {
        let Self { samples, goal, track, .. } = *self;
        let failed = |e: std::io::Error| Error::write(&goal, e);
        let mut samples = samples.into_inner().map_err(|e| failed(e.into_error()))?;
        samples.rewind().map_err(failed)?;
        let film = Partial::new(&goal);
        let mut out = BufWriter::new(File::create(&film.path).map_err(failed)?);
        out.write_all(&track.head()).map_err(failed)?;
        std::io::copy(&mut samples, &mut out).map_err(failed)?;
        out.flush().map_err(failed)?;
        film.rename()
    }
}

/// Brightness, and colour at half the size, after BT.601 with video range.
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
                *y = ((66 * r + 129 * g + 25 * b + 128 + (16 << 8)) >> 8) as u8;
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
                *u = ((-38 * r - 74 * g + 112 * b + 128 + (128 << 8)) >> 8) as u8;
                *v = ((112 * r - 94 * g - 18 * b + 128 + (128 << 8)) >> 8) as u8;
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
            [([255, 255, 255], [235, 128, 128]), ([0, 0, 0], [16, 128, 128]), ([255, 0, 0], [82, 90, 240])]
        {
            let mut planes = Planes::new(2, 2);
            planes.fill(&[rgb[0], rgb[1], rgb[2], 255].repeat(4));
            assert_eq!([planes.y[3], planes.u[0], planes.v[0]], yuv);
        }
    }
}
