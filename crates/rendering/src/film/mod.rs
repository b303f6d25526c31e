//! Pictures to films, encoded on a thread of their own while the next picture is drawn.

mod animation;
mod ffmpeg;
mod h264;
mod kept;
mod mp4;
mod sequence;

use crate::Error;
use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use vocabulary::Picture;

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

/// A film's measures.
#[derive(Debug, Clone, Copy)]
struct Format {
    width: u32,
    height: u32,
    /// Frames a second.
    rate: f64,
}

/// Takes pictures in order; dropped before `finish`, it leaves nothing behind.
trait Sink: Send {
    fn add(&mut self, picture: &Picture) -> Result<(), Error>;
    fn finish(self: Box<Self>) -> Result<(), Error>;
    /// As `finish`, but a later program may go on, where that can be.
    fn pause(self: Box<Self>) -> Result<(), Error> {
        self.finish()
    }
}

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
    format: Format,
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
        let format = Format { width, height, rate };
        check(kind, &format)?;
        let sink: Box<dyn Sink> = match kind {
            FilmKind::Mp4 => Box::new(h264::H264::create(path, format)?),
            FilmKind::Gif => Box::new(animation::Animation::create(path, format)?),
            FilmKind::PngSequence => Box::new(sequence::Sequence::create(path)?),
            FilmKind::Ffmpeg => Box::new(ffmpeg::Ffmpeg::create(path, format)?),
        };
        Self::begin(path, format, sink, 0)
    }

    /// Goes on with an .mp4 of `rate` frames a second that was interrupted, or begins it; and how many frames there are
    /// already. `made_of` is a line that is the same only for the same film.
    ///
    /// # Errors
    /// As [`Film::create`]; [`Error::Busy`] where another program is making the film.
    pub fn resume(
        path: &Path,
        (width, height): (u32, u32),
        rate: f64,
        made_of: &str,
    ) -> Result<(Self, u64), Error> {
        let format = Format { width, height, rate };
        check(FilmKind::Mp4, &format)?;
        let (sink, frames) = h264::H264::resume(path, format, made_of)?;
        Ok((Self::begin(path, format, Box::new(sink), frames)?, frames))
    }

    /// How many frames of an interrupted .mp4 of `rate` frames a second are kept at `path` for [`Film::resume`].
    pub fn kept(path: &Path, rate: f64) -> u64 {
        kept::frames(path, h264::group(rate))
    }

    fn begin(path: &Path, format: Format, sink: Box<dyn Sink>, frames: u64) -> Result<Self, Error> {
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
        // The temporary file is gone when this returns. An abandoned film has nobody to report errors to.
        if self.thread.is_some() {
            let _ = self.join();
        }
    }
}

fn stopped() -> Error {
    Error::Encode("the encoder has stopped".into())
}

fn work(mut sink: Box<dyn Sink>, receiver: &Receiver<Message>) -> Result<(), Error> {
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

/// A .gif counts in hundredths of a second, and what is shown for less than two of them browsers show for ten.
const FASTEST_GIF: f64 = 50.0;

fn check(kind: FilmKind, format: &Format) -> Result<(), Error> {
    let &Format { width, height, rate } = format;
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
