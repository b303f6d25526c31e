//! What pictures are drawn into, and how they come back from the device.

use crate::camera::viewpoint::Tile;
use crate::gpu::passes::{Canvas, DEPTH};
use crate::gpu::resources::{flat_texture, rows};
use crate::{Error, Gpu};
use std::sync::mpsc;
use vocabulary::Picture;
use wgpu::{
    BufferUsages, RenderPass, Texture, TextureDescriptor, TextureFormat, TextureUsages, TextureView,
    TextureViewDescriptor,
};

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
    /// Width and height, pixels.
    pub(crate) size: [u32; 2],
    pub(crate) canvas: Canvas,
    /// Several samples a pixel; `None` where there is one and the target itself is drawn into.
    sampled: Option<TextureView>,
    depth: TextureView,
}

impl Attachments {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2], canvas: Canvas) -> Self {
        let attachment = |format: TextureFormat| {
            let flat = flat_texture("attachment", size, format, TextureUsages::RENDER_ATTACHMENT);
            let descriptor = TextureDescriptor { sample_count: canvas.samples, ..flat };
            gpu.device.create_texture(&descriptor).create_view(&TextureViewDescriptor::default())
        };
        let sampled = (canvas.samples > 1).then(|| attachment(canvas.format));
        Self { size, canvas, sampled, depth: attachment(DEPTH) }
    }

    /// Draws into `target`, over what is in it or after it is cleared.
    pub(crate) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &TextureView,
        load: wgpu::LoadOp<wgpu::Color>,
        draw: impl FnOnce(&mut RenderPass<'_>),
    ) {
        let sampled = self.sampled.as_ref();
        let store = if sampled.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("world"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: sampled.unwrap_or(target),
                depth_slice: None,
                resolve_target: sampled.map(|_| target),
                ops: wgpu::Operations { load, store },
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
        });
        draw(&mut pass);
        // On GL the samples are resolved at the end of the pass within whatever scissor is set then.
        pass.set_scissor_rect(0, 0, self.size[0], self.size[1]);
    }
}

/// Confines a pass to a tile, and its depths to a part of those from 0 to 1.
pub(crate) fn confine(pass: &mut RenderPass<'_>, tile: &Tile, [near, far]: [f32; 2]) {
    let [x, y, width, height] = tile.area();
    pass.set_viewport(x, y, width, height, near, far);
    pass.set_scissor_rect(tile.x, tile.y, tile.width, tile.height);
}

/// A texture to draw into and the buffer through which its pixels come back.
#[derive(Debug)]
pub(crate) struct Readback {
    texture: Texture,
    pub(crate) view: TextureView,
    buffer: wgpu::Buffer,
    /// Bytes from one row in the buffer to the next.
    pitch: u32,
    /// What the device answers once the buffer can be read.
    asked: Option<mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>>,
}

impl Readback {
    /// Of a `format` with `depth` bytes a pixel.
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2], format: TextureFormat, depth: u32) -> Self {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
        let texture = gpu.device.create_texture(&flat_texture("picture", size, format, usage));
        let pitch = (depth * size[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(pitch) * u64::from(size[1]);
        Self {
            view: texture.create_view(&TextureViewDescriptor::default()),
            buffer: gpu.buffer("readback", bytes, BufferUsages::MAP_READ | BufferUsages::COPY_DST),
            texture,
            pitch,
            asked: None,
        }
    }

    /// Copies the texture into the buffer once it is drawn.
    pub(crate) fn copy(&self, encoder: &mut wgpu::CommandEncoder) {
        let buffer = wgpu::TexelCopyBufferInfo { buffer: &self.buffer, layout: rows(self.pitch) };
        encoder.copy_texture_to_buffer(self.texture.as_image_copy(), buffer, self.texture.size());
    }

    /// Waits for the submission and shows the rows that it has put into the buffer.
    pub(crate) fn read(
        &mut self,
        gpu: &Gpu,
        submission: wgpu::SubmissionIndex,
        look: impl FnOnce(std::slice::Chunks<'_, u8>),
    ) -> Result<(), Error> {
        self.wait(gpu, submission)?;
        self.look(look)
    }

    /// Waits for the submission and takes the picture, of four bytes a pixel, out of the buffer.
    pub(crate) fn picture(&mut self, gpu: &Gpu, submission: wgpu::SubmissionIndex) -> Result<Picture, Error> {
        self.wait(gpu, submission)?;
        self.taken()
    }

    /// The picture, of four bytes a pixel, if what was submitted is finished; it does not wait.
    pub(crate) fn arrived(&mut self, gpu: &Gpu) -> Result<Option<Picture>, Error> {
        let asked = self.ask();
        gpu.device.poll(wgpu::PollType::Poll).map_err(failed)?;
        gpu.check()?;
        match asked.try_recv() {
            Err(mpsc::TryRecvError::Empty) => {
                self.asked = Some(asked);
                return Ok(None);
            }
            answer => answer.map_err(failed)?.map_err(failed)?,
        }
        self.taken().map(Some)
    }

    fn wait(&mut self, gpu: &Gpu, submission: wgpu::SubmissionIndex) -> Result<(), Error> {
        let asked = self.ask();
        gpu.device
            .poll(wgpu::PollType::Wait { submission_index: Some(submission), timeout: None })
            .map_err(failed)?;
        gpu.check()?;
        asked.recv().map_err(failed)?.map_err(failed)
    }

    /// Asks for the buffer, unless it is asked for already.
    fn ask(&mut self) -> mpsc::Receiver<Result<(), wgpu::BufferAsyncError>> {
        self.asked.take().unwrap_or_else(|| {
            let (sender, receiver) = mpsc::channel();
            self.buffer.map_async(wgpu::MapMode::Read, .., move |result| {
                // The receiver is gone only if reading has already failed.
                let _ = sender.send(result);
            });
            receiver
        })
    }

    /// Shows the rows of the buffer, which can be read, and gives it back to the device.
    fn look(&self, look: impl FnOnce(std::slice::Chunks<'_, u8>)) -> Result<(), Error> {
        look(self.buffer.get_mapped_range(..).map_err(failed)?.chunks(self.pitch as usize));
        self.buffer.unmap();
        Ok(())
    }

    /// The picture in the buffer, which can be read.
    fn taken(&self) -> Result<Picture, Error> {
        let size = self.texture.size();
        let row = 4 * size.width as usize;
        let mut rgba = Vec::with_capacity(row * size.height as usize);
        self.look(|rows| rows.for_each(|line| rgba.extend_from_slice(&line[..row])))?;
        if self.texture.format() == TextureFormat::Bgra8Unorm {
            rgba.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
        }
        Ok(Picture { width: size.width, height: size.height, rgba })
    }
}

fn failed(why: impl std::fmt::Display) -> Error {
    Error::Device(why.to_string())
}
