//! Raw pictures through a pipe to an ffmpeg of the machine.

use crate::Error;
use crate::frame_sink::FrameSink;
use crate::video_format::VideoFormat;
use output::Draft;
use std::ffi::{OsStr, OsString};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::JoinHandle;
use vocabulary::Picture;

/// The running program.
pub(crate) struct Ffmpeg {
    child: Child,
    /// What it says about failures; read aside, lest a full pipe stop it.
    words: Option<JoinHandle<String>>,
    file: Option<Draft>,
    /// Of the draft and of its goal.
    names: [String; 2],
}

impl Ffmpeg {
    pub(crate) fn create(path: &Path, format: VideoFormat) -> Result<Self, Error> {
        let program = find(std::env::var_os("PATH").as_deref())?;
        // ffmpeg would report an unwritable folder only after the first picture.
        let file = Draft::new(path)?;
        let mut child = Command::new(program)
            .args(arguments(format, file.path()))
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
        let names = [file.path(), path].map(|path| path.display().to_string());
        Ok(Self { child, words, file: Some(file), names })
    }

    fn failure(&mut self) -> Error {
        let words = self.words.take().and_then(|w| w.join().ok()).unwrap_or_default();
        // It knows the draft alone, and a user the goal.
        let [draft, goal] = &self.names;
        Error::Encode(format!("ffmpeg: {}", words.replace(draft, goal).trim()))
    }
}

impl FrameSink for Ffmpeg {
    fn add(&mut self, picture: &Picture) -> Result<(), Error> {
        let written = self.child.stdin.as_mut().map(|pipe| pipe.write_all(&picture.rgba));
        if matches!(written, Some(Ok(()))) { Ok(()) } else { Err(self.failure()) }
    }

    fn finish(mut self: Box<Self>) -> Result<(), Error> {
        // Closing the pipe ends the film.
        self.child.stdin = None;
        let status = self.child.wait().map_err(|e| Error::Encode(format!("ffmpeg: {e}")))?;
        match self.file.take() {
            Some(file) if status.success() => Ok(file.keep()?),
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

/// The program in one of the folders of a search path.
fn find(search: Option<&OsStr>) -> Result<PathBuf, Error> {
    let name = format!("ffmpeg{}", std::env::consts::EXE_SUFFIX);
    let folders = search.into_iter().flat_map(std::env::split_paths).filter(|f| !f.as_os_str().is_empty());
    folders.map(|folder| folder.join(&name)).find(|file| file.is_file()).ok_or(Error::NoFfmpeg)
}

/// Raw pictures on standard input to a film in `file`.
fn arguments(format: VideoFormat, file: &Path) -> Vec<OsString> {
    let size = format!("{}x{}", format.width, format.height);
    let rate = format.rate.to_string();
    let words = ["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba", "-s", &size, "-r", &rate];
    let output = ["-i", "-", "-an", "-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p"];
    // Said as well as done: players guess the colours of a film that does not say them.
    let colours =
        ["-color_primaries", "bt709", "-color_trc", "bt709", "-colorspace", "bt709", "-color_range", "tv"];
    let words = words.into_iter().chain(output).chain(colours).map(OsString::from);
    words.chain([file.as_os_str().to_owned()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_found_where_the_search_path_has_it() {
        let (empty, full) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let program = full.path().join(format!("ffmpeg{}", std::env::consts::EXE_SUFFIX));
        std::fs::write(&program, "").unwrap();
        // A folder of that name is no program.
        std::fs::create_dir(empty.path().join(format!("ffmpeg{}", std::env::consts::EXE_SUFFIX))).unwrap();
        let both = std::env::join_paths([empty.path(), full.path()]).unwrap();
        assert_eq!(find(Some(&both)).ok(), Some(program));
        for search in [None, Some(OsStr::new("")), Some(empty.path().as_os_str())] {
            let error = find(search).unwrap_err();
            assert!(matches!(error, Error::NoFfmpeg) && error.to_string().contains("install"), "{error}");
        }
    }

    #[test]
    fn it_is_told_size_rate_and_file() {
        let words = arguments(VideoFormat { width: 640, height: 360, rate: 29.97 }, Path::new("a film.webm"));
        let after = |name: &str| words.iter().skip_while(|w| *w != name).nth(1).and_then(|w| w.to_str());
        assert_eq!([after("-s"), after("-r"), after("-i")], [Some("640x360"), Some("29.97"), Some("-")]);
        let colours = ["-color_primaries", "-color_trc", "-colorspace", "-color_range"].map(after);
        assert_eq!(colours, [Some("bt709"), Some("bt709"), Some("bt709"), Some("tv")]);
        // One word, spaces and all, and the last.
        assert_eq!(words.last().and_then(|w| w.to_str()), Some("a film.webm"));
    }
}
