//! Robots with several leaders, and what they cannot have.

use crate::{
    Follow, Law, Leader, Leaders, Robot, Safety, SensingKind,
    document::{LeaderKeys, RobotKeys},
    robots::check_distance,
    text::{Found, Node, Reporter, Span},
};
use vocabulary::Word;

/// The names of all leaders of a robot, as far as they could be read.
pub(crate) fn named(keys: &RobotKeys) -> Vec<Found<String>> {
    match &keys.leaders {
        Some(list) => list.value.iter().filter_map(|leader| leader.name.clone()).collect(),
        None => keys.leader.clone().into_iter().collect(),
    }
}

/// The one leader or the several of a robot that follows by `law`; `None` after reporting errors.
pub(crate) fn leaders(keys: &RobotKeys, node: &Node, law: &Law, reporter: &mut Reporter) -> Option<Leaders> {
    let name = keys.name.as_ref()?.value.as_str();
    if let Some(list) = &keys.leaders {
        for (key, span) in [
            ("leader", keys.leader.as_ref().map(|found| found.span)),
            ("distance", keys.distance.as_ref().map(|found| found.span)),
            ("bearing", keys.bearing.as_ref().map(|found| found.span)),
        ] {
            if let Some(span) = span {
                let message = format!(
                    "`{name}` has `leaders`, and each of them says this itself: leave out this `{key}`"
                );
                reporter.report(span, message);
            }
        }
        check_count(name, list.value.len(), law, list.span, reporter);
        let written = list.value.iter().zip(node.items("leaders"));
        let read: Vec<_> = written.map(|(keys, node)| leader(keys, node, name, law, reporter)).collect();
        let mut all = read.into_iter().collect::<Option<Vec<_>>>()?.into_iter();
        return Some(Leaders { first: all.next()?, also: all.collect() });
    }
    let span = keys.leader.as_ref()?.span;
    for key in ["distance", "bearing"] {
        if node.get(key).is_none() {
            reporter.report(span, format!("`{key}` is missing: a robot that follows one leader needs it"));
        }
    }
    check_count(name, 1, law, span, reporter);
    let (distance, bearing) = (keys.distance.as_ref()?, keys.bearing.as_ref()?);
    check_distance(distance.value.range()[0], law.distance_min, distance.span, reporter);
    Some(Leaders::one(keys.leader.as_ref()?.value.clone(), distance.value.clone(), bearing.value.clone()))
}

/// One of several leaders.
fn leader(
    keys: &LeaderKeys,
    node: &Node,
    follower: &str,
    law: &Law,
    reporter: &mut Reporter,
) -> Option<Leader> {
    let name = keys.name.as_ref()?;
    if keys.distance.is_none() && keys.bearing.is_none() {
        // One that is there but wrong is reported already.
        if node.get("distance").or(node.get("bearing")).is_none() {
            let message = format!(
                "`{follower}` wants nothing of `{}`: give a `distance`, a `bearing`, or both",
                name.value
            );
            reporter.report(name.span, message);
        }
        return None;
    }
    if let Some(found) = &keys.distance {
        check_distance(found.value.range()[0], law.distance_min, found.span, reporter);
    }
    let [distance, bearing] =
        [&keys.distance, &keys.bearing].map(|part| part.as_ref().map(|found| found.value.clone()));
    Some(Leader { name: name.value.clone(), distance, bearing })
}

/// Reports a robot with more or fewer leaders than its law looks at.
pub(crate) fn check_count(name: &str, count: usize, law: &Law, span: Span, reporter: &mut Reporter) {
    let wanted = law.leaders();
    if count == wanted {
        return;
    }
    let message = match (count, wanted) {
        (_, 1) => format!(
            "`{name}` has {count} leaders, and its law looks at one: a law for {count} leaders is needed, `law.file`"
        ),
        (1, _) => format!("`{name}` has one leader, and its law looks at {wanted}: give them as `leaders`"),
        _ => format!("`{name}` has {count} leaders, and its law looks at {wanted}"),
    };
    reporter.report(span, message);
}

/// Reports what a robot with several leaders cannot have; `span` is where they are said.
pub(crate) fn check_several(
    name: &str,
    follow: &Follow,
    safety: &Safety,
    span: Span,
    reporter: &mut Reporter,
) {
    if !follow.leaders.are_several() {
        return;
    }
    check_wanted(name, follow, span, reporter);
    let kind = follow.sensing.kind;
    let sensing = format!("sensing `{}`: a camera looks at one leader; use `truth` or `noise`", kind.word());
    let looks = safety.acts(false) && (safety.view_distance.is_some() || safety.view_angle.is_some());
    for (has, what) in [
        (matches!(kind, SensingKind::Geometric | SensingKind::Camera), sensing.as_str()),
        (follow.law.standing, "`standing`: a robot stands where the path of one leader ends"),
        (follow.narrowing.narrows, "`narrows`: a column is filed in behind one leader"),
        (looks, "`view_distance` and `view_angle`: they keep one leader in view"),
    ] {
        if has {
            reporter.report(span, format!("`{name}` has several leaders and cannot have {what}"));
        }
    }
}

/// Reports what a custom law reads of a set point that is left free.
fn check_wanted(name: &str, follow: &Follow, span: Span, reporter: &mut Reporter) {
    let Some(law) = follow.law.custom() else { return };
    let mut told = vec![];
    for (index, kind) in &law.declaration().reads {
        let (Some(part), Some(leader)) = (kind.wanted(), follow.leaders.iter().nth(*index)) else { continue };
        let (what, absent) =
            [("distance", leader.distance.is_none()), ("bearing", leader.bearing.is_none())][part];
        if absent && !told.contains(&(*index, part)) {
            told.push((*index, part));
            let number = index + 1;
            let message = format!(
                "{} reads `wanted{number}.{what}`, but `{name}` leaves its {what} from `{}` free: give it a `{what}`",
                law.name(),
                leader.name
            );
            reporter.report(span, message);
        }
    }
}

/// Why nobody can tell `robot` whom to follow; `None` where somebody can.
pub(crate) fn keeps_its_leaders(robot: &Robot) -> Option<String> {
    let several = robot.role.follow().is_some_and(|follow| follow.leaders.are_several());
    several.then(|| {
        format!(
            "`{}` has several leaders and keeps them: who changes its leader goes from one to one",
            robot.name
        )
    })
}
