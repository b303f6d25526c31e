//! Figures of a study: curves over one varied key, maps over two.

use crate::design::{Design, DesignAxis};
use crate::interval::wilson;
use crate::measure::MEASURES;
use crate::summary::{CellSummary, StudySummary};
use figures::{Axis, Figure, HeatMap, MapAxis, MapLine, Panel, Scale, Series};
use scene::{ValueScale, Values, WrittenNumber};

/// A figure of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyFigure {
    /// Of its files.
    pub stem: String,
    /// What it shows.
    pub caption: String,
    /// As SVG.
    pub svg: String,
}

/// What a map or a curve shows of the runs of each cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ChartQuantity {
    /// The share that meets its expectations.
    #[default]
    Met,
    /// One of the [`MEASURES`], by its place: the median.
    Measure(usize),
}

/// A quantity over the one key that varies.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyCurve {
    /// The key.
    pub axis: MapAxis,
    /// At each of its values the lower end, the middle and the upper end; NaN where there is none.
    pub values: Vec<[f64; 3]>,
}

impl ChartQuantity {
    /// What it is, with its unit.
    pub fn label(self) -> &'static str {
        match self {
            Self::Met => MET,
            Self::Measure(which) => MEASURES.get(which).map_or("", |measure| measure.label),
        }
    }

    /// Lower end, middle and upper end of a cell.
    pub fn range(self, cell: &CellSummary) -> [f64; 3] {
        match self {
            Self::Met if cell.runs == 0 => [f64::NAN; 3],
            Self::Met => [cell.interval[0], cell.share, cell.interval[1]],
            Self::Measure(which) => cell.quantiles.get(which).copied().unwrap_or([f64::NAN; 3]),
        }
    }
}

/// What is drawn besides the share that met its expectations.
const DRAWN: [&str; 3] = ["settling_time_s", "late_distance_error_m", "clearance_min_m"];
const MET: &str = "share that meets its expectations";
/// Cells of a side that are drawn at most: more are thinner than a line.
const MOST_DRAWN: u64 = 2000;

/// The figures of a study; none where nothing varies that lies on an axis. `lines` are drawn over maps of the first two keys.
pub fn charts(design: &Design, summary: &StudySummary, lines: &[MapLine]) -> Vec<StudyFigure> {
    let sides: Vec<(usize, ChartSide)> = design
        .axes()
        .iter()
        .enumerate()
        .filter_map(|(k, axis)| Some((k, ChartSide::of(design, axis)?)))
        .collect();
    match &sides[..] {
        [] => vec![],
        [(_, side)] => vec![curves(design, summary, side)],
        [(a, across), (b, up), ..] => {
            let mut figures = vec![map_of_share(design, summary, [*a, *b], [across, up], lines)];
            if design.axes().len() == 2 {
                let drawn =
                    MEASURES.iter().enumerate().filter(|(_, measure)| DRAWN.contains(&measure.column));
                figures.extend(
                    drawn.filter_map(|(which, _)| {
                        map_of_measure(design, summary, [*a, *b], [across, up], which)
                    }),
                );
            }
            figures
        }
    }
}

/// A varied key as an axis.
#[derive(Debug, Clone)]
struct ChartSide {
    key: String,
    axis: MapAxis,
}

impl ChartSide {
    /// Of keys that go together the first; `None` where it has one value, or too many.
    fn of(design: &Design, axis: &DesignAxis) -> Option<Self> {
        let parameter = design.study().parameters.get(*axis.parameters.first()?)?;
        let (texts, scale) = match &parameter.values {
            Values::Grid { values, scale, .. } => (values, *scale),
            Values::Zipped(values) => (values, ValueScale::Linear),
            Values::Drawn { .. } | Values::Same(_) => return None,
        };
        if !(2..=MOST_DRAWN).contains(&(texts.len() as u64)) {
            return None;
        }
        let numbers: Option<Vec<WrittenNumber>> = texts.iter().map(|text| WrittenNumber::of(text)).collect();
        let degrees = numbers.as_ref().is_some_and(|all| all.iter().all(|number| number.degrees));
        let value = |number: WrittenNumber| if degrees { number.number } else { number.si() };
        let numbers = numbers.map(|all| all.into_iter().map(value).collect::<Vec<f64>>());
        let rising = |numbers: &Vec<f64>| numbers.windows(2).all(|pair| pair[0] < pair[1]);
        let label = key_label(&parameter.key, degrees);
        let scale = if scale == ValueScale::Logarithmic { Scale::Log } else { Scale::Linear };
        let axis = match numbers.filter(rising) {
            Some(values) => MapAxis { label, scale, values, names: vec![] },
            None => MapAxis {
                label,
                scale: Scale::Linear,
                values: (0..texts.len()).map(|k| k as f64).collect(),
                names: texts.iter().map(|text| text.trim_matches('"').to_owned()).collect(),
            },
        };
        Some(Self { key: parameter.key.clone(), axis })
    }
}

/// A key with its unit, as on an axis; `degrees` says that its values are angles in degrees.
pub fn key_label(key: &str, degrees: bool) -> String {
    match scene::unit(key) {
        _ if degrees => format!("{key} (°)"),
        // Of a pair.
        Some(unit) => format!("{key} ({})", unit.replace(" or ", ", ")),
        None => key.to_owned(),
    }
}

/// The sides between neighbouring cells of a map as a line over it, with ticks towards the first of each pair; `None` where the
/// study has no map.
pub fn edge_line(design: &Design, pairs: &[[u64; 2]]) -> Option<MapLine> {
    let [across, up] = design.axes() else { return None };
    let sides = [ChartSide::of(design, across)?, ChartSide::of(design, up)?];
    // Halfway to a neighbour as the axis lies.
    let halfway = |side: &ChartSide, place: i64, by: i64| {
        let values = &side.axis.values;
        let last = values.len() as i64 - 1;
        let at = |k: i64| values[k.clamp(0, last) as usize];
        let logarithmic = side.axis.scale == Scale::Log;
        let (here, beyond) = (at(place), at(place - by));
        // At its ends a map goes on by half a step.
        let there = match (0..=last).contains(&(place + by)) {
            true => at(place + by),
            false if logarithmic => here * here / beyond,
            false => 2.0 * here - beyond,
        };
        if logarithmic { (here * there).sqrt() } else { f64::midpoint(here, there) }
    };
    let (mut points, mut ticks) = (vec![], vec![]);
    for pair in pairs {
        let middle = |cell: u64| {
            let places = design.places(cell);
            [0, 1].map(|k| sides[k].axis.values[places[k] as usize])
        };
        let [a, b] = [pair[0].min(pair[1]), pair[0].max(pair[1])].map(|cell| design.places(cell));
        let ([x, y], beside) = ([a[0] as i64, a[1] as i64], a[0] != b[0]);
        let ends = [-1, 1].map(|by| {
            if beside {
                [halfway(&sides[0], x, 1), halfway(&sides[1], y, by)]
            } else {
                [halfway(&sides[0], x, by), halfway(&sides[1], y, 1)]
            }
        });
        points.extend(ends);
        points.push([f64::NAN; 2]);
        let towards = middle(pair[0]);
        let crossing = if beside {
            [halfway(&sides[0], x, 1), towards[1]]
        } else {
            [towards[0], halfway(&sides[1], y, 1)]
        };
        ticks.push([crossing, towards]);
    }
    Some(MapLine { points, ticks, ..MapLine::default() })
}

/// Cells summed over all other keys: what is left is a value for each place along some axes.
fn shares(design: &Design, cells: &[CellSummary], axes: &[usize]) -> Vec<CellSummary> {
    let lens: Vec<u64> = axes.iter().filter_map(|axis| Some(design.axes().get(*axis)?.len)).collect();
    let none = CellSummary { runs: 0, met: 0, with_contacts: 0, quantiles: vec![], ..empty() };
    let mut all = vec![none; lens.iter().product::<u64>() as usize];
    for cell in cells {
        let places = design.places(cell.cell);
        let place = axes.iter().zip(&lens).fold(0, |place, (axis, len)| place * len + places[*axis]);
        let Some(sum) = all.get_mut(place as usize) else { continue };
        sum.runs += cell.runs;
        sum.met += cell.met;
        sum.with_contacts += cell.with_contacts;
        sum.quantiles.clone_from(&cell.quantiles);
    }
    for sum in &mut all {
        sum.share = if sum.runs == 0 { f64::NAN } else { sum.met as f64 / sum.runs as f64 };
        sum.interval = wilson(sum.met, sum.runs);
    }
    all
}

fn empty() -> CellSummary {
    CellSummary {
        cell: 0,
        values: vec![],
        runs: 0,
        met: 0,
        share: f64::NAN,
        interval: [0.0, 1.0],
        with_contacts: 0,
        alike: false,
        quantiles: vec![],
    }
}

const BLUE: figures::Rgb = [0.0, 0.447, 0.698];

fn curves(design: &Design, summary: &StudySummary, side: &ChartSide) -> StudyFigure {
    let which = design.axes().iter().position(|axis| {
        axis.parameters
            .first()
            .and_then(|index| design.study().parameters.get(*index))
            .is_some_and(|p| p.key == side.key)
    });
    let cells = shares(design, &summary.cells, &[which.unwrap_or(0)]);
    let points = |of: &dyn Fn(&CellSummary) -> f64| -> Vec<[f64; 2]> {
        side.axis.values.iter().zip(&cells).map(|(x, cell)| [*x, of(cell)]).collect()
    };
    let band = |of: [&dyn Fn(&CellSummary) -> f64; 3], label: &str, axis: Axis| {
        let edge = |points| Series { colour: BLUE, faint: true, points, ..Series::default() };
        let middle = Series { colour: BLUE, points: points(of[1]), ..Series::default() };
        Panel {
            axis: Axis { label: label.to_owned(), ..axis },
            series: vec![edge(points(of[0])), edge(points(of[2])), middle],
            ..Panel::default()
        }
    };
    let unit = Axis { range: Some([0.0, 1.0]), ..Axis::default() };
    let mut panels = vec![band([&|c| c.interval[0], &|c| c.share, &|c| c.interval[1]], MET, unit)];
    if design.axes().len() == 1 {
        for (which, measure) in MEASURES.iter().enumerate().filter(|(_, m)| DRAWN.contains(&m.column)) {
            let at = move |share: usize| {
                move |cell: &CellSummary| cell.quantiles.get(which).map_or(f64::NAN, |q| q[share])
            };
            let (low, middle, high) = (at(0), at(1), at(2));
            if cells.iter().any(|cell| middle(cell).is_finite()) {
                let zero = Axis { show: vec![0.0], ..Axis::default() };
                panels.push(band([&low, &middle, &high], measure.label, zero));
            }
        }
    }
    let figure = Figure {
        title: design.study().title.clone(),
        axis: Axis { label: side.axis.label.clone(), scale: side.axis.scale, ..Axis::default() },
        panels,
        ..Figure::default()
    };
    let caption = format!(
        "Over {}: the share of runs that meets its expectations with its 95 % interval; then medians, with 5 % and 95 % of the runs.",
        side.key
    );
    StudyFigure { stem: "curves".to_owned(), caption, svg: figure.svg() }
}

fn map(design: &Design, [across, up]: [&ChartSide; 2], cells: &[f64], label: &str) -> HeatMap {
    // The first key is the slower: its places are columns of the map, and a map has its cells row by row.
    let (columns, rows) = (across.axis.values.len(), up.axis.values.len());
    let turned = (0..rows).flat_map(|row| (0..columns).map(move |column| column * rows + row));
    HeatMap {
        title: design.study().title.clone(),
        across: across.axis.clone(),
        up: up.axis.clone(),
        cells: turned.map(|place| cells.get(place).copied().unwrap_or(f64::NAN)).collect(),
        label: label.to_owned(),
        ..HeatMap::default()
    }
}

/// The map of a quantity over the two keys that span the cells of a study, of the cells that have runs; `None` where other than
/// two keys do.
pub fn heat_map(design: &Design, cells: &[CellSummary], quantity: ChartQuantity) -> Option<HeatMap> {
    let [across, up] = design.axes() else { return None };
    let sides = [ChartSide::of(design, across)?, ChartSide::of(design, up)?];
    Some(map_of(design, cells, [0, 1], [&sides[0], &sides[1]], quantity))
}

/// The curve of a quantity over the one key that spans the cells of a study: its axis, and for each value the lower end, the
/// middle and the upper end; `None` where other than one key does. Of shares it is the 95 % interval, of numbers 5 %, 50 % and
/// 95 % of the runs.
pub fn curve(design: &Design, cells: &[CellSummary], quantity: ChartQuantity) -> Option<StudyCurve> {
    let [axis] = design.axes() else { return None };
    let side = ChartSide::of(design, axis)?;
    Some(StudyCurve { axis: side.axis, values: ranges(design, cells, quantity) })
}

/// Lower end, middle and upper end of each cell of a study; NaN of those that have no runs.
fn ranges(design: &Design, cells: &[CellSummary], quantity: ChartQuantity) -> Vec<[f64; 3]> {
    let mut values = vec![[f64::NAN; 3]; design.study().cells() as usize];
    for cell in cells {
        if let Some(value) = values.get_mut(cell.cell as usize) {
            *value = quantity.range(cell);
        }
    }
    values
}

fn map_of(
    design: &Design,
    cells: &[CellSummary],
    axes: [usize; 2],
    sides: [&ChartSide; 2],
    quantity: ChartQuantity,
) -> HeatMap {
    let values: Vec<f64> = if axes.len() == design.axes().len() {
        ranges(design, cells, quantity).iter().map(|range| range[1]).collect()
    } else {
        shares(design, cells, &axes).iter().map(|cell| quantity.range(cell)[1]).collect()
    };
    let map = map(design, sides, &values, quantity.label());
    let ChartQuantity::Measure(which) = quantity else {
        return HeatMap { range: Some([0.0, 1.0]), ..map };
    };
    // A few runs that fly apart do not take the colours from all others.
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let ratio =
        finite().fold(0.0_f64, f64::max) / finite().filter(|v| *v > 0.0).fold(f64::INFINITY, f64::min);
    let scale = if ratio > 100.0 { Scale::Log } else { Scale::Linear };
    let reversed = MEASURES.get(which).is_none_or(|measure| measure.column != "clearance_min_m");
    HeatMap { scale, reversed, ..map }
}

fn map_of_share(
    design: &Design,
    summary: &StudySummary,
    axes: [usize; 2],
    sides: [&ChartSide; 2],
    lines: &[MapLine],
) -> StudyFigure {
    let map = map_of(design, &summary.cells, axes, sides, ChartQuantity::Met);
    let map = HeatMap { lines: lines.to_vec(), ..map };
    let drawn = if lines.is_empty() {
        ""
    } else {
        " Lines are borders between cells; ticks are on the side where it holds, or where most runs meet their expectations."
    };
    let others = design.axes().len() - 2;
    let over = if others == 0 { String::new() } else { ", over all values of the other keys".to_owned() };
    let caption = format!("The {MET}, over {} and {}{over}.{drawn}", sides[0].key, sides[1].key);
    StudyFigure { stem: "map-met".to_owned(), caption, svg: map.svg() }
}

fn map_of_measure(
    design: &Design,
    summary: &StudySummary,
    axes: [usize; 2],
    sides: [&ChartSide; 2],
    which: usize,
) -> Option<StudyFigure> {
    let measure = MEASURES.get(which)?;
    let map = map_of(design, &summary.cells, axes, sides, ChartQuantity::Measure(which));
    if !map.cells.iter().any(|value| value.is_finite()) {
        return None;
    }
    let caption = format!(
        "Median of {}, over {} and {}; crosses: no run has it.",
        measure.label, sides[0].key, sides[1].key
    );
    let stem = format!("map-{}", measure.column.replace('_', "-"));
    Some(StudyFigure { stem, caption, svg: map.svg() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::{RowStatus, RunRow};
    use crate::summary::SummaryBuilder;
    use scene::{Study, StudyParameter};

    fn figures(keys: &[(&str, &str)], seeds: u64) -> Vec<StudyFigure> {
        let parameter = |(key, values): &(&str, &str)| StudyParameter {
            key: (*key).to_owned(),
            values: values.parse().expect("values"),
        };
        let parameters = keys.iter().map(parameter).collect();
        let design = Design::new(Study { parameters, seeds, ..Study::of_scene("circle-three", "A study") });
        let mut builder = SummaryBuilder::new(&design, 0);
        for index in 0..design.study().runs() {
            let mut row = RunRow::of(design.point(index), RowStatus::Complete, String::new());
            row.met = index % 3 == 0;
            row.measures = vec![index as f64; MEASURES.len()];
            builder.push(row);
        }
        charts(&design, &builder.finish(), &[])
    }

    #[test]
    fn one_key_gives_curves_and_two_give_maps() {
        let stems =
            |figures: Vec<StudyFigure>| figures.into_iter().map(|figure| figure.stem).collect::<Vec<_>>();
        assert_eq!(stems(figures(&[("law.k", "1..10/4")], 5)), ["curves"]);
        let maps = ["map-met", "map-late-distance-error-m", "map-settling-time-s", "map-clearance-min-m"];
        assert_eq!(stems(figures(&[("law.k", "1..10/4"), ("law.beta", "1,2")], 5)), maps);
        assert_eq!(
            stems(figures(&[("law.k", "1..10/4"), ("law.beta", "1,2"), ("vehicle.kind", "car,unicycle")], 2)),
            ["map-met"]
        );
        assert!(figures(&[("law.k", "uniform:1..2")], 5).is_empty());
    }

    #[test]
    fn what_is_no_number_has_its_name_on_the_axis() {
        let drawn = figures(&[("vehicle.kind", "car,unicycle"), ("robots.b.bearing", "-135..-90 deg/3")], 1);
        assert!(drawn[0].svg.contains(">unicycle<") && drawn[0].svg.contains("robots.b.bearing (°)"));
    }
}
