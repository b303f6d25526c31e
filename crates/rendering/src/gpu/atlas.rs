//! One texture for the pictures of many cameras, and how they come back from the device together.

use crate::camera::viewpoint::Tile;
use crate::gpu::passes::Canvas;
use crate::gpu::target::{Attachments, Readback};
use crate::{Error, Gpu};
use vocabulary::Grey;
use wgpu::TextureFormat;

/// Linear light, a byte a pixel.
pub(crate) const CANVAS: Canvas = Canvas { format: TextureFormat::R8Unorm, samples: 4, mono: true };
/// Sizes are multiples of this, pixels, so that regions that grow a little fit what is there.
const STEP: u32 = 64;
/// Places for rectangles of the given sizes in an area, and its width and height.
pub(crate) fn pack(sizes: &[[u32; 2]], most: u32) -> Option<(Vec<Tile>, [u32; 2])> {
    let area: f64 = sizes.iter().map(|[w, h]| f64::from(*w) * f64::from(*h)).sum();
    let widest = sizes.iter().map(|[w, _]| *w).max()?;
    // A little wider than high: what is left over at the ends of rows is drawn as well.
    let wide = ((1.3 * area).sqrt() as u32).max(widest).next_multiple_of(STEP).min(most);
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|k| std::cmp::Reverse(sizes[*k][1]));
    let mut tiles = vec![Tile { x: 0, y: 0, width: 0, height: 0 }; sizes.len()];
    let (mut x, mut y, mut row, mut used) = (0, 0, 0, 0);
    for k in order {
        let [width, height] = sizes[k];
        if x + width > wide {
            (x, y, row) = (0, y + row, 0);
        }
        tiles[k] = Tile { x, y, width, height };
        x += width;
        used = used.max(x);
        row = row.max(height);
    }
    let size = [used, y + row].map(|n| n.next_multiple_of(STEP).min(most));
    (widest <= most && y + row <= most).then_some((tiles, size))
}

/// Attachments of a size, and the texture that is read.
#[derive(Debug)]
pub(crate) struct Atlas {
    pub(crate) attachments: Attachments,
    pub(crate) readback: Readback,
}

impl Atlas {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        Self {
            attachments: Attachments::new(gpu, size, CANVAS),
            readback: Readback::new(gpu, size, CANVAS.format, 1),
        }
    }

    /// Whether it holds an area without wasting much of its own.
    pub(crate) fn suits(&self, [width, height]: [u32; 2]) -> bool {
        let [w, h] = self.attachments.size;
        let area = |width: u32, height: u32| u64::from(width) * u64::from(height);
        w >= width && h >= height && 4 * area(w, h) <= 5 * area(width, height)
    }

    /// Waits for the submission and takes the pictures out of the buffer.
    pub(crate) fn read(
        &mut self,
        gpu: &Gpu,
        submission: wgpu::SubmissionIndex,
        tiles: &[Tile],
        pictures: &mut [Grey],
    ) -> Result<(), Error> {
        self.readback.read(gpu, submission, |rows| {
            for (tile, picture) in tiles.iter().zip(pictures) {
                (picture.width, picture.height) = (tile.width, tile.height);
                picture.values.clear();
                let [x, y, width, height] = [tile.x, tile.y, tile.width, tile.height].map(|n| n as usize);
                let rows = rows.clone().skip(y).take(height);
                rows.for_each(|row| picture.values.extend_from_slice(&row[x..x + width]));
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_rectangles_lie_apart_and_waste_little() {
        for sizes in
            [vec![[220, 160]; 7], vec![[640, 480]; 7], vec![[4096, 3000]], vec![[1, 1], [900, 20], [30, 700]]]
        {
            let (tiles, [width, height]) = pack(&sizes, 8192).unwrap();
            for (k, a) in tiles.iter().enumerate() {
                assert_eq!([a.width, a.height], sizes[k]);
                assert!(a.x + a.width <= width && a.y + a.height <= height);
                let apart = |b: &Tile| {
                    a.x + a.width <= b.x
                        || b.x + b.width <= a.x
                        || a.y + a.height <= b.y
                        || b.y + b.height <= a.y
                };
                assert!(tiles[k + 1..].iter().all(apart));
            }
            let area: u32 = sizes.iter().map(|[w, h]| w * h).sum();
            assert!(sizes.len() == 3 || width * height < area * 3 / 2, "{width} {height} {area}");
        }
        assert!(pack(&[[5000, 100]], 4096).is_none() && pack(&[], 4096).is_none());
    }
}
