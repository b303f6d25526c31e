//! Annotations on the ground: the prediction, handles, other branches and infeasible ground.

use super::feasibility::{self, SIDE, STEP};
use crate::app_state::{AppState, Selection};
use crate::session::prediction::{PathPoint, Prediction, Trouble};
use rendering::{
    AnnotationArrow, AnnotationStroke, Annotations, Ghost, Ring, ShadedArea, StrokePoint, free_places,
    set_points,
};
use std::sync::Arc;
use vocabulary::{FleetInfo, StepRecord};

/// The colour of predicted problems.
const ALARM: [f32; 3] = [0.90, 0.16, 0.10];
/// The accent colour of the window.
pub const ACCENT: [f32; 3] = [0.25, 0.62, 1.0];
/// The colour of infeasible ground.
const REFUSED: [f32; 3] = [0.72, 0.10, 0.08];
/// Radius of the ring at a set point for a robot of the default size, m.
pub const RING: f64 = 0.25;
/// Radius of the ring at a goal for a robot of the default size, m.
pub const GOAL: f64 = 0.32;

/// The state of the pointer, as far as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PointerState {
    /// The edge whose set point is under the pointer.
    pub ring: Option<usize>,
    /// The edge whose set point is dragged.
    pub dragged: Option<usize>,
    /// The goal under the pointer, by its lead robot and its number.
    pub goal: Option<(usize, usize)>,
    /// The goal that is dragged.
    pub dragged_goal: Option<(usize, usize)>,
    /// The robot under the pointer.
    pub robot: Option<usize>,
    /// A connection being drawn: from a robot to a place, m.
    pub connecting: Option<(usize, [f64; 2])>,
}

/// The annotations of the shown moment.
pub fn annotations(app_state: &AppState, record: &StepRecord, pointer: &PointerState) -> Annotations {
    let mut annotations = Annotations::default();
    let Some(history) = &app_state.history else { return annotations };
    let fleet = Arc::clone(history.fleet());
    let colours = rendering::robot_colours(&fleet);
    if let Some(held) = pointer.dragged {
        refused(app_state, held, record, &mut annotations);
    }
    others(app_state, &colours, &mut annotations);
    let present = app_state.cursor.is_none();
    if let Some(prediction) =
        app_state.prediction.as_ref().filter(|f| present && f.branch == app_state.branch)
    {
        future(prediction, &colours, &fleet, &mut annotations);
        // What the run has gone through is in its records.
        if record.snapshot.time < prediction.span[0] {
            annotations.plans.clone_from(&prediction.plans);
        }
    }
    handles(app_state, &fleet, record, &colours, pointer, &mut annotations);
    if let Some((robot, to)) = pointer.connecting
        && let Some(state) = record.snapshot.robots.get(robot)
    {
        let from = [state.motion.pose.x, state.motion.pose.y];
        annotations.arrows.push(AnnotationArrow { from, to, gaps: [0.3, 0.0], colour: ACCENT, alpha: 0.95 });
    }
    annotations
}

/// Ground that is infeasible for the follower of an edge.
fn refused(app_state: &AppState, edge: usize, record: &StepRecord, annotations: &mut Annotations) {
    let Some((leader, mut alphas)) = feasibility::field(app_state, edge, record) else { return };
    for alpha in &mut alphas {
        *alpha *= 0.34;
    }
    let half = 0.5 * (SIDE - 1) as f64 * STEP;
    let area = ShadedArea::field([-half; 2], STEP, SIDE, &alphas, REFUSED, true);
    // In the leader's frame: rows run ahead, columns to the left.
    let turned = area.corners.into_iter().map(|spot| {
        let [left, ahead] = spot.at;
        StrokePoint { at: leader.world_from_body(ahead, left), ..spot }
    });
    annotations.areas.push(ShadedArea { corners: turned.collect(), hatched: true });
}

/// Paths of the other branches.
fn others(app_state: &AppState, colours: &[[f32; 3]], annotations: &mut Annotations) {
    let Some(history) = &app_state.history else { return };
    for branch in (0..history.branches()).filter(|branch| *branch != app_state.branch) {
        let from = app_state.branches.get(branch).and_then(|face| face.parent).map_or(0.0, |(_, time)| time);
        // Old paths would cover the ground.
        let from = from.max(app_state.time() - 12.0);
        let records = history.between(branch, [from, app_state.time() + 12.0], 160);
        for (robot, colour) in colours.iter().enumerate() {
            let spots = records.iter().filter_map(|record| {
                let pose = record.snapshot.robots.get(robot)?.motion.pose;
                Some(StrokePoint { at: [pose.x, pose.y], colour: light(*colour), alpha: 0.55 })
            });
            annotations.strokes.push(AnnotationStroke {
                dashed: true,
                pixels: 1.6,
                ..AnnotationStroke::new(spots.collect())
            });
        }
        if let Some(record) = history.at(branch, app_state.time()) {
            let ghost = |(robot, state): (usize, &vocabulary::RobotState)| Ghost {
                robot,
                pose: state.motion.pose,
                alpha: 0.22,
            };
            annotations.ghosts.extend(record.snapshot.robots.iter().enumerate().map(ghost));
        }
    }
}

/// The predicted paths and final poses.
fn future(prediction: &Prediction, colours: &[[f32; 3]], fleet: &FleetInfo, annotations: &mut Annotations) {
    for (robot, path) in prediction.paths.iter().enumerate() {
        // Paler than the ribbons of the past.
        let colour = light(colours.get(robot).copied().unwrap_or([0.6; 3])).map(|c| 0.4 + 0.6 * c);
        let last = path.len().saturating_sub(1).max(1) as f32;
        let spot = |(k, place): (usize, &PathPoint)| {
            let share = k as f32 / last;
            let fade = 0.95 * (1.0 - 0.75 * share * share);
            match place.trouble {
                Trouble::None => StrokePoint { at: place.at, colour, alpha: fade },
                Trouble::Limited | Trouble::Contact => {
                    StrokePoint { at: place.at, colour: ALARM, alpha: fade.max(0.8) }
                }
            }
        };
        let spots = path.iter().enumerate().map(spot).collect();
        let pixels = if path.iter().any(|p| p.trouble == Trouble::Contact) { 3.0 } else { 2.2 };
        annotations.strokes.push(AnnotationStroke { pixels, ..AnnotationStroke::new(spots) });
    }
    // The final poses; in a large formation the paths suffice.
    if fleet.robots.len() <= 30 {
        let ghost = |(robot, pose): (usize, &vocabulary::Pose)| Ghost { robot, pose: *pose, alpha: 0.30 };
        annotations.ghosts.extend(prediction.end.iter().enumerate().map(ghost));
    }
}

/// Rings as handles of set points, and a ring under the selected robot.
fn handles(
    app_state: &AppState,
    fleet: &FleetInfo,
    record: &StepRecord,
    colours: &[[f32; 3]],
    pointer: &PointerState,
    annotations: &mut Annotations,
) {
    let beside = app_state.chosen_edge().map(|edge| app_state.beside(edge)).unwrap_or_default();
    for (edge, at) in set_points(fleet, record).into_iter().enumerate() {
        let Some(at) = at else { continue };
        let follower = fleet.edges[edge].follower;
        let ring =
            Ring { least: 17.0, ..Ring::new(at, RING * size(fleet, follower), light(colours[follower])) };
        // With several leaders those beside the chosen edge have theirs, too.
        if pointer.dragged == Some(edge) || app_state.chosen_edge() == Some(edge) {
            annotations.rings.push(ring.selected());
            annotations.strokes.extend(reach(fleet, record, edge, 0.95));
        } else if pointer.ring == Some(edge) || beside.contains(&edge) {
            annotations.rings.push(ring.hovered());
            annotations.strokes.extend(reach(fleet, record, edge, 0.55));
        }
    }
    for (robot, number, at) in goals(app_state) {
        let colour = colours.get(robot).map_or(ACCENT, |colour| light(*colour));
        let ring = Ring { least: 17.0, ..Ring::new(at, GOAL * size(fleet, robot), colour) };
        let own = Some((robot, number));
        annotations.rings.push(if pointer.dragged_goal == own {
            ring.selected()
        } else if pointer.goal == own {
            ring.hovered()
        } else {
            ring
        });
    }
    let under = |robot: usize| {
        let pose = record.snapshot.robots.get(robot)?.motion.pose;
        let body = fleet.robots.get(robot)?.body;
        let at = pose.world_from_body(0.5 * body.wheelbase, 0.0);
        Some(Ring { pixels: 2.0, ..Ring::new(at, 0.62 * body.length, ACCENT) })
    };
    if let Selection::Robot(robot) = app_state.selection {
        annotations.rings.extend(under(robot));
    }
    if let Some(robot) = pointer.robot {
        annotations.rings.extend(under(robot).map(|ring| Ring { alpha: 0.5, ..ring }));
    }
}

/// Goals of lead robots: robot, number and place, m.
pub fn goals(app_state: &AppState) -> Vec<(usize, usize, [f64; 2])> {
    let Some(scene) = app_state.scene() else { return vec![] };
    let mut found = vec![];
    for (robot, member) in scene.robots.iter().enumerate() {
        let scene::Role::Lead { path } = &member.role else { continue };
        let goals = match path {
            scene::Path::Goal { pose, .. } => std::slice::from_ref(pose),
            scene::Path::Tour { goals, .. } => goals,
            _ => continue,
        };
        found.extend(goals.iter().enumerate().map(|(number, goal)| (robot, number, goal.position)));
    }
    found
}

/// All places that a set point of which a part is left free allows.
fn reach(fleet: &FleetInfo, record: &StepRecord, edge: usize, alpha: f32) -> Option<AnnotationStroke> {
    let colour = light(*rendering::robot_colours(fleet).get(fleet.edges.get(edge)?.follower)?);
    let places = free_places(fleet, record, edge)?;
    let spots = places.into_iter().map(|at| StrokePoint { at, colour, alpha }).collect();
    Some(AnnotationStroke { dashed: true, pixels: 2.0, ..AnnotationStroke::new(spots) })
}

/// Size of a robot relative to the default one.
fn size(fleet: &FleetInfo, robot: usize) -> f64 {
    fleet.robots.get(robot).map_or(1.0, |member| member.body.length / 0.42)
}

/// A colour that stands out from asphalt.
fn light(colour: [f32; 3]) -> [f32; 3] {
    if colour.iter().sum::<f32>() < 0.6 { [0.90, 0.88, 0.84] } else { colour.map(|c| 0.2 + 0.8 * c) }
}
