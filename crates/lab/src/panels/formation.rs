//! The tree of leaders and followers. Dragging a robot onto another makes that its leader.

use super::{colour, menu_item, naming, nothing, on_click};
use crate::action::{Action, Happens};
use crate::app_state::{AppState, Selection, Tool};
use eframe::egui::{self, RichText, Role, Sense, Ui, WidgetInfo};
use scene::Failure;
use vocabulary::math;
use vocabulary::{Condition, Edge, FleetInfo, StepRecord, Word};

/// The tree of robots.
pub fn show(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let Some(fleet) = app_state.fleet() else {
        return nothing(ui, "No scene is open.");
    };
    ui.horizontal_wrapped(|ui| {
        let add = ui.button("+ Robot").on_hover_text("A robot that follows the selected one (Insert)");
        on_click(&add, Action::AddRobot, out);
        let connects = app_state.tool == Tool::Connect;
        let tip = "Drag in the view from a robot to its new leader (C); with Shift it keeps those it has";
        let label = ui.selectable_label(connects, "Connect").on_hover_text(tip);
        on_click(&label, Action::UseTool(Tool::Connect), out);
    });
    let record = app_state.shown();
    let rows = order(fleet, record.as_deref());
    egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        for (robot, depth) in rows {
            row(ui, app_state, fleet, record.as_deref(), robot, depth, out);
        }
    });
}

/// Robots as they follow one another at the shown time, each after the one it follows, with its depth.
fn order(fleet: &FleetInfo, record: Option<&StepRecord>) -> Vec<(usize, usize)> {
    let mut edges: Vec<Edge> = match record {
        Some(record) => record.pairs(fleet).map(|(_, edge, _)| edge).collect(),
        None => fleet.edges.clone(),
    };
    // Those of one follower stand together; it is listed behind its first leader.
    edges.dedup_by_key(|edge| edge.follower);
    let mut rows = Vec::with_capacity(fleet.robots.len());
    let leads = |robot: &usize| edges.iter().all(|edge| edge.follower != *robot);
    let mut open: Vec<(usize, usize)> = (0..fleet.robots.len()).rev().filter(leads).map(|k| (k, 0)).collect();
    while let Some((robot, depth)) = open.pop() {
        rows.push((robot, depth));
        let followers = edges.iter().rev().filter(|edge| edge.leader == robot);
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
            let condition = record.and_then(|record| Some(record.snapshot.robots.get(robot)?.condition));
            if let Some(condition @ (Condition::Failed | Condition::Removed)) = condition {
                ui.label(RichText::new(condition.word()).small().color(ui.visuals().warn_fg_color));
            } else if let Some(error) = fleet
                .edges_of(robot)
                .filter_map(|edge| {
                    record?.edge(fleet, edge)?;
                    Some(record?.edges.get(edge)?.error)
                })
                .max_by(|a, b| math::hypot(a[0], a[1]).total_cmp(&math::hypot(b[0], b[1])))
            {
                let size = math::hypot(error[0], error[1]);
                let text = format!("{} m", crate::numbers::fixed(error[0], 2));
                let weak = RichText::new(text).small();
                let text = if size > 0.05 { weak.color(ui.visuals().warn_fg_color) } else { weak.weak() };
                ui.label(text).on_hover_text("Distance error");
            }
            let also: Vec<&str> = fleet
                .edges_of(robot)
                .filter_map(|edge| {
                    Some(
                        fleet.pair(
                            record.map_or_else(|| fleet.edges.get(edge).copied(), |r| r.edge(fleet, edge))?,
                        )[0],
                    )
                })
                .skip(1)
                .collect();
            if !also.is_empty() {
                ui.label(RichText::new(format!("+ {}", also.join(", "))).small().weak())
                    .on_hover_text("Its other leaders");
            }
            label
        })
        .inner;
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, name));
    response.dnd_set_drag_payload(robot);
    if let Some(follower) = response.dnd_release_payload::<usize>()
        && *follower != robot
    {
        let adds = ui.input(|input| input.modifiers.shift);
        out.push(Action::Connect { leader: robot, follower: *follower, adds });
    }
    if response.dnd_hover_payload::<usize>().is_some_and(|follower| *follower != robot) {
        let stroke = ui.visuals().selection.stroke;
        ui.painter().rect_stroke(response.rect, 3.0, stroke, egui::StrokeKind::Inside);
    }
    on_click(&response, Action::Select(Selection::Robot(robot)), out);
    if response.double_clicked() {
        out.push(Action::Follow(Some(robot)));
    }
    if let Some(new) = naming(&response, name, |ui| menu(ui, fleet, robot, out)) {
        out.push(Action::RenameRobot(name.clone(), new));
    }
}

fn menu(ui: &mut Ui, fleet: &FleetInfo, robot: usize, out: &mut Vec<Action>) {
    let name = &fleet.robots[robot].name;
    menu_item(ui, true, "Follow with the camera", Action::Follow(Some(robot)), out);
    menu_item(ui, true, "See through its camera", Action::Viewpoint(format!("camera:{name}")), out);
    menu_item(ui, true, "Remove", Action::RemoveRobot(name.to_owned()), out);
    ui.separator();
    ui.weak("From now on, in this run:");
    let happens = |what: Happens| Action::Happen { robot, what };
    ui.menu_button("it follows", |ui| {
        egui::ScrollArea::vertical().max_height(240.0).show(ui, |ui| {
            for (leader, info) in fleet.robots.iter().enumerate().filter(|(leader, _)| *leader != robot) {
                menu_item(ui, true, &info.name, happens(Happens::Follows(leader)), out);
            }
        });
    });
    for (text, what) in [
        ("it drives on its own", Happens::Leads),
        ("it fails and stops", Happens::Fails(Failure::Stop)),
        ("it fails and rolls to a stand", Happens::Fails(Failure::Coast)),
        ("it is taken away", Happens::Fails(Failure::Remove)),
        ("those behind it take their places anew", Happens::Assigns),
    ] {
        menu_item(ui, true, text, happens(what), out);
    }
}
