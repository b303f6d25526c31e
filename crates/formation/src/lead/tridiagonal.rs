//! Linear systems of three diagonals, solved in time that grows with their size alone: a curve may have many points.

use std::array::from_fn;

/// A matrix with entries beside the diagonal only; row k has `lower[k - 1]`, `diagonal[k]`, `upper[k]`.
#[derive(Debug, Clone)]
pub(super) struct Tridiagonal {
    pub(super) lower: Vec<f64>,
    pub(super) diagonal: Vec<f64>,
    pub(super) upper: Vec<f64>,
}

impl Tridiagonal {
    /// Turns the right sides into solutions, by elimination with exchange of rows. The matrix is not singular.
    pub(super) fn solve<const N: usize>(mut self, right: &mut [[f64; N]]) {
        let n = self.diagonal.len();
        // What exchanged rows put two beside the diagonal.
        let mut second = vec![0.0; n];
        for k in 0..n.saturating_sub(1) {
            if self.lower[k].abs() > self.diagonal[k].abs() {
                std::mem::swap(&mut self.diagonal[k], &mut self.lower[k]);
                std::mem::swap(&mut self.upper[k], &mut self.diagonal[k + 1]);
                if k + 2 < n {
                    std::mem::swap(&mut second[k], &mut self.upper[k + 1]);
                }
                right.swap(k, k + 1);
            }
            let share = self.lower[k] * (1.0 / self.diagonal[k]);
            self.diagonal[k + 1] -= self.upper[k] * share;
            if k + 2 < n {
                self.upper[k + 1] -= second[k] * share;
            }
            let (above, below) = (right[k], right[k + 1]);
            right[k + 1] = from_fn(|i| below[i] - above[i] * share);
        }
        for k in (0..n).rev() {
            let after = [1, 2].map(|more| right.get(k + more).copied());
            right[k] = from_fn(|i| {
                let mut value = right[k][i];
                if let Some(after) = after[1] {
                    value -= after[i] * second[k];
                }
                if let Some(after) = after[0] {
                    value -= after[i] * self.upper[k];
                }
                value / self.diagonal[k]
            });
        }
    }

    /// As [`Self::solve`], with two more entries, in the corners right above and left below (Sherman and Morrison).
    pub(super) fn solve_cyclic(mut self, [above, below]: [f64; 2], right: &mut [[f64; 2]]) {
        let n = self.diagonal.len();
        let first = -self.diagonal[0];
        self.diagonal[0] -= first;
        self.diagonal[n - 1] -= above * below / first;
        let mut all: Vec<[f64; 3]> = right.iter().map(|[x, y]| [*x, *y, 0.0]).collect();
        all[0][2] = first;
        all[n - 1][2] = below;
        self.solve(&mut all);
        let along = |i: usize| all[0][i] + all[n - 1][i] * above / first;
        for i in 0..2 {
            let share = along(i) / (1.0 + along(2));
            for (out, row) in right.iter_mut().zip(&all) {
                out[i] = row[i] - share * row[2];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    proptest! {
        /// Against nalgebra's dense LU, bit for bit where there are no corners.
        #[test]
        fn it_is_the_dense_solution(
            rows in proptest::collection::vec([0.1..4.0, 0.1..4.0, -3.0..3.0, -3.0..3.0], 3..12),
        ) {
            let n = rows.len();
            let diagonal: Vec<f64> = rows.iter().map(|r| 2.0 * (r[0] + r[1])).collect();
            let lower: Vec<f64> = rows[1..].iter().map(|r| r[0]).collect();
            let upper: Vec<f64> = rows[..n - 1].iter().map(|r| r[1]).collect();
            let right: Vec<[f64; 2]> = rows.iter().map(|r| [r[2], r[3]]).collect();
            let banded = Tridiagonal { lower: lower.clone(), diagonal: diagonal.clone(), upper: upper.clone() };
            let mut dense = DMatrix::from_fn(n, n, |i, j| match (i, j) {
                _ if i == j => diagonal[i],
                _ if i == j + 1 => lower[j],
                _ if j == i + 1 => upper[i],
                _ => 0.0,
            });
            let column = |i: usize| DVector::from_iterator(n, right.iter().map(|r| r[i]));
            let mut found = right.clone();
            banded.clone().solve(&mut found);
            for i in 0..2 {
                let wanted = dense.clone().lu().solve(&column(i)).expect("a solution");
                prop_assert!(found.iter().zip(wanted.iter()).all(|(a, b)| a[i] == *b));
            }
            (dense[(0, n - 1)], dense[(n - 1, 0)]) = (rows[0][0], rows[n - 1][1]);
            let mut found = right.clone();
            banded.solve_cyclic([rows[0][0], rows[n - 1][1]], &mut found);
            for i in 0..2 {
                let wanted = dense.clone().lu().solve(&column(i)).expect("a solution");
                prop_assert!(found.iter().zip(wanted.iter()).all(|(a, b)| (a[i] - b).abs() < 1e-12));
            }
        }
    }
}
