//! Pictures to PNG files, whole or not at all.

use crate::Error;
use crate::partial::Partial;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use vocabulary::Picture;

/// Writes `picture` with text `metadata` (key, value) beside `path` and renames it when it is complete.
///
/// # Errors
/// [`Error::Write`] where the file cannot be written.
pub fn write(path: &Path, picture: &Picture, metadata: &[(&str, &str)]) -> Result<(), Error> {
    let partial = Partial::new(path);
    write_file(&partial.path, path, picture, metadata)?;
    partial.rename()
}

/// Writes a file at `place`; errors speak of `shown`.
pub(crate) fn write_file(
    place: &Path,
    shown: &Path,
    picture: &Picture,
    metadata: &[(&str, &str)],
) -> Result<(), Error> {
    let file = File::create(place).map_err(|e| Error::write(shown, e))?;
    let mut buffered = BufWriter::new(file);
    encode(&mut buffered, picture, metadata).map_err(|e| match e {
        png::EncodingError::IoError(source) => Error::write(shown, source),
        other => Error::Encode(other.to_string()),
    })?;
    buffered.flush().map_err(|e| Error::write(shown, e))
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
