//! What a run showed, held against what its scene expects.

use crate::law_fault::law_fault_words;
use metrics::{
    EdgeMetrics, EventSummary, JudgedExpectation, LawFaultMetrics, Metrics, STANDING_AFTER, StandingMetrics,
};
use scene::{Expect, OnContact, Scene};
use simulation::{NotFinite, short};
use vocabulary::{EventKind, Word};

/// What every scene expects, and was not met.
pub(crate) fn not_finite(fault: &NotFinite) -> JudgedExpectation {
    let wanted = "every number finite".to_owned();
    JudgedExpectation { key: "finite", wanted, found: fault.to_string(), met: Some(false) }
}

/// What every custom law is asked for.
fn law_fault(scene: &Scene, fault: &LawFaultMetrics) -> JudgedExpectation {
    JudgedExpectation {
        key: "law",
        wanted: "a command at every sample".to_owned(),
        found: law_fault_words(scene, fault),
        met: Some(false),
    }
}

/// Everything that a scene asks of its run, in the order of its keys.
pub fn verdict(scene: &Scene, metrics: &Metrics, completed: bool) -> Vec<JudgedExpectation> {
    // Where the scene ends a run at a contact, that is its end.
    let stopped = scene.physics.on_contact == OnContact::Stop && metrics.contacts > 0;
    let planned = scene.events.len();
    let mut findings: Vec<_> = metrics.law_faults.iter().map(|fault| law_fault(scene, fault)).collect();
    findings.extend(expectations(&scene.expect, planned, metrics, completed || stopped));
    if scene.physics.on_contact == OnContact::Fail && !scene.expect.no_contact {
        let mut more = ExpectationJudge { metrics, list: Vec::new() };
        more.contacts("on_contact", "none, else the run fails".into(), |count| count == 0);
        findings.extend(more.list);
    }
    findings
}

fn expectations(
    expect: &Expect,
    planned: usize,
    metrics: &Metrics,
    completed: bool,
) -> Vec<JudgedExpectation> {
    let mut findings = ExpectationJudge { metrics, list: Vec::new() };
    if expect.completed {
        let found = format!("{:.2} s", metrics.duration);
        findings.add("completed", "the whole run".into(), found, completed);
    }
    if expect.no_contact {
        findings.contacts("no_contact", "none".into(), |count| count == 0);
    }
    if let Some(count) = expect.contacts_exactly {
        findings.contacts("contacts_exactly", count.to_string(), |found| found == count as usize);
    }
    if let Some([least, most]) = expect.contact_impulse_within {
        let found = metrics.contact_impulse_max;
        let (wanted, met) = (format!("{least} to {most} N s"), (least..=most).contains(&found));
        findings.add("contact_impulse_within", wanted, format!("{found:.3} N s"), met);
    }
    if expect.all_able {
        findings.able();
    }
    if let Some(most) = expect.lift_at_most {
        findings.lift(most);
    }
    if let Some(least) = expect.clearance_min {
        findings.clearance(least);
    }
    if let Some(most) = expect.final_distance_error {
        findings.worst("final_distance_error", 0, most, |edge| edge.final_error);
    }
    if let Some(most) = expect.final_bearing_error {
        findings.worst("final_bearing_error", 1, most, |edge| edge.final_error);
    }
    if let Some(latest) = expect.settling_time {
        findings.settling(latest);
    }
    for (channel, most) in expect.error_peak_at_most.into_iter().flatten().enumerate() {
        findings.worst("error_peak_at_most", channel, most, |edge| edge.peak_error);
    }
    for (channel, most) in expect.settled_error_at_most.into_iter().flatten().enumerate() {
        findings.late("settled_error_at_most", channel, most, expect, |edge| edge.late_peak_error);
    }
    for (channel, most) in expect.settled_rms_at_most.into_iter().flatten().enumerate() {
        findings.late("settled_rms_at_most", channel, most, expect, |edge| edge.late_rms_error);
    }
    if let Some(most) = expect.standing_turn_rate_at_most {
        findings.standing("standing_turn_rate_at_most", most, "rad/s", |found| found.turn_rate);
    }
    if let Some(most) = expect.standing_error_at_most {
        findings.standing("standing_error_at_most", most, "m", |found| found.error);
    }
    if let Some(latest) = expect.wide_again_by {
        findings.wide_again(latest);
    }
    if let Some(least) = expect.in_view_at_least {
        findings.in_view(least);
    }
    for (channel, most) in expect.rate_peak_at_most.into_iter().flatten().enumerate() {
        findings.worst_rate("rate_peak_at_most", channel, "≤", most, |found| found <= most);
    }
    for (channel, least) in expect.rate_peak_at_least.into_iter().flatten().enumerate() {
        findings.worst_rate("rate_peak_at_least", channel, "≥", least, |found| found >= least);
    }
    if let Some(most) = expect.limited_at_most {
        findings.limited(most);
    }
    if expect.no_event_refused {
        findings.refused(planned);
    }
    if expect.nobody_left_behind {
        findings.left_behind();
    }
    if expect.arrived {
        findings.arrived();
    }
    if let Some(range) = expect.speed_within {
        findings.speeds(range, expect.settling_time);
    }
    findings.list
}

/// Robots that a finding names.
const TOLD: usize = 4;

struct ExpectationJudge<'a> {
    metrics: &'a Metrics,
    list: Vec<JudgedExpectation>,
}

const ERROR_UNITS: [&str; 2] = ["m", "rad"];
const RATE_UNITS: [&str; 2] = ["m/s", "rad/s"];

impl<'a> ExpectationJudge<'a> {
    fn add(&mut self, key: &'static str, wanted: String, found: String, met: bool) {
        self.list.push(JudgedExpectation { key, wanted, found, met: Some(met) });
    }

    /// What the run does not show, since it ended before this time, s.
    fn add_unjudged(&mut self, key: &'static str, wanted: String, before: f64) {
        let found = format!("the run ended at {:.2} s, before {before} s", self.metrics.duration);
        self.list.push(JudgedExpectation { key, wanted, found, met: None });
    }

    fn contacts(&mut self, key: &'static str, wanted: String, met: impl Fn(usize) -> bool) {
        let count = self.metrics.contacts;
        let first = self.metrics.first_contacts.first().map_or_else(String::new, |contact| {
            let [a, b] = &contact.between;
            format!(", first `{a}` and `{b}` at {:.2} s", contact.begin)
        });
        self.add(key, wanted, format!("{count}{first}"), met(count));
    }

    fn able(&mut self) {
        let unable: Vec<_> = self.metrics.robots.iter().filter(|r| r.condition != "able").collect();
        let told = unable.iter().take(TOLD).map(|r| format!("`{}` is {}", r.robot, r.condition));
        let mut found = told.collect::<Vec<_>>().join(", ");
        if unable.is_empty() {
            "every robot".clone_into(&mut found);
        } else if unable.len() > TOLD {
            found = format!("{found} and {} more", unable.len() - TOLD);
        }
        self.add("all_able", "every robot able to drive".into(), found, unable.is_empty());
    }

    fn limited(&mut self, most: f64) {
        let percent = |share: f64| format!("{:.2} %", share * 100.0);
        let (found, met) = match self.followed().max_by(|a, b| a.limited.total_cmp(&b.limited)) {
            Some(edge) => (format!("{} on {}", percent(edge.limited), name(edge)), edge.limited <= most),
            None => self.nobody_follows(),
        };
        self.add("limited_at_most", format!("≤ {} of the samples", percent(most)), found, met);
    }

    /// Every one of the events `planned` took place, and none was refused.
    fn refused(&mut self, planned: usize) {
        let events = || self.metrics.events.iter();
        let refused = events().find(|event| !event.happened);
        let took_place = |index: &usize| events().any(|e| e.happened && e.event == Some(*index));
        let missing = (0..planned).find(|index| !took_place(index));
        let (found, met) = match (refused, missing) {
            (Some(event), _) => (format!("at {:.2} s {}", event.time, event.words), false),
            (None, Some(index)) => (format!("events.{index} had not taken place at the end"), false),
            (None, None) => (vocabulary::counted(planned as u64, "event"), true),
        };
        self.add("no_event_refused", "every event takes place".into(), found, met);
    }

    /// Nobody waits at the end, or stays where it is for good; said only of runs in which something happened.
    fn left_behind(&mut self) {
        let events = || self.metrics.events.iter().filter(|event| event.happened);
        if events().next().is_none() {
            return;
        }
        let mut last = std::collections::BTreeMap::new();
        for event in events() {
            last.insert(&event.robot, event);
        }
        let waits = |event: &&EventSummary| {
            [EventKind::Wait, EventKind::GiveUp].map(Word::word).contains(&event.kind)
        };
        let (found, met) = match last.into_values().find(waits) {
            Some(event) => (format!("at {:.2} s {}", event.time, event.words), false),
            None => ("nobody".to_owned(), true),
        };
        self.add("nobody_left_behind", "nobody".into(), found, met);
    }

    /// Every formation with a plan is at its end, and has not stopped on the way.
    fn arrived(&mut self) {
        let stops = |robot: &str| {
            let kinds =
                [EventKind::Halt, EventKind::GiveUp, EventKind::Reroute, EventKind::Arrive].map(Word::word);
            let own = |event: &&EventSummary| event.happened && event.robot == robot;
            let last = self.metrics.events.iter().filter(own).rfind(|event| kinds.contains(&event.kind));
            last.is_some_and(|event| kinds[..2].contains(&event.kind))
        };
        let leads = self.metrics.robots.iter().filter(|robot| robot.plan.is_some_and(|plan| plan.leads));
        let away = leads.clone().find_map(|robot| {
            let left = robot.plan.map_or(0.0, |plan| plan.time_left);
            match (stops(&robot.robot), left > 0.0) {
                (true, _) => Some(format!("`{}` has stopped on its way", robot.robot)),
                (false, true) => Some(format!("`{}` has {left:.1} s to go", robot.robot)),
                _ => None,
            }
        });
        let (found, met) = match away {
            Some(away) => (away, false),
            None if leads.count() == 0 => ("no robot has goals".to_owned(), false),
            None => ("everybody".to_owned(), true),
        };
        self.add("arrived", "everybody".into(), found, met);
    }

    /// What is found where no edge is judged: fine where the scene has none, not where all have ended.
    fn nobody_follows(&self) -> (String, bool) {
        if self.metrics.edges.is_empty() {
            ("no edges".into(), true)
        } else {
            ("nobody follows at the end".into(), false)
        }
    }

    fn lift(&mut self, most: f64) {
        let highest = self.metrics.robots.iter().max_by(|a, b| a.lift_max.total_cmp(&b.lift_max));
        let (found, met) = match highest {
            Some(robot) => (format!("{:.4} m, `{}`", robot.lift_max, robot.robot), robot.lift_max <= most),
            None => ("no robots".into(), true),
        };
        self.add("lift_at_most", format!("≤ {most} m"), found, met);
    }

    fn clearance(&mut self, least: f64) {
        let (key, wanted) = ("clearance_min", format!("≥ {least} m"));
        let (Some(found), Some(time), Some([a, b])) =
            (self.metrics.clearance_min, self.metrics.clearance_min_time, &self.metrics.clearance_min_robots)
        else {
            return self.add(key, wanted, "one robot only".into(), true);
        };
        let text = format!("{found:.4} m between `{a}` and `{b}` at {time:.2} s");
        self.add(key, wanted, text, found >= least);
    }

    /// The edges whose followers follow at the end.
    fn followed(&self) -> impl Iterator<Item = &'a EdgeMetrics> + use<'a> {
        self.metrics.edges.iter().filter(|edge| edge.ended.is_none())
    }

    /// The edge whose `value` in `channel` is largest in size; a value that is not a number is the worst.
    fn largest(
        &self,
        channel: usize,
        value: impl Fn(&EdgeMetrics) -> [f64; 2],
    ) -> Option<(&'a EdgeMetrics, f64)> {
        let sized = self.followed().map(|edge| (edge, value(edge)[channel].abs()));
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
        let wanted = format!("≤ {} {unit}", short(most));
        let (found, met) = match self.largest(channel, value) {
            Some((edge, size)) => (format!("{size:.6} {unit} on {}", name(edge)), size <= most),
            None => self.nobody_follows(),
        };
        self.add(key, wanted, found, met);
    }

    /// As [`Self::worst`], of what is measured from a time on.
    fn late(
        &mut self,
        key: &'static str,
        channel: usize,
        most: f64,
        expect: &Expect,
        value: impl Fn(&EdgeMetrics) -> [f64; 2],
    ) {
        match expect.settled_after.filter(|after| self.metrics.duration < *after) {
            Some(after) => {
                self.add_unjudged(key, format!("≤ {} {}", short(most), ERROR_UNITS[channel]), after);
            }
            None => self.worst(key, channel, most, value),
        }
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
        let wanted = format!("{sign} {} {unit}", short(bound));
        let (found, met) = match self.largest(channel, |edge| edge.peak_rates) {
            Some((edge, size)) => (format!("{size:.3} {unit} on {}", name(edge)), met(size)),
            None => ("no edges".into(), false),
        };
        self.add(key, wanted, found, met);
    }

    fn standing(
        &mut self,
        key: &'static str,
        most: f64,
        unit: &str,
        value: impl Fn(&StandingMetrics) -> f64,
    ) {
        let stood = self.followed().filter_map(|edge| Some((edge, value(edge.standing.as_ref()?))));
        let (found, met) = match stood.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((edge, size)) => (format!("{size:.4} {unit} on {}", name(edge)), size <= most),
            None => (format!("no leader stands for {STANDING_AFTER} s"), false),
        };
        self.add(key, format!("≤ {} {unit}", short(most)), found, met);
    }

    fn wide_again(&mut self, latest: f64) {
        let (key, wanted) = ("wide_again_by", format!("≤ {latest} s"));
        let edges = self.metrics.edges.iter();
        let filed: Vec<_> = edges.filter_map(|edge| Some((edge, edge.narrowing.as_ref()?))).collect();
        let away = filed.iter().find(|(_, found)| found.end.is_none());
        if away.is_some() && self.metrics.duration < latest {
            return self.add_unjudged(key, wanted, latest);
        }
        let ends = filed.iter().filter_map(|(edge, found)| Some((edge, found.end?)));
        let (found, met) = match (away, ends.max_by(|a, b| a.1.total_cmp(&b.1))) {
            (Some((edge, _)), _) => (format!("{} is not at its set point", name(edge)), false),
            (None, Some((edge, end))) => (format!("{end:.2} s on {}", name(edge)), end <= latest),
            (None, None) => ("nobody files in".into(), false),
        };
        self.add(key, wanted, found, met);
    }

    fn in_view(&mut self, least: f64) {
        let measured = self.followed().filter_map(|edge| Some((edge, edge.measurements.as_ref()?.in_view)));
        let percent = |share: f64| format!("{:.2} %", share * 100.0);
        let (found, met) = match measured.min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((edge, share)) => (format!("{} on {}", percent(share), name(edge)), share >= least),
            None => ("no follower measures".into(), false),
        };
        self.add("in_view_at_least", format!("≥ {} of the measurements", percent(least)), found, met);
    }

    fn settling(&mut self, latest: f64) {
        let band = self.metrics.settling_band;
        let wanted = format!("≤ {latest} s into ±{} m, ±{} rad", short(band[0]), short(band[1]));
        let unsettled = self.followed().find(|edge| edge.settling_time.is_none());
        let slowest = self.followed().filter_map(|edge| edge.settling_time.map(|t| (t, edge)));
        if unsettled.is_some() && self.metrics.duration < latest {
            return self.add_unjudged("settling_time", wanted, latest);
        }
        let (found, met) = match (unsettled, slowest.max_by(|a, b| a.0.total_cmp(&b.0))) {
            (Some(edge), _) => (format!("{} does not settle", name(edge)), false),
            (None, Some((time, edge))) => (format!("{time:.2} s on {}", name(edge)), time <= latest),
            (None, None) => self.nobody_follows(),
        };
        self.add("settling_time", wanted, found, met);
    }

    fn speeds(&mut self, [slowest, fastest]: [f64; 2], settling: Option<f64>) {
        let wanted = format!("{slowest} to {fastest} m/s");
        let mut worst: Option<(f64, String)> = None;
        for edge in self.metrics.edges.iter().filter(|edge| edge.ended.is_none()) {
            let speeds = if settling.is_some() { edge.settled_speeds } else { Some(edge.speeds) };
            let Some([low, high]) = speeds else { continue };
            let outside = (slowest - low).max(high - fastest);
            if worst.as_ref().is_none_or(|(most, _)| outside > *most) {
                worst = Some((outside, format!("{low:.3} to {high:.3} m/s for `{}`", edge.follower)));
            }
        }
        if let Some(latest) = settling.filter(|latest| worst.is_none() && self.metrics.duration < *latest) {
            return self.add_unjudged("speed_within", wanted, latest);
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
    use metrics::{NarrowingMetrics, RobotMetrics};

    fn metrics() -> Metrics {
        let edge = EdgeMetrics {
            leader: "ann".into(),
            follower: "bob".into(),
            final_error: [-0.03, 0.001],
            late_peak_error: [0.02, 0.03],
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
            events: vec![],
            law_faults: vec![],
            certificates: vec![],
            contacts: 2,
            contact_impulse_max: 3.0,
            robots: vec![RobotMetrics {
                robot: "ann".into(),
                lift_max: 0.1,
                condition: "stuck".into(),
                ..RobotMetrics::default()
            }],
            first_contacts: vec![],
        }
    }

    fn met(expect: &Expect, metrics: &Metrics, key: &str) -> Vec<bool> {
        expectations(expect, 0, metrics, true).iter().filter(|f| f.key == key).filter_map(|f| f.met).collect()
    }

    #[test]
    fn followers_are_back_in_time_or_not_and_someone_has_to_have_filed_in() {
        let expect = Expect { wide_again_by: Some(10.0), ..Expect::default() };
        let with = |duration: f64, end: Option<Option<f64>>| {
            let mut metrics = Metrics { duration, ..metrics() };
            metrics.edges[0].narrowing = end.map(|end| NarrowingMetrics { largest: 1.0, begin: 2.0, end });
            expectations(&expect, 0, &metrics, true)
                .into_iter()
                .find(|f| f.key == "wide_again_by")
                .expect("judged")
        };
        for (end, met, words) in [
            (Some(Some(9.0)), true, "9.00 s on `ann` → `bob`"),
            (Some(Some(11.0)), false, "11.00 s"),
            (Some(None), false, "is not at its set point"),
            (None, false, "nobody files in"),
        ] {
            let found = with(15.0, end);
            assert_eq!(found.met, Some(met), "{found:?}");
            assert!(found.found.contains(words), "{found:?}");
        }
        assert_eq!(with(9.0, Some(None)).met, None);
    }

    #[test]
    fn each_expectation_can_be_met_and_missed() {
        let cases: [(&str, Expect, Expect); 10] = [
            (
                "contacts_exactly",
                Expect { contacts_exactly: Some(2), ..Expect::default() },
                Expect { contacts_exactly: Some(1), ..Expect::default() },
            ),
            (
                "contact_impulse_within",
                Expect { contact_impulse_within: Some([2.0, 4.0]), ..Expect::default() },
                Expect { contact_impulse_within: Some([3.5, 4.0]), ..Expect::default() },
            ),
            (
                "lift_at_most",
                Expect { lift_at_most: Some(0.1), ..Expect::default() },
                Expect { lift_at_most: Some(0.09), ..Expect::default() },
            ),
            (
                "settled_error_at_most",
                Expect { settled_error_at_most: Some([0.02, 0.03]), ..Expect::default() },
                Expect { settled_error_at_most: Some([0.01, 0.02]), ..Expect::default() },
            ),
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
    fn a_robot_that_cannot_drive_is_named() {
        let findings = expectations(&Expect { all_able: true, ..Expect::default() }, 0, &metrics(), true);
        assert!(findings.iter().any(|f| f.failed() && f.found.contains("`ann` is stuck")), "{findings:?}");
    }

    #[test]
    fn speeds_after_settling_are_those_that_count_when_a_settling_time_is_asked() {
        let expect = Expect { speed_within: Some([0.8, 1.2]), settling_time: Some(3.0), ..Expect::default() };
        assert_eq!(met(&expect, &metrics(), "speed_within"), [true]);
    }

    #[test]
    fn contact_and_an_edge_that_never_settles_are_failures_that_name_it() {
        let mut metrics = metrics();
        metrics.contacts = 1;
        metrics.edges[0].settling_time = None;
        let expect = Expect { no_contact: true, settling_time: Some(9.0), ..Expect::default() };
        let findings = expectations(&expect, 0, &metrics, false);
        assert_eq!(findings.iter().filter(|f| f.failed()).count(), 3);
        assert!(findings.iter().any(|f| f.found.contains("bob` does not settle")), "{findings:?}");
    }

    #[test]
    fn what_a_run_is_too_short_to_show_is_not_judged() {
        let expect = Expect {
            settled_after: Some(20.0),
            settled_error_at_most: Some([0.1, 0.1]),
            settled_rms_at_most: Some([0.1, 0.1]),
            settling_time: Some(16.0),
            speed_within: Some([0.9, 1.1]),
            ..Expect::default()
        };
        let mut metrics = metrics();
        metrics.edges[0].settling_time = None;
        metrics.edges[0].settled_speeds = None;
        let findings = expectations(&expect, 0, &metrics, true);
        let open: Vec<_> = findings.iter().filter(|f| f.met.is_none()).collect();
        assert_eq!(open.len(), 6, "{findings:?}");
        assert_eq!(open[0].found, "the run ended at 15.00 s, before 16 s");
        metrics.duration = 30.0;
        let findings = expectations(&expect, 0, &metrics, true);
        assert!(findings.iter().all(|f| f.met.is_some()), "{findings:?}");
    }
}
