//! A map: a value for every cell of a grid, as colours, with a bar that says what they mean.

use crate::axis::Ruler;
use crate::draw::{GREY, MARGIN, SMALL, TICK, heading, points};
use crate::svg::{Anchor, Svg, polyline, width};
use crate::{Axis, Key, Rgb, Scale, Stroke};
use vocabulary::math;

/// One side of a map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MapAxis {
    /// Quantity and unit.
    pub label: String,
    /// How its values lie.
    pub scale: Scale,
    /// The values of its cells, rising; their places, 0, 1, 2, …, where they have names.
    pub values: Vec<f64>,
    /// What the cells are called, where they are no numbers.
    pub names: Vec<String>,
}

/// A line over a map, in the units of its axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MapLine {
    /// What it is; in the key over the map.
    pub name: String,
    /// How it is drawn.
    pub stroke: Stroke,
    /// Its points; one that is not finite begins another stretch.
    pub points: Vec<[f64; 2]>,
    /// Ticks on its side: each from a point of the line towards another.
    pub ticks: Vec<[[f64; 2]; 2]>,
}

/// Values over two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// Over everything.
    pub title: String,
    /// From left to right.
    pub across: MapAxis,
    /// From bottom to top.
    pub up: MapAxis,
    /// A value for every cell, row by row from the bottom; what is not finite has none.
    pub cells: Vec<f64>,
    /// What the values are, with their unit.
    pub label: String,
    /// How colours follow values.
    pub scale: Scale,
    /// The values of the first and the last colour; those of the cells if left out.
    pub range: Option<[f64; 2]>,
    /// Whether the last colour is for the least value.
    pub reversed: bool,
    /// Lines over the map.
    pub lines: Vec<MapLine>,
    /// Width, mm.
    pub width: f64,
}

/// Colours from dark to light: viridis (Smith and van der Walt, 2015) at every eighth. They are told apart in grey and by
/// those who see few colours.
const COLOURS: [Rgb; 9] = [
    [0.267, 0.005, 0.329],
    [0.279, 0.175, 0.483],
    [0.230, 0.322, 0.546],
    [0.173, 0.449, 0.558],
    [0.128, 0.567, 0.551],
    [0.158, 0.684, 0.502],
    [0.369, 0.789, 0.383],
    [0.678, 0.864, 0.190],
    [0.993, 0.906, 0.144],
];

/// The colour at a place from 0, dark, to 1, light.
pub fn viridis(at: f64) -> Rgb {
    let place = at.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let low = (place.floor() as usize).min(COLOURS.len() - 2);
    let within = (place - low as f64) as f32;
    [0, 1, 2].map(|channel| {
        let (a, b) = (COLOURS[low][channel], COLOURS[low + 1][channel]);
        a + within * (b - a)
    })
}

/// Width of the bar and the gap before it, points.
const BAR: f64 = 8.0;
const GAP: f64 = 8.0;
/// Height of a map, as a share of its width.
const SHAPE: f64 = 0.82;
/// Length of the ticks on a side of a line, points.
const SIDE: f64 = 3.2;
/// Under a map: labels of ticks and of the axis.
const FOOT: f64 = 23.0;

/// One side, laid out: where each cell begins and ends, 0 to 1.
pub struct MapSide<'a> {
    axis: &'a MapAxis,
    /// From values to places.
    pub ruler: Ruler,
    /// Where each cell begins, and the last one ends.
    pub edges: Vec<f64>,
}

impl<'a> MapSide<'a> {
    /// Lays a side out.
    pub fn new(axis: &'a MapAxis) -> Self {
        // Positions before the axis is laid out: logarithms where it is logarithmic.
        let logarithmic = axis.scale == Scale::Log && axis.values.iter().all(|value| *value > 0.0);
        let to = |value: f64| if logarithmic { math::log10(value) } else { value };
        let from = |at: f64| if logarithmic { math::powf(10.0, at) } else { at };
        let at: Vec<f64> = axis.values.iter().map(|value| to(*value)).collect();
        let step = |k: usize| at.get(k + 1).zip(at.get(k)).map_or(1.0, |(next, this)| next - this);
        let half = |k: usize| 0.5 * step(k);
        let mut cuts: Vec<f64> = at.first().map(|first| first - half(0)).into_iter().collect();
        cuts.extend((0..at.len().saturating_sub(1)).map(|k| at[k] + half(k)));
        cuts.extend(at.last().map(|last| last + half(at.len().saturating_sub(2))));
        let ends = cuts.first().zip(cuts.last()).map(|(first, last)| [from(*first), from(*last)]);
        let scale = if logarithmic { Scale::Log } else { Scale::Linear };
        let laid = Axis { scale, range: ends, ..Axis::default() };
        let ruler = Ruler::new(&laid, axis.values.iter().copied(), true);
        let edges = cuts.into_iter().map(|cut| ruler.at(from(cut)).unwrap_or(0.0)).collect();
        Self { axis, ruler, edges }
    }

    /// Places of labels, 0 to 1, with the labels; some have none.
    pub fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        if self.axis.names.is_empty() {
            return self.ruler.ticks(most).into_iter().map(|tick| (tick.at, tick.label)).collect();
        }
        let every = self.axis.names.len().div_ceil(most.max(1));
        let middle = |k: usize| 0.5 * (self.edges[k] + self.edges[k + 1]);
        let named = self.axis.names.iter().enumerate().step_by(every.max(1));
        named.filter(|(k, _)| k + 1 < self.edges.len()).map(|(k, name)| (middle(k), name.clone())).collect()
    }
}

impl Default for HeatMap {
    fn default() -> Self {
        Self {
            title: String::new(),
            across: MapAxis::default(),
            up: MapAxis::default(),
            cells: vec![],
            label: String::new(),
            scale: Scale::Linear,
            range: None,
            reversed: false,
            lines: vec![],
            width: 85.0,
        }
    }
}

impl HeatMap {
    /// The map as SVG.
    pub fn svg(&self) -> String {
        let sheet = points(self.width);
        let (across, up) = (MapSide::new(&self.across), MapSide::new(&self.up));
        let bar = self.bar();
        let up_ticks = up.ticks(8);
        let bar_ticks = bar.ticks(6);
        let widest = |labels: &mut dyn Iterator<Item = &str>| {
            labels.map(|label| width(label, SMALL)).fold(0.0, f64::max)
        };
        let left = MARGIN + widest(&mut up_ticks.iter().map(|(_, label)| label.as_str())) + TICK + 2.0;
        let right = widest(&mut bar_ticks.iter().map(|tick| tick.label.as_str())) + TICK + 3.0;
        let wide = (sheet - left - GAP - BAR - right - MARGIN).max(20.0);
        let high = SHAPE * wide;
        let mut svg = Svg::default();
        let keys: Vec<Key> = self
            .lines
            .iter()
            .filter(|line| !line.name.is_empty())
            .map(|line| Key {
                name: line.name.clone(),
                stroke: line.stroke,
                colour: Some(INK),
                ..Key::default()
            })
            .collect();
        let under = heading(&mut svg, &self.title, &keys, MARGIN, sheet);
        let head = under + SMALL + 4.0;
        svg.text([MARGIN, head], &self.up.label, Anchor::Start, "");
        svg.text([sheet - MARGIN, head], &self.label, Anchor::End, "");
        let top = head + 5.0;
        self.cells(&mut svg, [&across, &up], &bar, [left, top, wide, high]);
        for (at, label) in up_ticks {
            let y = top + (1.0 - at) * high;
            let long = if label.is_empty() { 0.5 * TICK } else { TICK };
            svg.line([left - long, y], [left, y], THIN);
            svg.text([left - TICK - 2.0, y + 2.5], &label, Anchor::End, "");
        }
        for (at, label) in across.ticks((wide / 26.0) as usize) {
            let x = left + at * wide;
            let long = if label.is_empty() { 0.5 * TICK } else { TICK };
            svg.line([x, top + high], [x, top + high + long], THIN);
            svg.text([x, top + high + TICK + 7.5], &label, Anchor::Middle, "");
        }
        svg.rect([left, top], [wide, high], THIN);
        self.draw_lines(&mut svg, [&across, &up], [left, top, wide, high]);
        self.draw_bar(&mut svg, &bar, [left + wide + GAP, top, BAR, high]);
        svg.text([left + 0.5 * wide, top + high + FOOT - 4.0], &self.across.label, Anchor::Middle, "");
        svg.finish(&self.title, [sheet, top + high + FOOT])
    }

    /// The axis of the colours.
    pub fn bar(&self) -> Ruler {
        let finite = || self.cells.iter().copied().filter(|value| value.is_finite());
        let inside = |value: &f64| self.scale == Scale::Linear || *value > 0.0;
        let (low, high) = finite()
            .filter(inside)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        let seen = if low < high { Some([low, high]) } else { None };
        let axis = Axis { scale: self.scale, range: self.range.or(seen), ..Axis::default() };
        Ruler::new(&axis, finite(), false)
    }

    /// The colour at a place of the bar, 0 to 1.
    pub fn colour_at(&self, at: f64) -> Rgb {
        viridis(if self.reversed { 1.0 - at } else { at })
    }

    fn colour(&self, at: f64) -> String {
        let [r, g, b] = self.colour_at(at).map(|channel| (channel * 255.0).round() as u8);
        format!("#{r:02x}{g:02x}{b:02x}")
    }

    fn cells(
        &self,
        svg: &mut Svg,
        [across, up]: [&MapSide<'_>; 2],
        bar: &Ruler,
        [left, top, wide, high]: [f64; 4],
    ) {
        for (row, y) in up.edges.windows(2).enumerate() {
            for (column, x) in across.edges.windows(2).enumerate() {
                let value =
                    self.cells.get(row * self.across.values.len() + column).copied().unwrap_or(f64::NAN);
                let fill = bar.at(value).filter(|_| value.is_finite()).map(|at| self.colour(at));
                let corner = [left + x[0] * wide, top + (1.0 - y[1]) * high];
                let size = [(x[1] - x[0]) * wide, (y[1] - y[0]) * high];
                let fill = fill.unwrap_or_else(|| NONE.to_owned());
                // No seam shows between neighbours.
                svg.rect(corner, size, &format!("fill=\"{fill}\" shape-rendering=\"crispEdges\""));
                if fill == NONE {
                    let [x, y] = [corner[0] + 0.5 * size[0], corner[1] + 0.5 * size[1]];
                    let arm = 1.4_f64.min(0.3 * size[0]).min(0.3 * size[1]);
                    let grey = format!("stroke=\"{GREY}\" stroke-width=\"0.5\"");
                    svg.line([x - arm, y - arm], [x + arm, y + arm], &grey);
                    svg.line([x - arm, y + arm], [x + arm, y - arm], &grey);
                }
            }
        }
    }

    fn draw_lines(&self, svg: &mut Svg, [across, up]: [&MapSide<'_>; 2], [left, top, wide, high]: [f64; 4]) {
        for line in &self.lines {
            let dashes = match line.stroke {
                Stroke::Dashed => " stroke-dasharray=\"4 2.4\"",
                Stroke::Dotted => " stroke-dasharray=\"0.8 1.8\"",
                Stroke::DashDotted => " stroke-dasharray=\"5 2 0.8 2\"",
                _ => "",
            };
            let place = |[x, y]: &[f64; 2]| {
                let (x, y) = (across.ruler.at(*x)?, up.ruler.at(*y)?);
                // The frame itself is inside, rounding or not.
                let inside = [x, y].iter().all(|at| (-1e-9..=1.0 + 1e-9).contains(at));
                inside.then_some([left + x * wide, top + (1.0 - y) * high])
            };
            for [from, towards] in &line.ticks {
                let (Some([x, y]), Some([to_x, to_y])) = (place(from), place(towards)) else { continue };
                let share = SIDE / math::hypot(to_x - x, to_y - y).max(SIDE);
                let end = [x + share * (to_x - x), y + share * (to_y - y)];
                svg.line([x, y], end, "stroke=\"#fff\" stroke-width=\"2.4\"");
                svg.line([x, y], end, "stroke=\"#1e1e22\" stroke-width=\"0.9\"");
            }
            let places: Vec<Option<[f64; 2]>> = line.points.iter().map(place).collect();
            for stretch in places.split(Option::is_none) {
                let stretch: Vec<[f64; 2]> = stretch.iter().copied().flatten().collect();
                if stretch.len() < 2 {
                    continue;
                }
                let d = polyline(&stretch);
                svg.path(&d, "fill=\"none\" stroke=\"#fff\" stroke-width=\"2.4\" stroke-linejoin=\"round\"");
                let ink = format!(
                    "fill=\"none\" stroke=\"#1e1e22\" stroke-width=\"1.1\" stroke-linejoin=\"round\"{dashes}"
                );
                svg.path(&d, &ink);
            }
        }
    }

    fn draw_bar(&self, svg: &mut Svg, bar: &Ruler, [left, top, wide, high]: [f64; 4]) {
        const STEPS: usize = 64;
        for step in 0..STEPS {
            let [low, up] = [step, step + 1].map(|k| k as f64 / STEPS as f64);
            let fill = format!("fill=\"{}\" shape-rendering=\"crispEdges\"", self.colour(0.5 * (low + up)));
            svg.rect([left, top + (1.0 - up) * high], [wide, (up - low) * high], &fill);
        }
        svg.rect([left, top], [wide, high], THIN);
        for tick in bar.ticks(6) {
            let y = top + (1.0 - tick.at) * high;
            let long = if tick.label.is_empty() { 0.5 * TICK } else { TICK };
            svg.line([left + wide, y], [left + wide + long, y], THIN);
            svg.text([left + wide + TICK + 2.0, y + 2.5], &tick.label, Anchor::Start, "");
        }
    }
}

/// The stroke of frames and ticks.
const THIN: &str = "stroke=\"#1e1e22\" stroke-width=\"0.5\" fill=\"none\"";
/// The fill of a cell without a value.
const NONE: &str = "#f0f0f2";
const INK: Rgb = [0.118, 0.118, 0.133];

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> HeatMap {
        HeatMap {
            across: MapAxis { label: "k".to_owned(), values: vec![1.0, 2.0, 3.0], ..MapAxis::default() },
            up: MapAxis {
                label: "ε (s)".to_owned(),
                scale: Scale::Log,
                values: vec![0.001, 0.01],
                ..MapAxis::default()
            },
            cells: vec![0.0, 0.5, 1.0, 0.25, f64::NAN, 0.75],
            range: Some([0.0, 1.0]),
            ..HeatMap::default()
        }
    }

    fn fills(svg: &str) -> Vec<&str> {
        svg.lines()
            .filter(|line| line.starts_with("<rect") && line.contains("fill=\"#") && !line.contains("100%"))
            .filter_map(|line| line.split("fill=\"").nth(1)?.split('"').next())
            .collect()
    }

    #[test]
    fn cells_have_the_colours_of_their_values() {
        let svg = map().svg();
        let fills = fills(&svg);
        assert_eq!(fills[..6], ["#440154", "#21918d", "#fde725", "#3b528b", NONE, "#5ec962"]);
        let turned = HeatMap { reversed: true, ..map() }.svg();
        assert!(turned.find("#fde725") < turned.find("#440154"));
    }

    #[test]
    fn sides_are_cut_between_values() {
        let side = map().across;
        let laid = MapSide::new(&side);
        assert!(laid.edges.iter().zip([0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0]).all(|(a, b)| (a - b).abs() < 1e-12));
        let side = map().up;
        assert!((MapSide::new(&side).edges[1] - 0.5).abs() < 1e-12);
    }

    #[test]
    fn one_cell_names_and_nothing_are_drawn_too() {
        let one = MapAxis { values: vec![2.0], ..MapAxis::default() };
        let named = MapAxis {
            values: vec![0.0, 1.0],
            names: vec!["car".into(), "unicycle".into()],
            ..MapAxis::default()
        };
        let svg =
            HeatMap { across: one.clone(), up: named, cells: vec![1.0, 2.0], ..HeatMap::default() }.svg();
        assert!(svg.contains(">unicycle<") && fills(&svg).len() > 2);
        assert!(HeatMap::default().svg().contains("</svg>"));
        let line =
            MapLine { name: "edge".into(), points: vec![[1.0, 0.001], [3.0, 0.01]], ..MapLine::default() };
        assert!(HeatMap { lines: vec![line], ..map() }.svg().contains(">edge<"));
    }
}
