//! Raw pictures through a pipe to an ffmpeg of the machine.

use super::{Format, Sink};
use crate::Error;
use crate::partial::Partial;
use std::io::{ErrorKind, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;
use vocabulary::Picture;

/// The running program.
pub(super) struct Ffmpeg {
    child: Child,
    /// What it says about failures; read aside, lest a full pipe stop it.
    words: Option<JoinHandle<String>>,
    file: Option<Partial>,
}

impl Ffmpeg {
    pub(super) fn create(path: &Path, format: Format) -> Result<Self, Error> {
        let file = Partial::new(path);
        // ffmpeg would report an unwritable folder only after the first picture.
        std::fs::File::create(&file.path).map_err(|e| Error::write(path, e))?;
        let size = format!("{}x{}", format.width, format.height);
        let rate = format.rate.to_string();
        let input = ["-f", "rawvideo", "-pix_fmt", "rgba", "-s", &size, "-r", &rate, "-i", "-"];
        let mut child = Command::new("ffmpeg")
            .args(["-y", "-loglevel", "error"])
            .args(input)
            .args(["-an", "-pix_fmt", "yuv420p"])
            .arg(&file.path)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(
                |e| if e.kind() == ErrorKind::NotFound { Error::NoFfmpeg } else { Error::write(path, e) },
            )?;
        let words = child.stderr.take().map(|mut pipe| {
            std::thread::spawn(move || {
                let mut text = String::new();
                // Whatever could be read is worth showing.
                let _ = pipe.read_to_string(&mut text);
                text
            })
        });
        Ok(Self { child, words, file: Some(file) })
    }

    fn failure(&mut self) -> Error {
        let words = self.words.take().and_then(|w| w.join().ok()).unwrap_or_default();
        Error::Encode(format!("ffmpeg: {}", words.trim()))
    }
}

impl Sink for Ffmpeg {
    fn add(&mut self, picture: &Picture) -> Result<(), Error> {
        let written = self.child.stdin.as_mut().map(|pipe| pipe.write_all(&picture.rgba));
        if matches!(written, Some(Ok(()))) { Ok(()) } else { Err(self.failure()) }
    }

    fn finish(mut self: Box<Self>) -> Result<(), Error> {
        // Closing the pipe ends the film.
        self.child.stdin = None;
        let status = self.child.wait().map_err(|e| Error::Encode(format!("ffmpeg: {e}")))?;
        match self.file.take() {
            Some(file) if status.success() => file.rename(),
            _ => Err(self.failure()),
        }
    }
}

impl Drop for Ffmpeg {
    fn drop(&mut self) {
        // After `finish` both do nothing; before, they end an abandoned film.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
