//! The ground as bodies meet it: a slab where it is flat, triangles where it is not.

use rapier3d_f64::prelude::{ColliderBuilder, Vector};
use vocabulary::Terrain;

/// Half the side of the ground, m: twice as far as anything can start.
pub(super) const FAR: f64 = 2e6;
/// Thickness, m.
const DEEP: f64 = 2.0;

/// The colliders of the ground.
pub(super) fn ground(terrain: Option<&Terrain>) -> Vec<ColliderBuilder> {
    match terrain {
        None => vec![slab([-FAR, -FAR], [FAR, FAR], 0.0)],
        Some(field) if field.heights.iter().all(|h| *h == field.heights[0]) => {
            vec![slab([-FAR, -FAR], [FAR, FAR], field.heights[0])]
        }
        Some(field) => {
            let mut parts = rim(field);
            parts.extend(triangles(field));
            parts
        }
    }
}

fn slab([x0, y0]: [f64; 2], [x1, y1]: [f64; 2], top: f64) -> ColliderBuilder {
    let middle = Vector::new(0.5 * (x0 + x1), 0.5 * (y0 + y1), top - DEEP / 2.0);
    ColliderBuilder::cuboid(0.5 * (x1 - x0), 0.5 * (y1 - y0), DEEP / 2.0).translation(middle)
}

/// Four slabs around the field, as high as the lowest point of its edge.
fn rim(field: &Terrain) -> Vec<ColliderBuilder> {
    let [x0, y0] = field.origin;
    let (x1, y1) = (x0 + field.cell * (field.columns - 1) as f64, y0 + field.cell * (field.rows - 1) as f64);
    let edge = |k: usize| {
        let (i, j) = (k % field.columns, k / field.columns);
        i == 0 || j == 0 || i == field.columns - 1 || j == field.rows - 1
    };
    let heights = field.heights.iter().enumerate().filter(|(k, _)| edge(*k)).map(|(_, h)| *h);
    let top = heights.fold(f64::INFINITY, f64::min);
    vec![
        slab([-FAR, -FAR], [x0, FAR], top),
        slab([x1, -FAR], [FAR, FAR], top),
        slab([x0, -FAR], [x1, y0], top),
        slab([x0, y1], [x1, FAR], top),
    ]
}

/// The same two triangles a cell that the wheels see.
fn triangles(field: &Terrain) -> Option<ColliderBuilder> {
    let place = |k: usize| {
        let (i, j) = ((k % field.columns) as f64, (k / field.columns) as f64);
        Vector::new(field.origin[0] + i * field.cell, field.origin[1] + j * field.cell, field.heights[k])
    };
    let corners = (0..field.heights.len()).map(place).collect();
    let mut faces = Vec::new();
    for j in 0..field.rows - 1 {
        for i in 0..field.columns - 1 {
            let a = (j * field.columns + i) as u32;
            let c = a + field.columns as u32;
            faces.extend([[a, a + 1, c + 1], [a, c + 1, c]]);
        }
    }
    ColliderBuilder::trimesh(corners, faces).ok()
}
