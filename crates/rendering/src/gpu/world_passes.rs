//! The passes that draw the world: ground and sky, paint, robots, props and their shadows.

use crate::Gpu;
use crate::camera::Camera;
use crate::fleet_model::FleetModel;
use crate::gpu::model::Detail;
use crate::gpu::passes::Canvas;
use crate::gpu::passes::asphalt::Asphalt;
use crate::gpu::passes::backdrop::BackdropPass;
use crate::gpu::passes::decal::{DecalLayer, DecalPass, DecalVertex};
use crate::gpu::passes::frame::{FrameGroups, FrameUniforms};
use crate::gpu::passes::prop::{PropInstances, PropPass, Veil};
use crate::gpu::passes::robot::{Models, RobotInstances, RobotPass};
use crate::gpu::passes::shadow::ShadowPass;
use crate::gpu::passes::tag::TagPass;
use crate::gpu::passes::terrain::TerrainPass;
use std::ops::Range;

/// Every pass with what it keeps on the device.
#[derive(Debug)]
pub(crate) struct WorldPasses {
    groups: FrameGroups,
    pub(crate) models: Models,
    pub(crate) shadow: ShadowPass,
    robot: RobotPass,
    tag: TagPass,
    backdrop: BackdropPass,
    /// In place of the flat ground.
    terrain: Option<TerrainPass>,
    prop: Option<PropPass>,
    decal: DecalPass,
}

/// What there is to see in a view.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SceneView<'a> {
    /// Of the view, among those uploaded.
    pub(crate) index: usize,
    pub(crate) camera: &'a Camera,
    pub(crate) crowd: &'a RobotInstances,
    pub(crate) props: &'a PropInstances,
    /// Which decks hide a robot.
    pub(crate) veiled: &'a [bool],
    /// Paint and shadows on the floor, in order.
    pub(crate) under: &'a [(DecalLayer, Range<u32>)],
    /// Paint that shows through the robots.
    pub(crate) over: Option<&'a (DecalLayer, Range<u32>)>,
    /// Whether it shows ghosts.
    pub(crate) ghosts: bool,
    /// Of its robots.
    pub(crate) detail: Detail,
}

impl WorldPasses {
    /// The first canvas is for sky, flat ground, paint and ghosts, the second for all that is solid; `shadows` is the side of
    /// the shadow map in texels.
    pub(crate) fn new(gpu: &Gpu, [flat, canvas]: [Canvas; 2], model: &FleetModel, shadows: u32) -> Self {
        let FleetModel { fleet, floor, robots, .. } = model;
        let map = ShadowPass::map(gpu, shadows);
        let groups = FrameGroups::new(gpu, &map);
        let asphalt = Asphalt::new(gpu);
        let terrain = fleet.terrain.as_deref();
        // What is seen through needs an opacity, which a monochrome picture has not.
        let veil = match (canvas.mono, floor.drivables.is_empty()) {
            (true, _) => Veil::None,
            (false, true) => Veil::All,
            (false, false) => Veil::ButDecks,
        };
        let prop = || PropPass::new(gpu, canvas, &groups, &asphalt, veil);
        Self {
            models: Models::new(gpu, &robots.builds),
            robot: RobotPass::new(gpu, [flat, canvas], &groups),
            tag: TagPass::new(gpu, canvas, &groups),
            backdrop: BackdropPass::new(gpu, flat, &groups, &asphalt),
            terrain: terrain.map(|t| TerrainPass::new(gpu, canvas, &groups, &asphalt, t)),
            prop: (!fleet.props.is_empty()).then(prop),
            decal: DecalPass::new(gpu, flat, &groups, !floor.is_plane()),
            shadow: ShadowPass::new(gpu, &groups, map, shadows),
            groups,
        }
    }

    /// Brings a picture's data to the device; every crowd and all props are drawn from there.
    pub(crate) fn upload<'a>(
        &mut self,
        gpu: &Gpu,
        frames: &[FrameUniforms],
        crowds: impl Iterator<Item = &'a mut RobotInstances>,
        props: impl Iterator<Item = &'a mut PropInstances>,
        corners: &[DecalVertex],
    ) {
        self.groups.fill(gpu, frames);
        self.models.fill(gpu, crowds);
        if let Some(prop) = &mut self.prop {
            prop.fill(gpu, props);
        }
        self.decal.fill(gpu, corners);
    }

    pub(crate) fn encode_shadow(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        crowd: &RobotInstances,
        props: &PropInstances,
        detail: Detail,
    ) {
        let mut pass = self.shadow.begin(encoder, &self.groups);
        self.models.draw_solid(&mut pass, crowd, detail);
        self.models.draw_faces(&mut pass, crowd);
        if let Some(prop) = &self.prop {
            prop.draw_solid(&mut pass, props);
        }
    }

    /// Draws a view with all that is in it.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, sight: &SceneView<'_>) {
        self.draw_ground(pass, sight);
        self.draw_robots(pass, sight);
        self.draw_over(pass, sight, false);
    }

    fn bind(&self, pass: &mut wgpu::RenderPass<'_>, sight: &SceneView<'_>) {
        pass.set_bind_group(0, &self.groups.view, &[FrameGroups::offset(sight.index)]);
        pass.set_bind_group(1, &self.groups.light, &[]);
    }

    /// Flat ground and sky are painted first and without depth: robots cover little of them, and on processors the
    /// depth test of every pixel would cost more than shading the few that are hidden.
    pub(crate) fn draw_ground(&self, pass: &mut wgpu::RenderPass<'_>, sight: &SceneView<'_>) {
        self.bind(pass, sight);
        self.backdrop.draw_sky(pass);
        match &self.terrain {
            Some(terrain) => terrain.draw(pass, sight.camera),
            None => self.backdrop.draw_ground(pass),
        }
        if let Some(prop) = &self.prop {
            prop.draw_decks(pass, sight.props, sight.veiled);
        }
        for (layer, corners) in sight.under {
            self.decal.draw(pass, corners, *layer);
        }
    }

    /// Robots and props.
    pub(crate) fn draw_robots(&self, pass: &mut wgpu::RenderPass<'_>, sight: &SceneView<'_>) {
        self.bind(pass, sight);
        // Faces first: they hide much of the rest.
        self.tag.draw(pass, &self.models, sight.crowd);
        self.robot.draw_solid(pass, &self.models, sight.crowd, sight.detail);
        // After the robots, which show through those in front of them.
        if let Some(prop) = &self.prop {
            prop.draw(pass, sight.props, sight.veiled);
        }
    }

    /// Ghosts, and what shows through the robots, whose depth is not there yet where they are drawn apart.
    pub(crate) fn draw_over(&self, pass: &mut wgpu::RenderPass<'_>, sight: &SceneView<'_>, apart: bool) {
        self.bind(pass, sight);
        if sight.ghosts {
            self.robot.draw_ghosts(pass, &self.models, sight.crowd, apart);
        }
        if let Some((layer, corners)) = sight.over {
            self.decal.draw(pass, corners, *layer);
        }
    }
}
