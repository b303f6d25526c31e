//! Whether followers that narrow have what they need.

use crate::{Law, Narrowing, Robot, robots::RobotDraft, text::Reporter};
use vocabulary::HeadingReference;

/// Reports followers that cannot narrow.
pub(crate) fn check_narrowing(drafts: &[RobotDraft], reporter: &mut Reporter) {
    for draft in drafts {
        let (Some(robot), Some(name)) = (&draft.robot, &draft.named.name) else { continue };
        let Some(follow) = robot.role.follow() else { continue };
        if let Some(message) = fault(robot, &follow.narrowing, &follow.law) {
            reporter.report(draft.start.unwrap_or(name.span), message);
        }
    }
}

/// Why a robot cannot narrow by `rule` as it follows by `law`.
pub(crate) fn fault(robot: &Robot, rule: &Narrowing, law: &Law) -> Option<String> {
    let (name, body) = (&robot.name, robot.vehicle.body());
    if !rule.narrows {
        return None;
    }
    let (spacing, least) =
        (rule.spacing_of(body.length), 2.0 * body.radius() + robot.safety.margin_of(body.length));
    if robot.proximity.range.is_none() {
        return Some(format!(
            "`{name}` narrows, but senses nothing near it: give it `proximity = {{ range = 8.0 }}`, in m"
        ));
    }
    if law.heading != HeadingReference::Path {
        return Some(format!(
            "`{name}` narrows, which needs `heading = \"path\"` in its `law`: a column swings whose bearings are counted \
             from the leader's own heading"
        ));
    }
    (spacing < least).then(|| {
        format!(
            "`spacing` of {spacing} m in the column is too little for `{name}`: its body and the margin of its filter take \
             {least:.3} m"
        )
    })
}
