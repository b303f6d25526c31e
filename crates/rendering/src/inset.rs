//! The chart in the corner: error of each edge over the whole run so far.

use crate::labels::{Ink, Words};
use crate::paint::Stage;
use crate::view::Tile;
use glam::Vec2;

/// Size at scale 1, pixels.
const SIZE: [f32; 2] = [320.0, 130.0];
const MARGIN: f32 = 24.0;

/// Where the panel is in a tile; nothing where it would fill the tile.
fn place(words: &Words<'_>, tile: Tile) -> Option<[f32; 4]> {
    let [width, height] = SIZE.map(|s| words.scaled(s));
    let margin = words.scaled(MARGIN);
    let [right, bottom] = [tile.width, tile.height].map(|side| side as f32 - margin);
    let fits = right - width > words.scaled(150.0) && bottom - height > 0.45 * tile.height as f32;
    fits.then_some([tile.x as f32 + right - width, tile.y as f32 + bottom - height, width, height])
}

/// Maps time and error to pixels.
struct Axes {
    left: f32,
    right: f32,
    zero: f32,
    metre: f32,
    duration: f32,
}

impl Axes {
    fn at(&self, time: f64, error: f32) -> Vec2 {
        let share = (time as f32 / self.duration).clamp(0.0, 1.0);
        Vec2::new(self.left + share * (self.right - self.left), self.zero - error * self.metre)
    }
}

/// Draws panel, axes and curves.
pub(crate) fn inset(words: &mut Words<'_>, stage: &Stage<'_>, tile: Tile) {
    let entries = &stage.trail.errors.entries;
    let Some(panel) = place(words, tile).filter(|_| !stage.cast.edges.is_empty()) else { return };
    let now = stage.moment.snapshot.time;
    words.reserve(panel);
    let radius = words.scaled(7.0);
    words.shapes.panel(panel, radius, [0.98, 0.98, 0.97, 0.80]);
    let [x, y, width, height] = panel;
    let most = entries.iter().flat_map(|(_, e)| e.iter()).map(|e| e[0].abs()).filter(|e| e.is_finite());
    let limit = ceiling(most.fold(0.02, f32::max));
    let (top, bottom) = (y + words.scaled(26.0), y + height - words.scaled(20.0));
    let axes = Axes {
        left: x + words.scaled(48.0),
        right: x + width - words.scaled(14.0),
        zero: 0.5 * (top + bottom),
        metre: 0.5 * (bottom - top) / limit,
        duration: stage.cast.duration.max(now).max(1e-3) as f32,
    };
    frame(words, &axes, limit, [x, top, bottom]);
    curves(words, stage, &axes, limit);
}

/// A round number not below `most`.
fn ceiling(most: f32) -> f32 {
    let power = 10.0_f32.powf(most.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|n| n * power).find(|n| *n >= most * 0.999).unwrap_or(most)
}

fn frame(words: &mut Words<'_>, axes: &Axes, limit: f32, [x, top, bottom]: [f32; 3]) {
    let thin = words.scaled(1.0);
    let ink = |alpha: f32| [0.07, 0.09, 0.11, alpha];
    for (height, alpha) in [(top, 0.15), (axes.zero, 0.55), (bottom, 0.15)] {
        let height = height.round() + 0.5;
        words.shapes.line(Vec2::new(axes.left, height), Vec2::new(axes.right, height), thin, ink(alpha));
    }
    let unit = if limit < 0.1 { "cm" } else { "m" };
    words.write(
        "distance error of each edge".into(),
        [x + words.scaled(12.0), top - words.scaled(13.0)],
        11.0,
        true,
        Ink::ON_PANEL,
    );
    let shown = if limit < 0.1 { limit * 100.0 } else { limit };
    let rows = [
        (format!("{shown} {unit}"), top),
        ("0".into(), axes.zero),
        (format!("\u{2212}{shown} {unit}"), bottom),
    ];
    for (text, height) in rows {
        let width = words.width(&text, 10.0, false);
        words.write(text, [axes.left - width - words.scaled(5.0), height], 10.0, false, Ink::ON_PANEL);
    }
    let under = bottom + words.scaled(11.0);
    words.write("0".into(), [axes.left, under], 10.0, false, Ink::ON_PANEL);
    let text = format!("{} s", (axes.duration * 10.0).round() / 10.0);
    let width = words.width(&text, 10.0, false);
    words.write(text, [axes.right - width, under], 10.0, false, Ink::ON_PANEL);
}

fn curves(words: &mut Words<'_>, stage: &Stage<'_>, axes: &Axes, limit: f32) {
    let now = stage.moment.snapshot.time;
    let wide = words.scaled(if stage.cast.edges.len() > 12 { 1.0 } else { 1.6 });
    for (index, edge) in stage.cast.edges.iter().enumerate() {
        let [r, g, b] = stage.colours[edge.follower];
        // A little darker than on the ground: the panel is bright.
        let colour = [r * 0.86, g * 0.86, b * 0.86, 0.95];
        let last = stage.moment.edges.get(index).map(|e| (now, e.error[0] as f32));
        let past = stage.trail.errors.entries.iter().filter_map(|(t, e)| e.get(index).map(|e| (*t, e[0])));
        let points = past.filter(|(t, _)| *t < now).chain(last).filter(|(_, e)| e.is_finite());
        let mut before: Option<Vec2> = None;
        for (time, error) in points {
            let at = axes.at(time, error.clamp(-limit, limit));
            // Steps below a pixel would only cost time.
            if before.is_none_or(|b| b.distance(at) > 0.9) {
                if let Some(from) = before {
                    words.shapes.line(from, at, wide, colour);
                }
                before = Some(at);
            }
        }
        if let Some(end) = before {
            let dot = words.scaled(2.5);
            words.shapes.panel([end.x - dot, end.y - dot, 2.0 * dot, 2.0 * dot], dot, colour);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_is_round_and_large_enough() {
        for (most, wanted) in [(0.02, 0.02), (0.021, 0.05), (0.3, 0.5), (1.0, 1.0), (7.0, 10.0)] {
            assert!((ceiling(most) - wanted).abs() < 1e-6 * wanted, "{most}: {}", ceiling(most));
        }
    }
}
