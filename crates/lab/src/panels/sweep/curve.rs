//! The curve over one key: the middle of the runs of each value with its spread, and a line at the present value.

use super::SweptCells;
use super::frame::{SweepFrame, part};
use super::tip;
use eframe::egui::{self, Color32, Mesh, Pos2, Sense, Shape, Stroke, Ui, vec2};
use figures::{Axis, MapSide, Ruler, Tick};
use sweeps::{ChartQuantity, StudyCurve};

/// Draws the curve; the cell that was clicked.
pub(super) fn show(ui: &mut Ui, shown: &SweptCells<'_>, mut curve: StudyCurve, high: f32) -> Option<u64> {
    let wide = ui.available_width();
    let (outer, response) = ui.allocate_exact_size(vec2(wide, high), Sense::click());
    curve.axis.label = shown.label(0);
    let side = MapSide::new(&curve.axis);
    let share = shown.quantity == ChartQuantity::Met;
    let axis = if share {
        Axis { range: Some([-0.03, 1.03]), ..Axis::default() }
    } else {
        Axis { show: vec![0.0], ..Axis::default() }
    };
    let ruler = Ruler::new(&axis, curve.values.iter().flatten().copied(), false);
    let up = ruler.ticks(((high / 34.0) as usize).max(2));
    let frame = SweepFrame::new(ui, outer, &up, &[]);
    let painter = ui.painter_at(outer);
    painter.rect_filled(frame.inner, 0.0, ui.visuals().extreme_bg_color);
    let place = |value: f64, number: f64| -> Option<Pos2> {
        Some(frame.at(side.ruler.at(value)?, ruler.at(number).filter(|at| at.is_finite())?))
    };
    let stretches = |which: usize| -> Vec<Option<Pos2>> {
        let points = curve.axis.values.iter().zip(&curve.values);
        points.map(|(value, ends)| place(*value, ends[which]).filter(|_| ends[which].is_finite())).collect()
    };
    let [low, middle, top] = [0, 1, 2].map(stretches);
    let colour = if shown.faded { ui.visuals().weak_text_color() } else { ui.visuals().selection.bg_fill };
    // Single runs have no spread.
    if shown.result.cells.iter().any(|cell| cell.runs > 1) {
        painter.extend(band(&low, &top, colour.gamma_multiply(0.25)));
    }
    for pair in middle.windows(2) {
        if let [Some(a), Some(b)] = pair {
            painter.line_segment([*a, *b], Stroke::new(1.6, colour));
        }
    }
    let at = response.hover_pos().filter(|at| frame.inner.contains(*at));
    let pointed = at.and_then(|at| part(&side.edges, frame.shares(at)[0]));
    for (cell, point) in middle.iter().enumerate() {
        if let Some(point) = point {
            let radius = if pointed == Some(cell as u64) { 4.5 } else { 2.6 };
            painter.circle_filled(*point, radius, colour);
        } else if shown.cell(cell as u64).is_some_and(|cell| cell.runs > 0) {
            // Its runs have been made, and none has a number.
            let x = frame.at(side.ruler.at(curve.axis.values[cell]).unwrap_or(-1.0), 0.0);
            let weak = Stroke::new(1.0, ui.visuals().weak_text_color());
            painter.line_segment([x - vec2(3.0, 9.0), x + vec2(3.0, -3.0)], weak);
            painter.line_segment([x - vec2(3.0, 3.0), x + vec2(3.0, -9.0)], weak);
        }
    }
    let across: Vec<Tick> = side
        .ticks(((frame.inner.width() / 44.0) as usize).max(2))
        .into_iter()
        .map(|(at, label)| Tick { at, label })
        .collect();
    frame.draw(ui, &across, &up, [&curve.axis.label, shown.quantity.label()]);
    present(ui, shown, &frame, &side);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, "Curve of the sweep"));
    let clicked = response.clicked();
    if let Some(cell) = pointed {
        response.on_hover_ui_at_pointer(|ui| tip::show(ui, shown, cell));
    }
    pointed.filter(|_| clicked)
}

/// A line at the present value.
fn present(ui: &Ui, shown: &SweptCells<'_>, frame: &SweepFrame, side: &MapSide<'_>) {
    let at = shown.present(0).and_then(|now| side.ruler.at(now)).filter(|at| (0.0..=1.0).contains(at));
    if let Some(at) = at {
        let ends = [frame.at(at, 0.0), frame.at(at, 1.0)];
        ui.painter().line_segment(ends, Stroke::new(1.5, ui.visuals().strong_text_color()));
    }
}

/// The area between two curves, where both have points.
fn band(low: &[Option<Pos2>], high: &[Option<Pos2>], colour: Color32) -> Vec<Shape> {
    let pairs: Vec<_> = low.iter().zip(high).collect();
    let quads = pairs.windows(2).filter_map(|pair| match pair {
        [(Some(a), Some(b)), (Some(c), Some(d))] => Some([*a, *b, *c, *d]),
        _ => None,
    });
    let quads = quads.map(|corners| {
        let mut mesh = Mesh::default();
        for corner in corners {
            mesh.colored_vertex(corner, colour);
        }
        mesh.add_triangle(0, 1, 2);
        mesh.add_triangle(1, 2, 3);
        Shape::mesh(mesh)
    });
    quads.collect()
}
