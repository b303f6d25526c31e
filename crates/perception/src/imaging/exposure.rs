//! The light that gathers while a shutter is open.

use vocabulary::Grey;

/// Instants that stand for the time a shutter is open.
const INSTANTS: u32 = 6;

/// The mean of pictures taken over `shutter` s, whose middle is the instant of the picture; a single one where nothing is
/// open any longer than that. `take` is told how far from that instant to look, s, and takes as many pictures every time.
///
/// # Errors
/// The first that `take` returns.
pub fn gather<E>(
    shutter: f64,
    mut take: impl FnMut(f64, &mut Vec<Grey>) -> Result<(), E>,
) -> Result<Vec<Grey>, E> {
    let mut pictures = Vec::new();
    if shutter.is_nan() || shutter <= 0.0 {
        take(0.0, &mut pictures)?;
        return Ok(pictures);
    }
    let mut sums: Vec<Vec<u32>> = Vec::new();
    for k in 0..INSTANTS {
        take(shutter * (f64::from(k) / f64::from(INSTANTS - 1) - 0.5), &mut pictures)?;
        sums.resize_with(pictures.len(), Vec::new);
        for (sum, picture) in sums.iter_mut().zip(&pictures) {
            sum.resize(picture.values.len(), 0);
            for (total, value) in sum.iter_mut().zip(&picture.values) {
                *total += u32::from(*value);
            }
        }
    }
    for (picture, sum) in pictures.iter_mut().zip(&sums) {
        for (value, total) in picture.values.iter_mut().zip(sum) {
            *value = ((total + INSTANTS / 2) / INSTANTS) as u8;
        }
    }
    Ok(pictures)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of one row in which a bright dot moves by a pixel in 10 ms, from the middle on.
    fn moving(at: f64) -> Vec<Grey> {
        let dot = (5.0 + at / 0.01).round();
        let values = (0..11).map(|x| if f64::from(x) == dot { 240 } else { 0 }).collect();
        vec![Grey { width: 11, height: 1, values }]
    }

    #[test]
    fn what_moves_is_smeared_evenly_around_where_it_is() {
        let over = |shutter| {
            let taken = gather(shutter, |off, pictures| {
                *pictures = moving(off);
                Ok::<(), String>(())
            });
            taken.expect("a picture")
        };
        let still = over(0.0);
        assert_eq!(still[0].values[5], 240);
        let smeared = over(0.1);
        let values = &smeared[0].values;
        let sum: f64 = values.iter().map(|v| f64::from(*v)).sum();
        let middle: f64 =
            values.iter().zip(0..).map(|(v, x)| f64::from(*v) * f64::from(x)).sum::<f64>() / sum;
        assert!((sum - 240.0).abs() < 1e-9 && (middle - 5.0).abs() < 1e-9, "{values:?}");
        assert!(values.iter().all(|v| *v <= 80), "{values:?}");
    }

    #[test]
    fn the_first_failure_ends_it() {
        let mut calls = 0;
        let failed = gather(0.01, |_, _| {
            calls += 1;
            if calls == 2 { Err("no light") } else { Ok(()) }
        });
        assert_eq!((failed, calls), (Err("no light"), 2));
    }
}
