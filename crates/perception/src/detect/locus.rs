//! The detector in use: locus-core, with the settings it is shipped with.

use super::{Detector, Tag};
use locus_core::{DetectorBuilder, FrameContext, ImageView, LocusEngine, TagFamily};
use vocabulary::Grey;

/// Pictures with fewer pixels across or down hold no tag: ten cells of little more than a pixel.
const LEAST: u32 = 16;

/// Side of the tiles that the library thresholds by, pixels. What is left over at the right and at the bottom it passes by.
const TILE: usize = 8;

/// Bytes behind a picture that the library's vector loads may touch.
const BEHIND: usize = 16;

/// Deviation of the corners it reports, pixels: 0.15 for tags of 60 pixels, 0.35 for tags of 20, measured.
const DEVIATION: f64 = 0.25;

/// Finds AprilTags 36h11 with locus-core.
pub struct Locus {
    engine: LocusEngine,
    context: FrameContext,
    padded: Vec<u8>,
}

impl Default for Locus {
    fn default() -> Self {
        Self::new()
    }
}

impl Locus {
    /// A detector that works within the thread pool it is called from. Its results do not depend on the pool.
    pub fn new() -> Self {
        let engine = DetectorBuilder::new().with_family(TagFamily::AprilTag36h11).build_engine();
        Self { engine, context: FrameContext::new(), padded: vec![] }
    }
}

impl Detector for Locus {
    fn detect(&mut self, picture: &Grey, found: &mut Vec<Tag>) {
        found.clear();
        let (width, height) = (picture.width as usize, picture.height as usize);
        if picture.width.min(picture.height) < LEAST || picture.values.len() != width * height {
            return;
        }
        let (across, down) = (width.next_multiple_of(TILE), height.next_multiple_of(TILE));
        self.pad(picture, across, down);
        let Ok(image) = ImageView::new(&self.padded, across, down, across) else { return };
        let Ok(seen) = self.engine.detect_with_context(&image, &mut self.context, None, None, false) else {
            return;
        };
        found.extend(seen.ids.iter().zip(seen.corners).filter_map(|(id, corners)| {
            // The library counts pixels from the corner of the top left one, and a tag's corners from the bottom right.
            let mut corners = corners.map(|c| [f64::from(c.x) - 0.5, f64::from(c.y) - 0.5]);
            corners.rotate_left(2);
            let finite = corners.iter().flatten().all(|x| x.is_finite());
            Some(Tag { id: u16::try_from(*id).ok()?, corners, deviation: DEVIATION }).filter(|_| finite)
        }));
        let middle = |t: &Tag| t.corners.iter().fold([0.0; 2], |sum, c| [sum[0] + c[0], sum[1] + c[1]]);
        found.sort_by(|a, b| {
            let (m, n) = (middle(a), middle(b));
            a.id.cmp(&b.id).then(m[0].total_cmp(&n[0])).then(m[1].total_cmp(&n[1]))
        });
    }
}

impl Locus {
    /// The picture with its last column and row repeated up to whole tiles.
    fn pad(&mut self, picture: &Grey, across: usize, down: usize) {
        self.padded.clear();
        let width = picture.width as usize;
        for row in picture.values.chunks_exact(width) {
            self.padded.extend_from_slice(row);
            let last = row.last().copied().unwrap_or_default();
            self.padded.resize(self.padded.len() + across - width, last);
        }
        while self.padded.len() < across * down {
            self.padded.extend_from_within(self.padded.len() - across..);
        }
        self.padded.resize(across * down + BEHIND, 0);
    }
}
