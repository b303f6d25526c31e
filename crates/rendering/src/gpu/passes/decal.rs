//! Paint on the ground, in the order in which it lies there.

use super::frame::FrameGroups;
use super::{Canvas, Recipe, StreamBuffer, developed, shader, vertices};
use crate::Gpu;
use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use std::ops::Range;
use wgpu::{RenderPass, vertex_attr_array};

pub(crate) const SHADERS: [&str; 2] = developed!("common/light", "decal");

/// Mirrors `DecalVertex` of the shader.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct DecalVertex {
    pub(crate) position: [f32; 3],
    pub(crate) kind: [f32; 2],
    pub(crate) shape: [f32; 2],
    pub(crate) colour: [f32; 4],
}

impl DecalVertex {
    /// A corner at a place relative to the local origin, m.
    pub(crate) fn new(place: DVec3, form: DecalForm, shape: [f32; 2], colour: [f32; 4]) -> Self {
        Self { position: place.as_vec3().to_array(), kind: form.code(), shape, colour }
    }
}

/// How a decal's edge is formed; see `coverage` in the shader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum DecalForm {
    /// Full between its long sides.
    Solid,
    /// A ring whose hole has this share of the radius.
    Ring(f32),
    /// Fading from the middle.
    Blob,
    /// A box that is full up to this share of its sides.
    SoftBox(f32),
    /// As dark as the shadow map says: for corners of [`DecalLayer::Shadow`].
    Shadow,
    /// A band along which dashes fill this share of every unit: for corners of [`DecalLayer::Annotations`], as are the next.
    Dashes(f32),
    /// Stripes that fill this share of every unit.
    Stripes(f32),
    /// Light on both sides of a circle with this share of the radius.
    Glow(f32),
}

/// What corners a view has, in the order in which they are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DecalLayer {
    /// Paint on the ground.
    Paint,
    /// Annotations.
    Annotations,
    /// Cast shadows over it.
    Shadow,
    /// What shows through the robots.
    Over,
}

impl DecalForm {
    pub(crate) fn code(self) -> [f32; 2] {
        match self {
            Self::Solid | Self::Shadow => [0.0, 0.0],
            Self::Ring(hole) => [1.0, hole],
            Self::Blob => [2.0, 0.0],
            Self::SoftBox(full) => [3.0, full],
            Self::Dashes(full) => [4.0, full],
            Self::Stripes(full) => [5.0, full],
            Self::Glow(share) => [6.0, share],
        }
    }
}

/// Pipeline and the corners of this picture.
#[derive(Debug)]
pub(crate) struct DecalPass {
    over: wgpu::RenderPipeline,
    /// On the floor: behind hills and decks there is nothing to see of it.
    paint: wgpu::RenderPipeline,
    /// Apart from paint, which has fewer forms to tell apart; monochrome cameras see none.
    annotations: Option<wgpu::RenderPipeline>,
    shadow: wgpu::RenderPipeline,
    corners: StreamBuffer,
}

impl DecalPass {
    pub(crate) const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
        vertex_attr_array![0 => Float32x3, 1 => Float32x2, 2 => Float32x2, 3 => Float32x4];

    /// On hills and decks depth is tested.
    pub(crate) fn new(gpu: &Gpu, canvas: Canvas, groups: &FrameGroups, uneven: bool) -> Self {
        let recipe = Recipe {
            label: "decal",
            source: canvas.of(SHADERS),
            groups: &[&groups.view_layout, &groups.light_layout],
            buffers: &[vertices::<DecalVertex>(&Self::ATTRIBUTES)],
            colour: Some((canvas, Some(wgpu::BlendState::ALPHA_BLENDING))),
            depth: Some((wgpu::CompareFunction::Always, false)),
            ..Default::default()
        };
        let test = if uneven { wgpu::CompareFunction::LessEqual } else { wgpu::CompareFunction::Always };
        let paint = Recipe { depth: Some((test, false)), ..recipe };
        // Where every millisecond counts.
        let shadow = if canvas.mono { "shadow_quick" } else { "shadow" };
        Self {
            over: recipe.build(gpu),
            paint: paint.build(gpu),
            annotations: (!canvas.mono)
                .then(|| Recipe { label: "sketch", entry: "sketch", ..paint }.build(gpu)),
            shadow: Recipe { label: "shadow decal", entry: shadow, ..paint }.build(gpu),
            corners: StreamBuffer::new(gpu, "decals", wgpu::BufferUsages::VERTEX),
        }
    }

    pub(crate) fn fill(&mut self, gpu: &Gpu, corners: &[DecalVertex]) {
        self.corners.fill(gpu, bytemuck::cast_slice(corners));
    }

    /// Draws corners of one view.
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>, corners: &Range<u32>, layer: DecalLayer) {
        let pipeline = match layer {
            DecalLayer::Paint => Some(&self.paint),
            DecalLayer::Annotations => self.annotations.as_ref(),
            DecalLayer::Shadow => Some(&self.shadow),
            DecalLayer::Over => Some(&self.over),
        };
        if let (Some(pipeline), false) = (pipeline, corners.is_empty()) {
            pass.set_pipeline(pipeline);
            pass.set_vertex_buffer(0, self.corners.slice());
            pass.draw(corners.clone(), 0..1);
        }
    }
}
