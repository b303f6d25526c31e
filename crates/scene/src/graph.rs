//! Who follows whom, as far as a file can be wrong about it.
//!
//! The formation checks its graph too; here the faults can be shown where they are written.

use crate::text::{Found, Reporter, Span, words::instead_of};
use std::collections::HashMap;

/// A robot's name and its leaders', where they could be read.
#[derive(Debug, Clone)]
pub(crate) struct Named {
    pub(crate) name: Option<Found<String>>,
    pub(crate) leaders: Vec<Found<String>>,
}

/// Reports duplicate names, unknown leaders, robots that follow themselves, and cycles. Without these every follower
/// comes to a robot that leads if it goes from leader to leader; there may be several that lead.
pub(crate) fn check_graph<'a>(robots: impl Iterator<Item = &'a Named> + Clone, reporter: &mut Reporter) {
    let mut leaders_of: HashMap<&str, &[Found<String>]> = HashMap::with_capacity(robots.size_hint().0);
    let mut spans: HashMap<&str, Span> = HashMap::with_capacity(robots.size_hint().0);
    for robot in robots.clone() {
        let Some(name) = &robot.name else { continue };
        leaders_of.insert(&name.value, &robot.leaders);
        if let Some(other) = spans.insert(&name.value, name.span) {
            // The one that was written later, from the command line above all.
            let span = name.span.max(other);
            reporter.report(span, format!("there are two robots called `{}`", name.value));
        }
    }
    for robot in robots.clone() {
        for (index, leader) in robot.leaders.iter().enumerate() {
            if robot.name.as_ref().is_some_and(|name| name.value == leader.value) {
                reporter.report(leader.span, format!("`{}` cannot follow itself", leader.value));
            } else if robot.leaders.iter().take(index).any(|other| other.value == leader.value) {
                let message =
                    format!("`{}` is named twice: the leaders of a robot must differ", leader.value);
                reporter.report(leader.span, message);
            } else if !leaders_of.contains_key(leader.value.as_str()) && !reporter.is_full() {
                check_known(&leader.value, leader.span, robots.clone(), reporter);
            }
        }
    }
    check_cycles(robots, &leaders_of, reporter);
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
    leaders_of: &HashMap<&'a str, &'a [Found<String>]>,
    reporter: &mut Reporter,
) {
    // From leader to leader, one after the other; a walk that meets its own trail has found a cycle.
    let mut walked: HashMap<&str, bool> = HashMap::with_capacity(leaders_of.len());
    for start in robots.filter_map(|robot| robot.name.as_ref()) {
        if walked.contains_key(start.value.as_str()) {
            continue;
        }
        walked.insert(&start.value, false);
        let mut trail = vec![(start.value.as_str(), 0)];
        while let Some((at, next)) = trail.last_mut() {
            let Some(leader) = leaders_of.get(at).and_then(|leaders| leaders.get(*next)) else {
                walked.insert(at, true);
                trail.pop();
                continue;
            };
            *next += 1;
            match walked.get(leader.value.as_str()) {
                None => {
                    walked.insert(&leader.value, false);
                    trail.push((&leader.value, 0));
                }
                Some(false) => note_cycle(&trail, &leader.value, leaders_of, reporter),
                Some(true) => {}
            }
        }
    }
}

/// A cycle that ends in `name`, which is on the trail; each of the trail with the number of the leader after the one that
/// the trail goes to.
fn note_cycle(
    trail: &[(&str, usize)],
    name: &str,
    leaders_of: &HashMap<&str, &[Found<String>]>,
    reporter: &mut Reporter,
) {
    let cycle: Vec<_> = trail.iter().copied().skip_while(|(robot, _)| *robot != name).collect();
    // A robot that follows itself has its own message.
    let [(_, after), _, ..] = cycle[..] else { return };
    let Some(leader) = leaders_of.get(name).and_then(|leaders| leaders.get(after - 1)) else { return };
    let robots = cycle.iter().map(|(robot, _)| *robot).chain([name]);
    let chain: Vec<_> = robots.map(|robot| format!("`{robot}`")).collect();
    reporter.report(leader.span, format!("the followers form a cycle: {}", chain.join(" follows ")));
}
