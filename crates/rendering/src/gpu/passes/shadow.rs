//! The shadow map: depth of robots and props as the sun sees them, fitted to the formation and shared by all views.

use super::frame::FrameGroups;
use super::instanced::LAYOUTS;
use super::{DEPTH, Recipe, shader};
use crate::Gpu;
use crate::gpu::resources::flat_texture;
use glam::{DMat4, DVec3, Mat4};
use wgpu::{CommandEncoder, RenderPass, TextureUsages};

pub(crate) const SHADER: &str = shader!("common/frame", "common/robot", "shadow");

/// Half the width of a soft edge, m.
const PENUMBRA: f64 = 0.02;

/// Map and pipeline.
#[derive(Debug)]
pub(crate) struct ShadowPass {
    map: wgpu::TextureView,
    size: u32,
    pipeline: wgpu::RenderPipeline,
}

/// How the sun's view is laid over the ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SunView {
    pub(crate) shadow_from_local: Mat4,
    /// Half the side of the map, m.
    half: f64,
}

impl ShadowPass {
    /// The map comes before the bind groups that read it, the pipeline after.
    pub(crate) fn map(gpu: &Gpu, size: u32) -> wgpu::TextureView {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let texture = gpu.device.create_texture(&flat_texture("shadow", [size, size], DEPTH, usage));
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    pub(crate) fn new(gpu: &Gpu, groups: &FrameGroups, map: wgpu::TextureView, size: u32) -> Self {
        let pipeline = Recipe {
            label: "shadow",
            source: SHADER,
            groups: &[&groups.view_layout],
            buffers: &LAYOUTS,
            depth: Some((wgpu::CompareFunction::Less, true)),
            bias: wgpu::DepthBiasState { constant: 2, slope_scale: 1.5, clamp: 0.0 },
            ..Default::default()
        }
        .build(gpu);
        Self { map, size, pipeline }
    }

    /// Softness of the edges in texture coordinates.
    pub(crate) fn penumbra(&self, sun: &SunView) -> f32 {
        // Never less than a texel, or the filter would show its grid.
        (PENUMBRA / (2.0 * sun.half)).max(0.9 / f64::from(self.size)) as f32
    }

    /// How far from a surface its light is looked up, m: farther than the filter reaches, or it would shade itself.
    pub(crate) fn clearance(&self, sun: &SunView) -> f32 {
        (2.0 * sun.half * (0.6 * f64::from(self.penumbra(sun)) + 1.5 / f64::from(self.size))).max(0.012)
            as f32
    }

    /// The pass into which all that casts shadows is drawn.
    pub(crate) fn begin<'a>(&self, encoder: &'a mut CommandEncoder, groups: &FrameGroups) -> RenderPass<'a> {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.map,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &groups.view, &[0]);
        pass
    }
}

/// The view of a sun in direction `sun` of everything within `radius` of `centre` (relative to the local origin).
pub(crate) fn sun_view(sun: DVec3, centre: DVec3, radius: f64) -> SunView {
    let half = radius.max(0.8);
    // Any direction will do where the sun is straight above.
    let right = DVec3::Z.cross(sun).normalize_or(DVec3::X);
    let up = sun.cross(right);
    let depth = 2.0 * half + 2.0;
    let row = |axis: DVec3, scale: f64, shift: f64| (axis * scale).extend(shift - axis.dot(centre) * scale);
    let rows = DMat4::from_cols(
        row(right, 1.0 / half, 0.0),
        row(up, 1.0 / half, 0.0),
        row(-sun, 0.5 / depth, 0.5),
        glam::DVec4::W,
    );
    SunView { shadow_from_local: rows.transpose().as_mat4(), half }
}
