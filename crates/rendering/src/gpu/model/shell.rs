//! The shell that carries the identification tags, and the camera on its mast.

use super::{Build, Detail, Material, Mesh};
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::FRAC_PI_8;
use vocabulary::math;
use vocabulary::{FACE_DIRECTIONS, Shell, TAG_CELLS};

/// Parts around the faces, as they are on the paper's shell, m.
const WALL: f64 = 0.005;
const RIM: f64 = 0.012;
const LIP: f64 = 0.002;

/// How many times as large as the paper's a shell is.
pub(super) fn size(shell: &Shell) -> f64 {
    shell.apothem / Shell::PAPER.apothem
}

/// A corner of the octagon `up` m above its middle, `outset` m out of the faces.
fn corner(shell: &Shell, angle: f64, up: f64, outset: f64) -> Vec3 {
    let apothem = shell.apothem - math::tan(shell.lean) * up + outset;
    // A corner of an octagon lies at the apothem over the cosine of half a face's angle.
    let at = DVec2::from_angle(angle) * (apothem / math::cos(FRAC_PI_8));
    DVec3::new(shell.forward + at.x, at.y, shell.height + up).as_vec3()
}

/// A ring of five faces between two heights, with inside and rims; the outside may be left to others.
fn ring(mesh: &mut Mesh, shell: &Shell, [low, high]: [f64; 2], outset: f64, outer: [Option<Material>; 2]) {
    let wall = -WALL * size(shell);
    let [outside, lining] = outer;
    let (outer, inner) = (outside.unwrap_or(Material::Shell), lining.unwrap_or(Material::Shell));
    for angle in FACE_DIRECTIONS {
        let (a, b) = (angle - FRAC_PI_8, angle + FRAC_PI_8);
        let out = |angle, z| corner(shell, angle, z, outset);
        let inn = |angle, z| corner(shell, angle, z, wall);
        if outside.is_some() {
            mesh.quad([out(a, low), out(b, low), out(b, high), out(a, high)], outer);
        }
        if lining.is_some() {
            mesh.quad([inn(b, low), inn(a, low), inn(a, high), inn(b, high)], inner);
        }
        mesh.quad([out(a, high), out(b, high), inn(b, high), inn(a, high)], outer);
        mesh.quad([inn(a, low), inn(b, low), out(b, low), out(a, low)], inner);
    }
    let end = 3.0 * FRAC_PI_8;
    for (angle, flip) in [(end, false), (-end, true)] {
        let face = [
            corner(shell, angle, low, wall),
            corner(shell, angle, low, outset),
            corner(shell, angle, high, outset),
            corner(shell, angle, high, wall),
        ];
        let [a, b, c, d] = face;
        mesh.quad(if flip { [d, c, b, a] } else { face }, outer);
    }
}

fn span(shell: &Shell) -> [f64; 2] {
    [-0.5 * shell.face_height, 0.5 * shell.face_height]
}

/// The five faces, seen from both sides.
pub(super) fn outline(mesh: &mut Mesh, build: &Build) {
    if let Some(shell) = &build.shell {
        ring(mesh, shell, span(shell), 0.0, [Some(Material::Paint); 2]);
    }
}

/// The outside of the faces that carry tags, which the body leaves out, each with its number for a material and its cells for a picture: column and row of a
/// place on the tag, from the upper left.
pub(crate) fn faces(build: &Build) -> Mesh {
    let mut mesh = Mesh::default();
    let Some(shell) = &build.shell else { return mesh };
    let [low, high] = span(shell);
    for (face, angle) in FACE_DIRECTIONS.into_iter().enumerate() {
        let from = mesh.vertices.len();
        let (a, b) = (angle - FRAC_PI_8, angle + FRAC_PI_8);
        let at = |angle, up| corner(shell, angle, up, 0.0);
        mesh.quad([at(a, low), at(b, low), at(b, high), at(a, high)], Material::Shell);
        let face_from_body = shell.body_from_face(face).inverse();
        let middle = 0.5 * TAG_CELLS as f64;
        for vertex in &mut mesh.vertices[from..] {
            let [x, y, _] = face_from_body.apply(vertex.position.map(f64::from));
            vertex.uv = [middle + x / shell.cell, middle - y / shell.cell].map(|c| c as f32);
            vertex.material = face as u32;
        }
    }
    mesh
}

pub(super) fn build(mesh: &mut Mesh, detail: Detail, build: &Build) {
    let Vec3 { x, z, .. } = build.camera;
    let head = build.head;
    // On the roof, or what is below it.
    let foot = (0.91 * build.body.height as f32).min(z - 0.05 * head);
    let half = 0.007 * head;
    mesh.cuboid([x - half, -half, foot], [x + half, half, z - 0.018 * head], Material::Metal);
    let Some(shell) = &build.shell else { return };
    let size = size(shell);
    let [low, high] = span(shell);
    // From far away the insides of the rims are not seen.
    let painted = [Some(Material::Paint), (detail > Detail::Coarse).then_some(Material::Paint)];
    ring(mesh, shell, [low, high], 0.0, [None, Some(Material::Lining)]);
    // Rims in the robot's colour, outside the area of the tags.
    ring(mesh, shell, [high, high + RIM * size], LIP * size, painted);
    ring(mesh, shell, [low - RIM * size, low], LIP * size, painted);
    if detail == Detail::Full {
        let mut struts = struts();
        let size = size as f32;
        let foot = [shell.forward, 0.0, shell.height + low].map(|x| x as f32);
        for vertex in &mut struts.vertices {
            let [x, y, z] = vertex.position;
            vertex.position = [foot[0] + x * size, y * size, foot[2] + z * size];
        }
        mesh.append(&struts, Vec3::ZERO);
    }
}

/// What carries the paper's shell, from the middle of its lower edge.
fn struts() -> Mesh {
    let mut mesh = Mesh::default();
    // From a place beside the hull to the strut at `y`.
    let across = |y: f32| [y.min(0.07 * y.signum()), y.max(0.07 * y.signum())];
    for y in [-0.085_f32, 0.085] {
        let [low, high] = across(y);
        mesh.cuboid([-0.17, y - 0.006, -0.016], [0.05, y + 0.006, -0.008], Material::Plastic);
        mesh.cuboid([-0.05, low, -0.022], [-0.03, high, -0.008], Material::Plastic);
    }
    for [low, high] in [-0.186_f32, 0.180].map(across) {
        mesh.cuboid([-0.045, low, -0.012], [-0.030, high, -0.004], Material::Plastic);
    }
    mesh
}

/// The camera's head around its pan axis.
pub(crate) fn camera(detail: Detail) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.cuboid([-0.022, -0.021, -0.018], [0.016, 0.021, 0.018], Material::Plastic);
    if detail == Detail::Coarse {
        return mesh;
    }
    mesh.cuboid([-0.0225, -0.012, -0.004], [-0.0221, 0.012, 0.004], Material::Metal);
    let from = mesh.vertices.len();
    let mut camera_model = Mesh::default();
    camera_model.turned(&[[-0.002, 0.0145], [0.016, 0.0145], [0.016, 0.011], [0.012, 0.0]], 12, |s| {
        if s < 2 { Material::Metal } else { Material::Glass }
    });
    // Turned shapes stand along y; the lens looks along x.
    for vertex in &mut camera_model.vertices {
        let turn = |[x, y, z]: [f32; 3]| [y, -x, z];
        vertex.position = turn(vertex.position);
        vertex.normal = turn(vertex.normal);
    }
    mesh.append(&camera_model, Vec3::new(0.016, 0.0, 0.0));
    mesh.smooth(from, 0.7);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::{Body, FACES, RobotInfo};

    /// Corners of the black squares, found by their cells, are where the shell has them.
    #[test]
    fn tags_are_where_the_shell_has_them() {
        let body = Body::default();
        for shell in [
            Shell::PAPER,
            Shell::PAPER.scaled(4.0).at(1.3, 1.8),
            Shell { lean: 0.4, face_height: 0.2, ..Shell::PAPER },
        ] {
            let member = RobotInfo { shell: Some(shell.tagged(3)), ..RobotInfo::new("a", true, body) };
            let mesh = faces(&Build::new(&member));
            assert_eq!(mesh.vertices.len(), 6 * FACES);
            for (face, corners) in mesh.vertices.chunks_exact(6).enumerate() {
                let [a, b, c] = [0, 1, 2].map(|k| corners[k]);
                let [p, q, r] = [a, b, c].map(|v| Vec3::from_array(v.position));
                let [u, v, w] = [a, b, c].map(|v| glam::Vec2::from_array(v.uv));
                // Affine from cells to places.
                let cells = glam::Mat2::from_cols(v - u, w - u).inverse();
                for (want, cell) in
                    shell.tag_corners(face).iter().zip([[1.0, 1.0], [9.0, 1.0], [9.0, 9.0], [1.0, 9.0]])
                {
                    let share = cells * (glam::Vec2::from_array(cell) - u);
                    let at = p + (q - p) * share.x + (r - p) * share.y;
                    let off = at.distance(DVec3::from_array(*want).as_vec3());
                    assert!(off < 2e-6 * size(&shell) as f32, "{face}: {off}");
                    assert_eq!(a.material, face as u32);
                }
            }
        }
    }
}
