//! All passes of a picture, in the order in which they run.

use crate::crowd::Fleet;
use crate::floor::Floor;
use crate::passes::Canvas;
use crate::passes::asphalt::Asphalt;
use crate::passes::decal::{Corner, DecalPass, Layer};
use crate::passes::frame::{Frame, FrameGroups};
use crate::passes::ground::GroundPass;
use crate::passes::overlay::{OverlayPass, Shapes};
use crate::passes::prop::{Copies, PropPass};
use crate::passes::robot::{Crowd, Models, RobotPass};
use crate::passes::shadow::ShadowPass;
use crate::passes::sky::SkyPass;
use crate::passes::tag::TagPass;
use crate::passes::terrain::TerrainPass;
use crate::passes::text::{Line, TextPass};
use crate::target::Attachments;
use crate::{Error, Gpu, view::Tile};
use std::ops::Range;
use vocabulary::Cast;

/// Shows where triangles of the terrain do not quite meet.
const STONE: wgpu::Color = wgpu::Color { r: 0.42, g: 0.42, b: 0.41, a: 1.0 };

/// Robots from which on their models are plain.
const PLAIN_ABOVE: usize = 24;

/// Every pass with what it keeps on the device.
#[derive(Debug)]
pub(crate) struct Passes {
    groups: FrameGroups,
    models: Models,
    pub(crate) shadow: ShadowPass,
    asphalt: Asphalt,
    robot: RobotPass,
    tag: TagPass,
    ground: GroundPass,
    /// In place of the flat ground.
    terrain: Option<TerrainPass>,
    prop: Option<PropPass>,
    decal: DecalPass,
    sky: SkyPass,
    overlay: OverlayPass,
    pub(crate) text: TextPass,
}

/// What a picture consists of, once its data is on the device.
pub(crate) struct Prepared {
    pub(crate) crowd: Crowd,
    pub(crate) props: Copies,
    pub(crate) tiles: Vec<Tile>,
    /// Which decks hide a robot in each view.
    pub(crate) veiled: Vec<Vec<bool>>,
    /// Corners of each view.
    pub(crate) decals: Vec<[(Layer, Range<u32>); 4]>,
    /// Whether a view shows ghosts: near the ground they would veil what is behind them.
    pub(crate) ghosts: Vec<bool>,
    pub(crate) shapes: Shapes,
}

/// What a picture is drawn into.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surface<'a> {
    pub(crate) target: &'a wgpu::TextureView,
    pub(crate) attachments: &'a Attachments,
    pub(crate) size: (u32, u32),
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, canvas: Canvas, cast: &Cast, fleet: &Fleet, floor: &Floor) -> Self {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let flat = Canvas { samples: 1, ..canvas };
        let robots = cast.members.len();
        let mut text = TextPass::new(device, queue, flat);
        let map = ShadowPass::map(device, robots > 12 || !cast.props.is_empty());
        let groups = FrameGroups::new(device, &map.0);
        let asphalt = Asphalt::new(device, queue);
        let digits = text.digits();
        let terrain = cast.terrain.as_deref();
        let (with_props, with_decks) = (!cast.props.is_empty(), !floor.decks.is_empty());
        Self {
            models: Models::new(device, queue, robots > PLAIN_ABOVE, &fleet.builds),
            shadow: ShadowPass::new(device, &groups, map),
            robot: RobotPass::new(device, queue, canvas, &groups, digits),
            tag: TagPass::new(device, queue, canvas, &groups),
            ground: GroundPass::new(device, canvas, &groups, &asphalt),
            terrain: terrain.map(|t| TerrainPass::new(device, queue, canvas, &groups, &asphalt, t)),
            prop: with_props.then(|| PropPass::new(device, queue, canvas, &groups, &asphalt, with_decks)),
            decal: DecalPass::new(device, canvas, &groups, !floor.is_plane()),
            sky: SkyPass::new(device, canvas, &groups),
            overlay: OverlayPass::new(device, flat),
            asphalt,
            text,
            groups,
        }
    }

    /// Brings a picture's data to the device.
    pub(crate) fn upload(
        &mut self,
        gpu: &Gpu,
        (width, height): (u32, u32),
        frames: &[Frame],
        prepared: &mut Prepared,
        corners: &[Corner],
        lines: &[Line],
    ) -> Result<(), Error> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        self.groups.fill(queue, frames);
        self.models.fill(device, queue, std::iter::once(&mut prepared.crowd));
        if let Some(prop) = &mut self.prop {
            prop.fill(device, queue, &prepared.props);
        }
        self.decal.fill(device, queue, corners);
        self.overlay.fill(device, queue, [width as f32, height as f32], &prepared.shapes);
        self.text.fill(device, queue, [width, height], lines).map_err(|e| Error::Device(e.to_string()))
    }

    pub(crate) fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        surface: Surface<'_>,
        prepared: &Prepared,
    ) -> Result<(), Error> {
        self.encode_shadow(encoder, prepared);
        self.encode_world(encoder, surface, prepared);
        self.encode_overlay(encoder, surface.target, prepared)
    }

    fn encode_shadow(&self, encoder: &mut wgpu::CommandEncoder, prepared: &Prepared) {
        let mut pass = self.shadow.begin(encoder, &self.groups);
        self.models.draw_solid(&mut pass, &prepared.crowd);
        self.models.draw_faces(&mut pass, &prepared.crowd);
        if let Some(prop) = &self.prop {
            prop.draw_solid(&mut pass, &prepared.props);
        }
    }

    /// Flat ground and sky are painted first and without depth: robots cover little of them, and on processors the
    /// depth test of every pixel would cost more than shading the few that are hidden.
    fn encode_world(&self, encoder: &mut wgpu::CommandEncoder, surface: Surface<'_>, prepared: &Prepared) {
        let sampled = surface.attachments.sampled.as_ref();
        let store = if sampled.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("world"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: sampled.unwrap_or(surface.target),
                depth_slice: None,
                resolve_target: sampled.map(|_| surface.target),
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(STONE), store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &surface.attachments.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        for (index, tile) in prepared.tiles.iter().enumerate() {
            let [x, y, width, height] = [tile.x, tile.y, tile.width, tile.height].map(|n| n as f32);
            pass.set_viewport(x, y, width, height, 0.0, 1.0);
            pass.set_scissor_rect(tile.x, tile.y, tile.width, tile.height);
            self.draw_view(&mut pass, index, prepared);
        }
        // On GL the samples are resolved at the end of the pass within whatever scissor is set then.
        pass.set_scissor_rect(0, 0, surface.size.0, surface.size.1);
    }

    fn draw_view(&self, pass: &mut wgpu::RenderPass<'_>, index: usize, prepared: &Prepared) {
        let [under @ .., (layer, over)] = &prepared.decals[index];
        pass.set_bind_group(0, &self.groups.view, &[FrameGroups::offset(index)]);
        pass.set_bind_group(1, &self.groups.light, &[]);
        self.sky.draw(pass);
        match &self.terrain {
            Some(terrain) => terrain.draw(pass, &self.asphalt),
            None => self.ground.draw(pass, &self.asphalt),
        }
        let veiled = &prepared.veiled[index];
        if let Some(prop) = &self.prop {
            prop.draw_decks(pass, &self.asphalt, &prepared.props, veiled);
        }
        for (layer, corners) in under {
            self.decal.draw(pass, corners, *layer);
        }
        self.robot.draw_solid(pass, &self.models, &prepared.crowd);
        self.tag.draw(pass, &self.models, &prepared.crowd);
        // After the robots, which show through those in front of them.
        if let Some(prop) = &self.prop {
            prop.draw(pass, &self.asphalt, &prepared.props, veiled);
        }
        if prepared.ghosts[index] {
            self.robot.draw_ghosts(pass, &self.models, &prepared.crowd);
        }
        self.decal.draw(pass, over, *layer);
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
