//! The charts in the corner: distance and bearing error of each edge over the whole run so far.

use crate::annotation::labels::{Ink, LabelPlacer, MARGIN};
use crate::camera::viewpoint::Tile;
use crate::palette::with_alpha;
use crate::picture_context::PictureContext;
use crate::picture_plan::{Area, overlap};
use glam::Vec2;
use vocabulary::round_step;

/// Sizes of the panel at scale 1, pixels: with numbers beside its charts, and where there is little room with the numbers
/// in the titles.
const LARGE: [f32; 2] = [320.0, 170.0];
const SMALL: [f32; 2] = [200.0, 106.0];

/// What one chart shows, by its index in an error.
#[derive(Debug, Clone, Copy)]
struct ChartedError {
    index: usize,
    title: &'static str,
    unit: &'static str,
    /// Shown units in one of the error's.
    factor: f32,
    /// Smallest range, in shown units: below, noise would fill the chart.
    least: f32,
    /// Largest range, in shown units.
    most: f32,
}

const QUANTITIES: [ChartedError; 2] = [
    ChartedError { index: 0, title: "distance error", unit: " m", factor: 1.0, least: 0.02, most: f32::MAX },
    ChartedError {
        index: 1,
        title: "bearing error",
        unit: "°",
        factor: 180.0 / std::f32::consts::PI,
        least: 1.0,
        most: 180.0,
    },
];

/// Where the panel is in a tile; nothing where it would fill the tile.
pub(crate) fn panel(words: &LabelPlacer<'_>, tile: Tile) -> Option<Area> {
    let margin = words.scaled(MARGIN);
    let (wide, high) = (tile.width as f32, tile.height as f32);
    let place = |[width, height]: [f32; 2], most: f32| {
        let [width, height] = [width, height].map(|side| words.scaled(side));
        let fits = width + margin <= 0.66 * wide && height + margin <= most * high;
        let (x, y) = (tile.x as f32 + wide - margin - width, tile.y as f32 + high - margin - height);
        fits.then_some([x, y, width, height])
    };
    place(LARGE, 0.3).or_else(|| place(SMALL, 0.36))
}

/// Maps time and error, in shown units, to pixels.
struct Axes {
    left: f32,
    right: f32,
    top: f32,
    zero: f32,
    bottom: f32,
    /// Pixels a unit.
    unit: f32,
    duration: f32,
    /// Opacity of all of it.
    clear: f32,
}

impl Axes {
    fn at(&self, time: f64, error: f32) -> Vec2 {
        let share = (time as f32 / self.duration).clamp(0.0, 1.0);
        let height = (self.zero - error * self.unit).clamp(self.top, self.bottom);
        Vec2::new(self.left + share * (self.right - self.left), height)
    }
}

/// Nearer to a robot than this the panel fades, and is gone before it covers it; at scale 1, pixels.
const NEAR: f32 = 12.0;

/// How much of a panel shows that shall hide none of `robots`: it fades where one comes near.
pub(crate) fn clearness(words: &LabelPlacer<'_>, panel: &Area, robots: &[Area]) -> f32 {
    let near = words.scaled(NEAR);
    let gap = |robot: &Area| {
        let aside = |k: usize| (robot[k] - panel[k] - panel[k + 2]).max(panel[k] - robot[k] - robot[k + 2]);
        if overlap(robot, panel) { 0.0 } else { aside(0).max(0.0).hypot(aside(1).max(0.0)) }
    };
    let least = robots.iter().map(gap).fold(near, f32::min) / near;
    least * least * (3.0 - 2.0 * least)
}

/// Draws the panel and both charts over one time axis.
pub(crate) fn inset(words: &mut LabelPlacer<'_>, context: &PictureContext<'_>, panel: Area, clear: f32) {
    words.reserve(panel);
    let radius = words.scaled(7.0);
    words.shapes.panel(panel, radius, [0.98, 0.98, 0.97, 0.86 * clear]);
    let ink = Ink::ON_PANEL.faded(clear);
    let [x, y, width, height] = panel;
    let large = width > words.scaled(0.5 * (LARGE[0] + SMALL[0]));
    let duration = context.fleet.duration.max(context.record.snapshot.time).max(1e-3) as f32;
    let aside = if large { 50.0 } else { 10.0 };
    let (left, right) = (x + words.scaled(aside), x + width - words.scaled(if large { 14.0 } else { 10.0 }));
    let (rows, tall) = if large { ([24.0, 95.0], 50.0) } else { ([20.0, 62.0], 22.0) };
    for (quantity, row) in QUANTITIES.iter().zip(rows) {
        let limit = (round_step(f64::from(largest(context, quantity)), 0.001) as f32).min(quantity.most);
        let (top, high) = (y + words.scaled(row), words.scaled(tall));
        let axes = Axes {
            left,
            right,
            top,
            zero: top + 0.5 * high,
            bottom: top + high,
            unit: 0.5 * high / limit,
            duration,
            clear,
        };
        frame(words, &axes, quantity, limit, large);
        curves(words, context, &axes, quantity);
    }
    let size = if large { 11.0 } else { 12.0 };
    let under = y + height - words.scaled(if large { 12.0 } else { 9.0 });
    words.write("0".into(), [left, under], size, false, ink);
    let text = format!("{} s", (duration * 10.0).round() / 10.0);
    let width = words.width(&text, size, false);
    words.write(text, [right - width, under], size, false, ink);
}

/// The largest error so far, in shown units.
fn largest(context: &PictureContext<'_>, quantity: &ChartedError) -> f32 {
    let now = context.record.edges.iter().map(|e| e.error[quantity.index] as f32);
    let past = context.trail.errors.entries.iter().flat_map(|(_, e)| e.iter()).map(|e| e[quantity.index]);
    let sizes = past.chain(now).map(|e| e.abs() * quantity.factor).filter(|e| e.is_finite());
    sizes.fold(quantity.least, f32::max)
}

fn frame(words: &mut LabelPlacer<'_>, axes: &Axes, quantity: &ChartedError, limit: f32, large: bool) {
    let thin = words.scaled(1.0);
    let ink = |alpha: f32| [0.07, 0.09, 0.11, alpha * axes.clear];
    for (height, alpha) in [(axes.top, 0.15), (axes.zero, 0.55), (axes.bottom, 0.15)] {
        let height = height.round() + 0.5;
        words.shapes.line(Vec2::new(axes.left, height), Vec2::new(axes.right, height), thin, ink(alpha));
    }
    // Small distances read better in centimetres.
    let (shown, unit) =
        if quantity.index == 0 && limit < 0.1 { (limit * 100.0, " cm") } else { (limit, quantity.unit) };
    let shown = (shown * 1e3).round() / 1e3;
    let ink = Ink::ON_PANEL.faded(axes.clear);
    if !large {
        let title = [axes.left, axes.top - words.scaled(9.0)];
        words.write(quantity.title.into(), title, 12.0, true, ink);
        let text = format!("±{shown}{unit}");
        let width = words.width(&text, 12.0, false);
        words.write(text, [axes.right - width, title[1]], 12.0, false, ink);
        return;
    }
    // Right of the numbers, which reach down to the next title.
    let title = [axes.left, axes.top - words.scaled(11.0)];
    words.write(quantity.title.into(), title, 11.0, true, ink);
    let rows = [
        (format!("{shown}{unit}"), axes.top),
        ("0".into(), axes.zero),
        (format!("\u{2212}{shown}{unit}"), axes.bottom),
    ];
    for (text, height) in rows {
        let width = words.width(&text, 11.0, false);
        words.write(text, [axes.left - width - words.scaled(5.0), height], 11.0, false, ink);
    }
}

fn curves(words: &mut LabelPlacer<'_>, context: &PictureContext<'_>, axes: &Axes, quantity: &ChartedError) {
    let now = context.record.snapshot.time;
    let wide = words.scaled(if context.fleet.edges.len() > 12 { 1.0 } else { 1.6 });
    let pick = |error: f32| error * quantity.factor;
    for (index, edge) in context.fleet.edges.iter().enumerate() {
        // A little darker than on the ground: the panel is bright.
        let colour = context.colours[edge.follower].map(|c| c * 0.86);
        let last = context.record.edges.get(index).map(|e| (now, pick(e.error[quantity.index] as f32)));
        let last = last.filter(|_| context.record.edge(context.fleet, index).is_some());
        let past = context.trail.errors.entries.iter();
        let past = past.filter_map(|(t, e)| e.get(index).map(|e| (*t, pick(e[quantity.index]))));
        let points = past.filter(|(t, _)| *t < now).chain(last).filter(|(_, e)| e.is_finite());
        let places = points.map(|(time, error)| (axes.at(time, error), error));
        // A bearing that goes through ±180° goes round, not through zero.
        let joins = |from: f32, to: f32| quantity.unit != "°" || (from - to).abs() <= 180.0;
        let dot = words.scaled(2.5);
        words.shapes.curve(places, joins, wide, dot, with_alpha(colour, 0.95 * axes.clear));
    }
}
