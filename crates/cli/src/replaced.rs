//! Files that took the place of others: one rule for all commands. A file of the same name is replaced once the new one is
//! whole, and that is told; folders are another matter, see `output::Claim`.

use crate::failure::Failure;
use crate::print::note;
use output::write_whole;
use std::path::{Path, PathBuf};

/// What was there before a command wrote its files.
#[derive(Default)]
pub(crate) struct Replaced(Vec<PathBuf>);

/// Writes texts as files of these names into `folder`, and prints which files they replaced.
pub(crate) fn write_all(
    folder: &Path,
    texts: &[(String, String)],
    quiet: bool,
) -> Result<Vec<PathBuf>, Failure> {
    let (mut written, mut replaced) = (vec![], Replaced::default());
    for (name, text) in texts {
        let path = folder.join(name);
        replaced.look(&path);
        write_whole(&path, text.as_bytes())?;
        written.push(path);
    }
    replaced.tell(quiet);
    Ok(written)
}

/// A name as CSV takes it.
pub(crate) fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

/// Names that are listed, at most.
const SHOWN: usize = 3;

impl Replaced {
    /// Looks whether there is a file at `path`, which is about to be written.
    pub(crate) fn look(&mut self, path: &Path) {
        if path.is_file() {
            self.0.push(path.to_owned());
        }
    }

    /// Says what was replaced, once it is.
    pub(crate) fn tell(&self, quiet: bool) {
        if !quiet && let Some(text) = self.words() {
            note(&text);
        }
    }

    fn words(&self) -> Option<String> {
        let names: Vec<String> = self.0.iter().take(SHOWN).map(|path| path.display().to_string()).collect();
        let more = match self.0.len().saturating_sub(SHOWN) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        (!names.is_empty()).then(|| format!("replaced {}{more}", names.join(", ")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_are_named_and_the_others_counted() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut replaced = Replaced::default();
        replaced.look(&folder.path().join("new.png"));
        assert_eq!(replaced.words(), None);
        for k in 0..5 {
            std::fs::write(folder.path().join(format!("{k}.png")), "old").expect("written");
            replaced.look(&folder.path().join(format!("{k}.png")));
        }
        let words = replaced.words().expect("replaced");
        assert!(words.starts_with("replaced ") && words.ends_with("2.png and 2 more"), "{words}");
    }
}
