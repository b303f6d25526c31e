//! Whole files or none: written beside their final name and renamed.

use crate::Error;
use std::fs;
use std::io::Write;
use std::path::Path;

/// Writes `bytes` to `path` so that a reader sees the old file or the new one, never half of it.
///
/// # Errors
/// [`Error::Io`] when the folder is not writable or full; nothing is left behind then.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    // A link stays, and what it points at is written; what is no file, such as a pipe or a device, takes it as it comes.
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    if path.exists() && !path.is_file() {
        return fs::write(path, bytes).map_err(Error::io("write", path));
    }
    let draft = path.with_extension("tmp");
    let written = fs::File::create(&draft).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_data()
    });
    if let Err(source) = written.and_then(|()| fs::rename(&draft, path)) {
        // The draft may not exist; the first error is the one to tell.
        let _ = fs::remove_file(&draft);
        return Err(Error::io("write", path)(source));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_a_file_and_leaves_no_draft() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.json");
        for text in ["one", "two"] {
            write_whole(&path, text.as_bytes()).expect("written");
            assert_eq!(fs::read_to_string(&path).expect("read"), text);
        }
        assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_devices_devices() {
        let folder = tempfile::tempdir().expect("a folder");
        let (file, link) = (folder.path().join("a.json"), folder.path().join("link.json"));
        fs::write(&file, "old").expect("written");
        std::os::unix::fs::symlink(&file, &link).expect("linked");
        write_whole(&link, b"new").expect("written");
        assert!(link.is_symlink() && fs::read_to_string(&file).expect("read") == "new");
        write_whole(Path::new("/dev/null"), b"gone").expect("written");
        assert!(!Path::new("/dev/null").is_file());
        assert!(!Path::new("/dev/full").exists() || write_whole(Path::new("/dev/full"), b"x").is_err());
    }

    #[test]
    fn a_missing_folder_is_an_error_that_names_the_file() {
        let error = write_whole(Path::new("/nowhere/at/all.json"), b"x").expect_err("no such folder");
        assert!(error.to_string().contains("/nowhere/at/all.json"), "{error}");
    }

    #[test]
    fn a_full_disk_is_an_error() {
        if !Path::new("/dev/full").exists() {
            return;
        }
        let source = fs::write("/dev/full", "x").expect_err("always full");
        let error = Error::io("write", Path::new("/dev/full"))(source);
        assert!(error.to_string().contains("No space left"), "{error}");
    }
}
