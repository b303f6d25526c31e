//! Pictures to PNG files, whole or not at all.

use crate::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use vocabulary::Picture;

/// Writes `picture` with text `metadata` (key, value) beside `path` and renames it when it is complete.
///
/// # Errors
/// [`Error::Write`] where the file cannot be written.
pub fn write(path: &Path, picture: &Picture, metadata: &[(&str, &str)]) -> Result<(), Error> {
    let partial = Partial::new(path);
    let file = File::create(&partial.path).map_err(|e| Error::write(path, e))?;
    let mut buffered = BufWriter::new(file);
    encode(&mut buffered, picture, metadata).map_err(|e| match e {
        png::EncodingError::IoError(source) => Error::write(path, source),
        other => Error::Encode(other.to_string()),
    })?;
    buffered.flush().map_err(|e| Error::write(path, e))?;
    partial.rename()
}

fn encode(out: impl Write, picture: &Picture, metadata: &[(&str, &str)]) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(out, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    // Fast: half the time of the default for a few percent of the size.
    encoder.set_compression(png::Compression::Fast);
    for (key, value) in metadata {
        encoder.add_itxt_chunk((*key).to_owned(), (*value).to_owned())?;
    }
    let rgb: Vec<u8> = picture.rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    writer.finish()
}

/// A file under a temporary name beside its final one; removed unless it is renamed.
#[derive(Debug)]
pub(crate) struct Partial {
    pub(crate) path: PathBuf,
    goal: PathBuf,
}

impl Partial {
    pub(crate) fn new(goal: &Path) -> Self {
        let name = goal.file_name().unwrap_or_default().to_string_lossy();
        // The process id keeps two programs that write the same film apart.
        let path = goal.with_file_name(format!(".{name}.{}.part", std::process::id()));
        Self { path, goal: goal.to_owned() }
    }

    /// Gives the file its name.
    pub(crate) fn rename(self) -> Result<(), Error> {
        std::fs::rename(&self.path, &self.goal).map_err(|e| Error::write(&self.goal, e))
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        // After a rename there is nothing left to remove.
        let _ = std::fs::remove_file(&self.path);
        let _ = std::fs::remove_dir_all(&self.path);
    }
}
