//! What estimates from measurements have to show, on a pair of exact unicycles.

use super::*;
use vocabulary::{Pose, math, nearest_turn};

const T: f64 = 0.01;

/// A leader on a circle and a follower that drives on its own, both exact unicycles.
struct EstimatorPair {
    leader: Pose,
    follower: Pose,
    own: Own,
}

impl EstimatorPair {
    fn new() -> Self {
        Self {
            leader: Pose::new(0.0, 0.0, 0.3),
            follower: Pose::new(-1.5, -1.1, 0.2),
            own: Own { speed: 1.0, acceleration: 0.0, turn_rate: 0.25 },
        }
    }

    fn advance(&mut self, own: Own) {
        self.own = own;
        let go = |pose: &mut Pose, speed: f64, turn: f64| {
            let middle = pose.heading + 0.5 * turn * T;
            // The chord of an arc.
            let chord = speed * T * (1.0 - math::powi(turn * T, 2) / 24.0);
            *pose = Pose::new(
                pose.x + chord * math::cos(middle),
                pose.y + chord * math::sin(middle),
                wrap(pose.heading + turn * T),
            );
        };
        go(&mut self.leader, 1.0, 0.3);
        go(&mut self.follower, own.speed, own.turn_rate);
    }

    fn relative(&self) -> Relative {
        Relative::between(self.leader, self.follower)
    }
}

fn law(method: ObserverKind) -> TrackerParameters {
    TrackerParameters {
        method,
        observer: Observer { epsilon: [0.03; 2], alpha1: [2.0; 2], alpha2: [1.0; 2], distance_min: 0.1 },
        adaptive: false,
        disturbance: [1.0; 2],
        gate: 6.0,
        interval: 1.0 / 30.0,
        hold: 0.5,
    }
}

/// A cheap even noise, the same on every machine.
fn noise(k: u64) -> f64 {
    let mut z = k.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(0x1234_5678);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 12_f64.sqrt()
}

/// What one run of a tracker shows.
struct Shown {
    /// Largest error of ℓ, ψ and γ in the last third.
    worst: [f64; 3],
    /// Root mean square error of the rates in the last third.
    rates: [f64; 2],
    used: usize,
    rejected: usize,
}

/// 6 s at 100 Hz with measurements at 33 ms that arrive `late` periods after they were taken.
fn run(
    law: &TrackerParameters,
    deviation: [f64; 3],
    late: usize,
    mut look_at: impl FnMut(usize, &mut Measurement) -> bool,
) -> Shown {
    let (mut pair, mut tracker) = (EstimatorPair::new(), Tracker::default());
    let mut waiting: VecDeque<(usize, Measurement)> = VecDeque::new();
    let mut shown = Shown { worst: [0.0; 3], rates: [0.0; 2], used: 0, rejected: 0 };
    let mut counted = 0;
    for k in 0..600_usize {
        if k.is_multiple_of(3) {
            let mut relative = pair.relative();
            let n = |j: u64| noise(3 * k as u64 + j);
            relative.distance += deviation[0] * n(0);
            relative.bearing += deviation[1] * n(1);
            relative.view_angle += deviation[2] * n(2);
            let mut measurement = Measurement { stamp: k as f64 * T, relative, deviation };
            if look_at(k, &mut measurement) {
                waiting.push_back((k + late, measurement));
            }
        }
        while let Some((_, measurement)) = waiting.pop_front_if(|(due, _)| *due <= k) {
            match tracker.take(law, &measurement) {
                Outcome::Used => shown.used += 1,
                _ => shown.rejected += 1,
            }
        }
        if k >= 400 {
            let (truth, seen) = (pair.relative(), tracker.relative().expect("measured"));
            let off = innovation(&truth, &seen);
            for (worst, off) in shown.worst.iter_mut().zip(off) {
                *worst = worst.max(off.abs());
            }
            let before = truth;
            let mut ahead = EstimatorPair { ..pair };
            ahead.advance(pair.own);
            let after = ahead.relative();
            let rate = [
                (after.distance - before.distance) / T,
                (nearest_turn(after.bearing, before.bearing) - before.bearing) / T,
            ];
            let estimate = tracker.estimate(law);
            for (sum, (seen, true_rate)) in shown.rates.iter_mut().zip(estimate.rates.iter().zip(rate)) {
                *sum += math::powi(seen - true_rate, 2);
            }
            counted += 1;
        }
        let t = k as f64 * T;
        let own = Own { speed: 1.0, acceleration: 0.0, turn_rate: 0.3 + 0.2 * math::sin(1.3 * t) };
        pair.advance(own);
        tracker.advance(law, own, T);
    }
    shown.rates = shown.rates.map(|sum| (sum / f64::from(counted)).sqrt());
    shown
}

/// What a disturbance of 1 does to a rate at ε = 0.03 s: 2 ε δ.
const BIAS: f64 = 0.06;
const QUIET: [f64; 3] = [1e-5, 1e-5, 1e-5];

#[test]
fn exact_measurements_are_followed_and_latency_costs_next_to_nothing() {
    for method in [ObserverKind::HighGain, ObserverKind::Unscented] {
        for late in [0, 1, 3] {
            let shown = run(&law(method), QUIET, late, |_, _| true);
            assert!(
                shown.worst[0] < 4e-3 && shown.worst[1] < 3e-3 && shown.worst[2] < 3e-3,
                "{method:?} {late}: {:?}",
                shown.worst
            );
            // Rates are as old as the measurement; a disturbance of 1 changes them by as much as that is late.
            let most = BIAS + T * late as f64;
            assert!(shown.rates[0] < most && shown.rates[1] < most, "{method:?} {late}: {:?}", shown.rates);
            assert_eq!(shown.rejected, 0);
        }
    }
}

#[test]
fn a_third_of_the_measurements_may_be_missing() {
    for method in [ObserverKind::HighGain, ObserverKind::Unscented] {
        let shown = run(&law(method), QUIET, 3, |k, _| noise(k as u64 + 7_000) > -0.7);
        assert!(shown.worst[0] < 2e-2 && shown.worst[1] < 2e-2, "{method:?}: {:?}", shown.worst);
    }
}

/// One flipped heading in ten measurements: an observer that believed it would see 30 rad/s.
#[test]
fn outliers_are_not_believed() {
    for method in [ObserverKind::HighGain, ObserverKind::Unscented] {
        let shown = run(&law(method), [2e-3, 8e-3, 5e-4], 1, |k, measurement| {
            if k % 30 == 0 && k > 60 {
                measurement.relative.bearing = wrap(measurement.relative.bearing + 0.6);
            }
            true
        });
        assert_eq!(shown.rejected, 17, "{method:?}");
        assert!(shown.worst[1] < 0.05, "{method:?}: {:?}", shown.worst);
    }
}

#[test]
fn a_leader_that_is_truly_elsewhere_is_believed_at_the_third_measurement() {
    let law = law(ObserverKind::HighGain);
    let mut tracker = Tracker::default();
    let measurement = |stamp, distance| Measurement {
        stamp,
        relative: Relative { distance, bearing: -2.0, view_angle: -2.0 },
        deviation: [2e-3, 8e-3, 5e-4],
    };
    assert_eq!(tracker.take(&law, &measurement(0.0, 2.0)), Outcome::Used);
    let outcomes: Vec<_> = (1..4)
        .map(|k| {
            tracker.advance(&law, Own::default(), T);
            tracker.take(&law, &measurement(f64::from(k) * T, 5.0))
        })
        .collect();
    assert_eq!(outcomes, [Outcome::Rejected, Outcome::Rejected, Outcome::Used]);
    assert_eq!(tracker.relative().map(|r| r.distance), Some(5.0));
}

#[test]
fn noise_sets_the_time_constant() {
    let law = TrackerParameters { adaptive: true, ..law(ObserverKind::HighGain) };
    let worst = |deviation| run(&law, deviation, 1, |_, _| true).rates[1];
    let (quiet, loud) = (worst([2e-4, 8e-4, 1e-4]), worst([2e-3, 8e-3, 5e-4]));
    // Ten times the noise costs less than ten times the error, as ε grows with it.
    assert!(loud > quiet && loud < 6.0 * quiet, "{quiet} {loud}");
    let fixed = TrackerParameters {
        adaptive: false,
        observer: Observer { epsilon: [0.001; 2], ..law.observer },
        ..law
    };
    let paper = run(&fixed, [2e-3, 8e-3, 5e-4], 1, |_, _| true).rates[1];
    assert!(paper > 2.0 * loud, "{paper} {loud}");
}

/// The last measurement before the leader is hidden is bad, and says so: the prediction that follows must not run away.
#[test]
fn a_measurement_that_doubts_itself_moves_little() {
    let law = TrackerParameters { adaptive: true, ..law(ObserverKind::HighGain) };
    let sure = [1e-3, 1e-3, 1e-4];
    let doubtful = sure.map(|d| 5.0 * d);
    let rate = |deviation: [f64; 3]| {
        let mut tracker = Tracker::default();
        for k in 0..31 {
            let off = if k == 30 { 15e-3 } else { 0.0 };
            let relative = Relative { distance: 2.0 + off, bearing: -2.0, view_angle: -2.0 };
            let deviation = if k == 30 { deviation } else { sure };
            tracker.take(&law, &Measurement { stamp: f64::from(k) * T, relative, deviation });
            tracker.advance(&law, Own::default(), T);
        }
        tracker.estimate(&law).rates[0].abs()
    };
    let (sudden, doubted) = (rate(sure), rate(doubtful));
    assert!(sudden > 0.15 && doubted < 0.15 * sudden, "{sudden} {doubted}");
}

/// A leader that is out of sight for a second is still there: it is taken to go on as it went.
#[test]
fn a_hidden_leader_is_followed_by_how_it_went() {
    for method in [ObserverKind::HighGain, ObserverKind::Unscented] {
        let law = TrackerParameters { hold: 2.0, adaptive: true, ..law(method) };
        let shown = run(&law, QUIET, 1, |k, _| !(410..510).contains(&k));
        // A tenth of what it drives in that second.
        assert!(shown.worst[0] < 0.1 && shown.worst[1] < 0.02, "{method:?}: {:?}", shown.worst);
    }
}

#[test]
fn sight_is_lost_with_time_and_comes_back() {
    let law = law(ObserverKind::HighGain);
    let mut tracker = Tracker::default();
    assert_eq!((tracker.sight(&law), tracker.relative()), (TrackingState::Waiting, None));
    let measurement = |stamp| Measurement {
        stamp,
        relative: Relative { distance: 2.0, bearing: -2.0, view_angle: -2.0 },
        deviation: QUIET,
    };
    tracker.take(&law, &measurement(0.0));
    let mut seen = vec![];
    for k in 1..=80 {
        tracker.advance(&law, Own::default(), T);
        seen.push(tracker.sight(&law));
        assert!((tracker.age() - f64::from(k) * T).abs() < 1e-12);
    }
    assert_eq!(
        (seen[4], seen[20], seen[60]),
        (TrackingState::Tracking, TrackingState::Coasting, TrackingState::Lost)
    );
    tracker.take(&law, &measurement(0.8));
    assert_eq!(tracker.sight(&law), TrackingState::Tracking);
}

#[test]
fn no_measurement_breaks_it() {
    let odd = [0.0, -1.0, 1e9, f64::NAN, f64::INFINITY, 1e-9];
    for method in [ObserverKind::HighGain, ObserverKind::Unscented] {
        let law = law(method);
        let mut tracker = Tracker::default();
        for (k, (a, b)) in odd.iter().flat_map(|a| odd.iter().map(move |b| (*a, *b))).enumerate() {
            let relative = Relative { distance: a, bearing: b, view_angle: a };
            tracker
                .take(&law, &Measurement { stamp: k as f64 * T, relative, deviation: [b.abs(), 1e-3, 0.0] });
            tracker.advance(&law, Own { speed: 1.0, acceleration: 1.0, turn_rate: 3.0 }, T);
            if let Some(r) = tracker.relative() {
                assert!(r.distance.is_finite() && r.bearing.is_finite() && r.view_angle.is_finite(), "{r:?}");
            }
        }
    }
}

/// With much noise and a small ε rates run away between two measurements.
#[test]
fn rates_that_run_away_start_again() {
    let (law, pair) = (law(ObserverKind::HighGain), EstimatorPair::new());
    let measurement =
        Measurement { relative: pair.relative(), deviation: [0.01; 3], ..Measurement::default() };
    for rates in [[f64::INFINITY, 0.0], [0.0, f64::NAN]] {
        let mut estimator = HighGain::at(&measurement);
        estimator.estimate.rates = rates;
        estimator.predict(&law, pair.own, 0.03, false);
        let off = estimator.relative().distance - measurement.relative.distance;
        assert!(off.abs() < 0.01, "{rates:?}: {off} m");
        estimator.correct(&law, &measurement, 0.03);
        assert!(estimator.estimate.rates.iter().all(|rate| rate.abs() < 1.0), "{rates:?}");
    }
}
