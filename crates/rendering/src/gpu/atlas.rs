//! One texture for the pictures of many cameras, and how they come back from the device together.

use crate::camera::viewpoint::Tile;
use crate::gpu::passes::Canvas;
use crate::gpu::target::{Attachments, mapped};
use crate::{Error, Gpu};
use vocabulary::Grey;
use wgpu::{TextureFormat, TextureUsages};

/// Linear light, a byte a pixel.
pub(crate) const CANVAS: Canvas = Canvas { format: TextureFormat::R8Unorm, samples: 4, mono: true };
/// Sizes are multiples of this, pixels, so that regions that grow a little fit what is there.
const STEP: u32 = 64;
/// Rows come back in multiples of so many bytes.
const PITCH: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

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

/// Attachments of a size, and the buffer behind them.
#[derive(Debug)]
pub(crate) struct Atlas {
    pub(crate) size: [u32; 2],
    pub(crate) attachments: Attachments,
    pub(crate) view: wgpu::TextureView,
    texture: wgpu::Texture,
    buffer: wgpu::Buffer,
    pitch: u32,
}

impl Atlas {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let device = &gpu.device;
        let [width, height] = size;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("eyes"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: CANVAS.format,
            usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let pitch = width.next_multiple_of(PITCH);
        Self {
            size,
            attachments: Attachments::new(device, [width, height], CANVAS.format, CANVAS.samples),
            view: texture.create_view(&wgpu::TextureViewDescriptor::default()),
            texture,
            buffer: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("eyes"),
                size: u64::from(pitch) * u64::from(height),
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            pitch,
        }
    }

    /// Whether it holds an area without wasting much of its own.
    pub(crate) fn suits(&self, [width, height]: [u32; 2]) -> bool {
        let [w, h] = self.size.map(u64::from);
        let wanted = u64::from(width) * u64::from(height);
        self.size[0] >= width && self.size[1] >= height && 4 * w * h <= 5 * wanted
    }

    /// Copies the pictures into the buffer once they are drawn.
    pub(crate) fn copy(&self, encoder: &mut wgpu::CommandEncoder) {
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(self.pitch), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            self.texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &self.buffer, layout },
            self.texture.size(),
        );
    }

    /// Waits for the submission and takes the pictures out of the buffer.
    pub(crate) fn read(
        &self,
        gpu: &Gpu,
        submission: wgpu::SubmissionIndex,
        tiles: &[Tile],
        pictures: &mut [Grey],
    ) -> Result<(), Error> {
        mapped(gpu, &self.buffer, submission, |bytes| {
            for (tile, picture) in tiles.iter().zip(pictures) {
                (picture.width, picture.height) = (tile.width, tile.height);
                picture.values.clear();
                let [x, y, width, height] = [tile.x, tile.y, tile.width, tile.height].map(|n| n as usize);
                let rows = bytes.chunks(self.pitch as usize).skip(y).take(height);
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
