//! Files and folders that appear under their name only when they are complete.

use crate::Error;
use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::io::Write;
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile, TempDir};

/// Writes `bytes` to `path` so that a reader sees the old file or the new one, never half of it.
///
/// # Errors
/// [`Error::Io`] where the folder is not writable or the disk is full; nothing is left behind then.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let mut draft = Draft::new(path)?;
    draft.file().write_all(bytes).map_err(Error::io("write", path))?;
    draft.keep()
}

/// A file without a name, for what is needed for a while; gone when it is closed, or when the program ends.
///
/// # Errors
/// [`Error::Io`] where the folder for such files is not writable.
pub fn scratch() -> Result<File, Error> {
    tempfile::tempfile().map_err(|e| Error::io("write into", &std::env::temp_dir())(e))
}

/// A file under a name that no other file has; removed unless it is kept.
///
/// What is a link stays one, and its target is replaced. A file that is replaced leaves its mode and owner. What is no file,
/// such as a pipe, takes the bytes as they come once the draft is complete.
#[derive(Debug)]
pub struct Draft {
    file: NamedTempFile,
    goal: PathBuf,
    /// The goal is a pipe or a device.
    special: bool,
}

impl Draft {
    /// Opens a draft of the file `goal`, beside it.
    ///
    /// # Errors
    /// [`Error::Io`] where the folder is not there or not writable.
    pub fn new(goal: &Path) -> Result<Self, Error> {
        let goal = followed(goal);
        let special = goal.exists() && !goal.is_file() && !goal.is_dir();
        let folder = if special { std::env::temp_dir() } else { folder_of(&goal).to_owned() };
        // Programs that are handed the path go by its ending.
        let ending = goal.extension().map_or_else(String::new, |e| format!(".{}", e.to_string_lossy()));
        let (prefix, suffix) = (prefix(&goal), format!(".part{ending}"));
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(&suffix);
        if let Some(mode) = mode(0o666) {
            builder.permissions(mode);
        }
        let file = builder.tempfile_in(folder).map_err(|e| Error::io("write", &goal)(plain(e)))?;
        Ok(Self { file, goal, special })
    }

    /// The file, open for writing.
    pub fn file(&mut self) -> &mut File {
        self.file.as_file_mut()
    }

    /// Where the draft is.
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Where the file will be.
    pub fn goal(&self) -> &Path {
        &self.goal
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// [`Error::Io`] where the disk does not take it; the draft is removed then.
    pub fn keep(self) -> Result<(), Error> {
        let Self { file, goal, special } = self;
        if special {
            let copied = fs::read(file.path()).and_then(|bytes| fs::write(&goal, bytes));
            return copied.map_err(Error::io("write", &goal));
        }
        file.as_file().sync_data().map_err(Error::io("write", &goal))?;
        if let Ok(old) = fs::metadata(&goal) {
            take_over(file.path(), &old);
        }
        file.persist(&goal).map(drop).map_err(|e| Error::io("write", &goal)(e.error))
    }
}

/// A folder under a name that no other has; removed with all that is in it unless it is kept.
#[derive(Debug)]
pub struct DraftFolder {
    folder: TempDir,
    goal: PathBuf,
}

impl DraftFolder {
    /// Makes a draft of the folder `goal`, beside it.
    ///
    /// # Errors
    /// [`Error::Io`] where the folder around it is not there or not writable.
    pub fn new(goal: &Path) -> Result<Self, Error> {
        let goal = followed(goal);
        let prefix = prefix(&goal);
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(".part");
        if let Some(mode) = mode(0o777) {
            builder.permissions(mode);
        }
        let folder = builder.tempdir_in(folder_of(&goal)).map_err(|e| Error::io("write", &goal)(plain(e)))?;
        Ok(Self { folder, goal })
    }

    /// Where the draft is.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Where the folder will be.
    pub fn goal(&self) -> &Path {
        &self.goal
    }

    /// Gives the folder its name; one without anything in it is replaced.
    ///
    /// # Errors
    /// [`Error::Io`] where there is a folder that holds something; the draft is removed then.
    pub fn keep(self) -> Result<(), Error> {
        let Self { folder, goal } = self;
        // Not every system renames onto a folder, though it be empty. A full one stays, and so does a missing one.
        let _ = fs::remove_dir(&goal);
        fs::rename(folder.path(), &goal).map_err(Error::io("write", &goal))?;
        // Nothing is left under that name to be removed.
        let _ = folder.keep();
        Ok(())
    }
}

/// Where links lead from `path`, though nothing be there yet.
pub(crate) fn followed(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    // As many as the system itself follows.
    for _ in 0..40 {
        if let Ok(whole) = fs::canonicalize(&path) {
            return whole;
        }
        // A stream of this process: its link leads to no name.
        if path.exists() {
            break;
        }
        // The file itself, or a folder on the way to it.
        let Some(link) = path.ancestors().find(|part| part.is_symlink() && !part.exists()) else { break };
        let Ok(target) = fs::read_link(link) else { break };
        let goal = folder_of(link).join(target);
        path = match path.strip_prefix(link) {
            Ok(rest) if !rest.as_os_str().is_empty() => goal.join(rest),
            _ => goal,
        };
    }
    path
}

/// The folder that a file stands in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Hidden, and short enough for every file system however long the name is.
fn prefix(goal: &Path) -> String {
    let stem = goal.file_stem().unwrap_or(OsStr::new("output")).to_string_lossy();
    format!(".{}.", stem.chars().take(40).collect::<String>())
}

/// The library names the draft in its errors; a user knows the goal alone.
fn plain(error: std::io::Error) -> std::io::Error {
    match error.to_string().split_once(" at path ") {
        Some((why, _)) => std::io::Error::new(error.kind(), why.to_owned()),
        None => error,
    }
}

#[cfg(unix)]
#[expect(clippy::unnecessary_wraps, reason = "other systems have no modes")]
fn mode(mode: u32) -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    // What the user's mask takes away is taken away by the system.
    Some(Permissions::from_mode(mode))
}

#[cfg(not(unix))]
fn mode(_: u32) -> Option<Permissions> {
    None
}

/// Gives a draft the owner and the mode of the file that it replaces, as far as the user may.
fn take_over(draft: &Path, old: &fs::Metadata) {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt, chown};
        let same = fs::metadata(draft).is_ok_and(|new| new.uid() == old.uid() && new.gid() == old.gid());
        // Only root gives files away; a group of one's own can be kept all the same.
        if !same && chown(draft, Some(old.uid()), Some(old.gid())).is_err() {
            let _ = chown(draft, None, Some(old.gid()));
        }
    }
    // After the owner, since a new owner may take bits away.
    let _ = fs::set_permissions(draft, old.permissions());
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("listed").flatten();
        let mut names: Vec<String> = entries.map(|e| e.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_replaced_and_no_draft_is_left() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.json");
        for text in ["one", "two"] {
            write_whole(&path, text.as_bytes()).expect("written");
            assert_eq!(fs::read_to_string(&path).expect("read"), text);
        }
        assert_eq!(names(folder.path()), ["a.json"]);
    }

    /// `report.tmp` beside `report.xml` is somebody's file.
    #[test]
    fn what_lies_beside_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in ["report.tmp", ".report.tmp", ".report.xml.tmp", ".report.1.part.xml"] {
            fs::write(folder.path().join(name), "mine").expect("written");
        }
        write_whole(&folder.path().join("report.xml"), b"<xml/>").expect("written");
        for name in ["report.tmp", ".report.tmp", ".report.xml.tmp", ".report.1.part.xml"] {
            assert_eq!(fs::read_to_string(folder.path().join(name)).expect("kept"), "mine");
        }
        assert_eq!(names(folder.path()).len(), 5);
    }

    #[test]
    fn drafts_that_are_dropped_leave_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        drop(Draft::new(&folder.path().join("film.mp4")).expect("a draft"));
        let frames = DraftFolder::new(&folder.path().join("frames")).expect("a draft");
        fs::write(frames.path().join("frame.png"), "x").expect("written");
        drop(frames);
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn a_draft_has_the_ending_of_its_file_and_any_length_of_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let long = folder.path().join(format!("{}.webm", "n".repeat(240)));
        let draft = Draft::new(&long).expect("a draft");
        assert_eq!(draft.path().extension(), Some(OsStr::new("webm")));
        draft.keep().expect("kept");
        assert!(long.exists());
    }

    #[test]
    fn a_folder_takes_the_place_of_an_empty_one_only() {
        let folder = tempfile::tempdir().expect("a folder");
        let goal = folder.path().join("frames");
        fs::create_dir(&goal).expect("made");
        let draft = |text: &str| {
            let draft = DraftFolder::new(&goal).expect("a draft");
            fs::write(draft.path().join("a"), text).expect("written");
            draft.keep()
        };
        draft("one").expect("kept");
        draft("two").expect_err("full");
        assert_eq!(fs::read_to_string(goal.join("a")).expect("kept"), "one");
        assert_eq!(names(folder.path()), ["frames"]);
    }

    #[cfg(unix)]
    #[test]
    fn modes_are_kept_and_new_files_have_those_of_the_mask() {
        use std::os::unix::fs::{MetadataExt, PermissionsExt};
        let folder = tempfile::tempdir().expect("a folder");
        let (old, new, plain) =
            (folder.path().join("old"), folder.path().join("new"), folder.path().join("plain"));
        fs::write(&old, "old").expect("written");
        fs::set_permissions(&old, Permissions::from_mode(0o640)).expect("set");
        let owner = |path: &Path| fs::metadata(path).map(|m| (m.uid(), m.gid())).expect("there");
        let before = owner(&old);
        write_whole(&old, b"new").expect("written");
        let mode = |path: &Path| fs::metadata(path).expect("there").permissions().mode() & 0o777;
        assert_eq!((mode(&old), owner(&old)), (0o640, before));
        write_whole(&new, b"new").expect("written");
        fs::write(&plain, "as the system makes it").expect("written");
        assert_eq!(mode(&new), mode(&plain));
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_though_nothing_is_there_yet() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("deep")).expect("made");
        std::os::unix::fs::symlink("deep/a.json", at("b.json")).expect("linked");
        std::os::unix::fs::symlink("b.json", at("c.json")).expect("linked");
        for text in ["first", "second"] {
            write_whole(&at("c.json"), text.as_bytes()).expect("written");
            assert!(at("c.json").is_symlink() && at("b.json").is_symlink());
            assert_eq!(fs::read_to_string(at("deep/a.json")).expect("read"), text);
        }
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_file_takes_the_bytes() {
        write_whole(Path::new("/dev/null"), b"gone").expect("written");
        assert!(!Path::new("/dev/null").is_file());
        if Path::new("/dev/full").exists() {
            let error = write_whole(Path::new("/dev/full"), b"x").expect_err("always full");
            assert!(error.to_string().contains("/dev/full") && error.to_string().contains("No space left"));
        }
    }

    #[test]
    fn a_missing_folder_is_an_error_that_names_the_file_alone() {
        let error = write_whole(Path::new("/nowhere/at/all.json"), b"x").expect_err("no such folder");
        assert!(error.to_string().starts_with("cannot write /nowhere/at/all.json: "), "{error}");
        assert!(!error.to_string().contains(".part"), "{error}");
    }
}
