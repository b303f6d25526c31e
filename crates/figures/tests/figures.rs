//! Figures as their readers meet them: well-formed, complete, the same every time.

use figures::{Axis, Figure, Guide, Key, Marker, Panel, Scale, Series, Stroke};
use roxmltree::Document;
use vocabulary::math;

fn series(name: &str, points: Vec<[f64; 2]>) -> Series {
    Series { name: name.into(), colour: [0.9, 0.6, 0.0], marker: Marker::Disc, points, ..Series::default() }
}

fn axis(label: &str, scale: Scale) -> Axis {
    Axis { label: label.into(), scale, ..Axis::default() }
}

fn figure(points: &[[f64; 2]], scale: Scale) -> Figure {
    let panel = |label: &str| Panel {
        axis: axis(label, scale),
        series: vec![series("a & <b>", points.to_vec())],
        guides: vec![
            Guide::Upright(0.1, "camera".into()),
            Guide::Level(0.2, "truth".into()),
            Guide::Band([0.1, 0.3]),
        ],
    };
    Figure {
        title: "Looks \"and\" errors".into(),
        axis: axis("pixel noise (px)", scale),
        panels: vec![panel("distance (mm)"), panel("bearing (°)")],
        keys: vec![Key { name: "high-gain".into(), ..Key::default() }],
        ..Figure::default()
    }
}

/// All texts of a figure that has to be well-formed, and numbers only where numbers belong.
fn texts(svg: &str) -> Vec<String> {
    let document = Document::parse(svg).expect("well-formed");
    for node in document.descendants() {
        for attribute in node.attributes() {
            let value = attribute.value();
            assert!(!value.contains("NaN") && !value.contains("inf"), "{value}");
        }
    }
    document
        .descendants()
        .filter(|n| n.has_tag_name("text"))
        .filter_map(|n| n.text().map(str::to_owned))
        .collect()
}

#[test]
fn labels_units_and_names_are_there() {
    let points = vec![[0.0, 0.05], [0.02, 0.1], [0.1, 0.2], [1.0, 2.0]];
    let found = texts(&figure(&points, Scale::Log).svg());
    for text in [
        "distance (mm)",
        "bearing (°)",
        "pixel noise (px)",
        "a & <b>",
        "camera",
        "truth",
        "high-gain",
        "0",
        "0.1",
    ] {
        assert!(found.iter().any(|t| t == text), "{text} is not among {found:?}");
    }
    // Only the last panel carries the labels of the shared axis.
    assert_eq!(found.iter().filter(|t| *t == "0").count(), 1);
}

#[test]
fn a_figure_is_as_wide_as_asked() {
    let svg = figure(&[[0.1, 1.0], [1.0, 2.0]], Scale::Linear).svg();
    let document = Document::parse(&svg).expect("well-formed");
    assert_eq!(document.root_element().attribute("width"), Some("85mm"));
}

#[test]
fn the_same_figure_gives_the_same_bytes() {
    let curve: Vec<[f64; 2]> =
        (1..200).map(|k| [f64::from(k) * 0.01, math::sin(f64::from(k) * 0.3)]).collect();
    let make = || figure(&curve, Scale::Linear).svg();
    assert_eq!(make(), make());
}

#[test]
fn nothing_to_draw_is_said() {
    for points in [vec![], vec![[f64::NAN, 1.0]], vec![[1.0, f64::INFINITY]]] {
        for scale in [Scale::Linear, Scale::Log] {
            let found = texts(&figure(&points, scale).svg());
            assert!(found.iter().any(|t| t == "no data"), "{found:?}");
        }
    }
    texts(&Figure::default().svg());
    texts(&Figure { width: f64::NAN, height: -3.0, ..figure(&[], Scale::Log) }.svg());
}

#[test]
fn what_is_no_number_leaves_a_gap() {
    let points = vec![[0.0, 1.0], [1.0, 2.0], [2.0, f64::NAN], [3.0, 2.0], [4.0, 1.0]];
    let svg = figure(&points, Scale::Linear).svg();
    texts(&svg);
    let curve = svg
        .lines()
        .find(|l| l.contains("stroke-linejoin"))
        .and_then(|_| svg.lines().find(|l| l.contains("stroke-linejoin") && l.matches('M').count() == 2));
    assert!(curve.is_some(), "{svg}");
}

#[test]
fn values_far_out_stay_drawable() {
    for points in
        [vec![[0.0, 1e308], [1.0, -1e308]], vec![[1e-300, 1e-300], [1e300, 1e300]], vec![[5.0, 5.0]]]
    {
        for scale in [Scale::Linear, Scale::Log] {
            let svg = figure(&points, scale).svg();
            texts(&svg);
            assert!(svg.len() < 200_000, "{}", svg.len());
        }
    }
}

#[test]
fn steps_go_level_before_they_go_up() {
    let mut figure = figure(&[], Scale::Linear);
    figure.panels[0].series[0] = Series { stroke: Stroke::Step, ..series("s", vec![[0.0, 0.0], [1.0, 1.0]]) };
    let svg = figure.svg();
    let path =
        svg.lines().find(|l| l.contains("stroke-linejoin") && !l.contains("#6b6f76")).expect("a curve");
    assert_eq!(path.matches('L').count(), 2, "{path}");
}
