//! Names at the ends of curves, moved apart where they would cover each other.

/// Places of texts that want to be at `wanted`, at least `apart` from each other and within [low, high] as far as there
/// is room; in the order of `wanted`.
pub(crate) fn spread(wanted: &[f64], apart: f64, [low, high]: [f64; 2]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..wanted.len()).collect();
    order.sort_by(|a, b| wanted[*a].total_cmp(&wanted[*b]).then(a.cmp(b)));
    let mut at = wanted.to_vec();
    let mut least = low;
    for k in &order {
        at[*k] = at[*k].max(least);
        least = at[*k] + apart;
    }
    let mut most = high;
    for k in order.iter().rev() {
        at[*k] = at[*k].min(most);
        most = at[*k] - apart;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_keep_apart_and_in_order() {
        let at = spread(&[10.0, 9.0, 30.0, 9.5], 8.0, [0.0, 40.0]);
        let mut sorted = at.clone();
        sorted.sort_by(f64::total_cmp);
        assert!(sorted.windows(2).all(|w| w[1] - w[0] >= 8.0 - 1e-9), "{at:?}");
        assert!(at[1] < at[3] && at[3] < at[0] && at[0] < at[2], "{at:?}");
        assert!(spread(&[], 8.0, [0.0, 1.0]).is_empty());
    }
}
