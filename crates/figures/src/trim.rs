//! Curves clipped to their panel, without points that make no difference in print.

use vocabulary::math;

/// Parts of the polyline `points` that lie within [x from, y from, x to, y to].
pub(crate) fn within(points: &[[f64; 2]], edges: [f64; 4]) -> Vec<Vec<[f64; 2]>> {
    let mut parts: Vec<Vec<[f64; 2]>> = vec![];
    for pair in points.windows(2) {
        let Some([from, to]) = segment(pair[0], pair[1], edges) else { continue };
        match parts.last_mut() {
            Some(part) if part.last() == Some(&from) => part.push(to),
            _ => parts.push(vec![from, to]),
        }
    }
    parts
}

/// The part of a segment within the edges (Liang and Barsky 1984).
fn segment(a: [f64; 2], b: [f64; 2], edges: [f64; 4]) -> Option<[[f64; 2]; 2]> {
    let d = [b[0] - a[0], b[1] - a[1]];
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for axis in [0, 1] {
        let (low, high) = (edges[axis] - a[axis], edges[axis + 2] - a[axis]);
        if d[axis] == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (enter, leave) = (low / d[axis], high / d[axis]);
        first = first.max(enter.min(leave));
        last = last.min(enter.max(leave));
    }
    let at = |share: f64| [a[0] + share * d[0], a[1] + share * d[1]];
    // Ends that are inside stay what they are, so that parts join.
    (first <= last).then(|| [if first > 0.0 { at(first) } else { a }, if last < 1.0 { at(last) } else { b }])
}

/// The points without which the polyline would be off by more than `most` (Douglas and Peucker 1973).
pub(crate) fn thinned(points: &[[f64; 2]], most: f64) -> Vec<[f64; 2]> {
    let Some(last) = points.len().checked_sub(1) else { return vec![] };
    let mut kept = vec![false; points.len()];
    (kept[0], kept[last]) = (true, true);
    let mut open = vec![(0, last)];
    while let Some((from, to)) = open.pop() {
        let off = |k: usize| distance(points[k], points[from], points[to]);
        let worst = (from + 1..to).max_by(|a, b| off(*a).total_cmp(&off(*b)));
        if let Some(k) = worst.filter(|k| off(*k) > most) {
            kept[k] = true;
            open.extend([(from, k), (k, to)]);
        }
    }
    points.iter().zip(kept).filter(|(_, kept)| *kept).map(|(p, _)| *p).collect()
}

/// Distance of a point from a segment.
fn distance(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (d, q) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = d[0] * d[0] + d[1] * d[1];
    let share = if square > 0.0 { ((q[0] * d[0] + q[1] * d[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    math::hypot(q[0] - share * d[0], q[1] - share * d[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_cut_where_it_leaves_and_where_it_comes_back() {
        let curve = [[-1.0, 0.5], [0.5, 0.5], [0.5, 3.0], [0.75, 3.0], [0.75, 0.25]];
        let parts = within(&curve, [0.0, 0.0, 1.0, 1.0]);
        assert_eq!(parts, [vec![[0.0, 0.5], [0.5, 0.5], [0.5, 1.0]], vec![[0.75, 1.0], [0.75, 0.25]]]);
        assert!(within(&[[2.0, 2.0], [3.0, 2.0]], [0.0, 0.0, 1.0, 1.0]).is_empty());
    }

    #[test]
    fn thinning_keeps_corners_and_drops_what_lies_between() {
        let line: Vec<[f64; 2]> = (0..=100).map(|k| [f64::from(k), 0.0]).collect();
        assert_eq!(thinned(&line, 0.01), [[0.0, 0.0], [100.0, 0.0]]);
        let corner = [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0], [2.0, 2.0]];
        assert_eq!(thinned(&corner, 0.01), corner);
        assert!(thinned(&[], 1.0).is_empty());
    }
}
