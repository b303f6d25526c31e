//! A film under way: pictures go to an encoder on a thread of its own while the next picture is drawn.

use crate::animation::Animation;
use crate::ffmpeg::Ffmpeg;
use crate::frame_sink::FrameSink;
use crate::h264::{self, H264};
use crate::sequence::Sequence;
use crate::video_format::VideoFormat;
use crate::{Error, FilmKind, kept_frames};
use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use vocabulary::Picture;

enum Message {
    Frame(Picture),
    Pause,
    End,
}

/// A film being written. Dropped before [`Film::finish`], it leaves no file.
#[derive(Debug)]
pub struct Film {
    sender: Option<SyncSender<Message>>,
    thread: Option<JoinHandle<Result<(), Error>>>,
    format: VideoFormat,
    frames: u64,
}

/// Pictures that may wait for the encoder: enough to smooth its pace, few enough to keep memory flat.
const WAITING: usize = 3;

impl Film {
    /// Begins a film of `rate` frames a second; frame k will be shown at k/`rate`.
    ///
    /// # Errors
    /// [`Error::OddSize`], [`Error::Size`] or [`Error::FrameRate`] for what the kind cannot hold,
    /// [`Error::Output`] where the file cannot be written, [`Error::NoFfmpeg`] where that is asked for and absent.
    pub fn create(path: &Path, kind: FilmKind, width: u32, height: u32, rate: f64) -> Result<Self, Error> {
        let format = VideoFormat { width, height, rate };
        format.check(kind)?;
        let sink: Box<dyn FrameSink> = match kind {
            FilmKind::Mp4 => Box::new(H264::create(path, format)?),
            FilmKind::Gif => Box::new(Animation::create(path, format)?),
            FilmKind::PngSequence => Box::new(Sequence::create(path)?),
            FilmKind::Ffmpeg => Box::new(Ffmpeg::create(path, format)?),
        };
        Self::begin(path, format, sink, 0)
    }

    /// Continues an interrupted .mp4 of `rate` frames a second, or begins it; also returns how many frames there are
    /// already. `made_of` is a line that is the same only for the same film.
    ///
    /// # Errors
    /// As [`Film::create`]; [`output::Error::Busy`] where another program is making the film.
    pub fn resume(
        path: &Path,
        width: u32,
        height: u32,
        rate: f64,
        made_of: &str,
    ) -> Result<(Self, u64), Error> {
        let format = VideoFormat { width, height, rate };
        format.check(FilmKind::Mp4)?;
        let (sink, frames) = H264::resume(path, format, made_of)?;
        Ok((Self::begin(path, format, Box::new(sink), frames)?, frames))
    }

    /// How many frames of an interrupted .mp4 of `rate` frames a second are kept at `path` for [`Film::resume`].
    pub fn kept(path: &Path, rate: f64) -> u64 {
        kept_frames::frames(path, h264::group(rate))
    }

    fn begin(path: &Path, format: VideoFormat, sink: Box<dyn FrameSink>, frames: u64) -> Result<Self, Error> {
        let (sender, receiver) = sync_channel(WAITING);
        let thread = std::thread::Builder::new()
            .name("film".into())
            .spawn(move || work(sink, &receiver))
            .map_err(|e| Error::write(path, e))?;
        Ok(Self { sender: Some(sender), thread: Some(thread), format, frames })
    }

    /// Adds the next picture; waits while the encoder is behind.
    ///
    /// # Errors
    /// [`Error::Mismatch`] for a picture of another size, else whatever stopped the encoder.
    pub fn push(&mut self, picture: Picture) -> Result<(), Error> {
        let (want, got) = ((self.format.width, self.format.height), (picture.width, picture.height));
        if want != got || picture.rgba.len() != 4 * want.0 as usize * want.1 as usize {
            return Err(Error::Mismatch { want, got });
        }
        self.send(Message::Frame(picture))?;
        self.frames += 1;
        Ok(())
    }

    /// Frames so far.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Completes the file and gives it its name.
    ///
    /// # Errors
    /// Whatever stopped the encoder, or [`Error::Encode`] for a film without pictures.
    pub fn finish(self) -> Result<(), Error> {
        self.end(Message::End)
    }

    /// Completes the file as far as it is; [`Film::resume`] can go on from there.
    ///
    /// # Errors
    /// As [`Film::finish`].
    pub fn pause(self) -> Result<(), Error> {
        self.end(Message::Pause)
    }

    fn end(mut self, message: Message) -> Result<(), Error> {
        if self.frames == 0 {
            return Err(Error::Encode("a film needs at least one picture".into()));
        }
        self.send(message)?;
        self.join()
    }

    fn send(&mut self, message: Message) -> Result<(), Error> {
        let sent = self.sender.as_ref().is_some_and(|sender| sender.send(message).is_ok());
        // A closed channel means that the encoder has given up: its error is the one to report.
        if sent { Ok(()) } else { self.join().and_then(|()| Err(stopped())) }
    }

    fn join(&mut self) -> Result<(), Error> {
        self.sender = None;
        self.thread
            .take()
            .map_or_else(|| Err(stopped()), |thread| thread.join().unwrap_or_else(|_| Err(stopped())))
    }
}

impl Drop for Film {
    fn drop(&mut self) {
        // The temporary file is gone when this returns. An abandoned film cannot report errors.
        if self.thread.is_some() {
            let _ = self.join();
        }
    }
}

fn stopped() -> Error {
    Error::Encode("the encoder has stopped".into())
}

fn work(mut sink: Box<dyn FrameSink>, receiver: &Receiver<Message>) -> Result<(), Error> {
    loop {
        match receiver.recv() {
            Ok(Message::Frame(picture)) => sink.add(&picture)?,
            Ok(Message::Pause) => return sink.pause(),
            Ok(Message::End) => return sink.finish(),
            // Abandoned: the sink cleans up.
            Err(_) => return Ok(()),
        }
    }
}
