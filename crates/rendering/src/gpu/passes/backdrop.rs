//! Sky and flat ground: two quads over the whole view, computed per pixel.

use super::asphalt::Asphalt;
use super::frame::FrameGroups;
use super::{Canvas, Recipe, developed, shader};
use crate::Gpu;
use wgpu::{BindGroup, RenderPass, RenderPipeline};

pub(crate) const SKY: [&str; 2] = developed!("common/light", "common/screen", "sky");
pub(crate) const GROUND: [&str; 2] = developed!("common/light", "common/screen", "common/asphalt", "ground");

/// The local origin is a multiple of this, m: a common multiple of the lines on the ground and of both scales of its texture.
pub(crate) const TILE: f64 = 20.0;

/// Their pipelines.
#[derive(Debug)]
pub(crate) struct BackdropPass {
    asphalt: BindGroup,
    sky: RenderPipeline,
    ground: RenderPipeline,
}

impl BackdropPass {
    pub(crate) fn new(gpu: &Gpu, canvas: Canvas, groups: &FrameGroups, asphalt: &Asphalt) -> Self {
        let groups = [&groups.view_layout, &groups.light_layout, &asphalt.layout];
        let recipe = Recipe {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            colour: Some((canvas, None)),
            // No depth: what lies on the ground is painted over it in order, so nothing can flicker.
            depth: Some((wgpu::CompareFunction::Always, false)),
            ..Default::default()
        };
        let (sky, ground) = (canvas.of(SKY), canvas.of(GROUND));
        Self {
            asphalt: asphalt.group.clone(),
            sky: Recipe { label: "sky", source: sky, groups: &groups[..2], ..recipe }.build(gpu),
            ground: Recipe { label: "ground", source: ground, groups: &groups, ..recipe }.build(gpu),
        }
    }

    pub(crate) fn draw_sky(&self, pass: &mut RenderPass<'_>) {
        pass.set_pipeline(&self.sky);
        pass.draw(0..4, 0..1);
    }

    pub(crate) fn draw_ground(&self, pass: &mut RenderPass<'_>) {
        pass.set_pipeline(&self.ground);
        pass.set_bind_group(2, &self.asphalt, &[]);
        pass.draw(0..4, 0..1);
    }
}
