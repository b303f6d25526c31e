//! What a run showed, held against what its scene expects.

use recording::{EdgeMetrics, Metrics};
use scene::Expect;

/// One expectation and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The key in the scene's `[expect]`.
    pub key: &'static str,
    /// What was wanted, with unit.
    pub wanted: String,
    /// What was found, with unit, and on which edge or between which robots.
    pub found: String,
    /// Whether it was met.
    pub met: bool,
}

/// Every expectation of a scene, in the order of its keys.
pub fn verdict(expect: &Expect, metrics: &Metrics, completed: bool) -> Vec<Finding> {
    let mut findings = Findings { metrics, list: Vec::new() };
    if expect.completed {
        let found = format!("{:.2} s", metrics.duration);
        findings.add("completed", "the whole run".into(), found, completed);
    }
    if expect.no_contact {
        findings.clearance("no_contact", "> 0 m".into(), |clearance| clearance > 0.0);
    }
    if let Some(least) = expect.clearance_min {
        findings.clearance("clearance_min", format!("≥ {least} m"), |clearance| clearance >= least);
    }
    let channels = [
        ("final_distance_error", 0, expect.final_distance_error),
        ("final_bearing_error", 1, expect.final_bearing_error),
    ];
    for (key, channel, most) in channels {
        if let Some(most) = most {
            findings.worst(key, channel, most, |edge| edge.final_error);
        }
    }
    if let Some(latest) = expect.settling_time {
        findings.settling(latest);
    }
    if let Some(most) = expect.error_peak_at_most {
        for (channel, most) in most.into_iter().enumerate() {
            findings.worst("error_peak_at_most", channel, most, |edge| edge.peak_error);
        }
    }
    if let Some(most) = expect.rate_peak_at_most {
        for (channel, most) in most.into_iter().enumerate() {
            findings.worst_rate("rate_peak_at_most", channel, "≤", most, |found| found <= most);
        }
    }
    if let Some(least) = expect.rate_peak_at_least {
        for (channel, least) in least.into_iter().enumerate() {
            findings.worst_rate("rate_peak_at_least", channel, "≥", least, |found| found >= least);
        }
    }
    if let Some(range) = expect.speed_within {
        findings.speeds(range, expect.settling_time.is_some());
    }
    findings.list
}

struct Findings<'a> {
    metrics: &'a Metrics,
    list: Vec<Finding>,
}

const ERROR_UNITS: [&str; 2] = ["m", "rad"];
const RATE_UNITS: [&str; 2] = ["m/s", "rad/s"];

impl Findings<'_> {
    fn add(&mut self, key: &'static str, wanted: String, found: String, met: bool) {
        self.list.push(Finding { key, wanted, found, met });
    }

    fn clearance(&mut self, key: &'static str, wanted: String, met: impl Fn(f64) -> bool) {
        let (Some(found), Some(time), Some([a, b])) =
            (self.metrics.clearance_min, self.metrics.clearance_min_time, &self.metrics.clearance_min_robots)
        else {
            return self.add(key, wanted, "one robot only".into(), true);
        };
        let text = format!("{found:.4} m between `{a}` and `{b}` at {time:.2} s");
        self.add(key, wanted, text, met(found));
    }

    /// The edge whose `value` in `channel` is largest in size; a value that is not a number is the worst.
    fn largest(
        &self,
        channel: usize,
        value: impl Fn(&EdgeMetrics) -> [f64; 2],
    ) -> Option<(&EdgeMetrics, f64)> {
        let sized = self.metrics.edges.iter().map(|edge| (edge, value(edge)[channel].abs()));
        sized.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn worst(
        &mut self,
        key: &'static str,
        channel: usize,
        most: f64,
        value: impl Fn(&EdgeMetrics) -> [f64; 2],
    ) {
        let unit = ERROR_UNITS[channel];
        let wanted = format!("≤ {most} {unit}");
        let (found, met) = match self.largest(channel, value) {
            Some((edge, size)) => (format!("{size:.6} {unit} on {}", name(edge)), size <= most),
            None => ("no edges".into(), true),
        };
        self.add(key, wanted, found, met);
    }

    fn worst_rate(
        &mut self,
        key: &'static str,
        channel: usize,
        sign: &str,
        bound: f64,
        met: impl Fn(f64) -> bool,
    ) {
        let unit = RATE_UNITS[channel];
        let wanted = format!("{sign} {bound} {unit}");
        let (found, met) = match self.largest(channel, |edge| edge.peak_rates) {
            Some((edge, size)) => (format!("{size:.3} {unit} on {}", name(edge)), met(size)),
            None => ("no edges".into(), false),
        };
        self.add(key, wanted, found, met);
    }

    fn settling(&mut self, latest: f64) {
        let band = self.metrics.settling_band;
        let wanted = format!("≤ {latest} s into ±{} m, ±{} rad", band[0], band[1]);
        let unsettled = self.metrics.edges.iter().find(|edge| edge.settling_time.is_none());
        let slowest = self.metrics.edges.iter().filter_map(|edge| edge.settling_time.map(|t| (t, edge)));
        let (found, met) = match (unsettled, slowest.max_by(|a, b| a.0.total_cmp(&b.0))) {
            (Some(edge), _) => (format!("{} does not settle", name(edge)), false),
            (None, Some((time, edge))) => (format!("{time:.2} s on {}", name(edge)), time <= latest),
            (None, None) => ("no edges".into(), true),
        };
        self.add("settling_time", wanted, found, met);
    }

    fn speeds(&mut self, [slowest, fastest]: [f64; 2], settled_only: bool) {
        let wanted = format!("{slowest} to {fastest} m/s");
        let mut worst: Option<(f64, String)> = None;
        for edge in &self.metrics.edges {
            let speeds = if settled_only { edge.settled_speeds } else { Some(edge.speeds) };
            let Some([low, high]) = speeds else { continue };
            let outside = (slowest - low).max(high - fastest);
            if worst.as_ref().is_none_or(|(most, _)| outside > *most) {
                worst = Some((outside, format!("{low:.3} to {high:.3} m/s for `{}`", edge.follower)));
            }
        }
        let (outside, found) = worst.unwrap_or((f64::INFINITY, "no settled follower".into()));
        self.add("speed_within", wanted, found, outside <= 0.0);
    }
}

fn name(edge: &EdgeMetrics) -> String {
    format!("`{}` → `{}`", edge.leader, edge.follower)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn metrics() -> Metrics {
        let edge = EdgeMetrics {
            leader: "ann".into(),
            follower: "bob".into(),
            final_error: [-0.03, 0.001],
            settling_time: Some(2.0),
            peak_rates: [40.0, 3.0],
            speeds: [0.1, 1.6],
            settled_speeds: Some([0.9, 1.1]),
            ..EdgeMetrics::default()
        };
        Metrics {
            duration: 15.0,
            edges: vec![edge],
            clearance_min: Some(0.4),
            clearance_min_time: Some(1.0),
            clearance_min_robots: Some(["ann".into(), "bob".into()]),
            settling_band: [0.05, 0.05],
        }
    }

    fn met(expect: &Expect, metrics: &Metrics, key: &str) -> Vec<bool> {
        verdict(expect, metrics, true).iter().filter(|f| f.key == key).map(|f| f.met).collect()
    }

    #[test]
    fn each_expectation_can_be_met_and_missed() {
        let cases: [(&str, Expect, Expect); 6] = [
            (
                "final_distance_error",
                Expect { final_distance_error: Some(0.03), ..Expect::default() },
                Expect { final_distance_error: Some(0.029), ..Expect::default() },
            ),
            (
                "settling_time",
                Expect { settling_time: Some(2.0), ..Expect::default() },
                Expect { settling_time: Some(1.9), ..Expect::default() },
            ),
            (
                "clearance_min",
                Expect { clearance_min: Some(0.4), ..Expect::default() },
                Expect { clearance_min: Some(0.41), ..Expect::default() },
            ),
            (
                "rate_peak_at_least",
                Expect { rate_peak_at_least: Some([40.0, 3.0]), ..Expect::default() },
                Expect { rate_peak_at_least: Some([41.0, 4.0]), ..Expect::default() },
            ),
            (
                "rate_peak_at_most",
                Expect { rate_peak_at_most: Some([40.0, 3.0]), ..Expect::default() },
                Expect { rate_peak_at_most: Some([39.0, 2.0]), ..Expect::default() },
            ),
            (
                "speed_within",
                Expect { speed_within: Some([0.1, 1.6]), ..Expect::default() },
                Expect { speed_within: Some([0.2, 1.6]), ..Expect::default() },
            ),
        ];
        for (key, good, bad) in cases {
            assert!(met(&good, &metrics(), key).iter().all(|m| *m), "{key} should be met");
            let missed = met(&bad, &metrics(), key);
            assert!(!missed.is_empty() && missed.iter().all(|m| !m), "{key} should be missed");
        }
    }

    #[test]
    fn speeds_after_settling_are_those_that_count_when_a_settling_time_is_asked() {
        let expect = Expect { speed_within: Some([0.8, 1.2]), settling_time: Some(3.0), ..Expect::default() };
        assert_eq!(met(&expect, &metrics(), "speed_within"), [true]);
    }

    #[test]
    fn contact_and_an_edge_that_never_settles_are_failures_that_name_it() {
        let mut metrics = metrics();
        metrics.clearance_min = Some(0.0);
        metrics.edges[0].settling_time = None;
        let expect = Expect { no_contact: true, settling_time: Some(9.0), ..Expect::default() };
        let findings = verdict(&expect, &metrics, false);
        assert_eq!(findings.iter().filter(|f| !f.met).count(), 3);
        assert!(findings.iter().any(|f| f.found.contains("bob` does not settle")), "{findings:?}");
    }
}
