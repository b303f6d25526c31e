//! Small dense symmetric systems: Cholesky's factorization, row by row.

/// A symmetric matrix by its lower half, row by row.
#[derive(Debug, Clone)]
pub(crate) struct Symmetric {
    size: usize,
    rows: Vec<f64>,
}

impl Symmetric {
    pub(crate) fn zero(size: usize) -> Self {
        Self { size, rows: vec![0.0; size * size] }
    }

    /// Adds to an entry and its mirror image.
    pub(crate) fn add(&mut self, row: usize, column: usize, value: f64) {
        let (row, column) = (row.max(column), row.min(column));
        self.rows[row * self.size + column] += value;
    }

    /// Adds `weight` times the outer product of a vector whose entries from `end` on are 0.
    pub(crate) fn add_square(&mut self, vector: &[f64], end: usize, weight: f64) {
        for row in 0..end {
            let scaled = weight * vector[row];
            let entries = &mut self.rows[row * self.size..=row * self.size + row];
            for (entry, other) in entries.iter_mut().zip(vector) {
                *entry += scaled * other;
            }
        }
    }

    /// Adds to all of the diagonal.
    pub(crate) fn add_diagonal(&mut self, value: f64) {
        for k in 0..self.size {
            self.rows[k * self.size + k] += value;
        }
    }

    /// Its factor L with L Lᵀ equal to it, if it is positive definite.
    pub(crate) fn factor(mut self) -> Option<Factor> {
        let n = self.size;
        for row in 0..n {
            for column in 0..=row {
                let (above, rest) = self.rows.split_at(row * n);
                let own = &rest[..=row];
                let other = if column == row { own } else { &above[column * n..=column * n + column] };
                let sum: f64 = own[..column].iter().zip(&other[..column]).map(|(a, b)| a * b).sum();
                let left = own[column] - sum;
                let entry = if column < row {
                    left / other[column]
                } else if left > 0.0 {
                    left.sqrt()
                } else {
                    return None;
                };
                self.rows[row * n + column] = entry;
            }
        }
        Some(Factor { size: n, rows: self.rows })
    }
}

/// A lower triangle.
#[derive(Debug, Clone)]
pub(crate) struct Factor {
    size: usize,
    rows: Vec<f64>,
}

impl Factor {
    /// Solves L Lᵀ x = b.
    pub(crate) fn solve(&self, b: &[f64]) -> Vec<f64> {
        let n = self.size;
        let mut x = b.to_vec();
        for row in 0..n {
            let sum: f64 = (0..row).map(|k| self.rows[row * n + k] * x[k]).sum();
            x[row] = (x[row] - sum) / self.rows[row * n + row];
        }
        for row in (0..n).rev() {
            let sum: f64 = (row + 1..n).map(|k| self.rows[k * n + row] * x[k]).sum();
            x[row] = (x[row] - sum) / self.rows[row * n + row];
        }
        x
    }
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_is_solved() {
        let mut matrix = Symmetric::zero(3);
        let vectors = [[1.0, 2.0, 0.0], [0.5, -1.0, 3.0], [2.0, 0.0, 1.0]];
        for vector in &vectors {
            matrix.add_square(vector, 3, 2.0);
        }
        matrix.add(0, 2, 0.25);
        matrix.add_diagonal(0.5);
        let x = matrix.factor().expect("positive").solve(&[1.0, -2.0, 3.0]);
        for row in 0..3 {
            let mut value = 0.5 * x[row];
            value += vectors.iter().map(|v| 2.0 * v[row] * dot(v, &x)).sum::<f64>();
            value += 0.25
                * (if row == 0 {
                    x[2]
                } else if row == 2 {
                    x[0]
                } else {
                    0.0
                });
            assert!((value - [1.0, -2.0, 3.0][row]).abs() < 1e-12, "{x:?}");
        }
        let mut hollow = Symmetric::zero(2);
        hollow.add(0, 1, 1.0);
        assert!(hollow.factor().is_none());
    }
}
