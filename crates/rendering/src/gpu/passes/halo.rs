//! Halos that keep text readable on any ground: each glyph's own, one quad, as wide as the size of the text asks for.

use super::text::TextLine;
use glyphon::{
    Buffer, CacheKey, ContentType, CustomGlyph, FontSystem, RasterizeCustomGlyphRequest,
    RasterizedCustomGlyph, SwashCache, SwashContent, SwashImage,
};
use std::collections::HashMap;

/// So many halos of different glyphs are kept.
const KEPT: usize = 8192;

/// A glyph's halo: where it lies from the glyph's own place, and how much each pixel has of it.
#[derive(Debug, Clone, PartialEq)]
struct Halo {
    id: u16,
    left: i32,
    top: i32,
    size: [usize; 2],
    cover: Vec<u8>,
}

/// The halos that were drawn.
#[derive(Debug, Default)]
pub(super) struct Halos {
    /// By glyph and reach; `None` for a glyph without ink.
    known: HashMap<(CacheKey, u32), Option<Halo>>,
    /// Their keys, by their number.
    keys: Vec<(CacheKey, u32)>,
}

impl Halos {
    /// Whether all of them should be forgotten, together with the atlas that holds them.
    pub(super) fn full(&self) -> bool {
        self.keys.len() >= KEPT
    }

    /// Adds the halos of a line whose upper left corner is at `corner`, pixels.
    pub(super) fn add(
        &mut self,
        fonts: &mut FontSystem,
        glyphs: &mut SwashCache,
        line: &TextLine,
        buffer: &Buffer,
        corner: [f32; 2],
        halos: &mut Vec<CustomGlyph>,
    ) {
        let (strength, colour) = line.halo;
        if strength <= 0.0 {
            return;
        }
        let reach = (line.size / 13.0 * 1.4).max(1.0);
        let color = Some(super::text::colour(colour, strength * line.alpha));
        for run in buffer.layout_runs() {
            for glyph in run.glyphs {
                let place = glyph.physical((corner[0], corner[1]), 1.0);
                let key = (place.cache_key, reach.to_bits());
                let keys = &mut self.keys;
                let known = self.known.entry(key).or_insert_with(|| {
                    let image = glyphs.get_image_uncached(fonts, place.cache_key)?;
                    let halo = Halo { id: u16::try_from(keys.len()).ok()?, ..around(&image, reach)? };
                    keys.push(key);
                    Some(halo)
                });
                let Some(Halo { id, left, top, size, .. }) = known else { continue };
                halos.push(CustomGlyph {
                    id: *id,
                    left: (place.x + *left) as f32,
                    top: (run.line_y.round() as i32 + place.y + *top) as f32,
                    width: size[0] as f32,
                    height: size[1] as f32,
                    color,
                    snap_to_physical_pixel: true,
                    metadata: 0,
                });
            }
        }
    }

    /// What the atlas asks for.
    pub(super) fn rasterize(&self, request: RasterizeCustomGlyphRequest) -> Option<RasterizedCustomGlyph> {
        let halo = self.known.get(self.keys.get(usize::from(request.id))?)?.as_ref()?;
        Some(RasterizedCustomGlyph { data: halo.cover.clone(), content_type: ContentType::Mask })
    }
}

/// The halo of a glyph: all that is nearer to its ink than `reach`, pixels.
fn around(image: &SwashImage, reach: f32) -> Option<Halo> {
    let ink = cover(image);
    let [width, height] = [image.placement.width as usize, image.placement.height as usize];
    if ink.len() != width * height || ink.is_empty() {
        return None;
    }
    let rim = (reach + 0.5).floor() as usize;
    let size = [width + 2 * rim, height + 2 * rim];
    let mut cover = vec![0_u8; size[0] * size[1]];
    for down in 0..=2 * rim {
        for across in 0..=2 * rim {
            let away = (across as f32 - rim as f32).hypot(down as f32 - rim as f32);
            let near = (reach + 0.5 - away).clamp(0.0, 1.0);
            if near <= 0.0 {
                continue;
            }
            for (row, inks) in ink.chunks_exact(width).enumerate() {
                let from = (row + down) * size[0] + across;
                for (cover, ink) in cover[from..from + width].iter_mut().zip(inks) {
                    *cover = (*cover).max((f32::from(*ink) * near).round() as u8);
                }
            }
        }
    }
    let rim = rim as i32;
    Some(Halo { id: 0, left: image.placement.left - rim, top: -image.placement.top - rim, size, cover })
}

/// How much ink each pixel of a glyph has; a picture, as some fonts have, counts by its opacity.
fn cover(image: &SwashImage) -> Vec<u8> {
    match image.content {
        SwashContent::Mask => image.data.clone(),
        SwashContent::Color | SwashContent::SubpixelMask => {
            image.data.chunks_exact(4).map(|pixel| pixel[3]).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_halo_is_round_and_as_wide_as_it_should_be() {
        let mut image = SwashImage::new();
        image.content = SwashContent::Mask;
        (image.placement.left, image.placement.top) = (3, 7);
        (image.placement.width, image.placement.height) = (1, 1);
        image.data = vec![255];
        let halo = around(&image, 1.4).unwrap();
        // 255 (1.4 + ½ − √2) at the corners, 255 (1.4 + ½ − 1) at the sides.
        let corner = 124;
        assert_eq!((halo.left, halo.top, halo.size), (2, -8, [3, 3]));
        assert_eq!(halo.cover, [corner, 230, corner, 230, 255, 230, corner, 230, corner]);
        // A space has none.
        image.placement.width = 0;
        image.data.clear();
        assert_eq!(around(&image, 1.4), None);
    }
}
