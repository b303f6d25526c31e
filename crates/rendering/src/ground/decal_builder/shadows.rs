//! Shadows on the ground, and the dark where things stand on it.

use crate::gpu::model::Build;
use crate::gpu::passes::decal::DecalForm;
use crate::gpu::passes::{GREY_SKY, GREY_SUN};
use crate::gpu::props::{corners, placed, turn};
use crate::ground::decal_builder::DecalBuilder;
use crate::palette::Rgb;
use crate::picture_context::PictureContext;
use glam::{DMat3, DVec2, DVec3};
use std::collections::BTreeMap;
use vocabulary::math;
use vocabulary::{Placement, Prop, RobotInfo, RobotState, Solid};

/// Shadows are lit by the sky alone, so they are a little blue.
const SHADE: Rgb = [0.015, 0.02, 0.04];
/// How far the dark at the foot of a prop reaches, m.
const FOOT: f64 = 0.16;

/// A parallelogram on the ground: its middle and half its sides.
type Patch = [DVec2; 3];

impl DecalBuilder<'_> {
    /// Patches that surely hold all shadows: few pixels look at the shadow map.
    pub(crate) fn shadows(&mut self, context: &PictureContext<'_>) {
        // What the sun gives, of all the light on flat ground: shadows under a low sun are faint.
        let share = GREY_SUN * context.sun.z / (GREY_SUN * context.sun.z + GREY_SKY);
        let alpha = (0.80 * share) as f32;
        let robots = context.record.snapshot.robots.iter().zip(&context.fleet.robots);
        let robots = robots.filter(|(robot, _)| robot.is_present());
        let mut patches: Vec<Patch> = robots.map(|(r, m)| robot_shadow(context, r, m)).collect();
        if context.fleet.props.is_empty() {
            for [middle, along, across] in patches {
                self.patch(middle, along, across, DecalForm::Shadow, SHADE, alpha);
            }
            return;
        }
        // Props stand close together, and where patches overlap their shadows would be dark twice.
        let reach = context.shadowed;
        patches.extend(placed(context).filter_map(|(_, prop, place)| prop_shadow(context, prop, &place)));
        let near = |p: &Patch| p[0].distance(reach.0) < reach.1 * 1.5 + p[1].length() + p[2].length();
        patches.retain(near);
        let cell = (reach.1 / 40.0).clamp(0.1, 1.0);
        for (row, runs) in covered(&patches, cell) {
            for [first, last] in runs {
                let low = DVec2::new(first as f64, row as f64) * cell;
                let high = DVec2::new((last + 1) as f64, (row + 1) as f64) * cell;
                let half = (high - low) * 0.5;
                self.patch(low + half, DVec2::X * half.x, DVec2::Y * half.y, DecalForm::Shadow, SHADE, alpha);
            }
        }
    }

    /// The dark under bodies, wheels and props.
    pub(crate) fn feet(&mut self, context: &PictureContext<'_>) {
        for (_, prop, place) in placed(context).filter(|(k, ..)| !context.floor.is_drivable(*k)) {
            let height = context.floor.height(DVec3::from_array(place.position).truncate());
            self.foot(height, prop, &place);
        }
        for (robot, member) in context.record.snapshot.robots.iter().zip(&context.fleet.robots) {
            if robot.is_present() {
                self.tyres(context, robot, member);
            }
        }
    }

    /// The dark around decks, on the ground alone.
    pub(crate) fn drivable_feet(&mut self, context: &PictureContext<'_>) {
        for drivable in &context.floor.drivables {
            let prop = &context.fleet.props[drivable.prop];
            let height = context.floor.ground(DVec3::from_array(prop.placement.position).truncate());
            self.foot(height, prop, &prop.placement);
        }
    }

    fn tyres(&mut self, context: &PictureContext<'_>, robot: &RobotState, member: &RobotInfo) {
        let (pose, body) = (robot.motion.pose, member.body);
        let ahead = DVec2::from_angle(pose.heading);
        let place = |forward, left| DVec2::from_array(pose.world_from_body(forward, left));
        let gap = |at: DVec2| (robot.attitude.height - context.floor.height(at)).max(0.0) / body.wheel_radius;
        let middle = place(0.46 * body.wheelbase, 0.0);
        let upright = math::cos(robot.attitude.roll) * math::cos(robot.attitude.pitch);
        // A body that lies on its roof touches the ground with that.
        let near = if upright > 0.3 { fade(gap(middle)) } else { 0.7 };
        let sides = (ahead * (0.62 * body.length), ahead.perp() * (0.78 * body.width));
        self.patch(middle, sides.0, sides.1, DecalForm::SoftBox(0.35), [0.0; 3], 0.50 * near);
        if upright < 0.3 {
            return;
        }
        for (x, y) in [(0.0, -0.5), (0.0, 0.5), (1.0, -0.5), (1.0, 0.5)] {
            let at = place(x * body.wheelbase, y * body.track);
            let size = body.wheel_radius;
            // A body that is tilted against the ground has wheels in the air.
            let raised = wheel_height(robot, x * body.wheelbase, y * body.track) - context.floor.height(at);
            let near = fade((raised / size).max(0.0));
            let across = ahead.perp() * (0.85 * size);
            self.patch(at, ahead * (1.25 * size), across, DecalForm::Blob, [0.0; 3], 0.85 * near);
        }
    }

    /// The dark around a prop over a floor of some height.
    fn foot(&mut self, floor: f64, prop: &Prop, place: &Placement) {
        let turn = DMat3::from_quat(turn(place));
        let at = DVec3::from_array(place.position);
        let over = at.z - floor;
        // Only what stands on its foot; what lies or flies has its shadow.
        if turn.z_axis.z < 0.97 || !(-0.5..0.1).contains(&over) {
            return;
        }
        let alpha = 0.62 * (1.0 - over.max(0.0) / 0.1) as f32;
        let (ahead, aside) = (turn.x_axis.truncate(), turn.y_axis.truncate());
        // Small things darken little.
        let margin = FOOT.min(0.35 * prop.solid.extent()[2] + 0.25 * prop.solid.reach());
        match prop.solid {
            Solid::Block { size } | Solid::Wedge { size } => {
                let thin = matches!(prop.solid, Solid::Wedge { .. });
                let half = [0.5 * size[0], 0.5 * size[1]];
                self.skirt(at.truncate(), [ahead, aside], half, margin, alpha, thin);
            }
            Solid::Cylinder { radius, .. } | Solid::Cone { radius, .. } => {
                let reach = radius + 1.4 * margin;
                let shape = DecalForm::Blob;
                self.patch(at.truncate(), ahead * reach, aside * reach, shape, [0.0; 3], 1.2 * alpha);
            }
        }
    }

    /// A box with soft edges as wide on long sides as on short ones; what is `thin` where it begins darkens nothing
    /// there.
    fn skirt(
        &mut self,
        middle: DVec2,
        axes: [DVec2; 2],
        half: [f64; 2],
        margin: f64,
        alpha: f32,
        thin: bool,
    ) {
        let knots = |half: f64| [-half - margin, -half, half, half + margin];
        let shapes = [-1.0, -0.25, 0.25, 1.0];
        let (mut along, across) = (knots(half[0]), knots(half[1]));
        let mut rising = shapes;
        if thin {
            (along[0], rising[1]) = (along[1], rising[0]);
        }
        for i in 0..3 {
            for j in 0..3 {
                let at = |di: usize, dj: usize| {
                    let place = middle + axes[0] * along[i + di] + axes[1] * across[j + dj];
                    let shape = [rising[i + di], shapes[j + dj]];
                    self.corner(place, DecalForm::SoftBox(0.25), shape, [0.0; 3], alpha)
                };
                let quad = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
                self.corners.extend([0, 1, 2, 0, 2, 3].map(|k| quad[k]));
            }
        }
    }
}

/// How dark something makes the ground that is `gap` wheel radii over it.
fn fade(gap: f64) -> f32 {
    (1.0 - gap).clamp(0.0, 1.0) as f32
}

/// Height of the lowest point of a wheel over z = 0, m.
fn wheel_height(robot: &RobotState, forward: f64, left: f64) -> f64 {
    let tilt = robot.attitude;
    tilt.height - forward * math::sin(tilt.pitch) + left * math::sin(tilt.roll) * math::cos(tilt.pitch)
}

fn robot_shadow(context: &PictureContext<'_>, robot: &RobotState, member: &RobotInfo) -> Patch {
    let build = Build::new(member);
    let away = -context.sun.truncate() / context.sun.z;
    let [x, y] = robot.motion.pose.world_from_body(0.15 * member.body.length, 0.0);
    // As high as the camera on its mast, and as far around as the shell or the bonnet.
    let over = (robot.attitude.height - context.floor.ground(DVec2::new(x, y))).max(0.0);
    let (top, around) = (build.top() + over, build.around());
    let reach = away * (0.5 * top);
    let along = reach + reach.normalize_or(DVec2::X) * around;
    let across = along.perp().normalize() * around;
    [DVec2::new(x, y) + reach, along, across]
}

/// Where the shadow of a prop may fall, along the sun.
fn prop_shadow(context: &PictureContext<'_>, prop: &Prop, place: &Placement) -> Option<Patch> {
    let away = -context.sun.truncate() / context.sun.z;
    let ahead = away.normalize_or(DVec2::X);
    let foot = DVec3::from_array(place.position);
    let ground = context.floor.ground(foot.truncate());
    // Ground that falls away lengthens shadows.
    let stretch = if context.fleet.terrain.is_some() { 1.6 } else { 1.0 };
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for corner in corners(prop, place) {
        for share in [0.0, stretch * (corner.z - ground).max(0.0)] {
            let at = corner.truncate() + away * share;
            let seen = DVec2::new(at.dot(ahead), at.dot(ahead.perp()));
            (low, high) = (low.min(seen), high.max(seen));
        }
    }
    let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5 + 0.04);
    let centre = ahead * middle.x + ahead.perp() * middle.y;
    centre.is_finite().then_some([centre, ahead * half.x, ahead.perp() * half.y])
}

/// Cells of a grid that patches cover: runs of columns by row.
fn covered(patches: &[Patch], cell: f64) -> BTreeMap<i64, Vec<[i64; 2]>> {
    let mut rows: BTreeMap<i64, Vec<[i64; 2]>> = BTreeMap::new();
    for [middle, along, across] in patches {
        let reach = along.abs() + across.abs();
        let index = |x: f64| (x / cell).floor() as i64;
        for row in index(middle.y - reach.y)..=index(middle.y + reach.y) {
            let span = |sign: f64| crossing(*middle, *along, *across, row as f64 * cell, cell, sign);
            let (first, last) = (index(span(-1.0)), index(span(1.0)));
            rows.entry(row).or_default().push([first, last]);
        }
    }
    for runs in rows.values_mut() {
        runs.sort_unstable();
        let mut joined: Vec<[i64; 2]> = Vec::with_capacity(runs.len());
        for run in runs.iter() {
            match joined.last_mut() {
                Some(last) if run[0] <= last[1] + 1 => last[1] = last[1].max(run[1]),
                _ => joined.push(*run),
            }
        }
        *runs = joined;
    }
    rows
}

/// The leftmost (`sign` −1) or rightmost x of a patch within the row from `y` on, m.
fn crossing(middle: DVec2, along: DVec2, across: DVec2, y: f64, cell: f64, sign: f64) -> f64 {
    let outline = [along + across, along - across, -along - across, across - along].map(|p| middle + p);
    let mut most = f64::NEG_INFINITY;
    for k in 0..4 {
        let (a, b) = (outline[k], outline[(k + 1) % 4]);
        for p in [a, b] {
            if (y..=y + cell).contains(&p.y) {
                most = most.max(sign * p.x);
            }
        }
        for edge in [y, y + cell] {
            let share = (edge - a.y) / (b.y - a.y);
            if (0.0..=1.0).contains(&share) {
                most = most.max(sign * (a.x + (b.x - a.x) * share));
            }
        }
    }
    // A patch that only touches the row.
    if most.is_finite() { sign * most } else { middle.x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_of_every_patch_is_covered_once() {
        let patches = [
            [DVec2::new(0.3, -0.2), DVec2::new(1.0, 0.7), DVec2::new(-0.2, 0.3)],
            [DVec2::new(0.9, 0.4), DVec2::new(0.5, 0.0), DVec2::new(0.0, 0.6)],
        ];
        let cell = 0.13;
        let rows = covered(&patches, cell);
        for [middle, along, across] in patches {
            for (u, v) in (-10..=10).flat_map(|u| (-10..=10).map(move |v| (u, v))) {
                let at = middle + along * (f64::from(u) * 0.099) + across * (f64::from(v) * 0.099);
                let (column, row) = ((at.x / cell).floor() as i64, (at.y / cell).floor() as i64);
                let hits = rows[&row].iter().filter(|run| (run[0]..=run[1]).contains(&column)).count();
                assert_eq!(hits, 1, "{at}");
            }
        }
    }
}
