//! The detector in use: locus-core, with the settings it is shipped with.

use super::{Detector, Tag};
use locus_core::{DetectorBuilder, FrameContext, ImageView, LocusEngine, TagFamily};
use std::sync::LazyLock;
use vocabulary::{Grey, math};

/// Pictures with fewer pixels across or down hold no tag: ten cells of little more than a pixel.
const LEAST: u32 = 16;

/// Side of the tiles that the library thresholds by, pixels. What is left over at the right and at the bottom it passes by.
const TILE: usize = 8;

/// Bytes behind a picture that the library's vector loads may touch.
const BEHIND: usize = 16;

/// Deviation of the corners it reports, pixels: 0.15 for tags of 60 pixels, 0.35 for tags of 20, measured.
const DEVIATION: f64 = 0.25;

/// The same for corners from the copy with its dark lifted, whose edges have moved.
const LIFTED_DEVIATION: f64 = 0.5;

/// How strongly the dark is lifted before tags are looked for. The library's thresholds are fractions of a neighbourhood's
/// range, and in linear light a face in the shade next to one in the sun lies below them: of 60 pictures of such shells it
/// finds 17 tags as they are, 53 with 20, 78 with 40, 62 with 80.
const LIFT: f64 = 40.0;

/// Display value of every amount of light, as near to logarithmic as the noise of the dark allows.
static DISPLAY: LazyLock<[u8; 256]> = LazyLock::new(|| {
    std::array::from_fn(|light| {
        let lifted = math::ln_1p(LIFT * light as f64 / 255.0) / math::ln_1p(LIFT);
        (255.0 * lifted).round() as u8
    })
});

/// Finds AprilTags 36h11 with locus-core, in the picture and in a copy with its dark lifted and its noise softened. Corners
/// are good to start from, and not as good as what [`super::sharpen`] makes of them on the picture itself.
pub struct Locus {
    engine: LocusEngine,
    context: FrameContext,
    softened: Vec<u8>,
    padded: Vec<u8>,
}

impl Default for Locus {
    fn default() -> Self {
        Self::new()
    }
}

impl Locus {
    /// A detector that works on one thread of its own: pictures are small, and many are looked at side by side.
    pub fn new() -> Self {
        let engine =
            DetectorBuilder::new().with_family(TagFamily::AprilTag36h11).with_threads(1).build_engine();
        Self { engine, context: FrameContext::new(), softened: vec![], padded: vec![] }
    }
}

impl Detector for Locus {
    fn detect(&mut self, picture: &Grey, found: &mut Vec<Tag>) {
        found.clear();
        self.pass(picture, false, DEVIATION, found);
    }

    fn detect_in_shade(&mut self, picture: &Grey, found: &mut Vec<Tag>) {
        self.pass(picture, true, LIFTED_DEVIATION, found);
    }
}

impl Locus {
    /// Adds the tags that are found in the picture, or in the copy with its dark lifted, and are not among those known.
    fn pass(&mut self, picture: &Grey, lifted: bool, deviation: f64, found: &mut Vec<Tag>) {
        let (width, height) = (picture.width as usize, picture.height as usize);
        if picture.width.min(picture.height) < LEAST || picture.values.len() != width * height {
            return;
        }
        let (across, down) = (width.next_multiple_of(TILE), height.next_multiple_of(TILE));
        self.pad(picture, lifted, across, down);
        let Ok(image) = ImageView::new(&self.padded, across, down, across) else { return };
        let Ok(seen) = self.engine.detect_with_context(&image, &mut self.context, None, None, false) else {
            return;
        };
        let known: Vec<u16> = found.iter().map(|tag| tag.id).collect();
        found.extend(seen.ids.iter().zip(seen.corners).filter_map(|(id, corners)| {
            let id = u16::try_from(*id).ok().filter(|id| !known.contains(id))?;
            // The library counts pixels from the corner of the top left one, and a tag's corners from the bottom right.
            let mut corners = corners.map(|c| [f64::from(c.x) - 0.5, f64::from(c.y) - 0.5]);
            corners.rotate_left(2);
            let finite = corners.iter().flatten().all(|x| x.is_finite());
            finite.then_some(Tag { id, corners, deviation })
        }));
        let middle = |t: &Tag| t.corners.iter().fold([0.0; 2], |sum, c| [sum[0] + c[0], sum[1] + c[1]]);
        found.sort_by(|a, b| {
            let (m, n) = (middle(a), middle(b));
            a.id.cmp(&b.id).then(m[0].total_cmp(&n[0])).then(m[1].total_cmp(&n[1]))
        });
    }

    /// Softens the picture by the weights 1, 2, 1 both ways, and lifts its dark.
    fn soften(&mut self, picture: &Grey) {
        let (width, height) = (picture.width as usize, picture.height as usize);
        let row = |y: usize| picture.values.get(y * width..(y + 1) * width).unwrap_or_default();
        self.softened.clear();
        self.softened.reserve(width * height);
        let mut upright = vec![0_u16; width];
        for y in 0..height {
            let (above, here, below) = (row(y.saturating_sub(1)), row(y), row((y + 1).min(height - 1)));
            for (sum, ((a, h), b)) in upright.iter_mut().zip(above.iter().zip(here).zip(below)) {
                *sum = u16::from(*a) + 2 * u16::from(*h) + u16::from(*b);
            }
            let at = |x: usize| upright.get(x).copied().unwrap_or_default();
            self.softened.extend((0..width).map(|x| {
                let sum = at(x.saturating_sub(1)) + 2 * at(x) + at((x + 1).min(width - 1));
                DISPLAY.get(usize::from((sum + 8) / 16)).copied().unwrap_or(u8::MAX)
            }));
        }
    }

    /// The picture with its last column and row repeated up to whole tiles.
    fn pad(&mut self, picture: &Grey, lifted: bool, across: usize, down: usize) {
        self.padded.clear();
        let width = picture.width as usize;
        if lifted {
            self.soften(picture);
        }
        let values = if lifted { &self.softened } else { &picture.values };
        for row in values.chunks_exact(width) {
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
