//! All passes of a picture, in the order in which they run.

use crate::annotation::text_shaper::TextShaper;
use crate::camera::Camera;
use crate::gpu::model::Detail;
use crate::gpu::passes::Canvas;
use crate::gpu::passes::decal::{DecalLayer, DecalVertex};
use crate::gpu::passes::frame::FrameUniforms;
use crate::gpu::passes::overlay::{OverlayPass, Shapes};
use crate::gpu::passes::prop::PropInstances;
use crate::gpu::passes::robot::RobotInstances;
use crate::gpu::passes::text::{TextLine, TextPass};
use crate::gpu::robot_models::RobotModels;
use crate::gpu::target::Attachments;
use crate::gpu::world_passes::{SceneView, WorldPasses};
use crate::ground::floor::Floor;
use crate::{Error, Gpu, camera::viewpoint::Tile};
use std::iter::once;
use std::ops::Range;
use vocabulary::FleetInfo;

/// Shows where triangles of the terrain do not quite meet.
const STONE: wgpu::Color = wgpu::Color { r: 0.42, g: 0.42, b: 0.41, a: 1.0 };

/// Robots from which on their models are plain.
const PLAIN_ABOVE: usize = 24;

/// Every pass with what it keeps on the device.
#[derive(Debug)]
pub(crate) struct Passes {
    pub(crate) world: WorldPasses,
    overlay: OverlayPass,
    text: TextPass,
    /// What the shadow map was drawn from: while nothing moves it stays.
    shadowed: Option<Vec<u8>>,
}

/// What a picture consists of, once its data is on the device.
pub(crate) struct Prepared {
    pub(crate) crowd: RobotInstances,
    pub(crate) cameras: Vec<Camera>,
    /// Of views through cameras: what they may see.
    pub(crate) own: Vec<Option<RobotInstances>>,
    /// How many of the tiles, the last, lie over others.
    pub(crate) upper: usize,
    pub(crate) props: PropInstances,
    pub(crate) tiles: Vec<Tile>,
    /// Which decks hide a robot in each view.
    pub(crate) veiled: Vec<Vec<bool>>,
    /// Corners of each view.
    pub(crate) decals: Vec<[(DecalLayer, Range<u32>); 5]>,
    /// Whether a view shows ghosts: near the ground they would veil what is behind them.
    pub(crate) ghosts: Vec<bool>,
    pub(crate) shapes: Shapes,
    /// Its texts.
    pub(crate) lines: Vec<TextLine>,
    /// Whether the shadow map is as it should be.
    pub(crate) shadowed: bool,
}

impl Prepared {
    fn sight(&self, index: usize) -> SceneView<'_> {
        let [under @ .., over] = &self.decals[index];
        SceneView {
            index,
            camera: &self.cameras[index],
            crowd: self.own[index].as_ref().unwrap_or(&self.crowd),
            props: &self.props,
            veiled: &self.veiled[index],
            under,
            over: Some(over),
            ghosts: self.ghosts[index],
        }
    }
}

/// What a picture is drawn into.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EncodeTarget<'a> {
    pub(crate) target: &'a wgpu::TextureView,
    pub(crate) attachments: &'a Attachments,
    pub(crate) size: (u32, u32),
}

impl Passes {
    pub(crate) fn new(
        gpu: &Gpu,
        canvas: Canvas,
        fleet: &FleetInfo,
        robot_models: &RobotModels,
        floor: &Floor,
    ) -> Self {
        let detail = if fleet.robots.len() > PLAIN_ABOVE { Detail::Plain } else { Detail::Full };
        let flat = Canvas { samples: 1, ..canvas };
        let robots = fleet.robots.len();
        let side = if robots > 12 || !fleet.props.is_empty() { 2048 } else { 1024 };
        Self {
            world: WorldPasses::new(gpu, canvas, fleet, robot_models, floor, detail, side),
            overlay: OverlayPass::new(&gpu.device, flat),
            text: TextPass::new(&gpu.device, &gpu.queue, flat),
            shadowed: None,
        }
    }

    /// Brings a picture's data to the device.
    pub(crate) fn upload(
        &mut self,
        gpu: &Gpu,
        [width, height]: [u32; 2],
        frames: &[FrameUniforms],
        prepared: &mut Prepared,
        corners: &[DecalVertex],
        letters: &mut TextShaper,
    ) -> Result<(), Error> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let (crowds, props) =
            (once(&mut prepared.crowd).chain(prepared.own.iter_mut().flatten()), once(&mut prepared.props));
        self.world.upload(gpu, frames, crowds, props, corners);
        self.overlay.fill(device, queue, [width as f32, height as f32], &prepared.shapes);
        let written = self.text.fill(device, queue, [width, height], &prepared.lines, letters);
        written.map_err(|e| Error::Device(e.to_string()))?;
        let casting = Some(casting(frames, prepared));
        prepared.shadowed = self.shadowed == casting;
        self.shadowed = casting;
        Ok(())
    }

    /// After a picture failed nobody knows what is in the shadow map.
    pub(crate) fn forget(&mut self) {
        self.shadowed = None;
    }

    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        surface: EncodeTarget<'_>,
        prepared: &Prepared,
    ) -> Result<(), Error> {
        if !prepared.shadowed {
            self.world.encode_shadow(encoder, &prepared.crowd, &prepared.props);
        }
        self.encode_world(encoder, surface, prepared);
        self.encode_overlay(encoder, surface.target, prepared)
    }

    fn encode_world(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        surface: EncodeTarget<'_>,
        prepared: &Prepared,
    ) {
        let mut pass = surface.attachments.begin(encoder, surface.target, STONE);
        for (index, tile) in prepared.tiles.iter().enumerate() {
            let [x, y, width, height] = [tile.x, tile.y, tile.width, tile.height].map(|n| n as f32);
            // What lies over others is nearer than all of them.
            let (near, far) = match (prepared.upper, index + prepared.upper < prepared.tiles.len()) {
                (0, _) => (0.0, 1.0),
                (_, true) => (0.5, 1.0),
                (_, false) => (0.0, 0.5),
            };
            pass.set_viewport(x, y, width, height, near, far);
            pass.set_scissor_rect(tile.x, tile.y, tile.width, tile.height);
            self.world.draw(&mut pass, &prepared.sight(index));
        }
        // On GL the samples are resolved at the end of the pass within whatever scissor is set then.
        pass.set_scissor_rect(0, 0, surface.size.0, surface.size.1);
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
        self.overlay.draw(&mut pass, &prepared.shapes);
        self.text.draw(&mut pass).map_err(|e| Error::Device(e.to_string()))
    }
}

/// All that a shadow map is drawn from.
fn casting(frames: &[FrameUniforms], prepared: &Prepared) -> Vec<u8> {
    let mut bytes = Vec::new();
    if let Some(frame) = frames.first() {
        bytes.extend_from_slice(bytemuck::bytes_of(&frame.shadow_from_local));
    }
    prepared.crowd.solid().for_each(|copy| bytes.extend_from_slice(bytemuck::bytes_of(copy)));
    prepared.props.all().for_each(|copy| bytes.extend_from_slice(bytemuck::bytes_of(copy)));
    bytes
}
