//! What moves with a frame or not at all: bodies, rings of set points, props, the ground.

use super::drawing::point;
use foxglove::messages::{
    Color, CubePrimitive, CylinderPrimitive, LinePrimitive, Pose, Quaternion, SceneEntity, TextPrimitive,
    TriangleListPrimitive, Vector3, line_primitive::Type,
};
use std::f64::consts::TAU;
use vocabulary::{Edge, FleetInfo, Mobility, Placement, Prop, RobotInfo, Solid, Terrain, math};

/// The frame in which all others are.
pub(super) const WORLD: &str = "world";
/// Radius of the rings of set points, m.
const RING: f64 = 0.25;
/// Points along a side of the ground, at most.
const GROUND: usize = 128;

pub(super) fn robot_frame(member: &RobotInfo) -> String {
    format!("robot/{}", member.name)
}

pub(super) fn prop_frame(prop: &Prop) -> String {
    format!("prop/{}", prop.name)
}

/// Whether a prop has a frame of its own.
pub(super) fn moves(prop: &Prop) -> bool {
    prop.mobility != Mobility::Fixed
}

pub(super) fn colour([r, g, b]: [f32; 3], a: f64) -> Color {
    Color { r: f64::from(r), g: f64::from(g), b: f64::from(b), a }
}

fn pose(x: f64, y: f64, z: f64) -> Pose {
    Pose {
        position: Some(Vector3 { x, y, z }),
        orientation: Some(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }),
    }
}

/// Everything that is drawn once.
pub(super) fn entities(fleet: &FleetInfo, colours: &[Color]) -> Vec<SceneEntity> {
    let robots = fleet.robots.iter().zip(colours).map(|(member, colour)| robot(member, *colour));
    let goals = goal_frames(fleet);
    let rings = fleet
        .edges
        .iter()
        .zip(&goals)
        .filter_map(|(edge, goal)| Some(ring(goal, *colours.get(edge.follower)?)));
    let props = fleet.props.iter().map(prop);
    let ground = fleet.terrain.iter().map(|terrain| ground(terrain));
    robots.chain(rings).chain(props).chain(ground).collect()
}

/// The frames of the set points of all edges; those of a robot's further leaders are numbered.
pub(super) fn goal_frames(fleet: &FleetInfo) -> Vec<String> {
    let mut counts = vec![0_usize; fleet.robots.len()];
    let frame = |edge: &Edge| {
        let (Some(count), Some(robot)) = (counts.get_mut(edge.follower), fleet.robots.get(edge.follower))
        else {
            return String::new();
        };
        *count += 1;
        let goal = format!("{}/set-point", robot_frame(robot));
        if *count == 1 { goal } else { format!("{goal}-{count}") }
    };
    fleet.edges.iter().map(frame).collect()
}

fn locked(frame: &str) -> SceneEntity {
    SceneEntity {
        frame_id: frame.to_owned(),
        id: frame.to_owned(),
        frame_locked: true,
        ..SceneEntity::default()
    }
}

/// A body as boxes: hull and cabin, so that front and back are plain, on four wheels, its name above.
fn robot(member: &RobotInfo, colour: Color) -> SceneEntity {
    let body = &member.body;
    let cube = |x: f64, y: f64, z: f64, size: [f64; 3], color: Color| CubePrimitive {
        pose: Some(pose(x, y, z)),
        size: Some(Vector3 { x: size[0], y: size[1], z: size[2] }),
        color: Some(color),
    };
    let [l, w, h] = [body.length, body.width, body.height];
    let (middle, clear) = (0.5 * body.wheelbase, 0.18 * h);
    let hull = cube(middle, 0.0, clear + 0.2 * h, [l, w, 0.4 * h], colour);
    let cabin = cube(middle - 0.12 * l, 0.0, clear + 0.6 * h, [0.45 * l, 0.86 * w, 0.4 * h], PAPER);
    let (radius, thick) = (body.wheel_radius, 0.16 * w);
    let wheel = |x: f64, side: f64| {
        let y = 0.5 * side * body.track.max(w - thick);
        cube(x, y, radius, [2.0 * radius, thick, 2.0 * radius], TYRE)
    };
    let wheels = [(0.0, 1.0), (0.0, -1.0), (body.wheelbase, 1.0), (body.wheelbase, -1.0)];
    let name = TextPrimitive {
        pose: Some(pose(middle, 0.0, h + 0.6 * l)),
        billboard: true,
        font_size: 13.0,
        scale_invariant: true,
        color: Some(colour),
        text: member.name.clone(),
    };
    SceneEntity {
        cubes: [hull, cabin].into_iter().chain(wheels.map(|(x, side)| wheel(x, side))).collect(),
        texts: vec![name],
        ..locked(&robot_frame(member))
    }
}

const PAPER: Color = Color { r: 0.95, g: 0.95, b: 0.93, a: 1.0 };
const TYRE: Color = Color { r: 0.1, g: 0.1, b: 0.11, a: 1.0 };
const WOOD: Color = Color { r: 0.72, g: 0.66, b: 0.58, a: 1.0 };
const EARTH: Color = Color { r: 0.62, g: 0.62, b: 0.6, a: 1.0 };

fn ring(frame: &str, color: Color) -> SceneEntity {
    let around = (0..32).map(|k| {
        let (sin, cos) = math::sin_cos(TAU * f64::from(k) / 32.0);
        point([RING * cos, RING * sin, 0.0])
    });
    let line = LinePrimitive {
        r#type: Type::LineLoop.into(),
        thickness: 2.0,
        scale_invariant: true,
        points: around.collect(),
        color: Some(color),
        ..LinePrimitive::default()
    };
    SceneEntity { lines: vec![line], ..locked(frame) }
}

fn prop(prop: &Prop) -> SceneEntity {
    let place = if moves(prop) { Placement::default() } else { prop.placement };
    let [qx, qy, qz, qw] = place.rotation;
    let [_, _, height] = prop.solid.extent();
    // Solids stand on their origin, primitives have theirs in the middle.
    let up = [2.0 * (qx * qz + qw * qy), 2.0 * (qy * qz - qw * qx), 1.0 - 2.0 * (qx * qx + qy * qy)];
    let [x, y, z] = [0, 1, 2].map(|k| place.position[k] + 0.5 * height * up[k]);
    let orientation = Some(Quaternion { x: qx, y: qy, z: qz, w: qw });
    let pose = Some(Pose { position: Some(Vector3 { x, y, z }), orientation });
    let frame = if moves(prop) { prop_frame(prop) } else { WORLD.to_owned() };
    let mut entity = SceneEntity { frame_id: frame, id: prop_frame(prop), ..locked("") };
    let color = Some(WOOD);
    match prop.solid {
        Solid::Block { size: [x, y, z] } => {
            entity.cubes.push(CubePrimitive { pose, size: Some(Vector3 { x, y, z }), color });
        }
        Solid::Cylinder { radius, height } | Solid::Cone { radius, height } => {
            let top_scale = if matches!(prop.solid, Solid::Cone { .. }) { 0.0 } else { 1.0 };
            let size = Some(Vector3 { x: 2.0 * radius, y: 2.0 * radius, z: height });
            entity.cylinders.push(CylinderPrimitive { pose, size, bottom_scale: 1.0, top_scale, color });
        }
        Solid::Wedge { size: [l, w, h] } => {
            let (l, w, h) = (0.5 * l, 0.5 * w, 0.5 * h);
            let corners = [[-l, -w, -h], [-l, w, -h], [l, -w, -h], [l, w, -h], [l, -w, h], [l, w, h]];
            let faces = [0, 4, 5, 0, 5, 1, 2, 3, 5, 2, 5, 4, 0, 2, 4, 1, 5, 3, 0, 1, 3, 0, 3, 2];
            let (points, indices) = (corners.map(point).to_vec(), faces.to_vec());
            entity.triangles.push(TriangleListPrimitive { pose, points, color, colors: vec![], indices });
        }
    }
    entity
}

/// The lie of the land, as coarse as it has to be.
fn ground(land: &Terrain) -> SceneEntity {
    let step = (land.columns.max(land.rows)).div_ceil(GROUND).max(1);
    let along = |points: usize| -> Vec<usize> { (0..points - 1).step_by(step).chain([points - 1]).collect() };
    let (columns, rows) = (along(land.columns), along(land.rows));
    let mut points = vec![];
    for row in &rows {
        for column in &columns {
            let [x, y] = [(0, column), (1, row)].map(|(k, at)| land.origin[k] + land.cell * *at as f64);
            points.push(point([x, y, land.at(x, y).height]));
        }
    }
    let wide = columns.len() as u32;
    let cells =
        (0..rows.len() as u32 - 1).flat_map(|row| (0..wide - 1).map(move |column| row * wide + column));
    let indices = cells.flat_map(|k| [k, k + 1, k + wide + 1, k, k + wide + 1, k + wide]).collect();
    let surface = TriangleListPrimitive {
        pose: Some(pose(0.0, 0.0, 0.0)),
        points,
        color: Some(EARTH),
        colors: vec![],
        indices,
    };
    SceneEntity { id: "ground".to_owned(), triangles: vec![surface], ..locked(WORLD) }
}
