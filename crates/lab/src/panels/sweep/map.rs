//! The map of two keys: a coloured cell for every combination, and a ring at the present values.

use super::SweptCells;
use super::frame::{SweepFrame, part, shade};
use super::tip;
use eframe::egui::{self, Color32, Mesh, Rect, Sense, Stroke, StrokeKind, Ui, vec2};
use figures::{HeatMap, MapSide, Tick};

/// Draws the map; the cell that was clicked.
pub(super) fn show(ui: &mut Ui, shown: &SweptCells<'_>, mut map: HeatMap, high: f32) -> Option<u64> {
    let wide = ui.available_width();
    let (outer, response) = ui.allocate_exact_size(vec2(wide, high), Sense::click());
    map.across.label = shown.label(0);
    map.up.label = shown.label(1);
    let sides = [MapSide::new(&map.across), MapSide::new(&map.up)];
    let bar = map.bar();
    let ticks = |side: &MapSide<'_>, most: f32| -> Vec<Tick> {
        side.ticks((most as usize).max(2)).into_iter().map(|(at, label)| Tick { at, label }).collect()
    };
    let up = ticks(&sides[1], high / 34.0);
    let bar_ticks = bar.ticks(((high / 40.0) as usize).max(2));
    let frame = SweepFrame::new(ui, outer, &up, &bar_ticks);
    let design = shown.result.job.experiment.design();
    // The first key is the slower one: cells of a column follow each other.
    let cell_at = |place: egui::Pos2| {
        let [x, y] = frame.shares(place);
        Some(design.cell_at(&[part(&sides[0].edges, x)?, part(&sides[1].edges, y)?]))
    };
    let painter = ui.painter_at(outer);
    painter.rect_filled(frame.inner, 0.0, ui.visuals().extreme_bg_color);
    let pointed = response.hover_pos().and_then(cell_at);
    let (mut marked, mut coloured) = (None, Mesh::default());
    for (row, y) in sides[1].edges.windows(2).enumerate() {
        for (column, x) in sides[0].edges.windows(2).enumerate() {
            let cell = design.cell_at(&[column as u64, row as u64]);
            // No seam shows between neighbours.
            let corners = Rect::from_two_pos(frame.at(x[0], y[0]), frame.at(x[1], y[1]));
            let rect = Rect::from_min_max(corners.min.round(), corners.max.round());
            let value = map.cells.get(row * map.across.values.len() + column).copied().unwrap_or(f64::NAN);
            match bar.at(value).filter(|_| value.is_finite()) {
                Some(at) => {
                    coloured.add_colored_rect(rect, shade(map.colour_at(at), shown.faded));
                }
                // The runs have been made, and none has a number.
                None if shown.cell(cell).is_some_and(|cell| cell.runs > 0) => cross(ui, &painter, rect),
                None => {}
            }
            if pointed == Some(cell) {
                marked = Some(rect);
            }
        }
    }
    painter.add(coloured);
    frame.draw(ui, &ticks(&sides[0], frame.inner.width() / 44.0), &up, [&map.across.label, &map.up.label]);
    frame.draw_bar(ui, &bar_ticks, |at| shade(map.colour_at(at), shown.faded));
    if let Some(rect) = marked {
        painter.rect_stroke(rect, 0.0, Stroke::new(2.0, Color32::WHITE), StrokeKind::Inside);
        painter.rect_stroke(rect, 0.0, Stroke::new(1.0, Color32::BLACK), StrokeKind::Outside);
    }
    present(ui, shown, &frame, &sides);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, "Map of the sweep"));
    let clicked = response.clicked();
    if let Some(cell) = pointed {
        response.on_hover_ui_at_pointer(|ui| tip::show(ui, shown, cell));
    }
    pointed.filter(|_| clicked)
}

/// A ring at the present values, or a mark at the rim on their side.
fn present(ui: &Ui, shown: &SweptCells<'_>, frame: &SweepFrame, sides: &[MapSide<'_>; 2]) {
    let place = |side: usize| sides[side].ruler.at(shown.present(side)?);
    let (Some(x), Some(y)) = (place(0), place(1)) else { return };
    let inside = [x, y].iter().all(|share| (0.0..=1.0).contains(share));
    let at = frame.at(x.clamp(0.0, 1.0), y.clamp(0.0, 1.0));
    let (painter, radius) = (ui.painter(), if inside { 6.0 } else { 3.0 });
    painter.circle_stroke(at, radius, Stroke::new(4.0, Color32::from_black_alpha(200)));
    painter.circle_stroke(at, radius, Stroke::new(2.0, Color32::WHITE));
}

/// A cross in a cell whose runs have no number.
fn cross(ui: &Ui, painter: &egui::Painter, rect: Rect) {
    let arm = (0.3 * rect.width()).min(0.3 * rect.height()).min(4.0);
    let stroke = Stroke::new(1.0, ui.visuals().weak_text_color());
    let at = rect.center();
    painter.line_segment([at - vec2(arm, arm), at + vec2(arm, arm)], stroke);
    painter.line_segment([at - vec2(arm, -arm), at + vec2(arm, -arm)], stroke);
}
