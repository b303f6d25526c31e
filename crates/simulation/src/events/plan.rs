//! The events of a scene, with robots by index and motions as they are driven.

use super::{EventAction, EventPlan, HandOverRules, Holds, PlannedEvent, Recovery, Trigger};
use crate::error::BuildError;
use crate::stage::course;
use formation::{HandOverParameters, SetPointTrajectory};
use scene::{Failure, Happening, Scene};
use vocabulary::EventKind;

/// What is to happen in a run of `scene`.
///
/// # Errors
/// Way-points that make no curve.
pub(crate) fn event_plan(scene: &Scene) -> Result<EventPlan, BuildError> {
    let mut events = Vec::with_capacity(scene.events.len());
    for event in &scene.events {
        // A checked scene names robots that there are.
        if let (Some(trigger), Some(action)) = (trigger(scene, event), action(scene, &event.happening)?) {
            events.push(PlannedEvent { trigger, action });
        }
    }
    let rules = &scene.hand_over;
    Ok(EventPlan {
        events,
        hand_over: HandOverRules {
            way: HandOverParameters {
                speed: rules.speed,
                acceleration: rules.acceleration,
                fade: rules.fade,
            },
            distance: rules.distance,
            bearing_max: rules.bearing_max,
            retry: rules.retry,
            patience: rules.patience,
            held_up: rules.held_up,
        },
    })
}

fn trigger(scene: &Scene, event: &scene::Event) -> Option<Trigger> {
    let when = match &event.trigger {
        scene::Trigger::At { at } => return Some(Trigger::At(*at)),
        scene::Trigger::When { when } => when,
    };
    let holds = match when.holds {
        scene::Holds::Reaches { reaches: place, within } => Holds::Reaches { place, within },
        scene::Holds::ClearanceBelow { clearance_below } => Holds::ClearanceBelow(clearance_below),
        scene::Holds::LostFor { lost_for } => Holds::LostFor(lost_for),
        scene::Holds::BlockedFor { blocked_for } => Holds::BlockedFor(blocked_for),
    };
    Some(Trigger::When { robot: scene.index_of(&when.robot)?, holds })
}

fn action(scene: &Scene, happening: &Happening) -> Result<Option<EventAction>, BuildError> {
    let index = |name: &str| scene.index_of(name);
    Ok(match happening {
        Happening::Follow { robot, leader, place, .. } => {
            let place = place.as_ref().map(|place| SetPointTrajectory {
                distance: place.distance.clone(),
                bearing: place.bearing.clone(),
            });
            let ends = index(robot).zip(index(leader));
            ends.map(|(robot, leader)| EventAction::Follow { robot, leader, place })
        }
        Happening::Lead { robot, path } => {
            let wrong = |source| BuildError::SplinePath { robot: robot.clone(), source };
            let (motion, _) = course(path).map_err(wrong)?;
            index(robot).map(|robot| EventAction::Lead { robot, motion: motion.trajectory() })
        }
        Happening::Fail { robot, fails, recovery } => {
            let kind = match fails {
                Failure::Stop => EventKind::Stop,
                Failure::Coast => EventKind::Coast,
                Failure::Remove => EventKind::Remove,
            };
            let recovery = match recovery {
                scene::Recovery::Graft => Recovery::Graft,
                scene::Recovery::Promote => Recovery::Promote,
                scene::Recovery::Assign => Recovery::Assign,
                scene::Recovery::Wait => Recovery::Wait,
            };
            index(robot).map(|robot| EventAction::Fail { robot, kind, recovery })
        }
        Happening::Assign { assign } => index(assign).map(|head| EventAction::Assign { head }),
    })
}
