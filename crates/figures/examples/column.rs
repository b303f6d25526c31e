//! A figure a column wide, to look at: `cargo run -p figures --example column > column.svg`.

use figures::{Axis, Figure, Guide, Key, Marker, Panel, Rgb, Scale, Series, Stroke};
use vocabulary::math;

const COLOURS: [Rgb; 3] = [[0.902, 0.624, 0.0], [0.337, 0.706, 0.914], [0.941, 0.894, 0.259]];

fn main() {
    let noises = [0.0_f64, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0];
    let panel = |label: &str, slope: f64, named: bool| {
        let series = COLOURS.iter().enumerate().flat_map(|(k, colour)| {
            let slope = slope * (1.0 + 0.4 * k as f64);
            let error = |x: f64| math::hypot(0.02 * slope, slope * x);
            let name = if named { format!("follower-{}", k + 1) } else { String::new() };
            let points = noises.iter().map(|x| [*x, error(*x)]).collect();
            let mark = vec![[0.07, error(0.09)]];
            let curve = Series { name, colour: *colour, marker: Marker::of(k), points, ..Series::default() };
            let mark = Series {
                colour: *colour,
                marker: Marker::Diamond,
                points: mark,
                stroke: Stroke::None,
                ..Series::default()
            };
            [curve, mark]
        });
        let axis = Axis { label: label.to_owned(), scale: Scale::Log, ..Axis::default() };
        Panel {
            axis,
            series: series.collect(),
            guides: vec![Guide::Level(0.03 * slope, "told the truth".to_owned())],
        }
    };
    let key = |name: &str, stroke, marker| Key { name: name.to_owned(), stroke, marker, colour: None };
    let figure = Figure {
        title: "Three trucks that see, on a circle: error budget, RMS".to_owned(),
        axis: Axis {
            label: "noise of a tag's corners (px)".to_owned(),
            scale: Scale::Log,
            ..Axis::default()
        },
        panels: vec![
            panel("Error of measurements: distance (mm)", 12.0, true),
            panel("Error of measurements: bearing (°)", 0.2, false),
            panel("Error of measurements: view angle (°)", 3.0, false),
        ],
        keys: vec![
            key("high-gain observer", Stroke::Solid, Marker::None),
            key("unscented filter", Stroke::Dashed, Marker::None),
            key("camera", Stroke::None, Marker::Diamond),
        ],
        ..Figure::default()
    };
    print!("{}", figure.svg());
}
