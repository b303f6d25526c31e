//! The folder of a data set: refused where it holds other things, every file in it whole or not there.

use crate::Error;
use output::{Claim, write_whole};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use vocabulary::Grey;

/// What `--force` replaces.
const OURS: [&str; 3] = ["dataset.json", "coco.json", PICTURES];
/// Folder of the pictures.
const PICTURES: &str = "pictures";

/// A folder that is being filled.
pub(crate) struct DatasetFolder {
    path: PathBuf,
    _claim: Claim,
}

impl DatasetFolder {
    /// Makes the folder; with `force`, removes an earlier data set from it, and nothing else.
    pub(crate) fn create(path: &Path, force: bool) -> Result<Self, Error> {
        let ours = |folder: &Path| folder.join(OURS[0]).exists().then(|| OURS.map(str::to_owned).to_vec());
        let claim = Claim::new(path, "a data set", force, ours)?;
        let pictures = path.join(PICTURES);
        fs::create_dir_all(&pictures).map_err(output::Error::io("create", &pictures))?;
        Ok(Self { path: path.to_owned(), _claim: claim })
    }

    /// Writes a picture and returns its name within the folder.
    pub(crate) fn picture(&self, name: &str, picture: &Grey) -> Result<String, Error> {
        let name = format!("{PICTURES}/{name}.png");
        let path = self.path.join(&name);
        let refused = |error: png::EncodingError| output::Error::io("write", &path)(error.into());
        let bytes = encoded(picture).map_err(refused)?;
        write_whole(&path, &bytes)?;
        Ok(name)
    }

    /// Writes a text file.
    pub(crate) fn json(&self, name: &str, value: &Value) -> Result<(), Error> {
        Ok(write_whole(&self.path.join(name), format!("{value:#}\n").as_bytes())?)
    }
}

/// A PNG file of 8 bits grey. The values are the sensor's, linear in light, and the file says so.
fn encoded(picture: &Grey) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width, picture.height);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_gamma(png::ScaledFloat::new(1.0));
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&picture.values)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_pictures_are_written_as_they_are() {
        let values: Vec<u8> = (0..12).map(|k| k * 20).collect();
        let bytes = encoded(&Grey { width: 4, height: 3, values: values.clone() }).expect("encoded");
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a picture");
        let mut read = vec![0; 12];
        let info = reader.next_frame(&mut read).expect("a frame");
        assert_eq!((info.width, info.height, info.color_type), (4, 3, png::ColorType::Grayscale));
        assert_eq!(read, values);
    }

    #[test]
    fn only_an_earlier_data_set_is_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        drop(DatasetFolder::create(folder.path(), false).expect("empty"));
        fs::write(at("dataset.json"), "{}").expect("written");
        fs::write(at("pictures/old.png"), "old").expect("written");
        fs::write(at("notes.txt"), "mine").expect("written");
        let again = DatasetFolder::create(folder.path(), false).err();
        assert!(matches!(
            again,
            Some(Error::Output(output::Error::Occupied { what: Some("a data set"), .. }))
        ));
        drop(DatasetFolder::create(folder.path(), true).expect("replaced"));
        assert!(at("notes.txt").exists() && !at("pictures/old.png").exists() && !at("dataset.json").exists());
        let text = match DatasetFolder::create(folder.path(), true) {
            Err(Error::Output(error)) => error.to_string(),
            _ => String::new(),
        };
        assert!(text.contains("other files"), "{text}");
    }
}
