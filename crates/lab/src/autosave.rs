//! Saves unsaved work automatically and offers it after a crash.

use std::fs;
use std::path::{Path, PathBuf};

/// The file in which this window saves its work.
#[derive(Debug)]
pub struct Autosave {
    file: Option<PathBuf>,
    written: String,
}

/// Unsaved work of a window that is gone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecoverableWork {
    /// The file that holds it.
    pub file: PathBuf,
    /// The file of its scene, if it has one.
    pub path: Option<PathBuf>,
    /// Names the scene: its file, or the name of what it began as.
    pub home: PathBuf,
    /// The text.
    pub text: String,
}

/// Prefix of the first line of an autosave: the file of its scene follows.
const HEAD: &str = "# unsaved work on ";
/// Stands before the name of a scene that has no file.
const COPY: &str = "a copy of ";

impl Autosave {
    /// Saves work in `folder`; `None` if there is no such folder.
    pub fn new(folder: Option<&Path>) -> Self {
        Self::at(folder.map(|folder| folder.join(format!("work-{}.toml", std::process::id()))))
    }

    /// Saves work in this file, if there is one.
    pub(crate) fn at(file: Option<PathBuf>) -> Self {
        Self { file, written: String::new() }
    }

    /// Writes the text of a scene if it has changed; `path` is the scene's file, `home` names it where it has none.
    ///
    /// # Errors
    /// Why it cannot be written.
    pub fn keep(&mut self, text: &str, path: Option<&Path>, home: &Path) -> Result<(), String> {
        let Some(file) = &self.file else { return Ok(()) };
        if text == self.written {
            return Ok(());
        }
        text.clone_into(&mut self.written);
        let place =
            path.map_or_else(|| format!("{COPY}{}", home.display()), |path| path.display().to_string());
        put(file, &format!("{HEAD}{place}\n{text}"))
            .map_err(|why| format!("unsaved work cannot be kept: {why}"))
    }

    /// Removes the autosave: nothing is unsaved any more.
    pub fn done(&mut self) {
        if !self.written.is_empty() {
            self.written.clear();
            if let Some(file) = &self.file {
                discard(file);
            }
        }
    }
}

/// Writes an autosave.
#[cfg(not(target_family = "wasm"))]
fn put(file: &Path, text: &str) -> Result<(), String> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    crate::outlet::write(file, text.as_bytes())
}

/// Removes an autosave.
#[cfg(not(target_family = "wasm"))]
pub(crate) fn discard(file: &Path) {
    // It may not exist.
    let _ = fs::remove_file(file);
}

#[cfg(target_family = "wasm")]
pub(crate) use crate::page::{discard, put};

/// The newest work in `folder` of a window that is gone; `alive` tells whether a process is running.
pub fn left(folder: &Path, alive: impl Fn(u32) -> bool) -> Option<RecoverableWork> {
    let files = fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path());
    let orphaned = files.filter(|file| {
        let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let number = name.strip_prefix("work-").and_then(|rest| rest.strip_suffix(".toml"));
        number.and_then(|number| number.parse().ok()).is_some_and(|process| !alive(process))
    });
    let newest = orphaned.max_by_key(|file| fs::metadata(file).and_then(|meta| meta.modified()).ok())?;
    let text = fs::read_to_string(&newest).ok()?;
    work_of(newest, &text)
}

/// The work in the text of an autosave.
pub(crate) fn work_of(file: PathBuf, text: &str) -> Option<RecoverableWork> {
    let (head, text) = text.split_once('\n')?;
    let place = head.strip_prefix(HEAD)?.trim();
    let (path, home) = match place.strip_prefix(COPY) {
        Some(home) => (None, PathBuf::from(home)),
        // Versions before this one named only files.
        None if place.is_empty() => (None, PathBuf::from("scene.toml")),
        None => (Some(PathBuf::from(place)), PathBuf::from(place)),
    };
    Some(RecoverableWork { file, path, home, text: text.to_owned() })
}

/// Whether a process is running, as far as the system tells.
pub fn alive(process: u32) -> bool {
    // A zombie process has ended.
    let state = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    let dead = state
        .rsplit(')')
        .next()
        .is_none_or(|rest| rest.trim().is_empty() || rest.trim().starts_with(['Z', 'X']));
    process == std::process::id() || !dead
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_is_kept_until_it_is_done_and_found_when_its_window_is_gone() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut kept = Autosave::new(Some(folder.path()));
        let path = Path::new("scenes/a.toml");
        kept.keep("schema = 1\n", Some(path), path).expect("kept");
        assert_eq!(left(folder.path(), |_| true), None);
        let found = left(folder.path(), |_| false).expect("left");
        assert_eq!((found.text.as_str(), found.path), ("schema = 1\n", Some(PathBuf::from("scenes/a.toml"))));
        kept.keep("schema = 2\n", None, Path::new("circle-three.toml")).expect("kept");
        let found = left(folder.path(), |_| false).expect("left");
        assert_eq!((found.path, found.home), (None, PathBuf::from("circle-three.toml")));
        kept.done();
        assert_eq!(left(folder.path(), |_| false), None);
    }
}
