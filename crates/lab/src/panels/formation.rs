//! The tree of leaders and followers. Dragging a robot onto another makes that its leader.

use super::{colour, menu_item, naming, nothing, on_click};
use crate::action::Action;
use crate::app_state::{AppState, Selection, Tool};
use eframe::egui::{self, RichText, Role, Sense, Ui, WidgetInfo};
use vocabulary::math;
use vocabulary::{FleetInfo, StepRecord};

/// The tree of robots.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some(fleet) = app_state.fleet() else {
        return nothing(ui, "No scene is open.");
    };
    ui.horizontal_wrapped(|ui| {
        let add = ui.button("+ Robot").on_hover_text("A robot that follows the selected one (Insert)");
        on_click(&add, Action::AddRobot, out);
        let connects = app_state.tool == Tool::Connect;
        let tip = "Drag in the view from a robot to its new leader (C)";
        let label = ui.selectable_label(connects, "Connect").on_hover_text(tip);
        on_click(&label, Action::UseTool(Tool::Connect), out);
    });
    let record = app_state.shown();
    let rows = order(fleet);
    egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        for (robot, depth) in rows {
            row(ui, app_state, fleet, record.as_deref(), robot, depth, out);
        }
    });
}

/// Robots, each after the one it follows, with its depth.
fn order(fleet: &FleetInfo) -> Vec<(usize, usize)> {
    let mut rows = Vec::with_capacity(fleet.robots.len());
    let mut open: Vec<(usize, usize)> =
        (0..fleet.robots.len()).rev().filter(|k| fleet.robots[*k].leads).map(|k| (k, 0)).collect();
    while let Some((robot, depth)) = open.pop() {
        rows.push((robot, depth));
        let followers = fleet.edges.iter().rev().filter(|edge| edge.leader == robot);
        open.extend(followers.map(|edge| (edge.follower, depth + 1)));
    }
    rows
}

fn row(
    ui: &mut Ui,
    app_state: &AppState,
    fleet: &FleetInfo,
    record: Option<&StepRecord>,
    robot: usize,
    depth: usize,
    out: &mut Vec<Action>,
) {
    let name = &fleet.robots[robot].name;
    let chosen = app_state.chosen_robot() == Some(robot);
    let response = ui
        .horizontal(|ui| {
            ui.add_space(14.0 * depth.min(8) as f32);
            let (rect, _) = ui.allocate_exact_size(egui::vec2(10.0, 10.0), Sense::hover());
            ui.painter().circle_filled(rect.center(), 5.0, colour(app_state, robot, ui));
            let text =
                if chosen { RichText::new(name).color(egui::Color32::WHITE) } else { RichText::new(name) };
            let label = ui.add(egui::Button::selectable(chosen, text).sense(Sense::click_and_drag()));
            if let Some(error) =
                app_state.edge_of(robot).and_then(|edge| Some(record?.edges.get(edge)?.error))
            {
                let size = math::hypot(error[0], error[1]);
                let text = format!("{} m", crate::numbers::fixed(error[0], 2));
                let weak = RichText::new(text).small();
                let text = if size > 0.05 { weak.color(ui.visuals().warn_fg_color) } else { weak.weak() };
                ui.label(text).on_hover_text("Distance error");
            }
            label
        })
        .inner;
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, name));
    response.dnd_set_drag_payload(robot);
    if let Some(follower) = response.dnd_release_payload::<usize>()
        && *follower != robot
    {
        out.push(Action::Connect { leader: robot, follower: *follower });
    }
    if response.dnd_hover_payload::<usize>().is_some_and(|follower| *follower != robot) {
        let stroke = ui.visuals().selection.stroke;
        ui.painter().rect_stroke(response.rect, 3.0, stroke, egui::StrokeKind::Inside);
    }
    on_click(&response, Action::Select(Selection::Robot(robot)), out);
    if response.double_clicked() {
        out.push(Action::Follow(Some(robot)));
    }
    if let Some(new) = naming(&response, name, |ui| menu(ui, name, robot, out)) {
        out.push(Action::RenameRobot(name.clone(), new));
    }
}

fn menu(ui: &mut Ui, name: &str, robot: usize, out: &mut Vec<Action>) {
    menu_item(ui, true, "Follow with the camera", Action::Follow(Some(robot)), out);
    menu_item(ui, true, "See through its camera", Action::Viewpoint(format!("camera:{name}")), out);
    menu_item(ui, true, "Remove", Action::RemoveRobot(name.to_owned()), out);
}
