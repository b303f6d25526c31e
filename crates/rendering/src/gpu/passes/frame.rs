//! What every pass knows of a view, and the light they share.

use crate::Gpu;
use crate::camera::Camera;
use crate::gpu::resources::sampled;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4};
use std::num::NonZeroU64;
use wgpu::{
    BindGroup, BindGroupLayout, BindingResource, BindingType, BufferBindingType, BufferUsages,
    SamplerBindingType, ShaderStages, TextureSampleType,
};

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
            ..Self::zeroed()
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
    pub(crate) fn new(gpu: &Gpu, shadow: &wgpu::TextureView) -> Self {
        let frame = BindingType::Buffer {
            ty: BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: FRAME_SIZE,
        };
        let view_layout = gpu.layout("frame", ShaderStages::VERTEX_FRAGMENT, &[frame]);
        let map = sampled(TextureSampleType::Depth);
        let comparison = BindingType::Sampler(SamplerBindingType::Comparison);
        let light_layout = gpu.layout("light", ShaderStages::FRAGMENT, &[map, comparison]);
        let (uniform, view) = views(gpu, &view_layout, 4);
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadow"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        let resources = vec![BindingResource::TextureView(shadow), BindingResource::Sampler(&sampler)];
        let light = gpu.group("light", &light_layout, resources);
        Self { view_layout, light_layout, view, light, uniform }
    }

    pub(crate) fn fill(&mut self, gpu: &Gpu, frames: &[FrameUniforms]) {
        let bytes: &[u8] = bytemuck::cast_slice(frames);
        if bytes.len() as u64 > self.uniform.size() {
            (self.uniform, self.view) =
                views(gpu, &self.view_layout, frames.len().next_power_of_two() as u64);
        }
        gpu.queue.write_buffer(&self.uniform, 0, bytes);
    }

    /// Where view `index` starts in the uniform.
    pub(crate) fn offset(index: usize) -> u32 {
        (index * size_of::<FrameUniforms>()) as u32
    }
}

/// Bytes of the frame of one view.
const FRAME_SIZE: Option<NonZeroU64> = NonZeroU64::new(size_of::<FrameUniforms>() as u64);

/// Room for the frames of `count` views, and the group through which one at a time is read.
fn views(gpu: &Gpu, layout: &BindGroupLayout, count: u64) -> (wgpu::Buffer, BindGroup) {
    let size = count * size_of::<FrameUniforms>() as u64;
    let uniform = gpu.buffer("frame", size, BufferUsages::UNIFORM | BufferUsages::COPY_DST);
    let one = wgpu::BufferBinding { buffer: &uniform, offset: 0, size: FRAME_SIZE };
    let group = gpu.group("frame", layout, vec![BindingResource::Buffer(one)]);
    (uniform, group)
}
