//! The frame of a map or a curve: where it lies, its ticks and words.

use eframe::egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, Ui, pos2, vec2};
use figures::{Rgb, Tick};

/// Size of the words, points.
const SIZE: f32 = 11.0;
/// Length of a tick, points.
const TICK: f32 = 3.5;

/// The frame of a map or a curve.
pub(super) struct SweepFrame {
    /// All of it.
    outer: Rect,
    /// What it encloses.
    pub(super) inner: Rect,
}

impl SweepFrame {
    /// In `outer`, with room for the labels of the ticks on its left and right sides.
    pub(super) fn new(ui: &Ui, outer: Rect, left: &[Tick], right: &[Tick]) -> Self {
        let widest = |ticks: &[Tick]| {
            let all = ticks.iter().map(|tick| {
                let galley = ui.painter().layout_no_wrap(tick.label.clone(), font(), Color32::PLACEHOLDER);
                galley.size().x
            });
            all.fold(0.0, f32::max)
        };
        let right = if right.is_empty() { 8.0 } else { widest(right) + BAR + 2.0 * TICK + 12.0 };
        let (head, foot) = (SIZE + 8.0, 2.0 * SIZE + 14.0);
        let min = outer.min + vec2(widest(left) + TICK + 5.0, head);
        let max = outer.max - vec2(right, foot);
        Self { outer, inner: Rect::from_min_max(min, max.max(min + vec2(20.0, 20.0))) }
    }

    /// The place of shares of both sides, from the lower left corner.
    pub(super) fn at(&self, x: f64, y: f64) -> Pos2 {
        let inner = self.inner;
        pos2(inner.left() + x as f32 * inner.width(), inner.bottom() - y as f32 * inner.height())
    }

    /// The shares at a place.
    pub(super) fn shares(&self, place: Pos2) -> [f64; 2] {
        let off = place - self.inner.left_bottom();
        [f64::from(off.x / self.inner.width()), f64::from(-off.y / self.inner.height())]
    }

    /// The outline, the ticks of both axes, and what the axes are.
    pub(super) fn draw(&self, ui: &Ui, across: &[Tick], up: &[Tick], labels: [&str; 2]) {
        let (painter, inner, colour) = (ui.painter(), self.inner, ui.visuals().text_color());
        let thin = Stroke::new(1.0, colour.gamma_multiply(0.7));
        painter.rect_stroke(inner, 0.0, thin, eframe::egui::StrokeKind::Outside);
        for tick in across {
            let x = self.at(tick.at, 0.0).x;
            let long = if tick.label.is_empty() { 0.5 * TICK } else { TICK };
            painter.line_segment([pos2(x, inner.bottom()), pos2(x, inner.bottom() + long)], thin);
            let place = pos2(x, inner.bottom() + TICK + 1.0);
            painter.text(place, Align2::CENTER_TOP, &tick.label, font(), colour);
        }
        for tick in up {
            let y = self.at(0.0, tick.at).y;
            let long = if tick.label.is_empty() { 0.5 * TICK } else { TICK };
            painter.line_segment([pos2(inner.left() - long, y), pos2(inner.left(), y)], thin);
            let place = pos2(inner.left() - TICK - 2.0, y);
            painter.text(place, Align2::RIGHT_CENTER, &tick.label, font(), colour);
        }
        let strong = ui.visuals().strong_text_color();
        painter.text(
            pos2(self.outer.left() + 2.0, inner.top() - 5.0),
            Align2::LEFT_BOTTOM,
            labels[1],
            font(),
            strong,
        );
        let foot = pos2(inner.center().x, inner.bottom() + TICK + SIZE + 5.0);
        painter.text(foot, Align2::CENTER_TOP, labels[0], font(), strong);
    }

    /// The bar that says what colours mean.
    pub(super) fn draw_bar(&self, ui: &Ui, ticks: &[Tick], colour_at: impl Fn(f64) -> Color32) {
        let (painter, colour) = (ui.painter(), ui.visuals().text_color());
        let left = self.inner.right() + 9.0;
        let bar = Rect::from_min_max(pos2(left, self.inner.top()), pos2(left + BAR, self.inner.bottom()));
        let steps = bar.height().ceil().max(1.0) as u32;
        for step in 0..steps {
            let at = |step: u32| bar.bottom() - step as f32 / steps as f32 * bar.height();
            let strip = Rect::from_min_max(pos2(bar.left(), at(step + 1)), pos2(bar.right(), at(step)));
            painter.rect_filled(strip, 0.0, colour_at((f64::from(step) + 0.5) / f64::from(steps)));
        }
        let thin = Stroke::new(1.0, colour.gamma_multiply(0.7));
        painter.rect_stroke(bar, 0.0, thin, eframe::egui::StrokeKind::Outside);
        for tick in ticks {
            let y = self.at(0.0, tick.at).y;
            let long = if tick.label.is_empty() { 0.5 * TICK } else { TICK };
            painter.line_segment([pos2(bar.right(), y), pos2(bar.right() + long, y)], thin);
            let place = pos2(bar.right() + TICK + 2.0, y);
            painter.text(place, Align2::LEFT_CENTER, &tick.label, font(), colour);
        }
    }
}

/// Width of the bar of colours, points.
const BAR: f32 = 10.0;

fn font() -> FontId {
    FontId::proportional(SIZE)
}

/// A colour of a figure, faint where what it shows does not hold any more.
pub(super) fn shade([r, g, b]: Rgb, faded: bool) -> Color32 {
    let [r, g, b] = [r, g, b].map(|channel| (channel * 255.0).round() as u8);
    let colour = Color32::from_rgb(r, g, b);
    if faded { colour.gamma_multiply(0.35) } else { colour }
}

/// Which of the parts between `edges` holds a share.
pub(super) fn part(edges: &[f64], share: f64) -> Option<u64> {
    let found = edges.windows(2).position(|ends| (ends[0]..ends[1]).contains(&share));
    found.map(|found| found as u64)
}
