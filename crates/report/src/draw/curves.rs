//! Inputs, errors and estimated rates over time.

use super::{COMPARED, Drawn, NAMED, stroke, table};
use crate::trace::{EdgeRow, Trace};
use crate::words::round;
use figures::{Axis, Figure, Guide, Key, Panel, Rgb, Scale, Series, Stroke};
use vocabulary::Limits;
use vocabulary::math;

/// One edge of one run, as it is drawn.
#[derive(Clone)]
pub(crate) struct EdgeCurve<'a> {
    pub(crate) name: String,
    pub(crate) run: &'a Trace,
    pub(crate) edge: usize,
    pub(crate) colour: Rgb,
    pub(crate) stroke: Stroke,
    pub(crate) faint: bool,
}

impl<'a> EdgeCurve<'a> {
    /// The same edge of runs that are compared, each with its short name.
    pub(crate) fn compared(runs: &[(&str, &'a Trace)], edge: usize) -> Vec<Self> {
        let curve = |(k, (name, run)): (usize, &(&str, &'a Trace))| EdgeCurve {
            name: (*name).to_owned(),
            run,
            edge,
            colour: COMPARED[(k + 3 - runs.len().min(3)) % COMPARED.len()],
            // Where curves coincide, dashes over a solid line show both.
            stroke: BY_RANK[(k + 3 - runs.len().min(3)) % BY_RANK.len()],
            faint: false,
        };
        runs.iter().enumerate().map(curve).collect()
    }

    /// All edges of a run; of many, a few by name and the others as a crowd.
    pub(crate) fn all(run: &'a Trace) -> Vec<Self> {
        let few = run.fleet.edges.len() < NAMED;
        let mut worst: Vec<usize> = (0..run.fleet.edges.len()).collect();
        worst.sort_by(|a, b| run.settled(*b).unwrap_or(0.0).total_cmp(&run.settled(*a).unwrap_or(0.0)));
        let (first, last) = (worst.first().copied(), worst.last().copied());
        let named = |edge: usize| few || Some(edge) == first || Some(edge) == last;
        let mut curves: Vec<Self> = (0..run.fleet.edges.len())
            .map(|edge| EdgeCurve {
                name: if named(edge) { run.follower(edge).to_owned() } else { String::new() },
                run,
                edge,
                colour: match (few, Some(edge) == first) {
                    (true, _) => run.colour(edge),
                    // In a crowd colours come again and again.
                    (false, true) => COMPARED[0],
                    (false, false) if named(edge) => COMPARED[2],
                    (false, false) => [0.5; 3],
                },
                stroke: match (few, Some(edge) == first) {
                    (true, _) => stroke(edge),
                    (false, true) => Stroke::Dashed,
                    (false, false) => Stroke::Solid,
                },
                faint: !named(edge),
            })
            .collect();
        curves.sort_by_key(|curve| !curve.faint);
        curves
    }

    /// Its name in a table.
    fn column_name(&self) -> &str {
        if self.name.is_empty() { self.run.follower(self.edge) } else { &self.name }
    }

    fn rows(&self) -> impl Iterator<Item = (f64, &EdgeRow)> {
        self.run.times.iter().copied().zip(self.run.edges.get(self.edge).into_iter().flatten())
    }

    fn series(&self, named: bool, points: Vec<[f64; 2]>) -> Series {
        Series {
            name: if named { self.name.clone() } else { String::new() },
            colour: self.colour,
            stroke: self.stroke,
            faint: self.faint,
            points,
            ..Series::default()
        }
    }

    /// Speeds of the follower, m/s.
    fn speeds(&self) -> Vec<f64> {
        let robot = self.run.fleet.edges.get(self.edge).and_then(|e| self.run.robots.get(e.follower));
        robot.into_iter().flatten().map(|m| m.speed).collect()
    }

    fn column(&self, value: impl Fn(&EdgeRow) -> f64) -> Vec<f64> {
        self.rows().map(|(_, row)| value(row)).collect()
    }

    fn limits(&self) -> Option<Limits> {
        let edge = self.run.fleet.edges.get(self.edge)?;
        Some(self.run.scene.robots.get(edge.follower)?.vehicle.limits())
    }
}

/// Strokes of what is compared, from the bottom to the top.
const BY_RANK: [Stroke; 3] = [Stroke::DashDotted, Stroke::Solid, Stroke::Dashed];

fn points(times: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    times.iter().zip(values).map(|(t, v)| [*t, *v]).collect()
}

/// Commands are held from sample to sample.
fn held(times: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::with_capacity(2 * times.len());
    for (t, v) in times.iter().zip(values) {
        if let Some([_, before]) = points.last().copied() {
            points.push([*t, before]);
        }
        points.push([*t, *v]);
    }
    points
}

/// Whether the start is shown magnified.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Magnify {
    /// So many seconds of it.
    First(f64),
    /// A thirtieth of the run, rounded.
    Start,
    /// It is not.
    No,
}

impl Magnify {
    fn part(self, curves: &[EdgeCurve<'_>]) -> Option<[f64; 2]> {
        let length = curves.first().map_or(1.0, |c| c.run.scene.time.duration);
        match self {
            Self::First(seconds) => Some([0.0, seconds.min(length)]),
            Self::Start => Some([0.0, round(length / 30.0)]),
            Self::No => None,
        }
    }
}

/// Panels over time. Two columns leave no room for names beside them: those stand above.
fn figure(mut panels: Vec<Panel>, zoom: Option<[f64; 2]>) -> Figure {
    let axis = Axis { label: "time (s)".to_owned(), ..Axis::default() };
    let mut keys = vec![];
    for series in panels.iter_mut().filter(|_| zoom.is_some()).flat_map(|panel| &mut panel.series) {
        let name = std::mem::take(&mut series.name);
        if !name.is_empty() {
            let (stroke, colour) = (series.stroke, Some(series.colour));
            keys.push(Key { name, stroke, colour, ..Key::default() });
        }
    }
    Figure { axis, panels, keys, zoom, height: 21.0, ..Figure::default() }
}

fn panel(label: &str, series: Vec<Series>) -> Panel {
    Panel { axis: Axis { label: label.to_owned(), ..Axis::default() }, series, guides: vec![] }
}

/// Speed, commanded acceleration and turn rate of followers, with grey beyond their limits.
pub(crate) fn inputs(curves: &[EdgeCurve<'_>], magnify: Magnify) -> Drawn {
    let limits = curves.first().and_then(EdgeCurve::limits).unwrap_or(Limits::PAPER);
    let mut columns = vec![];
    let (mut speed, mut asked, mut turn) = (vec![], vec![], vec![]);
    for curve in curves {
        let times = &curve.run.times;
        let (v, a) = (curve.speeds(), curve.column(|row| row.asked.acceleration));
        let (b, w) =
            (curve.column(|row| row.applied.acceleration), curve.column(|row| row.applied.turn_rate));
        speed.push(curve.series(true, points(times, &v)));
        asked.push(curve.series(false, held(times, &a)));
        turn.push(curve.series(false, held(times, &w)));
        let name = curve.column_name();
        columns.extend([
            (format!("{name} speed_m_s"), v),
            (format!("{name} asked_acceleration_m_s2"), a),
            (format!("{name} applied_acceleration_m_s2"), b),
            (format!("{name} applied_turn_rate_rad_s"), w),
        ]);
    }
    let mut speed = panel("speed v (m/s)", speed);
    bound(&mut speed, [limits.speed_min, limits.speed_max], [Some(0.0), None]);
    let mut turn = panel("turn rate ω (rad/s)", turn);
    bound(&mut turn, [-limits.turn_rate_max, limits.turn_rate_max], [None, None]);
    let panels = vec![speed, panel("dv/dt asked for (m/s²)", asked), turn];
    let svg = figure(panels, magnify.part(curves)).svg();
    Drawn { svg, csv: table(times(curves), &columns) }
}

fn times<'a>(curves: &[EdgeCurve<'a>]) -> &'a [f64] {
    curves.first().map_or(&[], |curve| &curve.run.times)
}

/// Grey beyond the bounds that curves come near to, and an axis that shows a little of it. `end` holds ends of the axis
/// that are given.
fn bound(panel: &mut Panel, [low, high]: [f64; 2], end: [Option<f64>; 2]) {
    let values = || panel.series.iter().flat_map(|s| &s.points).map(|p| p[1]).filter(|v| v.is_finite());
    let (least, most) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if least > most {
        return;
    }
    let span = (most - least).max(1e-6 * most.abs()).max(1e-9);
    let (reached_high, reached_low) =
        (most > high - 0.05 * span, least < low + 0.05 * span && end[0].is_none());
    let bottom = end[0].unwrap_or(least - if reached_low { 0.12 } else { 0.06 } * span);
    let top = end[1].unwrap_or(most + if reached_high { 0.12 } else { 0.06 } * span);
    panel.axis.range = Some([bottom, top]);
    if reached_high {
        panel.guides.push(Guide::Band([high, top]));
    }
    if reached_low {
        panel.guides.push(Guide::Band([bottom, low]));
    }
}

/// Smallest and largest ‖e‖ that are drawn: less is rounding, or the start of an interpolation.
const NORMS: [f64; 2] = [1e-6, 10.0];

/// Errors of distance and bearing, and their size by its logarithm.
pub(crate) fn errors(curves: &[EdgeCurve<'_>], magnify: Magnify) -> Drawn {
    let mut columns = vec![];
    let (mut distance, mut bearing, mut norm) = (vec![], vec![], vec![]);
    for curve in curves {
        let times = &curve.run.times;
        let each = [0, 1].map(|channel| curve.column(|row| row.error[channel]));
        let degrees: Vec<f64> = each[1].iter().map(|e| e.to_degrees()).collect();
        let sizes: Vec<f64> = each[0].iter().zip(&each[1]).map(|(a, b)| math::hypot(*a, *b)).collect();
        distance.push(curve.series(true, points(times, &each[0])));
        bearing.push(curve.series(false, points(times, &degrees)));
        // What is below the axis would have no logarithm to draw at zero.
        let drawn: Vec<f64> = sizes.iter().map(|e| e.max(1e-30)).collect();
        norm.push(curve.series(false, points(times, &drawn)));
        let name = curve.column_name();
        let [metres, radians] = each;
        columns.extend([
            (format!("{name} error_distance_m"), metres),
            (format!("{name} error_bearing_rad"), radians),
            (format!("{name} error_norm"), sizes),
        ]);
    }
    let zero = |mut panel: Panel| {
        panel.guides.push(Guide::Level(0.0, String::new()));
        panel
    };
    let mut norm = panel("‖e‖, m and rad", norm);
    norm.axis.scale = Scale::Log;
    let values = || norm.series.iter().flat_map(|s| &s.points).map(|p| p[1]);
    let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
    let ends = [least.clamp(NORMS[0], 0.1) * 0.7, most.clamp(0.01, NORMS[1]) * 1.4];
    norm.axis.range = Some(ends);
    let panels =
        vec![zero(panel("distance error (m)", distance)), zero(panel("bearing error (°)", bearing)), norm];
    let svg = figure(panels, magnify.part(curves)).svg();
    Drawn { svg, csv: table(times(curves), &columns) }
}

/// True and estimated rates of an edge, and how far they are apart.
pub(crate) fn observer(run: &Trace, edge: usize, magnify: Magnify) -> Drawn {
    let base = EdgeCurve {
        name: "true".to_owned(),
        run,
        edge,
        colour: [0.12; 3],
        stroke: Stroke::Solid,
        faint: false,
    };
    let estimated = EdgeCurve {
        name: "estimated".to_owned(),
        colour: COMPARED[0],
        stroke: Stroke::Dashed,
        ..base.clone()
    };
    let mut columns = vec![];
    let mut panels = vec![];
    for (channel, label, factor, unit) in [
        (0, "d\u{2113}/dt (m/s)", 1.0, "distance_m_s"),
        (1, "dψ/dt (°/s)", 180.0 / std::f64::consts::PI, "bearing_rad_s"),
    ] {
        let truth = base.column(|row| row.rates[channel]);
        let guess = base.column(|row| row.estimated[channel]);
        let scaled = |values: &[f64]| values.iter().map(|v| v * factor).collect::<Vec<_>>();
        let series = vec![
            base.series(channel == 0, points(&run.times, &scaled(&truth))),
            estimated.series(channel == 0, points(&run.times, &scaled(&guess))),
        ];
        panels.push(panel(label, series));
        columns.push((format!("true_rate_{unit}"), truth));
        columns.push((format!("estimated_rate_{unit}"), guess));
    }
    let apart = |row: &EdgeRow| {
        let [a, b] = [0, 1].map(|k| row.estimated[k] - row.rates[k]);
        math::hypot(a, b).max(1e-30)
    };
    let sizes = base.column(apart);
    let mut error =
        panel("error of the estimate, m/s and rad/s", vec![base.series(false, points(&run.times, &sizes))]);
    error.axis.scale = Scale::Log;
    let most = sizes.iter().copied().fold(0.01, f64::max);
    error.axis.range = Some([1e-6 * most, 1.5 * most]);
    panels.push(error);
    columns.push(("error_norm".to_owned(), sizes));
    let svg = figure(panels, magnify.part(&[base])).svg();
    Drawn { svg, csv: table(&run.times, &columns) }
}
