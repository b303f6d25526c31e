//! Whether safety filters have what they need.

use crate::{
    Robot, Role,
    robots::RobotDraft,
    text::{Reporter, Span},
    types::TimePart,
};
use vocabulary::{TimeMode, math};

/// Reports filters that cannot do what they are for.
pub(crate) fn check_safety(time: &TimePart, drafts: &[RobotDraft], reporter: &mut Reporter) {
    for draft in drafts {
        let (Some(robot), Some(name)) = (&draft.robot, &draft.named.name) else { continue };
        let leads = matches!(robot.role, Role::Lead { .. });
        if !robot.safety.acts(leads) {
            continue;
        }
        if let Some(mode) = time.mode.as_ref().filter(|mode| mode.value == TimeMode::Continuous) {
            let message = format!(
                "mode `continuous` has no control samples at which the safety filter of `{}` could act; use `sampled` or \
                 `measured`",
                robot.name
            );
            reporter.report(mode.span, message);
        }
        check_range(robot, name.span, reporter);
        check_start(robot, drafts, draft.start.unwrap_or(name.span), reporter);
        check_arena(robot, draft.start.unwrap_or(name.span), reporter);
    }
}

/// Room that the circle around a body takes, the point ahead and the margin included, m.
fn room(robot: &Robot) -> f64 {
    let body = robot.vehicle.body();
    let ahead = robot.safety.point_ahead_of(robot.vehicle.kind, body.length);
    body.radius() + robot.safety.margin_of(body.length) + ahead
}

/// Middle of the body of a robot at the start, m.
fn middle(robot: &Robot) -> [f64; 2] {
    robot.pose.world_from_body(0.5 * robot.vehicle.body().wheelbase, 0.0)
}

fn check_start(robot: &Robot, drafts: &[RobotDraft], span: Span, reporter: &mut Reporter) {
    let [x, y] = middle(robot);
    let body = robot.vehicle.body();
    let own = body.radius() + robot.safety.margin_of(body.length);
    let near = drafts.iter().filter_map(|draft| draft.robot.as_ref()).find_map(|other| {
        let [ox, oy] = middle(other);
        let keeps = own + other.vehicle.body().radius();
        let gap = math::hypot(x - ox, y - oy);
        (other.name != robot.name && gap < keeps).then_some((other, gap, keeps))
    });
    if let Some((other, gap, keeps)) = near {
        let (name, other) = (&robot.name, &other.name);
        let message = format!(
            "`{name}` and `{other}` start nearer to each other than the safety filter of `{name}` keeps them: their middles are \
             {gap:.3} m apart, and it wants {keeps:.3} m"
        );
        reporter.report(span, message);
    }
}

fn check_range(robot: &Robot, span: Span, reporter: &mut Reporter) {
    let (name, room) = (&robot.name, room(robot));
    let Some(range) = robot.proximity.range else {
        let message = format!(
            "`{name}` has a safety filter, but senses nothing near it: give it `proximity = {{ range = 4.0 }}`, in m"
        );
        reporter.report(span, message);
        return;
    };
    if range <= room {
        let message = format!(
            "`proximity` of `{name}` has a `range` of {range} m, within which its safety filter can no longer stop it: more \
             than {room:.3} m"
        );
        reporter.report(span, message);
    }
    if let Some(view) = robot.safety.view_distance.filter(|view| *view > range) {
        let message = format!(
            "`view_distance` of `{name}` is {view} m, beyond its `proximity`, whose `range` is {range} m: it has to sense its \
             leader there"
        );
        reporter.report(span, message);
    }
}

fn check_arena(robot: &Robot, span: Span, reporter: &mut Reporter) {
    let Some([x0, y0, x1, y1]) = robot.safety.arena else { return };
    let (name, room) = (&robot.name, room(robot));
    let narrow = (x1 - x0).min(y1 - y0);
    if narrow <= 2.0 * room {
        let message = format!(
            "`arena` of `{name}` is {narrow} m across, and the robot with its margin takes {:.3} m",
            2.0 * room
        );
        reporter.report(span, message);
    } else if !(x0..=x1).contains(&robot.pose.x) || !(y0..=y1).contains(&robot.pose.y) {
        let message = format!("`{name}` starts at [{}, {}], outside its `arena`", robot.pose.x, robot.pose.y);
        reporter.report(span, message);
    }
}
