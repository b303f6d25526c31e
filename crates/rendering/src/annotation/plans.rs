//! Plans to goals on the ground: the ground that each robot is to sweep, coloured by the shape of the formation, and the way of
//! the lead.

use super::annotations::{AnnotationStroke, Annotations, Ring, StrokePoint};
use crate::palette::narrowing_colour;
use crate::picture_context::PictureContext;
use vocabulary::{PlannedPath, PlannedPoint, Pose};

/// Opacity of the ground to sweep, and of the way of the lead.
const SWEPT: f32 = 0.16;
const WAY: f32 = 0.8;
/// Way of the lead between two points, m.
const SPACING: f64 = 0.2;

/// What is left of all plans.
pub(crate) fn plans(context: &PictureContext<'_>) -> Annotations {
    let mut annotations = Annotations::default();
    let now = context.record.snapshot.time;
    let new = &context.style.annotations.plans;
    let is_replaced = |lead: &usize| new.iter().any(|plan| plan.robots.contains(lead));
    let kept = context.trail.plans.iter().filter(|(lead, _)| !is_replaced(lead)).map(|(_, plan)| plan);
    for plan in kept.chain(new) {
        let left = plan.points.partition_point(|point| point.time <= now).saturating_sub(1);
        let points = spread(&plan.points[left.min(plan.points.len())..]);
        if points.len() < 2 {
            continue;
        }
        for (k, robot) in plan.robots.iter().enumerate().rev() {
            let Some(member) = context.fleet.robots.get(*robot) else { continue };
            let middle = 0.5 * member.body.wheelbase;
            let spots = |alpha: f32| strokes(&points, k, middle, alpha);
            let band = AnnotationStroke {
                pixels: 0.0,
                metres: member.body.width,
                ..AnnotationStroke::new(spots(SWEPT))
            };
            annotations.strokes.push(band);
            if k == 0 {
                annotations
                    .strokes
                    .push(AnnotationStroke { dashed: true, ..AnnotationStroke::new(spots(WAY)) });
            }
        }
        annotations.rings.extend(goal(plan, context));
    }
    annotations
}

/// A ring where the lead is to stop for good.
fn goal(plan: &PlannedPath, context: &PictureContext<'_>) -> Option<Ring> {
    let (lead, last) = (plan.lead()?, plan.points.last()?);
    let body = &context.fleet.robots.get(lead)?.body;
    let pose = last.poses.first()?;
    let at = pose.world_from_body(0.5 * body.wheelbase, 0.0);
    let colour = context.colours.get(lead).copied().unwrap_or(narrowing_colour(0.0));
    Some(Ring { fill: 0.1, ..Ring::new(at, 0.75 * body.length, colour) })
}

/// Points so far apart that lines through them are smooth, the last included.
fn spread(points: &[PlannedPoint]) -> Vec<&PlannedPoint> {
    let mut taken: Vec<&PlannedPoint> = vec![];
    for point in points {
        let away = |a: &Pose, b: &Pose| vocabulary::math::hypot(a.x - b.x, a.y - b.y);
        let near = taken.last().is_some_and(|last| {
            last.poses.first().zip(point.poses.first()).is_some_and(|(a, b)| away(a, b) < SPACING)
        });
        if !near {
            taken.push(point);
        }
    }
    taken.extend(points.last());
    taken
}

fn strokes(points: &[&PlannedPoint], robot: usize, middle: f64, alpha: f32) -> Vec<StrokePoint> {
    let spot = |point: &&PlannedPoint| {
        let colour = narrowing_colour(point.narrowing);
        let at = point.poses.get(robot)?.world_from_body(middle, 0.0);
        Some(StrokePoint { at, colour, alpha })
    };
    points.iter().filter_map(spot).collect()
}
