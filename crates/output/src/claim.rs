//! One folder, one program that fills it.

use crate::Error;
use crate::draft::followed;
use crate::place::{named, no_file};
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

/// A folder that nobody else may fill; given up when it is dropped, or when the program ends, however it ends.
#[derive(Debug)]
pub struct Claim {
    lock: Option<File>,
    path: PathBuf,
}

/// The file in a claimed folder that says so.
const LOCK: &str = ".lock";

impl Claim {
    /// Makes `folder` and claims it for `what`, such as `a run`. A folder that holds something is refused; with `force`,
    /// what `ours` names in it, the files of an earlier one, is removed, and nothing else. `ours` is `None` where the folder
    /// holds none.
    ///
    /// # Errors
    /// [`Error::Busy`] where another program has claimed it, [`Error::Occupied`] where it holds something, [`Error::Place`]
    /// for what is no folder, [`Error::Io`] where it cannot be written.
    pub fn new(
        folder: &Path,
        what: &'static str,
        force: bool,
        ours: impl FnOnce(&Path) -> Option<Vec<String>>,
    ) -> Result<Self, Error> {
        named(folder)?;
        no_file(folder)?;
        // Where a link leads is made, too.
        fs::create_dir_all(followed(folder)).map_err(Error::io("create", folder))?;
        let claim = Self::lock(folder)?;
        let entries = fs::read_dir(folder).map_err(Error::io("read", folder))?;
        if entries.flatten().all(|entry| entry.file_name() == LOCK) {
            return Ok(claim);
        }
        let path = || folder.to_owned();
        let Some(ours) = ours(folder) else { return Err(Error::Occupied { path: path(), what: None }) };
        if !force {
            return Err(Error::Occupied { path: path(), what: Some(what) });
        }
        for path in ours.iter().map(|name| folder.join(name)).filter(|path| path.exists()) {
            let removed = if path.is_dir() { fs::remove_dir_all(&path) } else { fs::remove_file(&path) };
            removed.map_err(Error::io("remove", &path))?;
        }
        Ok(claim)
    }

    /// Claims a folder that holds what is to be gone on with.
    ///
    /// # Errors
    /// [`Error::Busy`] where another program has claimed it, [`Error::Io`] where it cannot be written.
    pub fn again(folder: &Path) -> Result<Self, Error> {
        Self::lock(folder)
    }

    fn lock(folder: &Path) -> Result<Self, Error> {
        let path = folder.join(LOCK);
        loop {
            let lock = File::options()
                .write(true)
                .create(true)
                .truncate(false)
                .open(&path)
                .map_err(Error::io("write into", folder))?;
            match lock.try_lock() {
                Err(TryLockError::WouldBlock) => return Err(Error::Busy(folder.to_owned())),
                // A file system without locks lets everybody write, as it always did.
                Err(TryLockError::Error(_)) => return Ok(Self { lock: None, path }),
                // Whoever had it may have removed it between the two steps.
                Ok(()) if path.exists() => return Ok(Self { lock: Some(lock), path }),
                Ok(()) => {}
            }
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // Removed while it is locked, so that nobody's lock is taken away.
        let _ = fs::remove_file(&self.path);
        self.lock = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(folder: &Path, force: bool) -> Result<Claim, Error> {
        let ours = |folder: &Path| {
            folder.join("mark").exists().then(|| vec!["mark".to_owned(), "old".to_owned(), "gone".to_owned()])
        };
        Claim::new(folder, "a run", force, ours)
    }

    #[test]
    fn a_folder_has_one_writer_at_a_time_and_no_trace_of_it() {
        let root = tempfile::tempdir().expect("a folder");
        let folder = root.path().join("deep/run");
        let first = claim(&folder, false).expect("free");
        fs::write(folder.join("mark"), "").expect("written");
        for force in [false, true] {
            let error = claim(&folder, force).expect_err("claimed");
            assert!(error.is_usage() && error.to_string().contains("another program"), "{error}");
        }
        assert!(folder.join("mark").exists());
        drop(first);
        assert_eq!(fs::read_dir(&folder).expect("listed").count(), 1);
        // What a program that was killed has left is no claim.
        fs::write(folder.join(LOCK), "").expect("left");
        drop(claim(&folder, true).expect("free"));
    }

    #[test]
    fn only_what_is_ours_is_replaced_and_only_where_asked_for() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("notes.txt"), "mine").expect("written");
        let error = claim(folder.path(), true).expect_err("other files");
        assert!(matches!(error, Error::Occupied { what: None, .. }), "{error}");
        fs::write(at("mark"), "").expect("written");
        fs::create_dir_all(at("old/inner")).expect("made");
        let error = claim(folder.path(), false).expect_err("a run");
        assert!(matches!(error, Error::Occupied { what: Some("a run"), .. }), "{error}");
        // How it is replaced, or another folder named, is the business of whoever asks.
        assert_eq!(error.to_string(), format!("{} already holds a run", folder.path().display()));
        drop(claim(folder.path(), true).expect("replaced"));
        assert!(at("notes.txt").exists() && !at("mark").exists() && !at("old").exists());
        let told = claim(&at("notes.txt"), true).expect_err("a file").to_string();
        assert!(told.contains("is a file"), "{told}");
    }
}
