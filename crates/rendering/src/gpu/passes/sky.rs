//! The sky above the horizon.

use super::frame::FrameGroups;
use super::{Canvas, Recipe, developed, shader};
use crate::Gpu;

pub(crate) const SHADERS: [&str; 2] = developed!("common/light", "common/screen", "sky");

/// Its pipeline.
#[derive(Debug)]
pub(crate) struct SkyPass {
    pipeline: wgpu::RenderPipeline,
}

impl SkyPass {
    pub(crate) fn new(gpu: &Gpu, canvas: Canvas, groups: &FrameGroups) -> Self {
        let pipeline = Recipe {
            label: "sky",
            source: canvas.of(SHADERS),
            groups: &[&groups.view_layout, &groups.light_layout],
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            colour: Some((canvas, None)),
            depth: Some((wgpu::CompareFunction::Always, false)),
            ..Default::default()
        }
        .build(gpu);
        Self { pipeline }
    }

    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.draw(0..4, 0..1);
    }
}
