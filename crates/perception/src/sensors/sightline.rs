//! What stands between a camera and a tag.

use super::SensorConfig;
use vocabulary::{EntityId, Placement, Prop, Rigid, RobotInfo, RobotState, Snapshot, Solid, Terrain};

/// What may stand between two robots.
#[derive(Debug, Clone, Copy)]
pub struct Scenery<'a> {
    /// In the order of the snapshots.
    pub robots: &'a [RobotInfo],
    /// In the order of the snapshots.
    pub props: &'a [Prop],
    /// Flat where there is none.
    pub terrain: Option<&'a Terrain>,
}

impl Scenery<'_> {
    /// What hides the point `to` on the robot `watched` from the point `from` on the robot `watcher`, both in the
    /// world's frame, m; those two robots themselves do not count.
    pub fn hides(
        &self,
        snapshot: &Snapshot,
        [watcher, watched]: [usize; 2],
        from: [f64; 3],
        to: [f64; 3],
    ) -> Option<EntityId> {
        let others = snapshot.robots.iter().zip(self.robots).enumerate();
        let mut others =
            others.filter(|(index, (robot, _))| *index != watcher && *index != watched && robot.is_present());
        let hides =
            |(robot, info): (&RobotState, &RobotInfo)| robot_hides(info, &robot.world_from_body(), from, to);
        if let Some((index, _)) = others.find(|(_, pair)| hides(*pair)) {
            return Some(EntityId::Robot(index));
        }
        let mut props = self.props.iter().zip(&snapshot.props);
        if let Some(index) = props.position(|(prop, place)| prop_hides(prop.solid, place, from, to)) {
            return Some(EntityId::Prop(index));
        }
        let terrain = self.terrain?;
        let hidden = (1..GROUND_STEPS).any(|k| {
            let share = f64::from(k) / f64::from(GROUND_STEPS);
            let [x, y, z] = [0, 1, 2].map(|i| from[i] + (to[i] - from[i]) * share);
            terrain.at(x, y).height > z
        });
        hidden.then_some(EntityId::Ground)
    }
}

impl SensorConfig {
    /// What may stand between two robots.
    pub fn scenery(&self) -> Scenery<'_> {
        Scenery { robots: &self.robots, props: &self.props, terrain: self.terrain.as_deref() }
    }
}

/// Places along the line at which the ground is looked at.
const GROUND_STEPS: u32 = 40;

/// A robot is a box for its body and a cylinder for its shell.
fn robot_hides(info: &RobotInfo, frame: &Rigid, from: [f64; 3], to: [f64; 3]) -> bool {
    let back = frame.inverse();
    let (a, b) = (back.apply(from), back.apply(to));
    let body = info.body;
    let middle = [0.5 * body.wheelbase, 0.0, 0.5 * body.height];
    if crosses_box(
        shifted(a, middle),
        shifted(b, middle),
        [0.5 * body.length, 0.5 * body.width, 0.5 * body.height],
    ) {
        return true;
    }
    info.shell.is_some_and(|shell| {
        let foot = [shell.forward, 0.0, shell.height - 0.5 * shell.face_height];
        crosses_cylinder(shifted(a, foot), shifted(b, foot), 1.04 * shell.apothem, shell.face_height)
    })
}

fn prop_hides(solid: Solid, place: &Placement, from: [f64; 3], to: [f64; 3]) -> bool {
    let [x, y, z, w] = place.rotation;
    let rotation = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let back = Rigid { rotation, translation: place.position }.inverse();
    let (a, b) = (back.apply(from), back.apply(to));
    match solid {
        // A ramp hides what its box does: cameras seldom point along one.
        Solid::Block { size } | Solid::Wedge { size } => {
            let middle = [0.0, 0.0, 0.5 * size[2]];
            crosses_box(shifted(a, middle), shifted(b, middle), size.map(|s| 0.5 * s))
        }
        Solid::Cylinder { radius, height } => crosses_cylinder(a, b, radius, height),
        // Half as wide as its foot, on the whole.
        Solid::Cone { radius, height } => crosses_cylinder(a, b, 0.5 * radius, height),
    }
}

fn shifted(p: [f64; 3], by: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| p[k] - by[k])
}

/// Whether the way from `a` to `b` enters a box around the origin.
fn crosses_box(a: [f64; 3], b: [f64; 3], half: [f64; 3]) -> bool {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for k in 0..3 {
        let way = b[k] - a[k];
        if way.abs() < 1e-12 {
            if a[k].abs() > half[k] {
                return false;
            }
            continue;
        }
        let (s, t) = ((-half[k] - a[k]) / way, (half[k] - a[k]) / way);
        enter = enter.max(s.min(t));
        leave = leave.min(s.max(t));
    }
    enter < leave
}

/// Whether the way from `a` to `b` enters an upright cylinder that stands on the origin.
fn crosses_cylinder(a: [f64; 3], b: [f64; 3], radius: f64, height: f64) -> bool {
    let way = [0, 1, 2].map(|k| b[k] - a[k]);
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    if way[2].abs() < 1e-12 {
        if !(0.0..=height).contains(&a[2]) {
            return false;
        }
    } else {
        let (s, t) = (-a[2] / way[2], (height - a[2]) / way[2]);
        enter = enter.max(s.min(t));
        leave = leave.min(s.max(t));
    }
    let square = way[0] * way[0] + way[1] * way[1];
    let along = a[0] * way[0] + a[1] * way[1];
    let outside = a[0] * a[0] + a[1] * a[1] - radius * radius;
    if square < 1e-18 {
        return outside < 0.0 && enter < leave;
    }
    let root = along * along - square * outside;
    if root <= 0.0 {
        return false;
    }
    let root = root.sqrt();
    enter.max((-along - root) / square) < leave.min((-along + root) / square)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_meet_boxes_and_cylinders_where_they_should() {
        let half = [1.0, 0.5, 0.25];
        assert!(crosses_box([-3.0, 0.0, 0.0], [3.0, 0.1, 0.0], half));
        assert!(!crosses_box([-3.0, 0.6, 0.0], [3.0, 0.6, 0.0], half));
        assert!(!crosses_box([-3.0, 0.0, 0.0], [-1.5, 0.0, 0.0], half));
        assert!(!crosses_box([0.0, 0.0, 1.0], [0.0, 2.0, 0.0], half));
        assert!(crosses_cylinder([-2.0, 0.05, 0.4], [2.0, 0.05, 0.4], 0.1, 1.0));
        assert!(!crosses_cylinder([-2.0, 0.15, 0.4], [2.0, 0.15, 0.4], 0.1, 1.0));
        assert!(!crosses_cylinder([-2.0, 0.0, 1.2], [2.0, 0.0, 1.1], 0.1, 1.0));
        assert!(crosses_cylinder([0.0, 0.0, 2.0], [0.0, 0.0, 0.5], 0.1, 1.0));
    }

    #[test]
    fn a_turned_block_hides_what_is_behind_it() {
        let place = Placement::upright(vocabulary::Pose::new(1.0, 0.0, 0.8), 0.0);
        let solid = Solid::Block { size: [0.02, 1.0, 1.0] };
        assert!(prop_hides(solid, &place, [0.0, 0.0, 0.3], [2.0, 0.0, 0.3]));
        assert!(!prop_hides(solid, &place, [0.0, 0.0, 1.3], [2.0, 0.0, 1.3]));
        assert!(!prop_hides(solid, &place, [0.0, 0.8, 0.3], [2.0, 0.8, 0.3]));
    }
}
