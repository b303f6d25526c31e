//! A figure, laid out and drawn.

use crate::axis::{CUT, Ruler, Tick};
use crate::place::spread;
use crate::svg::{Anchor, Svg, ink, point, polyline, width};
use crate::trim::{thinned, within};
use crate::{Axis, Figure, Guide, Key, Marker, Panel, Series, Stroke};

/// Sizes of text, points of print.
pub(crate) const SMALL: f64 = 7.0;
const TITLE: f64 = 8.5;
/// From one line of small text to the next.
const LINE: f64 = 8.6;
/// Over a panel: its label, and air.
const HEAD: f64 = 18.5;
/// What of it is not needed over a first panel with nothing above.
pub(crate) const BARE: f64 = 6.5;
/// Under the last panel: ticks' labels and the axis' own.
const FOOT: f64 = 23.0;
pub(crate) const MARGIN: f64 = 4.0;
pub(crate) const TICK: f64 = 2.6;
pub(crate) const GREY: &str = "#6b6f76";

/// A panel's place on the sheet.
struct PanelArea {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl PanelArea {
    fn x(&self, share: f64) -> f64 {
        self.left + share * self.width
    }

    fn y(&self, share: f64) -> f64 {
        self.top + (1.0 - share) * self.height
    }

    fn right(&self) -> f64 {
        self.left + self.width
    }

    fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

pub(crate) fn draw(figure: &Figure) -> String {
    let (sheet, height) = (points(figure.width), points(figure.height));
    let rulers: Vec<Ruler> = figure.panels.iter().map(|p| Ruler::new(&p.axis, ordinates(p), false)).collect();
    let most = ((height / 11.0) as usize).max(2);
    let ticks: Vec<Vec<Tick>> = rulers.iter().map(|r| r.ticks(most)).collect();
    let labels = ticks.iter().flatten().map(|t| width(&t.label, SMALL)).fold(0.0, f64::max);
    let left = MARGIN + labels + TICK + 2.0;
    let named = figure.panels.iter().flat_map(|p| &p.series).filter(|s| !s.name.is_empty());
    let names = named.map(|s| width(&s.name, SMALL) + 6.0).fold(6.0, f64::max).min(0.35 * sheet);
    let along = (sheet - left - names - MARGIN).max(20.0);
    let columns = columns(figure, left, along);

    let mut svg = Svg::default();
    // Without a title, the first panel's label is the first line.
    let mut top = if figure.title.is_empty() && figure.keys.is_empty() { MARGIN - BARE } else { MARGIN };
    top = heading(&mut svg, &figure.title, &figure.keys, top, sheet);
    for (index, panel) in figure.panels.iter().enumerate() {
        let last = index + 1 == figure.panels.len();
        top += HEAD;
        svg.text([MARGIN, top - 5.0], &panel.axis.label, Anchor::Start, "");
        for (number, (across, left, width)) in columns.iter().enumerate() {
            let area = PanelArea { left: *left, top, width: *width, height };
            let (rulers, outermost) = ([across, &rulers[index]], number + 1 == columns.len());
            if let Some(zoom) = figure.zoom.filter(|_| outermost) {
                shade(&mut svg, &area, across, zoom);
            }
            frame(&mut svg, &area, across, &ticks[index], last, number == 0);
            guides(&mut svg, panel, &area, rulers, false);
            let ends: Vec<_> = panel.series.iter().map(|s| series(&mut svg, s, &area, rulers)).collect();
            if ends.iter().all(Option::is_none) {
                let middle = [area.x(0.5), area.y(0.5) + 2.5];
                svg.text(middle, "no data", Anchor::Middle, &format!("fill=\"{GREY}\""));
            }
            if outermost {
                guides(&mut svg, panel, &area, rulers, true);
                names_at(&mut svg, &panel.series, &ends, &area);
            }
        }
        top += height;
    }
    svg.text([left + 0.5 * along, top + FOOT - 4.0], &figure.axis.label, Anchor::Middle, "");
    svg.finish(&figure.title, [sheet, top + FOOT])
}

/// Share of a panel for its magnified part, and the gap to the rest, points.
const MAGNIFIED: f64 = 0.4;
const GAP: f64 = 17.0;

/// The horizontal axes beside each other, each with its left end and its width.
fn columns(figure: &Figure, left: f64, along: f64) -> Vec<(Ruler, f64, f64)> {
    let across = Ruler::new(&figure.axis, figure.panels.iter().flat_map(abscissae), true);
    let Some(zoom) = figure.zoom else { return vec![(across, left, along)] };
    let axis = Axis { range: Some(zoom), ..figure.axis.clone() };
    let first = MAGNIFIED * (along - GAP);
    let magnified = Ruler::new(&axis, std::iter::empty(), true);
    vec![(magnified, left, first), (across, left + first + GAP, along - GAP - first)]
}

/// The part of the axis that is magnified elsewhere.
fn shade(svg: &mut Svg, area: &PanelArea, across: &Ruler, zoom: [f64; 2]) {
    let [from, to] = zoom.map(|x| across.at(x).map_or(0.0, |at| area.x(at.clamp(0.0, 1.0))));
    svg.rect([from, area.top], [to - from, area.height], "fill=\"#0072b2\" fill-opacity=\"0.12\"");
}

fn abscissae(panel: &Panel) -> impl Iterator<Item = f64> {
    let guides = panel.guides.iter().filter_map(|g| match g {
        Guide::Upright(x, _) => Some(*x),
        Guide::Level(..) | Guide::Band(_) => None,
    });
    panel.series.iter().flat_map(|s| s.points.iter().map(|p| p[0])).chain(guides)
}

fn ordinates(panel: &Panel) -> impl Iterator<Item = f64> {
    let guides = panel.guides.iter().flat_map(|g| match g {
        Guide::Upright(..) => vec![],
        Guide::Level(y, _) => vec![*y],
        Guide::Band(ends) => ends.to_vec(),
    });
    panel.series.iter().flat_map(|s| s.points.iter().map(|p| p[1])).chain(guides)
}

/// A length in points of print, within what a sheet can be.
pub(crate) fn points(millimetres: f64) -> f64 {
    let millimetres = if millimetres.is_finite() { millimetres.clamp(5.0, 2000.0) } else { 85.0 };
    millimetres * 72.0 / 25.4
}

/// Title and keys over everything, from `top` on; where they end.
pub(crate) fn heading(svg: &mut Svg, title: &str, entries: &[Key], mut top: f64, sheet: f64) -> f64 {
    for line in wrapped(title, (sheet - 2.0 * MARGIN) / TITLE) {
        top += TITLE + 1.0;
        svg.text([MARGIN, top], &line, Anchor::Start, &format!("font-size=\"{TITLE}\" font-weight=\"600\""));
    }
    keys(svg, entries, [MARGIN, top], sheet)
}

/// A text in lines of at most about `em` times its size.
fn wrapped(text: &str, em: f64) -> Vec<String> {
    let mut lines: Vec<String> = vec![];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line, 1.0) + 0.3 + width(word, 1.0) <= em => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// What strokes and markers stand for, in rows; where they end.
fn keys(svg: &mut Svg, keys: &[Key], [left, top]: [f64; 2], sheet: f64) -> f64 {
    const SAMPLE: f64 = 16.0;
    let (mut x, mut y) = (left, top + if keys.is_empty() { 0.0 } else { LINE + 1.5 });
    for key in keys {
        let wide = SAMPLE + 3.0 + width(&key.name, SMALL) + 8.0;
        if x > left && x + wide > sheet {
            (x, y) = (left, y + LINE);
        }
        let at = y - 2.5;
        let colour = key.colour.map_or_else(|| GREY.to_owned(), ink);
        stroke(svg, &format!("M{}H{:.2}", point([x, at]), x + SAMPLE), key.stroke, &colour, false);
        marker(svg, key.marker, [x + 0.5 * SAMPLE, at], &colour);
        svg.text([x + SAMPLE + 3.0, y], &key.name, Anchor::Start, "");
        x += wide;
    }
    y
}

/// Axes, ticks, and faint lines across from the labelled ones.
fn frame(svg: &mut Svg, area: &PanelArea, across: &Ruler, ticks: &[Tick], last: bool, first: bool) {
    let thin = "stroke=\"#1e1e22\" stroke-width=\"0.5\" fill=\"none\"";
    for tick in ticks {
        let y = area.y(tick.at);
        let long = if tick.label.is_empty() { 0.5 * TICK } else { TICK };
        if !tick.label.is_empty() {
            svg.line([area.left, y], [area.right(), y], "stroke=\"#e3e4e6\" stroke-width=\"0.4\"");
            if first {
                svg.text([area.left - TICK - 2.0, y + 2.5], &tick.label, Anchor::End, "");
            }
        }
        svg.line([area.left - long, y], [area.left, y], thin);
    }
    let room = ((area.width / 26.0) as usize).max(2);
    for tick in across.ticks(room) {
        let x = area.x(tick.at);
        let long = if tick.label.is_empty() { 0.5 * TICK } else { TICK };
        svg.line([x, area.bottom()], [x, area.bottom() + long], thin);
        if last && !tick.label.is_empty() {
            svg.text([x, area.bottom() + TICK + 7.5], &tick.label, Anchor::Middle, "");
        }
    }
    let (left, right, bottom) = (area.left, area.right(), area.bottom());
    svg.line([left, area.top], [left, bottom], thin);
    if across.cut() {
        let cut = area.x(CUT);
        svg.line([left, bottom], [cut - 1.5, bottom], thin);
        svg.line([cut + 1.5, bottom], [right, bottom], thin);
        for x in [cut - 1.5, cut + 1.5] {
            svg.line([x - 1.0, bottom + 2.0], [x + 1.0, bottom - 2.0], thin);
        }
    } else {
        svg.line([left, bottom], [right, bottom], thin);
    }
}

/// Lines and bands, which lie under the curves, or their names, which lie over them.
fn guides(svg: &mut Svg, panel: &Panel, area: &PanelArea, [across, up]: [&Ruler; 2], names: bool) {
    let dashes = format!("stroke=\"{GREY}\" stroke-width=\"0.6\" stroke-dasharray=\"1.2 1.6\"");
    // A halo keeps names readable where curves pass under them.
    let fill = format!("fill=\"{GREY}\" stroke=\"#fff\" stroke-width=\"2\" paint-order=\"stroke\"");
    for guide in &panel.guides {
        match guide {
            Guide::Upright(x, name) => {
                let Some(x) = across.at(*x).map(|at| area.x(at)) else { continue };
                if !names {
                    svg.line([x, area.top], [x, area.bottom()], &dashes);
                    continue;
                }
                let wide = width(name, SMALL);
                let left = x + 2.0 + wide > area.right();
                let anchor = if left { Anchor::End } else { Anchor::Start };
                svg.text([if left { x - 2.0 } else { x + 2.0 }, area.top + 4.0], name, anchor, &fill);
            }
            Guide::Level(y, name) => {
                let Some(y) = up.at(*y).map(|at| area.y(at)) else { continue };
                if names {
                    svg.text([area.right(), y - 2.0], name, Anchor::End, &fill);
                } else {
                    svg.line([area.left, y], [area.right(), y], &dashes);
                }
            }
            Guide::Band(_) if names => {}
            Guide::Band([low, high]) => {
                let (Some(low), Some(high)) = (up.at(*low), up.at(*high)) else { continue };
                let (top, bottom) = (area.y(low.max(high)), area.y(low.min(high)));
                svg.rect([area.left, top], [area.width, bottom - top], "fill=\"#000\" fill-opacity=\"0.07\"");
            }
        }
    }
}

/// Draws a curve; where it ends, if any of it is to be seen.
fn series(svg: &mut Svg, series: &Series, area: &PanelArea, [across, up]: [&Ruler; 2]) -> Option<[f64; 2]> {
    let colour = ink(series.colour);
    let edges = [area.left, area.top, area.right(), area.bottom()];
    let (mut d, mut end, mut run, mut shown) = (String::new(), None, vec![], vec![]);
    let mut finish = |run: &mut Vec<[f64; 2]>| {
        for part in within(run, edges) {
            let part = if series.marker == Marker::None { thinned(&part, 0.03) } else { part };
            d.push_str(&polyline(&part));
            end = part.last().copied().or(end);
        }
        run.clear();
    };
    for [x, y] in &series.points {
        let Some(at) = across.at(*x).zip(up.at(*y)).map(|(x, y)| [area.x(x), area.y(y)]) else {
            finish(&mut run);
            continue;
        };
        // A hundredth of a point of print cannot be seen; long records have many such steps.
        let near = |from: &&[f64; 2]| (from[0] - at[0]).abs() + (from[1] - at[1]).abs() < 0.02;
        if run.last().is_some_and(|from| near(&from)) {
            continue;
        }
        if let Some(from) = run.last().filter(|_| series.stroke == Stroke::Step).copied() {
            run.push([at[0], from[1]]);
        }
        run.push(at);
        if at[0] > edges[0] - 0.1
            && at[0] < edges[2] + 0.1
            && at[1] > edges[1] - 0.1
            && at[1] < edges[3] + 0.1
        {
            shown.push(at);
        }
        if across.apart(*x) {
            finish(&mut run);
        }
    }
    finish(&mut run);
    stroke(svg, &d, series.stroke, &colour, series.faint);
    for at in &shown {
        marker(svg, series.marker, *at, &colour);
    }
    end.or(shown.last().copied())
}

/// Draws a path in one of the strokes.
pub(crate) fn stroke(svg: &mut Svg, d: &str, stroke: Stroke, colour: &str, faint: bool) {
    let dashes = match stroke {
        Stroke::Solid | Stroke::Step => "",
        Stroke::Dashed => " stroke-dasharray=\"3.6 1.8\"",
        Stroke::Dotted => " stroke-dasharray=\"0.1 2.2\" stroke-linecap=\"round\"",
        Stroke::DashDotted => " stroke-dasharray=\"4.5 1.8 0.8 1.8\"",
        Stroke::None => return,
    };
    let width = if faint { "stroke-width=\"0.4\" stroke-opacity=\"0.45\"" } else { "stroke-width=\"1\"" };
    if d.contains(['L', 'H']) {
        svg.path(d, &format!("fill=\"none\" stroke=\"{colour}\" {width} stroke-linejoin=\"round\"{dashes}"));
    }
}

fn marker(svg: &mut Svg, marker: Marker, [x, y]: [f64; 2], colour: &str) {
    let m = point([x, y]);
    let (d, stroke) = match marker {
        Marker::None => return,
        Marker::Disc => (format!("M{m}m-1.6 0a1.6 1.6 0 1 0 3.2 0a1.6 1.6 0 1 0 -3.2 0Z"), None),
        Marker::Square => (format!("M{m}m-1.5 -1.5h3v3h-3Z"), None),
        Marker::Triangle => (format!("M{m}m0 -2l1.9 3.3h-3.8Z"), None),
        Marker::Wedge => (format!("M{m}m0 2l1.9 -3.3h-3.8Z"), None),
        Marker::Plus => (format!("M{m}m-2 0h4m-2 -2v4"), Some(1.0)),
        Marker::Cross => (format!("M{m}m-1.5 -1.5l3 3m-3 0l3 -3"), Some(1.0)),
        Marker::Diamond => (format!("M{m}m0 -3.4l3.4 3.4l-3.4 3.4l-3.4 -3.4Z"), Some(1.1)),
    };
    let paint = match stroke {
        Some(width) => format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\""),
        None => format!("fill=\"{colour}\""),
    };
    svg.path(&d, &paint);
}

/// Names right of the panel, level with where their curves end.
fn names_at(svg: &mut Svg, all: &[Series], ends: &[Option<[f64; 2]>], area: &PanelArea) {
    let named: Vec<(&Series, [f64; 2])> = all
        .iter()
        .zip(ends)
        .filter(|(s, _)| !s.name.is_empty())
        .filter_map(|(s, end)| end.map(|end| (s, end)))
        .collect();
    let wanted: Vec<f64> = named.iter().map(|(_, end)| end[1]).collect();
    let places = spread(&wanted, LINE - 0.8, [area.top, area.bottom()]);
    for ((series, end), y) in named.iter().zip(places) {
        let (colour, x) = (ink(series.colour), area.right() + 5.0);
        if (y - end[1]).abs() > 1.5 {
            let thin = format!("stroke=\"{colour}\" stroke-width=\"0.4\"");
            svg.line([(end[0] + 2.0).min(area.right()), end[1]], [x - 0.8, y], &thin);
        }
        svg.text([x, y + 2.5], &series.name, Anchor::Start, &format!("fill=\"{colour}\""));
    }
}
