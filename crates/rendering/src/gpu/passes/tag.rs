//! The faces of shells with the tags on them.

use super::frame::FrameGroups;
use super::instanced::LAYOUTS;
use super::robot::{Models, RobotInstances};
use super::{Canvas, Recipe, developed, shader};
use crate::Gpu;
use crate::gpu::resources::{flat_texture, rows, sampled};
use vocabulary::{TAGS, tag_code};
use wgpu::{BindingResource, TextureFormat, TextureUsages};

pub(crate) const SHADERS: [&str; 2] = developed!("common/light", "common/robot", "tag");

/// Pipeline and the codes of the family.
#[derive(Debug)]
pub(crate) struct TagPass {
    pipeline: wgpu::RenderPipeline,
    codes: wgpu::BindGroup,
}

impl TagPass {
    pub(crate) fn new(gpu: &Gpu, canvas: Canvas, groups: &FrameGroups) -> Self {
        let texels = sampled(wgpu::TextureSampleType::Uint);
        let layout = gpu.layout("codes", wgpu::ShaderStages::VERTEX, &[texels]);
        let view = codes(gpu).create_view(&wgpu::TextureViewDescriptor::default());
        let codes = gpu.group("codes", &layout, vec![BindingResource::TextureView(&view)]);
        let pipeline = Recipe {
            label: "tag",
            source: canvas.of(SHADERS),
            groups: &[&groups.view_layout, &groups.light_layout, &layout],
            buffers: &LAYOUTS,
            cull: true,
            colour: Some((canvas, None)),
            depth: Some((wgpu::CompareFunction::Less, true)),
            ..Default::default()
        }
        .build(gpu);
        Self { pipeline, codes }
    }

    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, models: &Models, crowd: &RobotInstances) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(2, &self.codes, &[]);
        models.draw_faces(pass, crowd);
    }
}

/// All codes, a texel each: the low 32 bits, and those above.
fn codes(gpu: &Gpu) -> wgpu::Texture {
    let code = |id: usize| tag_code(id as u16).unwrap_or_default();
    let texels: Vec<[u32; 2]> = (0..TAGS).map(code).map(|c| [c as u32, (c >> 32) as u32]).collect();
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let descriptor = flat_texture("codes", [TAGS as u32, 1], TextureFormat::Rg32Uint, usage);
    let texture = gpu.device.create_texture(&descriptor);
    let (bytes, pitch) = (bytemuck::cast_slice(&texels), rows(8 * TAGS as u32));
    gpu.queue.write_texture(texture.as_image_copy(), bytes, pitch, descriptor.size);
    texture
}
