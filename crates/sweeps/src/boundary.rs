//! Where an answer changes: cells of a grid are run coarsely first, and then only where neighbours answer differently.
//!
//! The cells are those of the whole study, with the same seeds: what is run is what the whole study would have run there.

use crate::design::Design;
use std::collections::{BTreeMap, BTreeSet};

/// The search for the edge of the runs that meet their expectations, over one or two varied keys.
#[derive(Debug, Clone)]
pub struct BoundarySearch {
    /// Cells along each axis; one of a single cell where only one key varies.
    lens: [u64; 2],
    /// Side of the squares that are looked at, in cells; it is halved with every round.
    stride: u64,
    /// Lower corners of the squares that are looked at.
    squares: BTreeSet<[u64; 2]>,
    /// Whether a cell's runs meet their expectations, most of them.
    answers: BTreeMap<[u64; 2], bool>,
}

/// Squares along the longer side at first, at most; at least half as many.
const FIRST: u64 = 8;

impl BoundarySearch {
    /// Over the keys that vary on a grid; `None` where these are none or more than two, or numbers are drawn.
    pub fn new(design: &Design) -> Option<Self> {
        let lens = match design.axes() {
            [one] => [1, one.len],
            [one, two] => [one.len, two.len],
            _ => return None,
        };
        let longest = (lens[0].max(lens[1]) - 1).max(1);
        let stride = (longest / FIRST).max(1).next_power_of_two();
        let mut boundary = Self { lens, stride, squares: BTreeSet::new(), answers: BTreeMap::new() };
        for x in (0..lens[0].max(2) - 1).step_by(stride as usize) {
            for y in (0..lens[1].max(2) - 1).step_by(stride as usize) {
                boundary.squares.insert([x, y]);
            }
        }
        Some(boundary)
    }

    fn cell(&self, [x, y]: [u64; 2]) -> u64 {
        x * self.lens[1] + y
    }

    /// A corner of a square, within the grid.
    fn clamped(&self, [x, y]: [u64; 2]) -> [u64; 2] {
        [x.min(self.lens[0] - 1), y.min(self.lens[1] - 1)]
    }

    fn corners(&self, [x, y]: [u64; 2]) -> [[u64; 2]; 4] {
        let s = self.stride;
        [[x, y], [x + s, y], [x, y + s], [x + s, y + s]].map(|corner| self.clamped(corner))
    }

    /// The cells that have to be run next; none once the edge is known between neighbours.
    pub fn wanted(&mut self) -> Vec<u64> {
        loop {
            let corners = self.squares.iter().flat_map(|square| self.corners(*square));
            let open: BTreeSet<[u64; 2]> =
                corners.filter(|corner| !self.answers.contains_key(corner)).collect();
            if !open.is_empty() {
                return open.into_iter().map(|corner| self.cell(corner)).collect();
            }
            if self.stride == 1 {
                return vec![];
            }
            self.refine();
        }
    }

    /// What the runs of a cell say.
    pub fn answer(&mut self, cell: u64, met: bool) {
        self.answers.insert([cell / self.lens[1], cell % self.lens[1]], met);
    }

    /// Divides the squares in which, or at whose sides, the answer changes.
    fn refine(&mut self) {
        let s = self.stride;
        let changes = |square: &[u64; 2]| {
            let [x, y] = *square;
            let [right, top] = self.clamped([x + s, y + s]);
            let columns = self.answers.range([x, 0]..=[right, u64::MAX]);
            let mut inside = columns.filter(|([_, row], _)| (y..=top).contains(row)).map(|(_, met)| *met);
            let first = inside.next();
            inside.any(|met| Some(met) != first)
        };
        let half = s / 2;
        let divided: BTreeSet<[u64; 2]> = self
            .squares
            .iter()
            .filter(|square| changes(square))
            .flat_map(|[x, y]| [[*x, *y], [x + half, *y], [*x, y + half], [x + half, y + half]])
            .filter(|[x, y]| *x < self.lens[0].max(2) - 1 && *y < self.lens[1].max(2) - 1)
            .collect();
        self.squares = divided;
        self.stride = half;
    }

    /// Pairs of neighbouring cells that answer differently: first the one that meets its expectations.
    pub fn edge(&self) -> Vec<[u64; 2]> {
        let mut edge = vec![];
        for (&[x, y], &met) in &self.answers {
            for next in [[x + 1, y], [x, y + 1]] {
                if self.answers.get(&next).is_some_and(|other| *other != met) {
                    let [one, other] = [[x, y], next].map(|place| self.cell(place));
                    edge.push(if met { [one, other] } else { [other, one] });
                }
            }
        }
        edge
    }

    /// Cells that have been run.
    pub fn len(&self) -> u64 {
        self.answers.len() as u64
    }

    /// Whether none has been run.
    pub fn is_empty(&self) -> bool {
        self.answers.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::{Study, StudyParameter};

    fn search(keys: &[(&str, &str)], met: impl Fn(f64, f64) -> bool) -> (BoundarySearch, Design) {
        let parameter = |(key, values): &(&str, &str)| StudyParameter {
            key: (*key).to_owned(),
            values: values.parse().expect("values"),
        };
        let parameters = keys.iter().map(parameter).collect();
        let design = Design::new(Study { parameters, ..Study::of_scene("circle-three", "t") });
        let mut boundary = BoundarySearch::new(&design).expect("one or two keys");
        loop {
            let wanted = boundary.wanted();
            if wanted.is_empty() {
                return (boundary, design);
            }
            for cell in wanted {
                let values = design.point(cell).values;
                let number = |k: usize| values.get(k).and_then(|v| v.parse().ok()).unwrap_or(0.0);
                boundary.answer(cell, met(number(0), number(1)));
            }
        }
    }

    #[test]
    fn the_edge_of_a_disc_is_found_with_a_fraction_of_the_runs() {
        let inside = |x: f64, y: f64| x * x + y * y < 0.5;
        let (boundary, design) = search(&[("a.x", "-1..1/129"), ("a.y", "-1..1/129")], inside);
        let all = design.study().cells();
        assert!(boundary.len() * 5 < all, "{} of {all}", boundary.len());
        // Every pair of neighbours on the two sides of the edge is there.
        let value = |cell: u64| {
            let values = design.point(cell).values;
            inside(values[0].parse().expect("a number"), values[1].parse().expect("a number"))
        };
        let found: BTreeSet<[u64; 2]> = boundary.edge().into_iter().collect();
        let mut wanted = BTreeSet::new();
        for cell in 0..all {
            for (next, exists) in [(cell + 1, cell % 129 != 128), (cell + 129, cell + 129 < all)] {
                if exists && value(cell) != value(next) {
                    wanted.insert(if value(cell) { [cell, next] } else { [next, cell] });
                }
            }
        }
        assert_eq!(found, wanted);
    }

    #[test]
    fn one_key_has_an_edge_too() {
        let (boundary, _) = search(&[("a.x", "0..1/1001")], |x, _| x < 0.3333);
        assert_eq!(boundary.edge(), [[333, 334]]);
        assert!(boundary.len() < 30, "{}", boundary.len());
        let (none, _) = search(&[("a.x", "0..1/3")], |_, _| true);
        assert!(none.edge().is_empty());
    }

    #[test]
    fn drawn_and_many_keys_have_none() {
        let design = |values: &[&str]| {
            let parameter = |(k, values): (usize, &&str)| StudyParameter {
                key: format!("a.k{k}"),
                values: values.parse().expect("values"),
            };
            let parameters = values.iter().enumerate().map(parameter).collect();
            Design::new(Study { parameters, ..Study::of_scene("circle-three", "t") })
        };
        assert!(BoundarySearch::new(&design(&["uniform:0..1"])).is_none());
        assert!(BoundarySearch::new(&design(&["1,2", "1,2", "1,2"])).is_none());
    }
}
