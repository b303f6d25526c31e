//! Props of unit size, the origin in the middle of the foot: a copy's matrix gives each its measures.

use super::{Material, Mesh};
use glam::Vec3;

/// Sides of what is round.
const SIDES: usize = 28;

/// Box, pillar, cone and ramp, in the order of the shader's numbers.
pub(crate) fn solids() -> [Mesh; 4] {
    [block(), upright(&[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]), cone(), wedge()]
}

fn block() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.cuboid([-0.5, -0.5, 0.0], [0.5, 0.5, 1.0], Material::Paint);
    mesh
}

/// A traffic cone within the cone it stands for: a flange, and a blunt tip.
fn cone() -> Mesh {
    upright(&[[0.0, 0.0], [0.0, 1.0], [0.035, 0.965], [0.045, 0.80], [0.985, 0.055], [1.0, 0.0]])
}

/// A turned shape that stands: `trajectory` lists [z, radius] from the foot up.
fn upright(trajectory: &[[f32; 2]]) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.turned(trajectory, SIDES, |_| Material::Paint);
    for vertex in &mut mesh.vertices {
        // Turned shapes lie along y.
        let raise = |[x, y, z]: [f32; 3]| [x, -z, y];
        vertex.position = raise(vertex.position);
        vertex.normal = raise(vertex.normal);
    }
    mesh.smooth(0, 0.75);
    mesh
}

fn wedge() -> Mesh {
    let mut mesh = Mesh::default();
    let foot = |y: f32| Vec3::new(-0.5, y, 0.0);
    let back = |y: f32, z: f32| Vec3::new(0.5, y, z);
    mesh.quad([foot(-0.5), back(-0.5, 1.0), back(0.5, 1.0), foot(0.5)], Material::Paint);
    mesh.quad([back(-0.5, 0.0), back(0.5, 0.0), back(0.5, 1.0), back(-0.5, 1.0)], Material::Paint);
    mesh.quad([foot(0.5), back(0.5, 0.0), back(-0.5, 0.0), foot(-0.5)], Material::Paint);
    mesh.triangle([foot(-0.5), back(-0.5, 0.0), back(-0.5, 1.0)], Material::Paint);
    mesh.triangle([foot(0.5), back(0.5, 1.0), back(0.5, 0.0)], Material::Paint);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solids_are_closed_and_face_outwards() {
        for (mesh, volume) in solids().iter().zip([1.0, 3.12, 0.75, 0.5]) {
            // The signed volume is right only where every face is there and looks outwards.
            let at = |k: usize| Vec3::from_array(mesh.vertices[k].position);
            let six = (0..mesh.vertices.len()).step_by(3).map(|k| at(k).cross(at(k + 1)).dot(at(k + 2)));
            let found = six.sum::<f32>() / 6.0;
            assert!((found - volume).abs() < 0.15 * volume, "{found} {volume}");
            for vertex in &mesh.vertices {
                let z = vertex.position[2];
                assert!(
                    (0.0..=1.0).contains(&z) && (Vec3::from_array(vertex.normal).length() - 1.0).abs() < 1e-3
                );
            }
        }
    }
}
