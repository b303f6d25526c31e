//! Copies of the models for a moment: where bodies, wheels, cameras and ghosts stand.

use crate::Ghost;
use crate::camera::Camera;
use crate::gpu::model::Build;
use crate::gpu::passes::instanced::Instance;
use crate::gpu::passes::robot::{RobotInstances, Squad};
use crate::ground::decal_builder::flat;
use crate::palette::{Rgb, linear, with_alpha};
use crate::picture_context::PictureContext;
use glam::{DVec3, Mat3, Mat4, Vec3};
use vocabulary::math;
use vocabulary::{Attitude, FleetInfo, Pose, RobotInfo, RobotState};

/// Opacity of a ghost.
const GHOST: f32 = 0.18;

/// The distinct builds of a fleet, and which of them every robot has.
#[derive(Debug)]
pub(crate) struct RobotModels {
    pub(crate) builds: Vec<Build>,
    pub(crate) of: Vec<usize>,
}

impl RobotModels {
    pub(crate) fn new(fleet: &FleetInfo) -> Self {
        let mut builds: Vec<Build> = Vec::new();
        let of = fleet.robots.iter().map(|member| {
            let build = Build::new(member);
            builds.iter().position(|b| *b == build).unwrap_or_else(|| {
                builds.push(build);
                builds.len() - 1
            })
        });
        let of = of.collect();
        Self { builds, of }
    }
}

/// All copies of the models in a picture.
pub(crate) fn crowd(context: &PictureContext<'_>) -> RobotInstances {
    let robot_models = context.robot_models;
    let mut crowd = RobotInstances {
        squads: vec![Squad::default(); robot_models.builds.len()],
        ..RobotInstances::default()
    };
    for (index, (robot, member)) in
        context.record.snapshot.robots.iter().zip(&context.fleet.robots).enumerate()
    {
        if !robot.is_present() {
            continue;
        }
        let mut look = RobotAppearance::new(member, index, context.colours[index]);
        let pose = robot.motion.pose;
        look.marks[2] = (context.floor.height(flat(&pose)) - context.origin.z) as f32;
        let kind = robot_models.of[index];
        let (squad, build) = (&mut crowd.squads[kind], &robot_models.builds[kind]);
        crowd.cameras.push(stand(squad, robot, build, &look, context.origin));
    }
    if context.style.ghosts && context.detail > 0.0 {
        ghosts(&mut crowd, context);
    }
    sketched(&mut crowd, context);
    crowd
}

/// What of a crowd a camera on robot `own` may see: not the head it sits in.
pub(crate) fn part(
    all: &RobotInstances,
    context: &PictureContext<'_>,
    camera: &Camera,
    own: usize,
) -> RobotInstances {
    let robot_models = context.robot_models;
    let mut part =
        RobotInstances { squads: vec![Squad::default(); all.squads.len()], ..RobotInstances::default() };
    let mut counts = vec![0; all.squads.len()];
    let mut seen = Vec::new();
    // Places are counted as `crowd` fills them; that of a camera is among those of all robots.
    let present = context.record.snapshot.robots.iter().enumerate().filter(|(_, robot)| robot.is_present());
    for (rank, (index, robot)) in present.enumerate() {
        let kind = robot_models.of[index];
        let (middle, radius) = robot_models.builds[kind].ball();
        let middle = DVec3::from_array(robot.world_from_body().apply(middle));
        if camera.may_see(middle, radius) {
            seen.push((camera.view_from_world(middle).z, index, counts[kind], rank));
        }
        counts[kind] += 1;
    }
    // What is near hides what is behind it.
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, index, place, rank) in seen {
        let kind = robot_models.of[index];
        let (squad, whole) = (&mut part.squads[kind], &all.squads[kind]);
        squad.bodies.push(whole.bodies[place]);
        squad.wheels.extend_from_slice(&whole.wheels[4 * place..4 * place + 4]);
        if index != own {
            part.cameras.push(all.cameras[rank]);
        }
    }
    part
}

/// How high the largest robot is that a camera sees on a tile of some height, pixels.
pub(crate) fn largest(camera: &Camera, context: &PictureContext<'_>, height: f64) -> f64 {
    let robot_models = context.robot_models;
    let high = |(index, robot): (usize, &RobotState)| {
        let build = &robot_models.builds[robot_models.of[index]];
        let (middle, radius) = build.ball();
        let middle = DVec3::from_array(robot.world_from_body().apply(middle));
        let seen = camera.may_see(middle, radius);
        if seen { build.top() / camera.metres_per_pixel(middle, height) } else { 0.0 }
    };
    context.record.snapshot.robots.iter().enumerate().map(high).fold(0.0, f64::max)
}

/// Colour and number of a robot.
struct RobotAppearance {
    colour: Rgb,
    marks: [f32; 4],
}

impl RobotAppearance {
    fn new(member: &RobotInfo, index: usize, colour: Rgb) -> Self {
        let tag = member.shell.and_then(|shell| shell.first_tag).map_or(-1.0, f32::from);
        Self { colour, marks: [roof_number(member, index), f32::from(u8::from(member.leads)), 0.0, tag] }
    }

    fn instance(&self, local_from_model: Mat4, alpha: f32) -> Instance {
        Instance::new(local_from_model, with_alpha(linear(self.colour), alpha), self.marks)
    }
}

/// The number at the end of a robot's name, else its place in the fleet.
fn roof_number(member: &RobotInfo, index: usize) -> f32 {
    let digits = member.name.chars().rev().take_while(char::is_ascii_digit).count();
    let tail = &member.name[member.name.len() - digits..];
    tail.parse::<u16>().ok().filter(|n| *n < 1000).map_or(index as f32, f32::from)
}

fn local_from_body(pose: &Pose, attitude: &Attitude, origin: DVec3) -> Mat4 {
    let place = DVec3::new(pose.x, pose.y, attitude.height) - origin;
    let turn = Mat3::from_rotation_z(pose.heading as f32)
        * Mat3::from_rotation_y(attitude.pitch as f32)
        * Mat3::from_rotation_x(attitude.roll as f32);
    Mat4::from_translation(place.as_vec3()) * Mat4::from_mat3(turn)
}

/// Body and wheels of a robot, and its camera.
fn stand(
    squad: &mut Squad,
    robot: &RobotState,
    build: &Build,
    look: &RobotAppearance,
    origin: DVec3,
) -> Instance {
    let base = local_from_body(&robot.motion.pose, &robot.attitude, origin);
    squad.bodies.push(look.instance(base, 1.0));
    for (wheel, hub) in robot.wheels.iter().zip(build.hubs()) {
        let raised = hub + Vec3::Z * wheel.compression as f32;
        // The model's outer face looks left; on the right it is turned about, and then rolls the other way.
        let (about, roll) = if hub.y > 0.0 { (0.0, 1.0) } else { (std::f32::consts::PI, -1.0) };
        let model = base
            * Mat4::from_translation(raised)
            * Mat4::from_rotation_z(wheel.steering as f32 + about)
            * Mat4::from_rotation_y(roll * wheel.rotation as f32)
            * Mat4::from_scale(build.wheel);
        squad.wheels.push(look.instance(model, 1.0));
    }
    let camera = base
        * Mat4::from_translation(build.camera)
        * Mat4::from_rotation_z(robot.camera_pan as f32)
        * Mat4::from_scale(Vec3::splat(build.head));
    look.instance(camera, 1.0)
}

fn ghosts(crowd: &mut RobotInstances, context: &PictureContext<'_>) {
    let now = context.record.snapshot.time;
    for row in &context.trail.ghosts {
        let age = now - row.time;
        if !(0.0..=crate::ground::trail::RIBBON).contains(&age) {
            continue;
        }
        for (index, (pose, member)) in row.poses.iter().zip(&context.fleet.robots).enumerate() {
            let here = context.record.snapshot.robots.get(index).map(|r| r.motion.pose).unwrap_or_default();
            if context.record.snapshot.robots.get(index).is_some_and(|robot| !robot.is_present()) {
                continue;
            }
            // A ghost steps out of its robot gradually and fades before it goes.
            let away =
                (math::hypot(here.x - pose.x, here.y - pose.y) / member.body.length - 0.8).clamp(0.0, 1.0);
            let late = ((crate::ground::trail::RIBBON - age) / 1.5).clamp(0.0, 1.0);
            let alpha = GHOST * context.detail * (away * late) as f32;
            if alpha > 0.01 {
                let look = RobotAppearance::new(member, index, context.colours[index]);
                let base = local_from_body(pose, &lying(context, pose), context.origin);
                crowd.squads[context.robot_models.of[index]].ghosts.push(look.instance(base, alpha));
            }
        }
    }
}

/// The faint bodies among annotations.
fn sketched(crowd: &mut RobotInstances, context: &PictureContext<'_>) {
    for Ghost { robot, pose, alpha } in &context.style.annotations.ghosts {
        let finite = [pose.x, pose.y, pose.heading].iter().all(|x| x.is_finite());
        let Some(member) = context.fleet.robots.get(*robot).filter(|_| finite) else { continue };
        let look = RobotAppearance::new(member, *robot, context.colours[*robot]);
        let base = local_from_body(pose, &lying(context, pose), context.origin);
        crowd.squads[context.robot_models.of[*robot]].ghosts.push(look.instance(base, alpha.clamp(0.0, 1.0)));
    }
}

/// How a body stands that has all its wheels on the ground at a pose.
fn lying(context: &PictureContext<'_>, pose: &Pose) -> Attitude {
    if context.floor.is_plane() {
        return Attitude::default();
    }
    let (height, DVec3 { x, y, z }) = context.floor.surface(flat(pose));
    let (sin, cos) = math::sin_cos(pose.heading);
    Attitude { height, roll: math::atan2(x * sin - y * cos, z), pitch: math::atan2(x * cos + y * sin, z) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::Body;

    #[test]
    fn roofs_show_the_number_of_the_name() {
        let member = |name: &str| RobotInfo::new(name, false, Body::default());
        assert_eq!(roof_number(&member("follower-12"), 3), 12.0);
        assert_eq!(roof_number(&member("leader"), 0), 0.0);
        assert_eq!(roof_number(&member("x99999999"), 4), 4.0);
    }
}
