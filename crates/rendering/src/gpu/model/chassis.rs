//! What carries a hull that stands over its wheels: ladder frame, axles, springs.

use super::{Build, Detail, Material, Mesh};
use glam::Vec3;

pub(super) fn build(mesh: &mut Mesh, detail: Detail, build: &Build) {
    let body = build.body;
    let [radius, wheelbase, track] = [body.wheel_radius, body.wheelbase, body.track].map(|x| x as f32);
    let thick = 0.14 * radius;
    let rail = 0.34 * radius;
    mesh.cuboid(
        [-0.7 * radius, -rail, 0.95 * radius],
        [wheelbase + 0.7 * radius, rail, 1.3 * radius],
        Material::Plastic,
    );
    for axle in [0.0, wheelbase] {
        let [low, high] = [-0.48 * track, 0.48 * track];
        mesh.cuboid(
            [axle - thick, low, radius - thick],
            [axle + thick, high, radius + thick],
            Material::Metal,
        );
        if detail == Detail::Coarse {
            continue;
        }
        let round = 0.34 * radius;
        mesh.cuboid(
            [axle - round, -round, radius - round],
            [axle + round, round, radius + round],
            Material::Plastic,
        );
        for side in [-1.0, 1.0] {
            for lean in [-0.75, 0.75] {
                let foot =
                    Vec3::new(axle + 0.2 * lean * radius, side * (0.5 * track - 0.75 * radius), radius);
                let head = Vec3::new(axle + lean * radius, side * 0.62 * radius, 2.0 * radius);
                strut(mesh, foot, head, 0.11 * radius);
            }
        }
    }
}

/// A square bar between two points.
fn strut(mesh: &mut Mesh, foot: Vec3, head: Vec3, half: f32) {
    let along = (head - foot).normalize_or(Vec3::Z);
    let across = along.cross(Vec3::X).normalize_or(Vec3::Y) * half;
    let aside = across.cross(along);
    let ring = [across + aside, across - aside, -across - aside, -across + aside];
    for k in 0..4 {
        let (a, b) = (ring[k], ring[(k + 1) % 4]);
        let corners = [foot + a, foot + b, head + b, head + a];
        let outward = (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(a + b) > 0.0;
        let [p, q, r, s] = corners;
        mesh.quad(if outward { corners } else { [s, r, q, p] }, Material::Stripe);
    }
}
