//! Paint laid over ground that is not flat: triangles are cut where the ground bends, so that every piece lies in it,
//! and where decks begin.

use crate::gpu::passes::decal::DecalVertex;
use crate::ground::floor::{DrivableSurface, Floor};
use glam::{DVec2, DVec3};
use vocabulary::Terrain;

/// What of the floor paint is laid on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ProjectionTarget {
    /// Whatever is uppermost.
    Floor,
    /// The ground alone: what a deck covers is left out.
    Ground,
}

/// Where paint is looked at from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Eye {
    pub(crate) at: DVec3,
    /// How many times as far from the ground as need be it may lie: up to 3 stays within what the shader pulls it nearer.
    pub(crate) slack: f64,
}

/// Lays triangles of corners, relative to `origin`, on the floor; `eye` as for [`project_onto_terrain`].
pub(crate) fn project(
    corners: Vec<DecalVertex>,
    floor: &Floor,
    onto: ProjectionTarget,
    origin: DVec3,
    eye: Option<Eye>,
) -> Vec<DecalVertex> {
    let on_ground = match &floor.terrain {
        Some(terrain) => project_onto_terrain(&corners, terrain, origin, eye),
        None => corners,
    };
    if floor.drivables.is_empty() { on_ground } else { raise(&on_ground, &floor.drivables, onto, origin) }
}

/// Puts what lies on the ground under decks on top of them.
fn raise(
    corners: &[DecalVertex],
    drivables: &[DrivableSurface],
    onto: ProjectionTarget,
    origin: DVec3,
) -> Vec<DecalVertex> {
    let mut out = Vec::with_capacity(corners.len() * 2);
    for triangle in corners.chunks_exact(3) {
        let places = [0, 1, 2].map(|k| place(&triangle[k], origin));
        let low = places[0].min(places[1]).min(places[2]);
        let high = places[0].max(places[1]).max(places[2]);
        let mut near = drivables.iter().filter(|drivable| drivable.near(low, high)).peekable();
        if near.peek().is_none() {
            out.extend_from_slice(triangle);
            continue;
        }
        // Pieces, each with whether it lies on a deck.
        let mut pieces = vec![(triangle.to_vec(), false)];
        for drivable in near {
            let mut cut = Vec::with_capacity(pieces.len() + 4);
            for (piece, raised) in pieces {
                cut_out(piece, raised, drivable, origin, &mut cut);
            }
            pieces = cut;
        }
        for (piece, _) in pieces.iter().filter(|(_, raised)| onto == ProjectionTarget::Floor || !raised) {
            for k in 2..piece.len() {
                out.extend([0, k - 1, k].map(|c| piece[c]));
            }
        }
    }
    out
}

/// Cuts a convex piece along the sides of a deck and where it comes out of the deck, and lifts what is under it.
fn cut_out(
    piece: Vec<DecalVertex>,
    raised: bool,
    drivable: &DrivableSurface,
    origin: DVec3,
    cut: &mut Vec<(Vec<DecalVertex>, bool)>,
) {
    let mut rest = piece;
    for (at, inward) in drivable.sides() {
        let (outside, inside) = split(&rest, |corner| (place(corner, origin) - at).dot(inward));
        cut.extend((outside.len() > 2).then_some((outside, raised)));
        rest = inside;
    }
    let over = |corner: &DecalVertex| {
        let gap = drivable.height(place(corner, origin)) - origin.z - f64::from(corner.position[2]);
        // Where they meet the deck is above.
        if gap.abs() < 1e-6 { 0.0 } else { gap }
    };
    let (above, under) = (rest.iter().any(|c| over(c) < 0.0), rest.iter().any(|c| over(c) > 0.0));
    let (above, under) = match (above, under) {
        (true, true) => split(&rest, over),
        (true, false) => (rest, Vec::new()),
        (false, _) => (Vec::new(), rest),
    };
    cut.extend((above.len() > 2).then_some((above, raised)));
    if under.len() > 2 {
        let lift = |corner: DecalVertex| {
            let height = drivable.height(place(&corner, origin)) - origin.z;
            DecalVertex { position: [corner.position[0], corner.position[1], height as f32], ..corner }
        };
        cut.push((under.into_iter().map(lift).collect(), true));
    }
}

fn place(corner: &DecalVertex, origin: DVec3) -> DVec2 {
    let [x, y, _] = corner.position.map(f64::from);
    DVec2::new(x, y) + origin.truncate()
}

/// Lays triangles of corners, relative to `origin`, on the terrain; the farther from `eye` they are, the farther from
/// it they may lie: the shader pulls them nearer by more.
fn project_onto_terrain(
    corners: &[DecalVertex],
    terrain: &Terrain,
    origin: DVec3,
    eye: Option<Eye>,
) -> Vec<DecalVertex> {
    let mut out = Vec::with_capacity(corners.len() * 2);
    for triangle in corners.chunks_exact(3) {
        let raised = [0, 1, 2].map(|k| lifted(triangle[k], terrain, origin));
        if level(&raised, terrain, origin, eye) {
            out.extend(raised);
            continue;
        }
        let mut pieces = vec![triangle.to_vec()];
        // Lines of the grid, then the diagonals of its cells.
        for across in [DVec2::X, DVec2::Y, DVec2::new(1.0, -1.0)] {
            pieces = pieces.into_iter().flat_map(|p| slice(p, across, terrain, origin)).collect();
        }
        for piece in pieces {
            for k in 2..piece.len() {
                out.extend([0, k - 1, k].map(|c| lifted(piece[c], terrain, origin)));
            }
        }
    }
    out
}

/// A place in cells of the grid.
fn cells(corner: &DecalVertex, terrain: &Terrain, origin: DVec3) -> DVec2 {
    (place(corner, origin) - DVec2::from_array(terrain.origin)) / terrain.cell
}

/// Whether a triangle that was lifted by its corners lies in the ground all over.
fn level(triangle: &[DecalVertex; 3], terrain: &Terrain, origin: DVec3, eye: Option<Eye>) -> bool {
    let at = triangle.map(|corner| DVec3::from_array(corner.position.map(f64::from)) + origin);
    let size = (at[0].max(at[1]).max(at[2]) - at[0].min(at[1]).min(at[2])).truncate();
    let middle = (at[0] + at[1] + at[2]) / 3.0;
    let bound = eye.map_or(0.003, |eye| eye.slack * (0.003 + 0.001 * eye.at.distance(middle)));
    let off = |p: DVec3| (terrain.at(p.x, p.y).height - p.z).abs() < bound;
    let bends = || size.max_element() > 1.5 * terrain.cell && !plain(&at, bound, terrain);
    off(middle) && (0..3).all(|k| off((at[k] + at[(k + 1) % 3]) * 0.5)) && !bends()
}

/// Whether every point of the grid around a triangle lies in its plane.
fn plain(at: &[DVec3; 3], bound: f64, terrain: &Terrain) -> bool {
    let normal = (at[1] - at[0]).cross(at[2] - at[0]);
    if normal.z.abs() < 1e-9 {
        return false;
    }
    let index = |x: f64, k: usize, count: usize| {
        ((x - terrain.origin[k]) / terrain.cell).clamp(0.0, (count - 1) as f64)
    };
    let (low, high) = (at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2]));
    let columns = [low.x, high.x].map(|x| index(x, 0, terrain.columns));
    let rows = [low.y, high.y].map(|y| index(y, 1, terrain.rows));
    (rows[0].floor() as usize..=rows[1].ceil() as usize).all(|row| {
        (columns[0].floor() as usize..=columns[1].ceil() as usize).all(|column| {
            let place =
                DVec2::new(column as f64, row as f64) * terrain.cell + DVec2::from_array(terrain.origin);
            let plane = at[0].z - (place - at[0].truncate()).dot(normal.truncate()) / normal.z;
            (terrain.heights[row * terrain.columns + column] - plane).abs() < bound
        })
    })
}

/// A convex piece cut along whole numbers of cells in one direction; beyond the field there is nothing to cut.
fn slice(piece: Vec<DecalVertex>, across: DVec2, terrain: &Terrain, origin: DVec3) -> Vec<Vec<DecalVertex>> {
    let at = |corner: &DecalVertex| cells(corner, terrain, origin).dot(across);
    let (low, high) = piece
        .iter()
        .map(at)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let [least, most] = bounds(across, terrain);
    let mut cut = Vec::new();
    let mut rest = piece;
    let mut line = low.max(least).ceil();
    while line <= high.min(most) {
        let (below, above) = split(&rest, |corner| at(corner) - line);
        cut.extend((below.len() > 2).then_some(below));
        rest = above;
        line += 1.0;
    }
    cut.extend((rest.len() > 2).then_some(rest));
    cut
}

/// Between which lines of a direction the field lies.
fn bounds(across: DVec2, terrain: &Terrain) -> [f64; 2] {
    let (columns, rows) = ((terrain.columns - 1) as f64, (terrain.rows - 1) as f64);
    match (across.x > 0.0, across.y) {
        (true, 0.0) => [0.0, columns],
        (false, _) => [0.0, rows],
        _ => [-rows, columns],
    }
}

/// The parts of a convex piece below and above zero of `side`.
fn split(piece: &[DecalVertex], side: impl Fn(&DecalVertex) -> f64) -> (Vec<DecalVertex>, Vec<DecalVertex>) {
    let (mut below, mut above) = (Vec::with_capacity(piece.len() + 1), Vec::with_capacity(piece.len() + 1));
    for (k, corner) in piece.iter().enumerate() {
        let next = &piece[(k + 1) % piece.len()];
        let (a, b) = (side(corner), side(next));
        if a <= 0.0 {
            below.push(*corner);
        }
        if a >= 0.0 {
            above.push(*corner);
        }
        if a * b < 0.0 {
            let between = mixed(corner, next, (a / (a - b)) as f32);
            below.push(between);
            above.push(between);
        }
    }
    (below, above)
}

fn mixed(a: &DecalVertex, b: &DecalVertex, share: f32) -> DecalVertex {
    let mix = |p: f32, q: f32| p + (q - p) * share;
    DecalVertex {
        position: std::array::from_fn(|k| mix(a.position[k], b.position[k])),
        kind: a.kind,
        shape: std::array::from_fn(|k| mix(a.shape[k], b.shape[k])),
        colour: std::array::from_fn(|k| mix(a.colour[k], b.colour[k])),
    }
}

fn lifted(corner: DecalVertex, terrain: &Terrain, origin: DVec3) -> DecalVertex {
    let [x, y, _] = corner.position;
    let height = terrain.at(f64::from(x) + origin.x, f64::from(y) + origin.y).height - origin.z;
    DecalVertex { position: [x, y, height as f32], ..corner }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use vocabulary::{FleetInfo, Mobility, Placement, Pose, Prop, Solid};

    #[test]
    fn every_piece_lies_in_the_ground() {
        let heights: Vec<_> = (0..25).map(|k| f64::from((k * 7) % 5) * 0.2).collect();
        let terrain = Terrain { origin: [-1.0, -1.0], cell: 0.5, columns: 5, rows: 5, heights, grip: vec![] };
        let origin = DVec3::new(20.0, 0.0, 0.0);
        let corner = |x: f64, y: f64, u: f32| DecalVertex {
            position: [(x - origin.x) as f32, y as f32, 0.0],
            kind: [0.0; 2],
            shape: [u, 0.0],
            colour: [1.0; 4],
        };
        let triangle = vec![corner(-2.0, -0.3, -1.0), corner(2.5, -0.6, 1.0), corner(0.1, 0.9, 0.0)];
        let out = project_onto_terrain(&triangle, &terrain, origin, None);
        assert!(out.len() > 30 && out.len().is_multiple_of(3));
        let mut area = 0.0;
        for piece in out.chunks_exact(3) {
            let at = |k: usize| DVec3::from_array(piece[k].position.map(f64::from)) + origin;
            let middle = (at(0) + at(1) + at(2)) / 3.0;
            assert!((terrain.at(middle.x, middle.y).height - middle.z).abs() < 1e-5, "{middle}");
            area += 0.5 * (at(1) - at(0)).truncate().perp_dot((at(2) - at(0)).truncate()).abs();
        }
        let whole = 0.5 * DVec2::new(4.5, -0.3).perp_dot(DVec2::new(2.1, 1.2)).abs();
        assert!((area - whole).abs() < 1e-4, "{area} {whole}");
    }

    #[test]
    fn on_decks_every_piece_lies_on_what_is_uppermost() {
        let fixed = |solid: Solid, x: f64, y: f64, heading: f64, foot: f64| Prop {
            name: String::new(),
            solid,
            placement: Placement::upright(Pose::new(x, y, heading), foot),
            mobility: Mobility::Fixed,
        };
        let heights = (0..25).map(|k| f64::from((k * 7) % 5) * 0.04).collect();
        let terrain = Terrain { origin: [-1.0, -1.0], cell: 0.5, columns: 5, rows: 5, heights, grip: vec![] };
        // A ramp, a platform that cuts it, and one that is partly sunk.
        let props = vec![
            fixed(Solid::Wedge { size: [1.5, 0.9, 0.5] }, 0.1, 0.1, 0.5, 0.0),
            fixed(Solid::Block { size: [1.2, 1.1, 0.3] }, 0.6, 0.2, 1.1, 0.0),
            fixed(Solid::Block { size: [1.0, 1.0, 0.1] }, -0.7, 0.1, 0.0, 0.0),
        ];
        let fleet = FleetInfo { props, terrain: Some(Arc::new(terrain)), ..FleetInfo::default() };
        let floor = Floor::new(&fleet);
        assert_eq!(floor.drivables.len(), 3);
        let origin = DVec3::new(20.0, 0.0, 0.0);
        let corner = |x: f64, y: f64| DecalVertex {
            position: [(x - origin.x) as f32, y as f32, 0.0],
            kind: [0.0; 2],
            shape: [0.0; 2],
            colour: [1.0; 4],
        };
        let triangle = || vec![corner(-2.0, -0.3), corner(2.5, -0.6), corner(0.1, 0.9)];
        let area = |onto: ProjectionTarget| {
            let mut area = 0.0;
            for piece in project(triangle(), &floor, onto, origin, None).chunks_exact(3) {
                let at = |k: usize| DVec3::from_array(piece[k].position.map(f64::from)) + origin;
                let middle = (at(0) + at(1) + at(2)) / 3.0;
                let share = 0.5 * (at(1) - at(0)).truncate().perp_dot((at(2) - at(0)).truncate()).abs();
                area += share;
                if share > 1e-6 {
                    let height = floor.height(middle.truncate());
                    assert!((height - middle.z).abs() < 1e-4, "{middle} {height}");
                    assert!(onto == ProjectionTarget::Floor || height == floor.ground(middle.truncate()));
                }
            }
            area
        };
        let whole = 0.5 * DVec2::new(4.5, -0.3).perp_dot(DVec2::new(2.1, 1.2)).abs();
        let (all, open) = (area(ProjectionTarget::Floor), area(ProjectionTarget::Ground));
        assert!((all - whole).abs() < 1e-4 && open > 0.3 && open < whole - 1.0, "{all} {open} {whole}");
    }

    #[test]
    fn on_a_plane_nothing_is_cut() {
        let heights: Vec<_> = (0..100).map(|k| f64::from(k % 10) * 0.03).collect();
        let terrain = Terrain { origin: [0.0; 2], cell: 0.1, columns: 10, rows: 10, heights, grip: vec![] };
        let corner = |x: f32, y: f32| DecalVertex {
            position: [x, y, 0.0],
            kind: [0.0; 2],
            shape: [0.0; 2],
            colour: [1.0; 4],
        };
        let inside = [corner(0.1, 0.1), corner(0.8, 0.2), corner(0.4, 0.85)];
        assert_eq!(project_onto_terrain(&inside, &terrain, DVec3::ZERO, None).len(), 3);
        let across = [corner(0.1, 0.1), corner(1.8, 0.2), corner(0.4, 0.85)];
        assert!(project_onto_terrain(&across, &terrain, DVec3::ZERO, None).len() > 6);
    }
}
