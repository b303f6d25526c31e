//! Plots over time: one axis of time for all of them, one cursor, all branches.

use super::{colour, nothing};
use crate::action::Action;
use crate::desk::Desk;
use crate::quantities::{Curve, Quantity, bounds, curves};
use crate::tidy::fixed;
use eframe::egui::{self, Color32, Id, Stroke, Ui};
use egui_plot::{HLine, HoverPosition, Line, LineStyle, Plot, PlotPoints, VLine};

/// Points of a curve, at most.
const MOST_POINTS: usize = 400;

/// Plots of some quantities, one above the other.
pub fn show(ui: &mut Ui, desk: &Desk, quantities: &[Quantity], out: &mut Vec<Action>) {
    if desk.history.is_none() {
        return nothing(ui, "No scene is open.");
    }
    let gap = ui.spacing().item_spacing.y;
    let high = (ui.available_height() - gap * (quantities.len() - 1) as f32) / quantities.len() as f32;
    for (row, quantity) in quantities.iter().enumerate() {
        plot(ui, desk, *quantity, (high, row + 1 == quantities.len()), out);
    }
}

fn plot(ui: &mut Ui, desk: &Desk, quantity: Quantity, (high, last): (f32, bool), out: &mut Vec<Action>) {
    let end = desk.history.as_ref().map_or(0.0, |history| history.end(desk.branch));
    let group = Id::unique("time axis");
    let logarithmic = quantity.logarithmic();
    let weak = ui.visuals().weak_text_color();
    let text = |value: f64| {
        match logarithmic {
            // Decades only: between them a label would be one of its neighbours'.
            true if (value - value.round()).abs() > 0.01 => String::new(),
            true => format!("1e{}", fixed(value, 0)),
            false => short(value),
        }
    };
    let plot = Plot::new(("plot", quantity.column()))
        .height(high.max(30.0))
        .show_axes([last, true])
        .show_grid(true)
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
        .grid_spacing(14.0..=60.0)
        .y_axis_formatter(move |mark, _| text(mark.value))
        .x_axis_formatter(|mark, _| format!("{} s", short(mark.value)))
        .label_formatter(move |hover| {
            let (HoverPosition::NearDataPoint { position: at, .. }
            | HoverPosition::Elsewhere { position: at }) = hover;
            let value = if logarithmic { format!("{:.1e}", 10_f64.powf(at.y)) } else { fixed(at.y, 3) };
            Some(format!("{} s\n{value}", fixed(at.x, 2)))
        });
    let all = curves(desk, quantity, [0.0, f64::INFINITY], MOST_POINTS);
    let colours: Vec<Color32> = all
        .iter()
        .map(|curve| curve.robot.map_or(ui.visuals().text_color(), |robot| colour(desk, robot, ui)))
        .collect();
    let cursor = ui.visuals().strong_text_color();
    let chosen = desk.chosen_robot();
    let span = span(&all, quantity);
    let response = plot.show(ui, |plot| {
        plot.set_plot_bounds_y(span[0]..=span[1]);
        for bound in bounds(desk, quantity) {
            let near = all.iter().flat_map(|c| &c.points).any(|p| p[1].abs() > 0.4 * bound.abs());
            // A bound that is far away would only flatten the curves.
            if near {
                plot.hline(
                    HLine::new("bound", bound).color(weak).width(1.0).style(LineStyle::dashed_loose()),
                );
            }
        }
        for (curve, colour) in all.into_iter().zip(colours) {
            let active = curve.branch == desk.branch;
            let wide = match (active, chosen.is_some() && chosen == curve.robot) {
                (true, true) => 2.2,
                (true, false) => 1.4,
                _ => 1.0,
            };
            let colour = if active { colour } else { colour.gamma_multiply(0.45) };
            let style = if active { LineStyle::Solid } else { LineStyle::dashed_dense() };
            let points = PlotPoints::from(curve.points);
            plot.line(Line::new("", points).stroke(Stroke::new(wide, colour)).style(style));
        }
        plot.vline(VLine::new("now", desk.time()).color(cursor).width(1.0));
        plot.pointer_coordinate()
    });
    // The quantity stands in the plot, where it takes no room.
    let at = response.response.rect.right_top() + egui::vec2(-6.0, 2.0);
    let font = egui::FontId::proportional(11.5);
    let galley = ui.painter().layout_no_wrap(quantity.axis().to_owned(), font, ui.visuals().text_color());
    let place = egui::Align2::RIGHT_TOP.anchor_size(at, galley.size());
    ui.painter().rect_filled(place.expand(2.0), 2.0, ui.visuals().extreme_bg_color.gamma_multiply(0.8));
    ui.painter().galley(place.min, galley, ui.visuals().text_color());
    if response.response.clicked()
        && let Some(point) = response.inner
    {
        out.push(Action::Seek(point.x.max(0.0)));
    }
}

/// Share of the values, at either end, that may lie beside the plot: spikes of a sample would flatten all else.
const SPIKES: f64 = 0.015;

/// What a plot shows of its values.
fn span(curves: &[Curve], quantity: Quantity) -> [f64; 2] {
    let mut values: Vec<f64> = curves.iter().flat_map(|curve| &curve.points).map(|point| point[1]).collect();
    values.sort_by(f64::total_cmp);
    let (Some(low), Some(high)) = (values.first(), values.last()) else { return [-1.0, 1.0] };
    let spiky = !matches!(quantity, Quantity::DistanceError | Quantity::BearingError | Quantity::Clearance);
    let beside = if spiky { (SPIKES * values.len() as f64) as usize } else { 0 };
    let low = values.get(beside).unwrap_or(low);
    let high = values.get(values.len() - 1 - beside).unwrap_or(high);
    let (low, high) = if quantity.logarithmic() { (*low, *high) } else { (low.min(0.0), high.max(0.0)) };
    // What is at rest is shown at rest.
    let room = 0.1 * (high - low).max(0.02);
    [low - room, high + room]
}

/// A number for an axis.
fn short(value: f64) -> String {
    let text = format!("{:.3}", value);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    match text {
        "-0" | "" => "0".to_owned(),
        _ => text.replace('-', "−"),
    }
}
