//! What films add to pictures: cards, a line at the bottom, plots beside the view.

use crate::annotation::labels::{Ink, LabelPlacer};
use crate::annotation::text_shaper::{Block, Measure, line_height};
use crate::palette::{self, Rgb, with_alpha};
use crate::picture_plan::Area;
use glam::Vec2;
use vocabulary::math;
use vocabulary::round_step;

/// What is shown over and beside the views of a picture.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlays {
    /// Large words over a darkened picture.
    pub card: Option<Card>,
    /// Words at the bottom of the views.
    pub line: Option<Subtitle>,
    /// Plots beside the views, or below them where the picture is higher than wide; from top to bottom.
    pub plots: Vec<CurvePanel>,
    /// What cameras leave room for though this picture may not have it.
    pub room: ReservedSpace,
}

/// What other pictures of a film have, so that a camera does not move where it comes or goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReservedSpace {
    /// The chart of errors.
    pub panel: bool,
    /// Rows of the line at the bottom.
    pub rows: usize,
}

/// Large words over a darkened picture.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Card {
    /// The first row, large.
    pub title: String,
    /// The rows below it.
    pub rows: Vec<String>,
    /// 0 is not there, 1 is all there.
    pub opacity: f64,
}

/// Words at the bottom of the views.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Subtitle {
    /// Rows, the first uppermost.
    pub rows: Vec<String>,
    /// 0 is not there, 1 is all there.
    pub opacity: f64,
}

/// Curves over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CurvePanel {
    /// Quantity and unit.
    pub label: String,
    /// Time from its left to its right end, s.
    pub span: [f64; 2],
    /// The smallest range that is shown, in the unit of the values: below, noise would fill the plot.
    pub least: f64,
    /// Whether zero stands in the middle.
    pub centred: bool,
    /// The curves.
    pub curves: Vec<PanelCurve>,
}

/// A curve of one robot.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PanelCurve {
    /// Its robot, by its index: the curve has its colour.
    pub robot: usize,
    /// [time in s, value], in the order of time.
    pub points: Vec<[f64; 2]>,
}

/// Share of the picture's width, or of its height where it is higher than wide, that plots take.
const BESIDE: f64 = 0.30;
const BELOW: f64 = 0.34;

impl Overlays {
    /// Width and height that are left for the views of a picture, pixels; even, as they were.
    pub(crate) fn left_over(&self, [width, height]: [u32; 2]) -> [u32; 2] {
        let keep = |side: u32, share: f64| ((f64::from(side) * (1.0 - share)).round() as u32 & !1).max(16);
        match (self.plots.is_empty(), height > width) {
            (true, _) => [width, height],
            (false, false) => [keep(width, BESIDE), height],
            (false, true) => [width, keep(height, BELOW)],
        }
    }
}

/// Plots and line, in front of the views, and the card in front of all.
pub(crate) fn show(
    words: &mut LabelPlacer<'_>,
    show: &Overlays,
    colours: &[Rgb],
    views: [u32; 2],
    picture: [u32; 2],
) {
    let [width, height] = picture.map(|side| side as f32);
    let beside = views.map(|side| side as f32);
    if !show.plots.is_empty() {
        let [right, bottom] = beside;
        let area = if views[0] < picture[0] {
            [right, 0.0, width - right, height]
        } else {
            [0.0, bottom, width, height - bottom]
        };
        plots(words, &show.plots, colours, area);
    }
    if let Some(said) = show.line.as_ref().filter(|line| line.opacity > 0.0) {
        line(words, said, beside);
    }
    if let Some(shown) = show.card.as_ref().filter(|card| card.opacity > 0.0) {
        card(words, shown, [width, height]);
    }
}

fn plots(
    words: &mut LabelPlacer<'_>,
    plots: &[CurvePanel],
    colours: &[Rgb],
    [x, y, width, height]: [f32; 4],
) {
    words.shapes.panel([x, y, width, height], 0.0, with_alpha(palette::PAPER, 1.0));
    let margin = words.scaled(20.0);
    let each = (height - margin) / plots.len() as f32;
    for (k, plot) in plots.iter().enumerate() {
        let area = [x + margin, y + margin + each * k as f32, width - 2.0 * margin, each - margin];
        one_plot(words, plot, colours, area, k + 1 == plots.len());
    }
}

fn one_plot(
    words: &mut LabelPlacer<'_>,
    plot: &CurvePanel,
    colours: &[Rgb],
    [x, y, width, height]: [f32; 4],
    timed: bool,
) {
    let row = words.scaled(22.0);
    words.write(plot.label.clone(), [x, y + 0.4 * row], 14.0, true, Ink::ON_PANEL);
    let range = range(plot);
    // A number has to have room above and below it.
    let rows = ((height - 2.0 * row) / words.scaled(26.0)).clamp(1.0, 4.5);
    let ticks = ticks(range, f64::from(rows));
    let texts: Vec<(f64, String)> = ticks.iter().map(|t| (*t, number(*t, range))).collect();
    let mut wide = 0.0_f32;
    for (_, text) in &texts {
        wide = wide.max(words.width(text, 12.0, false));
    }
    let (left, right) = (x + wide + words.scaled(8.0), x + width);
    let (top, bottom) = (y + row + words.scaled(4.0), y + height - if timed { row } else { 0.3 * row });
    let span = (plot.span[1] - plot.span[0]).max(1e-9);
    let across = |time: f64| left + ((time - plot.span[0]) / span).clamp(0.0, 1.0) as f32 * (right - left);
    let up = |value: f64| {
        bottom - ((value - range[0]) / (range[1] - range[0])).clamp(0.0, 1.0) as f32 * (bottom - top)
    };
    let thin = words.scaled(1.0);
    for (value, text) in texts {
        let level = up(value).round() + 0.5;
        let alpha = if value == 0.0 { 0.5 } else { 0.13 };
        words.shapes.line(
            Vec2::new(left, level),
            Vec2::new(right, level),
            thin,
            with_alpha(palette::INK, alpha),
        );
        let width = words.width(&text, 12.0, false);
        words.write(text, [left - width - words.scaled(6.0), level], 12.0, false, Ink::ON_PANEL);
    }
    if timed {
        let under = bottom + 0.6 * row;
        let ends = [(plot.span[0], 0.0), (plot.span[1], 1.0)];
        for (time, share) in ends {
            let text = format!("{} s", (time * 10.0).round() / 10.0);
            let width = words.width(&text, 12.0, false);
            words.write(text, [across(time) - share * width, under], 12.0, false, Ink::ON_PANEL);
        }
    }
    let wide = words.scaled(if plot.curves.len() > 12 { 1.2 } else { 2.2 });
    for curve in &plot.curves {
        // A little darker than on the ground: the panel is bright.
        let colour = colours.get(curve.robot).copied().unwrap_or(palette::INK).map(|c| c * 0.86);
        let points = curve.points.iter().filter(|[_, value]| value.is_finite());
        let places = points.map(|[time, value]| (Vec2::new(across(*time), up(*value)), *value as f32));
        let dot = words.scaled(3.5);
        words.shapes.curve(places, |_, _| true, wide, dot, with_alpha(colour, 0.95));
    }
}

/// The range that a plot shows: round, over all its values.
fn range(plot: &CurvePanel) -> [f64; 2] {
    let values = plot.curves.iter().flat_map(|c| &c.points).map(|p| p[1]).filter(|v| v.is_finite());
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if plot.centred || low > high {
        let most = if low > high { plot.least } else { low.abs().max(high.abs()).max(plot.least) };
        let most = round_step(most, 0.001);
        return [-most, most];
    }
    let middle = f64::midpoint(low, high);
    let half = (0.55 * (high - low)).max(0.5 * plot.least);
    let step = round_step(half, 0.001) / 2.0;
    [((middle - half) / step).floor() * step, ((middle + half) / step).ceil() * step]
}

fn ticks([low, high]: [f64; 2], rows: f64) -> Vec<f64> {
    let step = round_step((high - low) / rows, 0.001);
    let first = (low / step).ceil() as i64;
    let last = (high / step * (1.0 + 1e-12)).floor() as i64;
    (first..=last).take(12).map(|k| k as f64 * step).collect()
}

/// A tick in as many digits as the range needs.
fn number(value: f64, [low, high]: [f64; 2]) -> String {
    let digits = (1.0 - math::log10(high - low).floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.digits$}");
    let text =
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text };
    if text == "-0" { "0".to_owned() } else { text.replace('-', "\u{2212}") }
}

/// Size of the letters of a line at the bottom, at scale 1, pixels; and most lines of a row of it.
const LINE: f32 = 17.0;
const LINE_ROWS: usize = 2;

/// What the rows of a line at the bottom take, the room of each, and the size of its letters.
fn line_rows(words: &mut LabelPlacer<'_>, said: &Subtitle, width: f32) -> (Vec<Measure>, Block, f32) {
    let most = 0.9 * width;
    let widest = said.rows.iter().map(|row| words.width(row, LINE, true)).fold(1.0_f32, f32::max);
    // A little too long, it is smaller; much too long, it wraps.
    let size = LINE * (0.995 * most / widest).clamp(0.75, 1.0);
    let block = Block { width: most, rows: LINE_ROWS, centred: false };
    let rows = said.rows.iter().map(|row| words.measure(row, size, true, Some(block)));
    (rows.collect(), block, size)
}

/// The panel behind `rows` lines of a line at the bottom, `wide` pixels across.
fn line_panel(words: &LabelPlacer<'_>, [width, height]: [f32; 2], wide: f32, rows: usize) -> Area {
    let pad = words.scaled(12.0);
    let high = words.scaled(1.45 * LINE) * rows as f32 + pad;
    // Clear of the clock in the corner.
    let bottom = height - words.scaled(62.0);
    [0.5 * (width - wide) - pad, bottom - high, wide + 2.0 * pad, high]
}

/// Where a line at the bottom is.
pub(crate) fn line_place(words: &mut LabelPlacer<'_>, said: &Subtitle, views: [f32; 2]) -> Area {
    let (rows, ..) = line_rows(words, said, views[0]);
    let wide = rows.iter().map(|row| row.width).fold(1.0, f32::max);
    line_panel(words, views, wide, rows.iter().map(|row| row.rows).sum())
}

/// Where a line at the bottom is or may come to be in the film.
pub(crate) fn line_room(words: &mut LabelPlacer<'_>, show: &Overlays, views: [f32; 2]) -> Option<Area> {
    let said = show.line.as_ref().map(|said| line_place(words, said, views));
    let kept = (show.room.rows > 0).then(|| line_panel(words, views, 0.9 * views[0], show.room.rows));
    match (said, kept) {
        (Some(said), Some(kept)) => {
            let top = said[1].min(kept[1]);
            Some([kept[0], top, kept[2], kept[1] + kept[3] - top])
        }
        (said, kept) => said.or(kept),
    }
}

fn line(words: &mut LabelPlacer<'_>, said: &Subtitle, views: [f32; 2]) {
    let alpha = said.opacity as f32;
    let (rows, block, size) = line_rows(words, said, views[0]);
    let place = line_place(words, said, views);
    let (radius, row, pad) = (words.scaled(8.0), words.scaled(1.45 * LINE), words.scaled(12.0));
    words.shapes.panel(place, radius, with_alpha(palette::INK, 0.72 * alpha));
    let ink = Ink { halo: (0.0, palette::INK), ..Ink::LIGHT }.faded(alpha);
    let mut down = place[1] + 0.5 * pad;
    for (text, row_size) in said.rows.iter().zip(rows) {
        let left = 0.5 * (views[0] - row_size.width);
        words.write_block(text.clone(), [left, down + 0.5 * row], size, true, ink, Some(block));
        down += row * row_size.rows as f32;
    }
}

/// Sizes of a card's title and of its rows at scale 1, pixels; and most lines of each.
const CARD: [(f32, usize); 2] = [(40.0, 2), (20.0, 3)];
/// A row of a card is not wider than this at scale 1, pixels: longer ones are hard to read.
const CARD_WIDTH: f32 = 800.0;

fn card(words: &mut LabelPlacer<'_>, shown: &Card, [width, height]: [f32; 2]) {
    let alpha = shown.opacity as f32;
    // What is written below the card is not to be read through it.
    for said in &mut words.lines {
        said.alpha *= 1.0 - 0.96 * alpha;
    }
    words.shapes.panel([0.0, 0.0, width, height], 0.0, with_alpha(palette::INK, 0.78 * alpha));
    let [(large, title_rows), (small, rows)] = CARD;
    // Where it is a little too long for the picture, in smaller letters; then in several lines.
    let most = 0.86 * width;
    let fit = most / words.width(&shown.title, large, true).max(1.0);
    let large = large * (0.995 * fit).clamp(0.6, 1.0);
    let narrow = most.min(words.scaled(CARD_WIDTH));
    let widest = shown.rows.iter().map(|row| words.width(row, small, false)).fold(1.0_f32, f32::max);
    let fit = 0.995 * narrow / widest;
    let small = if fit >= 0.75 { small * fit.min(1.0) } else { small };
    let block = |width: f32, rows: usize| Block { width, rows, centred: true };
    let texts = std::iter::once((&shown.title, large, true, block(most, title_rows)))
        .chain(shown.rows.iter().map(|row| (row, small, false, block(narrow, rows))));
    let texts: Vec<_> = texts
        .map(|(text, size, bold, block)| {
            let lines = words.measure(text, size, bold, Some(block)).rows;
            // Between lines of one text is less than between texts.
            let line = line_height(words.scaled(size));
            (text, size, bold, block, line, line * lines as f32 + words.scaled(0.4 * size))
        })
        .collect();
    let whole: f32 = texts.iter().map(|text| text.5).sum();
    let mut down = (0.46 * height - 0.5 * whole).max(0.0);
    let ink = Ink { halo: (0.0, palette::INK), ..Ink::LIGHT }.faded(alpha);
    for (text, size, bold, block, line, high) in texts {
        let left = 0.5 * (width - block.width);
        words.write_block(text.clone(), [left, down + 0.5 * line], size, bold, ink, Some(block));
        down += high;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plots_take_a_side_and_leave_even_sizes() {
        let show = Overlays { plots: vec![CurvePanel::default()], ..Overlays::default() };
        assert_eq!(Overlays::default().left_over([1280, 720]), [1280, 720]);
        assert_eq!(show.left_over([1280, 720]), [896, 720]);
        let [width, height] = show.left_over([1080, 1920]);
        assert!(width == 1080 && height % 2 == 0 && height < 1300);
    }

    #[test]
    fn ranges_are_round_and_hold_every_value() {
        let plot = |values: &[f64], centred: bool| CurvePanel {
            centred,
            least: 0.02,
            curves: vec![PanelCurve { robot: 0, points: values.iter().map(|v| [0.0, *v]).collect() }],
            ..CurvePanel::default()
        };
        assert_eq!(range(&plot(&[0.001, -0.003], true)), [-0.02, 0.02]);
        assert_eq!(range(&plot(&[0.3, -0.1], true)), [-0.5, 0.5]);
        let [low, high] = range(&plot(&[0.72, 1.49], false));
        assert!(low <= 0.72 && high >= 1.49 && high - low < 2.0, "{low} {high}");
        assert_eq!(number(-0.5, [-0.5, 0.5]), "\u{2212}0.5");
        assert_eq!(ticks([0.0, 2.0], 4.5), [0.0, 0.5, 1.0, 1.5, 2.0]);
        assert_eq!(ticks([-10.0, 10.0], 2.0), [-10.0, 0.0, 10.0]);
    }
}
