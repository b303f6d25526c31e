//! All passes of a picture, in the order in which they run.

use crate::annotation::text_shaper::TextShaper;
use crate::camera::Camera;
use crate::fleet_model::FleetModel;
use crate::gpu::model::Detail;
use crate::gpu::passes::Canvas;
use crate::gpu::passes::decal::{DecalLayer, DecalVertex};
use crate::gpu::passes::frame::FrameUniforms;
use crate::gpu::passes::overlay::{OverlayPass, Shapes};
use crate::gpu::passes::prop::PropInstances;
use crate::gpu::passes::robot::RobotInstances;
use crate::gpu::passes::text::{TextLine, TextPass};
use crate::gpu::target::{Attachments, confine};
use crate::gpu::world_passes::{SceneView, WorldPasses};
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
    pub(crate) props: PropInstances,
    pub(crate) views: Vec<PreparedView>,
    /// How many of the views, the last, lie over others.
    pub(crate) upper: usize,
    pub(crate) shapes: Shapes,
    /// Its texts.
    pub(crate) lines: Vec<TextLine>,
    /// Whether the shadow map is as it should be.
    pub(crate) shadowed: bool,
}

/// What one view consists of.
pub(crate) struct PreparedView {
    pub(crate) camera: Camera,
    pub(crate) tile: Tile,
    /// Of a view through a camera: what it may see.
    pub(crate) own: Option<RobotInstances>,
    /// Which decks hide a robot.
    pub(crate) veiled: Vec<bool>,
    pub(crate) decals: [(DecalLayer, Range<u32>); 5],
    /// Whether it shows ghosts: near the ground they would veil what is behind them.
    pub(crate) ghosts: bool,
}

impl Prepared {
    fn sight(&self, index: usize) -> SceneView<'_> {
        let view = &self.views[index];
        let [under @ .., over] = &view.decals;
        SceneView {
            index,
            camera: &view.camera,
            crowd: view.own.as_ref().unwrap_or(&self.crowd),
            props: &self.props,
            veiled: &view.veiled,
            under,
            over: Some(over),
            ghosts: view.ghosts,
        }
    }
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, canvas: Canvas, model: &FleetModel) -> Self {
        let FleetInfo { robots, props, .. } = &model.fleet;
        let detail = if robots.len() > PLAIN_ABOVE { Detail::Plain } else { Detail::Full };
        let flat = Canvas { samples: 1, ..canvas };
        let side = if robots.len() > 12 || !props.is_empty() { 2048 } else { 1024 };
        Self {
            world: WorldPasses::new(gpu, canvas, model, detail, side),
            overlay: OverlayPass::new(gpu, flat),
            text: TextPass::new(gpu, flat),
            shadowed: None,
        }
    }

    /// Brings a picture's data to the device.
    pub(crate) fn upload(
        &mut self,
        gpu: &Gpu,
        size: [u32; 2],
        frames: &[FrameUniforms],
        prepared: &mut Prepared,
        corners: &[DecalVertex],
        letters: &mut TextShaper,
    ) -> Result<(), Error> {
        let own = prepared.views.iter_mut().filter_map(|view| view.own.as_mut());
        let (crowds, props) = (once(&mut prepared.crowd).chain(own), once(&mut prepared.props));
        self.world.upload(gpu, frames, crowds, props, corners);
        self.overlay.fill(gpu, size.map(|side| side as f32), &prepared.shapes);
        let written = self.text.fill(gpu, size, &prepared.lines, letters);
        written.map_err(|e| Error::Device(e.to_string()))?;
        let casting = Some(casting(frames, prepared));
        prepared.shadowed = self.shadowed == casting;
        self.shadowed = casting;
        Ok(())
    }

    /// Forgets the shadow map, whose content is unknown after a failed picture.
    pub(crate) fn forget(&mut self) {
        self.shadowed = None;
    }

    /// Draws a picture into a target.
    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        attachments: &Attachments,
        prepared: &Prepared,
    ) -> Result<(), Error> {
        if !prepared.shadowed {
            self.world.encode_shadow(encoder, &prepared.crowd, &prepared.props);
        }
        let views = &prepared.views;
        attachments.draw(encoder, target, STONE, |pass| {
            for (index, view) in views.iter().enumerate() {
                // What lies over others is nearer than all of them.
                let depths = match (prepared.upper, index + prepared.upper < views.len()) {
                    (0, _) => [0.0, 1.0],
                    (_, true) => [0.5, 1.0],
                    (_, false) => [0.0, 0.5],
                };
                confine(pass, &view.tile, depths);
                self.world.draw(pass, &prepared.sight(index));
            }
        });
        self.encode_overlay(encoder, target, prepared)
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
