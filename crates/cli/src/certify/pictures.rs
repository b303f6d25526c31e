//! Certificates as figures for print.

use super::CertifyReport;
use figures::{Axis, Figure, Guide, Key, Marker, Panel, Rgb, Scale, Series, Stroke};
use studies::certify::beyond::{Beyond, PERIODS, StabilityChart};
use studies::certify::chain::LENGTHS;
use studies::certify::{LongestPeriod, WitnessRow};

/// Curves that are shown, at most.
const MOST_EDGES: usize = 6;
/// How light the curves of chains are, short ones first.
const GREYS: [f32; LENGTHS.len()] = [0.0, 0.25, 0.4, 0.55];
/// Points of a curve, at most.
const MOST_POINTS: usize = 400;

/// Names and texts of all figures there are.
pub(super) fn figures(report: &CertifyReport<'_>) -> Vec<(&'static str, String)> {
    let mut all = vec![("certificate.svg", over_time(report).svg())];
    if let Some(beyond) = &report.beyond {
        if let Some(chart) = &beyond.chart {
            all.push(("stability.svg", stability(report, chart).svg()));
        }
        all.push(("reach.svg", reach(report, beyond).svg()));
        if beyond.chain.iter().any(|gain| !gain.curve.is_empty()) {
            all.push(("chain.svg", chain(report, beyond).svg()));
        }
    }
    all
}

fn colours(report: &CertifyReport<'_>) -> Vec<Rgb> {
    let robots = rendering::robot_colours(&report.fleet);
    let colour = |edge: &vocabulary::Edge| robots.get(edge.follower).copied().unwrap_or([0.3; 3]);
    report.fleet.edges.iter().map(colour).collect()
}

/// An axis whose range follows from what it shows.
pub(crate) fn axis(label: &str, scale: Scale) -> Axis {
    Axis { label: label.to_owned(), scale, ..Axis::default() }
}

/// The margin of β, P and V, and W with its trap.
fn over_time(report: &CertifyReport<'_>) -> Figure {
    let colours = colours(report);
    let panel = |label: &str, scale: Scale, named: bool, value: fn(&WitnessRow) -> f64| {
        let mut series = vec![];
        for (k, certificate) in report.certificates.iter().take(MOST_EDGES).enumerate() {
            let rows = certificate.witness.rows();
            let every = (rows.len() / MOST_POINTS).max(1);
            // The first tenth of a second is where it happens: all of it.
            let kept = rows.iter().enumerate().filter(|(i, _)| *i < 60 || i % every == 0);
            series.push(Series {
                name: if named { report.follower(certificate.edge).to_owned() } else { String::new() },
                colour: colours.get(certificate.edge).copied().unwrap_or([0.3; 3]),
                stroke: if k % 2 == 0 { Stroke::Solid } else { Stroke::Dashed },
                points: kept.map(|(_, row)| [row.time, value(row)]).collect(),
                ..Series::default()
            });
        }
        Panel { axis: axis(label, scale), series, guides: vec![Guide::Level(0.0, String::new())] }
    };
    let mut panels = vec![
        panel(
            "margin of β: β − ‖gᵥVᵢ‖ − ‖d(gᵥVᵢ)/dt‖/k₁₂ (m/s²)",
            Scale::Linear,
            true,
            |row| row.margin.max(-20.0),
        ),
        panel("P of eq 28", Scale::Linear, false, |row| row.p),
        panel("V = ½ rᵀr + P of eq 29", Scale::Linear, false, |row| row.v),
        panel("‖r‖ (m/s)", Scale::Log, false, |row| row.filtered.max(1e-9)),
    ];
    if let Some(c) = report.certificates.iter().find_map(|c| c.constants) {
        let mut observer =
            panel("W of eq 39, and its trap ρε²", Scale::Log, false, |row| row.w.max(1e-18));
        observer.guides = vec![Guide::Level(c.trap, "ρε²".to_owned())];
        panels.push(observer);
        if let Some(filtered) = panels.get_mut(3) {
            filtered.guides = vec![Guide::Level(c.filtered, "2L₁ε".to_owned())];
        }
    }
    Figure {
        title: format!("{}: certificate", report.scene.title),
        axis: axis("time (s)", Scale::Linear),
        panels,
        ..Figure::default()
    }
}

/// The longest stable period over ε, a curve for every discretisation.
fn stability(report: &CertifyReport<'_>, chart: &StabilityChart) -> Figure {
    const COLOURS: [Rgb; 5] =
        [[0.0, 0.45, 0.70], [0.0, 0.62, 0.45], [0.90, 0.62, 0.0], [0.80, 0.47, 0.65], [0.84, 0.37, 0.0]];
    let series = chart.borders.iter().enumerate().map(|(k, (_, border))| {
        let points = chart.epsilons.iter().zip(border).filter_map(|(epsilon, longest)| match longest {
            LongestPeriod::At(period) => Some([*epsilon, 1e3 * period]),
            LongestPeriod::Beyond => Some([*epsilon, 1e3 * PERIODS[1]]),
            LongestPeriod::Below => None,
        });
        Series {
            name: ["continuous", "straight line", "held", "Runge-Kutta 4", "Euler"][k % 5].to_owned(),
            colour: COLOURS[k % COLOURS.len()],
            stroke: [Stroke::Solid, Stroke::Dashed, Stroke::Dotted][k % 3],
            points: points.collect(),
            ..Series::default()
        }
    });
    let mut series: Vec<Series> = series.collect();
    series.push(Series {
        name: "this scene".to_owned(),
        colour: [0.1; 3],
        stroke: Stroke::None,
        marker: Marker::Diamond,
        points: vec![[chart.epsilon, 1e3 * chart.period]],
        ..Series::default()
    });
    Figure {
        title: format!("{}: stability", report.scene.title),
        axis: axis("observer constant ε (s)", Scale::Log),
        panels: vec![Panel {
            axis: axis("stable below: longest period (ms)", Scale::Log),
            series,
            guides: vec![],
        }],
        height: 60.0,
        ..Figure::default()
    }
}

/// How far away a set point may be, over its bearing.
fn reach(report: &CertifyReport<'_>, beyond: &Beyond) -> Figure {
    let colours = colours(report);
    let mut series = vec![];
    let shown = || beyond.reach.iter().take(MOST_EDGES);
    for (k, reach) in shown().enumerate() {
        let colour = colours.get(reach.edge).copied().unwrap_or([0.3; 3]);
        // Followers of one leader can hold the same: one curve for all of them.
        let like = || shown().filter(|other| other.rays == reach.rays);
        if like().next().is_some_and(|first| first.edge == reach.edge) {
            let alone = like().count() == 1;
            series.push(Series {
                name: if alone { report.follower(reach.edge).to_owned() } else { "all".to_owned() },
                colour: if alone { colour } else { [0.2; 3] },
                stroke: if k % 2 == 0 { Stroke::Solid } else { Stroke::Dashed },
                points: reach.rays.iter().map(|ray| [ray.bearing.to_degrees(), ray.distance]).collect(),
                ..Series::default()
            });
        }
        let [distance, bearing] = reach.set_point;
        series.push(Series {
            colour,
            stroke: Stroke::None,
            marker: Marker::Diamond,
            points: vec![[bearing.to_degrees(), distance]],
            ..Series::default()
        });
    }
    Figure {
        title: format!("{}: reach", report.scene.title),
        axis: Axis { label: "bearing (°)".to_owned(), show: vec![-180.0, 180.0], ..Axis::default() },
        panels: vec![Panel {
            axis: Axis {
                label: "distances below can be held (m)".to_owned(),
                show: vec![0.0],
                ..Axis::default()
            },
            series,
            guides: vec![],
        }],
        keys: vec![Key {
            name: "set point".to_owned(),
            stroke: Stroke::None,
            marker: Marker::Diamond,
            ..Key::default()
        }],
        height: 50.0,
        ..Figure::default()
    }
}

/// Gains over frequency of the first edge, and in long chains of it.
fn chain(report: &CertifyReport<'_>, beyond: &Beyond) -> Figure {
    let Some(gain) = beyond.chain.iter().find(|gain| !gain.curve.is_empty()) else {
        return Figure::default();
    };
    let lengths = LENGTHS.iter().enumerate().map(|(k, followers)| Series {
        name: if *followers == 1 { "1 follower".to_owned() } else { followers.to_string() },
        colour: [GREYS[k], 0.35 + 0.3 * GREYS[k], 0.7],
        stroke: [Stroke::Solid, Stroke::Dashed, Stroke::Dotted, Stroke::Solid][k],
        // Beyond a kilometre no limit is kept any more.
        points: gain.curve.iter().map(|p| [p.frequency, 1e3 * p.lengths[k]]).filter(|p| p[1] < 1e6).collect(),
        ..Series::default()
    });
    let growth = Series {
        colour: [0.84, 0.37, 0.0],
        points: gain.curve.iter().map(|p| [p.frequency, p.growth]).collect(),
        ..Series::default()
    };
    Figure {
        title: format!("{} in a chain of its like", report.follower(gain.edge)),
        axis: axis("frequency of the lead robot's speed (rad/s)", Scale::Log),
        panels: vec![
            Panel {
                axis: axis("distance error of the last (mm per m/s)", Scale::Log),
                series: lengths.collect(),
                guides: vec![],
            },
            Panel {
                axis: axis("growth from follower to follower", Scale::Linear),
                series: vec![growth],
                guides: vec![Guide::Level(1.0, String::new())],
            },
        ],
        height: 40.0,
        ..Figure::default()
    }
}
