//! How the followers of a scene file in; the formation gives them their places in the column.

use crate::build::edge_law;
use formation::column::Filing;
use formation::{EdgeLaw, Narrowing};
use scene::{Follow, Leader, Robot, Scene};
use vocabulary::Relative;

/// The laws of all followers, in the order of the graph's edges: those that follow from the start, and those that join.
pub(crate) fn edge_laws(scene: &Scene) -> Vec<EdgeLaw> {
    let pose = |name: &str| scene.robots.get(scene.index_of(name)?).map(|robot| robot.pose);
    let law = |robot: &Robot, follow: &Follow, leader: &Leader| {
        // What is left free is as it is at the start.
        let free = leader.distance.is_none() || leader.bearing.is_none();
        let at = free.then(|| pose(&leader.name)).flatten().unwrap_or(robot.pose);
        let now = Relative::between(at, robot.pose);
        let law = edge_law(follow, leader, [now.distance, now.bearing]);
        EdgeLaw { narrowing: narrowing(robot, follow), ..law }
    };
    let followers = scene.robots.iter().filter_map(|robot| Some((robot, robot.role.follow()?)));
    let from_the_start = followers
        .flat_map(|(robot, follow)| follow.leaders.iter().map(move |leader| (robot, follow, leader)));
    let from_the_start = from_the_start.map(|(robot, follow, leader)| law(robot, follow, leader));
    let joining = scene.joining();
    let later = joining.iter().filter_map(|(name, follow)| {
        let robot = scene.robots.get(scene.index_of(name)?)?;
        Some(law(robot, follow, &follow.leaders.first))
    });
    from_the_start.chain(later).collect()
}

/// How a follower files in; `None` where it does not.
pub(crate) fn filing(robot: &Robot, follow: &Follow) -> Option<Filing> {
    let (rule, length) = (&follow.narrowing, robot.vehicle.body().length);
    rule.narrows.then(|| Filing { spacing: rule.spacing_of(length), stagger: rule.stagger_of(length) })
}

fn narrowing(robot: &Robot, follow: &Follow) -> Option<Narrowing> {
    let (rule, safety, body) = (&follow.narrowing, &robot.safety, robot.vehicle.body());
    let ahead = if safety.acts(false) { safety.point_ahead_of(robot.vehicle.kind, body.length) } else { 0.0 };
    filing(robot, follow).map(|filing| Narrowing {
        filing,
        column: [0.0; 2],
        // What its filter keeps free beside the point ahead, and a little more.
        half_width: body.radius() + safety.margin_of(body.length) + ahead + rule.room_of(body.length),
        rate: rule.rate_of(body.length),
        acceleration: rule.acceleration_of(body.length),
        patience: rule.patience,
        reserve: rule.reserve_of(body.length),
    })
}
