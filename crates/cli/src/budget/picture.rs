//! A comparison as a figure a column wide.

use crate::certify::axis;
use figures::{Axis, Figure, Key, Marker, Panel, Rgb, Scale, Series, Stroke};
use studies::budget::{Budget, EdgeErrors, ObserverChoice, SensingLevel};

/// One quantity of an edge.
type Value<'a> = &'a dyn Fn(&EdgeErrors) -> Option<f64>;

pub(crate) fn figure(budget: &Budget<'_>) -> Figure {
    if budget.constants { constants(budget) } else { levels(budget) }
}

/// The followers' colours and names, by edge.
fn followers(budget: &Budget<'_>) -> Vec<(Rgb, String)> {
    let colours = rendering::robot_colours(&budget.fleet);
    let colour = |robot: usize| colours.get(robot).copied().unwrap_or_default();
    let edges = budget.fleet.edges.iter().enumerate();
    edges.map(|(index, edge)| (colour(edge.follower), budget.edge(index)[1].to_owned())).collect()
}

/// Factor from rad to degrees.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;
/// Factor from m to mm.
const MILLI: f64 = 1e3;

/// Errors of measurements and of following over the noise of corners, with the camera among them.
fn levels(budget: &Budget<'_>) -> Figure {
    let mut panels = vec![
        measurements(budget, "Error of measurements: distance (mm)", 0, MILLI),
        measurements(budget, "Error of measurements: bearing (°)", 1, DEGREES),
        measurements(budget, "Error of measurements: view angle (°)", 2, DEGREES),
        tracking(budget, "Tracking error: distance (mm)", 0, MILLI),
        tracking(budget, "Tracking error: bearing (°)", 1, DEGREES),
    ];
    // Colours are the same in all panels: one carries the names.
    for panel in panels.iter_mut().skip(1) {
        panel.series.iter_mut().for_each(|series| series.name.clear());
    }
    let mut keys = vec![
        Key { name: "high-gain observer".to_owned(), ..Key::default() },
        Key { name: "unscented filter".to_owned(), stroke: Stroke::Dashed, ..Key::default() },
        Key { name: "told the truth".to_owned(), stroke: Stroke::Dotted, ..Key::default() },
    ];
    if budget.run(SensingLevel::Camera, ObserverChoice::HighGain).is_some() {
        keys.push(Key {
            name: "camera, at the noise its measurements stand for".to_owned(),
            stroke: Stroke::None,
            marker: Marker::Diamond,
            colour: None,
        });
    }
    Figure {
        title: format!("{}: error budget, RMS", budget.scene.title),
        axis: axis("noise of a tag's corners (px)", Scale::Log),
        panels,
        keys,
        ..Figure::default()
    }
}

/// A curve for every edge, and a diamond for its camera.
fn measurements(budget: &Budget<'_>, label: &str, channel: usize, factor: f64) -> Panel {
    let value = |m: &EdgeErrors| Some(m.measurements?[channel] * factor);
    let series = followers(budget).into_iter().enumerate().flat_map(|(index, (colour, name))| {
        let mut points = budget.curve(index, ObserverChoice::HighGain, value);
        // Without noise and tilt only rounding errs: showing it would flatten everything else.
        if let [[_, first], [_, second], ..] = points[..]
            && first < 0.05 * second
        {
            points.remove(0);
        }
        let curve = Series { name, colour, points, marker: Marker::of(index), ..Series::default() };
        [Some(curve), camera(budget, index, colour, &value)].into_iter().flatten()
    });
    Panel { axis: axis(label, Scale::Log), series: series.collect(), guides: vec![] }
}

/// A curve for every edge and observer, a diamond for its camera, and the least that is possible.
fn tracking(budget: &Budget<'_>, label: &str, channel: usize, factor: f64) -> Panel {
    let value = |m: &EdgeErrors| Some(m.tracking[channel] * factor);
    let series = followers(budget).into_iter().enumerate().flat_map(|(index, (colour, name))| {
        let curve = |observer: ObserverChoice, stroke: Stroke, marker: Marker| Series {
            colour,
            points: budget.curve(index, observer, value),
            marker,
            stroke,
            ..Series::default()
        };
        let unscented = curve(ObserverChoice::Unscented, Stroke::Dashed, Marker::None);
        let high_gain = Series { name, ..curve(ObserverChoice::HighGain, Stroke::Solid, Marker::of(index)) };
        [Some(unscented), Some(high_gain), camera(budget, index, colour, &value)].into_iter().flatten()
    });
    let mut series: Vec<Series> = series.collect();
    let least = series.iter().flat_map(|s| &s.points).map(|p| p[1]).fold(f64::INFINITY, f64::min);
    let ends: Vec<f64> = budget.pixels().into_iter().filter(|p| *p > 0.0).collect();
    let truth = budget.run(SensingLevel::Truth, ObserverChoice::HighGain);
    for (index, (colour, _)) in followers(budget).into_iter().enumerate() {
        let Some(level) = truth.and_then(|run| value(run.edges.get(index)?)) else { continue };
        // Where the truth is far better, showing it would flatten everything else.
        if level > least / 10.0 {
            let points = [ends.first(), ends.last()].into_iter().flatten().map(|x| [*x, level]).collect();
            series.push(Series { colour, points, stroke: Stroke::Dotted, ..Series::default() });
        }
    }
    Panel { axis: axis(label, Scale::Log), series, guides: vec![] }
}

/// The camera's value, at the noise of corners that the follower's measurements by camera stand for.
fn camera(budget: &Budget<'_>, index: usize, colour: Rgb, value: Value<'_>) -> Option<Series> {
    let run = budget.run(SensingLevel::Camera, ObserverChoice::HighGain)?;
    let (pixels, value) = (budget.camera_as_pixels(index).1?, value(run.edges.get(index)?)?);
    let points = vec![[pixels, value]];
    Some(Series { colour, points, stroke: Stroke::None, marker: Marker::Diamond, ..Series::default() })
}

/// What an observer constant does to following, to rates and to commands, with the constant that follows from the
/// noise.
fn constants(budget: &Budget<'_>) -> Figure {
    let panel = |label: &str, scale: Scale, value: Value<'_>| {
        let series = followers(budget).into_iter().enumerate().flat_map(|(index, (colour, name))| {
            let at = |observer: ObserverChoice| {
                let run = budget.runs.iter().find(|(case, _)| case.observer == observer);
                value(run?.1.edges.get(index)?)
            };
            let points: Vec<[f64; 2]> = epsilons(budget)
                .filter_map(|epsilon| Some([epsilon, at(ObserverChoice::Constant(Some(epsilon)))?]))
                .collect();
            let ends = [points.first(), points.last()].into_iter().flatten().map(|p| p[0]);
            let level = at(ObserverChoice::Constant(None));
            let adaptive = ends.filter_map(|x| Some([x, level?])).collect();
            [
                Series { colour, points: adaptive, stroke: Stroke::Dashed, ..Series::default() },
                Series { name, colour, points, marker: Marker::of(index), ..Series::default() },
            ]
        });
        let series = series.collect();
        let show = if scale == Scale::Linear { vec![0.0, 5.0] } else { vec![] };
        Panel { axis: Axis { label: label.to_owned(), scale, show, range: None }, series, guides: vec![] }
    };
    let mut panels = vec![
        panel("Tracking error: distance (mm)", Scale::Log, &|m| Some(m.tracking[0] * MILLI)),
        panel("Tracking error: bearing (°)", Scale::Log, &|m| Some(m.tracking[1] * DEGREES)),
        panel("Error of estimated rate: distance (mm/s)", Scale::Log, &|m| Some(m.rate_error[0] * MILLI)),
        panel("Error of estimated rate: bearing (°/s)", Scale::Log, &|m| Some(m.rate_error[1] * DEGREES)),
        panel("Samples with a limited command (%)", Scale::Linear, &|m| Some(m.limited * 100.0)),
    ];
    for panel in panels.iter_mut().skip(1) {
        panel.series.iter_mut().for_each(|series| series.name.clear());
    }
    let by = budget.runs.first().map_or("", |(case, _)| case.level.word());
    Figure {
        title: format!("{}: observer constant, measurements by {by}, RMS", budget.scene.title),
        axis: axis("observer constant ε (s)", Scale::Log),
        panels,
        keys: vec![
            Key { name: "ε the same throughout".to_owned(), ..Key::default() },
            Key { name: "ε from the noise".to_owned(), stroke: Stroke::Dashed, ..Key::default() },
        ],
        ..Figure::default()
    }
}

/// The constants that were tried, in order.
fn epsilons(budget: &Budget<'_>) -> impl Iterator<Item = f64> {
    budget.runs.iter().filter_map(|(case, _)| match case.observer {
        ObserverChoice::Constant(constant) => constant,
        ObserverChoice::HighGain | ObserverChoice::Unscented => None,
    })
}
