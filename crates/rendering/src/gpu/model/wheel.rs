//! A wheel whose spokes show that it rolls.

use super::{Detail, Material, Mesh};
use glam::{Vec2, Vec3};

/// As modelled, m.
pub(crate) const RADIUS: f32 = 0.045;
const SPOKES: usize = 5;
/// Blocks in each of the two rows of a coarse tread.
const LUGS: usize = 15;

/// A wheel around its hub, the outer face to the left, with `lugs` for rough ground: turned tyre and rim, spokes, hub; in
/// less than full detail a disc with spokes.
pub(crate) fn wheel(detail: Detail, lugs: bool) -> Mesh {
    let mut mesh = Mesh::default();
    let half = 0.018;
    let trajectory = [
        [-half, 0.0],
        [-half, 0.034],
        [-0.014, RADIUS],
        [0.014, RADIUS],
        [half, 0.037],
        [half, 0.031],
        [0.008, 0.0295],
        [0.007, 0.0],
    ];
    if detail < Detail::Full {
        mesh.turned(&[[-half, 0.0], [-half, RADIUS], [half, RADIUS], [half, 0.0]], 8, |_| Material::Tyre);
        mesh.turned(&[[half, 0.028], [half + 0.002, 0.0]], 5, |_| Material::Metal);
        return mesh;
    }
    mesh.turned(&trajectory, 18, |s| if s == 6 { Material::Plastic } else { Material::Tyre });
    mesh.smooth(0, 0.7);
    if lugs {
        tread(&mut mesh);
    }
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

/// Two rows of blocks around the tyre, each row turned against the other.
fn tread(mesh: &mut Mesh) {
    let step = std::f32::consts::TAU / LUGS as f32;
    for (row, side) in [(0.0, 1.0), (0.5, -1.0)] {
        for k in 0..LUGS {
            let angle = step * (k as f32 + row);
            let corner = |turn: f32, y: f32, radius: f32| {
                let turned = Vec2::from_angle(angle + turn * step) * radius;
                Vec3::new(turned.x, y * side, turned.y)
            };
            // The block leans along the tyre as it goes outwards.
            let foot = [
                corner(-0.28, 0.001, 0.0440),
                corner(0.10, 0.001, 0.0440),
                corner(0.34, 0.0165, 0.0405),
                corner(-0.02, 0.0165, 0.0405),
            ];
            let head = [
                corner(-0.24, 0.001, RADIUS + 0.0022),
                corner(0.06, 0.001, RADIUS + 0.0022),
                corner(0.30, 0.0155, RADIUS + 0.0006),
                corner(0.02, 0.0155, RADIUS + 0.0006),
            ];
            let mut face = |corners: [Vec3; 4]| {
                let [a, b, c, d] = corners;
                mesh.quad(if side > 0.0 { [d, c, b, a] } else { [a, b, c, d] }, Material::Tyre);
            };
            face(head);
            for n in 0..4 {
                let m = (n + 1) % 4;
                face([foot[n], foot[m], head[m], head[n]]);
            }
        }
    }
}
