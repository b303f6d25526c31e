//! Ground that is not flat: a mesh of the height field that goes on level far beyond its edges.

use super::asphalt::Asphalt;
use super::frame::FrameGroups;
use super::{Canvas, Recipe, StreamBuffer, developed, shader, vertices};
use crate::Gpu;
use crate::camera::Camera;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use std::ops::Range;
use vocabulary::Terrain;
use wgpu::{BindGroup, BufferUsages, vertex_attr_array};

pub(crate) const SHADERS: [&str; 2] = developed!("common/light", "common/asphalt", "terrain");

/// How far the ground goes on beyond the field, m: to where the view ends.
const BEYOND: f64 = 560.0;

/// Mirrors `TerrainVertex` of the shader.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct TerrainVertex {
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
    pub(crate) grip: f32,
}

/// Mesh and pipeline.
#[derive(Debug)]
pub(crate) struct TerrainPass {
    dry: wgpu::RenderPipeline,
    slick: wgpu::RenderPipeline,
    asphalt: BindGroup,
    points: StreamBuffer,
    triangles: StreamBuffer,
    /// Those that grip come first.
    pieces: Vec<Piece>,
}

/// Triangles that lie together and look alike.
#[derive(Debug, Clone, PartialEq)]
struct Piece {
    triangles: Range<u32>,
    slick: bool,
    /// A ball around them, in the world, m.
    middle: DVec3,
    radius: f64,
}

impl TerrainPass {
    pub(crate) const ATTRIBUTES: [wgpu::VertexAttribute; 3] =
        vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32];

    pub(crate) fn new(
        gpu: &Gpu,
        canvas: Canvas,
        groups: &FrameGroups,
        asphalt: &Asphalt,
        terrain: &Terrain,
    ) -> Self {
        let (points, triangles) = mesh(terrain);
        let recipe = Recipe {
            label: "terrain",
            source: canvas.of(SHADERS),
            groups: &[&groups.view_layout, &groups.light_layout, &asphalt.layout],
            buffers: &[vertices::<TerrainVertex>(&Self::ATTRIBUTES)],
            colour: Some((canvas, None)),
            depth: Some((wgpu::CompareFunction::Less, true)),
            ..Default::default()
        };
        let (dry, slick) = (recipe.build(gpu), Recipe { entry: "slick", ..recipe }.build(gpu));
        let (triangles, pieces) = parted(&triangles, &points, terrain);
        let (corners, indices) = (bytemuck::cast_slice(&points), bytemuck::cast_slice(&triangles));
        Self {
            dry,
            slick,
            asphalt: asphalt.group.clone(),
            points: StreamBuffer::constant(gpu, "terrain", BufferUsages::VERTEX, corners),
            triangles: StreamBuffer::constant(gpu, "terrain", BufferUsages::INDEX, indices),
            pieces,
        }
    }

    /// What of it a camera may see.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, camera: &Camera) {
        pass.set_bind_group(2, &self.asphalt, &[]);
        pass.set_vertex_buffer(0, self.points.slice());
        pass.set_index_buffer(self.triangles.slice(), wgpu::IndexFormat::Uint32);
        for (slick, pipeline) in [(false, &self.dry), (true, &self.slick)] {
            pass.set_pipeline(pipeline);
            let seen = |p: &&Piece| p.slick == slick && camera.may_see(p.middle, p.radius);
            let draw = |pass: &mut wgpu::RenderPass<'_>, run: Range<u32>| {
                if !run.is_empty() {
                    pass.draw_indexed(run, 0, 0..1);
                }
            };
            // Pieces that follow each other are drawn as one.
            let mut run = 0..0;
            for piece in self.pieces.iter().filter(seen) {
                if piece.triangles.start != run.end {
                    draw(pass, run.clone());
                    run.start = piece.triangles.start;
                }
                run.end = piece.triangles.end;
            }
            draw(pass, run);
        }
    }
}

/// Cells along the side of a piece.
const PIECE: f64 = 12.0;

/// Triangles by the piece they belong to, those that grip before those that do not, and the pieces.
fn parted(triangles: &[u32], points: &[TerrainVertex], terrain: &Terrain) -> (Vec<u32>, Vec<Piece>) {
    let corner = |k: u32| DVec3::from_array(points[k as usize].position.map(f64::from));
    let key = |t: &[u32]| {
        let slick = t.iter().any(|k| points[*k as usize].grip < 1.0);
        let middle = (corner(t[0]) + corner(t[1]) + corner(t[2])) / 3.0;
        let place = |x: f64| (x / (PIECE * terrain.cell)).floor().clamp(-1.0, 1e6) as i64;
        (slick, place(middle.y), place(middle.x))
    };
    let mut sorted: Vec<_> = triangles.chunks_exact(3).map(|t| (key(t), t)).collect();
    sorted.sort_by_key(|(key, _)| *key);
    let origin = DVec3::new(terrain.origin[0], terrain.origin[1], 0.0);
    let mut pieces = Vec::new();
    let mut first = 0;
    for piece in sorted.chunk_by(|a, b| a.0 == b.0) {
        let places = || piece.iter().flat_map(|(_, t)| t.iter().map(|k| corner(*k)));
        let (low, high) =
            places().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        let last = first + 3 * piece.len() as u32;
        pieces.push(Piece {
            triangles: first..last,
            slick: piece[0].0.0,
            middle: origin + (low + high) * 0.5,
            radius: 0.5 * low.distance(high),
        });
        first = last;
    }
    (sorted.iter().flat_map(|(_, t)| t.iter().copied()).collect(), pieces)
}

/// Points relative to the terrain's origin, one more around the field on all sides, and triangles between them.
fn mesh(terrain: &Terrain) -> (Vec<TerrainVertex>, Vec<u32>) {
    let (columns, rows) = (terrain.columns + 2, terrain.rows + 2);
    let row = |row| (0..columns).map(move |column| point(terrain, column, row));
    let points: Vec<_> = (0..rows).flat_map(row).collect();
    let triangles = faces(&points, columns, rows);
    (points, triangles)
}

/// Most cells along a side of what is drawn as one.
const MOST_MERGED: usize = 64;

/// Two triangles for every cell; level cells that grip alike are drawn together.
fn faces(points: &[TerrainVertex], columns: usize, rows: usize) -> Vec<u32> {
    let wide = columns - 1;
    let mut done = vec![false; wide * (rows - 1)];
    let mut triangles = Vec::new();
    for row in 0..rows - 1 {
        for column in 0..wide {
            if done[row * wide + column] {
                continue;
            }
            let alike = |i: usize, j: usize| {
                i < wide - 1
                    && j < rows - 2
                    && !done[j * wide + i]
                    && level(points, columns, i, j, [column, row])
            };
            // The outermost cells are as long as the ground goes on.
            let inner = column > 0 && row > 0 && alike(column, row);
            let across = |j: usize| (column..column + MOST_MERGED).take_while(|i| alike(*i, j)).count();
            let count = if inner { across(row) } else { 1 };
            let full = |j: &usize| (column..column + count).all(|i| alike(i, *j));
            let high = if inner { (row..row + MOST_MERGED).take_while(full).count() } else { 1 };
            for j in row..row + high {
                done[j * wide + column..j * wide + column + count].fill(true);
            }
            let at = |i: usize, j: usize| (j * columns + i) as u32;
            let (last, top) = (column + count, row + high);
            triangles.extend([at(column, row), at(last, row), at(last, top)]);
            triangles.extend([at(column, row), at(last, top), at(column, top)]);
        }
    }
    triangles
}

/// Whether a cell is level and grips like the first point of another.
fn level(points: &[TerrainVertex], columns: usize, i: usize, j: usize, other: [usize; 2]) -> bool {
    let like = points[other[1] * columns + other[0]];
    let corners = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].map(|(i, j)| points[j * columns + i]);
    corners.iter().all(|p| p.normal[2] == 1.0 && p.position[2] == like.position[2] && p.grip == like.grip)
}

/// A point by its place in the grid that is one wider than the field.
fn point(terrain: &Terrain, column: usize, row: usize) -> TerrainVertex {
    let held = |k: usize, count: usize| k.clamp(1, count) - 1;
    let (i, j) = (held(column, terrain.columns), held(row, terrain.rows));
    let height = |i: usize, j: usize| terrain.heights[j * terrain.columns + i];
    let along = |k: usize, count: usize| {
        let off = if k == 0 { -BEYOND } else { f64::from(u8::from(k > count)) * BEYOND };
        held(k, count) as f64 * terrain.cell + off
    };
    // Slopes across two cells; the border is shaded as the level ground that begins there.
    let slope = |low: f64, high: f64| (high - low) / (2.0 * terrain.cell);
    let (west, east) = (i.saturating_sub(1), (i + 1).min(terrain.columns - 1));
    let (south, north) = (j.saturating_sub(1), (j + 1).min(terrain.rows - 1));
    let inside = |k: usize, count: usize| (2..count).contains(&k);
    let dx = if inside(column, terrain.columns) { slope(height(west, j), height(east, j)) } else { 0.0 };
    let dy = if inside(row, terrain.rows) { slope(height(i, south), height(i, north)) } else { 0.0 };
    let normal = Vec3::new(-dx as f32, -dy as f32, 1.0).normalize();
    let place = [along(column, terrain.columns), along(row, terrain.rows), height(i, j)];
    let grip = terrain.grip.get(j * terrain.columns + i).copied().unwrap_or(1.0);
    TerrainVertex { position: place.map(|x| x as f32), normal: normal.to_array(), grip: grip as f32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mesh_is_the_field_and_goes_on_level() {
        let heights = (0..12).map(|k| f64::from(k % 4) * 0.1).collect();
        let terrain = Terrain { origin: [2.0, 3.0], cell: 0.5, columns: 4, rows: 3, heights, grip: vec![] };
        let (points, triangles) = mesh(&terrain);
        assert_eq!((points.len(), triangles.len()), (30, 6 * 5 * 4));
        for point in &points {
            let [x, y, z] = point.position.map(f64::from);
            let surface = terrain.at(x + 2.0, y + 3.0);
            assert!((surface.height - z).abs() < 1e-6, "{point:?}");
            assert!(point.normal[2] > 0.9 && point.grip == 1.0);
        }
        assert!(points[0].position[0] < -500.0 && points[29].position[1] > 500.0);
    }

    #[test]
    fn pieces_hold_all_triangles_once() {
        let (columns, rows) = (60, 50);
        let heights = (0..columns * rows).map(|k| f64::from(k as u32 % 7) * 0.1).collect();
        let grip = (0..columns * rows).map(|k| if k % 60 < 9 { 0.3 } else { 1.0 }).collect();
        let terrain = Terrain { origin: [5.0, -3.0], cell: 0.5, columns, rows, heights, grip };
        let (points, triangles) = mesh(&terrain);
        let (sorted, pieces) = parted(&triangles, &points, &terrain);
        assert_eq!(sorted.len(), triangles.len());
        assert!(
            pieces.windows(2).all(|p| p[0].triangles.end == p[1].triangles.start && p[0].slick <= p[1].slick)
        );
        assert_eq!(pieces.last().map(|p| p.triangles.end as usize), Some(sorted.len()));
        for piece in &pieces {
            for k in &sorted[piece.triangles.start as usize..piece.triangles.end as usize] {
                let [x, y, z] = points[*k as usize].position.map(f64::from);
                assert!(piece.middle.distance(DVec3::new(x + 5.0, y - 3.0, z)) < piece.radius + 1e-6);
            }
        }
    }

    #[test]
    fn level_ground_is_drawn_in_large_pieces() {
        let (columns, rows) = (60, 50);
        let bump = 25 * columns + 30;
        let heights = (0..columns * rows).map(|k| f64::from(u8::from(k == bump))).collect();
        let terrain = Terrain { origin: [0.0; 2], cell: 0.5, columns, rows, heights, grip: vec![] };
        let (points, triangles) = mesh(&terrain);
        assert!(triangles.len() < 6 * 300, "{}", triangles.len());
        let area: f64 = triangles
            .chunks_exact(3)
            .map(|t| {
                let at = |k: usize| points[t[k] as usize].position.map(f64::from);
                let (a, b, c) = (at(0), at(1), at(2));
                0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
            })
            .sum();
        let side = |cells: usize| cells as f64 * 0.5 + 2.0 * BEYOND;
        assert!((area / (side(columns - 1) * side(rows - 1)) - 1.0).abs() < 1e-6, "{area}");
    }
}
