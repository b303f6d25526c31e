//! What cameras on robots look at, for tests and for looking.

use vocabulary::{Cast, Edge, FACES, Frame, Moment, Region, Relative, Shell, Shot, Sighting, Snapshot};

/// The whole picture of every follower, which looks at its leader.
pub(crate) fn shots(cast: &Cast, snapshot: &mut Snapshot) -> Vec<Shot> {
    let turn = |edge: &Edge| {
        let (leader, robot) = (snapshot.robots[edge.leader], &mut snapshot.robots[edge.follower]);
        let member = &cast.members[edge.follower];
        let shell = cast.members[edge.leader].shell.unwrap_or(Shell::PAPER);
        let target = leader.world_from_body().apply([shell.forward, 0.0, shell.height]);
        let from = robot.world_from_body().after(&member.mount.body_from_camera(0.0)).inverse();
        let [x, _, z] = from.apply(target);
        robot.camera_pan = -x.atan2(z);
        Shot {
            robot: edge.follower,
            world_from_camera: member.mount.world_from_camera(robot),
            focal: member.lens.focal,
            centre: member.lens.centre,
            region: Region::whole(&member.lens),
            exposure: 1.0,
        }
    };
    cast.edges.iter().map(turn).collect()
}

/// What a tracker would look at: the shell of a robot with some room around it.
pub(crate) fn region_around(cast: &Cast, snapshot: &Snapshot, shot: &Shot, robot: usize) -> Region {
    let lens = cast.members[shot.robot].lens;
    let shell = cast.members[robot].shell.unwrap_or(Shell::PAPER);
    let camera_from_body = shot.world_from_camera.inverse().after(&snapshot.robots[robot].world_from_body());
    let seen: Vec<_> = (0..FACES)
        .flat_map(|face| shell.tag_corners(face))
        .filter_map(|corner| lens.project(camera_from_body.apply(corner)))
        .collect();
    let span = |k: usize, most: u32| {
        let low = seen.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = seen.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        let margin = 0.25 * (high - low);
        let edge = |x: f64| x.clamp(0.0, f64::from(most)) as u32;
        let from = edge(low - margin).min(most - 16);
        [from, (edge(high + margin) - from).max(16)]
    };
    let ([x, width], [y, height]) = (span(0, lens.width), span(1, lens.height));
    Region { x, y, width, height }
}

/// Looks of every follower at its leader as a perfect eye would report them, every camera turned to what it looks at.
pub(crate) fn looks(cast: &Cast, moment: &mut Moment) {
    let shots = shots(cast, &mut moment.snapshot);
    let snapshot = &moment.snapshot;
    let look = |(index, (edge, shot)): (usize, (&Edge, &Shot))| {
        let (leader, follower) = (snapshot.robots[edge.leader], snapshot.robots[edge.follower]);
        let shell = cast.members[edge.leader].shell.unwrap_or(Shell::PAPER);
        let camera_from_body = shot.world_from_camera.inverse().after(&leader.world_from_body());
        let lens = cast.members[edge.follower].lens;
        let tag = |face: usize| {
            let frame = camera_from_body.after(&shell.body_from_face(face));
            let (at, out) = (frame.translation, frame.turn([0.0, 0.0, 1.0]));
            let facing = -(0..3).map(|k| at[k] * out[k]).sum::<f64>() / at[2];
            let corners = shell.tag_corners(face).map(|corner| lens.project(camera_from_body.apply(corner)));
            let [Some(a), Some(b), Some(c), Some(d)] = corners else { return None };
            (facing > 0.4 && [a, b, c, d].iter().all(|p| lens.holds(*p, 2.0))).then_some([a, b, c, d])
        };
        let relative = Relative::between(leader.motion.pose, follower.motion.pose);
        Frame {
            edge: index,
            sighting: Sighting { stamp: snapshot.time, relative, deviation: [0.0007, 0.0003, 0.0021] },
            arrival: snapshot.time,
            truth: relative,
            tags: std::array::from_fn(tag),
            region: region_around(cast, snapshot, shot, edge.leader),
            pan: follower.camera_pan,
            ..Frame::default()
        }
    };
    let frames = cast.edges.iter().zip(&shots).enumerate().map(look).collect();
    moment.frames = frames;
}
