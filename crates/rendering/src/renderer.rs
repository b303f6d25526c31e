//! Moments to pictures.

use crate::annotation::labels::Window;
use crate::annotation::text_shaper::TextShaper;
use crate::camera::Camera;
use crate::camera::pick::pick;
use crate::compose::{frame, sun_over, veiled_decks, words};
use crate::fleet_model::FleetModel;
use crate::gpu::encode::{Passes, Prepared, PreparedView};
use crate::gpu::model::Detail;
use crate::gpu::passes::Canvas;
use crate::gpu::passes::decal::{DecalLayer, DecalVertex};
use crate::gpu::props::props;
use crate::gpu::robot_groups::Groups;
use crate::gpu::robot_models::{crowd, largest, part};
use crate::gpu::target::{PICTURE_FORMAT, Readback, check_size};
use crate::ground::decal_builder::build_decals;
use crate::picture_context::PictureContext;
use crate::picture_plan::PicturePlan;
use crate::{Error, Gpu, Picked, PictureSpec, Sightline, Style, Viewpoint};
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};
use vocabulary::{FleetInfo, Picture, StepRecord};
use wgpu::TextureFormat;

/// Renders moments of one fleet at one size.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    model: FleetModel,
    canvas: Canvas,
    /// Width and height of the pictures, pixels.
    size: [u32; 2],
    passes: Passes,
    /// Behind a lock, since sightlines depend on the lengths of the texts.
    letters: Mutex<TextShaper>,
    /// Two, so that one picture can be drawn while the one before is read.
    offscreen: Vec<Readback>,
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
        let (model, size) = (FleetModel::new(fleet), [width, height]);
        let renderer = Self {
            gpu: gpu.clone(),
            passes: Passes::new(gpu, size, canvas, &model),
            model,
            canvas,
            size,
            letters: Mutex::new(TextShaper::new()),
            offscreen: Vec::new(),
            waiting: None,
        };
        gpu.check()?;
        Ok(renderer)
    }

    /// Width and height of the pictures, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Changes title and caption, as where gains are tuned while a run goes.
    pub fn retitle(&mut self, title: &str, caption: &str) {
        title.clone_into(&mut self.model.fleet.title);
        caption.clone_into(&mut self.model.fleet.caption);
    }

    /// Changes the size of the pictures.
    ///
    /// # Errors
    /// [`Error::Size`] for sizes that cannot be drawn.
    pub fn resize(&mut self, width: u32, height: u32) -> Result<(), Error> {
        check_size(&self.gpu, width, height)?;
        if self.size() != [width, height] {
            self.size = [width, height];
            self.passes.resize(&self.gpu, self.size);
            self.offscreen.clear();
            self.waiting = None;
        }
        Ok(())
    }

    /// The picture of a moment.
    ///
    /// # Errors
    /// [`Error::FleetInfo`] for a moment of other robots, [`Error::Device`] where the device fails.
    pub fn draw(&mut self, spec: PictureSpec<'_>) -> Result<Picture, Error> {
        let (slot, submission) = self.submit(spec)?;
        self.offscreen[slot].picture(&self.gpu, submission)
    }

    /// Starts the picture of a moment and returns the one started before, if any: for films, where the device
    /// draws while the picture before is read and encoded. [`Renderer::finish`] returns the last.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn draw_next(&mut self, spec: PictureSpec<'_>) -> Result<Option<Picture>, Error> {
        let next = self.submit(spec)?;
        let before = self.waiting.replace(next);
        before.map(|(slot, submission)| self.offscreen[slot].picture(&self.gpu, submission)).transpose()
    }

    /// The picture that [`Renderer::draw_next`] started last, if any.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn finish(&mut self) -> Result<Option<Picture>, Error> {
        let last = self.waiting.take();
        last.map(|(slot, submission)| self.offscreen[slot].picture(&self.gpu, submission)).transpose()
    }

    /// The picture that [`Renderer::draw_next`] started last, once it is there: for where nobody may wait, such as a web
    /// page. It is asked again and again.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails; then there is no picture to come.
    pub fn arrived(&mut self) -> Result<Option<Picture>, Error> {
        let Some((slot, submission)) = self.waiting.take() else { return Ok(None) };
        let picture = self.offscreen[slot].arrived(&self.gpu)?;
        if picture.is_none() {
            self.waiting = Some((slot, submission));
        }
        Ok(picture)
    }

    /// Draws a moment into a texture of the renderer's format and size, such as a window's. It does not wait for the device.
    ///
    /// # Errors
    /// As [`Renderer::draw`]; where the texture does not fit, [`Error::Device`], and the next may be drawn.
    pub fn draw_into(
        &mut self,
        target: &wgpu::TextureView,
        spec: PictureSpec<'_>,
    ) -> Result<wgpu::SubmissionIndex, Error> {
        self.encoded(spec, target, None)
    }

    fn submit(&mut self, spec: PictureSpec<'_>) -> Result<(usize, wgpu::SubmissionIndex), Error> {
        let slot = self.waiting.as_ref().map_or(0, |(busy, _)| 1 - busy);
        if !matches!(self.canvas.format, TextureFormat::Rgba8Unorm | TextureFormat::Bgra8Unorm) {
            return Err(Error::Device(format!("no picture can be read from {:?}", self.canvas.format)));
        }
        while self.offscreen.len() <= slot {
            self.offscreen.push(Readback::new(&self.gpu, self.size(), self.canvas.format, 4));
        }
        let view = self.offscreen[slot].view.clone();
        Ok((slot, self.encoded(spec, &view, Some(slot))?))
    }

    /// Draws a moment into a target and copies it to where it is read, if it is.
    fn encoded(
        &mut self,
        spec: PictureSpec<'_>,
        target: &wgpu::TextureView,
        read: Option<usize>,
    ) -> Result<wgpu::SubmissionIndex, Error> {
        let drawn = self.prepare(spec).and_then(|prepared| {
            let mut encoder =
                self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            self.passes.encode(&mut encoder, target, &prepared)?;
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
    fn prepare(&mut self, spec: PictureSpec<'_>) -> Result<Prepared, Error> {
        self.check(spec.record)?;
        let plan = self.plan(spec);
        let context = PictureContext::new(&self.model, spec.trail, spec.record, spec.style);
        let cameras = cameras(&plan, &context);
        // Cameras on robots do not see annotations.
        let bare = Style { shadows: spec.style.shadows, ..Style::bare() };
        let (crowd, props) = (crowd(&context), props(&context));
        let sun = sun_over(&context);
        let (mut frames, mut corners, mut views) = (Vec::new(), Vec::new(), Vec::new());
        for ((view, camera), tile) in plan.views.iter().zip(&cameras).zip(&plan.tiles) {
            let (seen, own) = match view {
                Viewpoint::Camera(robot) => {
                    (PictureContext { style: &bare, ..context }, Some(part(&crowd, &context, camera, *robot)))
                }
                _ => (context, None),
            };
            let add = |(layer, more): (DecalLayer, Vec<DecalVertex>)| {
                let first = corners.len() as u32;
                corners.extend(more);
                (layer, first..corners.len() as u32)
            };
            let most = self.gpu.device.limits().max_texture_dimension_2d;
            let groups = match &own {
                _ if !self.passes.apart() => Groups::default(),
                Some(own) => Groups::whole(own.clone(), tile),
                None => {
                    let bounds = &self.passes.world.models.bounds;
                    Groups::of(&crowd, &context, bounds, Window { camera, tile: *tile }, most)
                }
            };
            frames.push(frame(camera, &seen, view, &sun, &self.passes.world.shadow));
            views.push(PreparedView {
                camera: *camera,
                tile: *tile,
                groups,
                own,
                veiled: veiled_decks(camera, &context, view),
                decals: build_decals(&seen, view, camera, f64::from(tile.height)).map(add),
                ghosts: !matches!(view, Viewpoint::SnakeEye | Viewpoint::Camera(_)),
                detail: Detail::at(largest(camera, &context, f64::from(tile.height))),
            });
        }
        let windows: Vec<_> =
            views.iter().map(|view| Window { camera: &view.camera, tile: view.tile }).collect();
        let letters = self.letters.get_mut().unwrap_or_else(PoisonError::into_inner);
        let size = self.size;
        let (words, _) = words(letters, &context, &plan, &windows, size);
        let (lines, shapes) = (words.lines, words.shapes);
        let upper = plan.upper;
        let mut prepared = Prepared { crowd, props, views, upper, shapes, lines, shadowed: false };
        self.passes.upload(&self.gpu, size, &frames, &mut prepared, &corners, letters)?;
        Ok(prepared)
    }

    /// The sightlines of the views of a picture, in the order in which they are drawn: that of the small
    /// picture of [`Style::picture_in_picture`], which lies over others, is last.
    ///
    /// # Errors
    /// [`Error::FleetInfo`] for a moment of other robots.
    pub fn sightlines(&self, spec: PictureSpec<'_>) -> Result<Vec<Sightline>, Error> {
        self.check(spec.record)?;
        let plan = self.plan(spec);
        let context = PictureContext::new(&self.model, spec.trail, spec.record, spec.style);
        let cameras = cameras(&plan, &context);
        let seen = plan.views.into_iter().zip(plan.tiles).zip(cameras);
        Ok(seen
            .map(|((view, tile), camera)| Sightline { view, tile, camera, floor: self.model.floor.clone() })
            .collect())
    }

    /// What of a moment is under a pixel of one of its views, or within a few pixels of it: robots by how near they are,
    /// then set points, then edges.
    pub fn pick(&self, sightline: &Sightline, record: &StepRecord, pixel: [f64; 2]) -> Vec<Picked> {
        if self.check(record).is_err() || !sightline.holds(pixel) {
            return Vec::new();
        }
        pick(sightline, &self.model.fleet, record, pixel)
    }

    /// The characters of some texts that neither the embedded fonts nor those of the machine have.
    pub fn unwritable<'a>(&self, texts: impl IntoIterator<Item = &'a str>) -> BTreeSet<char> {
        self.letters.lock().unwrap_or_else(PoisonError::into_inner).lacks(texts.into_iter())
    }

    fn plan(&self, spec: PictureSpec<'_>) -> PicturePlan {
        let mut letters = self.letters.lock().unwrap_or_else(PoisonError::into_inner);
        PicturePlan::new(&mut letters, &self.model.fleet, spec.layout, spec.style, self.size())
    }

    fn check(&self, record: &StepRecord) -> Result<(), Error> {
        let fleet = &self.model.fleet;
        let robots = (record.snapshot.robots.len(), fleet.robots.len());
        let edges = (record.edges.len(), fleet.edges.len());
        for (what, (got, want)) in [("robots", robots), ("edges", edges)] {
            if got != want {
                return Err(Error::FleetInfo { what, got, want });
            }
        }
        Ok(())
    }
}

/// The cameras of a picture's views.
pub(crate) fn cameras(plan: &PicturePlan, context: &PictureContext<'_>) -> Vec<Camera> {
    let camera = |(k, view): (usize, &Viewpoint)| Camera::of(view, context, &plan.room(k));
    plan.views.iter().enumerate().map(camera).collect()
}
