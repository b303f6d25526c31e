//! What cameras on robots see: monochrome pictures, linear in light, of the same world that the views show.

use crate::camera::Camera;
use crate::camera::viewpoint::{Tile, Viewpoint};
use crate::compose::{frame, local_origin, shadowed, sun_over, towards_sun};
use crate::gpu::atlas::{Atlas, CANVAS, pack};
use crate::gpu::model::Detail;
use crate::gpu::passes::decal::{DecalLayer, DecalVertex};
use crate::gpu::passes::prop::PropInstances;
use crate::gpu::passes::robot::RobotInstances;
use crate::gpu::props::props;
use crate::gpu::robot_models::{RobotModels, crowd, part};
use crate::gpu::world_passes::{SceneView, WorldPasses};
use crate::ground::decal_builder::shade;
use crate::ground::floor::Floor;
use crate::palette::{Rgb, robot_colours};
use crate::picture_context::PictureContext;
use crate::{Error, Gpu, Style, Trail};
use std::iter::once;
use std::ops::Range;
use vocabulary::{CameraRenderer, FleetInfo, Grey, Shot, Snapshot, StepRecord};

/// Side of the shadow map, texels.
const SHADOWS: u32 = 1024;
/// Most atlases that are kept.
const ATLASES: usize = 4;

/// Cameras on the robots of a cast: all pictures of an instant are drawn together.
#[derive(Debug)]
pub struct GpuCameraRenderer {
    gpu: Gpu,
    fleet: FleetInfo,
    colours: Vec<Rgb>,
    robot_models: RobotModels,
    floor: Floor,
    trail: Trail,
    style: Style,
    world: WorldPasses,
    /// Old to new.
    atlases: Vec<Atlas>,
    size: f64,
}

/// What one shot shows.
struct CameraScene {
    camera: Camera,
    crowd: RobotInstances,
    props: PropInstances,
    tile: Tile,
}

impl GpuCameraRenderer {
    /// Eyes for the robots of `fleet`.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn new(gpu: &Gpu, fleet: &FleetInfo) -> Result<Self, Error> {
        let (robot_models, floor) = (RobotModels::new(fleet), Floor::new(fleet));
        let world = WorldPasses::new(gpu, CANVAS, fleet, &robot_models, &floor, Detail::Coarse, SHADOWS);
        gpu.check()?;
        Ok(Self {
            gpu: gpu.clone(),
            colours: robot_colours(fleet),
            robot_models,
            floor,
            // Cameras see no past.
            trail: Trail::new(fleet),
            style: Style::bare(),
            world,
            atlases: Vec::new(),
            size: fleet.robots.iter().map(|m| crate::gpu::model::size(&m.body)).fold(1.0, f64::max),
            fleet: fleet.clone(),
        })
    }

    /// The pictures of all `shots` of an instant, one each.
    ///
    /// # Errors
    /// [`Error::FleetInfo`] for a snapshot of other robots, [`Error::Size`] for regions that are empty or too large,
    /// [`Error::Device`] where the device fails.
    pub fn take(&mut self, snapshot: &Snapshot, shots: &[Shot], images: &mut Vec<Grey>) -> Result<(), Error> {
        let (got, want) = (snapshot.robots.len(), self.fleet.robots.len());
        if got != want {
            return Err(Error::FleetInfo { what: "robots", got, want });
        }
        images.resize_with(shots.len(), Grey::default);
        let Some(first) = shots.first() else { return Ok(()) };
        let (tiles, size) = self.places(shots)?;
        let record = StepRecord { snapshot: snapshot.clone(), ..StepRecord::default() };
        let context = PictureContext {
            fleet: &self.fleet,
            floor: &self.floor,
            colours: &self.colours,
            trail: &self.trail,
            record: &record,
            style: &self.style,
            origin: local_origin(&record),
            sun: towards_sun(&self.fleet.light),
            size: self.size,
            shadowed: shadowed(&self.fleet, &record),
            detail: 0.0,
        };
        let sun = sun_over(&context);
        let (mut all, mut things) = (crowd(&context, &self.robot_models), props(&context));
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
                crowd: part(&all, &context, &self.robot_models, &camera, shot.robot),
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
        self.world.encode_shadow(&mut encoder, crowd, props);
        {
            let mut pass = atlas.attachments.begin(&mut encoder, &atlas.view, wgpu::Color::BLACK);
            for (index, scene) in scenes.iter().enumerate() {
                let tile = scene.tile;
                let [x, y, width, height] = [tile.x, tile.y, tile.width, tile.height].map(|n| n as f32);
                pass.set_viewport(x, y, width, height, 0.0, 1.0);
                pass.set_scissor_rect(tile.x, tile.y, tile.width, tile.height);
                let sight = SceneView {
                    index,
                    camera: &scene.camera,
                    crowd: &scene.crowd,
                    props: &scene.props,
                    veiled: &[],
                    under,
                    over: None,
                    ghosts: false,
                };
                self.world.draw(&mut pass, &sight);
            }
            // On GL the samples are resolved at the end of the pass within whatever scissor is set then.
            pass.set_scissor_rect(0, 0, atlas.size[0], atlas.size[1]);
        }
        atlas.copy(&mut encoder);
        self.gpu.queue.submit(once(encoder.finish()))
    }
}

impl CameraRenderer for GpuCameraRenderer {
    fn render(&mut self, snapshot: &Snapshot, shots: &[Shot], images: &mut Vec<Grey>) -> Result<(), String> {
        self.take(snapshot, shots, images).map_err(|error| error.to_string())
    }
}
