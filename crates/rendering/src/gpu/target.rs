//! What pictures are drawn into, and how they come back from the device.

use crate::gpu::passes::frame::depth_texture;
use crate::{Error, Gpu};
use std::sync::mpsc;
use vocabulary::Picture;
use wgpu::{Device, Texture, TextureFormat, TextureUsages, TextureView};

/// Largest side of a picture, pixels.
const MOST: u32 = 8192;
const LEAST: u32 = 16;

/// Format of pictures in memory: sRGB bytes; the shaders encode.
pub(crate) const PICTURE_FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;

/// Refuses sizes that no picture has.
pub(crate) fn check_size(gpu: &Gpu, width: u32, height: u32) -> Result<(), Error> {
    let most = MOST.min(gpu.device.limits().max_texture_dimension_2d);
    let fine = LEAST..=most;
    if fine.contains(&width) && fine.contains(&height) {
        return Ok(());
    }
    Err(Error::Size { width, height, most })
}

/// Colour with its samples, and depth.
#[derive(Debug)]
pub(crate) struct Attachments {
    /// Several samples a pixel; `None` where there is one and the target itself is drawn into.
    pub(crate) sampled: Option<TextureView>,
    pub(crate) depth: TextureView,
}

impl Attachments {
    pub(crate) fn new(device: &Device, size: [u32; 2], format: TextureFormat, samples: u32) -> Self {
        let sampled =
            (samples > 1).then(|| view(&colour(device, size, format, samples, TextureUsages::empty())));
        Self { sampled, depth: depth_texture(device, size, samples, false) }
    }

    /// A pass that clears and then draws into `target`.
    pub(crate) fn begin<'a>(
        &self,
        encoder: &'a mut wgpu::CommandEncoder,
        target: &TextureView,
        clear: wgpu::Color,
    ) -> wgpu::RenderPass<'a> {
        let sampled = self.sampled.as_ref();
        let store = if sampled.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("world"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: sampled.unwrap_or(target),
                depth_slice: None,
                resolve_target: sampled.map(|_| target),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }
}

fn view(texture: &Texture) -> TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn colour(
    device: &Device,
    size: [u32; 2],
    format: TextureFormat,
    samples: u32,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::RENDER_ATTACHMENT | usage,
        view_formats: &[],
    })
}

/// A picture on the device and the buffer through which it comes back.
#[derive(Debug)]
pub(crate) struct Offscreen {
    texture: Texture,
    pub(crate) view: TextureView,
    buffer: wgpu::Buffer,
    pitch: u32,
    /// Whether blue comes before red.
    swapped: bool,
}

impl Offscreen {
    /// Of a `format` with four bytes a pixel.
    pub(crate) fn new(device: &Device, [width, height]: [u32; 2], format: TextureFormat) -> Self {
        let texture = colour(device, [width, height], format, 1, TextureUsages::COPY_SRC);
        let pitch = (4 * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: u64::from(pitch) * u64::from(height),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let swapped = format == TextureFormat::Bgra8Unorm;
        Self { view: view(&texture), texture, buffer, pitch, swapped }
    }

    /// Copies the picture into the buffer once it is drawn.
    pub(crate) fn copy(&self, encoder: &mut wgpu::CommandEncoder) {
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(self.pitch), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            self.texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &self.buffer, layout },
            self.texture.size(),
        );
    }

    /// Waits for the submission and takes the picture out of the buffer.
    pub(crate) fn read(&self, gpu: &Gpu, submission: wgpu::SubmissionIndex) -> Result<Picture, Error> {
        let size = self.texture.size();
        let row = 4 * size.width as usize;
        let mut rgba = Vec::with_capacity(row * size.height as usize);
        mapped(gpu, &self.buffer, submission, |bytes| {
            for line in bytes.chunks(self.pitch as usize) {
                rgba.extend_from_slice(&line[..row]);
            }
        })?;
        if self.swapped {
            rgba.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
        }
        Ok(Picture { width: size.width, height: size.height, rgba })
    }
}

/// Waits for the submission and shows what it has put into the buffer.
pub(crate) fn mapped(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    submission: wgpu::SubmissionIndex,
    look: impl FnOnce(&[u8]),
) -> Result<(), Error> {
    let (sender, receiver) = mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |result| {
        // Nobody listens any more only where reading has already failed.
        let _ = sender.send(result);
    });
    let failed = |e: &dyn std::fmt::Display| Error::Device(e.to_string());
    gpu.device
        .poll(wgpu::PollType::Wait { submission_index: Some(submission), timeout: None })
        .map_err(|e| failed(&e))?;
    gpu.check()?;
    receiver.recv().map_err(|e| failed(&e))?.map_err(|e| failed(&e))?;
    look(&buffer.get_mapped_range(..).map_err(|e| failed(&e))?);
    buffer.unmap();
    Ok(())
}
