//! Certificates against independent answers: SciPy's P0, and cases in which every statement's outcome is known.

use formation::Observer;
use formation::certificate::{BoundaryLayer, Premise, Statement, StatementOutcome};
use scene::{Override, Scene};
use simulation::{Simulation, build};
use std::path::Path;
use studies::certify::chain::gains;
use studies::certify::reach::{Reach, ReachRay, reach};
use studies::certify::{Certificate, ChannelSensitivity, Discretisation, Examiner};
use vocabulary::math;

/// Every row of `reference/lyapunov.csv`, which `reference/lyapunov.py` makes.
#[test]
fn p0_is_scipys() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/lyapunov.csv");
    let mut reader = csv::Reader::from_path(path).expect("a table");
    let mut rows = 0;
    for row in reader.records() {
        let row: Vec<f64> = row.expect("a row").iter().map(|cell| cell.parse().expect("a number")).collect();
        let observer = Observer {
            epsilon: [1.0; 2],
            alpha1: [row[0], row[1]],
            alpha2: [row[2], row[3]],
            distance_min: 0.1,
        };
        let layer = BoundaryLayer::of(&observer).expect("a stable observer");
        for i in 0..4 {
            for j in 0..4 {
                let (found, wanted) = (layer.matrix[(i, j)], row[4 + 4 * i + j]);
                assert!((found - wanted).abs() < 1e-9 * row[21], "{row:?}: P0[{i}, {j}] is {found}");
            }
        }
        assert!(
            (layer.least - row[20]).abs() < 1e-9 * row[21] && (layer.norm - row[21]).abs() < 1e-9 * row[21]
        );
        rows += 1;
    }
    assert!(rows >= 5);
}

/// A follower of a leader that drives straight on, 0.1 m off its place and as fast; as the theorems want it.
const IDEAL: &str = "\
schema = 1
title = \"ideal\"
time = { duration = 3.0, period = 0.002, mode = \"continuous\" }
law = { kind = \"robust-state\", switching = \"sign\" }
vehicle = { kind = \"unicycle\", speed_max = 100.0, turn_rate_max = 1000.0 }
[[robots]]
name = \"leader\"
pose = [0.0, 0.0, 0.0]
path = { kind = \"constant\", speed = 1.0 }
[[robots]]
name = \"follower\"
pose = [-1.5142, -1.4142, 0.0]
speed = 1.0
leader = \"leader\"
distance = 2.0
bearing = \"-135 deg\"
";

fn certificates(text: &str, set: &[&str]) -> Vec<Certificate> {
    let set: Vec<Override> = set.iter().map(|s| s.parse().expect("an override")).collect();
    let scene = Scene::parse(text, "ideal.toml", &set).expect("a scene").scene;
    let mut simulation = Simulation::new(build(&scene).expect("a run"));
    let mut examiner = Examiner::new(&scene, &simulation, true);
    while simulation.next_record().is_some() {
        examiner.push(&simulation);
    }
    examiner.finish(&simulation)
}

fn certificate(set: &[&str]) -> Certificate {
    certificates(IDEAL, set).remove(0)
}

fn outcome(certificate: &Certificate, statement: Statement) -> StatementOutcome {
    certificate.finding(statement).expect("a finding").outcome()
}

/// A word for a premise.
fn word(premise: &Premise) -> &'static str {
    match premise {
        Premise::FullState => "full-state",
        Premise::CustomLaw => "custom-law",
        Premise::NoObserver => "no-observer",
        Premise::SeveralLeaders => "several-leaders",
        Premise::Smoothed => "tanh",
        Premise::Chatter(_) => "chatter",
        Premise::Saturated(_) => "saturated",
        Premise::SpeedBound(_) => "speed-bound",
        Premise::LeaderNotSmooth { .. } => "leader-not-smooth",
        Premise::Held(_) => "sampled",
        Premise::SampledMeasurement => "sampled-measurement",
        Premise::Measurements => "measurements",
        Premise::Wheels => "wheels",
        Premise::Filtered(_) => "filtered",
        Premise::Standing(_) => "standing",
        Premise::TooClose(_) => "too-close",
        Premise::RobustGain { .. } => "robust-gain",
        Premise::Epsilon => "epsilon",
    }
}

fn unmet(certificate: &Certificate, statement: Statement) -> Vec<&'static str> {
    certificate.finding(statement).expect("a finding").unmet.iter().map(word).collect()
}

const ROBUST: [Statement; 3] = [Statement::RobustGain, Statement::NonNegative, Statement::TrackingDecrease];

#[test]
fn theorem_4_2_holds_where_all_its_premises_are_met() {
    // Until the sign begins to switch at every step.
    let smooth = certificate(&["time.duration=0.9"]);
    for statement in ROBUST {
        let finding = smooth.finding(statement).expect("a finding");
        assert_eq!(finding.outcome(), StatementOutcome::Holds, "{finding:?}");
    }
    assert_eq!(unmet(&smooth, Statement::Epsilon), ["no-observer"]);
    let whole = certificate(&[]);
    assert_eq!(unmet(&whole, Statement::TrackingDecrease), ["chatter"]);
    assert!(whole.final_error.iter().all(|e| e.abs() < 1e-3), "{:?}", whole.final_error);
}

/// The rate of V is −rᵀKr (eq 30), by differences of V along the run.
#[test]
fn v_falls_by_r_k_r() {
    let certificate = certificate(&["law.k=5"]);
    let rows = certificate.witness.rows();
    let mut steps = 0;
    for pair in rows.windows(2).take_while(|pair| pair[1].filtered > 0.3 * rows[0].filtered) {
        let slope = (pair[1].v - pair[0].v) / (pair[1].time - pair[0].time);
        let wanted = -5.0 * (math::powi(pair[0].filtered, 2) + math::powi(pair[1].filtered, 2)) / 2.0;
        assert!((slope - wanted).abs() < 0.02 * wanted.abs(), "{slope} against {wanted}");
        steps += 1;
    }
    assert!(steps > 10, "{steps} steps");
}

/// What acts in place of the law suspends what is said of V and e, for as many samples as it acts, and nothing else.
#[test]
fn a_filter_and_a_stand_suspend_what_is_said_of_the_error() {
    let filtered = include_str!("../scenes/pillar.toml");
    let scene = Scene::parse(filtered, "pillar.toml", &[]).expect("a scene").scene;
    let mut simulation = Simulation::new(build(&scene).expect("a run"));
    let mut examiner = Examiner::new(&scene, &simulation, false);
    let (mut moved, mut from) = (0, f64::INFINITY);
    while let Some(record) = simulation.next_record() {
        if record.is_filtered(2) {
            (moved, from) = (moved + 1, from.min(record.snapshot.time));
        }
        examiner.push(&simulation);
    }
    let all = examiner.finish(&simulation);
    let [free, held] = [&all[0], &all[1]];
    assert!(!unmet(free, Statement::TrackingDecrease).contains(&"filtered"));
    for statement in [Statement::TrackingDecrease, Statement::UltimateBound] {
        let finding = held.finding(statement).expect("a finding");
        let spell = finding.unmet.iter().find_map(|premise| match premise {
            Premise::Filtered(spell) => Some(*spell),
            _ => None,
        });
        let spell = spell.expect("a filter that acts");
        let count = (spell.share * held.witness.samples() as f64).round();
        assert_eq!((count, spell.first), (f64::from(moved), from));
        assert!(moved > 100);
    }
    for statement in [Statement::RobustGain, Statement::NonNegative, Statement::Trapped] {
        assert!(!unmet(held, statement).contains(&"filtered"), "{statement:?}");
    }
    let stands = certificates(include_str!("../scenes/stop-and-go.toml"), &[]);
    for certificate in &stands {
        let unmet = unmet(certificate, Statement::TrackingDecrease);
        assert!(unmet.contains(&"standing") && !unmet.contains(&"filtered"), "{unmet:?}");
    }
    // A leader that its filter leads past another does not drive smoothly along its path.
    let crossing = certificates(include_str!("../scenes/crossing.toml"), &["time.duration=12"]);
    assert!(crossing.iter().all(|c| unmet(c, Statement::RobustGain).contains(&"leader-not-smooth")));
}

/// With a path's heading a place is turned by τ/R on a circle, and so is what can be held.
#[test]
fn what_can_be_held_is_turned_with_a_headings_lag() {
    let curve = |lag: &str| {
        let lag = format!("law.heading_lag={lag}");
        let set = ["law.heading=path", &*lag].map(|set| set.parse::<Override>().expect("an override"));
        let scene =
            Scene::parse(include_str!("../scenes/circle-three.toml"), "c.toml", &set).expect("a scene");
        reach(&scene.scene).expect("a run")
    };
    let [plain, turned] = [curve("0"), curve("1")].map(|all| all[0].clone());
    // 1 m/s and 0.3 rad/s for half of the run; then the border of a bearing is that of the one 0.3 rad to the right.
    let border = |of: &Reach, bearing: f64| {
        let off = |ray: &&ReachRay| vocabulary::wrap(ray.bearing - bearing).abs();
        of.rays.iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("rays").distance
    };
    let bearing = -1.0;
    assert!((border(&turned, bearing + 0.3) - border(&plain, bearing)).abs() < 0.1);
    assert!((border(&turned, bearing) - border(&plain, bearing)).abs() > 0.15);
}

#[test]
fn a_beta_below_what_the_leader_does_is_violated_from_the_start() {
    // ‖g_v V_i‖ is 0.5 behind a leader at 1 m/s.
    let certificate = certificate(&["law.beta=0.3"]);
    assert_eq!(outcome(&certificate, Statement::RobustGain), StatementOutcome::Violated(0.0));
    assert_eq!(unmet(&certificate, Statement::NonNegative), ["robust-gain"]);
    let end = certificate.witness.rows().last().expect("rows");
    assert!((end.margin - (0.3 - end.effect)).abs() < 1e-2 && (end.effect - 0.5).abs() < 0.01, "{end:?}");
}

#[test]
fn every_premise_is_named_where_it_is_not_met() {
    let v = Statement::TrackingDecrease;
    assert_eq!(unmet(&certificate(&["law.switching=tanh"]), v), ["tanh"]);
    assert_eq!(unmet(&certificate(&["time.mode=sampled"]), v), ["sampled"]);
    let slow = certificate(&["vehicle.speed_max=1.02"]);
    assert!(unmet(&slow, v).contains(&"saturated") && unmet(&slow, v).contains(&"speed-bound"));
    let full = certificate(&["law.kind=full-state"]);
    assert!(ROBUST.iter().all(|statement| unmet(&full, *statement) == ["full-state"]));
    let measured = certificate(&["law.kind=output-feedback", "time.mode=measured", "observer.epsilon=0.01"]);
    assert_eq!(unmet(&measured, Statement::Trapped), ["sampled-measurement"]);
    let measuring = certificate(&[
        "law.kind=output-feedback",
        "time.mode=sampled",
        "sensing.kind=noise",
        "observer.epsilon=0.01",
    ]);
    assert!(unmet(&measuring, Statement::Trapped).contains(&"measurements"));
    let car = certificate(&["vehicle.kind=car", "vehicle.speed_max=2", "time.mode=sampled"]);
    assert!(unmet(&car, v).contains(&"wheels"));
}

#[test]
fn output_feedback_is_trapped_in_time_and_its_bound_is_kept() {
    let certificate = certificate(&["law.kind=output-feedback", "observer.epsilon=0.002"]);
    let constants = certificate.constants.expect("an observer");
    for statement in
        [Statement::RobustGain, Statement::Epsilon, Statement::ObserverDecrease, Statement::Trapped]
    {
        let finding = certificate.finding(statement).expect("a finding");
        assert_eq!(finding.outcome(), StatementOutcome::Holds, "{finding:?} {constants:?}");
    }
    let end = certificate.witness.rows().last().expect("rows");
    assert!(
        end.error <= constants.error && end.error + end.error_rate + end.observer_error <= constants.delta_0
    );
    // The bound is linear in ε, so the promise for it is ε itself.
    assert!((constants.epsilon_for(constants.error) - 0.002).abs() < 1e-12);
    // P0 of α = (2, 1) in closed form, and what follows from it.
    let norm = 1.0 + 0.5_f64.sqrt();
    assert!((constants.norm - norm).abs() < 1e-12);
    assert!(
        (constants.rho - 16.0 * math::powi(constants.sigma_v, 2) * math::powi(norm, 3)).abs()
            < 1e-9 * constants.rho
    );
    assert!(constants.epsilon_1 <= 1.0 / (4.0 * constants.sigma_s * norm) + 1e-15);
}

#[test]
fn an_epsilon_above_what_the_proof_takes_is_told() {
    let certificate = certificate(&["law.kind=output-feedback", "observer.epsilon=0.5"]);
    assert_eq!(outcome(&certificate, Statement::Epsilon), StatementOutcome::Violated(0.0));
    assert!(unmet(&certificate, Statement::UltimateBound).contains(&"epsilon"));
}

fn robot(name: &str, leader: &str, x: f64, y: f64) -> String {
    format!(
        "[[robots]]\nname = \"{name}\"\npose = [{x}, {y}, 0.0]\nspeed = 1.0\nleader = \"{leader}\"\n\
         distance = 2.0\nbearing = \"-135 deg\"\n"
    )
}

/// A third robot follows the second.
fn chain_of(followers: usize) -> String {
    let mut text = IDEAL.to_owned();
    let mut before = "follower".to_owned();
    for k in 1..followers {
        let step = 2.0_f64.sqrt();
        let (x, y) = (-0.1 - step * (k + 1) as f64, -step * (k + 1) as f64);
        text += &robot(&format!("f{k}"), &before, x, y);
        before = format!("f{k}");
    }
    text
}

#[test]
fn a_leader_that_follows_is_not_smooth_while_its_command_is_held() {
    let certificates = certificates(&chain_of(2), &["time.mode=sampled", "law.switching=tanh"]);
    let rough = |k: usize| unmet(&certificates[k], Statement::RobustGain);
    assert_eq!((rough(0), rough(1)), (vec![], vec!["leader-not-smooth"]));
}

/// The amplitudes that the linear chain predicts are those of a run whose lead robot's speed swings a little.
#[test]
fn gains_down_a_chain_are_those_of_a_run() {
    let (rate, amplitude) = (1.5, 0.002);
    let text = chain_of(3).replace(
        "path = { kind = \"constant\", speed = 1.0 }",
        &format!(
            "path = {{ kind = \"sinusoid\", speed = 1.0, speed_amplitude = {amplitude}, speed_rate = {rate}, \
             turn_rate = 0.0 }}"
        ),
    );
    let set = ["law.switching=tanh", "time.duration=30", "time.period=0.01"]
        .map(|s| s.parse::<Override>().expect("an override"));
    let swinging = Scene::parse(&text, "chain.toml", &set).expect("a scene").scene;
    let mut simulation = Simulation::new(build(&swinging).expect("a run"));
    // Fourier sums over the last whole periods, when the start has died out.
    let span = 3.0 * std::f64::consts::TAU / rate;
    let mut sums = [[0.0; 3]; 3];
    while let Some(record) = simulation.next_record() {
        let time = record.snapshot.time;
        if time < 30.0 - span {
            continue;
        }
        for (sum, edge) in sums.iter_mut().zip(&record.edges) {
            let e = edge.error[0];
            *sum = [sum[0] + e * math::cos(rate * time), sum[1] + e * math::sin(rate * time), sum[2] + 1.0];
        }
    }
    let steady = Scene::parse(&chain_of(3), "chain.toml", &set).expect("a scene").scene;
    for (gain, sum) in gains(&steady).expect("gains").iter().zip(sums) {
        let run = 2.0 * math::hypot(sum[0], sum[1]) / sum[2] / amplitude;
        assert!(gain.stable);
        let near = |p: &&studies::certify::chain::GainPoint| math::ln(p.frequency / rate).abs();
        let point = gain.curve.iter().min_by(|a, b| near(a).total_cmp(&near(b))).expect("a curve");
        assert!((run - point.lead).abs() < 0.03 * point.lead, "edge {}: {run} not {}", gain.edge, point.lead);
    }
}

/// The chart against runs that measure at samples, on both sides of its border.
#[test]
fn the_stability_chart_is_right_about_measured_runs() {
    let settles = |period: f64| {
        let set = [
            "time.mode=measured".to_owned(),
            "law.kind=output-feedback".to_owned(),
            "law.switching=tanh".to_owned(),
            "observer.epsilon=0.01".to_owned(),
            "time.duration=12".to_owned(),
            format!("time.period={period}"),
        ];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let rows = certificate(&set).witness.rows().to_vec();
        let late = rows.len() * 3 / 4;
        rows[late..].iter().map(|row| row.filtered).fold(0.0, f64::max) < 0.1
    };
    let channel = ChannelSensitivity { gain: 5.0, stiffness: 25.0 + 5.0 * 24.53, alpha1: 2.0, alpha2: 1.0 };
    for (period, stable) in [(0.02, true), (0.04, true), (0.12, false), (0.15, false)] {
        assert_eq!(channel.growth(Discretisation::Ramp, 0.01, period) < 1.0, stable, "chart at {period} s");
        assert_eq!(settles(period), stable, "run at {period} s");
    }
}
