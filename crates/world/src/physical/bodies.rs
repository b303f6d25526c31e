//! rapier's side of the world: bodies, colliders, and what can be asked of them. Only this file and `ground` speak to
//! rapier's sets.

use super::PropBody;
use super::ground::ground;
use crate::Wheeled;
use crate::touch::BodyContact;
use crate::wheeled::wheel::{Carriage, Footing};
use rapier3d_f64::parry::bounding_volume::BoundingVolume;
use rapier3d_f64::prelude::{
    ActiveCollisionTypes, BroadPhaseBvh, CCDSolver, Collider, ColliderBuilder, ColliderSet, ContactPair,
    ImpulseJointSet, IntegrationParameters, IslandManager, MassProperties, MultibodyJointSet, NarrowPhase,
    PhysicsPipeline, Pose as Isometry, QueryFilter, Ray, RigidBodyBuilder, RigidBodyHandle, RigidBodySet,
    Rotation, SharedShape, SoftBodySet, Vector,
};
use vocabulary::{
    Attitude, Body, EntityId, GRAVITY, Mobility, Motion, Placement, Pose, Solid, Surface, math,
};

/// Bodies whose nearest points are closer than this touch, m.
const TOUCHING: f64 = 1e-4;
/// Points of a contact that are less than this farther apart than the nearest belong to it, m.
const CORNERS: f64 = 2e-3;
/// Friction and restitution of robots' bodies.
const SHELL: [f64; 2] = [0.4, 0.1];

/// All bodies and their solver.
#[derive(Clone, Default)]
pub(super) struct Bodies {
    pipeline: Pipeline,
    parameters: IntegrationParameters,
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    set: RigidBodySet,
    colliders: ColliderSet,
    joints: ImpulseJointSet,
    multibodies: MultibodyJointSet,
    soft: SoftBodySet,
    ccd: CCDSolver,
    /// Of each prop; none of one that is fixed.
    props: Vec<Option<RigidBodyHandle>>,
}

/// A vehicle at the end of a physics step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Knot {
    pub(super) motion: Motion,
    /// Of the pose's point, m/s, world.
    pub(super) velocity: [f64; 2],
}

/// Runs the physics; a copy leaves out its scratch memory, which holds nothing from one step to the next.
#[derive(Default)]
struct Pipeline(PhysicsPipeline);

impl Clone for Pipeline {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Bodies {
    /// The ground alone.
    pub(super) fn new(terrain: Option<&vocabulary::Terrain>) -> Self {
        let mut colliders = ColliderSet::new();
        for part in ground(terrain) {
            colliders.insert(part.friction(0.7).user_data(mark(EntityId::Ground)));
        }
        Self {
            // Recycled contacts keep old distances: a touch would be seen centimetres late.
            parameters: IntegrationParameters {
                contact_recycling: false,
                ..IntegrationParameters::default()
            },
            set: RigidBodySet::new(),
            colliders,
            ..Self::default()
        }
    }

    /// A vehicle that starts with `motion` on a surface.
    pub(super) fn add_vehicle(
        &mut self,
        index: usize,
        vehicle: &Wheeled,
        motion: &Motion,
        surface: &Surface,
        step: f64,
    ) -> RigidBodyHandle {
        let frame = on_surface(motion.pose, surface);
        let mass = MassProperties::new(
            Vector::from(vehicle.mass_centre()),
            vehicle.mass,
            Vector::from(vehicle.inertia()),
        );
        let centre = frame.rotation * Vector::from(vehicle.mass_centre());
        let spin = Vector::new(0.0, 0.0, motion.turn_rate);
        let forward = frame.rotation * Vector::X * motion.speed;
        let body = RigidBodyBuilder::dynamic()
            .pose(frame)
            .linvel(forward + spin.cross(centre))
            .angvel(spin)
            .additional_mass_properties(mass)
            .can_sleep(false)
            .ccd_enabled(needs_sweep(vehicle, step));
        let (body, shell) = (self.set.insert(body), shell(index, &vehicle.body, vehicle.clearance));
        self.colliders.insert_with_parent(shell, body, &mut self.set);
        body
    }

    /// Looks again at whether the body of `vehicle` needs the swept test.
    pub(super) fn sweep(&mut self, body: RigidBodyHandle, vehicle: &Wheeled, step: f64) {
        let needed = needs_sweep(vehicle, step);
        if self.set.get(body).is_some_and(|body| body.is_ccd_enabled() != needed)
            && let Some(body) = self.set.get_mut(body)
        {
            body.enable_ccd(needed);
        }
    }

    /// Nothing touches a body any more, and it stays where it is.
    pub(super) fn take_away(&mut self, body: RigidBodyHandle) {
        if let Some(body) = self.set.get_mut(body) {
            body.set_enabled(false);
        }
    }

    /// A body without mass that goes where it is placed.
    pub(super) fn add_unicycle(
        &mut self,
        index: usize,
        body: &Body,
        pose: Pose,
        surface: &Surface,
    ) -> RigidBodyHandle {
        let handle =
            self.set.insert(RigidBodyBuilder::kinematic_position_based().pose(on_surface(pose, surface)));
        let shell = shell(index, body, 0.2 * body.height).active_collision_types(ActiveCollisionTypes::all());
        self.colliders.insert_with_parent(shell, handle, &mut self.set);
        handle
    }

    /// A prop; the handle of one that can move.
    pub(super) fn add_prop(&mut self, index: usize, prop: &PropBody) -> Option<RigidBodyHandle> {
        let frame = frame_of(&prop.prop.placement);
        let (shape, inside) = solid(&prop.prop.solid);
        let collider = ColliderBuilder::new(shape)
            .friction(prop.friction)
            .restitution(prop.restitution)
            .mass(prop.mass)
            .user_data(mark(EntityId::Prop(index)))
            .active_collision_types(ActiveCollisionTypes::all());
        let handle = match prop.prop.mobility {
            Mobility::Fixed => None,
            Mobility::Loose => {
                // What is thrown flies fast.
                Some(self.set.insert(RigidBodyBuilder::dynamic().pose(frame).ccd_enabled(true)))
            }
            Mobility::Guided => {
                Some(self.set.insert(RigidBodyBuilder::kinematic_position_based().pose(frame)))
            }
        };
        match handle {
            Some(body) => self.colliders.insert_with_parent(collider.position(inside), body, &mut self.set),
            None => self.colliders.insert(collider.position(frame * inside)),
        };
        self.props.push(handle);
        handle
    }

    /// One physics step of `h` s.
    pub(super) fn step(&mut self, h: f64) {
        self.parameters.dt = h;
        self.pipeline.0.step(
            Vector::new(0.0, 0.0, -GRAVITY),
            &self.parameters,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.set,
            &mut self.colliders,
            &mut self.joints,
            &mut self.multibodies,
            &mut self.soft,
            &mut self.ccd,
            &(),
            &(),
        );
    }

    /// Where a guided body is at the end of the coming step.
    pub(super) fn place(&mut self, body: RigidBodyHandle, frame: Isometry) {
        self.set[body].set_next_kinematic_position(frame);
    }

    /// Replaces the force and torque on a body for the coming step.
    pub(super) fn push(&mut self, body: RigidBodyHandle, force: Vector, torque: Vector) {
        let body = &mut self.set[body];
        body.reset_forces(false);
        body.reset_torques(false);
        body.add_force(force, false);
        body.add_torque(torque, false);
    }

    /// Pushes a body at a place for the length of one step, as an impulse, since nobody resets its forces.
    pub(super) fn push_at(&mut self, body: RigidBodyHandle, force: Vector, place: Vector) {
        let step = self.parameters.dt;
        self.set[body].apply_impulse_at_point(force * step, place, true);
    }

    /// How a body moves, and the origin of its frame.
    pub(super) fn carriage(&self, body: RigidBodyHandle) -> (Carriage, Vector) {
        let body = &self.set[body];
        let turn = body.rotation();
        let axes = [*turn * Vector::X, *turn * Vector::Y, *turn * Vector::Z];
        let carriage =
            Carriage { axes, centre: body.center_of_mass(), velocity: body.linvel(), spin: body.angvel() };
        (carriage, body.translation())
    }

    /// How the pose's point of a vehicle moves on the plane; its acceleration is not known here.
    pub(super) fn knot(&self, body: RigidBodyHandle) -> Knot {
        let (carriage, origin) = self.carriage(body);
        let [ahead, ..] = carriage.axes;
        let velocity = carriage.velocity + carriage.spin.cross(origin - carriage.centre);
        let heading = math::atan2(ahead.y, ahead.x);
        let level = Vector::new(ahead.x, ahead.y, 0.0).normalize_or(Vector::X);
        let pose = Pose { x: origin.x, y: origin.y, heading };
        let (speed, turn_rate) = (velocity.dot(level), carriage.spin.z);
        let motion = Motion { pose, speed, acceleration: 0.0, turn_rate };
        Knot { motion, velocity: [velocity.x, velocity.y] }
    }

    /// Height, roll and pitch of a body.
    pub(super) fn attitude(&self, body: RigidBodyHandle) -> Attitude {
        let ([ahead, left, up], origin) = {
            let (carriage, origin) = self.carriage(body);
            (carriage.axes, origin)
        };
        Attitude {
            height: origin.z,
            roll: math::atan2(left.z, up.z),
            pitch: math::asin((-ahead.z).clamp(-1.0, 1.0)),
        }
    }

    /// Where a prop is now; `None` for one that is fixed.
    pub(super) fn placement(&self, prop: usize) -> Option<Placement> {
        let frame = self.set[self.props[prop]?].position();
        let turn = frame.rotation;
        Some(Placement { position: frame.translation.to_array(), rotation: [turn.x, turn.y, turn.z, turn.w] })
    }

    /// Whether any prop is within `reach` m of the box around a vehicle.
    pub(super) fn props_near(&self, body: RigidBodyHandle, reach: f64) -> bool {
        let Some(collider) = self.set[body].colliders().first() else { return false };
        let around = self.colliders[*collider].compute_aabb().loosened(reach);
        let is_prop = |_, collider: &Collider| matches!(thing_of(collider), EntityId::Prop(_));
        let filter = QueryFilter::new().predicate(&is_prop);
        self.query(filter).intersect_aabb_conservative(around).next().is_some()
    }

    /// The highest prop under a wheel between `above` and `below` m of its mount: how far up it comes, what the wheel
    /// stands on, and the body that bears it.
    pub(super) fn prop_under(
        &self,
        camera_mount: Vector,
        up: Vector,
        above: f64,
        below: f64,
    ) -> Option<(f64, Footing, Option<RigidBodyHandle>)> {
        let is_prop = |_, collider: &Collider| matches!(thing_of(collider), EntityId::Prop(_));
        let ray = Ray::new(camera_mount + up * above, -up);
        let query = self.query(QueryFilter::new().predicate(&is_prop));
        let (hit, at) = query.cast_ray_and_get_normal(&ray, above + below, true)?;
        // A ray that starts inside a prop has no ground under it: the body runs into that prop.
        if at.time_of_impact <= 0.0 {
            return None;
        }
        let place = ray.point_at(at.time_of_impact);
        let body = self.colliders[hit].parent();
        let velocity = body.map_or(Vector::ZERO, |body| self.set[body].velocity_at_point(place));
        let loose = body.filter(|body| self.set[*body].is_dynamic());
        Some((above - at.time_of_impact, Footing { place, normal: at.normal, velocity, grip: 1.0 }, loose))
    }

    fn query<'a>(&'a self, filter: QueryFilter<'a>) -> rapier3d_f64::prelude::QueryPipeline<'a> {
        self.broad_phase.as_query_pipeline(
            self.narrow_phase.query_dispatcher(),
            &self.set,
            &self.colliders,
            filter,
        )
    }

    /// The touches of robots and props.
    pub(super) fn touches(&self) -> Vec<BodyContact> {
        self.narrow_phase.contact_pairs().filter_map(|pair| self.touch(pair)).collect()
    }

    /// The touch of a pair, if it touches and is neither a prop on the ground nor two things that never move.
    fn touch(&self, pair: &ContactPair) -> Option<BodyContact> {
        let colliders = [&self.colliders[pair.collider1], &self.colliders[pair.collider2]];
        let stands = |collider: &&Collider| collider.parent().is_none_or(|body| self.set[body].is_fixed());
        if colliders.iter().all(stands) {
            return None;
        }
        let mut things = colliders.map(thing_of);
        // What lies on the ground is no collision, except a robot's body.
        if things.contains(&EntityId::Ground)
            && !things.iter().any(|thing| matches!(thing, EntityId::Robot(_)))
        {
            return None;
        }
        let impulse = pair.total_impulse_magnitude();
        let points = pair.manifolds().iter().flat_map(|m| m.points.iter().map(move |p| (m, p)));
        let (manifold, deepest) = points.min_by(|(_, a), (_, b)| a.dist.total_cmp(&b.dist))?;
        if impulse <= 0.0 && deepest.dist > TOUCHING {
            return None;
        }
        // A face that meets a face touches at its corners; the place is their middle.
        let about = manifold.points.iter().filter(|point| point.dist <= deepest.dist + CORNERS);
        let (sum, count) = about.fold((Vector::ZERO, 0.0), |(sum, n), point| (sum + point.local_p1, n + 1.0));
        let frame = match manifold.subshape_pos1() {
            Some(part) => *colliders[0].position() * part,
            None => *colliders[0].position(),
        };
        let mut normal = frame.rotation * manifold.local_n1;
        if things[0] > things[1] {
            things.swap(0, 1);
            normal = -normal;
        }
        let place = frame.transform_point(sum / count).to_array();
        Some(BodyContact { things, place, normal: normal.to_array(), impulse })
    }
}

/// The body of a robot as others run into it.
fn shell(index: usize, body: &Body, clearance: f64) -> ColliderBuilder {
    let half = [0.5 * body.length, 0.5 * body.width, 0.5 * (body.height - clearance)];
    let [friction, restitution] = SHELL;
    ColliderBuilder::cuboid(half[0], half[1], half[2])
        .translation(Vector::new(0.5 * body.wheelbase, 0.0, clearance + half[2]))
        .density(0.0)
        .friction(friction)
        .restitution(restitution)
        .user_data(mark(EntityId::Robot(index)))
}

/// The collider of a solid, and where its frame is in the solid's.
fn solid(solid: &Solid) -> (SharedShape, Isometry) {
    let raised = |height: f64| Isometry::from_translation(Vector::new(0.0, 0.0, 0.5 * height));
    // rapier's cylinders and cones stand along y.
    let stood = |height: f64| {
        Isometry::from_parts(
            Vector::new(0.0, 0.0, 0.5 * height),
            Rotation::from_axis_angle(Vector::X, std::f64::consts::FRAC_PI_2),
        )
    };
    match *solid {
        Solid::Block { size: [l, w, h] } => (SharedShape::cuboid(0.5 * l, 0.5 * w, 0.5 * h), raised(h)),
        Solid::Cylinder { radius, height } => (SharedShape::cylinder(0.5 * height, radius), stood(height)),
        Solid::Cone { radius, height } => (SharedShape::cone(0.5 * height, radius), stood(height)),
        Solid::Wedge { size: [l, w, h] } => {
            let at = |x: f64, y: f64, z: f64| Vector::new(0.5 * l * x, 0.5 * w * y, h * z);
            let corners = [
                at(-1.0, -1.0, 0.0),
                at(-1.0, 1.0, 0.0),
                at(1.0, -1.0, 0.0),
                at(1.0, 1.0, 0.0),
                at(1.0, -1.0, 1.0),
                at(1.0, 1.0, 1.0),
            ];
            let hull = SharedShape::convex_hull(&corners);
            (hull.unwrap_or_else(|| SharedShape::cuboid(0.5 * l, 0.5 * w, 0.5 * h)), Isometry::identity())
        }
    }
}

/// A thing as a number that a collider carries.
fn mark(thing: EntityId) -> u128 {
    match thing {
        EntityId::Ground => 0,
        EntityId::Robot(index) => 1 + 2 * index as u128,
        EntityId::Prop(index) => 2 + 2 * index as u128,
    }
}

fn thing_of(collider: &Collider) -> EntityId {
    match collider.user_data {
        0 => EntityId::Ground,
        odd if odd % 2 == 1 => EntityId::Robot((odd / 2) as usize),
        even => EntityId::Prop((even / 2 - 1) as usize),
    }
}

fn frame_of(placement: &Placement) -> Isometry {
    let [x, y, z, w] = placement.rotation;
    Isometry::from_parts(Vector::from(placement.position), Rotation::from_xyzw(x, y, z, w).normalize())
}

/// Upright at a pose.
pub(super) fn upright(pose: Pose, height: f64) -> Isometry {
    frame_of(&Placement::upright(pose, height))
}

/// At a pose, with its wheels on a surface.
pub(super) fn on_surface(pose: Pose, surface: &Surface) -> Isometry {
    let Attitude { height, roll, pitch } = attitude_on(pose.heading, surface);
    let turn = Rotation::from_rotation_z(pose.heading)
        * Rotation::from_rotation_y(pitch)
        * Rotation::from_rotation_x(roll);
    Isometry::from_parts(Vector::new(pose.x, pose.y, height), turn)
}

/// How a body stands on a surface.
pub(super) fn attitude_on(heading: f64, surface: &Surface) -> Attitude {
    let ([nx, ny, nz], (sin, cos)) = (surface.normal, math::sin_cos(heading));
    let (ahead, left) = (nx * cos + ny * sin, ny * cos - nx * sin);
    // The body's z axis comes out as the normal: (sin p cos r, −sin r, cos p cos r) in the heading's frame.
    Attitude { height: surface.height, roll: math::asin(-left), pitch: math::atan2(ahead, nz) }
}

/// Only what can cross its own width in a few steps needs the swept test.
fn needs_sweep(vehicle: &Wheeled, step: f64) -> bool {
    vehicle.limits.speed_max * step > 0.02
}
