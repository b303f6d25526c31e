//! Small drawings on buttons, made of lines so that they are sharp at any size.

use eframe::egui::{self, Color32, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo};

/// What a button shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Icon {
    /// A triangle.
    Play,
    /// Two bars.
    Pause,
    /// A triangle against a bar.
    Step,
    /// A bar and a triangle to the left.
    Restart,
    /// A camera.
    Camera,
    /// Three lines.
    Menu,
    /// Three dots.
    More,
    /// A disc.
    Record,
    /// A square.
    Stop,
    /// Three dots, joined.
    Share,
}

/// A button with a drawing, and a text beside it where there is one.
pub(crate) fn button(
    ui: &mut Ui,
    icon: Icon,
    text: &str,
    name: &str,
    colour: Option<Color32>,
) -> egui::Response {
    let font = egui::TextStyle::Button.resolve(ui.style());
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, colour.unwrap_or(Color32::PLACEHOLDER));
    let side = 14.0;
    let gap = if text.is_empty() { 0.0 } else { 6.0 };
    let size = Vec2::new(12.0 + side + gap + galley.size().x, 24.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), name));
    let visuals = ui.style().interact(&response);
    ui.painter().rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
    let colour = colour.unwrap_or(visuals.text_color());
    let place =
        Rect::from_center_size(Pos2::new(rect.left() + 6.0 + 0.5 * side, rect.center().y), Vec2::splat(side));
    ui.painter().extend(shapes(icon, place, colour));
    let at = Pos2::new(place.right() + gap, rect.center().y - 0.5 * galley.size().y);
    ui.painter().galley(at, galley, colour);
    response
}

fn shapes(icon: Icon, rect: Rect, colour: Color32) -> Vec<Shape> {
    let at = |x: f32, y: f32| Pos2::new(rect.left() + x * rect.width(), rect.top() + y * rect.height());
    let solid = |points: &[(f32, f32)]| {
        let points = points.iter().map(|(x, y)| at(*x, *y)).collect();
        Shape::convex_polygon(points, colour, Stroke::NONE)
    };
    let bar = |x: f32, y: f32, wide: f32, high: f32| {
        Shape::rect_filled(Rect::from_min_max(at(x, y), at(x + wide, y + high)), 1.0, colour)
    };
    match icon {
        Icon::Play => vec![solid(&[(0.2, 0.08), (0.95, 0.5), (0.2, 0.92)])],
        Icon::Pause => vec![bar(0.16, 0.1, 0.24, 0.8), bar(0.6, 0.1, 0.24, 0.8)],
        Icon::Step => vec![solid(&[(0.12, 0.12), (0.7, 0.5), (0.12, 0.88)]), bar(0.74, 0.12, 0.16, 0.76)],
        Icon::Restart => vec![solid(&[(0.88, 0.12), (0.3, 0.5), (0.88, 0.88)]), bar(0.1, 0.12, 0.16, 0.76)],
        Icon::Camera => {
            let body = Rect::from_min_max(at(0.0, 0.26), at(1.0, 0.9));
            let stroke = Stroke::new(1.5, colour);
            vec![
                Shape::rect_stroke(body, 2.0, stroke, egui::StrokeKind::Inside),
                Shape::circle_stroke(at(0.5, 0.58), 0.17 * rect.width(), stroke),
                bar(0.32, 0.12, 0.36, 0.16),
            ]
        }
        Icon::Menu => (0..3).map(|k| bar(0.05, 0.16 + 0.28 * k as f32, 0.9, 0.12)).collect(),
        Icon::More => {
            let dot = |k: u8| Shape::circle_filled(at(0.5, 0.16 + 0.34 * f32::from(k)), 1.6, colour);
            (0..3).map(dot).collect()
        }
        Icon::Record => vec![Shape::circle_filled(at(0.5, 0.5), 0.42 * rect.width(), colour)],
        Icon::Share => {
            let [from, up, down] = [at(0.16, 0.5), at(0.82, 0.14), at(0.82, 0.86)];
            let line = |to| Shape::line_segment([from, to], Stroke::new(1.3, colour));
            let dot = |place| Shape::circle_filled(place, 0.17 * rect.width(), colour);
            vec![line(up), line(down), dot(from), dot(up), dot(down)]
        }
        Icon::Stop => vec![bar(0.14, 0.14, 0.72, 0.72)],
    }
}
