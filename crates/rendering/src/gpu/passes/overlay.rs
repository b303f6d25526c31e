//! Flat shapes in front of the picture: panels, curves, marks.

use super::{Canvas, Recipe, StreamBuffer, shader, vertices};
use crate::Gpu;
use bytemuck::{Pod, Zeroable};
use glam::Vec2;
use wgpu::{BufferUsages, vertex_attr_array};

pub(crate) const SHADER: &str = shader!("overlay");

/// Mirrors `OverlayVertex` of the shader.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct OverlayVertex {
    pub(crate) position: [f32; 2],
    pub(crate) offset: [f32; 2],
    pub(crate) half_size: [f32; 3],
    pub(crate) colour: [f32; 4],
}

/// Shapes of a picture, in pixels from its upper left.
#[derive(Debug, Clone, Default)]
pub(crate) struct Shapes {
    pub(crate) corners: Vec<OverlayVertex>,
}

impl Shapes {
    /// A box with rounded corners.
    pub(crate) fn panel(&mut self, [x, y, width, height]: [f32; 4], radius: f32, colour: [f32; 4]) {
        let half = Vec2::new(width, height) * 0.5;
        self.push(Vec2::new(x, y) + half, Vec2::X, half, radius, colour);
    }

    /// A straight line.
    pub(crate) fn line(&mut self, from: Vec2, to: Vec2, width: f32, colour: [f32; 4]) {
        let along = to - from;
        let half = Vec2::new(0.5 * along.length() + 0.5 * width, 0.5 * width);
        self.push((from + to) * 0.5, along.normalize_or(Vec2::X), half, 0.5 * width, colour);
    }

    /// A curve through places with their values that ends in a dot; `joins` tells whether a line leads from one value to
    /// the next.
    pub(crate) fn curve(
        &mut self,
        places: impl Iterator<Item = (Vec2, f32)>,
        joins: impl Fn(f32, f32) -> bool,
        width: f32,
        dot: f32,
        colour: [f32; 4],
    ) {
        let mut before: Option<(Vec2, f32)> = None;
        for (at, value) in places {
            match before {
                // Steps below a pixel would only cost time.
                Some((from, _)) if from.distance(at) <= 0.9 => continue,
                Some((from, last)) if joins(last, value) => self.line(from, at, width, colour),
                _ => {}
            }
            before = Some((at, value));
        }
        if let Some((end, _)) = before {
            self.panel([end.x - dot, end.y - dot, 2.0 * dot, 2.0 * dot], dot, colour);
        }
    }

    fn push(&mut self, middle: Vec2, along: Vec2, half: Vec2, radius: f32, colour: [f32; 4]) {
        let across = Vec2::new(-along.y, along.x);
        // A pixel more on all sides, for the smooth edge.
        let reach = half + Vec2::ONE;
        for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let offset = reach * Vec2::new(u, v);
            self.corners.push(OverlayVertex {
                position: (middle + along * offset.x + across * offset.y).to_array(),
                offset: offset.to_array(),
                half_size: [half.x, half.y, radius],
                colour,
            });
        }
    }
}

/// Pipeline and this picture's corners.
#[derive(Debug)]
pub(crate) struct OverlayPass {
    pipeline: wgpu::RenderPipeline,
    corners: StreamBuffer,
    screen: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl OverlayPass {
    pub(crate) const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
        vertex_attr_array![0 => Float32x2, 1 => Float32x2, 2 => Float32x3, 3 => Float32x4];

    pub(crate) fn new(gpu: &Gpu, canvas: Canvas) -> Self {
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let layout = gpu.layout("screen", wgpu::ShaderStages::VERTEX, &[uniform]);
        let screen = gpu.buffer("screen", 16, BufferUsages::UNIFORM | BufferUsages::COPY_DST);
        let group = gpu.group("screen", &layout, vec![screen.as_entire_binding()]);
        let pipeline = Recipe {
            label: "overlay",
            source: SHADER,
            groups: &[&layout],
            buffers: &[vertices::<OverlayVertex>(&Self::ATTRIBUTES)],
            colour: Some((canvas, Some(wgpu::BlendState::ALPHA_BLENDING))),
            ..Default::default()
        }
        .build(gpu);
        Self { pipeline, corners: StreamBuffer::new(gpu, "overlay", BufferUsages::VERTEX), screen, group }
    }

    pub(crate) fn fill(&mut self, gpu: &Gpu, size: [f32; 2], shapes: &Shapes) {
        gpu.queue.write_buffer(&self.screen, 0, bytemuck::bytes_of(&[size[0], size[1], 0.0, 0.0]));
        self.corners.fill(gpu, bytemuck::cast_slice(&shapes.corners));
    }

    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, shapes: &Shapes) {
        if !shapes.corners.is_empty() {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.set_vertex_buffer(0, self.corners.slice());
            pass.draw(0..shapes.corners.len() as u32, 0..1);
        }
    }
}
