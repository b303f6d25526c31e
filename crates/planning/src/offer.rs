//! Why there is no way, and what there is a way for: a smaller formation, or a column, and the gap that holds up the rest.

use crate::convex::apart;
use crate::formation_model::FormationModel;
use crate::gap::Gap;
use crate::leg::Leg;
use crate::map::{Boundary, Map};
use crate::mission::{Mission, PlanRequest, SearchEffort};
use crate::search::{Ended, search};
use crate::trailing::{Blocked, STEP, Sweep, Trailing};
use std::fmt;
use thiserror::Error;

/// No way, and why.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{reason}{}{}", self.shown_gap(), self.shown_offer())]
pub struct NoWay {
    /// Why.
    pub reason: NoWayReason,
    /// The largest formation that gets there, if a smaller one does.
    pub offer: Option<Offer>,
    /// The gap in the way: of what is offered, or of the widest way where nothing is.
    pub gap: Option<Gap>,
    /// Steps that were swept.
    pub expansions: usize,
}

/// Why there is no way.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum NoWayReason {
    /// The lead begins off the ground.
    #[error("the start is off the ground")]
    StartOutside,
    /// A robot begins too near to something.
    #[error("robot {robot} starts too near to {by}")]
    StartBlocked {
        /// Its number, 0 for the lead.
        robot: usize,
        /// To what.
        by: Boundary,
    },
    /// The goal is off the ground.
    #[error("the goal is off the ground")]
    GoalOutside,
    /// The lead has no room at the goal.
    #[error("at the goal the lead is too near to {by}")]
    GoalBlocked {
        /// To what.
        by: Boundary,
    },
    /// Not even the lead gets there.
    #[error("no way for the lead alone: nothing as wide as its body gets there")]
    LeadUnreachable,
    /// Everybody gets there, at another heading only.
    #[error("no way at the heading asked for: there is one to the same place at another")]
    HeadingUnreachable,
    /// The formation does not get there.
    #[error("no way for {}{}", vocabulary::counted(.robots, "robot"), unproven(*.proven))]
    TooWide {
        /// How many they are.
        robots: usize,
        /// Whether all steps were tried.
        proven: bool,
    },
    /// The search was told to stop.
    #[error("the search was stopped before it found a way")]
    Stopped,
}

/// A formation that gets there.
#[derive(Debug, Clone, PartialEq)]
pub struct Offer {
    /// How many robots.
    pub robots: usize,
    /// The formation: robots from the end of the column are left out.
    pub model: FormationModel,
    /// Its mission: levels may differ from what was asked.
    pub mission: Mission,
    /// The way, before smoothing.
    pub legs: Vec<Leg>,
}

fn unproven(proven: bool) -> &'static str {
    if proven { "" } else { " was found: the search used up its effort" }
}

impl NoWay {
    pub(crate) fn because(reason: NoWayReason) -> Self {
        Self { reason, offer: None, gap: None, expansions: 0 }
    }

    fn shown_gap(&self) -> String {
        let shown = |gap: &Gap| {
            let [a, b] = gap.between;
            format!(
                "; the gap of {:.2} m between {a} and {b} at ({:.1}, {:.1})",
                gap.width, gap.at[0], gap.at[1]
            )
        };
        self.gap.as_ref().map(shown).unwrap_or_default()
    }

    fn shown_offer(&self) -> String {
        self.offer.as_ref().map(|offer| format!("; {offer}")).unwrap_or_default()
    }
}

impl fmt::Display for Offer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.robots {
            1 => write!(f, "one for the lead alone"),
            robots if self.model.levels() == 1 => write!(f, "one for {robots} of them"),
            robots => write!(f, "one for a column of {robots}"),
        }
    }
}

/// A share of the effort is left for each search for an offer.
const EFFORT: usize = 3;

/// Why nobody found a way, with an offer.
pub(crate) fn why_not(request: &PlanRequest<'_>, ended: Ended, stop: &mut dyn FnMut(usize) -> bool) -> NoWay {
    let robots = request.model.robots();
    let mut found = NoWay::because(match ended {
        Ended::Stopped => NoWayReason::Stopped,
        Ended::Unreachable => NoWayReason::LeadUnreachable,
        Ended::Exhausted => NoWayReason::TooWide { robots, proven: true },
        Ended::OutOfEffort | Ended::Found => NoWayReason::TooWide { robots, proven: false },
    });
    if found.reason == NoWayReason::Stopped {
        return found;
    }
    let (start, goal) = (request.mission.start.pose, request.mission.goal.position);
    let widest = || Gap::narrowest_on_widest_way(request.map, [start.x, start.y], goal);
    if found.reason == NoWayReason::LeadUnreachable {
        found.gap = widest();
        return found;
    }
    if request.mission.goal.heading.is_some() && at_any_heading(request, &mut found, stop) {
        found.reason = NoWayReason::HeadingUnreachable;
        return found;
    }
    offer(request, &mut found, stop);
    found.gap = match &found.offer {
        Some(offer) => blocking_gap(request, offer).or_else(widest),
        None => widest(),
    };
    found
}

/// An offer for a formation that cannot even start.
pub(crate) fn with_offer(
    request: &PlanRequest<'_>,
    reason: NoWayReason,
    stop: &mut dyn FnMut(usize) -> bool,
) -> NoWay {
    let mut found = NoWay::because(reason);
    offer(request, &mut found, stop);
    found
}

fn less(effort: &SearchEffort) -> SearchEffort {
    SearchEffort { expansions: (effort.expansions / EFFORT).max(1), improvement: 0, ..*effort }
}

fn at_any_heading(request: &PlanRequest<'_>, found: &mut NoWay, stop: &mut dyn FnMut(usize) -> bool) -> bool {
    let mut easier = *request;
    easier.mission.goal.heading = None;
    easier.effort = less(&request.effort);
    let trailing = Trailing::new(easier.model, &easier.limits);
    let outcome = search(&easier, &trailing, stop);
    found.expansions += outcome.expansions;
    outcome.way.is_some()
}

/// Finds the largest column that gets there, by halves: a formation gets wherever a larger one does.
fn offer(request: &PlanRequest<'_>, found: &mut NoWay, stop: &mut dyn FnMut(usize) -> bool) {
    let mut models = vec![request.model.clone()];
    while let Some(smaller) = models.last().and_then(FormationModel::without_last) {
        models.push(smaller);
    }
    let mut mission = request.mission;
    mission.start.level = (request.model.levels() - 1) as f64;
    mission.goal.level = None;
    let is_asked = mission == request.mission;
    let mut tried = |model: &FormationModel| {
        let mission = Mission {
            start: crate::mission::PlanStart {
                level: mission.start.level.min((model.levels() - 1) as f64),
                ..mission.start
            },
            ..mission
        };
        let request = PlanRequest { model, mission, effort: less(&request.effort), held: None, ..*request };
        let trailing = Trailing::new(model, &request.limits);
        let outcome = search(&request, &trailing, stop);
        found.expansions += outcome.expansions;
        outcome.way.map(|way| Offer { robots: model.robots(), model: model.clone(), mission, legs: way.legs })
    };
    // models[k] leaves k robots out: the least k with a way.
    let (mut fails, mut works) = (if is_asked { 0 } else { -1 }, models.len() as i64);
    let mut best = None;
    while works - fails > 1 {
        let middle = if best.is_none() { works - 1 } else { i64::midpoint(fails, works) };
        match tried(&models[middle as usize]) {
            Some(offer) => (best, works) = (Some(offer), middle),
            None if best.is_none() => break,
            None => fails = middle,
        }
    }
    found.offer = best;
}

/// The gap on the way of an offer at which the formation that was asked for is held up: in its column, if it can start so.
fn blocking_gap(request: &PlanRequest<'_>, offer: &Offer) -> Option<Gap> {
    let model = request.model;
    let trailing = Trailing::new(model, &request.limits);
    let mut sweep = Sweep::new(request.map, &trailing, &request.limits);
    let levels = [(model.levels() - 1) as f64, request.mission.start.level];
    levels.iter().find_map(|level| {
        let mut convoy = trailing.begin(request, *level);
        sweep.resume();
        for leg in &offer.legs {
            for mut piece in leg.pieces(STEP) {
                piece.level = *level;
                if let Err(Blocked::Touches { robot, .. }) = sweep.piece(&mut convoy, &piece) {
                    return Gap::at(request.map, beside(&offer.legs, convoy.positions[robot]));
                }
            }
        }
        None
    })
}

/// The point of a way that is nearest to another.
fn beside(legs: &[Leg], point: [f64; 2]) -> [f64; 2] {
    let ends = legs.iter().flat_map(|leg| leg.pieces(STEP)).map(|piece| [piece.end.x, piece.end.y]);
    ends.min_by(|a, b| apart(*a, point).total_cmp(&apart(*b, point))).unwrap_or(point)
}

/// What a point is too near to, if it needs this much room, m.
pub(crate) fn blocked_by(map: &Map, point: [f64; 2], need: f64) -> Option<Boundary> {
    let (nearest, boundary) = map.nearest(point);
    (nearest.distance < need).then_some(boundary)
}
