//! Which obstacles can be the nearest, cell by cell: exact distances at the cost of one or two obstacles each.

use crate::convex::Convex;

/// A square grid whose cells know the obstacles that are nearest to some point of theirs.
#[derive(Debug, Clone)]
pub(crate) struct NearestGrid {
    origin: [f64; 2],
    /// 1/m.
    per_metre: f64,
    /// Cells along a side, a power of two.
    side: usize,
    /// Which list a cell has.
    lists: Vec<u32>,
    /// Where lists begin; one more than there are lists.
    begins: Vec<u32>,
    members: Vec<u32>,
}

/// Cells are this large, m, where that does not take too many.
const CELL: f64 = 0.2;
/// Cells along a side at most.
const SIDE_MOST: usize = 1024;
/// A block whose list is no longer than this is not divided.
const SHORT_LIST: usize = 2;

impl NearestGrid {
    /// Over the square that holds the box from `low` to `high`, m.
    pub(crate) fn new(low: [f64; 2], high: [f64; 2], obstacles: &[Convex]) -> Self {
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(CELL);
        let side = ((extent / CELL).ceil() as usize).next_power_of_two().min(SIDE_MOST);
        let mut grid = Self {
            origin: low,
            per_metre: side as f64 / extent,
            side,
            lists: vec![0; side * side],
            begins: vec![0],
            members: vec![],
        };
        let all: Vec<u32> = (0..obstacles.len() as u32).collect();
        grid.fill([0, 0], side, &all, obstacles);
        grid
    }

    /// The obstacles among which the nearest to a point is, if it lies over the grid; those of the nearest cell otherwise.
    pub(crate) fn candidates(&self, point: [f64; 2]) -> &[u32] {
        let cell = |k: usize| {
            ((point[k] - self.origin[k]) * self.per_metre).clamp(0.0, (self.side - 1) as f64) as usize
        };
        let list = self.lists[cell(1) * self.side + cell(0)] as usize;
        &self.members[self.begins[list] as usize..self.begins[list + 1] as usize]
    }

    /// Fills a block of `size` cells by `size`. The distance to an obstacle changes by at most the way that one goes: what
    /// is farther from the middle than the nearest by two half diagonals is not the nearest anywhere in the block.
    fn fill(&mut self, [column, row]: [usize; 2], size: usize, among: &[u32], obstacles: &[Convex]) {
        let half = 0.5 * size as f64 / self.per_metre;
        let middle = [column, row].map(|cell| cell as f64 / self.per_metre + half);
        let middle = [0, 1].map(|k| self.origin[k] + middle[k]);
        let distances: Vec<f64> = among.iter().map(|o| obstacles[*o as usize].distance(middle)).collect();
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        let reach = least + 2.0 * (2.0_f64.sqrt() * half) * (1.0 + 1e-9);
        let kept: Vec<u32> =
            among.iter().zip(&distances).filter(|(_, d)| **d <= reach).map(|(o, _)| *o).collect();
        if size > 1 && kept.len() > SHORT_LIST {
            let half = size / 2;
            for [right, up] in [[0, 0], [half, 0], [0, half], [half, half]] {
                self.fill([column + right, row + up], half, &kept, obstacles);
            }
            return;
        }
        let list = (self.begins.len() - 1) as u32;
        self.members.extend(kept);
        self.begins.push(self.members.len() as u32);
        for row in row..row + size {
            self.lists[row * self.side + column..][..size].fill(list);
        }
    }
}

/// Obstacles by the cells of a coarse grid that their boxes touch, for all within a distance.
#[derive(Debug, Clone)]
pub(crate) struct Buckets {
    origin: [f64; 2],
    per_metre: f64,
    size: [usize; 2],
    begins: Vec<u32>,
    members: Vec<u32>,
}

/// Buckets are no smaller than this, m, and no more than that along a side.
const BUCKET: f64 = 1.0;
const BUCKETS_MOST: f64 = 256.0;

impl Buckets {
    pub(crate) fn new(low: [f64; 2], high: [f64; 2], obstacles: &[Convex]) -> Self {
        let extent = (high[0] - low[0]).max(high[1] - low[1]);
        let per_metre = 1.0 / BUCKET.max(extent / BUCKETS_MOST);
        let size = [0, 1].map(|k| (((high[k] - low[k]) * per_metre).ceil() as usize).max(1));
        let mut buckets = Self { origin: low, per_metre, size, begins: vec![], members: vec![] };
        let mut pairs: Vec<[u32; 2]> = vec![];
        for (index, obstacle) in obstacles.iter().enumerate() {
            let cells = buckets.cells(obstacle.centre(), obstacle.reach());
            pairs.extend(cells.map(|cell| [cell as u32, index as u32]));
        }
        pairs.sort_unstable();
        let mut k = 0;
        for cell in 0..=size[0] * size[1] {
            while k < pairs.len() && (pairs[k][0] as usize) < cell {
                k += 1;
            }
            buckets.begins.push(k as u32);
        }
        buckets.members = pairs.into_iter().map(|[_, index]| index).collect();
        buckets
    }

    /// Numbers of all obstacles whose boxes are within `reach` m of a point, some of them several times.
    pub(crate) fn near(&self, point: [f64; 2], reach: f64) -> impl Iterator<Item = usize> + '_ {
        self.cells(point, reach).flat_map(|cell| {
            let [from, to] = [self.begins[cell], self.begins[cell + 1]];
            self.members[from as usize..to as usize].iter().map(|index| *index as usize)
        })
    }

    fn cells(&self, point: [f64; 2], reach: f64) -> impl Iterator<Item = usize> + use<> {
        let cell = |k: usize, value: f64| {
            ((value - self.origin[k]) * self.per_metre).clamp(0.0, (self.size[k] - 1) as f64) as usize
        };
        let [columns, rows] = [0, 1].map(|k| cell(k, point[k] - reach)..=cell(k, point[k] + reach));
        let width = self.size[0];
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }
}
