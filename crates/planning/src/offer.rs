//! Why there is no way, and what there is a way for: a smaller formation, or a column, and the gap that holds up the rest.

use crate::convex::apart;
use crate::formation_model::FormationModel;
use crate::gap::Gap;
use crate::leg::Leg;
use crate::map::{Boundary, Map};
use crate::mission::{Mission, PlanRequest, SearchEffort};
use crate::planner::at_the_ends;
use crate::search::{Ended, search};
use crate::search_record::SearchRecord;
use crate::trailing::{Blocked, STEP, Sweep, Trailing};
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt;
use thiserror::Error;
use vocabulary::wrap;

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
    /// What the search for the way that was asked for looked at, if its effort asks for it.
    pub record: SearchRecord,
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
    /// The goal is reached, at another heading only.
    #[error(
        "the goal can be reached, but not with heading {} deg: there is no room to turn; there is a way with heading {} deg",
        degrees(*.heading),
        degrees(*.other)
    )]
    HeadingUnreachable {
        /// That is asked for, rad.
        heading: f64,
        /// That a way ends with, rad.
        other: f64,
    },
    /// The goal is reached from another heading at the start only.
    #[error(
        "there is no room to turn from heading {} deg at the start: there is a way from heading {} deg",
        degrees(*.heading),
        degrees(*.other)
    )]
    StartHeading {
        /// That of the start, rad.
        heading: f64,
        /// From which there is a way, rad.
        other: f64,
    },
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

/// Whole degrees.
fn degrees(heading: f64) -> f64 {
    // −0 is written as 0.
    wrap(heading).to_degrees().round() + 0.0
}

fn unproven(proven: bool) -> &'static str {
    if proven { "" } else { " was found: the search used up its effort" }
}

impl NoWay {
    pub(crate) fn because(reason: NoWayReason) -> Self {
        Self { reason, offer: None, gap: None, expansions: 0, record: SearchRecord::default() }
    }

    fn shown_gap(&self) -> String {
        let shown = |gap: &Gap| {
            let [a, b] = gap.between;
            // −0 is written as 0.
            let [x, y] = gap.at.map(|value| (10.0 * value).round() / 10.0 + 0.0);
            format!("; the gap of {:.2} m between {a} and {b} at ({x:.1}, {y:.1})", gap.width)
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

/// Why nobody found a way, with an offer if the effort asks for an explanation.
pub(crate) fn why_not(request: &PlanRequest<'_>, ended: Ended, stop: &mut dyn FnMut(usize) -> bool) -> NoWay {
    let robots = request.model.robots();
    let mut found = NoWay::because(match ended {
        Ended::Stopped => NoWayReason::Stopped,
        Ended::Unreachable => NoWayReason::LeadUnreachable,
        Ended::Exhausted => NoWayReason::TooWide { robots, proven: true },
        Ended::OutOfEffort | Ended::Found => NoWayReason::TooWide { robots, proven: false },
    });
    if found.reason == NoWayReason::Stopped || !request.effort.explains {
        return found;
    }
    let (start, goal) = (request.mission.start.pose, request.mission.goal.position);
    let widest = || Gap::narrowest_on_widest_way(request.map, [start.x, start.y], goal);
    if found.reason == NoWayReason::LeadUnreachable {
        found.gap = widest();
        return found;
    }
    if let Some(reason) = at_another_goal_heading(request, &mut found, stop) {
        found.reason = reason;
        return found;
    }
    offer(request, &mut found, stop);
    if found.offer.is_none() {
        // Not even the lead alone gets there, though its body would: it has no room to turn.
        let lead = alone(request.model);
        let request = &of_smaller(request, &lead, request.mission.start.level);
        let turns = at_another_goal_heading(request, &mut found, stop);
        if let Some(reason) = turns.or_else(|| from_another_heading(request, &mut found, stop)) {
            found.reason = reason;
            return found;
        }
        found.gap = widest();
        return found;
    }
    found.gap = found.offer.as_ref().and_then(|offer| blocking_gap(request, offer));
    if found.gap.is_none() {
        // Nothing is too narrow for it, so it cannot turn.
        match from_another_heading(request, &mut found, stop) {
            Some(reason) => found.reason = reason,
            None => found.gap = widest(),
        }
    }
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
    SearchEffort {
        expansions: (effort.expansions / EFFORT).max(1),
        improvement: 0,
        records: false,
        ..*effort
    }
}

/// The reason if there is a way to the goal at another heading than that asked for.
fn at_another_goal_heading(
    request: &PlanRequest<'_>,
    found: &mut NoWay,
    stop: &mut dyn FnMut(usize) -> bool,
) -> Option<NoWayReason> {
    let heading = request.mission.goal.heading?;
    let mut easier = *request;
    easier.mission.goal.heading = None;
    let legs = tried(&easier, found, stop)?;
    let other = legs.last()?.pieces(STEP).last()?.end.heading;
    Some(NoWayReason::HeadingUnreachable { heading, other })
}

/// The reason if there is a way from another heading at the start.
fn from_another_heading(
    request: &PlanRequest<'_>,
    found: &mut NoWay,
    stop: &mut dyn FnMut(usize) -> bool,
) -> Option<NoWayReason> {
    let heading = request.mission.start.pose.heading;
    for turn in TURNS {
        let mut turned = PlanRequest { held: None, ..*request };
        let start = &mut turned.mission.start;
        start.pose.heading = wrap(heading + turn);
        start.curvature = 0.0;
        let other = start.pose.heading;
        let trailing = Trailing::new(turned.model, &turned.limits);
        if at_the_ends(&turned, &trailing).is_none() && tried(&turned, found, stop).is_some() {
            return Some(NoWayReason::StartHeading { heading, other });
        }
    }
    None
}

/// Headings at the start that are tried, against that which it has, rad.
const TURNS: [f64; 3] = [PI, FRAC_PI_2, -FRAC_PI_2];

/// A way with less effort.
fn tried(
    request: &PlanRequest<'_>,
    found: &mut NoWay,
    stop: &mut dyn FnMut(usize) -> bool,
) -> Option<Vec<Leg>> {
    let request = PlanRequest { effort: less(&request.effort), ..*request };
    let trailing = Trailing::new(request.model, &request.limits);
    let outcome = search(&request, &trailing, stop);
    found.expansions += outcome.expansions;
    outcome.way.map(|way| way.legs)
}

/// The lead of a formation without all that follow it.
fn alone(model: &FormationModel) -> FormationModel {
    let mut model = model.clone();
    while let Some(smaller) = model.without_last() {
        model = smaller;
    }
    model
}

/// The same for a smaller formation, which begins at a level that it has and ends at any.
fn of_smaller<'a>(request: &PlanRequest<'a>, model: &'a FormationModel, level: f64) -> PlanRequest<'a> {
    let mut smaller = PlanRequest { model, held: None, ..*request };
    smaller.mission.start.level = level.min((model.levels() - 1) as f64);
    smaller.mission.goal.level = None;
    smaller
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
    let mut offered = |model: &FormationModel| {
        let smaller = of_smaller(request, model, mission.start.level);
        let legs = tried(&smaller, found, stop)?;
        Some(Offer { robots: model.robots(), model: model.clone(), mission: smaller.mission, legs })
    };
    // models[k] leaves k robots out: the least k with a way.
    let (mut fails, mut works) = (if is_asked { 0 } else { -1 }, models.len() as i64);
    let mut best = None;
    while works - fails > 1 {
        let middle = if best.is_none() { works - 1 } else { i64::midpoint(fails, works) };
        match offered(&models[middle as usize]) {
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
