//! Plots over time: one axis of time for all of them, one cursor, all branches.

use super::{colour, nothing};
use crate::action::Action;
use crate::app_state::AppState;
use crate::numbers::fixed;
use crate::quantities::{PlotQuantity, QuantityCurve, bounds, curves, signal_curves, signal_names};
use crate::session::history::History;
use eframe::egui::{self, Color32, Id, Stroke, Ui};
use egui_plot::{GridMark, HLine, HoverPosition, LineStyle, Plot, PlotPoint, VLine};
use vocabulary::math;

/// Maximum number of points of a curve, before straight parts are simplified.
const MOST_POINTS: usize = 400;
/// Tolerance of the simplification, screen points.
const OFF: f64 = 0.35;

/// Plots of some quantities, one above the other.
pub fn show(ui: &mut Ui, app_state: &AppState, quantities: &[PlotQuantity], out: &mut Vec<Action>) {
    if app_state.history.is_none() {
        return nothing(ui, "No scene is open.");
    }
    let gap = ui.spacing().item_spacing.y;
    let high = (ui.available_height() - gap * (quantities.len() - 1) as f32) / quantities.len() as f32;
    for (row, quantity) in quantities.iter().enumerate() {
        let plotted = PlottedCurves {
            id: quantity.column().to_owned(),
            axis: quantity.axis().to_owned(),
            logarithmic: quantity.logarithmic(),
            spiky: quantity.is_spiky(),
            bounds: bounds(app_state, *quantity),
            curves: curves(app_state, *quantity, MOST_POINTS),
        };
        plot(ui, app_state, plotted, high, row + 1 == quantities.len(), out);
    }
}

/// Curves that share a plot.
struct PlottedCurves {
    id: String,
    /// Label of the vertical axis.
    axis: String,
    /// Whether values are logarithms to the base of 10.
    logarithmic: bool,
    /// Whether few samples are far from all others.
    spiky: bool,
    /// Dashed lines.
    bounds: Vec<f64>,
    curves: Vec<QuantityCurve>,
}

/// Most signals that are plotted at once.
const MOST_SIGNALS: usize = 3;

/// What the custom law of the selected follower carries and shows: a choice of curves.
pub fn signals(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let known = signal_names(app_state);
    if known.is_empty() {
        return nothing(ui, "A custom law shows its memory and its `let`s here; the panel Law chooses one.");
    }
    let id = Id::unique("signals");
    let mut chosen: Vec<String> = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    chosen.retain(|name| known.iter().any(|(known, _)| known == name));
    if chosen.is_empty() {
        chosen.push(known[0].0.clone());
    }
    ui.horizontal_wrapped(|ui| {
        for (name, unit) in &known {
            let on = chosen.contains(name);
            let unit = if unit.is_empty() { "a number".to_owned() } else { format!("in {unit}") };
            if ui.selectable_label(on, name).on_hover_text(unit).clicked() {
                if on && chosen.len() > 1 {
                    chosen.retain(|other| other != name);
                } else if !on {
                    chosen.push(name.clone());
                    let extra = chosen.len().saturating_sub(MOST_SIGNALS);
                    chosen.drain(..extra);
                }
            }
        }
    });
    let gap = ui.spacing().item_spacing.y;
    let high = (ui.available_height() - gap * (chosen.len() - 1) as f32) / chosen.len() as f32;
    for (row, name) in chosen.iter().enumerate() {
        let unit = known.iter().find(|(known, _)| known == name).map_or("", |(_, unit)| unit);
        let axis = if unit.is_empty() { name.clone() } else { format!("{name} ({unit})") };
        let curves = signal_curves(app_state, name, MOST_POINTS);
        let plotted = PlottedCurves {
            id: format!("signal {name}"),
            axis,
            logarithmic: false,
            spiky: true,
            bounds: vec![],
            curves,
        };
        plot(ui, app_state, plotted, high, row + 1 == chosen.len(), out);
    }
    ui.data_mut(|data| data.insert_temp(id, chosen));
}

fn plot(
    ui: &mut Ui,
    app_state: &AppState,
    plotted: PlottedCurves,
    high: f32,
    last: bool,
    out: &mut Vec<Action>,
) {
    let PlottedCurves { id, axis, logarithmic, spiky, bounds, curves: all } = plotted;
    let end = app_state.history.as_ref().map_or(0.0, History::latest);
    let group = Id::unique("time axis");
    let weak = ui.visuals().weak_text_color();
    let text = |value: f64| match logarithmic {
        // Decades only: labels between them would repeat their neighbours'.
        true if (value - value.round()).abs() > 0.01 => String::new(),
        true => format!("1e{}", fixed(value, 0)),
        false => short(value),
    };
    let plot = Plot::new(("plot", id))
        .height(high.max(30.0))
        .show_axes([last, true])
        .show_grid(true)
        .show_background(false)
        .link_axis(group, [true, false])
        .link_cursor(group, [true, false])
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_drag([true, false])
        .allow_zoom([true, false])
        .grid_color(weak.gamma_multiply(0.35))
        .set_margin_fraction(egui::vec2(0.01, 0.08))
        .include_x(0.0)
        .include_x(end.max(1.0))
        .y_axis_min_width(40.0)
        .x_grid_spacer(|input| marks(input.bounds.into(), 5.0, 1e-3))
        .y_grid_spacer(move |input| {
            marks(input.bounds.into(), f64::from(high) / 26.0, if logarithmic { 1.0 } else { 1e-9 })
        })
        .y_axis_formatter(move |mark, _| text(mark.value))
        .x_axis_formatter(|mark, _| format!("{} s", short(mark.value)))
        .label_formatter(move |hover| {
            let (HoverPosition::NearDataPoint { position: at, .. }
            | HoverPosition::Elsewhere { position: at }) = hover;
            let value =
                if logarithmic { format!("{:.1e}", math::powf(10_f64, at.y)) } else { fixed(at.y, 3) };
            Some(format!("{} s\n{value}", fixed(at.x, 2)))
        });
    let colours: Vec<Color32> = all
        .iter()
        .map(|curve| curve.robot.map_or(ui.visuals().text_color(), |robot| colour(app_state, robot, ui)))
        .collect();
    let cursor = ui.visuals().strong_text_color();
    let chosen = app_state.chosen_robot();
    let span = span(&all, spiky, logarithmic);
    let off = OFF * (span[1] - span[0]) / f64::from(high.max(30.0));
    let response = plot.show(ui, |plot| {
        plot.set_plot_bounds_y(span[0]..=span[1]);
        for bound in bounds {
            let near = all.iter().flat_map(|c| &c.points).any(|p| p[1].abs() > 0.4 * bound.abs());
            // A distant bound would flatten the curves.
            if near {
                let line = HLine::new("bound", bound).color(weak).width(1.0);
                plot.hline(line.style(LineStyle::dashed_loose()));
            }
        }
        plot.vline(VLine::new("now", app_state.time()).color(cursor).width(1.0));
        plot.pointer_coordinate()
    });
    let transform = response.transform;
    let painter = ui.painter_at(*transform.frame());
    for (curve, colour) in all.iter().zip(colours) {
        let active = curve.branch == app_state.branch;
        let wide = match (active, chosen.is_some() && chosen == curve.robot) {
            (true, true) => 2.2,
            (true, false) => 1.4,
            _ => 1.0,
        };
        let colour = if active { colour } else { colour.gamma_multiply(0.5) };
        let on_screen = |[x, y]: [f64; 2]| transform.position_from_point(&PlotPoint::new(x, y));
        let points: Vec<_> = straightened(&curve.points, span, off).into_iter().map(on_screen).collect();
        // Piece by piece: the corners of a path that turns back on itself would be filled.
        if active {
            let pieces = points
                .windows(2)
                .map(|ends| egui::Shape::line_segment([ends[0], ends[1]], Stroke::new(wide, colour)));
            painter.extend(pieces);
        } else {
            painter.extend(egui::Shape::dashed_line(&points, Stroke::new(wide, colour), 5.0, 4.0));
        }
    }
    // The label lies in the plot, where it takes no space.
    let at = response.response.rect.right_top() + egui::vec2(-6.0, 2.0);
    let font = egui::FontId::proportional(11.5);
    let mut words = axis;
    if let Some(peak) = peak(&all, span).filter(|_| !logarithmic) {
        let decimals = if peak.abs() < 10.0 { 2 } else { usize::from(peak.abs() < 100.0) };
        words = format!("{words}   peak {}", fixed(peak, decimals));
    }
    let galley = ui.painter().layout_no_wrap(words, font, ui.visuals().text_color());
    let place = egui::Align2::RIGHT_TOP.anchor_size(at, galley.size());
    ui.painter().rect_filled(place.expand(2.0), 2.0, ui.visuals().extreme_bg_color.gamma_multiply(0.8));
    ui.painter().galley(place.min, galley, ui.visuals().text_color());
    if response.response.clicked()
        && let Some(point) = response.inner
    {
        out.push(Action::Seek(point.x.max(0.0)));
    }
}

/// The largest value of all, if the plot leaves some out.
fn peak(curves: &[QuantityCurve], [low, high]: [f64; 2]) -> Option<f64> {
    let values = || curves.iter().flat_map(|curve| &curve.points).map(|point| point[1]);
    let cut = values().any(|value| value < low || value > high);
    values().filter(|_| cut).max_by(|a, b| a.abs().total_cmp(&b.abs()))
}

/// Marks of an axis at round values: about `about` of them, at least `least` apart.
fn marks([low, high]: [f64; 2], about: f64, least: f64) -> Vec<GridMark> {
    let rough = ((high - low) / about.max(2.0)).max(least);
    let step = vocabulary::round_step(rough, 0.0);
    let step = if least >= 1.0 { step.round().max(1.0) } else { step };
    let (first, last) = ((low / step).ceil(), (high / step).floor());
    if !(last - first).is_finite() || last - first > 200.0 {
        return Vec::new();
    }
    // Every mark has a label.
    let wide = 0.5 * (high - low);
    (0..=(last - first).max(0.0) as u32)
        .map(|k| GridMark { value: (first + f64::from(k)) * step, step_size: wide })
        .collect()
}

/// Share of the values at either end that may lie outside the plot: short spikes would flatten everything else.
const SPIKES: f64 = 0.015;

/// A curve without the points that lie on a straight line between others, within `off`: constant curves cost next to
/// nothing to draw.
fn straightened(points: &[[f64; 2]], [low, high]: [f64; 2], off: f64) -> Vec<[f64; 2]> {
    // Points far outside the plot are clamped.
    let beside = 0.2 * (high - low);
    let within = |[x, y]: &[f64; 2]| [*x, y.clamp(low - beside, high + beside)];
    let points: Vec<[f64; 2]> = points.iter().map(within).collect();
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return Vec::new() };
    let mut kept = vec![*first];
    // Slopes from the last kept point that pass all points since within `off`.
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut before = *first;
    for point in points[1..].iter().filter(|point| point[0].is_finite()) {
        if point[0] <= before[0] {
            continue;
        }
        let [x, y] = kept[kept.len() - 1];
        let along = (point[0] - x).max(f64::MIN_POSITIVE);
        let slope = (point[1] - y) / along;
        if slope < low || slope > high {
            kept.push(before);
            let along = (point[0] - before[0]).max(f64::MIN_POSITIVE);
            (low, high) = ((point[1] - off - before[1]) / along, (point[1] + off - before[1]) / along);
        } else {
            low = low.max((point[1] - off - y) / along);
            high = high.min((point[1] + off - y) / along);
        }
        before = *point;
    }
    kept.push(*last);
    kept
}

/// The vertical range of a plot.
fn span(curves: &[QuantityCurve], spiky: bool, logarithmic: bool) -> [f64; 2] {
    let mut values: Vec<f64> = curves.iter().flat_map(|curve| &curve.points).map(|point| point[1]).collect();
    values.sort_by(f64::total_cmp);
    let (Some(low), Some(high)) = (values.first(), values.last()) else { return [-1.0, 1.0] };
    let beside = if spiky { (SPIKES * values.len() as f64) as usize } else { 0 };
    let low = values.get(beside).unwrap_or(low);
    let high = values.get(values.len() - 1 - beside).unwrap_or(high);
    let (low, high) = if logarithmic { (*low, *high) } else { (low.min(0.0), high.max(0.0)) };
    // Constant values are shown as constant.
    let room = 0.1 * (high - low).max(0.02);
    [low - room, high + room]
}

/// A number for an axis.
fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" | "" => "0".to_owned(),
        _ => text.replace('-', "−"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_is_that_of_all_values_where_some_are_cut_off() {
        let curve = |values: &[f64]| QuantityCurve {
            branch: 0,
            robot: None,
            points: values.iter().map(|value| [0.0, *value]).collect(),
        };
        let curves = [curve(&[0.0, 82.0]), curve(&[-11.3, 4.0])];
        assert_eq!(peak(&curves, [-10.0, 90.0]), Some(82.0));
        assert_eq!(peak(&curves, [-12.0, 90.0]), None);
        assert_eq!(peak(&[curve(&[-744.0, 3.0])], [-10.0, 90.0]), Some(-744.0));
    }

    #[test]
    fn straight_curves_keep_their_ends_and_bent_ones_their_shape() {
        let line: Vec<[f64; 2]> = (0..100).map(|k| [f64::from(k), 2.0 * f64::from(k)]).collect();
        assert_eq!(straightened(&line, [0.0, 200.0], 0.01).len(), 2);
        let wave: Vec<[f64; 2]> = (0..200).map(|k| [f64::from(k), math::sin(f64::from(k) * 0.1)]).collect();
        let kept = straightened(&wave, [-1.0, 1.0], 0.02);
        assert!(kept.len() < 100, "{}", kept.len());
        for point in &wave {
            let after = kept.iter().position(|p| p[0] >= point[0]).expect("the end is kept");
            let (a, b) = (kept[after.saturating_sub(1)], kept[after]);
            let share = if b[0] > a[0] { (point[0] - a[0]) / (b[0] - a[0]) } else { 0.0 };
            assert!((a[1] + share * (b[1] - a[1]) - point[1]).abs() < 0.05, "at {}", point[0]);
        }
        assert!(straightened(&[], [0.0, 1.0], 0.1).is_empty());
    }
}
