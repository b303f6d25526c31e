//! What every pass knows of a view, and the light they share.

use super::DEPTH;
use crate::camera::Camera;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4};
use wgpu::{BindGroup, BindGroupLayout, Device, ShaderStages};

/// Mirrors `FrameUniforms` of the shaders.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct FrameUniforms {
    pub(crate) clip_from_local: [[f32; 4]; 4],
    pub(crate) shadow_from_local: [[f32; 4]; 4],
    pub(crate) eye: [f32; 4],
    pub(crate) right: [f32; 4],
    pub(crate) up: [f32; 4],
    pub(crate) forward: [f32; 4],
    pub(crate) sun: [f32; 4],
    pub(crate) ground: [f32; 4],
    pub(crate) terrain: [f32; 4],
    pub(crate) spare: [f32; 4],
}

impl FrameUniforms {
    /// The frame of `camera` with positions relative to `origin`.
    pub(crate) fn new(camera: &Camera, origin: DVec3, shadow_from_local: Mat4) -> Self {
        let middle = camera.forward + camera.right * camera.shift.x + camera.up * camera.shift.y;
        let [eye, right, up, forward] =
            [camera.eye - origin, camera.right * camera.half.x, camera.up * camera.half.y, middle]
                .map(DVec3::as_vec3);
        let [height, slope, above] = camera.skyline().map(|x| x as f32);
        Self {
            clip_from_local: camera.clip_from_local(origin).to_cols_array_2d(),
            shadow_from_local: shadow_from_local.to_cols_array_2d(),
            eye: eye.extend(f32::from(u8::from(camera.perspective))).to_array(),
            right: right.extend(slope).to_array(),
            up: up.extend(height).to_array(),
            forward: forward.extend(above).to_array(),
            sun: [0.0; 4],
            ground: [0.0; 4],
            terrain: [0.0; 4],
            spare: [0.0; 4],
        }
    }
}

/// Bind groups of the view and of its light.
#[derive(Debug)]
pub(crate) struct FrameGroups {
    pub(crate) view_layout: BindGroupLayout,
    pub(crate) light_layout: BindGroupLayout,
    pub(crate) view: BindGroup,
    pub(crate) light: BindGroup,
    uniform: wgpu::Buffer,
}

impl FrameGroups {
    pub(crate) fn new(device: &Device, shadow: &wgpu::TextureView) -> Self {
        let view_layout = view_layout(device);
        let light_layout = light_layout(device);
        let (uniform, view) = views(device, &view_layout, 4);
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadow"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        let light = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("light"),
            layout: &light_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(shadow) },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
            ],
        });
        Self { view_layout, light_layout, view, light, uniform }
    }

    pub(crate) fn fill(&mut self, device: &Device, queue: &wgpu::Queue, frames: &[FrameUniforms]) {
        let bytes: &[u8] = bytemuck::cast_slice(frames);
        if bytes.len() as u64 > self.uniform.size() {
            (self.uniform, self.view) =
                views(device, &self.view_layout, frames.len().next_power_of_two() as u64);
        }
        queue.write_buffer(&self.uniform, 0, bytes);
    }

    /// Where view `index` starts in the uniform.
    pub(crate) fn offset(index: usize) -> u32 {
        (index * size_of::<FrameUniforms>()) as u32
    }
}

/// Room for the frames of `count` views, and the group through which one at a time is read.
fn views(device: &Device, layout: &BindGroupLayout, count: u64) -> (wgpu::Buffer, BindGroup) {
    let uniform = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("frame"),
        size: count * size_of::<FrameUniforms>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let one = wgpu::BufferBinding {
        buffer: &uniform,
        offset: 0,
        size: std::num::NonZeroU64::new(size_of::<FrameUniforms>() as u64),
    };
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("frame"),
        layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(one) }],
    });
    (uniform, group)
}

fn view_layout(device: &Device) -> BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("frame"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: true,
                min_binding_size: std::num::NonZeroU64::new(size_of::<FrameUniforms>() as u64),
            },
            count: None,
        }],
    })
}

fn light_layout(device: &Device) -> BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("light"),
        entries: &[
            wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Depth,
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            },
            wgpu::BindGroupLayoutEntry {
                binding: 1,
                visibility: ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
                count: None,
            },
        ],
    })
}

/// A depth texture to draw into, and to read where it is a shadow map.
pub(crate) fn depth_texture(device: &Device, size: [u32; 2], samples: u32, read: bool) -> wgpu::TextureView {
    let binding = if read { wgpu::TextureUsages::TEXTURE_BINDING } else { wgpu::TextureUsages::empty() };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("depth"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | binding,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
