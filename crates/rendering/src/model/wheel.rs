//! A wheel whose spokes show that it rolls.

use super::{Material, Mesh};
use glam::{Vec2, Vec3};

/// As modelled, m.
pub(crate) const RADIUS: f32 = 0.045;
const SPOKES: usize = 5;

/// Turned tyre and rim, spokes, hub; `plain` is a disc with spokes.
pub(super) fn wheel(plain: bool) -> Mesh {
    let mut mesh = Mesh::default();
    let half = 0.018;
    let profile = [
        [-half, 0.0],
        [-half, 0.034],
        [-0.014, RADIUS],
        [0.014, RADIUS],
        [half, 0.037],
        [half, 0.031],
        [0.008, 0.0295],
        [0.007, 0.0],
    ];
    if plain {
        mesh.turned(&[[-half, 0.0], [-half, RADIUS], [half, RADIUS], [half, 0.0]], 8, |_| Material::Tyre);
        mesh.turned(&[[half, 0.028], [half + 0.002, 0.0]], 5, |_| Material::Metal);
        return mesh;
    }
    mesh.turned(&profile, 18, |s| if s == 6 { Material::Plastic } else { Material::Tyre });
    mesh.smooth(0, 0.7);
    let at = |angle: f32, radius: f32, y: f32| {
        let turn = Vec2::from_angle(angle) * radius;
        Vec3::new(turn.x, y, turn.y)
    };
    let y = 0.0155;
    for k in 0..SPOKES {
        let angle = std::f32::consts::TAU * k as f32 / SPOKES as f32;
        let (foot, tip) = (0.42, 0.17);
        let face = [
            at(angle + foot, 0.011, y),
            at(angle - foot, 0.011, y),
            at(angle - tip, 0.0305, y),
            at(angle + tip, 0.0305, y),
        ];
        let [a, b, c, d] = face;
        mesh.quad([d, c, b, a], Material::Metal);
        let low = |p: Vec3| Vec3::new(p.x, 0.007, p.z);
        mesh.quad([a, d, low(d), low(a)], Material::Metal);
        mesh.quad([c, b, low(b), low(c)], Material::Metal);
    }
    let mut hub = Mesh::default();
    hub.turned(&[[0.007, 0.0125], [0.0165, 0.0115], [0.0165, 0.0]], 10, |_| Material::Metal);
    mesh.append(&hub, Vec3::ZERO);
    mesh
}
