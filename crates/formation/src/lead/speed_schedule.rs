//! How fast a curve is driven: speed over time, or over the distance travelled.

use super::Hermite;

/// Speed along a curve.
#[derive(Debug, Clone)]
pub struct SpeedSchedule(Given);

#[derive(Debug, Clone)]
enum Given {
    Time(Hermite),
    /// The profile, its rows' distances, and when each is reached, s.
    Distance {
        speed: Hermite,
        rows: Vec<f64>,
        reached: Vec<f64>,
    },
}

/// Slowest speed over distance, m/s: at rest, time would not go on.
const SLOWEST: f64 = 1e-3;

impl SpeedSchedule {
    /// Speed in m/s over time in s.
    pub fn over_time(speed: Hermite) -> Self {
        Self(Given::Time(speed))
    }

    /// Speed in m/s over the distance travelled in m; no slower than 1 mm/s.
    pub fn over_distance(speed: Hermite) -> Self {
        let mut rows = vec![0.0];
        rows.extend(speed.times().filter(|d| *d > 0.0));
        let mut reached = vec![0.0];
        for pair in rows.windows(2) {
            reached.push(reached[reached.len() - 1] + driving_time(&speed, pair[0], pair[1]));
        }
        Self(Given::Distance { speed, rows, reached })
    }

    /// Distance travelled in m, speed in m/s and acceleration in m/s² at `time` s.
    pub fn at(&self, time: f64) -> [f64; 3] {
        match &self.0 {
            Given::Time(speed) => {
                let [v, acceleration] = speed.at(time);
                [speed.integral(time), v, acceleration]
            }
            Given::Distance { speed, rows, reached } => {
                let travelled = travelled(speed, rows, reached, time);
                let [v, slope] = speed.at(travelled);
                if v < SLOWEST { [travelled, SLOWEST, 0.0] } else { [travelled, v, v * slope] }
            }
        }
    }

    /// When `travelled` m are behind, s; `None` where that never is.
    pub(super) fn when(&self, travelled: f64) -> Option<f64> {
        match &self.0 {
            Given::Time(speed) => {
                let last = speed.times().last().unwrap_or(0.0);
                let spare = travelled - speed.integral(last);
                if spare > 0.0 {
                    let final_speed = speed.at(last)[0];
                    return (final_speed > 0.0).then(|| last + spare / final_speed);
                }
                let (mut low, mut high) = (0.0, last);
                for _ in 0..60 {
                    let middle = f64::midpoint(low, high);
                    if speed.integral(middle) < travelled { low = middle } else { high = middle }
                }
                Some(high)
            }
            Given::Distance { speed, rows, reached } => {
                let k = rows.partition_point(|row| *row <= travelled).max(1) - 1;
                Some(reached[k] + driving_time(speed, rows[k], travelled))
            }
        }
    }

    /// Whether the speed stays what it is from `time` s on.
    pub(super) fn is_steady_from(&self, time: f64) -> bool {
        match &self.0 {
            Given::Time(speed) => speed.times().last().is_none_or(|last| time >= last),
            Given::Distance { reached, .. } => reached.last().is_none_or(|last| time >= *last),
        }
    }
}

/// Seconds from `a` to `b` m: ∫ ds/v(s) by Simpson's rule.
fn driving_time(speed: &Hermite, a: f64, b: f64) -> f64 {
    const PANELS: u32 = 64;
    let slowness = |s: f64| 1.0 / speed.at(s)[0].max(SLOWEST);
    let h = (b - a) / f64::from(PANELS);
    let weighted = |k: u32| match k {
        0 | PANELS => slowness(a + f64::from(k) * h),
        k => f64::from(2 + 2 * (k % 2)) * slowness(a + f64::from(k) * h),
    };
    (0..=PANELS).map(weighted).sum::<f64>() * h / 3.0
}

/// Inverts the driving time by Newton's method inside the rows; the speed is constant beyond them.
fn travelled(speed: &Hermite, rows: &[f64], reached: &[f64], time: f64) -> f64 {
    let v = |s: f64| speed.at(s)[0].max(SLOWEST);
    let k = reached.partition_point(|t| *t <= time).max(1) - 1;
    let spare = time - reached[k];
    if k + 1 == rows.len() {
        return rows[k] + spare * v(rows[k]);
    }
    let mut s = rows[k] + spare / (reached[k + 1] - reached[k]) * (rows[k + 1] - rows[k]);
    for _ in 0..20 {
        let step = (driving_time(speed, rows[k], s) - spare) * v(s);
        s = (s - step).clamp(rows[k], rows[k + 1]);
        if step.abs() < 1e-12 {
            break;
        }
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pace_over_distance_is_its_own_derivative() {
        let trajectory = Hermite::new(vec![[0.0, 0.5], [2.0, 1.5], [5.0, 0.8]]).expect("rows");
        let pace = SpeedSchedule::over_distance(trajectory.clone());
        let h = 1e-4;
        for t in [0.5, 1.2, 2.5, 4.0, 9.0] {
            let [s, v, a] = pace.at(t);
            assert!((trajectory.at(s)[0] - v).abs() < 1e-9);
            assert!((pace.when(s).expect("it comes there") - t).abs() < 1e-6);
            assert!(((pace.at(t + h)[0] - pace.at(t - h)[0]) / (2.0 * h) - v).abs() < 1e-5, "speed at {t}");
            assert!(
                ((pace.at(t + h)[1] - pace.at(t - h)[1]) / (2.0 * h) - a).abs() < 1e-4,
                "acceleration at {t}"
            );
        }
    }

    #[test]
    fn it_is_known_when_a_distance_is_behind() {
        let pace =
            SpeedSchedule::over_time(Hermite::new(vec![[0.0, 0.5], [4.0, 1.5], [6.0, 0.0]]).expect("rows"));
        for t in [0.3, 3.0, 5.5] {
            assert!((pace.when(pace.at(t)[0]).expect("it comes there") - t).abs() < 1e-9, "{t}");
        }
        assert_eq!(pace.when(10.0), None, "it stands from 6 s on");
    }

    #[test]
    fn standing_still_is_not_possible() {
        let pace = SpeedSchedule::over_distance(Hermite::new(vec![[0.0, 0.0]]).expect("rows"));
        assert_eq!(pace.at(10.0)[1], SLOWEST);
    }
}
