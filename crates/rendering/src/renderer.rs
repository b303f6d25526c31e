//! Moments to pictures.

use crate::annotation::labels::{Window, detail};
use crate::annotation::text_shaper::TextShaper;
use crate::camera::Camera;
use crate::camera::pick::pick;
use crate::compose::{frame, local_origin, shadowed, sun_over, towards_sun, veiled_decks, words};
use crate::gpu::encode::{EncodeTarget, Passes, Prepared};
use crate::gpu::passes::Canvas;
use crate::gpu::passes::decal::{DecalLayer, DecalVertex};
use crate::gpu::props::props;
use crate::gpu::robot_models::{RobotModels, crowd, part};
use crate::gpu::target::{Attachments, Offscreen, PICTURE_FORMAT, check_size};
use crate::ground::decal_builder::build_decals;
use crate::ground::floor::Floor;
use crate::palette::{Rgb, robot_colours};
use crate::picture_context::PictureContext;
use crate::picture_plan::PicturePlan;
use crate::{Error, Gpu, Picked, Sightline, Style, Trail, ViewLayout, Viewpoint};
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};
use vocabulary::{FleetInfo, Picture, StepRecord};
use wgpu::TextureFormat;

/// Draws moments of one cast at one size.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    fleet: FleetInfo,
    colours: Vec<Rgb>,
    robot_models: RobotModels,
    floor: Floor,
    size: (u32, u32),
    canvas: Canvas,
    attachments: Attachments,
    passes: Passes,
    /// Behind a lock, since whoever asks how a view is seen has to know how long its words are.
    letters: Mutex<TextShaper>,
    /// Two, so that one picture can be drawn while the one before is read.
    offscreen: Vec<Offscreen>,
    waiting: Option<(usize, wgpu::SubmissionIndex)>,
}

impl Renderer {
    /// A renderer of pictures in memory; `samples` per pixel are 4, or 1 for speed.
    ///
    /// # Errors
    /// [`Error::Size`] or [`Error::Samples`] for what cannot be drawn, [`Error::Device`] where the device fails.
    pub fn new(gpu: &Gpu, fleet: &FleetInfo, width: u32, height: u32, samples: u32) -> Result<Self, Error> {
        Self::with_format(gpu, fleet, width, height, samples, PICTURE_FORMAT)
    }

    /// A renderer into textures of `format`, for a window's surface. The shaders write sRGB-encoded values, so
    /// the format must not encode again (`Bgra8Unorm`, not `Bgra8UnormSrgb`).
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn with_format(
        gpu: &Gpu,
        fleet: &FleetInfo,
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
        let robot_models = RobotModels::new(fleet);
        let floor = Floor::new(fleet);
        let passes = Passes::new(gpu, canvas, fleet, &robot_models, &floor);
        let renderer = Self {
            gpu: gpu.clone(),
            fleet: fleet.clone(),
            colours: robot_colours(fleet),
            robot_models,
            floor,
            size: (width, height),
            canvas,
            attachments: Attachments::new(&gpu.device, [width, height], format, samples),
            passes,
            letters: Mutex::new(TextShaper::new()),
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
        title.clone_into(&mut self.fleet.title);
        caption.clone_into(&mut self.fleet.caption);
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
                Attachments::new(&self.gpu.device, self.size.into(), self.canvas.format, self.canvas.samples);
            self.offscreen.clear();
            self.waiting = None;
        }
        Ok(())
    }

    /// The picture of a moment.
    ///
    /// # Errors
    /// [`Error::FleetInfo`] for a moment of other robots, [`Error::Device`] where the device fails.
    pub fn draw(
        &mut self,
        trail: &Trail,
        record: &StepRecord,
        layout: &ViewLayout,
        style: &Style,
    ) -> Result<Picture, Error> {
        let (slot, submission) = self.submit(trail, record, layout, style)?;
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
        record: &StepRecord,
        layout: &ViewLayout,
        style: &Style,
    ) -> Result<Option<Picture>, Error> {
        let next = self.submit(trail, record, layout, style)?;
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
        record: &StepRecord,
        layout: &ViewLayout,
        style: &Style,
    ) -> Result<wgpu::SubmissionIndex, Error> {
        self.encoded(trail, record, layout, style, target, None)
    }

    fn submit(
        &mut self,
        trail: &Trail,
        record: &StepRecord,
        layout: &ViewLayout,
        style: &Style,
    ) -> Result<(usize, wgpu::SubmissionIndex), Error> {
        let slot = self.waiting.as_ref().map_or(0, |(busy, _)| 1 - busy);
        if !matches!(self.canvas.format, TextureFormat::Rgba8Unorm | TextureFormat::Bgra8Unorm) {
            return Err(Error::Device(format!("no picture can be read from {:?}", self.canvas.format)));
        }
        while self.offscreen.len() <= slot {
            self.offscreen.push(Offscreen::new(&self.gpu.device, self.size.into(), self.canvas.format));
        }
        let view = self.offscreen[slot].view.clone();
        Ok((slot, self.encoded(trail, record, layout, style, &view, Some(slot))?))
    }

    /// Draws a moment into a target and copies it to where it is read, if it is.
    fn encoded(
        &mut self,
        trail: &Trail,
        record: &StepRecord,
        layout: &ViewLayout,
        style: &Style,
        target: &wgpu::TextureView,
        read: Option<usize>,
    ) -> Result<wgpu::SubmissionIndex, Error> {
        let drawn = self.prepare(trail, record, layout, style).and_then(|prepared| {
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
        record: &StepRecord,
        layout: &ViewLayout,
        style: &Style,
    ) -> Result<Prepared, Error> {
        self.check(record)?;
        let plan = self.plan(layout, style);
        let (views, tiles) = (&plan.views, &plan.tiles);
        let cameras = cameras(&plan, trail, record, &self.fleet, &self.floor);
        // Cameras on robots see nothing that is drawn to explain.
        let bare = Style { shadows: style.shadows, ..Style::bare() };
        let context = PictureContext {
            fleet: &self.fleet,
            floor: &self.floor,
            colours: &self.colours,
            trail,
            record,
            style,
            origin: local_origin(record),
            sun: towards_sun(&self.fleet.light),
            size: trail.smoothed.formation().size,
            shadowed: shadowed(&self.fleet, record),
            detail: detail(self.fleet.robots.len()),
        };
        let (crowd, props) = (crowd(&context, &self.robot_models), props(&context));
        let sun = sun_over(&context);
        let shadow = &self.passes.world.shadow;
        let context_of = |view: &Viewpoint| match view {
            Viewpoint::Camera(_) => PictureContext { style: &bare, ..context },
            _ => context,
        };
        let seen = || views.iter().zip(&cameras);
        let frames: Vec<_> =
            seen().map(|(view, camera)| frame(camera, &context_of(view), view, &sun, shadow)).collect();
        let own = |(view, camera): (&Viewpoint, &Camera)| match view {
            Viewpoint::Camera(robot) => Some(part(&crowd, &context, &self.robot_models, camera, *robot)),
            _ => None,
        };
        let own = seen().map(own).collect();
        let mut corners = Vec::new();
        let mut decals = Vec::new();
        for ((view, camera), tile) in seen().zip(tiles) {
            let add = |(layer, more): (DecalLayer, Vec<DecalVertex>)| {
                let first = corners.len() as u32;
                corners.extend(more);
                (layer, first..corners.len() as u32)
            };
            decals.push(build_decals(&context_of(view), view, camera, f64::from(tile.height)).map(add));
        }
        let windows: Vec<_> =
            cameras.iter().zip(tiles).map(|(camera, tile)| Window { camera, tile: *tile }).collect();
        let letters = self.letters.get_mut().unwrap_or_else(PoisonError::into_inner);
        let (words, _) = words(letters, &context, &plan, &windows, self.size.into());
        let (lines, shapes) = (words.lines, words.shapes);
        let ghosts =
            views.iter().map(|view| !matches!(view, Viewpoint::SnakeEye | Viewpoint::Camera(_))).collect();
        let veiled = seen().map(|(view, camera)| veiled_decks(camera, &context, view)).collect();
        let mut prepared = Prepared {
            crowd,
            cameras,
            own,
            upper: plan.upper,
            props,
            tiles: plan.tiles,
            veiled,
            decals,
            ghosts,
            shapes,
            lines,
            shadowed: false,
        };
        self.passes.upload(&self.gpu, self.size.into(), &frames, &mut prepared, &corners, letters)?;
        Ok(prepared)
    }

    /// How each view of a picture is seen when it is drawn like this, in the order in which they are drawn: the small
    /// picture of [`Style::picture_in_picture`], which lies over others, is the last.
    ///
    /// # Errors
    /// [`Error::FleetInfo`] for a moment of other robots.
    pub fn sightlines(
        &self,
        trail: &Trail,
        record: &StepRecord,
        layout: &ViewLayout,
        style: &Style,
    ) -> Result<Vec<Sightline>, Error> {
        self.check(record)?;
        let plan = self.plan(layout, style);
        let cameras = cameras(&plan, trail, record, &self.fleet, &self.floor);
        let seen = plan.views.into_iter().zip(plan.tiles).zip(cameras);
        Ok(seen
            .map(|((view, tile), camera)| Sightline::new(view, tile, camera, self.floor.clone()))
            .collect())
    }

    /// What of a moment is under a pixel of one of its views, or within a few pixels of it: robots by how near they are,
    /// then set points, then edges.
    pub fn pick(&self, sightline: &Sightline, record: &StepRecord, pixel: [f64; 2]) -> Vec<Picked> {
        if self.check(record).is_err() || !sightline.holds(pixel) {
            return Vec::new();
        }
        pick(sightline, &self.fleet, record, pixel)
    }

    /// The characters of some texts that neither the embedded fonts nor those of the machine have.
    pub fn unwritable<'a>(&self, texts: impl IntoIterator<Item = &'a str>) -> BTreeSet<char> {
        self.letters.lock().unwrap_or_else(PoisonError::into_inner).lacks(texts.into_iter())
    }

    fn plan(&self, layout: &ViewLayout, style: &Style) -> PicturePlan {
        let mut letters = self.letters.lock().unwrap_or_else(PoisonError::into_inner);
        PicturePlan::new(&mut letters, &self.fleet, layout, style, self.size.into())
    }

    /// A target with all that drawing into it takes.
    fn surface<'a>(&'a self, target: &'a wgpu::TextureView) -> EncodeTarget<'a> {
        EncodeTarget { target, attachments: &self.attachments, size: self.size }
    }

    fn check(&self, record: &StepRecord) -> Result<(), Error> {
        let robots = (record.snapshot.robots.len(), self.fleet.robots.len());
        let edges = (record.edges.len(), self.fleet.edges.len());
        for (what, (got, want)) in [("robots", robots), ("edges", edges)] {
            if got != want {
                return Err(Error::FleetInfo { what, got, want });
            }
        }
        Ok(())
    }
}

/// The cameras of a picture's views.
pub(crate) fn cameras(
    plan: &PicturePlan,
    trail: &Trail,
    record: &StepRecord,
    fleet: &FleetInfo,
    floor: &Floor,
) -> Vec<Camera> {
    let camera = |(k, view): (usize, &Viewpoint)| {
        Camera::of(view, &trail.smoothed, &record.snapshot, fleet, floor, &plan.room(k))
    };
    plan.views.iter().enumerate().map(camera).collect()
}
