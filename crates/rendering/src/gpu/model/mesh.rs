//! Triangles with normals: the few ways in which the models are put together.

use super::Material;
use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};
use std::collections::HashMap;
use std::ops::Range;

/// A corner as the shader reads it.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Vertex {
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
    pub(crate) uv: [f32; 2],
    pub(crate) material: u32,
}

/// Triangles, three corners each.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mesh {
    pub(crate) vertices: Vec<Vertex>,
}

impl Mesh {
    /// A triangle with its corners counter-clockwise as seen from outside.
    pub(crate) fn triangle(&mut self, corners: [Vec3; 3], material: Material) {
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        if normal.length_squared() < 1e-14 {
            return;
        }
        let normal = normal.normalize().to_array();
        let vertex =
            |p: Vec3| Vertex { position: p.to_array(), normal, uv: [0.0; 2], material: material as u32 };
        self.vertices.extend(corners.map(vertex));
    }

    /// A quadrilateral with its corners counter-clockwise as seen from outside.
    pub(crate) fn quad(&mut self, [a, b, c, d]: [Vec3; 4], material: Material) {
        self.triangle([a, b, c], material);
        self.triangle([a, c, d], material);
    }

    /// A quadrilateral that carries a picture; corners lower left, lower right, upper right, upper left.
    pub(crate) fn pictured(&mut self, corners: [Vec3; 4], material: Material) {
        let first = self.vertices.len();
        self.quad(corners, material);
        let uv = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
        for (vertex, k) in self.vertices[first..].iter_mut().zip([0, 1, 2, 0, 2, 3]) {
            vertex.uv = uv[k];
        }
    }

    /// A box between two opposite corners.
    pub(crate) fn cuboid(&mut self, low: [f32; 3], high: [f32; 3], material: Material) {
        let at = |x: usize, y: usize, z: usize| {
            let pick = |k: usize, which: usize| if which == 0 { low[k] } else { high[k] };
            Vec3::new(pick(0, x), pick(1, y), pick(2, z))
        };
        self.quad([at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)], material);
        self.quad([at(0, 1, 0), at(1, 1, 0), at(1, 0, 0), at(0, 0, 0)], material);
        self.quad([at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)], material);
        self.quad([at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1)], material);
        self.quad([at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)], material);
        self.quad([at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1)], material);
    }

    /// A skin over closed sections of equally many points, each counter-clockwise as seen from the front (+x),
    /// ordered from rear to front, both ends closed.
    pub(crate) fn loft(&mut self, sections: &[Vec<Vec3>], material: impl Fn(usize, usize) -> Material) {
        for (s, pair) in sections.windows(2).enumerate() {
            let count = pair[0].len();
            for k in 0..count {
                let n = (k + 1) % count;
                self.quad([pair[0][k], pair[1][k], pair[1][n], pair[0][n]], material(s, k));
            }
        }
        if let (Some(rear), Some(front)) = (sections.first(), sections.last()) {
            for k in 1..front.len() - 1 {
                self.triangle([front[0], front[k], front[k + 1]], material(sections.len(), k));
                self.triangle([rear[0], rear[k + 1], rear[k]], material(sections.len(), k));
            }
        }
    }

    /// A turned shape around the y axis: `trajectory` lists [y, radius] from right (−y) to left (+y).
    pub(crate) fn turned(
        &mut self,
        trajectory: &[[f32; 2]],
        sides: usize,
        material: impl Fn(usize) -> Material,
    ) {
        let at = |[y, radius]: [f32; 2], k: usize| {
            let turn = Vec2::from_angle(std::f32::consts::TAU * (k % sides) as f32 / sides as f32);
            Vec3::new(turn.x * radius, y, turn.y * radius)
        };
        for (s, pair) in trajectory.windows(2).enumerate() {
            for k in 0..sides {
                let corners = [at(pair[0], k), at(pair[0], k + 1), at(pair[1], k + 1), at(pair[1], k)];
                self.quad([corners[0], corners[3], corners[2], corners[1]], material(s));
            }
        }
    }

    /// Normals of the faces as they are now, after corners were moved, rounded where they nearly agree.
    pub(crate) fn face(&mut self) {
        for triangle in self.vertices.chunks_exact_mut(3) {
            let at = [0, 1, 2].map(|k| Vec3::from_array(triangle[k].position));
            let old = Vec3::from_array(triangle[0].normal);
            let normal = (at[1] - at[0]).cross(at[2] - at[0]).normalize_or(old).to_array();
            for vertex in triangle {
                vertex.normal = normal;
            }
        }
        self.smooth(0, 0.6);
    }

    /// Everything of `other`, moved.
    pub(crate) fn append(&mut self, other: &Self, by: Vec3) {
        let moved = |v: &Vertex| Vertex { position: (Vec3::from_array(v.position) + by).to_array(), ..*v };
        self.vertices.extend(other.vertices.iter().map(moved));
    }

    /// The box that holds it, if it has any corner.
    pub(crate) fn bounds(&self) -> Option<[Vec3; 2]> {
        let corners = self.vertices.iter().map(|vertex| [Vec3::from_array(vertex.position); 2]);
        corners.reduce(|[low, high], [from, to]| [low.min(from), high.max(to)])
    }

    /// Appends the corners, each once, and the triangles between them; the range of these among the indices.
    pub(crate) fn weld(&self, vertices: &mut Vec<Vertex>, indices: &mut Vec<u32>) -> Range<u32> {
        let first = indices.len() as u32;
        let mut seen = HashMap::new();
        for vertex in &self.vertices {
            let bits: [u8; size_of::<Vertex>()] = bytemuck::cast(*vertex);
            let index = *seen.entry(bits).or_insert_with(|| {
                vertices.push(*vertex);
                vertices.len() as u32 - 1
            });
            indices.push(index);
        }
        first..indices.len() as u32
    }

    /// Rounds the shading over edges where faces of one material meet at less than `crease` (cosine).
    pub(crate) fn smooth(&mut self, from: usize, crease: f32) {
        let key = |v: &Vertex| (v.position.map(|x| (x * 2e4).round() as i32), v.material);
        let mut around: HashMap<_, Vec<Vec3>> = HashMap::new();
        for vertex in &self.vertices[from..] {
            around.entry(key(vertex)).or_default().push(Vec3::from_array(vertex.normal));
        }
        for vertex in &mut self.vertices[from..] {
            let own = Vec3::from_array(vertex.normal);
            let near = around[&key(vertex)].iter().filter(|n| n.dot(own) > crease);
            vertex.normal = near.sum::<Vec3>().normalize_or(own).to_array();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_point_outwards() {
        let mut mesh = Mesh::default();
        mesh.cuboid([-1.0; 3], [1.0; 3], Material::Paint);
        mesh.turned(&[[-1.0, 0.0], [-1.0, 2.0], [1.0, 2.0], [1.0, 0.0]], 12, |_| Material::Tyre);
        for vertex in &mesh.vertices {
            let (p, n) = (Vec3::from_array(vertex.position), Vec3::from_array(vertex.normal));
            assert!(p.dot(n) > 0.0, "{vertex:?}");
        }
    }

    #[test]
    fn models_are_small_and_point_outwards() {
        for (mesh, most) in [
            (
                super::super::body(
                    super::super::Detail::Full,
                    &super::super::Build::new(&vocabulary::RobotInfo::new(
                        "a",
                        true,
                        vocabulary::Body::default(),
                    )),
                ),
                2600,
            ),
            (super::super::wheel(super::super::Detail::Full, false), 500),
            (super::super::wheel(super::super::Detail::Full, true), 1200),
        ] {
            let triangles = mesh.vertices.len() / 3;
            assert!(triangles < most, "{triangles}");
            assert!(mesh.vertices.iter().all(|v| (Vec3::from_array(v.normal).length() - 1.0).abs() < 1e-3));
        }
    }
}
