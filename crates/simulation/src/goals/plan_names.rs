//! Why there is no way, with the names of the scene.

use super::known_things::owner;
use crate::caption::short;
use planning::{Boundary, Convex, NoWay, NoWayReason, PlanError};
use std::fmt::Write;
use vocabulary::{EntityId, TourGoal};

/// Who and what a plan was asked for.
pub(super) struct PlanNames<'a> {
    /// Of everything.
    pub(super) name: &'a dyn Fn(EntityId) -> String,
    /// The robots of the plan, the lead first.
    pub(super) robots: &'a [usize],
    /// What stands in its map.
    pub(super) standing: &'a [(EntityId, Convex)],
    /// What moves.
    pub(super) moving: &'a [EntityId],
    /// The goal that it sets out from, on a tour.
    pub(super) from: Option<TourGoal>,
}

impl PlanNames<'_> {
    /// Why there is no plan.
    pub(super) fn why(&self, error: &PlanError) -> String {
        match error {
            PlanError::Input(error) => error.to_string(),
            PlanError::NoWay(no_way) => self.no_way(no_way),
            PlanError::Meets(error) => {
                let thing =
                    self.moving.get(error.0.thing).map_or_else(String::new, |thing| self.quoted(*thing));
                format!(
                    "{} meets {thing} {:.1} s after it sets out, and cannot wait until that is gone",
                    self.robot(error.0.robot),
                    error.0.time
                )
            }
        }
    }

    fn quoted(&self, whose: EntityId) -> String {
        format!("`{}`", (self.name)(whose))
    }

    fn thing(&self, boundary: &Boundary) -> String {
        owner(self.standing, boundary)
            .map_or_else(|| "the edge of the map".to_owned(), |whose| self.quoted(whose))
    }

    fn robot(&self, index: usize) -> String {
        let robot = self.robots.get(index);
        robot.map_or_else(|| format!("robot {index}"), |robot| self.quoted(EntityId::Robot(*robot)))
    }

    fn no_way(&self, no_way: &NoWay) -> String {
        let mut text = match &no_way.reason {
            NoWayReason::StartBlocked { robot, by } => format!(
                "{} starts too near to {}: move it, or ask for less `clearance`",
                self.robot(*robot),
                self.thing(by)
            ),
            NoWayReason::GoalBlocked { by } => {
                let thing = self.thing(by);
                format!("at its goal it is too near to {thing}: move the goal, or ask for less `clearance`")
            }
            reason => reason.to_string(),
        };
        // Writing to a text cannot fail.
        if let (NoWayReason::StartHeading { .. }, Some(from)) = (&no_way.reason, self.from) {
            let _ = write!(text, "; give {from} that heading, or another place");
        }
        if let Some(gap) = &no_way.gap {
            let [a, b] = &gap.between;
            // −0 is written as 0.
            let [x, y] = gap.at.map(|value| short((10.0 * value).round() / 10.0 + 0.0));
            let width = short((100.0 * gap.width).round() / 100.0);
            let (a, b) = (self.thing(a), self.thing(b));
            let _ = write!(
                text,
                "; what is in the way is the gap of {width} m between {a} and {b} at [{x}, {y}]"
            );
        }
        if let Some(offer) = &no_way.offer {
            let _ = write!(text, "; there is {offer}");
        }
        text
    }
}
