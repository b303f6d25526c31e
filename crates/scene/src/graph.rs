//! Who follows whom, as far as a file can be wrong about it.
//!
//! The formation checks its graph too; here the faults can be shown where they are written.

use crate::text::{Found, Reporter, Span, words::instead_of};
use std::collections::HashMap;

/// A robot's name and its leader's, where they could be read.
#[derive(Debug, Clone)]
pub(crate) struct Named {
    pub(crate) name: Option<Found<String>>,
    pub(crate) leader: Option<Found<String>>,
}

/// Reports duplicate names, unknown leaders, robots that follow themselves, and cycles. Without these every follower
/// comes to a robot that leads if it goes from leader to leader; there may be several that lead.
pub(crate) fn check_graph<'a>(robots: impl Iterator<Item = &'a Named> + Clone, reporter: &mut Reporter) {
    let mut leader_of: HashMap<&str, Option<&Found<String>>> = HashMap::with_capacity(robots.size_hint().0);
    let mut spans: HashMap<&str, Span> = HashMap::with_capacity(robots.size_hint().0);
    for robot in robots.clone() {
        let Some(name) = &robot.name else { continue };
        leader_of.insert(&name.value, robot.leader.as_ref());
        if let Some(other) = spans.insert(&name.value, name.span) {
            // The one that was written later, from the command line above all.
            let span = name.span.max(other);
            reporter.report(span, format!("there are two robots called `{}`", name.value));
        }
    }
    for robot in robots.clone() {
        let Some(leader) = &robot.leader else { continue };
        if robot.name.as_ref().is_some_and(|name| name.value == leader.value) {
            reporter.report(leader.span, format!("`{}` cannot follow itself", leader.value));
        } else if !leader_of.contains_key(leader.value.as_str()) && !reporter.is_full() {
            check_known(&leader.value, leader.span, robots.clone(), reporter);
        }
    }
    check_cycles(robots, &leader_of, reporter);
}

/// Reports that no robot is called `name`, if so, with the nearest and some that there are.
pub(crate) fn check_known<'a>(
    name: &str,
    span: Span,
    robots: impl Iterator<Item = &'a Named> + Clone,
    reporter: &mut Reporter,
) {
    // A robot whose name cannot be read may be the one that is meant.
    if robots.clone().any(|robot| robot.name.as_ref().is_none_or(|known| known.value == name)) {
        return;
    }
    // With very many robots the nearest of the first ones has to do.
    let names = robots.filter_map(|robot| Some(robot.name.as_ref()?.value.as_str())).take(1000);
    let hint = instead_of(name, names);
    reporter.report(span, format!("there is no robot called `{name}`{hint}"));
}

fn check_cycles<'a>(
    robots: impl Iterator<Item = &'a Named>,
    leader_of: &HashMap<&'a str, Option<&'a Found<String>>>,
    reporter: &mut Reporter,
) {
    // Each name is walked from once; a walk that meets its own trail has found a cycle.
    let mut walk_of: HashMap<&str, usize> = HashMap::with_capacity(leader_of.len());
    for (walk, robot) in robots.enumerate() {
        let mut trail = vec![];
        let mut at = robot.name.as_ref().map(|name| name.value.as_str());
        while let Some(name) = at {
            match walk_of.insert(name, walk) {
                None => trail.push(name),
                Some(earlier) => {
                    if earlier == walk {
                        note_cycle(&trail, name, leader_of, reporter);
                    }
                    break;
                }
            }
            at = leader_of.get(name).copied().flatten().map(|leader| leader.value.as_str());
        }
    }
}

fn note_cycle(
    trail: &[&str],
    name: &str,
    leader_of: &HashMap<&str, Option<&Found<String>>>,
    reporter: &mut Reporter,
) {
    let cycle: Vec<_> = trail.iter().copied().skip_while(|robot| *robot != name).collect();
    let Some(Some(leader)) = leader_of.get(name) else { return };
    // A robot that follows itself has its own message.
    if cycle.len() > 1 {
        let chain: Vec<_> = cycle.iter().chain([&name]).map(|robot| format!("`{robot}`")).collect();
        reporter.report(leader.span, format!("the followers form a cycle: {}", chain.join(" follows ")));
    }
}
