//! How the followers of a scene file in: the places of all in the column, for the law of each.

use crate::build::edge_law;
use formation::column::{Filing, cartesian, column};
use formation::{EdgeLaw, Graph, Narrowing};
use scene::{Follow, Robot};

/// The laws of all followers, in the order of the graph's edges.
pub(crate) fn edge_laws(robots: &[Robot], graph: &Graph) -> Vec<EdgeLaw> {
    let followers: Vec<(&Robot, &Follow)> =
        robots.iter().filter_map(|robot| Some((robot, robot.role.follow()?))).collect();
    let mut laws: Vec<EdgeLaw> = followers.iter().map(|(_, follow)| edge_law(follow)).collect();
    if followers.iter().any(|(_, follow)| follow.narrowing.narrows) {
        let places: Vec<_> = laws.iter().map(|law| cartesian(law.set_point.at(0.0).value)).collect();
        let filings: Vec<_> = followers.iter().map(|(robot, follow)| filing(robot, follow)).collect();
        let columns = column(graph, &places, &filings);
        for ((law, (robot, follow)), column) in laws.iter_mut().zip(&followers).zip(columns) {
            law.narrowing = narrowing(robot, follow, column);
        }
    }
    laws
}

/// How a follower files in; `None` where it does not.
pub(crate) fn filing(robot: &Robot, follow: &Follow) -> Option<Filing> {
    let (rule, length) = (&follow.narrowing, robot.vehicle.body().length);
    rule.narrows.then(|| Filing { spacing: rule.spacing_of(length), stagger: rule.stagger_of(length) })
}

fn narrowing(robot: &Robot, follow: &Follow, column: [f64; 2]) -> Option<Narrowing> {
    let (rule, safety, body) = (&follow.narrowing, &robot.safety, robot.vehicle.body());
    let ahead = if safety.acts(false) { safety.point_ahead_of(robot.vehicle.kind, body.length) } else { 0.0 };
    rule.narrows.then(|| Narrowing {
        column,
        // What its filter keeps free beside the point ahead, and a little more.
        half_width: body.radius() + safety.margin_of(body.length) + ahead + rule.room_of(body.length),
        rate: rule.rate_of(body.length),
        acceleration: rule.acceleration_of(body.length),
        patience: rule.patience,
        reserve: rule.reserve_of(body.length),
    })
}
