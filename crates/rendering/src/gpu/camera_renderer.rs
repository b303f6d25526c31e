//! Camera images of robots: monochrome, linear in light, of the same world that the views show.

use crate::camera::Camera;
use crate::camera::viewpoint::{Tile, Viewpoint};
use crate::compose::{frame, sun_over};
use crate::fleet_model::FleetModel;
use crate::gpu::atlas::{Atlas, CANVAS, pack};
use crate::gpu::model::Detail;
use crate::gpu::passes::decal::{DecalLayer, DecalVertex};
use crate::gpu::passes::prop::PropInstances;
use crate::gpu::passes::robot::RobotInstances;
use crate::gpu::props::props;
use crate::gpu::robot_models::{crowd, part};
use crate::gpu::target::confine;
use crate::gpu::world_passes::{SceneView, WorldPasses};
use crate::ground::decal_builder::shade;
use crate::picture_context::PictureContext;
use crate::{Error, Gpu, Style, Trail};
use std::iter::once;
use std::ops::Range;
use vocabulary::{CameraRenderer, FleetInfo, Grey, Shot, Snapshot, StepRecord};

/// Side of the shadow map, texels.
const SHADOWS: u32 = 1024;
/// Most atlases that are kept.
const ATLASES: usize = 4;

/// Renders the camera images of a fleet: all images of an instant are rendered together.
#[derive(Debug)]
pub struct GpuCameraRenderer {
    gpu: Gpu,
    model: FleetModel,
    trail: Trail,
    style: Style,
    world: WorldPasses,
    /// Old to new.
    atlases: Vec<Atlas>,
}

/// What one shot shows.
struct CameraScene {
    camera: Camera,
    crowd: RobotInstances,
    props: PropInstances,
    tile: Tile,
}

impl GpuCameraRenderer {
    /// A renderer for the cameras of `fleet`.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn new(gpu: &Gpu, fleet: &FleetInfo) -> Result<Self, Error> {
        let model = FleetModel::new(fleet);
        let world = WorldPasses::new(gpu, [CANVAS; 2], &model, SHADOWS);
        gpu.check()?;
        Ok(Self {
            gpu: gpu.clone(),
            model,
            // Cameras see no past.
            trail: Trail::new(fleet),
            style: Style::bare(),
            world,
            atlases: Vec::new(),
        })
    }

    /// The pictures of all `shots` of an instant, one each.
    ///
    /// # Errors
    /// [`Error::FleetInfo`] for a snapshot of other robots, [`Error::Size`] for regions that are empty or too large,
    /// [`Error::Device`] where the device fails.
    pub fn take(&mut self, snapshot: &Snapshot, shots: &[Shot], images: &mut Vec<Grey>) -> Result<(), Error> {
        let (got, want) = (snapshot.robots.len(), self.model.fleet.robots.len());
        if got != want {
            return Err(Error::FleetInfo { what: "robots", got, want });
        }
        images.resize_with(shots.len(), Grey::default);
        let Some(first) = shots.first() else { return Ok(()) };
        let (tiles, size) = self.places(shots)?;
        let record = StepRecord { snapshot: snapshot.clone(), ..StepRecord::default() };
        let context = PictureContext::new(&self.model, &self.trail, &record, &self.style);
        let context = PictureContext { detail: 0.0, ..context };
        let sun = sun_over(&context);
        let (mut all, mut things) = (crowd(&context), props(&context));
        let mut corners: Vec<DecalVertex> = Vec::new();
        let under = shade(&context, &Camera::shot(first)).map(|(layer, more)| {
            let from = corners.len() as u32;
            corners.extend(more);
            (layer, from..corners.len() as u32)
        });
        let mut frames = Vec::with_capacity(shots.len());
        let mut scenes: Vec<CameraScene> = Vec::with_capacity(shots.len());
        for (shot, tile) in shots.iter().zip(&tiles) {
            let camera = Camera::shot(shot);
            let mut frame =
                frame(&camera, &context, &Viewpoint::Camera(shot.robot), &sun, &self.world.shadow);
            frame.ground[1] = shot.exposure as f32;
            frames.push(frame);
            scenes.push(CameraScene {
                camera,
                crowd: part(&all, &context, &camera, shot.robot),
                props: things.part(&camera, context.origin),
                tile: *tile,
            });
        }
        let (mut crowds, mut copies) = (vec![&mut all], vec![&mut things]);
        for scene in &mut scenes {
            crowds.push(&mut scene.crowd);
            copies.push(&mut scene.props);
        }
        self.world.upload(&self.gpu, &frames, crowds.into_iter(), copies.into_iter(), &corners);
        let atlas = self.atlas(size);
        let submission = self.draw(atlas, &all, &things, &scenes, &under);
        self.gpu.check()?;
        self.atlases[atlas].read(&self.gpu, submission, &tiles, images)
    }

    /// Where each picture lies in an atlas, and how large that is.
    fn places(&self, shots: &[Shot]) -> Result<(Vec<Tile>, [u32; 2]), Error> {
        let most = self.gpu.device.limits().max_texture_dimension_2d;
        let sizes: Vec<_> = shots.iter().map(|shot| [shot.region.width, shot.region.height]).collect();
        for [width, height] in sizes.iter().copied() {
            if width == 0 || height == 0 || width > most || height > most {
                return Err(Error::Size { width, height, most });
            }
        }
        let [width, height] = sizes.first().copied().unwrap_or_default();
        pack(&sizes, most).ok_or(Error::Size { width, height, most })
    }

    /// The index of an atlas of about that size.
    fn atlas(&mut self, size: [u32; 2]) -> usize {
        if let Some(index) = self.atlases.iter().position(|atlas| atlas.suits(size)) {
            return index;
        }
        if self.atlases.len() >= ATLASES {
            self.atlases.remove(0);
        }
        self.atlases.push(Atlas::new(&self.gpu, size));
        self.atlases.len() - 1
    }

    fn draw(
        &self,
        atlas: usize,
        crowd: &RobotInstances,
        props: &PropInstances,
        scenes: &[CameraScene],
        under: &[(DecalLayer, Range<u32>)],
    ) -> wgpu::SubmissionIndex {
        let atlas = &self.atlases[atlas];
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.world.encode_shadow(&mut encoder, crowd, props, Detail::Coarse);
        let clear = wgpu::LoadOp::Clear(wgpu::Color::BLACK);
        atlas.attachments.draw(&mut encoder, &atlas.readback.view, clear, |pass| {
            for (index, scene) in scenes.iter().enumerate() {
                confine(pass, &scene.tile, [0.0, 1.0]);
                let sight = SceneView {
                    index,
                    camera: &scene.camera,
                    crowd: &scene.crowd,
                    props: &scene.props,
                    veiled: &[],
                    under,
                    over: None,
                    ghosts: false,
                    detail: Detail::Coarse,
                };
                self.world.draw(pass, &sight);
            }
        });
        atlas.readback.copy(&mut encoder);
        self.gpu.queue.submit(once(encoder.finish()))
    }
}

impl CameraRenderer for GpuCameraRenderer {
    fn render(&mut self, snapshot: &Snapshot, shots: &[Shot], images: &mut Vec<Grey>) -> Result<(), String> {
        self.take(snapshot, shots, images).map_err(|error| error.to_string())
    }
}
