//! Outlines of what a proximity sensor has measured: more than the nearest point, for who looks whether a way is free.

use crate::proximity::gap_to;
use vocabulary::{EntityId, Placement, Pose, Solid, math};

/// What is known of the shape of one thing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Outline {
    pub(crate) thing: EntityId,
    solid: Solid,
    placement: Placement,
    /// Whether it is in the way: robots are that drive no more.
    stands: bool,
}

/// A robot that has not gone on for this long stands, s.
const STANDS: f64 = 1.0;

impl Outline {
    /// Of a prop. Its nearest point to the sensor is measured at another place than where it is, and all of it with that:
    /// `[sensor, nearest, measured]`, m.
    pub(crate) fn prop(
        thing: EntityId,
        solid: &Solid,
        placement: &Placement,
        [from, nearest, measured]: [[f64; 2]; 3],
    ) -> Self {
        let mut placement = *placement;
        if nearest != measured {
            let direction = |[x, y]: [f64; 2]| math::atan2(y - from[1], x - from[0]);
            let turn = direction(measured) - direction(nearest);
            let (sin, cos) = math::sin_cos(turn);
            let turned = |[x, y]: [f64; 2]| {
                let [dx, dy] = [x - from[0], y - from[1]];
                [from[0] + cos * dx - sin * dy, from[1] + sin * dx + cos * dy]
            };
            let [x, y, z] = placement.position;
            let ([at, to], [half_sin, half_cos]) = ([turned([x, y]), turned(nearest)], half(turn));
            placement.position = [at[0] + measured[0] - to[0], at[1] + measured[1] - to[1], z];
            let [qx, qy, qz, qw] = placement.rotation;
            placement.rotation = [
                half_cos * qx - half_sin * qy,
                half_cos * qy + half_sin * qx,
                half_cos * qz + half_sin * qw,
                half_cos * qw - half_sin * qz,
            ];
        }
        Self { thing, solid: *solid, placement, stands: true }
    }

    /// Of a robot within a circle that has not gone on for `stood` s.
    pub(crate) fn robot(thing: EntityId, [x, y]: [f64; 2], radius: f64, stood: f64) -> Self {
        Self {
            thing,
            solid: Solid::Cylinder { radius, height: 1.0 },
            placement: Placement::upright(Pose::new(x, y, 0.0), 0.0),
            stands: stood >= STANDS,
        }
    }

    /// Whether it leaves a circle free, or only touches it beyond `range` m from the sensor at `from`.
    pub(crate) fn leaves(&self, place: [f64; 2], radius: f64, from: [f64; 2], range: f64) -> bool {
        if !self.stands {
            return true;
        }
        let Some((normal, gap)) = gap_to(&self.solid, &self.placement, place, 0.0) else { return true };
        let hit = [0, 1].map(|k| place[k] - gap * normal[k]);
        gap >= radius || math::hypot(hit[0] - from[0], hit[1] - from[1]) > range
    }
}

/// [sin, cos] of half an angle.
fn half(angle: f64) -> [f64; 2] {
    let (sin, cos) = math::sin_cos(0.5 * angle);
    [sin, cos]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wall(pose: Pose) -> (Solid, Placement) {
        (Solid::Block { size: [0.4, 6.0, 1.0] }, Placement::upright(pose, 0.0))
    }

    #[test]
    fn a_wall_is_in_the_way_all_along_and_not_beyond_the_range() {
        let (solid, placement) = wall(Pose::new(9.2, 4.0, 0.0));
        let thing = EntityId::Prop(0);
        let outline = Outline::prop(thing, &solid, &placement, [[0.0; 2]; 3]);
        let leaves = |place: [f64; 2], range: f64| outline.leaves(place, 0.37, [0.0; 2], range);
        assert!(!leaves([8.7, 1.2], 12.0) && !leaves([9.0, 6.9], 12.0) && !leaves([9.2, 3.0], 12.0));
        assert!(leaves([9.0, 0.6], 12.0) && leaves([8.6, 2.0], 12.0));
        // [9.0, 6.9] is 11.3 m away.
        assert!(leaves([8.7, 6.9], 11.0));
    }

    /// An error of a measurement moves and turns the whole wall about the sensor.
    #[test]
    fn a_wall_is_where_it_was_measured() {
        let (solid, placement) = wall(Pose::new(5.0, 0.0, 0.3));
        let from = [1.0, -1.0];
        let (normal, distance) = gap_to(&solid, &placement, from, 0.0).expect("a wall");
        let nearest = [0, 1].map(|k| from[k] - distance * normal[k]);
        let direction = math::atan2(-normal[1], -normal[0]) + 0.05;
        let (sin, cos) = math::sin_cos(direction);
        let measured = [from[0] + (distance + 0.1) * cos, from[1] + (distance + 0.1) * sin];
        let outline = Outline::prop(EntityId::Prop(0), &solid, &placement, [from, nearest, measured]);
        let (normal, found) = gap_to(&outline.solid, &outline.placement, from, 0.0).expect("a wall");
        assert!((found - distance - 0.1).abs() < 1e-12);
        assert!((math::atan2(-normal[1], -normal[0]) - direction).abs() < 1e-12);
    }

    #[test]
    fn robots_are_in_the_way_once_they_stand() {
        let drives = Outline::robot(EntityId::Robot(1), [2.0, 0.0], 0.24, 0.4);
        let stands = Outline::robot(EntityId::Robot(1), [2.0, 0.0], 0.24, 1.2);
        assert!(drives.leaves([2.0, 0.3], 0.37, [0.0; 2], 8.0));
        assert!(!stands.leaves([2.0, 0.3], 0.37, [0.0; 2], 8.0));
        assert!(stands.leaves([2.0, 0.7], 0.37, [0.0; 2], 8.0));
    }
}
