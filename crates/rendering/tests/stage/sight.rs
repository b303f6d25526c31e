//! What cameras on robots look at, for tests and for looking.

use vocabulary::math;
use vocabulary::{
    Edge, FACES, FleetInfo, Measurement, MeasurementRecord, Region, Relative, Shell, Shot, Snapshot,
    StepRecord,
};

/// The whole picture of every follower, which looks at its leader.
pub(crate) fn shots(fleet: &FleetInfo, snapshot: &mut Snapshot) -> Vec<Shot> {
    let turn = |edge: &Edge| {
        let (leader, robot) = (snapshot.robots[edge.leader], &mut snapshot.robots[edge.follower]);
        let member = &fleet.robots[edge.follower];
        let shell = fleet.robots[edge.leader].shell.unwrap_or(Shell::PAPER);
        let target = leader.world_from_body().apply([shell.forward, 0.0, shell.height]);
        let from = robot.world_from_body().after(&member.camera_mount.body_from_camera(0.0)).inverse();
        let [x, _, z] = from.apply(target);
        robot.camera_pan = -math::atan2(x, z);
        Shot {
            robot: edge.follower,
            world_from_camera: member.camera_mount.world_from_camera(robot),
            focal: member.camera_model.focal,
            centre: member.camera_model.centre,
            region: Region::whole(&member.camera_model),
            exposure: 1.0,
        }
    };
    fleet.edges.iter().map(turn).collect()
}

/// What a tracker would look at: the shell of a robot with some room around it.
pub(crate) fn region_around(fleet: &FleetInfo, snapshot: &Snapshot, shot: &Shot, robot: usize) -> Region {
    let camera_model = fleet.robots[shot.robot].camera_model;
    let shell = fleet.robots[robot].shell.unwrap_or(Shell::PAPER);
    let camera_from_body = shot.world_from_camera.inverse().after(&snapshot.robots[robot].world_from_body());
    let seen: Vec<_> = (0..FACES)
        .flat_map(|face| shell.tag_corners(face))
        .filter_map(|corner| camera_model.project(camera_from_body.apply(corner)))
        .collect();
    let span = |k: usize, most: u32| {
        let low = seen.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = seen.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        let margin = 0.25 * (high - low);
        let edge = |x: f64| x.clamp(0.0, f64::from(most)) as u32;
        let from = edge(low - margin).min(most - 16);
        [from, (edge(high + margin) - from).max(16)]
    };
    let ([x, width], [y, height]) = (span(0, camera_model.width), span(1, camera_model.height));
    Region { x, y, width, height }
}

/// Measurements of every follower as a perfect eye would report them, every camera turned to what it looks at.
pub(crate) fn measurements(fleet: &FleetInfo, record: &mut StepRecord) {
    let shots = shots(fleet, &mut record.snapshot);
    let snapshot = &record.snapshot;
    let measurement = |(index, (edge, shot)): (usize, (&Edge, &Shot))| {
        let (leader, follower) = (snapshot.robots[edge.leader], snapshot.robots[edge.follower]);
        let shell = fleet.robots[edge.leader].shell.unwrap_or(Shell::PAPER);
        let camera_from_body = shot.world_from_camera.inverse().after(&leader.world_from_body());
        let camera_model = fleet.robots[edge.follower].camera_model;
        let tag = |face: usize| {
            let frame = camera_from_body.after(&shell.body_from_face(face));
            let (at, out) = (frame.translation, frame.turn([0.0, 0.0, 1.0]));
            let facing = -(0..3).map(|k| at[k] * out[k]).sum::<f64>() / at[2];
            let corners =
                shell.tag_corners(face).map(|corner| camera_model.project(camera_from_body.apply(corner)));
            let [Some(a), Some(b), Some(c), Some(d)] = corners else { return None };
            (facing > 0.4 && [a, b, c, d].iter().all(|p| camera_model.holds(*p, 2.0))).then_some([a, b, c, d])
        };
        let relative = Relative::between(leader.motion.pose, follower.motion.pose);
        MeasurementRecord {
            edge: index,
            measurement: Measurement { stamp: snapshot.time, relative, deviation: [0.0007, 0.0003, 0.0021] },
            arrival: snapshot.time,
            truth: relative,
            tags: std::array::from_fn(tag),
            region: region_around(fleet, snapshot, shot, edge.leader),
            pan: follower.camera_pan,
            ..MeasurementRecord::default()
        }
    };
    let frames = fleet.edges.iter().zip(&shots).enumerate().map(measurement).collect();
    record.frames = frames;
}
