//! Cameras: where each view stands, solved from what it has to show.

pub(crate) mod free_space;
pub(crate) mod onboard;
pub(crate) mod pick;
pub(crate) mod sightline;
pub(crate) mod smoothing;
pub(crate) mod snake;
pub(crate) mod transition;
pub(crate) mod viewpoint;

use crate::Viewpoint;
use crate::camera::free_space::{Bound, FreeSpace, eye};
use crate::camera::onboard::onboard;
use crate::camera::smoothing::{Extent, SmoothedFormation};
use crate::camera::snake::snake;
use crate::camera::transition::between;
use crate::ground::floor::Floor;
use crate::picture_context::PictureContext;
use glam::{DMat4, DVec2, DVec3, DVec4, Mat4};
use vocabulary::math;
use vocabulary::{Edge, Snapshot};

/// The pose and projection of a camera; only cameras on robots roll.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Camera {
    pub(crate) eye: DVec3,
    pub(crate) forward: DVec3,
    pub(crate) right: DVec3,
    pub(crate) up: DVec3,
    /// Tangents of half the fields of view across and down; for a parallel projection half the sides in m.
    pub(crate) half: DVec2,
    /// Tangents of the directions to the middle of the picture, right and up; 0 where it looks straight ahead.
    pub(crate) shift: DVec2,
    pub(crate) near: f64,
    pub(crate) perspective: bool,
}

const NEAR: f64 = 0.05;
const FAR: f64 = 600.0;
/// Of an eye that the ground would hide, m.
const LEAST_OVER_GROUND: f64 = 0.28;
/// Of an eye that the user has placed, m.
const LEAST_OVER_FLOOR: f64 = 0.06;

/// Nearer the eye does not come, m.
pub(crate) const NEAREST: f64 = 2.6;
/// Robots reach over their places by this, rings at set points too; of the default body, m.
pub(crate) const REACH: f64 = 0.28;

impl Camera {
    /// The camera of `view`, which keeps robots in `room` where it can.
    pub(crate) fn of(view: &Viewpoint, context: &PictureContext<'_>, room: &FreeSpace) -> Self {
        let PictureContext { fleet, floor, .. } = *context;
        let (smoothed, snapshot) = (&context.trail.smoothed, &context.record.snapshot);
        let aspect = room.aspect();
        let mut camera = match view {
            Viewpoint::Snake => snake(smoothed, room),
            Viewpoint::SnakeEye => snake_eye(smoothed, aspect),
            Viewpoint::Top => top(smoothed, room),
            Viewpoint::Orbit => orbit(smoothed, snapshot.time, fleet.edges.is_empty(), room),
            Viewpoint::Follow(robot) => {
                let edges: Vec<Edge> = context.record.pairs(fleet).map(|(_, edge, _)| edge).collect();
                follow(smoothed, snapshot, &edges, *robot, aspect)
            }
            Viewpoint::Camera(robot) => return onboard(snapshot, fleet, *robot, aspect),
            Viewpoint::Fixed { eye, target, field_of_view } => {
                let [mut eye, target] = [eye, target].map(|place| DVec3::from_array(*place));
                // The user has placed it: it stays, unless the floor is in the way.
                eye.z = eye.z.max(floor.height(eye.truncate()) + LEAST_OVER_FLOOR);
                return Self::looking(eye, target, *field_of_view, aspect);
            }
            Viewpoint::Between(from, to, share) => {
                let [from, to] = [from, to].map(|view| Self::of(view, context, room));
                return between(&from, &to, *share, smoothed);
            }
        };
        if !floor.is_plane() {
            camera.stay_above(floor);
        }
        camera
    }

    /// No hill or ramp may swallow the eye.
    fn stay_above(&mut self, floor: &Floor) {
        // Around the eye too, so that it rises before a slope reaches it.
        let least = [DVec2::ZERO, DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y]
            .map(|off| floor.height(self.eye.truncate() + off * 0.4));
        self.eye.z = least.into_iter().fold(self.eye.z, |z, ground| z.max(ground + LEAST_OVER_GROUND));
    }

    /// A camera at `eye` that looks at `target`.
    pub(crate) fn looking(eye: DVec3, target: DVec3, field_of_view: f64, aspect: f64) -> Self {
        let forward = (target - eye).normalize_or(DVec3::NEG_Z);
        let flat = forward.truncate();
        // Looking straight down, the picture's upper edge is where +x would be.
        let heading = if flat.length() < 1e-9 { DVec2::X } else { flat.normalize() };
        let right = DVec3::new(heading.y, -heading.x, 0.0);
        let tangent = math::tan(0.5 * field_of_view);
        let half = DVec2::new(tangent * aspect, tangent);
        Self::upright(eye, forward, right, half)
    }

    /// A camera with perspective that does not lean and looks straight ahead.
    pub(crate) fn upright(eye: DVec3, forward: DVec3, right: DVec3, half: DVec2) -> Self {
        Self {
            eye,
            forward,
            right,
            up: right.cross(forward),
            half,
            shift: DVec2::ZERO,
            near: NEAR,
            perspective: true,
        }
    }

    pub(crate) fn pitched(heading: f64, pitch: f64, tangent: f64, aspect: f64) -> Self {
        let forward = DVec3::new(
            math::cos(heading) * math::cos(pitch),
            math::sin(heading) * math::cos(pitch),
            -math::sin(pitch),
        );
        let right = DVec3::new(math::sin(heading), -math::cos(heading), 0.0);
        let half = DVec2::new(tangent * aspect, tangent);
        Self::upright(DVec3::ZERO, forward, right, half)
    }

    /// Coordinates of a world point along right, up and forward, from the eye, m.
    pub(crate) fn view_from_world(&self, point: DVec3) -> DVec3 {
        let from_eye = point - self.eye;
        DVec3::new(from_eye.dot(self.right), from_eye.dot(self.up), from_eye.dot(self.forward))
    }

    /// Where a world point appears, −1 to 1 across and up; `None` behind the eye.
    pub(crate) fn project(&self, point: DVec3) -> Option<DVec2> {
        let p = self.view_from_world(point);
        if self.perspective {
            (p.z > self.near).then(|| (DVec2::new(p.x, p.y) / p.z - self.shift) / self.half)
        } else {
            Some(DVec2::new(p.x, p.y) / self.half)
        }
    }

    /// Beyond which sides of the picture, or behind the eye, a point is by more than `margin` m, a bit for each: what lies
    /// between two points that share one is not in the picture.
    pub(crate) fn beyond(&self, point: DVec3, margin: f64) -> u8 {
        let p = self.view_from_world(point);
        let depth = if self.perspective { p.z } else { 1.0 };
        let side = |at: f64, half: f64, shift: f64| {
            let edge = half * depth + margin * (1.0 + half + shift.abs());
            let off = at - shift * depth;
            [off > edge, -off > edge]
        };
        let [right, left] = side(p.x, self.half.x, self.shift.x);
        let [up, down] = side(p.y, self.half.y, self.shift.y);
        let behind = self.perspective && p.z < self.near - margin;
        let bits = [right, left, up, down, behind].into_iter().enumerate();
        bits.fold(0, |all, (k, bit)| all | u8::from(bit) << k)
    }

    /// The part of the picture that holds what is between some corners, given by its lower left and its upper right, each
    /// −1 to 1 across and up: all of it where some are behind the eye, `None` where all are.
    pub(crate) fn around(&self, corners: &[DVec3]) -> Option<[DVec2; 2]> {
        let places = || corners.iter().map(|corner| self.project(*corner));
        if places().any(|place| place.is_none()) {
            return places().any(|place| place.is_some()).then_some([DVec2::NEG_ONE, DVec2::ONE]);
        }
        let bounds = places().flatten().map(|place| [place; 2]);
        bounds.reduce(|[low, high], [from, to]| [low.min(from), high.max(to)])
    }

    /// Metres per pixel at a world point, on a tile `height` pixels high.
    pub(crate) fn metres_per_pixel(&self, point: DVec3, height: f64) -> f64 {
        let depth = if self.perspective { self.view_from_world(point).z.max(self.near) } else { 1.0 };
        2.0 * self.half.y * depth / height
    }

    /// Clip coordinates (depth 0 near to 1 far) from coordinates relative to `origin`.
    pub(crate) fn clip_from_local(&self, origin: DVec3) -> Mat4 {
        let eye = self.eye - origin;
        let row = |axis: DVec3, scale: f64| (axis * scale).extend(-axis.dot(eye) * scale);
        let x = row(self.right - self.forward * self.shift.x, 1.0 / self.half.x);
        let y = row(self.up - self.forward * self.shift.y, 1.0 / self.half.y);
        let along = row(self.forward, 1.0);
        let rows = if self.perspective {
            let slope = FAR / (FAR - self.near);
            DMat4::from_cols(x, y, along * slope - DVec4::W * (self.near * slope), along)
        } else {
            DMat4::from_cols(x, y, along / FAR, DVec4::W)
        };
        rows.transpose().as_mat4()
    }

    /// Normalised height of the horizon; above 1 it is out of the picture.
    pub(crate) fn horizon(&self) -> f64 {
        if !self.perspective || self.up.z < 1e-6 {
            return 4.0;
        }
        (-self.forward.z / self.up.z - self.shift.y) / self.half.y
    }

    /// The horizon as the shaders have it: its normalised height in the middle, by how much it rises over half the
    /// width, and 1 where the sky is above it, −1 where it is below.
    pub(crate) fn skyline(&self) -> [f64; 3] {
        let (aside, up) = (self.right.z * self.half.x, self.up.z * self.half.y);
        if aside.abs() < 1e-9 && up >= 0.0 || !self.perspective {
            return [self.horizon().clamp(-4.0, 4.0), 0.0, 1.0];
        }
        let up = if up.abs() < 1e-5 { 1e-5_f64.copysign(up) } else { up };
        let middle = self.forward.z + self.right.z * self.shift.x + self.up.z * self.shift.y;
        [-middle / up, -aside / up, up.signum()]
    }

    /// Moves the eye as near to `points` as `bounds` let it, turning nothing.
    pub(crate) fn fit(&mut self, points: &[DVec3], bounds: &[Bound], nearest: f64) {
        self.eye = DVec3::ZERO;
        let seen: Vec<_> = points.iter().map(|p| self.view_from_world(*p)).collect();
        let place = eye(&seen, self.half, bounds, nearest, EYE_LOW);
        self.eye = self.right * place.x + self.up * place.y + self.forward * place.z;
    }
}

/// Where the eye may be lower or higher, it is this share of the way up: robots are in the lower part of their room.
const EYE_LOW: f64 = 0.6;

/// The sides of the picture as bounds: a share of the width, and normalised heights.
pub(crate) fn sides(width: f64, [bottom, top]: [f64; 2]) -> [Bound; 4] {
    let bound = |across: f64, up: f64, most: f64| Bound { across, up, most };
    [bound(1.0, 0.0, width), bound(-1.0, 0.0, width), bound(0.0, 1.0, top), bound(0.0, -1.0, -bottom)]
}

/// Outline of the formation from the ground to the robots' height.
pub(crate) fn corners(extent: &Extent, margin: f64) -> Vec<DVec3> {
    let places = extent.outline(margin).into_iter().map(|[f, l]| extent.frame.world_from_body(f, l));
    let [low, high] = [extent.ground[0], extent.ground[1] + 0.3 * extent.size];
    places.flat_map(|[x, y]| [DVec3::new(x, y, low), DVec3::new(x, y, high)]).collect()
}

fn snake_eye(smoothed: &SmoothedFormation, aspect: f64) -> Camera {
    let extent = smoothed.formation();
    let heading = extent.frame.heading;
    let tangent = math::tan((27.5_f64).to_radians());
    let mut camera = Camera::pitched(heading, 0.08, tangent, aspect);
    // Far enough back for the last row to fit, unless that row is very wide.
    let aside = extent.left.map(|left| (left - extent.rear).abs());
    let size = extent.size;
    let back =
        ((aside[0].max(aside[1]) + 0.2 * size) / (0.86 * tangent * aspect)).clamp(1.2 * size, 6.0 * size);
    let [x, y] = extent.frame.world_from_body(extent.forward[0] - back, extent.rear);
    // Half-way up the formation, so that fewer hills are in the way.
    camera.eye = DVec3::new(x, y, 0.5 * (extent.ground[0] + extent.ground[1]) + 0.35 * size);
    camera
}

fn top(smoothed: &SmoothedFormation, room: &FreeSpace) -> Camera {
    let extent = smoothed.formation();
    let ([x, y], across) = (extent.middle(), extent.radius(0.45 * extent.size));
    let (middle, radius) = room.disc();
    let half = across.max(1.2 * extent.size) / radius;
    let half = DVec2::new(half * room.aspect(), half);
    let eye = DVec2::new(x, y) - DVec2::from_array(middle) * half;
    let eye = eye.extend(100.0 + extent.ground[1]);
    Camera { up: DVec3::Y, perspective: false, ..Camera::upright(eye, DVec3::NEG_Z, DVec3::X, half) }
}

fn orbit(smoothed: &SmoothedFormation, time: f64, alone: bool, room: &FreeSpace) -> Camera {
    let extent = smoothed.formation();
    let ([x, y], radius) = (extent.middle(), extent.radius(REACH * extent.size));
    let tangent = math::tan((19.0_f64).to_radians());
    // A full turn in 40 s, so that no side stays hidden: from behind a formation on the left; robots of which none
    // follows another often meet, and meetings are seen from the side.
    let start = if alone { 1.6 } else { 2.6 };
    let (turn, rise) = (start + time * 0.157, 0.42_f64);
    let heading = turn + std::f64::consts::PI;
    let mut camera = Camera::pitched(heading, rise, tangent, room.aspect());
    let [low, high] = [extent.ground[0], extent.ground[1] + 0.3 * extent.size];
    let around = (0..32).flat_map(|k| {
        let (sin, cos) = math::sin_cos(heading + std::f64::consts::TAU * f64::from(k) / 32.0);
        [low, high].map(|z| DVec3::new(x + radius * cos, y + radius * sin, z))
    });
    let [bottom, over] = room.rows();
    let bounds: Vec<_> =
        sides(0.9, [bottom.max(-0.9), over.min(0.8)]).into_iter().chain(room.corners()).collect();
    camera.fit(&around.collect::<Vec<_>>(), &bounds, NEAREST * extent.size);
    camera
}

/// Behind one robot, turned a little to its leader and far enough back for that to be in the picture.
fn follow(
    smoothed: &SmoothedFormation,
    snapshot: &Snapshot,
    edges: &[Edge],
    robot: usize,
    aspect: f64,
) -> Camera {
    let place = |k: usize| snapshot.robots.get(k).map(|r| r.motion.pose);
    let pose = place(robot).unwrap_or_default();
    let heading = smoothed.heading(robot).unwrap_or(pose.heading);
    let leader = edges.iter().find(|e| e.follower == robot).and_then(|e| place(e.leader));
    let to_leader = leader.map_or(DVec2::ZERO, |l| DVec2::new(l.x - pose.x, l.y - pose.y));
    // The sine keeps the turn steady where the leader is straight behind.
    let bearing = math::atan2(to_leader.y, to_leader.x) - heading;
    let turn = if leader.is_some() { 0.6 * math::sin(bearing) } else { 0.0 };
    let forward = DVec2::from_angle(heading + turn);
    let tangent = math::tan((25.0_f64).to_radians());
    let size = smoothed.formation().size;
    let (ahead, aside) = (to_leader.dot(forward), to_leader.perp_dot(forward).abs() + 0.2 * size);
    // Not farther: the robot that is followed must stay large.
    let back = (aside / (0.86 * tangent * aspect) - ahead).clamp(2.0 * size, 4.5 * size);
    let rise = 0.5 * back;
    // The robot stands in the lower third.
    let pitch = math::atan(rise / back) - math::atan(0.48 * tangent);
    let mut camera = Camera::pitched(heading + turn, pitch, tangent, aspect);
    camera.eye = (DVec2::new(pose.x, pose.y) - forward * back).extend(smoothed.height(robot) + rise);
    camera
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn projection_agrees_with_the_matrix() {
        let camera = Camera::looking(DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 0.5), 0.7, 1.6);
        let point = DVec3::new(3.5, 4.0, 0.2);
        let origin = DVec3::new(1.0, 1.0, 0.0);
        let clip = camera.clip_from_local(origin) * (point - origin).as_vec3().extend(1.0);
        let seen = camera.project(point).unwrap();
        assert!((f64::from(clip.x / clip.w) - seen.x).abs() < 1e-5);
        assert!((f64::from(clip.y / clip.w) - seen.y).abs() < 1e-5);
        assert!(clip.z > 0.0 && clip.z < clip.w);
    }

    #[test]
    fn what_is_between_points_beyond_a_side_is_not_seen() {
        let level = Camera::looking(DVec3::new(0.0, 0.0, 1.0), DVec3::new(4.0, 1.0, 0.0), 0.7, 1.6);
        for camera in [level, Camera { perspective: false, half: DVec2::new(3.0, 2.0), ..level }] {
            let point = |k: usize| DVec3::new(((k * 7) % 23) as f64 - 9.0, ((k * 5) % 19) as f64 - 9.0, 0.0);
            let (mut hidden, mut shown) = (0, 0);
            for (a, b) in (0..400).map(|k| (point(k), point(k * 3 + 1))) {
                let out = camera.beyond(a, 0.2) & camera.beyond(b, 0.2) != 0;
                let seen = |share: f64| {
                    camera.project(a.lerp(b, share)).is_some_and(|p| p.abs().max_element() < 1.0)
                };
                let any = (0..=50).any(|k| seen(f64::from(k) * 0.02));
                assert!(!(out && any), "{a} {b}");
                hidden += usize::from(out);
                shown += usize::from(any);
            }
            assert!(hidden > 60 && shown > 20, "{hidden} {shown}");
        }
    }

    #[test]
    fn the_part_around_corners_holds_what_is_between_them() {
        let level = Camera::looking(DVec3::new(0.0, 0.0, 1.0), DVec3::new(4.0, 1.0, 0.0), 0.7, 1.6);
        let parallel = Camera { perspective: false, half: DVec2::new(3.0, 2.0), ..level };
        let (mut behind, mut partly) = (0, 0);
        for camera in [level, Camera { shift: DVec2::new(0.1, -0.2), ..level }, parallel] {
            for k in 0..300 {
                let at = |step: usize, count: usize| ((k * step) % count) as f64 * 0.7 - 5.0;
                let (low, size) = (DVec3::new(at(7, 23), at(5, 19), 0.0), 0.2 + 0.1 * at(3, 11).abs());
                let inside = |x: f64, y: f64, z: f64| low + DVec3::new(x, y, z) * size;
                let corners: Vec<_> = (0..8)
                    .map(|c: u8| inside(f64::from(c & 1), f64::from(c >> 1 & 1), f64::from(c >> 2)))
                    .collect();
                let part = camera.around(&corners);
                for j in 0..125 {
                    let share = |k: i32| f64::from(k % 5) / 4.0;
                    let Some(seen) = camera.project(inside(share(j), share(j / 5), share(j / 25))) else {
                        continue;
                    };
                    if seen.abs().max_element() < 1.0 {
                        let [low, high] = part.unwrap();
                        assert!(
                            seen.cmpge(low - 1e-9).all() && seen.cmple(high + 1e-9).all(),
                            "{low} {size}"
                        );
                    }
                }
                behind += usize::from(part.is_none());
                partly += usize::from(part.is_some_and(|[low, high]| (high - low).max_element() < 1.0));
            }
        }
        assert!(behind > 50 && partly > 200, "{behind} {partly}");
    }

    #[test]
    fn a_followed_robot_is_low_and_its_leader_in_the_picture() {
        let edges = [Edge { leader: 0, follower: 1 }];
        for degrees in [0.0, 45.0, 90.0, 120.0, -60.0, -120.0] {
            let (sin, cos) = math::sin_cos(f64::to_radians(degrees));
            let robots = vec![vocabulary::RobotState::default(); 2];
            let mut snapshot = Snapshot { robots, ..Snapshot::default() };
            snapshot.robots[0].motion.pose = vocabulary::Pose::new(2.0 * cos, 2.0 * sin, 0.3);
            let mut smoothed = SmoothedFormation::new(0, 1.0);
            let record =
                vocabulary::StepRecord { snapshot: snapshot.clone(), ..vocabulary::StepRecord::default() };
            smoothed.push(&record, &[]);
            let camera = follow(&smoothed, &snapshot, &edges, 1, 16.0 / 9.0);
            let seen = |x, y| camera.project(DVec3::new(x, y, 0.0)).unwrap();
            let own = seen(0.0, 0.0);
            assert!(own.x.abs() < 1e-9 && (-0.7..-0.34).contains(&own.y), "{own}");
            let leader = seen(2.0 * cos, 2.0 * sin);
            assert!(leader.abs().max_element() < 0.95, "{degrees}: {leader}");
        }
    }

    #[test]
    fn the_horizon_is_where_far_points_go() {
        let camera = Camera::looking(DVec3::new(0.0, 0.0, 3.0), DVec3::new(8.0, 0.0, 0.0), 0.9, 1.6);
        let far = camera.project(DVec3::new(1e9, 0.0, 0.0)).unwrap();
        assert!((far.y - camera.horizon()).abs() < 1e-6);
    }
}
