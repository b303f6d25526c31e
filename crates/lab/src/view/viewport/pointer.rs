//! The pointer in the view: hovering, dragging and clicking.

use super::Viewport;
use crate::action::Action;
use crate::app_state::{AppState, Selection, Tool};
use crate::numbers::snap;
use crate::view::annotations::goals;
use crate::view::camera::CameraControl;
use eframe::egui::{self, Pos2, Rect, Ui, Vec2};
use rendering::{Picked, Sightline, set_points};
use vocabulary::math;
use vocabulary::{StepRecord, wrap};

/// Steps of a dragged set point: m and degrees.
const STEPS: [f64; 2] = [0.1, 5.0];
/// Distance from a ring's centre within which the pointer grasps it, points.
const GRASP: f32 = 16.0;
/// What a drag moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Drag {
    Orbit,
    Pan,
    SetPoint(usize),
    /// By lead robot and number.
    Goal(usize, usize),
    Connect(usize),
}

/// The context of the pointer in a frame.
struct PointerFrame<'a> {
    ui: &'a Ui,
    response: &'a egui::Response,
    app_state: &'a AppState,
    record: &'a StepRecord,
    sight: Sightline,
}

impl Viewport {
    /// Handles the pointer in the view.
    pub(super) fn handle_pointer(
        &mut self,
        ui: &Ui,
        response: &egui::Response,
        app_state: &AppState,
        record: &StepRecord,
        rect: Rect,
        out: &mut Vec<Action>,
    ) {
        // Those of the picture, which may have fewer than the screen.
        let pixels = self.pixels_per_point(rect);
        let pixel = |pos: Pos2| [pos.x - rect.left(), pos.y - rect.top()].map(|x| f64::from(x * pixels));
        let Some(sight) = self.view_renderer.as_ref().and_then(|view_renderer| view_renderer.sight.clone())
        else {
            return;
        };
        let frame = PointerFrame { ui, response, app_state, record, sight };
        let sight = &frame.sight;
        let pointer = response.hover_pos().or_else(|| response.interact_pointer_pos());
        self.hover(&frame, pointer.map(pixel));
        if response.drag_started() {
            // The place of the press counts, wherever the pointer is now.
            let origin = ui.input(|input| input.pointer.press_origin());
            self.hover(&frame, origin.or(pointer).map(pixel));
            self.begin_drag(ui, app_state);
        }
        // Two fingers zoom about the place between them; the first alone would turn the view.
        let fingers = ui.input(egui::InputState::multi_touch).map(|touch| touch.center_pos);
        let share = |delta: Vec2| [delta.x, delta.y].map(|x| f64::from(x / rect.height().max(1.0)));
        if let (Some(drag), Some(pos)) = (self.drag, released_at(ui).or(response.interact_pointer_pos())) {
            let delta = response.drag_delta();
            match drag {
                Drag::Orbit | Drag::Pan if delta == Vec2::ZERO || fingers.is_some() => {}
                Drag::Orbit => {
                    self.take_camera(record, None);
                    if let Some(held) = &mut self.camera_control {
                        held.orbit(share(delta));
                    }
                }
                Drag::Pan => {
                    let (from, to) = (sight.ground(pixel(pos - delta)), sight.ground(pixel(pos)));
                    self.take_camera(record, None);
                    if let (Some(held), Some(from), Some(to)) = (&mut self.camera_control, from, to) {
                        held.pan(from, to);
                    }
                }
                Drag::SetPoint(edge) => {
                    if let Some(place) = sight.ground(pixel(pos)) {
                        out.extend(dragged(&frame, edge, place));
                    }
                }
                Drag::Goal(robot, number) => {
                    if let Some(place) = sight.ground(pixel(pos)) {
                        out.extend(moved(&frame, robot, number, place));
                    }
                }
                Drag::Connect(robot) => {
                    self.pointer.connecting = sight.ground(pixel(pos)).map(|place| (robot, place));
                }
            }
        }
        if response.drag_stopped() {
            self.end_drag(ui, out);
        }
        self.wheel(&frame, fingers.or(pointer).map(pixel));
        self.clicks(&frame, pointer.map(pixel), out);
    }

    /// Pixels of the picture per point of its place in the window.
    fn pixels_per_point(&self, rect: Rect) -> f32 {
        self.view_renderer
            .as_ref()
            .map_or(1.0, |drawn| drawn.renderer.size()[1] as f32 / rect.height().max(1.0))
    }

    /// Finds what is under the pointer.
    fn hover(&mut self, frame: &PointerFrame<'_>, pixel: Option<[f64; 2]>) {
        let PointerFrame { app_state, record, sight, .. } = frame;
        let grasp = f64::from(self.pixels_per_point(frame.response.rect) * GRASP);
        self.pointer.ring = None;
        self.pointer.robot = None;
        let (Some(pixel), Some(view_renderer)) = (pixel, &self.view_renderer) else { return };
        let near =
            set_points(&view_renderer.fleet, record).into_iter().enumerate().filter_map(|(edge, at)| {
                let [x, y] = sight.pixel_of_ground(at?)?;
                let away = math::hypot(x - pixel[0], y - pixel[1]);
                let radius =
                    crate::view::annotations::RING / sight.metres_per_pixel([at?[0], at?[1], 0.0]).max(1e-9);
                (away < grasp.max(0.8 * radius)).then_some((away, edge))
            });
        // The selected set point comes before others at the same place.
        let first = |(away, edge): &(f64, usize)| {
            if app_state.chosen_edge() == Some(*edge) { 0.5 * away } else { *away }
        };
        if app_state.tool == Tool::Select {
            self.pointer.ring = near.min_by(|a, b| first(a).total_cmp(&first(b))).map(|(_, edge)| edge);
        }
        self.pointer.goal = None;
        if app_state.tool == Tool::Select && self.pointer.ring.is_none() {
            let near = goals(app_state).into_iter().filter_map(|(robot, number, at)| {
                let [x, y] = sight.pixel_of_ground(at)?;
                let away = math::hypot(x - pixel[0], y - pixel[1]);
                let radius =
                    crate::view::annotations::GOAL / sight.metres_per_pixel([at[0], at[1], 0.0]).max(1e-9);
                (away < grasp.max(0.8 * radius)).then_some((away, (robot, number)))
            });
            self.pointer.goal = near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, goal)| goal);
        }
        let robot =
            view_renderer.renderer.pick(sight, record, pixel).into_iter().find_map(|picked| match picked {
                Picked::Robot(robot) => Some(robot),
                _ => None,
            });
        self.pointer.robot = robot;
    }

    fn begin_drag(&mut self, ui: &Ui, app_state: &AppState) {
        let (right, shift) = ui.input(|input| {
            let pointer = &input.pointer;
            (pointer.secondary_down() || pointer.middle_down(), input.modifiers.shift)
        });
        let goal = self.pointer.goal;
        self.drag = Some(match (right, app_state.tool, self.pointer.robot, self.pointer.ring) {
            (true, ..) => Drag::Pan,
            (_, Tool::Connect, Some(robot), _) => Drag::Connect(robot),
            (_, Tool::Select, _, Some(edge)) => Drag::SetPoint(edge),
            _ => match goal {
                Some((robot, number)) if app_state.tool == Tool::Select => Drag::Goal(robot, number),
                _ if shift => Drag::Pan,
                _ => Drag::Orbit,
            },
        });
        if let Some(Drag::SetPoint(edge)) = self.drag {
            self.pointer.dragged = Some(edge);
        }
        if let Some(Drag::Goal(robot, number)) = self.drag {
            self.pointer.dragged_goal = Some((robot, number));
        }
    }

    fn end_drag(&mut self, ui: &Ui, out: &mut Vec<Action>) {
        match self.drag.take() {
            Some(Drag::SetPoint(edge)) => {
                out.push(Action::Release);
                out.push(Action::Select(Selection::Edge(edge)));
            }
            Some(Drag::Goal(..)) => out.push(Action::Release),
            Some(Drag::Connect(follower)) => {
                if let Some(leader) = self.pointer.robot.filter(|leader| *leader != follower) {
                    let adds = ui.input(|input| input.modifiers.shift);
                    out.push(Action::Connect { leader, follower, adds });
                }
            }
            _ => {}
        }
        self.pointer.dragged = None;
        self.pointer.dragged_goal = None;
        self.pointer.connecting = None;
    }

    fn wheel(&mut self, frame: &PointerFrame<'_>, pixel: Option<[f64; 2]>) {
        if !frame.response.hovered() {
            return;
        }
        let (scroll, pinch) = frame.ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        let factor = f64::from((-scroll * 0.004).exp() / pinch.max(1e-3));
        if (factor - 1.0).abs() > 1e-4 {
            let about = pixel.and_then(|pixel| frame.sight.ground(pixel));
            self.take_camera(frame.record, None);
            if let Some(held) = &mut self.camera_control {
                held.zoom(factor, about, &frame.record.snapshot);
            }
        }
    }

    fn clicks(&self, frame: &PointerFrame<'_>, pixel: Option<[f64; 2]>, out: &mut Vec<Action>) {
        let Some(pixel) = pixel else { return };
        if frame.response.double_clicked() {
            if let Some(robot) = self.pointer.robot {
                out.push(Action::Follow(Some(robot)));
            }
        } else if frame.response.clicked() {
            match (frame.app_state.tool, frame.sight.ground(pixel)) {
                (Tool::Pillar, Some(place)) => out.push(Action::AddProp("pillar", place)),
                _ => out.extend(self.chosen(frame, pixel)),
            }
        }
    }

    fn chosen(&self, frame: &PointerFrame<'_>, pixel: [f64; 2]) -> Option<Action> {
        if let Some(edge) = self.pointer.ring {
            return Some(Action::Select(Selection::Edge(edge)));
        }
        let view_renderer = self.view_renderer.as_ref()?;
        let record = frame.app_state.record()?;
        let picked = view_renderer.renderer.pick(&frame.sight, &record, pixel).into_iter().next()?;
        Some(Action::Select(match picked {
            Picked::Robot(robot) => Selection::Robot(robot),
            Picked::Edge(edge) | Picked::SetPoint(edge) => Selection::Edge(edge),
        }))
    }

    /// Switches from the named view to the free camera.
    pub(super) fn take_camera(&mut self, record: &StepRecord, robot: Option<usize>) {
        if self.camera_control.is_some() {
            return;
        }
        let Some(view_renderer) = &self.view_renderer else { return };
        let lead = view_renderer.fleet.robots.iter().position(|member| member.leads);
        if let Some(sight) = &view_renderer.sight {
            self.camera_control = Some(CameraControl::take(sight.free(), robot.or(lead), &record.snapshot));
        }
    }
}

/// Where a button was released in this frame: the pointer may have moved since.
fn released_at(ui: &Ui) -> Option<Pos2> {
    ui.input(|input| {
        input.events.iter().rev().find_map(|event| match event {
            egui::Event::PointerButton { pos, pressed: false, .. } => Some(*pos),
            _ => None,
        })
    })
}

/// The action of a goal that is dragged to a place.
fn moved(frame: &PointerFrame<'_>, robot: usize, number: usize, place: [f64; 2]) -> Option<Action> {
    let free = frame.ui.input(|input| input.modifiers.shift);
    let place = if free { place } else { place.map(|x| snap(x, STEPS[0])) };
    let all = goals(frame.app_state);
    let (.., now) = all.into_iter().find(|(own, own_number, _)| (*own, *own_number) == (robot, number))?;
    let away = math::hypot(place[0] - now[0], place[1] - now[1]);
    (away > 1e-9).then_some(Action::Goal { robot, number, place })
}

/// The action of a set point that is dragged to a place.
fn dragged(frame: &PointerFrame<'_>, edge: usize, place: [f64; 2]) -> Option<Action> {
    let PointerFrame { ui, app_state, record, .. } = frame;
    let [distance, bearing] = app_state.set_point_at(record, edge, place)?;
    let least = app_state.follower(edge).map_or(0.1, |(_, _, follow)| follow.law.distance_min);
    let (free, whole) = ui.input(|input| (input.modifiers.shift, input.modifiers.command));
    let [distance, bearing] = if free {
        [distance, bearing]
    } else {
        [snap(distance, STEPS[0]), wrap(snap(bearing.to_degrees(), STEPS[1]).to_radians())]
    };
    let distance = distance.max(least.max(0.1));
    let [now_distance, now_bearing] = app_state.set_point(edge)?;
    // What is left free stays as it is.
    let free = app_state.fleet().map_or([false; 2], |fleet| fleet.free(edge));
    let distance = if free[0] { now_distance } else { distance };
    let bearing = if free[1] { now_bearing } else { bearing };
    if (distance - now_distance).abs() < 1e-9 && wrap(bearing - now_bearing).abs() < 1e-9 {
        return None;
    }
    Some(if whole {
        Action::Shape { scale: distance / now_distance.max(1e-6), turn: wrap(bearing - now_bearing) }
    } else {
        Action::SetPoint { edge, distance, bearing }
    })
}
