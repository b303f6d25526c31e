//! How much room there is: the distance between the bodies of robots and props, by parry.
//!
//! What a robot drives on does not count: ramps, the ground, and props whose top is lower than the middle of its body.

use parry3d_f64::math::{Pose as Isometry, Rotation, Vector};
use parry3d_f64::query::distance;
use parry3d_f64::shape::{Cone, Cuboid, Cylinder, Shape};
use std::f64::consts::FRAC_PI_2;
use vocabulary::{Body, Contact, EntityId, FleetInfo, Placement, RobotState, Snapshot, Solid};

/// The room between a robot and something else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastClearance {
    /// m; 0 where the two touch or overlap.
    pub clearance: f64,
    /// What is nearest.
    pub nearest: EntityId,
    /// s.
    pub time: f64,
}

/// Keeps the least room of every robot over a run.
#[derive(Clone)]
pub struct Clearance {
    shapes: Vec<Hull>,
    least: Vec<Option<LeastClearance>>,
    robots: usize,
    /// Everything that counts, by the smallest x it reached last time.
    order: Vec<usize>,
}

/// A convex body and where it is.
#[derive(Clone)]
struct Hull {
    thing: EntityId,
    shape: std::sync::Arc<dyn Shape>,
    /// The shape's frame in that of the robot or prop.
    inside: Isometry,
    /// Radius of the ball around its middle.
    reach: f64,
    /// Half its height while it stands upright, m.
    half_height: f64,
    /// Half its sides, if it is a box.
    half: Option<Vector>,
    frame: Isometry,
}

/// Room for rounding where a bound decides that two bodies are not measured, m.
const SLACK: f64 = 1e-9;

impl Clearance {
    /// For a run of `fleet`.
    pub fn new(fleet: &FleetInfo) -> Self {
        let robots = fleet.robots.iter().enumerate().map(|(k, member)| Hull::robot(k, &member.body));
        let props = fleet.props.iter().enumerate().filter_map(|(k, prop)| Hull::prop(k, &prop.solid));
        let shapes: Vec<Hull> = robots.chain(props).collect();
        let (count, robots) = (shapes.len(), fleet.robots.len());
        Self { shapes, least: vec![None; robots], robots, order: (0..count).collect() }
    }

    /// Takes in a snapshot: robots with less room than ever before are noted.
    ///
    /// Bodies are swept in the order of x, and only those are measured that could be nearer than what is known.
    pub fn push(&mut self, snapshot: &Snapshot) {
        for hull in &mut self.shapes {
            hull.stand(snapshot);
        }
        let Self { shapes, least, robots, order } = self;
        order.retain(|&k| k >= *robots || snapshot.robots[k].is_present());
        order.sort_by(|&a, &b| shapes[a].left().total_cmp(&shapes[b].left()));
        let farthest =
            least.iter().map(|room| room.map_or(f64::INFINITY, |r| r.clearance)).fold(0.0, f64::max);
        for (rank, &i) in order.iter().enumerate() {
            for &j in &order[rank + 1..] {
                let (a, b) = (&shapes[i], &shapes[j]);
                if b.left() - a.right() > farthest {
                    break;
                }
                let limit = known(least, i).max(known(least, j));
                let apart = || a.at_least(b) >= limit || a.separation(b) >= limit + SLACK;
                if limit <= 0.0 || apart() || a.drives_over(b) || b.drives_over(a) {
                    continue;
                }
                let clearance = a.distance(b);
                for (k, other) in [(i, b.thing), (j, a.thing)] {
                    if k < *robots && clearance < known(least, k) {
                        least[k] = Some(LeastClearance { clearance, nearest: other, time: snapshot.time });
                    }
                }
            }
        }
    }

    /// Takes in a contact: between two samples a fast body comes and goes unseen by snapshots.
    pub fn touch(&mut self, contact: &Contact) {
        let hull = |thing: EntityId| self.shapes.iter().position(|hull| hull.thing == thing);
        let [Some(i), Some(j)] = contact.things.map(hull) else { return };
        let (a, b) = (&self.shapes[i], &self.shapes[j]);
        if a.drives_over(b) || b.drives_over(a) {
            return;
        }
        for (k, nearest) in [(i, b.thing), (j, a.thing)] {
            if k < self.robots && known(&self.least, k) > 0.0 {
                self.least[k] = Some(LeastClearance { clearance: 0.0, nearest, time: contact.begin });
            }
        }
    }

    /// The least room of each robot so far; `None` where there is nothing else.
    pub fn least(&self) -> &[Option<LeastClearance>] {
        &self.least
    }
}

impl Hull {
    fn robot(index: usize, body: &Body) -> Self {
        let half = Vector::new(0.5 * body.length, 0.5 * body.width, 0.5 * body.height);
        Self {
            thing: EntityId::Robot(index),
            shape: std::sync::Arc::new(Cuboid::new(half)),
            inside: Isometry::from_translation(Vector::new(0.5 * body.wheelbase, 0.0, 0.5 * body.height)),
            reach: half.length(),
            half_height: half.z,
            half: Some(half),
            frame: Isometry::identity(),
        }
    }

    fn prop(index: usize, solid: &Solid) -> Option<Self> {
        let [l, w, h] = solid.extent();
        let raised = Vector::new(0.0, 0.0, 0.5 * h);
        // parry's cylinders and cones stand along y.
        let stood = Isometry::from_parts(raised, Rotation::from_axis_angle(Vector::X, FRAC_PI_2));
        let (shape, inside): (std::sync::Arc<dyn Shape>, Isometry) = match *solid {
            Solid::Wedge { .. } => return None,
            Solid::Block { .. } => (
                std::sync::Arc::new(Cuboid::new(Vector::new(0.5 * l, 0.5 * w, 0.5 * h))),
                Isometry::from_translation(raised),
            ),
            Solid::Cylinder { radius, height } => {
                (std::sync::Arc::new(Cylinder::new(0.5 * height, radius)), stood)
            }
            Solid::Cone { radius, height } => (std::sync::Arc::new(Cone::new(0.5 * height, radius)), stood),
        };
        let reach = (0.25 * (l * l + w * w + h * h)).sqrt();
        Some(Self {
            thing: EntityId::Prop(index),
            shape,
            inside,
            reach,
            half_height: 0.5 * h,
            half: matches!(solid, Solid::Block { .. }).then(|| Vector::new(0.5 * l, 0.5 * w, 0.5 * h)),
            frame: Isometry::identity(),
        })
    }

    fn stand(&mut self, snapshot: &Snapshot) {
        let frame = match self.thing {
            EntityId::Robot(index) => snapshot.robots.get(index).map(of_robot),
            EntityId::Prop(index) => snapshot.props.get(index).map(of_placement),
            EntityId::Ground => None,
        };
        if let Some(frame) = frame {
            self.frame = frame * self.inside;
        }
    }

    fn left(&self) -> f64 {
        self.frame.translation.x - self.reach
    }

    fn right(&self) -> f64 {
        self.frame.translation.x + self.reach
    }

    /// Whether the other is a prop lower than the middle of this robot's body.
    fn drives_over(&self, other: &Self) -> bool {
        let robot = matches!(self.thing, EntityId::Robot(_)) && matches!(other.thing, EntityId::Prop(_));
        robot && other.frame.translation.z + other.half_height < self.frame.translation.z
    }

    /// A lower bound of the distance, m.
    fn at_least(&self, other: &Self) -> f64 {
        (self.frame.translation - other.frame.translation).length() - self.reach - other.reach
    }

    /// A better lower bound of the distance of two boxes, m: how far apart they are along one of their own axes.
    fn separation(&self, other: &Self) -> f64 {
        let (Some(a), Some(b)) = (self.half, other.half) else { return f64::NEG_INFINITY };
        let between = other.frame.translation - self.frame.translation;
        let axes = |hull: &Self| [Vector::X, Vector::Y, Vector::Z].map(|axis| hull.frame.rotation * axis);
        let (own, others) = (axes(self), axes(other));
        let reach = |axes: &[Vector; 3], half: Vector, along: Vector| {
            let [x, y, z] = axes.map(|axis| axis.dot(along).abs());
            x * half.x + y * half.y + z * half.z
        };
        let along = own
            .iter()
            .chain(&others)
            .map(|axis| between.dot(*axis).abs() - reach(&own, a, *axis) - reach(&others, b, *axis));
        along.fold(f64::NEG_INFINITY, f64::max)
    }

    fn distance(&self, other: &Self) -> f64 {
        // All shapes here are convex, which parry can measure.
        distance(&self.frame, self.shape.as_ref(), &other.frame, other.shape.as_ref())
            .map_or(f64::INFINITY, |found| found.distance)
    }
}

/// The least room known of body `k`, m: that of props is not asked for.
fn known(least: &[Option<LeastClearance>], k: usize) -> f64 {
    least.get(k).map_or(0.0, |room| room.map_or(f64::INFINITY, |room| room.clearance))
}

fn of_robot(robot: &RobotState) -> Isometry {
    let (pose, attitude) = (robot.motion.pose, robot.attitude);
    let turn = Rotation::from_rotation_z(pose.heading)
        * Rotation::from_rotation_y(attitude.pitch)
        * Rotation::from_rotation_x(attitude.roll);
    Isometry::from_parts(Vector::new(pose.x, pose.y, attitude.height), turn)
}

fn of_placement(placement: &Placement) -> Isometry {
    let [x, y, z, w] = placement.rotation;
    Isometry::from_parts(Vector::from(placement.position), Rotation::from_xyzw(x, y, z, w))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use vocabulary::math;
    use vocabulary::{Mobility, Pose, Prop, RobotInfo};

    const BODY: Body =
        Body { length: 0.4, width: 0.2, height: 0.2, wheelbase: 0.3, track: 0.2, wheel_radius: 0.05 };

    fn fleet(robots: usize, props: &[Solid]) -> FleetInfo {
        let member = RobotInfo::new("", false, BODY);
        let prop = |solid: &Solid| Prop {
            name: String::new(),
            solid: *solid,
            placement: Placement::default(),
            mobility: Mobility::Fixed,
        };
        FleetInfo {
            robots: vec![member; robots],
            props: props.iter().map(prop).collect(),
            ..FleetInfo::default()
        }
    }

    fn snapshot(poses: &[Pose], props: &[Pose]) -> Snapshot {
        let robot = |pose: &Pose| {
            let mut robot = RobotState::default();
            robot.motion.pose = *pose;
            robot
        };
        let props = props.iter().map(|pose| Placement::upright(*pose, 0.0)).collect();
        Snapshot { time: 1.0, robots: poses.iter().map(robot).collect(), props }
    }

    fn least(fleet: &FleetInfo, snapshot: &Snapshot) -> Vec<Option<LeastClearance>> {
        let mut clearance = Clearance::new(fleet);
        clearance.push(snapshot);
        clearance.least().to_vec()
    }

    /// A fast body that was past a robot at every sample touched it all the same.
    #[test]
    fn a_contact_between_two_samples_leaves_no_room() {
        let fleet = fleet(2, &[Solid::Block { size: [0.3; 3] }]);
        let mut clearance = Clearance::new(&fleet);
        clearance.push(&snapshot(&[Pose::default(), Pose::new(9.0, 0.0, 0.0)], &[Pose::new(0.0, 1.0, 0.0)]));
        assert!(clearance.least()[0].is_some_and(|room| room.clearance > 0.5));
        let things = [EntityId::Robot(0), EntityId::Prop(0)];
        let contact = Contact {
            number: 0,
            things,
            begin: 0.6,
            end: 0.6,
            open: false,
            place: [0.0; 3],
            normal: [1.0, 0.0, 0.0],
            impulse: 0.0,
        };
        clearance.touch(&contact);
        let room = LeastClearance { clearance: 0.0, nearest: things[1], time: 0.6 };
        assert_eq!(clearance.least()[0], Some(room));
        assert!(clearance.least()[1].is_some_and(|room| room.clearance > 1.0));
        clearance.touch(&Contact { things: [EntityId::Robot(1), EntityId::Ground], ..contact });
        assert!(clearance.least()[1].is_some_and(|room| room.clearance > 1.0));
    }

    #[test]
    fn known_distances() {
        let at = |x: f64, y: f64, heading: f64| {
            // The bodies' middles are half a wheelbase ahead of their poses.
            let [dx, dy] = Pose::new(0.0, 0.0, heading).world_from_body(0.15, 0.0);
            let poses = [Pose::default(), Pose::new(x + 0.15 - dx, y - dy, heading)];
            least(&fleet(2, &[]), &snapshot(&poses, &[]))[0].expect("another robot").clearance
        };
        assert!((at(1.0, 0.0, 0.0) - 0.6).abs() < 1e-9);
        assert!((at(0.0, 1.0, 0.0) - 0.8).abs() < 1e-9);
        assert!((at(1.0, 0.0, FRAC_PI_2) - 0.7).abs() < 1e-9);
        assert!((at(1.0, 1.0, 0.0) - math::hypot(0.6_f64, 0.8)).abs() < 1e-9);
        assert_eq!(at(0.3, 0.05, 0.1), 0.0);
        assert_eq!(at(0.0, 0.0, FRAC_PI_2), 0.0, "crossed without a corner inside");
    }

    #[test]
    fn props_count_and_ramps_do_not() {
        let pillar = Solid::Cylinder { radius: 0.1, height: 1.0 };
        let ramp = Solid::Wedge { size: [1.0, 1.0, 0.2] };
        let places = [Pose::new(1.15, 0.0, 0.0), Pose::default()];
        let rooms = least(&fleet(1, &[pillar, ramp]), &snapshot(&[Pose::default()], &places));
        let room = rooms[0].expect("a pillar");
        assert!((room.clearance - 0.7).abs() < 1e-6, "{room:?}");
        assert_eq!((room.nearest, room.time), (EntityId::Prop(0), 1.0));
        assert_eq!(least(&fleet(1, &[ramp]), &snapshot(&[Pose::default()], &places[1..]))[0], None);
    }

    #[test]
    fn what_is_driven_over_does_not_count() {
        let (kerb, wall) = (Solid::Block { size: [1.0, 1.0, 0.05] }, Solid::Block { size: [1.0, 1.0, 0.5] });
        let beside = [Pose::new(1.5, 0.0, 0.0)];
        let clearance = |solid| least(&fleet(1, &[solid]), &snapshot(&[Pose::default()], &beside))[0];
        assert_eq!(clearance(kerb), None);
        assert!((clearance(wall).expect("a wall").clearance - 0.65).abs() < 1e-9);
    }

    proptest! {
        /// What bounds say of two boxes is never more than their distance, also where they are tilted.
        #[test]
        fn bounds_are_below_the_distance(x in -1.0..1.0, y in -1.0..1.0, z in -1.0..1.0, turns in [-3.0..3.0, -3.0..3.0, -3.0..3.0]) {
            let [mut a, mut b] = [0, 1].map(|k| Hull::robot(k, &BODY));
            let turn = |[r, p, y]: [f64; 3]| {
                Rotation::from_rotation_z(y) * Rotation::from_rotation_y(p) * Rotation::from_rotation_x(r)
            };
            (a.frame, b.frame) = (Isometry::identity(), Isometry::from_parts(Vector::new(x, y, z), turn(turns)));
            let distance = a.distance(&b);
            prop_assert!(a.at_least(&b) <= distance + 1e-9 && a.separation(&b) <= distance + 1e-9);
            // Along an axis of the first there is nothing to lose.
            b.frame = Isometry::from_translation(Vector::new(1.0 + x.abs(), 0.0, 0.0));
            prop_assert!((a.separation(&b) - a.distance(&b)).abs() < 1e-9);
        }

        /// The sweep finds what trying all pairs finds, for every robot.
        #[test]
        fn sweeping_equals_trying_all(poses in proptest::collection::vec((-3.0..3.0, -3.0..3.0, -3.0..3.0), 2..12)) {
            let poses: Vec<Pose> = poses.into_iter().map(|(x, y, h)| Pose::new(x, y, h)).collect();
            let swept = least(&fleet(poses.len(), &[]), &snapshot(&poses, &[]));
            for (i, room) in swept.iter().enumerate() {
                let pair = |j: usize| {
                    let two = [poses[i.min(j)], poses[i.max(j)]];
                    least(&fleet(2, &[]), &snapshot(&two, &[]))[0].expect("another").clearance
                };
                let wanted = (0..poses.len()).filter(|j| *j != i).map(pair).fold(f64::INFINITY, f64::min);
                prop_assert!((room.expect("others").clearance - wanted).abs() < 1e-9);
            }
        }
    }
}
