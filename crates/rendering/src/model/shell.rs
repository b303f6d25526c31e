//! The shell that carries the identification tags, and the camera on its mast.

use super::{Build, CAMERA, Material, Mesh};
use glam::{Vec2, Vec3};

const APOTHEM: f32 = 0.187;
const CENTRE: f32 = 0.20;
const HEIGHT: f32 = 0.16;
/// Faces lean back 10°, so that one face alone tells two poses apart.
const LEAN: f32 = 0.176_327;
const WALL: f32 = 0.005;

/// Outward directions of the five faces from the heading, degrees; the front three are cut away.
const FACES: [f32; 5] = [90.0, 135.0, 180.0, 225.0, 270.0];

fn corner(angle: f32, z: f32, inset: f32) -> Vec3 {
    let apothem = APOTHEM - LEAN * (z - CENTRE) - inset;
    // A corner of an octagon lies at the apothem over the cosine of half a face's angle.
    let at = Vec2::from_angle(angle.to_radians()) * (apothem / 22.5_f32.to_radians().cos());
    Vec3::new(at.x, at.y, z)
}

/// A ring of five faces between two heights, with inside and rims.
fn ring(mesh: &mut Mesh, low: f32, high: f32, outset: f32, outer: Material, inner: Material) {
    for angle in FACES {
        let (a, b) = (angle - 22.5, angle + 22.5);
        let out = |angle, z| corner(angle, z, -outset);
        let inn = |angle, z| corner(angle, z, WALL);
        mesh.quad([out(a, low), out(b, low), out(b, high), out(a, high)], outer);
        mesh.quad([inn(b, low), inn(a, low), inn(a, high), inn(b, high)], inner);
        mesh.quad([out(a, high), out(b, high), inn(b, high), inn(a, high)], outer);
        mesh.quad([inn(a, low), inn(b, low), out(b, low), out(a, low)], inner);
    }
    for (angle, flip) in [(67.5, false), (292.5, true)] {
        let face = [
            corner(angle, low, WALL),
            corner(angle, low, -outset),
            corner(angle, high, -outset),
            corner(angle, high, WALL),
        ];
        let [a, b, c, d] = face;
        mesh.quad(if flip { [d, c, b, a] } else { face }, outer);
    }
}

/// The five faces, seen from both sides.
pub(super) fn outline(mesh: &mut Mesh, build: &Build) {
    if build.shell.is_some() {
        let mut shell = Mesh::default();
        let (low, high) = (CENTRE - 0.5 * HEIGHT, CENTRE + 0.5 * HEIGHT);
        ring(&mut shell, low, high, 0.0, Material::Paint, Material::Paint);
        build.fit_shell(&mut shell);
        mesh.append(&shell, Vec3::ZERO);
    }
}

pub(super) fn build(mesh: &mut Mesh, plain: bool, build: &Build) {
    if build.shell.is_none() {
        // The camera alone, on a short mast on the roof.
        let [x, z, roof] = [build.camera.x, build.camera.z, build.body.height as f32];
        mesh.cuboid([x - 0.02, -0.02, roof - 0.05], [x + 0.02, 0.02, z - 0.05], Material::Metal);
        return;
    }
    let mut shell = Mesh::default();
    modelled(&mut shell, plain);
    build.fit_shell(&mut shell);
    mesh.append(&shell, Vec3::ZERO);
}

/// Shell and mast of the default body.
fn modelled(mesh: &mut Mesh, plain: bool) {
    let (low, high) = (CENTRE - 0.5 * HEIGHT, CENTRE + 0.5 * HEIGHT);
    ring(mesh, low, high, 0.0, Material::Shell, Material::Lining);
    // Rims in the robot's colour, outside the area of the tags.
    ring(mesh, high, high + 0.012, 0.002, Material::Paint, Material::Paint);
    ring(mesh, low - 0.012, low, 0.002, Material::Paint, Material::Paint);
    if !plain {
        struts(mesh);
    }
    let [x, y, z] = CAMERA;
    mesh.cuboid([x - 0.007, y - 0.007, 0.20], [x + 0.007, y + 0.007, z - 0.018], Material::Metal);
}

/// What carries the shell.
fn struts(mesh: &mut Mesh) {
    for y in [-0.085_f32, 0.085] {
        mesh.cuboid([-0.17, y - 0.006, 0.104], [0.05, y + 0.006, 0.112], Material::Plastic);
        mesh.cuboid(
            [-0.05, y.min(0.07 * y.signum()), 0.098],
            [-0.03, y.max(0.07 * y.signum()), 0.112],
            Material::Plastic,
        );
    }
    for y in [-0.186_f32, 0.180] {
        mesh.cuboid(
            [-0.045, y.min(0.07 * y.signum()), 0.108],
            [-0.030, y.max(0.07 * y.signum()), 0.116],
            Material::Plastic,
        );
    }
}

pub(super) fn camera() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.cuboid([-0.022, -0.021, -0.018], [0.016, 0.021, 0.018], Material::Plastic);
    mesh.cuboid([-0.0225, -0.012, -0.004], [-0.0221, 0.012, 0.004], Material::Metal);
    let from = mesh.vertices.len();
    let mut lens = Mesh::default();
    lens.turned(&[[-0.002, 0.0145], [0.016, 0.0145], [0.016, 0.011], [0.012, 0.0]], 12, |s| {
        if s < 2 { Material::Metal } else { Material::Glass }
    });
    // Turned shapes stand along y; the lens looks along x.
    for vertex in &mut lens.vertices {
        let turn = |[x, y, z]: [f32; 3]| [y, -x, z];
        vertex.position = turn(vertex.position);
        vertex.normal = turn(vertex.normal);
    }
    mesh.append(&lens, Vec3::new(0.016, 0.0, 0.0));
    mesh.smooth(from, 0.7);
    mesh
}
