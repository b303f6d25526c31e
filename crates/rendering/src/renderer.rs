//! Moments to pictures.

use crate::camera::Camera;
use crate::compose::{frame, local_origin, shadowed, sun_over, towards_sun, veiled_decks, words};
use crate::crowd::{Fleet, crowd, part};
use crate::encode::{Passes, Prepared, Surface};
use crate::floor::Floor;
use crate::labels::{Window, detail};
use crate::paint::{Stage, paint};
use crate::palette::{Rgb, robot_colours};
use crate::passes::Canvas;
use crate::passes::decal::{Corner, Layer};
use crate::pick::pick;
use crate::props::props;
use crate::target::{Attachments, Offscreen, PICTURE_FORMAT, check_size};
use crate::{
    Error, Gpu, Layout, Picked, Sightline, Style, Trail, View,
    view::{Tile, corner},
};
use vocabulary::{Cast, Moment, Picture};
use wgpu::TextureFormat;

/// Draws moments of one cast at one size.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    cast: Cast,
    colours: Vec<Rgb>,
    fleet: Fleet,
    floor: Floor,
    size: (u32, u32),
    canvas: Canvas,
    attachments: Attachments,
    passes: Passes,
    /// Two, so that one picture can be drawn while the one before is read.
    offscreen: Vec<Offscreen>,
    waiting: Option<(usize, wgpu::SubmissionIndex)>,
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
        let canvas = Canvas { format, samples, mono: false };
        let fleet = Fleet::new(cast);
        let floor = Floor::new(cast);
        let passes = Passes::new(gpu, canvas, cast, &fleet, &floor);
        let renderer = Self {
            gpu: gpu.clone(),
            cast: cast.clone(),
            colours: robot_colours(cast),
            fleet,
            floor,
            size: (width, height),
            canvas,
            attachments: Attachments::new(&gpu.device, (width, height), format, samples),
            passes,
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

    /// Changes title and caption, as where gains are tuned while a run goes.
    pub fn retitle(&mut self, title: &str, caption: &str) {
        title.clone_into(&mut self.cast.title);
        caption.clone_into(&mut self.cast.caption);
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

    /// Draws a moment into a texture of the renderer's format and size, such as a window's. It does not wait for the device.
    ///
    /// # Errors
    /// As [`Renderer::draw`]; where the texture does not fit, [`Error::Device`], and the next may be drawn.
    pub fn draw_into(
        &mut self,
        target: &wgpu::TextureView,
        trail: &Trail,
        moment: &Moment,
        layout: &Layout,
        style: &Style,
    ) -> Result<wgpu::SubmissionIndex, Error> {
        self.encoded((trail, moment), layout, style, target, None)
    }

    fn submit(
        &mut self,
        trail: &Trail,
        moment: &Moment,
        layout: &Layout,
        style: &Style,
    ) -> Result<(usize, wgpu::SubmissionIndex), Error> {
        let slot = self.waiting.as_ref().map_or(0, |(busy, _)| 1 - busy);
        if !matches!(self.canvas.format, TextureFormat::Rgba8Unorm | TextureFormat::Bgra8Unorm) {
            return Err(Error::Device(format!("no picture can be read from {:?}", self.canvas.format)));
        }
        while self.offscreen.len() <= slot {
            self.offscreen.push(Offscreen::new(&self.gpu.device, self.size, self.canvas.format));
        }
        let view = self.offscreen[slot].view.clone();
        Ok((slot, self.encoded((trail, moment), layout, style, &view, Some(slot))?))
    }

    /// Draws a moment into a target and copies it to where it is read, if it is.
    fn encoded(
        &mut self,
        (trail, moment): (&Trail, &Moment),
        layout: &Layout,
        style: &Style,
        target: &wgpu::TextureView,
        read: Option<usize>,
    ) -> Result<wgpu::SubmissionIndex, Error> {
        let drawn = self.prepare(trail, moment, layout, style).and_then(|prepared| {
            let mut encoder =
                self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            self.passes.encode(&mut encoder, self.surface(target), &prepared)?;
            if let Some(slot) = read {
                self.offscreen[slot].copy(&mut encoder);
            }
            let submission = self.gpu.queue.submit([encoder.finish()]);
            self.gpu.check().map(|()| submission)
        });
        if drawn.is_err() {
            self.passes.forget();
        }
        drawn
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
        let (views, tiles, upper) = self.views(layout, style);
        let cameras = self.cameras(trail, moment, &views, &tiles);
        // Cameras on robots see nothing that is drawn to explain.
        let bare = Style { shadows: style.shadows, ..Style::bare() };
        let stage = Stage {
            cast: &self.cast,
            floor: &self.floor,
            colours: &self.colours,
            trail,
            moment,
            style,
            origin: local_origin(moment),
            sun: towards_sun(&self.cast.light),
            size: trail.steady.formation().size,
            shadowed: shadowed(&self.cast, moment),
            detail: detail(self.cast.members.len()),
        };
        let (crowd, props) = (crowd(&stage, &self.fleet), props(&stage));
        let sun = sun_over(&stage);
        let shadow = &self.passes.world.shadow;
        let stage_of = |view: &View| match view {
            View::Camera(_) => Stage { style: &bare, ..stage },
            _ => stage,
        };
        let seen = || views.iter().zip(&cameras);
        let frames: Vec<_> =
            seen().map(|(view, camera)| frame(camera, &stage_of(view), view, &sun, shadow)).collect();
        let own = |(view, camera): (&View, &Camera)| match view {
            View::Camera(robot) => Some(part(&crowd, &stage, &self.fleet, camera, *robot)),
            _ => None,
        };
        let own = seen().map(own).collect();
        let mut corners = Vec::new();
        let mut decals = Vec::new();
        for ((view, camera), tile) in seen().zip(&tiles) {
            let add = |(layer, more): (Layer, Vec<Corner>)| {
                let first = corners.len() as u32;
                corners.extend(more);
                (layer, first..corners.len() as u32)
            };
            decals.push(paint(&stage_of(view), view, camera, f64::from(tile.height)).map(add));
        }
        let windows: Vec<_> =
            cameras.iter().zip(&tiles).map(|(camera, tile)| Window { camera, tile: *tile }).collect();
        let (lines, shapes) = words(&mut self.passes.text, &stage, (&views, upper), &windows, self.size);
        let ghosts = views.iter().map(|view| !matches!(view, View::SnakeEye | View::Camera(_))).collect();
        let veiled = seen().map(|(view, camera)| veiled_decks(camera, &stage, view)).collect();
        let mut prepared = Prepared {
            crowd,
            cameras,
            own,
            upper,
            props,
            tiles,
            veiled,
            decals,
            ghosts,
            shapes,
            shadowed: false,
        };
        self.passes.upload(&self.gpu, self.size, &frames, &mut prepared, &corners, &lines)?;
        Ok(prepared)
    }

    /// How each view of a picture is seen when it is drawn like this, in the order in which they are drawn: the small
    /// picture of [`Style::picture_in_picture`], which lies over others, is the last.
    ///
    /// # Errors
    /// [`Error::Cast`] for a moment of other robots.
    pub fn sightlines(
        &self,
        trail: &Trail,
        moment: &Moment,
        layout: &Layout,
        style: &Style,
    ) -> Result<Vec<Sightline>, Error> {
        self.check(moment)?;
        let (views, tiles, _) = self.views(layout, style);
        let cameras = self.cameras(trail, moment, &views, &tiles);
        let seen = views.into_iter().zip(tiles).zip(cameras);
        Ok(seen
            .map(|((view, tile), camera)| Sightline::new(view, tile, camera, self.floor.clone()))
            .collect())
    }

    /// What of a moment is under a pixel of one of its views, or within a few pixels of it: robots by how near they are,
    /// then set points, then edges.
    pub fn pick(&self, sightline: &Sightline, moment: &Moment, pixel: [f64; 2]) -> Vec<Picked> {
        if self.check(moment).is_err() || !sightline.holds(pixel) {
            return Vec::new();
        }
        pick(sightline, &self.cast, moment, pixel)
    }

    fn cameras(&self, trail: &Trail, moment: &Moment, views: &[View], tiles: &[Tile]) -> Vec<Camera> {
        let aspect = |tile: &Tile| f64::from(tile.width) / f64::from(tile.height);
        let camera = |(view, tile): (&View, &Tile)| {
            Camera::of(view, &trail.steady, &moment.snapshot, (&self.cast, &self.floor), aspect(tile))
        };
        views.iter().zip(tiles).map(camera).collect()
    }

    /// The views of a picture with their tiles, and how many of them, the last, lie over others.
    fn views(&self, layout: &Layout, style: &Style) -> (Vec<View>, Vec<Tile>, usize) {
        let mut views = layout.views.clone();
        let (width, height) = style.show.left_over(self.size);
        let mut tiles = layout.tiles(width, height);
        let member =
            style.picture_in_picture.and_then(|robot| self.cast.members.get(robot).map(|m| (robot, m)));
        let (Some((robot, member)), Some(first)) = (member, tiles.first()) else { return (views, tiles, 0) };
        let aspect = f64::from(member.lens.width.max(1)) / f64::from(member.lens.height.max(1));
        tiles.push(corner(first, aspect, 24.0 * style.scale));
        views.push(View::Camera(robot));
        (views, tiles, 1)
    }

    /// A target with all that drawing into it takes.
    fn surface<'a>(&'a self, target: &'a wgpu::TextureView) -> Surface<'a> {
        Surface { target, attachments: &self.attachments, size: self.size }
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
}
