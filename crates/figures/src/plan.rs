//! What lies on a plane, drawn to one scale in both directions: ways, bodies, graphs.

use crate::axis::{Ruler, Tick};
use crate::draw::{BARE, GREY, MARGIN, SMALL, TICK, heading, points, stroke};
use crate::svg::{Anchor, Svg, ink, point, polyline, width};
use crate::trim::thinned;
use crate::{Axis, Key, Rgb, Stroke};
use vocabulary::math;

/// A way over the plane.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanPath {
    /// [x, y].
    pub points: Vec<[f64; 2]>,
    /// Its colour.
    pub colour: Rgb,
    /// How points are joined.
    pub stroke: Stroke,
    /// Thin and pale: one of a crowd.
    pub faint: bool,
}

/// Ground that something sweeps.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanStrip {
    /// Its middle line, [x, y].
    pub points: Vec<[f64; 2]>,
    /// In the unit of the axes.
    pub width: f64,
    /// Its colour.
    pub colour: Rgb,
}

/// A crowd of dots.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanDots {
    /// [x, y].
    pub points: Vec<[f64; 2]>,
    /// Their colour.
    pub colour: Rgb,
}

/// A closed shape.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanOutline {
    /// Corners, [x, y].
    pub points: Vec<[f64; 2]>,
    /// Its colour.
    pub colour: Rgb,
    /// How much of its colour fills it, 0 to 1.
    pub filled: f64,
}

/// A straight arrow.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Arrow {
    /// Where it starts, [x, y].
    pub from: [f64; 2],
    /// Where its tip is.
    pub to: [f64; 2],
    /// What stays free at both ends, points of print.
    pub free: f64,
    /// Its colour.
    pub colour: Rgb,
}

/// A disc with a word in it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanNode {
    /// Its middle, [x, y].
    pub at: [f64; 2],
    /// What stands in it.
    pub name: String,
    /// Radius, points of print.
    pub radius: f64,
    /// Its colour.
    pub colour: Rgb,
    /// Filled with its colour, the word in white.
    pub filled: bool,
}

/// Where a note stands beside its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// To the right.
    #[default]
    Right,
    /// To the left.
    Left,
    /// Above.
    Above,
    /// Below.
    Below,
}

/// Words at a place.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Note {
    /// [x, y].
    pub at: [f64; 2],
    /// The words.
    pub text: String,
    /// Where they stand.
    pub side: Side,
    /// From the place to the words, points of print.
    pub off: f64,
    /// Their colour; grey if none.
    pub colour: Option<Rgb>,
}

/// A map: x to the right, y up.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Over everything.
    pub title: String,
    /// Labels of the axes; a map without has no frame.
    pub axes: Option<[String; 2]>,
    /// Ground under everything.
    pub strips: Vec<PlanStrip>,
    /// Dots over that.
    pub dots: Vec<PlanDots>,
    /// Ways.
    pub tracks: Vec<PlanPath>,
    /// Shapes over them.
    pub outlines: Vec<PlanOutline>,
    /// Arrows over those.
    pub arrows: Vec<Arrow>,
    /// Discs over those.
    pub nodes: Vec<PlanNode>,
    /// Words over everything.
    pub notes: Vec<Note>,
    /// What strokes stand for, over the map.
    pub keys: Vec<Key>,
    /// Width, mm: 85 is a column.
    pub width: f64,
    /// Largest height of the map itself, mm: what is higher is drawn smaller.
    pub height: f64,
    /// Left free around everything, [left and right, above and below], points of print.
    pub margin: [f64; 2],
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            title: String::new(),
            axes: None,
            strips: vec![],
            dots: vec![],
            tracks: vec![],
            outlines: vec![],
            arrows: vec![],
            nodes: vec![],
            notes: vec![],
            keys: vec![],
            width: 85.0,
            height: 85.0,
            margin: [6.0; 2],
        }
    }
}

/// Where things come to lie on the sheet.
struct Projection {
    /// Least x and largest y of what is shown.
    corner: [f64; 2],
    /// Points of print for one unit.
    scale: f64,
    origin: [f64; 2],
}

impl Projection {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.origin[0] + (x - self.corner[0]) * self.scale,
            self.origin[1] + (self.corner[1] - y) * self.scale,
        ]
    }
}

impl Plan {
    /// The map as SVG.
    pub fn svg(&self) -> String {
        let (sheet, most) = (points(self.width), points(self.height));
        let mut svg = Svg::default();
        let mut top = heading(&mut svg, &self.title, &self.keys, MARGIN, sheet);
        let (left, foot) = if self.axes.is_some() { (24.0, 23.0) } else { (MARGIN, MARGIN) };
        top += if self.axes.is_some() { 16.0 } else { 3.0 };
        if self.title.is_empty() && self.keys.is_empty() && self.axes.is_some() {
            top -= BARE;
        }
        let [low, high] = self.extent();
        let [aside, over] = self.margin;
        let room = [sheet - left - MARGIN - 2.0 * aside, most - 2.0 * over];
        let span = [(high[0] - low[0]).max(1e-9), (high[1] - low[1]).max(1e-9)];
        let scale = (room[0] / span[0]).min(room[1] / span[1]);
        let free = 0.5 * (room[0] - scale * span[0]).max(0.0);
        let inner = if self.axes.is_some() { aside } else { aside + free };
        let projection = Projection { corner: [low[0], high[1]], scale, origin: [left + inner, top + over] };
        let height = scale * span[1] + 2.0 * over;
        if let Some(names) = &self.axes {
            // Axes end where the frame does; a map that is higher than wide leaves paper free to its right.
            let wide = scale * span[0] + 2.0 * aside;
            let [x, y] = [aside / scale, over / scale];
            let ends = [[low[0] - x, high[0] + x], [low[1] - y, high[1] + y]];
            frame(&mut svg, names, ends, [left, top, wide, height]);
        }
        self.draw(&mut svg, &projection);
        svg.finish(&self.title, [sheet, top + height + foot])
    }

    /// Least and largest [x, y] of everything.
    fn extent(&self) -> [[f64; 2]; 2] {
        let tracks = self.tracks.iter().flat_map(|t| &t.points);
        let outlines = self.outlines.iter().flat_map(|o| &o.points);
        let arrows = self.arrows.iter().flat_map(|a| [&a.from, &a.to]);
        let dots = self.dots.iter().flat_map(|d| &d.points);
        let all = tracks.chain(dots).chain(outlines).chain(arrows).chain(self.nodes.iter().map(|n| &n.at));
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for place in all.filter(|p| p.iter().all(|x| x.is_finite())) {
            for axis in [0, 1] {
                low[axis] = low[axis].min(place[axis]);
                high[axis] = high[axis].max(place[axis]);
            }
        }
        if low[0] > high[0] { [[0.0; 2], [1.0; 2]] } else { [low, high] }
    }

    fn draw(&self, svg: &mut Svg, on: &Projection) {
        let on_paper = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
            points.iter().filter(|p| p.iter().all(|x| x.is_finite())).map(|p| on.at(*p)).collect()
        };
        for strip in &self.strips {
            let d = polyline(&thinned(&on_paper(&strip.points), 0.03));
            let (colour, width) = (ink(strip.colour), strip.width * on.scale);
            svg.path(
                &d,
                &format!(
                    "fill=\"none\" stroke=\"{colour}\" stroke-opacity=\"0.4\" stroke-width=\"{width:.2}\" \
                     stroke-linejoin=\"round\""
                ),
            );
        }
        for dots in &self.dots {
            let places: Vec<String> = on_paper(&dots.points).into_iter().map(point).collect();
            if places.is_empty() {
                continue;
            }
            let d = format!("M{}h0", places.join("h0M"));
            let colour = ink(dots.colour);
            svg.path(
                &d,
                &format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.1\" stroke-linecap=\"round\""),
            );
        }
        for track in &self.tracks {
            stroke(
                svg,
                &polyline(&thinned(&on_paper(&track.points), 0.03)),
                track.stroke,
                &ink(track.colour),
                track.faint,
            );
        }
        for outline in &self.outlines {
            let d = polyline(&outline.points.iter().map(|p| on.at(*p)).collect::<Vec<_>>());
            let (colour, filled) = (ink(outline.colour), outline.filled.clamp(0.0, 1.0));
            svg.path(&format!("{d}Z"), "fill=\"#fff\"");
            svg.path(
                &format!("{d}Z"),
                &format!(
                    "fill=\"{colour}\" fill-opacity=\"{filled}\" stroke=\"{colour}\" stroke-width=\"0.6\" \
                     stroke-linejoin=\"round\""
                ),
            );
        }
        self.arrows.iter().for_each(|a| arrow(svg, a, on));
        for node in &self.nodes {
            disc(svg, node, on.at(node.at));
        }
        for note in &self.notes {
            let ([x, y], off) = (on.at(note.at), note.off);
            let (at, anchor) = match note.side {
                Side::Right => ([x + off, y + 2.5], Anchor::Start),
                Side::Left => ([x - off, y + 2.5], Anchor::End),
                Side::Above => ([x, y - off], Anchor::Middle),
                Side::Below => ([x, y + off + 5.0], Anchor::Middle),
            };
            let colour = note.colour.map_or_else(|| GREY.to_owned(), ink);
            // Words lie over ways: a halo keeps them readable. It is drawn first, by itself, for all who read SVG.
            let halo = "fill=\"#fff\" stroke=\"#fff\" stroke-width=\"2.2\" stroke-linejoin=\"round\"";
            svg.text(at, &note.text, anchor, halo);
            svg.text(at, &note.text, anchor, &format!("fill=\"{colour}\""));
        }
    }
}

fn arrow(svg: &mut Svg, arrow: &Arrow, on: &Projection) {
    const HEAD: f64 = 4.6;
    let (from, to) = (on.at(arrow.from), on.at(arrow.to));
    let d = [to[0] - from[0], to[1] - from[1]];
    let long = math::hypot(d[0], d[1]);
    if long <= 2.0 * arrow.free + 1.0 {
        return;
    }
    let u = [d[0] / long, d[1] / long];
    let at = |along: f64, aside: f64| {
        [from[0] + along * u[0] - aside * u[1], from[1] + along * u[1] + aside * u[0]]
    };
    let (tip, colour) = (long - arrow.free, ink(arrow.colour));
    let head = HEAD.min(0.5 * (tip - arrow.free));
    let line = format!("stroke=\"{colour}\" stroke-width=\"0.9\" fill=\"none\"");
    svg.line(at(arrow.free, 0.0), at(tip - head, 0.0), &line);
    let triangle = [at(tip, 0.0), at(tip - head, 0.36 * head), at(tip - head, -0.36 * head)];
    svg.path(&format!("{}Z", polyline(&triangle)), &format!("fill=\"{colour}\""));
}

fn disc(svg: &mut Svg, node: &PlanNode, [x, y]: [f64; 2]) {
    let (r, colour) = (node.radius, ink(node.colour));
    let around = format!("M{}a{r} {r} 0 1 0 {d} 0a{r} {r} 0 1 0 -{d} 0Z", point([x - r, y]), d = 2.0 * r);
    let fill = if node.filled { colour.as_str() } else { "#fff" };
    svg.path(&around, &format!("fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.1\""));
    // A word that does not fit would run over the rim.
    let size = SMALL.min(1.75 * r / width(&node.name, 1.0).max(0.1));
    let ink = if node.filled { "#fff" } else { "#1e1e22" };
    let look = format!("fill=\"{ink}\" font-size=\"{size:.2}\" font-weight=\"600\"");
    svg.text([x, y + 0.36 * size], &node.name, Anchor::Middle, &look);
}

/// Axes with ticks to the left and below, and faint lines across from them.
fn frame(svg: &mut Svg, names: &[String; 2], ends: [[f64; 2]; 2], [left, top, wide, high]: [f64; 4]) {
    let thin = "stroke=\"#1e1e22\" stroke-width=\"0.5\" fill=\"none\"";
    let faint = "stroke=\"#e3e4e6\" stroke-width=\"0.4\"";
    let ticks = |ends: [f64; 2], room: f64| -> Vec<Tick> {
        let axis = Axis { range: Some(ends), ..Axis::default() };
        Ruler::new(&axis, std::iter::empty(), true).ticks(room as usize)
    };
    let bottom = top + high;
    for tick in ticks(ends[0], (wide / 26.0).max(2.0)) {
        let x = left + tick.at * wide;
        svg.line([x, top], [x, bottom], faint);
        svg.line([x, bottom], [x, bottom + TICK], thin);
        svg.text([x, bottom + TICK + 7.5], &tick.label, Anchor::Middle, "");
    }
    for tick in ticks(ends[1], (high / 13.0).max(3.0)) {
        let y = bottom - tick.at * high;
        svg.line([left, y], [left + wide, y], faint);
        svg.line([left - TICK, y], [left, y], thin);
        svg.text([left - TICK - 2.0, y + 2.5], &tick.label, Anchor::End, "");
    }
    svg.line([left, top], [left, bottom], thin);
    svg.line([left, bottom], [left + wide, bottom], thin);
    svg.text([left + 0.5 * wide, bottom + 19.0], &names[0], Anchor::Middle, "");
    svg.text([MARGIN, top - 5.0], &names[1], Anchor::Start, "");
}
