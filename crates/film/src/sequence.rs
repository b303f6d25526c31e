//! A folder of numbered pictures.

use crate::frame_sink::FrameSink;
use crate::{Error, png};
use output::DraftFolder;
use std::fs::File;
use std::path::Path;
use vocabulary::Picture;

/// The folder under its temporary name.
pub(crate) struct Sequence {
    folder: DraftFolder,
    count: u32,
}

impl Sequence {
    pub(crate) fn create(path: &Path) -> Result<Self, Error> {
        // Pictures of an older, longer film would stay among the new ones.
        if std::fs::read_dir(path).is_ok_and(|mut entries| entries.next().is_some()) {
            return Err(output::Error::Occupied { path: path.to_owned(), what: None }.into());
        }
        Ok(Self { folder: DraftFolder::new(path)?, count: 0 })
    }
}

impl FrameSink for Sequence {
    fn add(&mut self, picture: &Picture) -> Result<(), Error> {
        let name = format!("frame-{:05}.png", self.count);
        self.count += 1;
        let shown = self.folder.goal().join(&name);
        let file = File::create(self.folder.path().join(name)).map_err(|e| Error::write(&shown, e))?;
        png::write_into(file, &shown, picture, &[])
    }

    fn finish(self: Box<Self>) -> Result<(), Error> {
        Ok(self.folder.keep()?)
    }
}
