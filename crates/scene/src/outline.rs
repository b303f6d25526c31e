//! Outlines of bodies as seen from above, and whether they overlap.

use crate::Robot;
use vocabulary::{Pose, Solid, math};

/// Overlaps smaller than this are rounding, m.
const ROUNDING: f64 = 1e-9;

/// What a body covers of the ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outline {
    /// Middle and direction.
    pose: Pose,
    form: OutlineForm,
    /// Largest distance from the middle, m.
    reach: f64,
}

#[derive(Debug, Clone, Copy)]
enum OutlineForm {
    /// Half of [length, width], m.
    Box([f64; 2]),
    /// Radius, m.
    Disc(f64),
}

impl Outline {
    fn new(pose: Pose, form: OutlineForm) -> Self {
        let reach = match form {
            OutlineForm::Box([length, width]) => math::hypot(length, width),
            OutlineForm::Disc(radius) => radius,
        };
        Self { pose, form, reach }
    }

    /// Of a robot at its start.
    pub(crate) fn of_robot(robot: &Robot) -> Self {
        let body = robot.vehicle.body();
        let [x, y] = robot.pose.world_from_body(0.5 * body.wheelbase, 0.0);
        let pose = Pose::new(x, y, robot.pose.heading);
        Self::new(pose, OutlineForm::Box([0.5 * body.length, 0.5 * body.width]))
    }

    /// Of a solid at a pose.
    pub(crate) fn of_solid(solid: Solid, pose: Pose) -> Self {
        let form = match solid {
            Solid::Block { size } | Solid::Wedge { size } => OutlineForm::Box([0.5 * size[0], 0.5 * size[1]]),
            Solid::Cylinder { radius, .. } | Solid::Cone { radius, .. } => OutlineForm::Disc(radius),
        };
        Self::new(pose, form)
    }

    /// [least, largest] x that it may cover, m.
    pub(crate) fn span(&self) -> [f64; 2] {
        [self.pose.x - self.reach, self.pose.x + self.reach]
    }

    fn apart(&self, other: &Self) -> f64 {
        let [x, y] = [self.pose.x - other.pose.x, self.pose.y - other.pose.y];
        (x * x + y * y).sqrt()
    }

    /// Whether discs around both are at least `distance` (m) apart.
    pub(crate) fn far_from(&self, other: &Self, distance: f64) -> bool {
        self.apart(other) - self.reach - other.reach >= distance
    }

    /// Whether they overlap; touching is none.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        if self.apart(other) >= self.reach + other.reach - ROUNDING {
            return false;
        }
        // Convex shapes are apart where some line divides them: along a side of a box, or across the way from a disc's
        // middle to the box's nearest point.
        match (self.form, other.form) {
            (OutlineForm::Box(_), OutlineForm::Box(_)) => !self.beside(other) && !other.beside(self),
            (OutlineForm::Box(half), OutlineForm::Disc(radius)) => self.covers_near(half, other.pose, radius),
            (OutlineForm::Disc(radius), OutlineForm::Box(half)) => other.covers_near(half, self.pose, radius),
            (OutlineForm::Disc(_), OutlineForm::Disc(_)) => true,
        }
    }

    /// Whether a point of this box with these half sides is nearer than `radius` to the middle of a disc.
    fn covers_near(&self, half: [f64; 2], disc: Pose, radius: f64) -> bool {
        let [forward, left] = self.seen([disc.x - self.pose.x, disc.y - self.pose.y]);
        let [a, b] = [forward.abs() - half[0], left.abs() - half[1]].map(|beyond| beyond.max(0.0));
        math::hypot(a, b) < radius - ROUNDING
    }

    /// Whether a side of this box divides it from another box.
    fn beside(&self, other: &Self) -> bool {
        let (OutlineForm::Box(half), OutlineForm::Box([length, width])) = (self.form, other.form) else {
            return false;
        };
        let [forward, left] = self.seen([other.pose.x - self.pose.x, other.pose.y - self.pose.y]);
        let (sin, cos) = math::sin_cos(other.pose.heading - self.pose.heading);
        let [sin, cos] = [sin.abs(), cos.abs()];
        forward.abs() >= half[0] + length * cos + width * sin - ROUNDING
            || left.abs() >= half[1] + length * sin + width * cos - ROUNDING
    }

    /// A direction of the world as [forward, left].
    fn seen(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = math::sin_cos(self.pose.heading);
        [x * cos + y * sin, y * cos - x * sin]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_4;

    fn block(length: f64, width: f64, x: f64, y: f64, heading: f64) -> Outline {
        Outline::of_solid(Solid::Block { size: [length, width, 1.0] }, Pose::new(x, y, heading))
    }

    fn disc(radius: f64, x: f64, y: f64) -> Outline {
        Outline::of_solid(Solid::Cylinder { radius, height: 1.0 }, Pose::new(x, y, 0.0))
    }

    #[test]
    fn boxes_overlap_touch_and_part() {
        let a = block(2.0, 1.0, 0.0, 0.0, 0.0);
        for (b, wanted) in [
            (block(2.0, 1.0, 1.99, 0.0, 0.0), true),
            (block(2.0, 1.0, 2.0, 0.0, 0.0), false),
            (block(2.0, 1.0, 1.9, 1.01, 0.0), false),
            (block(1.0, 1.0, 0.0, 0.5 + 0.5f64.sqrt() - 0.01, FRAC_PI_4), true),
            (block(1.0, 1.0, 0.0, 0.5 + 0.5f64.sqrt() + 0.01, FRAC_PI_4), false),
            // Within each other's bounding boxes, and still apart.
            (block(1.0, 1.0, 1.0 + 0.4, 0.5 + 0.4, FRAC_PI_4), false),
            (block(0.1, 0.1, 0.3, 0.2, 1.0), true),
        ] {
            assert_eq!((a.overlaps(&b), b.overlaps(&a)), (wanted, wanted), "{b:?}");
        }
    }

    #[test]
    fn discs_overlap_boxes_near_their_corners_only() {
        let a = block(2.0, 1.0, 0.0, 0.0, FRAC_PI_4);
        for (forward, left, wanted) in
            [(1.29, 0.0, true), (1.31, 0.0, false), (1.2, 0.7, true), (1.22, 0.72, false), (0.0, 0.0, true)]
        {
            let [x, y] = a.pose.world_from_body(forward, left);
            let b = disc(0.3, x, y);
            assert_eq!((a.overlaps(&b), b.overlaps(&a)), (wanted, wanted), "{forward} {left}");
        }
    }
}
