//! Whether robots and props have room where they start.

use crate::{
    Ground, Robot,
    outline::Outline,
    props::Placed,
    text::{Reporter, Span},
};

/// A body at its start.
struct Footprint<'a> {
    name: &'a str,
    span: Span,
    is_prop: bool,
    outline: Outline,
    /// [foot, top], m over z = 0.
    heights: [f64; 2],
}

/// Reports robots that overlap each other or a prop where they start; props may overlap each other.
pub(crate) fn check_start<'a>(
    robots: impl Iterator<Item = (Span, &'a Robot)>,
    props: &'a [Placed],
    ground: &Ground,
    reporter: &mut Reporter,
) {
    let height = |x, y| ground.terrain.as_ref().map_or(0.0, |terrain| terrain.at(x, y).height);
    let robots = robots.map(|(span, robot)| {
        let foot = height(robot.pose.x, robot.pose.y);
        Footprint {
            name: &robot.name,
            span,
            is_prop: false,
            outline: Outline::of_robot(robot),
            heights: [foot, foot + robot.vehicle.height],
        }
    });
    let props = props.iter().map(|Placed { span, value: prop }| Footprint {
        name: &prop.name,
        span: *span,
        is_prop: true,
        outline: Outline::of_solid(prop.solid, prop.pose),
        heights: [prop.elevation, prop.elevation + prop.solid.extent()[2]],
    });
    let mut bodies: Vec<_> = robots.chain(props).collect();
    bodies.sort_by(|a, b| a.outline.span()[0].total_cmp(&b.outline.span()[0]));
    for (index, body) in bodies.iter().enumerate() {
        let end = body.outline.span()[1];
        let near = bodies.iter().skip(index + 1).take_while(|other| other.outline.span()[0] < end);
        for other in near.filter(|other| body.meets(other)) {
            if reporter.is_full() {
                return;
            }
            // The one that is written later is the one to move.
            let (first, second) = if body.span <= other.span { (body, other) } else { (other, body) };
            let message = format!("`{}` and `{}` overlap where they start", first.name, second.name);
            reporter.report(second.span, message);
        }
    }
}

impl Footprint<'_> {
    fn meets(&self, other: &Self) -> bool {
        !(self.is_prop && other.is_prop)
            && self.heights[0] < other.heights[1]
            && other.heights[0] < self.heights[1]
            && self.outline.overlaps(&other.outline)
    }
}
