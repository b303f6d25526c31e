//! Heights out of a seed.

use crate::random::RandomStream;
use crate::types::Noise;
use vocabulary::Terrain;

/// Keeps the ground's random numbers apart from those of groups and patterns.
const FIRST_STREAM: u64 = 1 << 40;

/// Columns and rows of a grid of cells of side `cell` (m) that covers `region` (m).
pub(crate) fn grid([x0, y0, x1, y1]: [f64; 4], cell: f64) -> [f64; 2] {
    // A hair less keeps rounding from adding a column.
    [x1 - x0, y1 - y0].map(|side| (side / cell - 1e-9).ceil() + 1.0)
}

/// Level ground at z = 0 over `region` (m); the grid has to be one that memory can hold.
pub(crate) fn level(region: [f64; 4], cell: f64) -> Terrain {
    let [columns, rows] = grid(region, cell).map(|points| (points as usize).max(2));
    Terrain {
        origin: [region[0], region[1]],
        cell,
        columns,
        rows,
        heights: vec![0.0; columns * rows],
        grip: vec![],
    }
}

/// Waves of random height and place: `octaves` layers, each of half the length and height of the one before, so that
/// the largest |height| is the amplitude; they fade to 0 within a wavelength of the region's edges.
pub(crate) fn make(noise: &Noise, octaves: u32) -> Terrain {
    let mut terrain = level(noise.region, noise.cell);
    let [x0, y0, x1, y1] = noise.region;
    let layers: Vec<_> = (0..octaves)
        .map(|octave| ReliefLayer::new(noise, octave, noise.wavelength / f64::from(1u32 << octave)))
        .collect();
    let fade = |at: f64, from: f64, to: f64| {
        let width = noise.wavelength.min(0.5 * (to - from));
        smooth(((at - from).min(to - at) / width).clamp(0.0, 1.0))
    };
    for (index, height) in terrain.heights.iter_mut().enumerate() {
        let [i, j] = [index % terrain.columns, index / terrain.columns];
        let (x, y) = (i as f64 * noise.cell, j as f64 * noise.cell);
        let sum: f64 = layers.iter().map(|layer| layer.at(x, y)).sum();
        *height = sum * fade(x0 + x, x0, x1) * fade(y0 + y, y0, y1);
    }
    let largest = terrain.heights.iter().fold(0.0, |most: f64, height| most.max(height.abs()));
    if largest > 0.0 {
        terrain.heights.iter_mut().for_each(|height| *height *= noise.amplitude / largest);
    }
    terrain
}

/// One layer of gradient noise: a lattice with a slope and a height at each of its points.
struct ReliefLayer {
    spacing: f64,
    columns: usize,
    /// [slope along x, slope along y, height] per point.
    points: Vec<[f64; 3]>,
}

impl ReliefLayer {
    /// Waves of about `length` m.
    fn new(noise: &Noise, octave: u32, length: f64) -> Self {
        let mut random = RandomStream::new(noise.seed, FIRST_STREAM + u64::from(octave));
        let scale = length / noise.wavelength;
        // A hill and a hollow make a wave, so two points of the lattice.
        let spacing = 0.5 * length;
        let [columns, rows] = grid(noise.region, spacing).map(|points| points as usize + 2);
        let mut next = || scale * random.signed();
        let points = (0..columns * rows).map(|_| [next(), next(), next()]).collect();
        Self { spacing, columns, points }
    }

    /// Height at (x, y) in m from the region's corner.
    fn at(&self, x: f64, y: f64) -> f64 {
        let [u, v] = [x / self.spacing, y / self.spacing];
        let [i, j] = [u.floor(), v.floor()];
        let [u, v] = [u - i, v - j];
        let corner = |di: usize, dj: usize| {
            let index = (j as usize + dj) * self.columns + i as usize + di;
            self.points.get(index).map_or(0.0, |[a, b, h]| h + a * (u - di as f64) + b * (v - dj as f64))
        };
        let mix = |a: f64, b: f64, share: f64| a + (b - a) * smooth(share);
        mix(mix(corner(0, 0), corner(1, 0), u), mix(corner(0, 1), corner(1, 1), u), v)
    }
}

/// From 0 to 1 with two derivatives of 0 at either end.
fn smooth(t: f64) -> f64 {
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE: Noise =
        Noise { amplitude: 0.2, wavelength: 1.0, seed: 3, region: [-2.0, 1.0, 3.0, 5.05], cell: 0.1 };

    #[test]
    fn it_reaches_its_amplitude_fades_at_its_edges_and_depends_on_the_seed() {
        let ground = make(&NOISE, 3);
        assert_eq!((ground.columns, ground.rows, ground.heights.len()), (51, 42, 51 * 42));
        let [low, high] = ground.range();
        assert!((high.max(-low) - 0.2).abs() < 1e-12 && low < 0.0 && high > 0.0, "{low} {high}");
        for k in 0..=50 {
            let along = f64::from(k) * 0.1;
            for (x, y) in [(-2.0 + along, 1.0), (-2.0 + along, 5.1), (-2.0, 1.0 + along), (3.0, 1.0 + along)]
            {
                assert!(ground.at(x, y).height.abs() < 1e-12, "an edge at {x}, {y}");
            }
        }
        assert_eq!(ground, make(&NOISE, 3));
        assert_ne!(ground, make(&Noise { seed: 4, ..NOISE }, 3));
    }

    #[test]
    fn hills_are_smooth() {
        let hills = make(&Noise { wavelength: 2.0, ..NOISE }, 1);
        let steps = hills.heights.chunks(hills.columns).flat_map(|row| row.windows(2));
        let steepest = steps.map(|pair| (pair[1] - pair[0]).abs() / 0.1).fold(0.0, f64::max);
        // A sine of that height and length rises by 2π A/λ = 0.63.
        assert!(steepest < 2.0, "{steepest}");
    }
}
