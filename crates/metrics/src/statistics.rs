//! The statistics that every summary of a run needs: root mean squares and medians.

/// A root mean square of vectors that come one after the other, component by component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RootMeanSquare<const N: usize> {
    squares: [f64; N],
    count: u64,
}

impl<const N: usize> RootMeanSquare<N> {
    /// Of nothing yet.
    pub const EMPTY: Self = Self { squares: [0.0; N], count: 0 };

    /// Takes in one vector.
    pub fn add(&mut self, values: [f64; N]) {
        for (sum, value) in self.squares.iter_mut().zip(values) {
            *sum += value * value;
        }
        self.count += 1;
    }

    /// How many vectors there were.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The root mean square, in the unit of the vectors; `None` of no vectors.
    pub fn root(&self) -> Option<[f64; N]> {
        (self.count > 0).then(|| self.squares.map(|sum| (sum / self.count as f64).sqrt()))
    }
}

impl<const N: usize> Default for RootMeanSquare<N> {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// Median, or the mean of the two in the middle; `None` of nothing.
pub fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = values.get(middle)?;
    if values.len().is_multiple_of(2) { Some(0.5 * (upper + values[middle - 1])) } else { Some(*upper) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_mean_square_is_that_of_each_component() {
        let mut rms = RootMeanSquare::default();
        assert_eq!((rms.root(), rms.count()), (None, 0));
        rms.add([3.0, 1.0]);
        rms.add([-4.0, 1.0]);
        let [first, second] = rms.root().expect("two vectors");
        assert!((first - 12.5_f64.sqrt()).abs() < 1e-15 && second == 1.0);
        assert_eq!(rms.count(), 2);
    }

    #[test]
    fn a_median_is_in_the_middle() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(&mut []), None);
    }
}
