//! Tags in pictures: a detector that is somebody else's, corners that are measured anew, and whose faces they are.

mod identify;
mod locus;
mod sharpen;

pub use identify::identify;
pub use locus::Locus;
pub use sharpen::sharpen;

use crate::imaging::Optics;
use crate::pose::SeenFace;
use vocabulary::{Grey, Region, Shell};

/// A tag found in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tag {
    /// Its number in the family.
    pub id: u16,
    /// Corners of its black square, pixels: top left, top right, bottom right, bottom left of the tag upright. The middle
    /// of the picture's top left pixel is (0, 0).
    pub corners: [[f64; 2]; 4],
    /// Standard deviation of a corner in one direction as its finder judges it, pixels; 0 from those who do not.
    pub deviation: f64,
}

/// Corners keep this far from the edge of a picture, pixels.
const EDGE: f64 = 1.0;

/// Finds tags.
pub trait Detector: Send {
    /// Puts the tags of a picture, however many, into `found`, which is emptied first; in an order that depends on
    /// nothing but the picture.
    fn detect(&mut self, picture: &Grey, found: &mut Vec<Tag>);

    /// Adds those that only show when the dark of the picture is lifted: in the shade beside what the sun lights.
    fn detect_in_shade(&mut self, _picture: &Grey, _found: &mut Vec<Tag>) {}
}

/// The faces of `shell` in a picture of `region`: tags found, their corners sharpened, and judged. Corners are pixels of
/// the whole frame. Once `expected` faces are found, the shade is not searched.
pub fn recognise(
    detector: &mut dyn Detector,
    picture: &Grey,
    region: Region,
    optics: &Optics,
    shell: &Shell,
    expected: usize,
) -> Vec<SeenFace> {
    let mut tags = vec![];
    detector.detect(picture, &mut tags);
    tags.retain(|tag| shell.face_of(tag.id).is_some());
    if tags.len() < expected {
        detector.detect_in_shade(picture, &mut tags);
        tags.retain(|tag| shell.face_of(tag.id).is_some());
    }
    sharpen(picture, region, optics, &mut tags);
    // What the edge of the picture cuts off was read by luck.
    let last = [picture.width, picture.height].map(|n| f64::from(n) - 1.0);
    tags.retain(|tag| tag.corners.iter().all(|c| (0..2).all(|k| c[k] > EDGE && c[k] < last[k] - EDGE)));
    for corner in tags.iter_mut().flat_map(|tag| &mut tag.corners) {
        *corner = [corner[0] + f64::from(region.x), corner[1] + f64::from(region.y)];
    }
    identify(&tags, shell)
}
