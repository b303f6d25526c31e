//! How much room there is between robots: the distance between the outlines of their bodies on the plane.

use vocabulary::{Body, Cast, Pose, Snapshot};

/// Two robots and the room between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closest {
    /// m between the outlines; 0 where they touch or overlap.
    pub clearance: f64,
    /// Indices of the two, the smaller first.
    pub robots: [usize; 2],
}

/// The two robots that are closest, looked for only among those nearer than `below` m.
///
/// Robots are swept in the order of x, so that a hundred cost little more than a few.
pub fn closest(cast: &Cast, snapshot: &Snapshot, below: f64, order: &mut Vec<usize>) -> Option<Closest> {
    let pose = |i: usize| middle(snapshot.robots[i].motion.pose, &cast.members[i].body);
    let reach = |i: usize| radius(&cast.members[i].body);
    let largest = cast.members.iter().map(|m| radius(&m.body)).fold(0.0, f64::max);
    if order.len() != snapshot.robots.len() {
        *order = (0..snapshot.robots.len()).collect();
    }
    order.sort_by(|&a, &b| pose(a).x.total_cmp(&pose(b).x));
    let mut best: Option<Closest> = None;
    for (rank, &i) in order.iter().enumerate() {
        for &j in &order[rank + 1..] {
            let limit = best.map_or(below, |b| b.clearance);
            let (p, q) = (pose(i), pose(j));
            if q.x - p.x - reach(i) - largest > limit {
                break;
            }
            if (q.x - p.x).hypot(q.y - p.y) - reach(i) - reach(j) > limit {
                continue;
            }
            let clearance = between_middles(p, &cast.members[i].body, q, &cast.members[j].body);
            if clearance < limit {
                best = Some(Closest { clearance, robots: [i.min(j), i.max(j)] });
            }
        }
    }
    best
}

/// Half the diagonal, m.
fn radius(body: &Body) -> f64 {
    body.length.hypot(body.width) / 2.0
}

/// m between the outlines of two robots at poses `a` and `b`; 0 where they touch or overlap.
pub fn between(a: Pose, body_a: &Body, b: Pose, body_b: &Body) -> f64 {
    between_middles(middle(a, body_a), body_a, middle(b, body_b), body_b)
}

/// As [`between`], from the middles of the bodies.
fn between_middles(a: Pose, body_a: &Body, b: Pose, body_b: &Body) -> f64 {
    let (outline_a, outline_b) = (outline(a, body_a), outline(b, body_b));
    if overlap(a, body_a, &outline_b) || overlap(b, body_b, &outline_a) || cross(&outline_a, &outline_b) {
        return 0.0;
    }
    let corners = |from: &[[f64; 2]; 4], to: &[[f64; 2]; 4]| {
        let sides = (0..4).flat_map(|k| from.iter().map(move |p| to_side(*p, to[k], to[(k + 1) % 4])));
        sides.fold(f64::INFINITY, f64::min)
    };
    corners(&outline_a, &outline_b).min(corners(&outline_b, &outline_a))
}

/// The middle of the body, half a wheelbase ahead of the rear axle.
fn middle(pose: Pose, body: &Body) -> Pose {
    let [x, y] = pose.world_from_body(body.wheelbase / 2.0, 0.0);
    Pose { x, y, ..pose }
}

/// Corners in order, m, world frame.
fn outline(pose: Pose, body: &Body) -> [[f64; 2]; 4] {
    let (l, w) = (body.length / 2.0, body.width / 2.0);
    [[l, w], [-l, w], [-l, -w], [l, -w]].map(|[forward, left]| pose.world_from_body(forward, left))
}

/// Whether any of `points` lies in the body.
fn overlap(pose: Pose, body: &Body, points: &[[f64; 2]; 4]) -> bool {
    let (sin, cos) = pose.heading.sin_cos();
    points.iter().any(|[x, y]| {
        let (dx, dy) = (x - pose.x, y - pose.y);
        (dx * cos + dy * sin).abs() <= body.length / 2.0 && (dy * cos - dx * sin).abs() <= body.width / 2.0
    })
}

/// Whether any sides cross: two long bodies may, without a corner in one another.
fn cross(a: &[[f64; 2]; 4], b: &[[f64; 2]; 4]) -> bool {
    let turn =
        |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let sides = |o: &[[f64; 2]; 4]| [0, 1, 2, 3].map(|k| (o[k], o[(k + 1) % 4]));
    sides(a).iter().any(|&(p, q)| {
        sides(b)
            .iter()
            .any(|&(r, s)| turn(p, q, r) * turn(p, q, s) < 0.0 && turn(r, s, p) * turn(r, s, q) < 0.0)
    })
}

/// m from a point to a side.
fn to_side(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let along = (((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    (p[0] - a[0] - along * dx).hypot(p[1] - a[1] - along * dy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use vocabulary::{Member, RobotState};

    const BODY: Body =
        Body { length: 0.4, width: 0.2, height: 0.2, wheelbase: 0.3, track: 0.2, wheel_radius: 0.05 };

    #[test]
    fn known_distances() {
        let at = |x: f64, y: f64, heading: f64| {
            between_middles(Pose::default(), &BODY, Pose::new(x, y, heading), &BODY)
        };
        assert!((at(1.0, 0.0, 0.0) - 0.6).abs() < 1e-12);
        assert!((at(0.0, 1.0, 0.0) - 0.8).abs() < 1e-12);
        assert!((at(1.0, 0.0, std::f64::consts::FRAC_PI_2) - 0.7).abs() < 1e-12);
        assert!((at(1.0, 1.0, 0.0) - 0.6_f64.hypot(0.8)).abs() < 1e-12);
        assert_eq!(at(0.3, 0.05, 0.1), 0.0);
        assert_eq!(at(0.0, 0.0, std::f64::consts::FRAC_PI_2), 0.0, "crossed without a corner inside");
    }

    /// Two robots face to face are closer than their rear axles tell.
    #[test]
    fn bodies_reach_ahead_of_their_rear_axles() {
        let facing = between(Pose::default(), &BODY, Pose::new(1.0, 0.0, std::f64::consts::PI), &BODY);
        let ahead = BODY.wheelbase / 2.0 + BODY.length / 2.0;
        assert!((facing - (1.0 - 2.0 * ahead)).abs() < 1e-12, "{facing}");
    }

    proptest! {
        /// The sweep finds what trying all pairs finds.
        #[test]
        fn sweeping_equals_trying_all(poses in proptest::collection::vec((-3.0..3.0, -3.0..3.0, -3.0..3.0), 2..12)) {
            let poses: Vec<Pose> = poses.into_iter().map(|(x, y, h)| Pose::new(x, y, h)).collect();
            let member = Member { name: String::new(), leads: false, body: BODY };
            let cast = Cast { members: vec![member; poses.len()], ..Cast::default() };
            let mut robots = vec![RobotState::default(); poses.len()];
            for (robot, pose) in robots.iter_mut().zip(&poses) {
                robot.motion.pose = *pose;
            }
            let snapshot = Snapshot { time: 0.0, robots, props: vec![] };
            let swept = closest(&cast, &snapshot, f64::INFINITY, &mut vec![]).expect("two robots");
            let mut least = f64::INFINITY;
            for i in 0..poses.len() {
                for j in 0..i {
                    least = least.min(between(poses[i], &BODY, poses[j], &BODY));
                }
            }
            prop_assert_eq!(swept.clearance, least);
        }
    }
}
