//! Bonnet, cabin, bumpers, arches and lights.

use super::{Build, Detail, Material, Mesh, chassis};
use glam::Vec3;

/// Half a turn of a rounded rectangle would be too many corners for a body 60 pixels long; this has 14.
fn section(x: f32, half: f32, low: f32, high: f32, round: f32) -> Vec<Vec3> {
    let r = round.min(0.5 * (high - low)).min(half);
    let diagonal = r * 0.293;
    let right = [
        [0.0, low],
        [half - r, low],
        [half - diagonal, low + diagonal],
        [half, low + r],
        [half, high - r],
        [half - diagonal, high - diagonal],
        [half - r, high],
        [0.0, high],
    ];
    let left = right.iter().map(|[y, z]| Vec3::new(x, *y, *z));
    let mirrored = right[1..7].iter().rev().map(|[y, z]| Vec3::new(x, -*y, *z));
    left.chain(mirrored).collect()
}

/// The sections, or in a coarse model those chosen, with every rounding one edge.
fn thinned(sections: &[Vec<Vec3>], chosen: &[usize], detail: Detail) -> Vec<Vec<Vec3>> {
    if detail > Detail::Coarse {
        return sections.to_vec();
    }
    let kept = |section: &Vec<Vec3>| [1, 3, 4, 6, 8, 10, 11, 13].map(|k| section[k]).to_vec();
    chosen.iter().map(|k| kept(&sections[*k])).collect()
}

/// The hull between the wheels, with the bonnet in front.
fn hull(mesh: &mut Mesh, detail: Detail) {
    let from = mesh.vertices.len();
    let sections = [
        section(-0.083, 0.070, 0.050, 0.108, 0.016),
        section(-0.070, 0.078, 0.040, 0.124, 0.018),
        section(0.00, 0.080, 0.036, 0.132, 0.020),
        section(0.15, 0.080, 0.034, 0.134, 0.022),
        section(0.20, 0.080, 0.034, 0.129, 0.026),
        section(0.27, 0.077, 0.036, 0.117, 0.028),
        section(0.305, 0.073, 0.040, 0.103, 0.026),
        section(0.322, 0.066, 0.050, 0.084, 0.016),
    ];
    mesh.loft(&thinned(&sections, &[0, 2, 4, 5, 7], detail), |_, _| Material::Paint);
    mesh.smooth(from, 0.6);
}

/// The cabin: glass all round, pillars by the paint of roof and hull.
fn cabin(mesh: &mut Mesh, detail: Detail) {
    let from = mesh.vertices.len();
    let (base, roof) = (0.128, 0.206);
    let foot = [[-0.078, 0.072], [-0.010, 0.078], [0.100, 0.078], [0.196, 0.070]];
    let head = [[-0.056, 0.056], [-0.006, 0.060], [0.074, 0.060], [0.118, 0.054]];
    let at = |p: [f32; 2], side: f32, z: f32| Vec3::new(p[0], p[1] * side, z);
    for k in 0..3 {
        let glass = if k == 2 { Material::Paint } else { Material::Glass };
        for (a, b, side) in [(k + 1, k, 1.0), (k, k + 1, -1.0)] {
            let [p, q] = [foot[a], foot[b]].map(|place| at(place, side, base));
            let [r, s] = [head[b], head[a]].map(|place| at(place, side, roof));
            mesh.quad([p, q, r, s], glass);
        }
    }
    mesh.quad(
        [at(foot[0], 1.0, base), at(foot[0], -1.0, base), at(head[0], -1.0, roof), at(head[0], 1.0, roof)],
        Material::Glass,
    );
    mesh.quad(
        [at(foot[3], -1.0, base), at(foot[3], 1.0, base), at(head[3], 1.0, roof), at(head[3], -1.0, roof)],
        Material::Glass,
    );
    // The roof's lip overhangs the glass a little and catches the sun.
    let lip = |x: f32, half: f32| section(x, half, roof - 0.004, roof + 0.010, 0.006);
    let sections =
        [lip(-0.062, 0.052), lip(-0.050, 0.063), lip(0.078, 0.064), lip(0.116, 0.058), lip(0.126, 0.050)];
    mesh.loft(&thinned(&sections, &[0, 2, 4], detail), |_, _| Material::Paint);
    mesh.smooth(from, 0.75);
    let z = roof + 0.0108;
    let patch = [[-0.052, 0.050], [-0.052, -0.050], [0.048, -0.050], [0.048, 0.050]];
    mesh.pictured(patch.map(|[x, y]| Vec3::new(x, y, z)), Material::Roof);
}

/// An arch over a wheel: a strip of a ring around the axle.
fn arch(mesh: &mut Mesh, build: &Build, axle: f32, side: f32) {
    let (tall, wide) = (build.wheel.x, build.arch());
    let from = mesh.vertices.len();
    let at = |k: i32, radius: f32, y: f32| {
        let turn = (18.0 + 20.571 * k as f32).to_radians();
        Vec3::new(axle + tall * radius * turn.cos(), y, tall * (0.045 + radius * turn.sin()))
    };
    let (inner, outer) = (0.074 * side * wide, 0.121 * side * wide);
    let mut face = |corners: [Vec3; 4]| {
        let [a, b, c, d] = corners;
        mesh.quad(if side > 0.0 { [a, b, c, d] } else { [d, c, b, a] }, Material::Paint);
    };
    for k in 0..7 {
        face([at(k, 0.060, inner), at(k, 0.060, outer), at(k + 1, 0.060, outer), at(k + 1, 0.060, inner)]);
        face([at(k, 0.052, outer), at(k + 1, 0.052, outer), at(k + 1, 0.060, outer), at(k, 0.060, outer)]);
        face([at(k, 0.052, outer), at(k, 0.052, inner), at(k + 1, 0.052, inner), at(k + 1, 0.052, outer)]);
    }
    mesh.smooth(from, 0.6);
}

fn bumpers(mesh: &mut Mesh) {
    let from = mesh.vertices.len();
    let front = [
        section(0.298, 0.112, 0.030, 0.060, 0.010),
        section(0.319, 0.108, 0.030, 0.060, 0.010),
        section(0.330, 0.088, 0.034, 0.056, 0.010),
    ];
    let rear = [
        section(-0.090, 0.092, 0.034, 0.062, 0.010),
        section(-0.082, 0.110, 0.030, 0.066, 0.010),
        section(-0.068, 0.112, 0.030, 0.066, 0.010),
    ];
    mesh.loft(&front, |_, _| Material::Plastic);
    mesh.loft(&rear, |_, _| Material::Plastic);
    for side in [-1.0_f32, 1.0] {
        let (near, far) = (0.078 * side, 0.112 * side);
        mesh.cuboid([0.066, near.min(far), 0.034], [0.204, near.max(far), 0.056], Material::Plastic);
    }
    mesh.smooth(from, 0.6);
}

fn lights(mesh: &mut Mesh) {
    for side in [-1.0_f32, 1.0] {
        let span = |a: f32, b: f32| ((a * side).min(b * side), (a * side).max(b * side));
        let (low, high) = span(0.036, 0.068);
        mesh.cuboid([0.296, low, 0.070], [0.3205, high, 0.090], Material::Headlight);
        let (low, high) = span(0.040, 0.104);
        mesh.cuboid([-0.0935, low, 0.050], [-0.080, high, 0.062], Material::TailLight);
    }
    mesh.cuboid([0.300, -0.030, 0.064], [0.3225, 0.030, 0.080], Material::Plastic);
}

/// A stripe along bonnet and roof: gold on a lead robot, on the others a shade of their paint.
fn stripe(mesh: &mut Mesh) {
    let points = [[0.198, 0.1305], [0.236, 0.1250], [0.272, 0.1185], [0.305, 0.1045]];
    for pair in points.windows(2) {
        let at = |p: [f32; 2], y: f32| Vec3::new(p[0], y, p[1]);
        mesh.quad(
            [at(pair[0], -0.018), at(pair[1], -0.018), at(pair[1], 0.018), at(pair[0], 0.018)],
            Material::Stripe,
        );
    }
    let z = 0.2168;
    let at = |x: f32, y: f32| Vec3::new(x, y, z);
    mesh.quad([at(0.054, -0.018), at(0.118, -0.018), at(0.118, 0.018), at(0.054, 0.018)], Material::Stripe);
}

/// Hull and cabin.
pub(super) fn outline(mesh: &mut Mesh, detail: Detail) {
    hull(mesh, detail);
    cabin(mesh, detail);
}

/// A part as modelled, moved to where it is on this hull.
fn fitted(mesh: &mut Mesh, build: &Build, part: impl Fn(&mut Mesh)) {
    let mut modelled = Mesh::default();
    part(&mut modelled);
    build.fit(&mut modelled);
    mesh.append(&modelled, Vec3::ZERO);
}

pub(super) fn build(mesh: &mut Mesh, detail: Detail, build: &Build) {
    fitted(mesh, build, |mesh| outline(mesh, detail));
    fitted(mesh, build, lights);
    fitted(mesh, build, stripe);
    if build.high {
        chassis::build(mesh, detail, build);
    }
    if detail < Detail::Full {
        return;
    }
    if !build.high {
        for axle in [0.0, build.body.wheelbase as f32] {
            arch(mesh, build, axle, 1.0);
            arch(mesh, build, axle, -1.0);
        }
    }
    fitted(mesh, build, bumpers);
}
