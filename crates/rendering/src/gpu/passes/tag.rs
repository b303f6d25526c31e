//! The faces of shells with the tags on them.

use super::frame::FrameGroups;
use super::robot::{Models, RobotInstances};
use super::{Canvas, Recipe, developed, shader};
use vocabulary::{TAGS, tag_code};
use wgpu::{Device, Queue};

pub(crate) const SHADERS: [&str; 2] = developed!("common/light", "common/robot", "tag");

/// Pipeline and the codes of the family.
#[derive(Debug)]
pub(crate) struct TagPass {
    pipeline: wgpu::RenderPipeline,
    codes: wgpu::BindGroup,
}

impl TagPass {
    pub(crate) fn new(device: &Device, queue: &Queue, canvas: Canvas, groups: &FrameGroups) -> Self {
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("codes"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Uint,
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let view = codes(device, queue).create_view(&wgpu::TextureViewDescriptor::default());
        let codes = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("codes"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&view),
            }],
        });
        let pipeline = Recipe {
            label: "tag",
            source: canvas.of(SHADERS),
            groups: &[&groups.view_layout, &groups.light_layout, &layout],
            buffers: &Models::LAYOUTS,
            cull: true,
            colour: Some((canvas, None)),
            depth: Some((wgpu::CompareFunction::Less, true)),
            ..Default::default()
        }
        .build(device);
        Self { pipeline, codes }
    }

    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, models: &Models, crowd: &RobotInstances) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(2, &self.codes, &[]);
        models.draw_faces(pass, crowd);
    }
}

/// All codes, a texel each: the low 32 bits, and those above.
fn codes(device: &Device, queue: &Queue) -> wgpu::Texture {
    let code = |id: usize| tag_code(id as u16).unwrap_or_default();
    let texels: Vec<[u32; 2]> = (0..TAGS).map(code).map(|c| [c as u32, (c >> 32) as u32]).collect();
    let size = wgpu::Extent3d { width: TAGS as u32, height: 1, depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("codes"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rg32Uint,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let rows =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * size.width), rows_per_image: None };
    queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&texels), rows, size);
    texture
}
