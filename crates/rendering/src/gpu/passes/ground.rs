//! Flat ground: asphalt and metre lines computed per pixel.

use super::asphalt::Asphalt;
use super::frame::FrameGroups;
use super::{Canvas, Recipe, developed, shader};
use crate::Gpu;

pub(crate) const SHADERS: [&str; 2] = developed!("common/light", "common/screen", "common/asphalt", "ground");

/// The local origin is a multiple of this, m: a common multiple of the lines and of both scales of the texture.
pub(crate) const TILE: f64 = 20.0;

/// Its pipeline.
#[derive(Debug)]
pub(crate) struct GroundPass {
    pipeline: wgpu::RenderPipeline,
}

impl GroundPass {
    pub(crate) fn new(gpu: &Gpu, canvas: Canvas, groups: &FrameGroups, asphalt: &Asphalt) -> Self {
        let pipeline = Recipe {
            label: "ground",
            source: canvas.of(SHADERS),
            groups: &[&groups.view_layout, &groups.light_layout, &asphalt.layout],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            colour: Some((canvas, None)),
            // No depth: what lies on the ground is painted over it in order, so nothing can flicker.
            depth: Some((wgpu::CompareFunction::Always, false)),
            ..Default::default()
        }
        .build(gpu);
        Self { pipeline }
    }

    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, asphalt: &Asphalt) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(2, &asphalt.group, &[]);
        pass.draw(0..4, 0..1);
    }
}
