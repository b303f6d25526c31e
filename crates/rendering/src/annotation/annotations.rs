//! Annotations on the ground: predicted paths, handles, areas, arrows and faint bodies.

use std::sync::Arc;
use vocabulary::{PlannedPath, Pose};

/// Annotations on the ground, in the order in which they are drawn. They lie under the robots and follow the floor as
/// ribbons do; items with a place or a colour that is not finite are left out.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Annotations {
    /// Shaded ground.
    pub areas: Vec<ShadedArea>,
    /// Arrows from place to place.
    pub arrows: Vec<AnnotationArrow>,
    /// Lines, such as predicted paths.
    pub strokes: Vec<AnnotationStroke>,
    /// Rings, such as handles.
    pub rings: Vec<Ring>,
    /// Faint bodies of robots where they are not; as other ghosts, not seen from just above the ground.
    pub ghosts: Vec<Ghost>,
    /// Plans that are drawn in place of those that hold for the same robots.
    pub plans: Vec<Arc<PlannedPath>>,
}

/// A place with its colour, of a line or an area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokePoint {
    /// In the world, m.
    pub at: [f64; 2],
    /// sRGB, 0 to 1 a channel.
    pub colour: [f32; 3],
    /// Opacity, 0 to 1.
    pub alpha: f32,
}

/// A smooth line through places; colour and opacity change evenly from each to the next.
#[derive(Debug, Clone, PartialEq)]
pub struct AnnotationStroke {
    /// From one end to the other.
    pub spots: Vec<StrokePoint>,
    /// Width in pixels at scale 1, however far it is.
    pub pixels: f64,
    /// Width on the ground where that is more, m.
    pub metres: f64,
    /// Whether it is dashed.
    pub dashed: bool,
}

impl AnnotationStroke {
    /// A thin line.
    pub fn new(spots: Vec<StrokePoint>) -> Self {
        Self { spots, pixels: 3.0, metres: 0.0, dashed: false }
    }

    /// A thin line of one colour that fades towards its end, like a prediction that becomes less certain.
    pub fn fading(places: &[[f64; 2]], colour: [f32; 3], alpha: f32) -> Self {
        let last = places.len().saturating_sub(1).max(1) as f32;
        // Slowly at first, so that most of the line is well seen.
        let spot = |(k, at): (usize, &[f64; 2])| {
            let share = k as f32 / last;
            StrokePoint { at: *at, colour, alpha: alpha * (1.0 - share * share) }
        };
        Self::new(places.iter().enumerate().map(spot).collect())
    }
}

/// A ring on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Its middle in the world, m.
    pub at: [f64; 2],
    /// To the outside, m.
    pub radius: f64,
    /// Least radius in pixels at scale 1, so that a handle can be grasped from afar.
    pub least: f64,
    /// Width of the line in pixels at scale 1.
    pub pixels: f64,
    /// sRGB, 0 to 1 a channel.
    pub colour: [f32; 3],
    /// Opacity of the line, 0 to 1.
    pub alpha: f32,
    /// Opacity inside, 0 to 1.
    pub fill: f32,
    /// Strength of a glow on both sides of the line, 0 to 1.
    pub glow: f32,
    /// Opacity of a dot in the middle, 0 to 1.
    pub dot: f32,
}

impl Ring {
    /// A plain ring; the fields say what else it may have.
    pub fn new(at: [f64; 2], radius: f64, colour: [f32; 3]) -> Self {
        Self { at, radius, least: 9.0, pixels: 2.5, colour, alpha: 0.95, fill: 0.0, glow: 0.0, dot: 0.0 }
    }

    /// A handle under the pointer: the line is wider, and there is a dot to grasp.
    #[must_use]
    pub fn hovered(self) -> Self {
        Self { pixels: 3.0, alpha: 1.0, fill: 0.12, glow: 0.35, dot: 0.8, ..self }
    }

    /// A handle that is dragged or selected.
    #[must_use]
    pub fn selected(self) -> Self {
        Self { pixels: 3.5, alpha: 1.0, fill: 0.16, glow: 0.8, dot: 1.0, ..self }
    }
}

/// Shaded ground, triangle by triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadedArea {
    /// Three of them are a triangle. An edge is soft where the opacity goes down to 0 towards it.
    pub corners: Vec<StrokePoint>,
    /// Stripes over the tint.
    pub hatched: bool,
}

impl ShadedArea {
    /// The area of a field of opacities, row by row in squares of `step` m from the lower left `origin` (m, world frame);
    /// what lies between is even. Squares without any opacity are left out.
    pub fn field(
        origin: [f64; 2],
        step: f64,
        columns: usize,
        alphas: &[f32],
        colour: [f32; 3],
        hatched: bool,
    ) -> Self {
        let rows = alphas.len() / columns.max(1);
        let spot = |column: usize, row: usize| StrokePoint {
            at: [origin[0] + column as f64 * step, origin[1] + row as f64 * step],
            colour,
            alpha: alphas[row * columns + column],
        };
        let mut corners = Vec::new();
        for row in 1..rows {
            for column in 1..columns {
                let quad = [(1, 1), (0, 1), (0, 0), (1, 0)].map(|(c, r)| spot(column - c, row - r));
                if quad.iter().any(|s| s.alpha > 0.0) {
                    // Along the diagonal whose ends are more alike, so that a slanting edge has no teeth.
                    let unlike = |a: usize, b: usize| (quad[a].alpha - quad[b].alpha).abs();
                    let order =
                        if unlike(0, 2) <= unlike(1, 3) { [0, 1, 2, 0, 2, 3] } else { [1, 2, 3, 1, 3, 0] };
                    corners.extend(order.map(|k| quad[k]));
                }
            }
        }
        Self { corners, hatched }
    }
}

/// A straight arrow on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnnotationArrow {
    /// Where it starts, m, world frame.
    pub from: [f64; 2],
    /// Where it points, m, world frame.
    pub to: [f64; 2],
    /// What is left out at either end, m: an arrow between robots starts and ends beside them.
    pub gaps: [f64; 2],
    /// sRGB, 0 to 1 a channel.
    pub colour: [f32; 3],
    /// Opacity, 0 to 1.
    pub alpha: f32,
}

/// The faint body of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ghost {
    /// The robot, by its index in the fleet.
    pub robot: usize,
    /// Where it stands; its height and lean are those of the floor.
    pub pose: Pose,
    /// Opacity, 0 to 1; 0.2 is faint, 0.5 clear.
    pub alpha: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_shaded_where_it_is_opaque() {
        let alphas = [0.0, 0.0, 0.0, 0.0, 0.0, 0.5];
        let area = ShadedArea::field([1.0, 2.0], 0.5, 3, &alphas, [1.0; 3], true);
        assert_eq!(area.corners.len(), 6);
        assert!(area.corners.iter().all(|s| s.at[0] >= 1.5 && s.at[1] <= 2.5));
        assert!(ShadedArea::field([0.0; 2], 1.0, 0, &[], [1.0; 3], false).corners.is_empty());
    }

    #[test]
    fn what_is_to_come_fades() {
        let stroke = AnnotationStroke::fading(&[[0.0; 2], [1.0, 0.0], [2.0, 0.0]], [1.0; 3], 0.8);
        let alphas: Vec<_> = stroke.spots.iter().map(|s| s.alpha).collect();
        assert!(alphas[0] == 0.8 && alphas[1] > 0.5 && alphas[2] == 0.0);
    }
}
