//! All passes of a picture, in the order in which they run.

use crate::annotation::text_shaper::TextShaper;
use crate::camera::Camera;
use crate::fleet_model::FleetModel;
use crate::gpu::model::Detail;
use crate::gpu::passes::Canvas;
use crate::gpu::passes::decal::{DecalLayer, DecalVertex};
use crate::gpu::passes::frame::FrameUniforms;
use crate::gpu::passes::layer::LayerPass;
use crate::gpu::passes::overlay::{OverlayPass, Shapes};
use crate::gpu::passes::prop::PropInstances;
use crate::gpu::passes::robot::RobotInstances;
use crate::gpu::passes::text::{TextLine, TextPass};
use crate::gpu::robot_groups::Groups;
use crate::gpu::target::{Attachments, confine};
use crate::gpu::world_passes::{SceneView, WorldPasses};
use crate::{Error, Gpu, camera::viewpoint::Tile};
use std::iter::once;
use std::ops::Range;
use vocabulary::FleetInfo;

/// Shows where triangles of the terrain do not quite meet.
const STONE: wgpu::Color = wgpu::Color { r: 0.42, g: 0.42, b: 0.41, a: 1.0 };

/// Every pass with what it keeps on the device.
#[derive(Debug)]
pub(crate) struct Passes {
    pub(crate) world: WorldPasses,
    /// Of the ground, or of everything.
    attachments: Attachments,
    /// Robots apart from the ground, which needs one sample a pixel where it is flat: several cost processors as much again
    /// as drawing it does.
    layer: Option<LayerPass>,
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
    /// What is in the picture of its robots, where these are drawn apart.
    pub(crate) groups: Groups,
    /// Of a view through a camera: what it may see.
    pub(crate) own: Option<RobotInstances>,
    /// Which decks hide a robot.
    pub(crate) veiled: Vec<bool>,
    pub(crate) decals: [(DecalLayer, Range<u32>); 5],
    /// Whether it shows ghosts: near the ground they would veil what is behind them.
    pub(crate) ghosts: bool,
    /// Of its robots.
    pub(crate) detail: Detail,
}

impl Prepared {
    /// Of the robots that cast shadows: spokes and lamps have none that anybody sees.
    fn casting_detail(&self) -> Detail {
        let shown = self.views.iter().map(|view| view.detail).max();
        shown.map_or(Detail::Plain, |most| most.min(Detail::Plain))
    }

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
            detail: view.detail,
        }
    }
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2], canvas: Canvas, model: &FleetModel) -> Self {
        let FleetInfo { robots, props, .. } = &model.fleet;
        let flat = canvas.flat();
        // What is seen through by the share of its samples, and what depth hides of the ground, need it all in one.
        let apart = canvas.samples > 1 && model.floor.is_plane() && props.is_empty();
        let ground = if apart { flat } else { canvas };
        let side = if robots.len() > 12 || !props.is_empty() { 2048 } else { 1024 };
        Self {
            world: WorldPasses::new(gpu, [ground, canvas], model, side),
            attachments: Attachments::new(gpu, size, ground),
            layer: apart.then(|| LayerPass::new(gpu, canvas)),
            overlay: OverlayPass::new(gpu, flat),
            text: TextPass::new(gpu, flat),
            shadowed: None,
        }
    }

    /// Whether robots are drawn apart from the ground.
    pub(crate) fn apart(&self) -> bool {
        self.layer.is_some()
    }

    /// Changes the size of the pictures.
    pub(crate) fn resize(&mut self, gpu: &Gpu, size: [u32; 2]) {
        self.attachments = Attachments::new(gpu, size, self.attachments.canvas);
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
        let views = prepared.views.iter_mut();
        let own = views.flat_map(|view| view.own.iter_mut().chain(view.groups.crowds()));
        let (crowds, props) = (once(&mut prepared.crowd).chain(own), once(&mut prepared.props));
        self.world.upload(gpu, frames, crowds, props, corners);
        self.overlay.fill(gpu, size.map(|side| side as f32), &prepared.shapes);
        let written = self.text.fill(gpu, size, &prepared.lines, letters);
        written.map_err(|e| Error::Device(e.to_string()))?;
        if let Some(layer) = &mut self.layer {
            layer.fit(gpu, prepared.views.iter().map(|view| view.groups.size));
        }
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
        prepared: &Prepared,
    ) -> Result<(), Error> {
        if !prepared.shadowed {
            self.world.encode_shadow(encoder, &prepared.crowd, &prepared.props, prepared.casting_detail());
        }
        match &self.layer {
            Some(layer) => self.encode_apart(encoder, target, layer, prepared),
            None => self.encode_whole(encoder, target, prepared),
        }
        self.encode_overlay(encoder, target, prepared)
    }

    /// View by view, the robots into their layer and that over the ground; later views lie over those before.
    fn encode_apart(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        layer: &LayerPass,
        prepared: &Prepared,
    ) {
        let mut load = wgpu::LoadOp::Clear(STONE);
        for (index, view) in prepared.views.iter().enumerate() {
            let sight = prepared.sight(index);
            layer.draw(encoder, &view.tile, &view.groups, |pass, crowd| {
                self.world.draw_robots(pass, &SceneView { crowd, ..sight });
            });
            self.attachments.draw(encoder, target, load, |pass| {
                confine(pass, &view.tile, [0.0, 1.0]);
                self.world.draw_ground(pass, &sight);
                layer.lay(pass, &view.groups);
                confine(pass, &view.tile, [0.0, 1.0]);
                self.world.draw_over(pass, &sight, true);
            });
            load = wgpu::LoadOp::Load;
        }
    }

    fn encode_whole(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        prepared: &Prepared,
    ) {
        let views = &prepared.views;
        self.attachments.draw(encoder, target, wgpu::LoadOp::Clear(STONE), |pass| {
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
    let mut bytes = vec![prepared.casting_detail() as u8];
    if let Some(frame) = frames.first() {
        bytes.extend_from_slice(bytemuck::bytes_of(&frame.shadow_from_local));
    }
    prepared.crowd.solid().for_each(|copy| bytes.extend_from_slice(bytemuck::bytes_of(copy)));
    prepared.props.all().for_each(|copy| bytes.extend_from_slice(bytemuck::bytes_of(copy)));
    bytes
}
