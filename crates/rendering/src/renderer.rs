//! Moments to pictures. The passes stand in `encode` in the order in which they run.

use crate::camera::Camera;
use crate::compose::{frame, local_origin, sun_over, towards_sun, words};
use crate::crowd::crowd;
use crate::labels::{Window, detail};
use crate::paint::{Stage, paint, paint_over};
use crate::palette::{Rgb, robot_colours};
use crate::passes::Canvas;
use crate::passes::decal::{Corner, DecalPass};
use crate::passes::frame::{Frame, FrameGroups};
use crate::passes::ground::GroundPass;
use crate::passes::overlay::{OverlayPass, Shapes};
use crate::passes::robot::{Crowd, Models, RobotPass};
use crate::passes::shadow::ShadowPass;
use crate::passes::sky::SkyPass;
use crate::passes::text::{Line, TextPass};
use crate::target::{Attachments, Offscreen, PICTURE_FORMAT, check_size};
use crate::{Error, Gpu, Layout, Style, Trail, View, view::Tile};
use std::ops::Range;
use vocabulary::{Cast, Moment, Picture};
use wgpu::TextureFormat;

/// Draws moments of one cast at one size.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    cast: Cast,
    colours: Vec<Rgb>,
    size: (u32, u32),
    canvas: Canvas,
    attachments: Attachments,
    passes: Passes,
    /// Two, so that one picture can be drawn while the one before is read.
    offscreen: Vec<Offscreen>,
    waiting: Option<(usize, wgpu::SubmissionIndex)>,
}

#[derive(Debug)]
struct Passes {
    groups: FrameGroups,
    models: Models,
    shadow: ShadowPass,
    robot: RobotPass,
    ground: GroundPass,
    decal: DecalPass,
    sky: SkyPass,
    overlay: OverlayPass,
    text: TextPass,
}

impl Passes {
    fn new(gpu: &Gpu, canvas: Canvas, robots: usize) -> Self {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let flat = Canvas { samples: 1, ..canvas };
        let mut text = TextPass::new(device, queue, flat);
        let map = ShadowPass::map(device, robots);
        let groups = FrameGroups::new(device, &map.0);
        let digits = text.digits();
        Self {
            models: Models::new(device, queue, robots),
            shadow: ShadowPass::new(device, &groups, map),
            robot: RobotPass::new(device, queue, canvas, &groups, digits),
            ground: GroundPass::new(device, queue, canvas, &groups),
            decal: DecalPass::new(device, canvas, &groups),
            sky: SkyPass::new(device, canvas, &groups),
            overlay: OverlayPass::new(device, flat),
            text,
            groups,
        }
    }
}

/// What a picture consists of, once its data is on the device.
struct Prepared {
    crowd: Crowd,
    tiles: Vec<Tile>,
    /// Under the robots and over them.
    decals: Vec<[Range<u32>; 2]>,
    /// Whether a view shows ghosts: near the ground they would veil what is behind them.
    ghosts: Vec<bool>,
    shapes: Shapes,
}

impl Renderer {
    /// A renderer of pictures in memory; `samples` per pixel are 4, or 1 for speed.
    ///
    /// # Errors
    /// [`Error::Size`] or [`Error::Samples`] for what cannot be drawn, [`Error::Device`] where the device fails.
    pub fn new(gpu: &Gpu, cast: &Cast, width: u32, height: u32, samples: u32) -> Result<Self, Error> {
        Self::with_format(gpu, cast, width, height, samples, PICTURE_FORMAT)
    }

    /// A renderer into textures of `format`, for a window's surface. The shaders write sRGB-encoded values, so
    /// the format must not encode again (`Bgra8Unorm`, not `Bgra8UnormSrgb`).
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn with_format(
        gpu: &Gpu,
        cast: &Cast,
        width: u32,
        height: u32,
        samples: u32,
        format: TextureFormat,
    ) -> Result<Self, Error> {
        check_size(gpu, width, height)?;
        if !matches!(samples, 1 | 4) {
            return Err(Error::Samples(samples));
        }
        let canvas = Canvas { format, samples };
        let renderer = Self {
            gpu: gpu.clone(),
            cast: cast.clone(),
            colours: robot_colours(cast),
            size: (width, height),
            canvas,
            attachments: Attachments::new(&gpu.device, (width, height), format, samples),
            passes: Passes::new(gpu, canvas, cast.members.len()),
            offscreen: Vec::new(),
            waiting: None,
        };
        gpu.check()?;
        Ok(renderer)
    }

    /// Width and height of the pictures, pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Changes the size of the pictures.
    ///
    /// # Errors
    /// [`Error::Size`] for sizes that cannot be drawn.
    pub fn resize(&mut self, width: u32, height: u32) -> Result<(), Error> {
        check_size(&self.gpu, width, height)?;
        if self.size != (width, height) {
            self.size = (width, height);
            self.attachments =
                Attachments::new(&self.gpu.device, self.size, self.canvas.format, self.canvas.samples);
            self.offscreen.clear();
            self.waiting = None;
        }
        Ok(())
    }

    /// The picture of a moment.
    ///
    /// # Errors
    /// [`Error::Cast`] for a moment of other robots, [`Error::Device`] where the device fails.
    pub fn draw(
        &mut self,
        trail: &Trail,
        moment: &Moment,
        layout: &Layout,
        style: &Style,
    ) -> Result<Picture, Error> {
        let (slot, submission) = self.submit(trail, moment, layout, style)?;
        self.offscreen[slot].read(&self.gpu, submission)
    }

    /// Starts the picture of a moment and returns the one started before, if any: for films, where the device
    /// draws while the picture before is read and encoded. [`Renderer::finish`] returns the last.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn draw_next(
        &mut self,
        trail: &Trail,
        moment: &Moment,
        layout: &Layout,
        style: &Style,
    ) -> Result<Option<Picture>, Error> {
        let next = self.submit(trail, moment, layout, style)?;
        let before = self.waiting.replace(next);
        before.map(|(slot, submission)| self.offscreen[slot].read(&self.gpu, submission)).transpose()
    }

    /// The picture that [`Renderer::draw_next`] started last, if any.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn finish(&mut self) -> Result<Option<Picture>, Error> {
        let last = self.waiting.take();
        last.map(|(slot, submission)| self.offscreen[slot].read(&self.gpu, submission)).transpose()
    }

    /// Draws a moment into a texture of the renderer's format and size, such as a window's.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn draw_into(
        &mut self,
        target: &wgpu::TextureView,
        trail: &Trail,
        moment: &Moment,
        layout: &Layout,
        style: &Style,
    ) -> Result<wgpu::SubmissionIndex, Error> {
        let prepared = self.prepare(trail, moment, layout, style)?;
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.encode(&mut encoder, target, &prepared)?;
        let submission = self.gpu.queue.submit([encoder.finish()]);
        self.gpu.check()?;
        Ok(submission)
    }

    fn submit(
        &mut self,
        trail: &Trail,
        moment: &Moment,
        layout: &Layout,
        style: &Style,
    ) -> Result<(usize, wgpu::SubmissionIndex), Error> {
        let slot = self.waiting.as_ref().map_or(0, |(busy, _)| 1 - busy);
        let prepared = self.prepare(trail, moment, layout, style)?;
        while self.offscreen.len() <= slot {
            self.offscreen.push(Offscreen::new(&self.gpu.device, self.size));
        }
        let offscreen = &self.offscreen[slot];
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.encode(&mut encoder, &offscreen.view, &prepared)?;
        offscreen.copy(&mut encoder);
        let submission = self.gpu.queue.submit([encoder.finish()]);
        self.gpu.check()?;
        Ok((slot, submission))
    }

    /// Computes what the picture consists of and brings it to the device.
    fn prepare(
        &mut self,
        trail: &Trail,
        moment: &Moment,
        layout: &Layout,
        style: &Style,
    ) -> Result<Prepared, Error> {
        self.check(moment)?;
        let (width, height) = self.size;
        let tiles = layout.tiles(width, height);
        let aspect = |tile: &Tile| f64::from(tile.width) / f64::from(tile.height);
        let cameras: Vec<_> = layout
            .views
            .iter()
            .zip(&tiles)
            .map(|(view, tile)| {
                Camera::of(view, &trail.steady, &moment.snapshot, &self.cast.edges, aspect(tile))
            })
            .collect();
        let stage = Stage {
            cast: &self.cast,
            colours: &self.colours,
            trail,
            moment,
            style,
            origin: local_origin(moment),
            sun: towards_sun(&self.cast.light),
            detail: detail(self.cast.members.len()),
        };
        let crowd = crowd(&stage);
        let sun = sun_over(&stage);
        let frames: Vec<_> = cameras
            .iter()
            .map(|camera| frame(camera, &stage, &sun, self.passes.shadow.penumbra(&sun)))
            .collect();
        let mut corners = Vec::new();
        let mut decals = Vec::new();
        for ((view, camera), tile) in layout.views.iter().zip(&cameras).zip(&tiles) {
            let mut add = |more: Vec<Corner>| {
                let first = corners.len() as u32;
                corners.extend(more);
                first..corners.len() as u32
            };
            let height = f64::from(tile.height);
            decals.push([add(paint(&stage, view, camera, height)), add(paint_over(&stage, camera, height))]);
        }
        let windows: Vec<_> =
            cameras.iter().zip(&tiles).map(|(camera, tile)| Window { camera, tile: *tile }).collect();
        let (lines, shapes) = words(&mut self.passes.text, &stage, layout, &windows, height);
        self.upload(&frames, &crowd, &corners, &shapes, &lines)?;
        let ghosts = layout.views.iter().map(|view| !matches!(view, View::SnakeEye)).collect();
        Ok(Prepared { crowd, tiles, decals, ghosts, shapes })
    }

    fn check(&self, moment: &Moment) -> Result<(), Error> {
        let robots = (moment.snapshot.robots.len(), self.cast.members.len());
        let edges = (moment.edges.len(), self.cast.edges.len());
        for (what, (got, want)) in [("robots", robots), ("edges", edges)] {
            if got != want {
                return Err(Error::Cast { what, got, want });
            }
        }
        Ok(())
    }

    fn upload(
        &mut self,
        frames: &[Frame],
        crowd: &Crowd,
        corners: &[Corner],
        shapes: &Shapes,
        lines: &[Line],
    ) -> Result<(), Error> {
        let (device, queue) = (&self.gpu.device, &self.gpu.queue);
        let (width, height) = self.size;
        let passes = &mut self.passes;
        passes.groups.fill(queue, frames);
        passes.models.fill(device, queue, crowd);
        passes.decal.fill(device, queue, corners);
        passes.overlay.fill(device, queue, [width as f32, height as f32], shapes);
        passes.text.fill(device, queue, [width, height], lines).map_err(|e| Error::Device(e.to_string()))
    }

    fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        prepared: &Prepared,
    ) -> Result<(), Error> {
        let passes = &self.passes;
        passes.shadow.draw(encoder, &passes.groups, &passes.models, &prepared.crowd);
        self.encode_world(encoder, target, prepared);
        self.encode_overlay(encoder, target, prepared)
    }

    /// Ground and sky are painted first and without depth: robots cover little of them, and on processors the
    /// depth test of every pixel would cost more than shading the few that are hidden.
    fn encode_world(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        prepared: &Prepared,
    ) {
        let passes = &self.passes;
        let sampled = self.attachments.sampled.as_ref();
        let store = if sampled.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("world"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: sampled.unwrap_or(target),
                depth_slice: None,
                resolve_target: sampled.map(|_| target),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.attachments.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        for (index, (tile, [under, over])) in prepared.tiles.iter().zip(&prepared.decals).enumerate() {
            let [x, y, width, height] = [tile.x, tile.y, tile.width, tile.height].map(|n| n as f32);
            pass.set_viewport(x, y, width, height, 0.0, 1.0);
            pass.set_scissor_rect(tile.x, tile.y, tile.width, tile.height);
            pass.set_bind_group(0, &passes.groups.view, &[FrameGroups::offset(index)]);
            pass.set_bind_group(1, &passes.groups.light, &[]);
            passes.sky.draw(&mut pass);
            passes.ground.draw(&mut pass);
            passes.decal.draw(&mut pass, under.clone());
            passes.robot.draw_solid(&mut pass, &passes.models, &prepared.crowd);
            if prepared.ghosts[index] {
                passes.robot.draw_ghosts(&mut pass, &passes.models, &prepared.crowd);
            }
            passes.decal.draw(&mut pass, over.clone());
        }
        // On GL the samples are resolved at the end of the pass within whatever scissor is set then.
        pass.set_scissor_rect(0, 0, self.size.0, self.size.1);
    }

    fn encode_overlay(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        prepared: &Prepared,
    ) -> Result<(), Error> {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("overlay"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: target,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        self.passes.overlay.draw(&mut pass, &prepared.shapes);
        self.passes.text.draw(&mut pass).map_err(|e| Error::Device(e.to_string()))
    }
}
