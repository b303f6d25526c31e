//! The numbers behind the paper's figures held against the independent solutions, and claims that turn when runs do.

use report::{Case, FinishedRun, Report, Tracer, Variant, paper, paper_runs};
use simulation::{Simulation, build};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::LazyLock;
use vocabulary::LawKind;

/// All runs behind the figures.
static RUNS: LazyLock<Vec<FinishedRun>> = LazyLock::new(|| {
    let jobs = paper_runs().expect("shipped scenes");
    let run = |job: &report::PlannedRun| {
        let mut simulation = Simulation::new(build(&job.scene).expect("a scene that runs"));
        let colours = vec![[0.0; 3]; simulation.fleet().robots.len()];
        let mut tracer = Tracer::new(job.name.clone(), &job.scene, &simulation, &colours, job.transient);
        while let Some(record) = simulation.next_record() {
            tracer.push(record);
        }
        FinishedRun { case: job.case, variant: job.variant, trace: tracer.finish() }
    };
    jobs.iter().map(run).collect()
});

/// Columns by name.
type Table = BTreeMap<String, Vec<f64>>;

fn table(text: &str) -> Table {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let names: Vec<String> = reader.headers().expect("a head").iter().map(str::to_owned).collect();
    let mut table: Table = names.iter().map(|name| (name.clone(), vec![])).collect();
    for row in reader.records() {
        for (name, cell) in names.iter().zip(&row.expect("a row")) {
            table.get_mut(name).expect("a column").push(cell.parse().expect("a number"));
        }
    }
    table
}

fn golden(name: &str) -> Table {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/golden").join(format!("{name}.csv"));
    table(&std::fs::read_to_string(path).expect("a golden file"))
}

fn figure(report: &Report, stem: &str) -> Table {
    table(&report.items.iter().find(|item| item.stem == stem).expect(stem).csv)
}

/// Holds a figure's column against one of a golden file, at the times of the latter.
fn agree(ours: (&Table, &str), golden: (&Table, &str), most: f64) {
    let (times, values) =
        (&ours.0["time_s"], ours.0.get(ours.1).unwrap_or_else(|| panic!("no column {}", ours.1)));
    let mut compared = 0;
    for (time, wanted) in golden.0["t"].iter().zip(&golden.0[golden.1]) {
        let row = times.iter().position(|t| (t - time).abs() < 1e-6).expect("a row");
        let apart = values[row] - wanted;
        let apart = if golden.1.starts_with("theta") { vocabulary::wrap(apart) } else { apart };
        assert!(apart.abs() < most, "{} is {} off at {time} s", ours.1, apart);
        compared += 1;
    }
    assert!(compared > 200, "{compared} rows");
}

/// Names of figures' curves, golden files, and how far apart they may be. At ε = 0.1 s the golden files carry the error
/// that `tests/reference.rs` speaks of.
const LAWS: [(&str, &str, f64); 3] =
    [("FSFB", "fsfb_sampled", 1e-6), ("RSFB", "rsfb_sampled", 1e-6), ("OFB", "ofb_sampled", 1e-5)];
const CONSTANTS: [(&str, &str, f64); 2] =
    [("ε = 0.1 s", "ofb_eps0.1_sampled", 1e-3), ("ε = 0.001 s", "ofb_sampled", 1e-5)];

#[test]
fn figures_3_to_12_show_the_independent_solutions() {
    let report = paper(&RUNS);
    for (first, case) in [(3, "line"), (8, "circle")] {
        let stem = |offset: u32| format!("figure-{:02}", first + offset);
        let ways = figure(&report, &stem(0));
        let ofb = golden(&format!("{case}_ofb_sampled"));
        for (robot, name) in ["leader", "follower-1", "follower-2"].iter().enumerate() {
            for (ours, theirs) in [("x_m", "x"), ("y_m", "y"), ("heading_rad", "theta")] {
                agree((&ways, &format!("{name} {ours}")), (&ofb, &format!("{theirs}{robot}")), 1e-5);
            }
        }
        for (inputs, errors, curves) in [(stem(1), stem(2), &LAWS[..]), (stem(3), stem(4), &CONSTANTS[..])] {
            let (inputs, errors) = (figure(&report, &inputs), figure(&report, &errors));
            for (name, file, most) in curves {
                let golden = golden(&format!("{case}_{file}"));
                agree((&inputs, &format!("{name} speed_m_s")), (&golden, "v1"), *most);
                agree((&errors, &format!("{name} error_distance_m")), (&golden, "e_l1"), *most);
                agree((&errors, &format!("{name} error_bearing_rad")), (&golden, "e_psi1"), *most);
            }
        }
    }
}

#[test]
fn the_graph_of_seven_is_that_of_the_independent_solution() {
    let report = paper(&RUNS);
    let csv = &report.items.iter().find(|item| item.stem == "figure-15").expect("a graph").csv;
    assert_eq!(csv.lines().count(), 7);
    for bearing in [",2,-2.35619449,-135", ",2,2.35619449,135"] {
        assert_eq!(csv.lines().filter(|line| line.ends_with(bearing)).count(), 3, "{csv}");
    }
    let seven = RUNS.iter().find(|ran| ran.case == Case::Seven).expect("seven robots");
    let golden = golden("seven_line_ofb_sampled");
    for (edge, fleet) in seven.trace.fleet.edges.iter().enumerate() {
        let wanted = &golden[&format!("e_l{}", fleet.follower)];
        for (time, wanted) in golden["t"].iter().zip(wanted) {
            let found = seven.trace.edges[edge][seven.trace.sample_at(*time)].error[0];
            assert!((found - wanted).abs() < 1e-5, "edge {edge} at {time} s");
        }
    }
}

/// Whether the claims of a figure about a quantity hold, in order.
fn verdicts(runs: &[FinishedRun], stem: &str, quantity: &str) -> Vec<bool> {
    let report = paper(runs);
    let claims = report.claims().filter(|c| c.figure == stem && c.quantity.starts_with(quantity));
    claims.map(|claim| claim.holds).collect()
}

/// The runs with two variants of every case taken for each other.
fn swapped(a: Variant, b: Variant) -> Vec<FinishedRun> {
    let other = |variant| {
        if variant == a {
            b
        } else if variant == b {
            a
        } else {
            variant
        }
    };
    let mut runs = RUNS.clone();
    runs.iter_mut().filter(|ran| ran.case != Case::Seven).for_each(|ran| ran.variant = other(ran.variant));
    runs
}

#[test]
fn claims_about_the_observer_constant_turn_when_the_constants_are_swapped() {
    let swapped = swapped(Variant::epsilon(0.1), Variant::epsilon(0.001));
    for (effort, errors) in [("figure-06", "figure-07"), ("figure-11", "figure-12")] {
        assert_eq!(verdicts(&RUNS, errors, "settled"), [true]);
        assert_eq!(verdicts(&swapped, errors, "settled"), [false]);
        assert_eq!(verdicts(&RUNS, effort, "peak |dv/dt|"), [true]);
        assert_eq!(verdicts(&swapped, effort, "peak |dv/dt|"), [false]);
    }
}

#[test]
fn claims_about_the_laws_turn_when_the_laws_are_swapped() {
    let swapped = swapped(Variant::law(LawKind::FullState), Variant::epsilon(0.001));
    for (effort, errors) in [("figure-04", "figure-05"), ("figure-09", "figure-10")] {
        assert_eq!(verdicts(&RUNS, errors, "settled"), [true, true]);
        assert_eq!(verdicts(&swapped, errors, "settled"), [false, true]);
        assert_eq!(verdicts(&RUNS, effort, "∫|dv/dt|"), [true]);
        assert_eq!(verdicts(&swapped, effort, "∫|dv/dt|"), [false]);
    }
}

#[test]
fn a_run_that_does_not_settle_is_not_said_to() {
    let mut runs = RUNS.clone();
    assert_eq!(verdicts(&runs, "figure-03", "largest error"), [true, true]);
    for ran in &mut runs {
        ran.trace.metrics.edges[0].late_peak_error = [0.5, 0.5];
    }
    assert_eq!(verdicts(&runs, "figure-03", "largest error"), [false, false]);
}

#[test]
fn figures_are_the_same_bytes_again() {
    let sheets =
        |report: &Report| report.items.iter().map(|i| (i.svg.clone(), i.csv.clone())).collect::<Vec<_>>();
    assert_eq!(sheets(&paper(&RUNS)), sheets(&paper(&RUNS)));
}
