//! Lines with fewer points that look the same: for pictures that have to be quick.

use glam::DVec2;

/// Opacities this near to each other look the same.
const ALIKE: f32 = 0.025;
/// Most points that are left out in a row: a bound of the work for each of them.
const MOST: usize = 24;

/// Some of `points`, each with its opacity, such that all others are within `within(place)` m of the lines between them.
pub(crate) fn thinned(points: &[(DVec2, f32)], within: impl Fn(DVec2) -> f64) -> Vec<(DVec2, f32)> {
    let bounds: Vec<_> = points.iter().map(|(place, _)| within(*place)).collect();
    let mut kept = Vec::with_capacity(points.len() / 4 + 2);
    kept.extend(points.first());
    let mut anchor = 0;
    for k in 2..points.len() {
        let close = |j: usize| near([&points[j], &points[anchor], &points[k]], bounds[j]);
        if k - anchor > MOST || !(anchor + 1..k).all(close) {
            anchor = k - 1;
            kept.push(points[anchor]);
        }
    }
    kept.extend(points.last().filter(|_| points.len() > 1));
    kept
}

/// Whether a point is as good as on the line between two others.
fn near([(place, alpha), from, to]: [&(DVec2, f32); 3], bound: f64) -> bool {
    let along = to.0 - from.0;
    let share = ((*place - from.0).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
    let even = from.1 + (to.1 - from.1) * share as f32;
    place.distance(from.0 + along * share) <= bound && (alpha - even).abs() <= ALIKE
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::math;

    #[test]
    fn what_is_left_out_lies_on_the_line() {
        let point = |k: u32| {
            let turn = 0.01 * f64::from(k);
            (DVec2::new(turn, 0.3 * math::sin(3.0 * turn)), if k < 200 { 0.8 } else { 0.2 })
        };
        let points: Vec<_> = (0..400).map(point).collect();
        let thin = thinned(&points, |_| 0.002);
        assert!(thin.len() < 60 && thin[0] == points[0] && thin.last() == points.last(), "{}", thin.len());
        for p in &points {
            assert!(thin.windows(2).any(|w| near([p, &w[0], &w[1]], 0.0021)), "{p:?}");
        }
        assert_eq!(thinned(&points[..1], |_| 1.0).len(), 1);
        assert_eq!(thinned(&points[..2], |_| 1.0).len(), 2);
        assert!(thinned(&[], |_| 1.0).is_empty());
    }
}
