//! A cell's share in a bell curve.

use std::sync::LazyLock;
use vocabulary::{TAG_CELLS, math};

/// Standard deviations beyond which a bell curve is over.
const REACH: f64 = 3.5;

/// Places of the table per standard deviation.
const FINE: f64 = 64.0;

/// The normal distribution and its density from −4 on.
static TABLE: LazyLock<Vec<[f64; 2]>> = LazyLock::new(|| {
    let density = |x: f64| math::exp(-0.5 * x * x) / (2.0 * std::f64::consts::PI).sqrt();
    let mut below = 0.0;
    let places = (0..=(8.0 * FINE) as usize).map(|k| {
        let x = k as f64 / FINE - 4.0;
        if k > 0 {
            // Simpson's rule over the last stretch.
            let h = 1.0 / FINE;
            below += h / 6.0 * (density(x - h) + 4.0 * density(x - 0.5 * h) + density(x));
        }
        [below, density(x)]
    });
    places.collect()
});

/// How a bell curve around a place is shared among the tag's cells in one direction, and how that changes with the place.
pub(super) struct EdgeProfile {
    first: usize,
    count: usize,
    shares: [[f64; 3]; TAG_CELLS],
}

impl EdgeProfile {
    /// Around `at` (cells from the middle of the tag), with a standard deviation of `soft` cells. The outermost cells go
    /// on for ever.
    pub(super) fn new(at: f64, soft: f64) -> Self {
        let at = at + 0.5 * TAG_CELLS as f64;
        let cell = |x: f64| (x.max(0.0) as usize).min(TAG_CELLS - 1);
        let (first, last) = (cell(at - REACH * soft), cell(at + REACH * soft));
        let mut shares = [[0.0; 3]; TAG_CELLS];
        let mut before = [0.0; 3];
        let table: &[[f64; 2]] = &TABLE;
        for (k, share) in shares.iter_mut().enumerate().take(last + 1 - first) {
            let edge = first + k + 1;
            let until = if edge > last {
                [1.0, 0.0, 0.0]
            } else {
                let x = (edge as f64 - at) / soft;
                let [below, density] = normal(table, x);
                [below, density, x * density]
            };
            // Moving on moves the edge back.
            *share = [until[0] - before[0], (before[1] - until[1]) / soft, before[2] - until[2]];
            before = until;
        }
        Self { first, count: last + 1 - first, shares }
    }

    /// Cell, and its share, the change of the share per cell, and its change with the logarithm of the deviation.
    pub(super) fn shares(&self) -> impl Iterator<Item = (usize, [f64; 3])> + '_ {
        self.shares.iter().take(self.count).enumerate().map(|(k, share)| (self.first + k, *share))
    }
}

/// The normal distribution and its density at `x`.
fn normal(table: &[[f64; 2]], x: f64) -> [f64; 2] {
    let place = (x + 4.0) * FINE;
    if place.is_nan() || place <= 0.0 {
        return [0.0; 2];
    }
    let index = place as usize;
    match table.get(index..index + 2) {
        Some([a, b]) => {
            let share = place - index as f64;
            [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
        }
        _ => [1.0, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up_and_change_as_they_say() {
        for (at, soft) in [(-4.7, 0.3), (0.0, 0.2), (1.37, 0.5), (4.9, 0.9), (2.0, 0.01)] {
            let shares = |at, soft| {
                let mut out = [[0.0; 3]; TAG_CELLS];
                EdgeProfile::new(at, soft).shares().for_each(|(k, share)| out[k] = share);
                out
            };
            let (here, h) = (shares(at, soft), 1e-3);
            assert!((here.iter().map(|s| s[0]).sum::<f64>() - 1.0).abs() < 1e-12);
            let moved = (shares(at + h * soft, soft), shares(at - h * soft, soft));
            let widened = (shares(at, soft * (1.0 + h)), shares(at, soft * (1.0 - h)));
            for (k, cell) in here.iter().enumerate() {
                let change = (moved.0[k][0] - moved.1[k][0]) / (2.0 * h);
                assert!((change - soft * cell[1]).abs() < 2e-2, "{at} {soft} {k}: {change} {cell:?}");
                let change = (widened.0[k][0] - widened.1[k][0]) / (2.0 * h);
                assert!((change - cell[2]).abs() < 2e-2, "{at} {soft} {k}: {change} {cell:?}");
            }
        }
    }
}
