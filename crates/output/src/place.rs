//! Looks at where something will be written, before the work begins.

use crate::draft::{folder_of, followed};
use crate::{Draft, Error};
use std::fs;
use std::path::{Path, PathBuf};

/// A place that can be written. Folders that were made for it go away with it where they stayed empty.
#[derive(Debug)]
#[must_use = "folders that were made are removed when it is dropped"]
pub struct Place {
    /// The innermost first.
    made: Vec<PathBuf>,
}

impl Place {
    /// Looks whether a file can be written at `path`, and makes the folder for it.
    ///
    /// # Errors
    /// [`Error::Place`] for what is a folder or a device; [`Error::Io`] where it cannot be written.
    pub fn file(path: &Path) -> Result<Self, Error> {
        named(path)?;
        let text = path.as_os_str().as_encoded_bytes();
        if path.is_dir() || text.last().is_some_and(|last| std::path::is_separator(char::from(*last))) {
            return Err(Error::place(path, "is a folder: name a file"));
        }
        let goal = followed(path);
        if let Ok(about) = fs::metadata(&goal) {
            if is_device(&about) {
                return Err(Error::place(path, "is a device: name a file"));
            }
            if !about.is_file() {
                return Ok(Self { made: vec![] });
            }
            // One that its owner protects is left alone, though the folder would let it be replaced.
            fs::OpenOptions::new().append(true).open(&goal).map_err(Error::io("write", path))?;
        }
        let place = Self::made(folder_of(&goal))?;
        drop(Draft::new(&goal)?);
        Ok(place)
    }

    /// Looks whether files can be written into the folder `path`, and makes it.
    ///
    /// # Errors
    /// [`Error::Place`] for what is no folder; [`Error::Io`] where it cannot be written.
    pub fn folder(path: &Path) -> Result<Self, Error> {
        named(path)?;
        no_file(path)?;
        let place = Self::made(&followed(path))?;
        match Draft::new(&path.join("output")) {
            Err(Error::Io { source, .. }) => Err(Error::io("write into", path)(source)),
            Err(other) => Err(other),
            Ok(_) => Ok(place),
        }
    }

    /// Looks whether a folder can be made at `path`, and makes those around it.
    ///
    /// # Errors
    /// As [`Place::folder`].
    pub fn new_folder(path: &Path) -> Result<Self, Error> {
        named(path)?;
        if path.exists() {
            return Self::folder(path);
        }
        let goal = followed(path);
        let place = Self::made(folder_of(&goal))?;
        drop(Draft::new(&goal)?);
        Ok(place)
    }

    /// Makes `folder` and those around it.
    fn made(folder: &Path) -> Result<Self, Error> {
        if let Some(file) = folder.ancestors().find(|f| f.is_file()) {
            return Err(Error::place(file, "is a file: name a folder"));
        }
        let missing = folder.ancestors().take_while(|f| !f.as_os_str().is_empty() && !f.exists());
        let place = Self { made: missing.map(Path::to_owned).collect() };
        fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
        Ok(place)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        for folder in &self.made {
            // One that holds something stays.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// Refuses what names nothing.
pub(crate) fn named(path: &Path) -> Result<(), Error> {
    let goal = followed(path);
    if goal.ancestors().any(|part| part.is_symlink() && !part.exists()) {
        return Err(Error::place(
            path,
            "is a link that leads nowhere, round in a circle: name another place",
        ));
    }
    match path.as_os_str().as_encoded_bytes() {
        b"" => Err(Error::place(path, "(nothing) is no place to write to: name one")),
        b"-" => Err(Error::place(
            path,
            "would be standard output, which only text goes to: name a file or folder",
        )),
        _ => Ok(()),
    }
}

/// Endings that nobody gives a folder on purpose.
const ENDINGS: [&str; 15] = [
    "png", "jpg", "jpeg", "gif", "mp4", "m4v", "webm", "svg", "pdf", "json", "csv", "xml", "html", "mcap",
    "toml",
];

/// Refuses what is there and is no folder, and what would be one with the name of a file.
pub(crate) fn no_file(path: &Path) -> Result<(), Error> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    match path.exists() {
        true if path.is_dir() => Ok(()),
        true if path.is_file() => Err(Error::place(path, "is a file: name a folder")),
        true => Err(Error::place(path, "is no folder: name one")),
        false if ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str())) => {
            Err(Error::place(path, "has the ending of a file, and names a folder here: leave the ending out"))
        }
        false => Ok(()),
    }
}

#[cfg(unix)]
fn is_device(about: &fs::Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    let kind = about.file_type();
    kind.is_char_device() || kind.is_block_device() || kind.is_socket()
}

#[cfg(not(unix))]
fn is_device(about: &fs::Metadata) -> bool {
    !about.is_file()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_made_and_go_away_where_nothing_came() {
        let root = tempfile::tempdir().expect("a folder");
        let deep = root.path().join("a/b/report.xml");
        drop(Place::file(&deep).expect("a place"));
        assert!(!root.path().join("a").exists());
        let place = Place::file(&deep).expect("a place");
        fs::write(&deep, "x").expect("written");
        drop(place);
        assert!(deep.exists());
        drop(Place::folder(&root.path().join("c/d")).expect("a place"));
        drop(Place::new_folder(&root.path().join("c/d")).expect("a place"));
        assert!(!root.path().join("c").exists());
        assert_eq!(fs::read_dir(root.path()).expect("listed").count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn what_links_lead_to_is_made() {
        use std::os::unix::fs::symlink;
        let root = tempfile::tempdir().expect("a folder");
        let at = |name: &str| root.path().join(name);
        symlink("nowhere/deep", at("link")).expect("linked");
        for (name, made) in [("link", "nowhere/deep"), ("link/below/it", "nowhere/deep/below/it")] {
            let claim = crate::Claim::new(&at(name), "a run", false, |_| None).expect("claimed");
            assert!(at(made).join(".lock").exists(), "{name}");
            drop(claim);
            std::fs::remove_dir_all(at("nowhere")).expect("removed");
            for look in [Place::folder, Place::file, Place::new_folder] {
                drop(look(&at(name)).expect("a place"));
                assert!(!at("nowhere").exists() && at("link").is_symlink(), "{name}");
            }
        }
        symlink("b", at("a")).expect("linked");
        symlink("a/c", at("b")).expect("linked");
        for name in ["a", "a/below"] {
            let claim = crate::Claim::new(&at(name), "a run", false, |_| None).map(drop);
            let places = [Place::folder(&at(name)), Place::file(&at(name)), Place::new_folder(&at(name))];
            for result in places.map(|place| place.map(drop)).into_iter().chain([claim]) {
                let error = result.expect_err("refused");
                assert!(error.is_usage() && error.to_string().contains("round in a circle"), "{error}");
            }
        }
    }

    #[test]
    fn what_is_no_place_is_refused_with_what_helps() {
        let root = tempfile::tempdir().expect("a folder");
        let file = root.path().join("file");
        fs::write(&file, "x").expect("written");
        let told = |place: Result<Place, Error>| {
            let error = place.expect_err("refused");
            assert!(error.is_usage(), "{error}");
            error.to_string()
        };
        assert!(told(Place::file(root.path())).contains("is a folder"));
        assert!(told(Place::file(&root.path().join("new/"))).contains("is a folder"));
        assert!(told(Place::folder(&file)).contains("is a file"));
        for name in ["shot.png", "run.MCAP", "deep/numbers.json"] {
            assert!(told(Place::folder(&root.path().join(name))).contains("leave the ending out"), "{name}");
        }
        // A folder that is there is one, whatever it is called.
        fs::create_dir(root.path().join("old.png")).expect("made");
        drop(Place::folder(&root.path().join("old.png")).expect("a folder"));
        drop(Place::folder(&root.path().join("v1.2")).expect("a folder"));
        assert!(told(Place::file(Path::new("-"))).contains("standard output"));
        assert!(told(Place::folder(Path::new("-"))).contains("standard output"));
        assert!(told(Place::file(Path::new(""))).contains("name one"));
        if cfg!(unix) {
            assert!(told(Place::file(Path::new("/dev/null"))).contains("device"));
        }
        // Below a file there is no folder.
        assert!(Place::file(&file.join("below.xml")).expect_err("refused").is_usage());
        assert_eq!(fs::read_to_string(&file).expect("untouched"), "x");
    }
}
