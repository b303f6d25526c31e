//! Figures for print: panels of curves over one shared axis, as SVG text that is as wide as a column.
//!
//! One family: thin axes, the quantity and its unit over every panel, names beside curves instead of a legend where they
//! fit, colours of robots as in pictures, and for grey print a marker or a dash for everything that a colour tells.
//! The same figure gives the same bytes. What is not a finite number leaves a gap; nothing here can fail.
//!
//! A plotting library (kuva 0.6) sets no names at the ends of curves, no zero on a logarithmic axis, and ticks at 0.1 as
//! `1e-1`: what would be left for it to do is less than the layer around it.

mod axis;
mod draw;
mod map;
mod place;
mod plan;
mod svg;
mod trim;

pub use axis::{Ruler, Tick};
pub use map::{HeatMap, MapAxis, MapLine, MapSide, viridis};
pub use plan::{Arrow, Note, Plan, PlanDots, PlanNode, PlanOutline, PlanPath, PlanStrip, Side};
pub use svg::Rgb;

/// How values lie along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By their logarithm. A zero on the horizontal axis stands by itself to the left; elsewhere what is not above zero is
    /// left out.
    Log,
}

/// One axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// Quantity and unit, such as `distance (mm)`.
    pub label: String,
    /// How values lie.
    pub scale: Scale,
    /// Values that are shown whether or not a curve reaches them, such as 0.
    pub show: Vec<f64>,
    /// Its ends, lower first, where values shall not set them; curves are cut there.
    pub range: Option<[f64; 2]>,
}

/// What stands at every point of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Marker {
    /// Nothing.
    #[default]
    None,
    /// A disc.
    Disc,
    /// A square.
    Square,
    /// A triangle.
    Triangle,
    /// A triangle on its tip.
    Wedge,
    /// An upright cross.
    Plus,
    /// A slanted cross.
    Cross,
    /// A large diamond, open: what is marked among others.
    Diamond,
}

impl Marker {
    /// The small markers in turn, one for each of several curves.
    pub fn of(index: usize) -> Self {
        const TURN: [Marker; 6] =
            [Marker::Disc, Marker::Square, Marker::Triangle, Marker::Wedge, Marker::Plus, Marker::Cross];
        TURN[index % TURN.len()]
    }
}

/// How points are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stroke {
    /// By straight lines.
    #[default]
    Solid,
    /// By dashes.
    Dashed,
    /// By dots.
    Dotted,
    /// By dashes and dots in turn.
    DashDotted,
    /// Each value holds until the next.
    Step,
    /// Not at all.
    None,
}

/// One curve.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    /// Its name, set at its end; none if empty.
    pub name: String,
    /// Its colour, sRGB from 0 to 1; colours too light for paper are darkened.
    pub colour: Rgb,
    /// How its points are joined.
    pub stroke: Stroke,
    /// What stands at its points.
    pub marker: Marker,
    /// Thin and pale: one of a crowd.
    pub faint: bool,
    /// [x, y] in the units of the axes.
    pub points: Vec<[f64; 2]>,
}

/// A straight grey line across a panel.
#[derive(Debug, Clone, PartialEq)]
pub enum Guide {
    /// Upright, at a place of the horizontal axis.
    Upright(f64, String),
    /// Level, at a place of the panel's own axis.
    Level(f64, String),
    /// A grey band between two places of the panel's own axis.
    Band([f64; 2]),
}

/// Curves with an axis of their own.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// The upright axis.
    pub axis: Axis,
    /// What is drawn.
    pub series: Vec<Series>,
    /// Lines and bands behind the curves.
    pub guides: Vec<Guide>,
}

/// What a stroke or a marker stands for, in grey, over the panels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Key {
    /// What it stands for.
    pub name: String,
    /// The stroke.
    pub stroke: Stroke,
    /// The marker.
    pub marker: Marker,
    /// Its colour; grey if it stands for curves of several colours.
    pub colour: Option<Rgb>,
}

/// Panels one above the other on one horizontal axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Over everything.
    pub title: String,
    /// The horizontal axis of all panels.
    pub axis: Axis,
    /// From top to bottom.
    pub panels: Vec<Panel>,
    /// What strokes and markers stand for.
    pub keys: Vec<Key>,
    /// Width, mm: 85 is a column.
    pub width: f64,
    /// Height of a panel, mm.
    pub height: f64,
    /// Part of the horizontal axis that every panel shows a second time, magnified, to the left.
    pub zoom: Option<[f64; 2]>,
}

impl Default for Figure {
    fn default() -> Self {
        Self {
            title: String::new(),
            axis: Axis::default(),
            panels: vec![],
            keys: vec![],
            width: 85.0,
            height: 22.0,
            zoom: None,
        }
    }
}

impl Figure {
    /// The figure as SVG.
    pub fn svg(&self) -> String {
        draw::draw(self)
    }
}
