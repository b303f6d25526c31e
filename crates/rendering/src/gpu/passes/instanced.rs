//! Meshes on the device, each drawn as often as it has copies.

use super::{StreamBuffer, vertices};
use crate::Gpu;
use crate::gpu::model::Vertex;
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};
use wgpu::{BufferUsages, VertexAttribute, VertexBufferLayout, VertexStepMode, vertex_attr_array};

/// A copy of a mesh; mirrors `Instance` of the shaders.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Instance {
    pub(crate) rows: [[f32; 4]; 3],
    pub(crate) colour: [f32; 4],
    pub(crate) marks: [f32; 4],
}

impl Instance {
    pub(crate) fn new(local_from_model: Mat4, colour: [f32; 4], marks: [f32; 4]) -> Self {
        let [x, y, z, _] = local_from_model.transpose().to_cols_array_2d();
        Self { rows: [x, y, z], colour, marks }
    }

    /// Where a point of the model is, relative to the local origin, m.
    pub(crate) fn place(&self, point: Vec3) -> Vec3 {
        Vec3::from_array(self.rows.map(|row| point.extend(1.0).dot(row.into())))
    }
}

const CORNER: [VertexAttribute; 4] =
    vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x2, 3 => Uint32];
const INSTANCE: [VertexAttribute; 5] =
    vertex_attr_array![4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4];

/// Layouts of corners and copies.
pub(crate) const LAYOUTS: [VertexBufferLayout<'static>; 2] = [
    vertices::<Vertex>(&CORNER),
    VertexBufferLayout { step_mode: VertexStepMode::Instance, ..vertices::<Instance>(&INSTANCE) },
];

/// Meshes that stay, and the copies of this picture.
#[derive(Debug)]
pub(crate) struct InstancedMeshes {
    vertices: StreamBuffer,
    indices: StreamBuffer,
    instances: StreamBuffer,
}

impl InstancedMeshes {
    pub(crate) fn new(gpu: &Gpu, vertices: &[Vertex], indices: &[u32]) -> Self {
        let (corners, triangles) = (bytemuck::cast_slice(vertices), bytemuck::cast_slice(indices));
        Self {
            vertices: StreamBuffer::constant(gpu, "corners", BufferUsages::VERTEX, corners),
            indices: StreamBuffer::constant(gpu, "triangles", BufferUsages::INDEX, triangles),
            instances: StreamBuffer::new(gpu, "instances", BufferUsages::VERTEX),
        }
    }

    pub(crate) fn fill(&mut self, gpu: &Gpu, instances: &[Instance]) {
        self.instances.fill(gpu, bytemuck::cast_slice(instances));
    }

    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice());
        pass.set_vertex_buffer(1, self.instances.slice());
        pass.set_index_buffer(self.indices.slice(), wgpu::IndexFormat::Uint32);
    }
}
