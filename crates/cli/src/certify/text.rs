//! A certificate for people.

use super::CertifyReport;
use crate::print::say;
use std::path::PathBuf;
use studies::certify::beyond::{Beyond, PERIODS, StabilityChart};
use studies::certify::chain::{EdgeGain, GainPoint, LENGTHS};
use studies::certify::{
    Certificate, Constants, Discretisation, Infeasible, LongestPeriod, NotLinear, Premise, Statement,
    StatementFinding, StatementOutcome,
};
use vocabulary::{HeadingReference, Word, math};

/// Edges that are listed statement by statement; the others have a line each.
const IN_FULL: usize = 2;
/// Edges that have a line.
const MOST_EDGES: usize = 12;

pub(super) fn tell(report: &CertifyReport<'_>, written: &[PathBuf]) {
    say(&format!("{}\n{}", report.scene.title, studies::caption(report.scene)));
    for certificate in report.certificates.iter().take(IN_FULL) {
        edge(report, certificate);
    }
    others(report);
    suspended(report);
    if report.scene.followers().any(|(_, follow)| follow.law.heading == HeadingReference::Path) {
        say(
            "\nheading = \"path\": stated of φ = ψ + θᵢ in place of ψ, so dωᵢ/dt drops out of gᵥVᵢ and d²θ̄/dt² comes in; that θ̄ itself \
             stays near θᵢ is measured only",
        );
    }
    if let Some(beyond) = &report.beyond {
        say("\nBeyond the paper");
        sensitivities(report, beyond);
        reach(report, beyond);
        if let Some(chart) = &beyond.chart {
            stability(chart);
        }
        chain(report, beyond);
    }
    say(&format!("\ncertified in {:.2} s", report.wall));
    for path in written {
        say(&format!("{}", path.display()));
    }
}

fn edge(report: &CertifyReport<'_>, certificate: &Certificate) {
    let [from, to] = certificate.span;
    say(&format!("\n{}, {from:.2} to {to:.2} s", report.pair(certificate)));
    if certificate.custom {
        say("  the paper's statements are about its own laws; of any law holds what was measured:");
        say(&format!("  {}", certificate.measured.words()));
        if let Some(fault) = &certificate.fault {
            say(&format!("  THE LAW BREAKS OFF: {}", studies::law_fault_words(report.scene, fault)));
            say("  from then on its follower brakes");
        }
        return;
    }
    for finding in &certificate.findings {
        statement(finding);
    }
    let witness = &certificate.witness;
    if let Some(last) = witness.rows().last() {
        let [effect, margin, initial, p, v, w] =
            [last.effect, last.margin, witness.initial, last.p, last.v, last.w].map(short);
        say(&format!(
            "  at the end     ‖gᵥVᵢ‖ {effect}, margin of β {margin}, ζ_b {initial}, P {p}, V {v}, W {w}"
        ));
    }
    let error = |e: [f64; 2]| format!("{} mm {}°", short(1e3 * e[0]), short(e[1].to_degrees()));
    let smoothing = certificate
        .smoothing
        .map_or_else(String::new, |e| format!("; tanh in place of sign alone leaves {}", error(e)));
    say(&format!("  error          {}{smoothing}", error(certificate.final_error)));
    if let Some(constants) = &certificate.constants {
        let met = certificate
            .finding(Statement::UltimateBound)
            .is_some_and(|finding| finding.outcome() != StatementOutcome::PremiseNotMet);
        numbers(constants, report.bound, met);
    }
}

/// A line for every edge that is not listed statement by statement.
fn others(report: &CertifyReport<'_>) {
    let rest = || report.certificates.iter().skip(IN_FULL);
    if rest().next().is_none() {
        return;
    }
    let heads = Statement::WORDS.iter().map(|(_, statement, _)| format!("  {:>13}", statement.source()));
    let head: String = heads.collect();
    say(&format!("\n{:40}{head}", "the others, in short"));
    for certificate in rest().take(MOST_EDGES) {
        let cells = certificate.findings.iter().map(|f| format!("  {:>13}", cell(f)));
        let cells = cells.collect::<Vec<_>>().concat();
        let [from, to] = certificate.span;
        let name = format!("{} {from:.1}–{to:.1} s", clip(&report.pair(certificate), 26));
        say(&format!("{name:40}{cells}"));
    }
    let more = rest().count().saturating_sub(MOST_EDGES);
    if more > 0 {
        say(&format!("… and {more} more; all of them with --json or -o DIR"));
    }
    say(
        "✓ holds, ✗ violated from this time on, – premise not met; in brackets whether the inequality holds numerically (✓) or not (✗)",
    );
}

/// What acted in place of laws: how often, on which edges and from when on, and what then holds.
fn suspended(report: &CertifyReport<'_>) {
    let filter = |premise: &Premise| matches!(premise, Premise::Filtered(_));
    let stands = |premise: &Premise| matches!(premise, Premise::Standing(_));
    for (what, is, then) in [
        (
            "a safety filter moves commands",
            &filter as &dyn Fn(&Premise) -> bool,
            "then nothing is claimed of V, r and e (eqs 29-30, 44, 51-53); β and P, which are of the law's own command, and the \
             observer, which is fed what is applied, keep their statements (Lemma 4.1, eqs 28, 45-49); barriers hold wherever they \
             leave a command",
        ),
        (
            "the standing rule acts in place of the law",
            &stands,
            "then the same: followers track their places, or hold, as tests measure and no theorem says",
        ),
    ] {
        let mut lines = vec![];
        for certificate in &report.certificates {
            let finding = certificate.finding(Statement::TrackingDecrease);
            let Some(Premise::Filtered(spell) | Premise::Standing(spell)) =
                finding.and_then(|finding| finding.unmet.iter().find(|premise| is(premise)))
            else {
                continue;
            };
            let samples = certificate.witness.samples();
            let count = (spell.share * samples as f64).round();
            lines.push(format!(
                "  {:<28} {count} of {samples} samples, from {:.2} s, last at {:.2} s",
                report.edge(certificate.edge),
                spell.first,
                spell.last
            ));
        }
        if lines.is_empty() {
            continue;
        }
        say(&format!("\n{what}"));
        for line in lines.iter().take(MOST_EDGES) {
            say(line);
        }
        if let Some(more) = lines.len().checked_sub(MOST_EDGES).filter(|more| *more > 0) {
            say(&format!("  … and {more} more"));
        }
        say(&format!("  {then}"));
    }
}

fn cell(finding: &StatementFinding) -> String {
    match (finding.outcome(), finding.against, finding.margin) {
        (StatementOutcome::Holds, ..) => "✓".to_owned(),
        (StatementOutcome::Violated(at), ..) => format!("✗ {at:.2} s"),
        (StatementOutcome::PremiseNotMet, Some(spell), _) => format!("– (✗ {:.2} s)", spell.first),
        (StatementOutcome::PremiseNotMet, None, Some(_)) => "– (✓)".to_owned(),
        (StatementOutcome::PremiseNotMet, None, None) => "–".to_owned(),
    }
}

fn statement(finding: &StatementFinding) {
    let margin =
        finding.margin.map_or_else(String::new, |margin| format!(", least margin {}", short(margin)));
    let when = finding.against.map_or_else(String::new, |spell| {
        if spell.throughout {
            "throughout".to_owned()
        } else if spell.first == spell.last {
            format!("at {:.2} s", spell.first)
        } else {
            format!("from {:.2} to {:.2} s", spell.first, spell.last)
        }
    });
    let outcome = match finding.outcome() {
        StatementOutcome::Holds => format!("holds{margin}"),
        StatementOutcome::Violated(_) => format!("violated {when}{margin}"),
        StatementOutcome::PremiseNotMet => "premise not met".to_owned(),
    };
    say(&format!("  {:<14} {:<32} {outcome}", finding.statement.source(), finding.statement.symbols()));
    if finding.outcome() == StatementOutcome::PremiseNotMet {
        let reasons: Vec<String> = finding.unmet.iter().map(studies::certify::Premise::words).collect();
        for line in wrapped(&reasons, 84) {
            say(&format!("{:51}{line}", ""));
        }
        match (finding.margin, when.is_empty()) {
            (None, _) => {}
            (Some(_), true) => say(&format!("{:51}the inequality nevertheless holds numerically", "")),
            (Some(_), false) => say(&format!("{:51}numerically the inequality is violated {when}", "")),
        }
    }
}

/// Words joined by semicolons, in lines.
fn wrapped(words: &[String], width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for (k, word) in words.iter().enumerate() {
        let word = if k + 1 < words.len() { format!("{word};") } else { word.clone() };
        match lines.last_mut() {
            Some(line) if line.chars().count() + word.chars().count() < width => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

fn numbers(c: &Constants, bound: Option<f64>, met: bool) {
    let [s_s, s_v, norm, least, rho, s_1] =
        [c.sigma_s, c.sigma_v, c.norm, c.least, c.rho, c.sigma_1].map(short);
    let [l1, mu, mu_1, mu_2, c3] = [c.l1, c.mu, c.mu_1, c.mu_2, c.c3].map(short);
    say(&format!(
        "  constants      σ_s {s_s}, σ_v {s_v}, ‖P₀‖ {norm}, λ_min {least}, ρ {rho}, σ₁ {s_1}, L₁ {l1}, μ {mu}, \
         μ₁ {mu_1}, μ₂ {mu_2}, c₃ {c3}"
    ));
    let [epsilon, epsilon_1, time] = [c.epsilon, c.epsilon_1, c.t_epsilon].map(short);
    let [filtered, error, delta] = [c.filtered, c.error, c.delta_0].map(short);
    let unmet = if met { "" } else { ", if the premises were met" };
    say(&format!(
        "  for ε = {epsilon} s  ε₁ {epsilon_1} s, T_ε {time} s; in the end ‖r‖ ≤ {filtered}, ‖e‖ ≤ {error}, δ₀ {delta}{unmet}"
    ));
    if let Some(bound) = bound {
        say(&format!(
            "                 ‖e‖ ≤ {} in the end {} promised for ε up to {} s",
            short(bound),
            if met { "is" } else { "would be" },
            short(c.epsilon_for(bound))
        ));
    }
}

fn sensitivities(report: &CertifyReport<'_>, beyond: &Beyond) {
    let found = match &beyond.sensitivities {
        Ok(found) => found,
        Err(why) => return say(&format!("  sensitivity of the settled error: {why}")),
    };
    say("  sensitivity of the settled error (last fifth of the run): % more for 1 % more gain on all edges");
    let edges = report.fleet.edges.len().min(MOST_EDGES);
    let heads = (0..edges).map(|e| format!("  {:>21}", clip(report.follower(e), 21)));
    let head = heads.collect::<Vec<_>>().concat();
    say(&format!("    {:14}{head}", ""));
    let error = |e: &[f64; 2]| format!("  {:>9} mm {:>8}°", short(1e3 * e[0]), short(e[1].to_degrees()));
    let settled: String = found.settled.iter().take(edges).map(error).collect();
    say(&format!("    {:14}{settled}", "settled error"));
    for gain in &found.gains {
        let cell = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:+.2}"));
        let both = |e: &[Option<f64>; 2]| format!("  {:>12} {:>8}", cell(e[0]), cell(e[1]));
        let row: String = gain.edges.iter().take(edges).map(both).collect();
        say(&format!("    {:14}{row}", gain.gain.symbol()));
    }
}

fn reach(report: &CertifyReport<'_>, beyond: &Beyond) {
    say("  set points that can be held while leaders drive their paths, limits on speed and turning kept");
    for reach in beyond.reach.iter().take(MOST_EDGES) {
        let [distance, bearing] = reach.set_point;
        let degrees = bearing.to_degrees();
        let near = reach.rays.iter().min_by(|a, b| {
            let off = |ray: &studies::certify::reach::ReachRay| vocabulary::wrap(ray.bearing - bearing).abs();
            off(a).total_cmp(&off(b))
        });
        let along = near.map_or_else(String::new, |ray| match ray.end {
            None => format!("{degrees:.0}°: to {:.1} m and beyond", ray.distance),
            Some(why) => format!("{degrees:.0}°: to {:.2} m, then {}", ray.distance, reason(why)),
        });
        let own = reach
            .refused
            .map_or_else(|| "can be held".to_owned(), |why| format!("CANNOT be held: {}", reason(why)));
        say(&format!("    {:<28} {distance:.2} m at {degrees:.0}° {own}; {along}", report.edge(reach.edge)));
    }
    if studies::certify::reach::moving(report.scene) {
        say("    set points of this scene move; these are the ones at the start");
    }
}

pub(super) fn reason(why: Infeasible) -> &'static str {
    match why {
        Infeasible::TooClose => "nearer than the law allows",
        Infeasible::TooSlow => "slower than it can drive",
        Infeasible::TooFast => "faster than it can drive",
        Infeasible::TooTight => "tighter than it can turn",
        Infeasible::TooHard => "harder than it can speed up or brake",
    }
}

fn stability(chart: &StabilityChart) {
    let at = chart.channel;
    say(&format!(
        "  sampled stability of {}, linear about its set point, at ε = {} s and {} ms",
        chart.follower,
        short(chart.epsilon),
        short(1e3 * chart.period)
    ));
    for how in Discretisation::ALL {
        let growth = at.growth(how, chart.epsilon, chart.period);
        let stable = if growth < 1.0 { "stable" } else { "UNSTABLE" };
        let longest = match at.longest_period(how, chart.epsilon, PERIODS) {
            LongestPeriod::At(period) => format!("up to {} ms", short(1e3 * period)),
            LongestPeriod::Below => "at none from 0.1 ms on".to_owned(),
            LongestPeriod::Beyond => "up to 1 s and beyond".to_owned(),
        };
        let rate = at.reported_rate(how, chart.epsilon, chart.period);
        let rate = rate.map_or("–".to_owned(), |share| format!("{:.1} %", 100.0 * share));
        say(&format!(
            "    {:<30} {stable:<9} {:>9} per period, stable {longest}; reports {rate} of a constant rate",
            how.words(),
            if growth < 10.0 { format!("×{growth:.3}") } else { format!("×{growth:.0}") }
        ));
    }
}

fn chain(report: &CertifyReport<'_>, beyond: &Beyond) {
    say(
        "  chains: distance error per deviation of the lead robot's speed, largest over frequency (linear, no limits)",
    );
    for gain in beyond.chain.iter().take(MOST_EDGES) {
        let name = report.edge(gain.edge);
        if let Some(why) = gain.missing {
            let why = match why {
                NotLinear::SeveralLeaders => "its follower has several leaders",
                NotLinear::CustomLaw => "a custom law: `echelon laws test` linearises one",
                NotLinear::Sign => "the sign has no slope: inside β nothing is passed on",
                NotLinear::NoSteadyMotion => "no steady motion of its leader is known to linearise about",
            };
            say(&format!("    {name:<28} {why}"));
            continue;
        }
        let (Some(own), Some(lead), Some(growth)) =
            (gain.peak(|p| p.own_leader), gain.peak(|p| p.lead), gain.peak(|p| p.growth))
        else {
            continue;
        };
        let followers = if gain.depth == 1 { "follower" } else { "followers" };
        say(&format!(
            "    {name:<28} {} mm per cm/s of its leader at {} rad/s; {} mm per cm/s of the lead, {} {followers} on",
            short(10.0 * own.0),
            short(own.1),
            short(10.0 * lead.0),
            gain.depth
        ));
        let slow = near(gain, SLOW);
        let lengths: Vec<String> = LENGTHS
            .iter()
            .enumerate()
            .filter_map(|(k, n)| Some(format!("{n}: {}", millimetres(10.0 * slow?.lengths[k]))))
            .collect();
        say(&format!(
            "    {:<28} in chains of its like, per cm/s at {SLOW} rad/s, error of follower {}",
            "",
            lengths.join(", ")
        ));
        say(&format!(
            "    {:<28} from follower to follower at most ×{}, at {} rad/s",
            "",
            short(growth.0),
            short(growth.1)
        ));
        let turns = TURNS
            .map(|at| format!("×{} at {at} rad/s", near(gain, at).map_or("–".to_owned(), |p| short(p.turn))));
        say(&format!("    {:<28} a turn of the leader is passed on {}", "", turns.join(", ")));
    }
}

/// Frequencies at which it is told how a turn is passed on, rad/s.
const TURNS: [f64; 3] = [0.2, 0.5, 2.0];

/// The gains next to a frequency in rad/s.
fn near(gain: &EdgeGain, frequency: f64) -> Option<&GainPoint> {
    gain.curve.iter().min_by(|a, b| {
        let off = |p: &GainPoint| math::ln(p.frequency / frequency).abs();
        off(a).total_cmp(&off(b))
    })
}

/// A frequency at which formations are led, rad/s.
const SLOW: f64 = 0.2;

/// What is beyond a metre is beyond the limits that are left out here, too.
fn millimetres(value: f64) -> String {
    if value < 1e3 { format!("{} mm", short(value)) } else { "over 1 m".to_owned() }
}

fn clip(text: &str, most: usize) -> String {
    text.chars().take(most).collect()
}

/// Three significant digits.
pub(super) fn short(value: f64) -> String {
    if !value.is_finite() {
        return "∞".to_owned();
    }
    let size = value.abs();
    // What is left of a zero by rounding.
    if size < 1e-12 {
        return "0".to_owned();
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{value:.2e}");
    }
    let digits = (2 - math::log10(size).floor() as i32).max(0) as usize;
    format!("{value:.digits$}")
}
