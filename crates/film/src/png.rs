//! Pictures to PNG files, whole or not at all, and the texts of such files back.

use crate::Error;
use output::Draft;
use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Cursor, Seek, Write};
use std::path::Path;
use vocabulary::Picture;

/// Texts from this length on are compressed, bytes.
const LONG: usize = 2_000;
/// Most that is read of the texts of a file, bytes.
const MOST_TEXT: usize = 4_000_000;
/// Largest side of a picture whose texts are read, pixels.
const MOST_SIDE: u32 = 65_536;

/// Writes `picture` with text `metadata` (key, value) beside `path` and renames it when it is complete.
///
/// # Errors
/// [`Error::Output`] where the file cannot be written.
pub fn write(path: &Path, picture: &Picture, metadata: &[(&str, &str)]) -> Result<(), Error> {
    let mut draft = Draft::new(path)?;
    write_into(draft.file(), path, picture, metadata)?;
    Ok(draft.keep()?)
}

/// Writes into `file`; errors speak of `shown`.
pub(crate) fn write_into(
    file: impl Write,
    shown: &Path,
    picture: &Picture,
    metadata: &[(&str, &str)],
) -> Result<(), Error> {
    let mut buffered = BufWriter::new(file);
    encode_into(&mut buffered, picture, metadata).map_err(|e| match e {
        png::EncodingError::IoError(source) => Error::write(shown, source),
        other => Error::Encode(other.to_string()),
    })?;
    buffered.flush().map_err(|e| Error::write(shown, e))
}

/// A picture as the bytes of a file, with text `metadata` (key, value).
///
/// # Errors
/// [`Error::Encode`] for keys that are empty or longer than 79 letters.
pub fn encode(picture: &Picture, metadata: &[(&str, &str)]) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    encode_into(&mut bytes, picture, metadata).map_err(|e| Error::Encode(e.to_string()))?;
    Ok(bytes)
}

/// The texts (key, value) of the file at `path`, long ones after the others.
///
/// # Errors
/// [`Error::Read`] where the file cannot be read or is no picture, or has more texts than a picture of ours.
pub fn read_texts(path: &Path) -> Result<Vec<(String, String)>, Error> {
    let file = File::open(path).map_err(|e| Error::read(path, e))?;
    texts(BufReader::new(file)).map_err(|e| Error::read(path, e))
}

/// The texts (key, value) of the bytes of a file, as [`read_texts`]; errors speak of `shown`.
///
/// # Errors
/// As [`read_texts`].
pub fn texts_of(bytes: &[u8], shown: &Path) -> Result<Vec<(String, String)>, Error> {
    texts(Cursor::new(bytes)).map_err(|e| Error::read(shown, e))
}

/// The texts that stand before the image.
fn texts(file: impl BufRead + Seek) -> Result<Vec<(String, String)>, std::io::Error> {
    let broken = |e: png::DecodingError| match e {
        png::DecodingError::IoError(e) => e,
        other => std::io::Error::new(std::io::ErrorKind::InvalidData, other),
    };
    let mut decoder = png::Decoder::new_with_limits(file, png::Limits { bytes: MOST_TEXT });
    let header = decoder.read_header_info().map_err(broken)?;
    // No picture of ours is larger; the reader that follows makes room for a row.
    if header.width.max(header.height) > MOST_SIDE {
        return Err(std::io::ErrorKind::InvalidData.into());
    }
    let reader = decoder.read_info().map_err(broken)?;
    let mut room = MOST_TEXT;
    let mut found = Vec::new();
    for chunk in &reader.info().utf8_text {
        let mut chunk = chunk.clone();
        chunk.decompress_text_with_limit(room).map_err(broken)?;
        let text = chunk.get_text().map_err(broken)?;
        room = room.saturating_sub(text.len());
        found.push((chunk.keyword, text));
    }
    Ok(found)
}

fn encode_into(
    out: impl Write,
    picture: &Picture,
    metadata: &[(&str, &str)],
) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(out, picture.width, picture.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    // Fast: half the time of the default for a few percent of the size.
    encoder.set_compression(png::Compression::Fast);
    for (key, value) in metadata.iter().filter(|(_, value)| value.len() < LONG) {
        encoder.add_itxt_chunk((*key).to_owned(), (*value).to_owned())?;
    }
    let rgb: Vec<u8> = picture.rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut writer = encoder.write_header()?;
    for (key, value) in metadata.iter().filter(|(_, value)| value.len() >= LONG) {
        let mut chunk = png::text_metadata::ITXtChunk::new(*key, *value);
        chunk.compressed = true;
        writer.write_text_chunk(&chunk)?;
    }
    writer.write_image_data(&rgb)?;
    writer.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Picture {
        Picture { width: 3, height: 2, rgba: vec![200; 24] }
    }

    #[test]
    fn texts_come_back() {
        let rows: Vec<_> = (0..6_000).map(|k| format!("\"k{k}\" = \u{03b2}")).collect();
        let scene = rows.join("\n");
        let all = [("Adapter", "llvmpipe · 1 × 2"), ("Scene", scene.as_str()), ("Empty", "")];
        let bytes = encode(&picture(), &all).unwrap();
        assert!(scene.len() > 50_000 && bytes.len() < 30_000, "{} {}", scene.len(), bytes.len());
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        write(&path, &picture(), &all).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), bytes);
        let mut found = read_texts(&path).unwrap();
        found.sort();
        let mut wanted: Vec<_> = all.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
        wanted.sort();
        assert_eq!(found, wanted);
        assert_eq!(texts_of(&encode(&picture(), &[]).unwrap(), &path).unwrap(), []);
    }

    #[test]
    fn hostile_files_are_refused() {
        let shown = Path::new("a.png");
        // A text that is far larger than its file.
        let bomb = "x".repeat(2 * MOST_TEXT);
        let bytes = encode(&picture(), &[("Bomb", &bomb)]).unwrap();
        assert!(bytes.len() < MOST_TEXT / 50);
        let error = texts_of(&bytes, shown).unwrap_err();
        assert!(matches!(error, Error::Read { .. }) && error.to_string().contains("a.png"), "{error}");
        let good = encode(&picture(), &[("Scene", &"abc".repeat(900))]).unwrap();
        for cut in 0..good.len() - 30 {
            let _ = texts_of(&good[..cut], shown);
            let mut bent = good.clone();
            bent[cut] ^= 0x5a;
            let _ = texts_of(&bent, shown);
        }
        // A row of eight gigabytes.
        let mut wide = good.clone();
        wide[16..20].copy_from_slice(&[0x7f, 255, 255, 255]);
        assert!(texts_of(&wide, shown).is_err());
        assert!(texts_of(b"no picture", shown).is_err());
        assert!(read_texts(Path::new("/nowhere/a.png")).is_err());
    }
}
