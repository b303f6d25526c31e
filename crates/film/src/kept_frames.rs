//! The files that keep an unfinished film on disk, so that a later program can continue it.
//!
//! Frames go to one file as they come, their sizes to another, the journal: whole groups of frames count, the rest is made
//! again. Every group starts an encoder of its own, so that the film is the same in the end.

use crate::Error;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Two files beside the film.
pub(crate) struct KeptFrames {
    goal: PathBuf,
    frames: BufWriter<File>,
    journal: BufWriter<File>,
    /// Whether there are whole groups.
    groups: bool,
}

/// The frames of a film so far.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct FilmJournal {
    /// Size of every frame, and whether playing can start at it.
    pub(crate) sizes: Vec<(u32, bool)>,
    /// Sequence and picture parameters of the encoder.
    pub(crate) parameters: [Vec<u8>; 2],
}

impl FilmJournal {
    /// Bytes of all frames.
    pub(crate) fn bytes(&self) -> u64 {
        self.sizes.iter().map(|(size, _)| u64::from(*size)).sum()
    }
}

fn paths(goal: &Path) -> [PathBuf; 2] {
    let name = goal.file_name().unwrap_or_default().to_string_lossy();
    ["frames", "journal"].map(|ending| goal.with_file_name(format!(".{name}.{ending}")))
}

impl KeptFrames {
    /// Opens the kept frames of the film `goal` from the same source (`made_of`, one line), or starts again; `group` is
    /// the number of frames in a group. Also returns the frames of whole groups that were there.
    pub(crate) fn open(goal: &Path, made_of: &str, group: usize) -> Result<(Self, FilmJournal), Error> {
        let failed = |e: std::io::Error| Error::write(goal, e);
        let [frames, journal] = paths(goal);
        let open = |path: &Path| {
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(failed)
        };
        let mut journal = open(&journal)?;
        if let Err(TryLockError::WouldBlock) = journal.try_lock() {
            return Err(output::Error::Busy(goal.to_owned()).into());
        }
        let mut frames = open(&frames)?;
        let mut text = String::new();
        // A journal that is no text is none of ours.
        if journal.read_to_string(&mut text).is_err() {
            text.clear();
        }
        let length = frames.metadata().map_err(failed)?.len();
        let found = read(&text, made_of, group, length).unwrap_or_default();
        frames.set_len(found.bytes()).and_then(|()| frames.seek(SeekFrom::End(0))).map_err(failed)?;
        let text = written(&found, made_of);
        journal.set_len(0).and_then(|()| journal.rewind()).map_err(failed)?;
        journal.write_all(text.as_bytes()).and_then(|()| journal.sync_data()).map_err(failed)?;
        let groups = !found.sizes.is_empty();
        let (frames, journal) = (BufWriter::with_capacity(1 << 18, frames), BufWriter::new(journal));
        Ok((Self { goal: goal.to_owned(), frames, journal, groups }, found))
    }

    /// Adds a frame.
    pub(crate) fn add(&mut self, frame: &[u8], key: bool) -> Result<(), Error> {
        let failed = |e: std::io::Error| Error::write(&self.goal, e);
        self.frames.write_all(frame).map_err(failed)?;
        self.journal.write_all(line(frame.len() as u32, key).as_bytes()).map_err(failed)
    }

    /// The encoder's parameters are known.
    pub(crate) fn parameters(&mut self, parameters: &[Vec<u8>; 2]) -> Result<(), Error> {
        let failed = |e: std::io::Error| Error::write(&self.goal, e);
        self.journal.write_all(parameter_line(parameters).as_bytes()).map_err(failed)
    }

    /// A group is whole: it is on disk before the journal says so.
    pub(crate) fn close_group(&mut self) -> Result<(), Error> {
        let failed = |e: std::io::Error| Error::write(&self.goal, e);
        self.frames.flush().and_then(|()| self.journal.flush()).map_err(failed)?;
        self.groups = true;
        Ok(())
    }

    /// All frames, from the first on.
    pub(crate) fn read_all(&mut self) -> Result<BufReader<&File>, Error> {
        let failed = |e: std::io::Error| Error::write(&self.goal, e);
        self.frames.flush().and_then(|()| self.journal.flush()).map_err(failed)?;
        let mut file = self.frames.get_ref();
        file.rewind().map_err(failed)?;
        Ok(BufReader::new(file))
    }

    /// The film is done: nothing has to be kept.
    pub(crate) fn remove(mut self) {
        self.groups = false;
    }
}

impl Drop for KeptFrames {
    fn drop(&mut self) {
        if !self.groups {
            // Files that cannot be removed are overwritten later.
            for path in paths(&self.goal) {
                let _ = std::fs::remove_file(path);
            }
        }
    }
}

/// Frames of the film `goal` that are kept in whole groups of `group`, whatever it is made of.
pub(crate) fn frames(goal: &Path, group: usize) -> u64 {
    let [frames, journal] = paths(goal);
    let text = std::fs::read_to_string(journal).unwrap_or_default();
    let length = std::fs::metadata(frames).map_or(0, |about| about.len());
    let made_of = text.lines().nth(1).unwrap_or_default();
    read(&text, made_of, group, length).map_or(0, |found| found.sizes.len() as u64)
}

const HEAD: &str = "echelon film 1";

fn line(size: u32, key: bool) -> String {
    format!("{size} {}\n", u8::from(key))
}

fn parameter_line([sequence, picture]: &[Vec<u8>; 2]) -> String {
    let digit = |nibble: u8| char::from_digit(u32::from(nibble), 16).unwrap_or('0');
    let hex = |bytes: &[u8]| bytes.iter().flat_map(|b| [digit(b >> 4), digit(b & 15)]).collect::<String>();
    format!("p {} {}\n", hex(sequence), hex(picture))
}

fn written(found: &FilmJournal, made_of: &str) -> String {
    let mut text = format!("{HEAD}\n{made_of}\n");
    if !found.sizes.is_empty() {
        text.push_str(&parameter_line(&found.parameters));
    }
    text.extend(found.sizes.iter().map(|(size, key)| line(*size, *key)));
    text
}

/// The whole groups in a journal; `length` bytes of frames are there.
fn read(text: &str, made_of: &str, group: usize, length: u64) -> Option<FilmJournal> {
    let rest = text.strip_prefix(HEAD)?.strip_prefix('\n')?.strip_prefix(made_of)?.strip_prefix('\n')?;
    let mut found = FilmJournal::default();
    // The last line may be cut off.
    for line in rest.split_inclusive('\n').filter_map(|line| line.strip_suffix('\n')) {
        let mut words = line.split(' ');
        match (words.next()?, words.next()?, words.next()) {
            ("p", sequence, picture) => found.parameters = [bytes(sequence)?, bytes(picture?)?],
            (size, key, _) => found.sizes.push((size.parse().ok()?, key == "1")),
        }
    }
    let mut whole = found.sizes.len() / group * group;
    let used = |frames: usize| found.sizes[..frames].iter().map(|(size, _)| u64::from(*size)).sum::<u64>();
    while whole > 0 && used(whole) > length {
        whole -= group;
    }
    found.sizes.truncate(whole);
    (!found.parameters[0].is_empty() || whole == 0).then_some(found)
}

fn bytes(hex: &str) -> Option<Vec<u8>> {
    let digits: Vec<u32> = hex.chars().map(|c| c.to_digit(16)).collect::<Option<_>>()?;
    digits.len().is_multiple_of(2).then(|| digits.chunks_exact(2).map(|d| (16 * d[0] + d[1]) as u8).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "echelon film 1\nthe same\np 6742 68\n10 1\n20 0\n30 1\n40 0\n50 1\n";

    #[test]
    fn whole_groups_count_that_are_there() {
        let sizes = |text: &str, length| read(text, "the same", 2, length).map(|f| f.sizes.len());
        assert_eq!(sizes(TEXT, 1000), Some(4));
        assert_eq!(sizes(TEXT, 99), Some(2));
        assert_eq!(sizes(TEXT, 29), Some(0));
        // Cut off in the middle of a line, and what is no journal, or another film's.
        assert_eq!(sizes(&TEXT[..TEXT.len() - 11], 1000), Some(2));
        assert_eq!(sizes("", 1000), None);
        assert_eq!(sizes("echelon film 1\nthe same\nx y\n", 1000), None);
        assert_eq!(read(TEXT, "another", 2, 1000), None);
        let found = read(TEXT, "the same", 2, 1000).expect("a film");
        assert_eq!(found.parameters, [vec![0x67, 0x42], vec![0x68]]);
        assert_eq!(written(&found, "the same"), TEXT.strip_suffix("50 1\n").expect("its end"));
    }
}
