//! What is under a pixel.

use crate::camera::sightline::{Sightline, ViewRay};
use crate::gpu::model::Build;
use crate::ground::decal_builder::RING;
use crate::ground::trail::{set_points, sizes};
use glam::{DVec2, DVec3};
use vocabulary::{FleetInfo, RobotInfo, RobotState, StepRecord};

/// Objects this near to a pixel count as hit, pixels.
const NEAR: f64 = 5.0;

/// An object under the pointer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Picked {
    /// A robot, by its index in the fleet.
    Robot(usize),
    /// The set point of an edge, by the index of the edge in the fleet.
    SetPoint(usize),
    /// The line from a leader to its follower, by the index of the edge in the fleet.
    Edge(usize),
}

/// What is under a pixel of a view.
pub(crate) fn pick(
    sight: &Sightline,
    fleet: &FleetInfo,
    record: &StepRecord,
    pixel: [f64; 2],
) -> Vec<Picked> {
    let ray = sight.ray(pixel);
    // Objects behind a hill do not count.
    let ground = sight.depth(&ray).map_or(f64::INFINITY, |far| far + 0.02 * far + 0.3);
    let robots = record.snapshot.robots.iter().zip(&fleet.robots).enumerate();
    let mut found: Vec<((f64, f64), Picked)> = robots
        .filter(|(_, (robot, _))| robot.is_present())
        .filter_map(|(k, (robot, member))| {
            let (beside, far) = depth(sight, &ray, robot, member, DVec2::from_array(pixel))?;
            (far < ground).then_some(((beside, far), Picked::Robot(k)))
        })
        .collect();
    found.sort_by(|((a, near), _), ((b, far), _)| a.total_cmp(b).then(near.total_cmp(far)));
    let mut picked: Vec<_> = found.into_iter().map(|(_, robot)| robot).collect();
    picked.extend(goals(sight, fleet, record, pixel));
    picked.extend(edges(sight, fleet, record, DVec2::from_array(pixel)));
    picked
}

/// How many pixels beside a robot a ray passes, and how far along the ray it is; one that is only a few pixels large need
/// not be met.
fn depth(
    sight: &Sightline,
    ray: &ViewRay,
    robot: &RobotState,
    member: &RobotInfo,
    pixel: DVec2,
) -> Option<(f64, f64)> {
    let body = &member.body;
    let frame = robot.world_from_body();
    let back = frame.inverse();
    let local = ViewRay {
        from: DVec3::from_array(back.apply(ray.from.to_array())),
        along: DVec3::from_array(back.turn(ray.along.to_array())),
    };
    let half = DVec3::new(0.5 * body.length, 0.5 * body.width, 0.5 * Build::new(member).top());
    let middle = DVec3::new(0.5 * body.wheelbase, 0.0, half.z);
    if let Some(far) = entered(&local, middle - half, middle + half) {
        return Some((0.0, far));
    }
    let place = DVec3::from_array(frame.apply(middle.to_array()));
    let at = DVec2::from_array(sight.pixel(place.to_array())?);
    let beside = at.distance(pixel);
    let far = (place - ray.from).dot(ray.along) / ray.along.length_squared();
    (beside < 2.0 * NEAR).then_some((beside, far))
}

/// How far along a ray a box is.
fn entered(ray: &ViewRay, low: DVec3, high: DVec3) -> Option<f64> {
    let (a, b) = ((low - ray.from) / ray.along, (high - ray.from) / ray.along);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    (enter <= leave && leave > 0.0).then_some(enter.max(0.0))
}

/// The set points whose rings are under a pixel, the nearest middle first.
fn goals(sight: &Sightline, fleet: &FleetInfo, record: &StepRecord, pixel: [f64; 2]) -> Vec<Picked> {
    let Some(place) = sight.ground(pixel).map(DVec2::from_array) else { return Vec::new() };
    let reach = RING * sizes(fleet).max(1.0);
    let goals = set_points(fleet, record).into_iter().enumerate();
    nearest_first(goals.filter_map(|(k, goal)| {
        let goal = goal?;
        let away = place.distance(DVec2::from_array(goal));
        let [x, y] = goal;
        let pixel = sight.metres_per_pixel([x, y, sight.height(goal)]);
        (away < reach.max(2.0 * NEAR * pixel)).then_some((away, Picked::SetPoint(k)))
    }))
}

/// The edges that pass a pixel, the nearest first.
fn edges(sight: &Sightline, fleet: &FleetInfo, record: &StepRecord, pixel: DVec2) -> Vec<Picked> {
    let place = |k: usize| {
        let pose = record.snapshot.robots.get(k)?.motion.pose;
        sight.pixel_of_ground([pose.x, pose.y]).map(DVec2::from_array)
    };
    nearest_first(record.pairs(fleet).filter_map(|(k, edge, _)| {
        let away = beside(pixel, place(edge.leader)?, place(edge.follower)?);
        (away < NEAR).then_some((away, Picked::Edge(k)))
    }))
}

/// What was found at some distances, in the order of these.
fn nearest_first(found: impl Iterator<Item = (f64, Picked)>) -> Vec<Picked> {
    let mut found: Vec<_> = found.collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, picked)| picked).collect()
}

/// How far a point is from the line between two others.
fn beside(point: DVec2, from: DVec2, to: DVec2) -> f64 {
    let along = to - from;
    let share = ((point - from).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
    point.distance(from + along * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Viewpoint;
    use crate::camera::Camera;
    use crate::camera::viewpoint::Tile;
    use crate::ground::floor::Floor;
    use vocabulary::math;
    use vocabulary::{Body, Edge, EdgeState, Pose, Snapshot};

    fn context() -> (FleetInfo, StepRecord) {
        let member = |name: &str, leads| RobotInfo::new(name, leads, Body::default());
        let fleet = FleetInfo {
            robots: vec![member("a", true), member("b", false)],
            edges: vec![Edge { leader: 0, follower: 1 }],
            ..FleetInfo::default()
        };
        let mut robots = vec![RobotState::default(); 2];
        robots[1].motion.pose = Pose::new(-2.0, 0.0, 0.3);
        let edge = EdgeState { set_point: [2.0, 2.5], ..EdgeState::default() };
        let snapshot = Snapshot { robots, ..Snapshot::default() };
        (fleet, StepRecord { snapshot, edges: vec![edge], ..StepRecord::default() })
    }

    fn sight(eye: [f64; 3], to: [f64; 3]) -> Sightline {
        let camera = Camera::looking(DVec3::from_array(eye), DVec3::from_array(to), 0.7, 2.0);
        let tile = Tile { x: 30, y: 10, width: 800, height: 400 };
        Sightline { view: Viewpoint::Snake, tile, camera, floor: Floor::default() }
    }

    #[test]
    fn the_nearest_robot_is_first_and_edges_are_last() {
        let (fleet, record) = context();
        let sight = sight([-5.0, -0.3, 0.6], [0.0, 0.0, 0.1]);
        let at = |x: f64, y: f64, z: f64| sight.pixel([x, y, z]).unwrap();
        // From behind, the follower hides part of its leader.
        let both = pick(&sight, &fleet, &record, at(0.1, 0.0, 0.08));
        assert!(both.starts_with(&[Picked::Robot(1), Picked::Robot(0)]), "{both:?}");
        assert_eq!(pick(&sight, &fleet, &record, at(-1.9, 0.0, 0.05))[0], Picked::Robot(1));
        let between = pick(&sight, &fleet, &record, at(-1.0, 0.0, 0.0));
        assert!(between.ends_with(&[Picked::Edge(0)]), "{between:?}");
        let goal = [2.0 * math::cos(2.5_f64), 2.0 * math::sin(2.5_f64)];
        assert_eq!(pick(&sight, &fleet, &record, at(goal[0], goal[1], 0.0)), [Picked::SetPoint(0)]);
        assert!(pick(&sight, &fleet, &record, at(1.0, -2.0, 0.0)).is_empty());
    }

    #[test]
    fn a_robot_of_a_few_pixels_is_still_found() {
        let (fleet, record) = context();
        let sight = sight([0.0, -0.001, 300.0], [0.0; 3]);
        let [x, y] = sight.pixel([0.1, 0.0, 0.0]).unwrap();
        assert_eq!(pick(&sight, &fleet, &record, [x, y - 3.0])[0], Picked::Robot(0));
    }
}
