//! Who takes which place, so that together they go the least way: the method of Kuhn and Munkres.

use pathfinding::kuhn_munkres::kuhn_munkres_min;
use pathfinding::matrix::Matrix;

/// A square metre in the whole numbers that are compared.
const SQUARE: f64 = 1e6;
/// Ways are compared up to this length, m.
const FARTHEST: f64 = 1e5;

/// For each robot the place that it takes, such that the sum of the squares of their ways is least, and that sum in m².
/// At least as many places as robots.
pub fn least_way(robots: &[[f64; 2]], places: &[[f64; 2]]) -> (f64, Vec<usize>) {
    let square = |a: &[f64; 2], b: &[f64; 2]| {
        let off = [0, 1].map(|k| (a[k] - b[k]).clamp(-FARTHEST, FARTHEST));
        off[0] * off[0] + off[1] * off[1]
    };
    let weights = robots
        .iter()
        .map(|robot| places.iter().map(|place| (square(robot, place) * SQUARE) as i64).collect::<Vec<_>>());
    match Matrix::from_rows(weights) {
        Ok(weights) if !robots.is_empty() && robots.len() <= places.len() => {
            let (_, taken) = kuhn_munkres_min(&weights);
            let way = robots.iter().zip(&taken).map(|(robot, place)| square(robot, &places[*place])).sum();
            (way, taken)
        }
        _ => (0.0, (0..robots.len().min(places.len())).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// All ways to fill places, by brute force.
    fn best(robots: &[[f64; 2]], places: &[[f64; 2]], taken: &mut Vec<usize>) -> f64 {
        let Some(robot) = robots.get(taken.len()) else { return 0.0 };
        let free: Vec<usize> = (0..places.len()).filter(|k| !taken.contains(k)).collect();
        free.into_iter()
            .map(|k| {
                let [x, y] = [0, 1].map(|i| robot[i] - places[k][i]);
                let way = x * x + y * y;
                taken.push(k);
                let rest = best(robots, places, taken);
                taken.pop();
                way + rest
            })
            .fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #[test]
        fn no_other_way_is_shorter(
            robots in prop::collection::vec((-5.0..5.0, -5.0..5.0), 1..5),
            more in prop::collection::vec((-5.0..5.0, -5.0..5.0), 0..2),
            places in prop::collection::vec((-5.0..5.0, -5.0..5.0), 4..5),
        ) {
            let robots: Vec<[f64; 2]> = robots.into_iter().map(|(x, y)| [x, y]).collect();
            let places: Vec<[f64; 2]> = places.into_iter().chain(more).map(|(x, y)| [x, y]).collect();
            let (way, taken) = least_way(&robots, &places);
            let mut once = taken.clone();
            once.sort_unstable();
            once.dedup();
            prop_assert_eq!(once.len(), robots.len());
            prop_assert!((way - best(&robots, &places, &mut vec![])).abs() < 1e-4);
        }
    }

    #[test]
    fn nobody_takes_nothing() {
        assert_eq!(least_way(&[], &[]), (0.0, vec![]));
    }
}
