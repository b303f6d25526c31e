//! Times of pictures: one rule for all of them.

use crate::error::Error;

/// Times no further apart than this are one, s: a sample's time carries the rounding of its multiplication.
const SAME: f64 = 1e-9;

/// The times asked for, in order, each once; the end of the run if none. What is past the end by rounding is the end.
///
/// # Errors
/// [`Error::Usage`] for a time that is not in the run.
pub fn within(asked: &[f64], duration: f64) -> Result<Vec<f64>, Error> {
    let inside = |t: &f64| (-SAME..=duration + SAME).contains(t);
    if let Some(bad) = asked.iter().find(|t| !inside(t)) {
        return Err(Error::Usage(format!(
            "{bad} s is not within the run: times are from 0 to {} s",
            shown(duration)
        )));
    }
    let mut times = if asked.is_empty() { vec![duration] } else { asked.to_vec() };
    for time in &mut times {
        // Also takes the sign from a zero.
        *time = if *time > 0.0 { time.min(duration) } else { 0.0 };
    }
    times.sort_by(f64::total_cmp);
    times.dedup_by(|a, b| (*a - *b).abs() < SAME);
    Ok(times)
}

/// A time in s as text, without the rounding of a multiplication.
pub fn shown(time: f64) -> String {
    let text = format!("{time:.9}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A time as files are named by it, s: `002.500`, and as many more digits as tell it from all others.
pub fn in_names(time: f64) -> String {
    let text = format!("{time:013.9}");
    let (whole, part) = text.split_once('.').unwrap_or((&text, ""));
    let digits = part.trim_end_matches('0').len().max(3);
    format!("{whole}.{}", &part[..digits])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_time_of_a_run_is_one_of_its_times() {
        for k in 1..=3000 {
            // As a program multiplies, as a person types, and as a file has it.
            let (multiplied, typed) = (f64::from(k) * 0.01, format!("{:.2}", f64::from(k) / 100.0));
            let typed: f64 = typed.parse().expect("a number");
            for [asked, duration] in [[multiplied, typed], [typed, multiplied]] {
                assert_eq!(within(&[asked], duration).expect("a time"), [asked.min(duration)]);
            }
        }
        assert!(within(&[2.31], 2.3).is_err() && within(&[-0.1], 2.3).is_err());
        assert!(within(&[f64::NAN], 2.3).is_err() && within(&[f64::INFINITY], 2.3).is_err());
    }

    #[test]
    fn zero_has_no_sign_and_names_tell_times_apart() {
        let times = within(&[-0.0, 1.0004, 1.0001, 1.0001 + 1e-12], 3.0).expect("times");
        assert_eq!(
            times.iter().map(|t| in_names(*t)).collect::<Vec<_>>(),
            ["000.000", "001.0001", "001.0004"]
        );
        assert!(times[0].is_sign_positive());
        assert_eq!(in_names(230.0 * 0.01), "002.300");
        assert_eq!(in_names(1234.5), "1234.500");
        assert_eq!((shown(2.300_000_000_000_000_3), shown(15.0)), ("2.3".to_owned(), "15".to_owned()));
    }
}
