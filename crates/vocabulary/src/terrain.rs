//! The lie of the land: a grid of heights, and how well it grips.

/// A height field over a grid of square cells, each two flat triangles; beyond its edges it goes on level from the
/// nearest point of the grid.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Terrain {
    /// The corner with the smallest x and y, m.
    pub origin: [f64; 2],
    /// Side of a cell, m; positive.
    pub cell: f64,
    /// Points along x; at least 2.
    pub columns: usize,
    /// Points along y; at least 2.
    pub rows: usize,
    /// Heights of the points, m, row after row from the smallest y: `columns` × `rows`.
    pub heights: Vec<f64>,
    /// Coefficient of friction at each point that multiplies the tyres' own; empty for 1 everywhere.
    pub grip: Vec<f64>,
}

/// The surface under a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// m over z = 0.
    pub height: f64,
    /// Unit vector out of the ground.
    pub normal: [f64; 3],
    /// Multiplies the tyres' own friction.
    pub grip: f64,
}

impl Surface {
    /// Flat ground with full grip.
    pub const FLAT: Self = Self { height: 0.0, normal: [0.0, 0.0, 1.0], grip: 1.0 };
}

impl Terrain {
    /// The surface under (x, y), m.
    pub fn at(&self, x: f64, y: f64) -> Surface {
        let (i, u, inside_x) = place(x, self.origin[0], self.cell, self.columns);
        let (j, v, inside_y) = place(y, self.origin[1], self.cell, self.rows);
        let first = j * self.columns + i;
        let corner = |values: &[f64]| {
            [values[first], values[first + 1], values[first + self.columns], values[first + self.columns + 1]]
        };
        let (height, slope) = triangle(corner(&self.heights), u, v);
        let grip = if self.grip.is_empty() { 1.0 } else { triangle(corner(&self.grip), u, v).0 };
        let dx = if inside_x { slope[0] / self.cell } else { 0.0 };
        let dy = if inside_y { slope[1] / self.cell } else { 0.0 };
        let norm = (1.0 + dx * dx + dy * dy).sqrt();
        Surface { height, normal: [-dx / norm, -dy / norm, 1.0 / norm], grip }
    }

    /// Its lowest and highest point, m.
    pub fn range(&self) -> [f64; 2] {
        self.heights
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| [low.min(*h), high.max(*h)])
    }
}

/// Cell of a coordinate, share of the way through it, and whether it lies on the grid at all.
fn place(at: f64, origin: f64, cell: f64, points: usize) -> (usize, f64, bool) {
    let last = (points - 1) as f64;
    let along = (at - origin) / cell;
    let held = along.clamp(0.0, last);
    let index = held.floor().min(last - 1.0);
    (index as usize, held - index, along >= 0.0 && along <= last)
}

/// Value and slopes per cell on the triangle of a cell that (u, v) lies in; the diagonal runs from (0, 0) to (1, 1).
fn triangle([a, b, c, d]: [f64; 4], u: f64, v: f64) -> (f64, [f64; 2]) {
    let slope = if u >= v { [b - a, d - b] } else { [d - c, c - a] };
    (a + slope[0] * u + slope[1] * v, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(slope: [f64; 2]) -> Terrain {
        let heights = (0..12).map(|k| slope[0] * f64::from(k % 4) * 0.5 + slope[1] * f64::from(k / 4) * 0.5);
        Terrain {
            origin: [-1.0, 2.0],
            cell: 0.5,
            columns: 4,
            rows: 3,
            heights: heights.collect(),
            grip: vec![],
        }
    }

    #[test]
    fn a_plane_is_a_plane_everywhere_on_the_grid() {
        let field = plane([0.3, -0.2]);
        for (x, y) in [(-1.0, 2.0), (-0.62, 2.31), (0.1, 2.9), (0.5, 3.0)] {
            let surface = field.at(x, y);
            assert!((surface.height - (0.3 * (x + 1.0) - 0.2 * (y - 2.0))).abs() < 1e-12);
            assert!((surface.normal[0] / surface.normal[2] + 0.3).abs() < 1e-12);
            assert!((surface.normal[1] / surface.normal[2] - 0.2).abs() < 1e-12);
        }
    }

    #[test]
    fn beyond_its_edges_it_goes_on_level() {
        let field = plane([0.3, 0.0]);
        let beyond = field.at(100.0, 2.5);
        assert!((beyond.height - 0.45).abs() < 1e-12);
        assert_eq!(beyond.normal, [0.0, 0.0, 1.0]);
        assert_eq!(field.range(), [0.0, 0.3 * 1.5]);
    }
}
