//! Panels without a window: what they show, by what names it is found, and what hands on them ask for.

mod gains;
mod laws;
mod places;
mod safety;
mod seeing;
mod sweep;
mod time;

use eframe::egui::{self, Event, Ui, accesskit::Role};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use lab::action::Action;
use lab::app_state::AppState;

/// A panel, its state, and what was asked for.
pub(crate) struct Bench {
    pub(crate) app_state: AppState,
    pub(crate) out: Vec<Action>,
}

/// What draws a panel.
type Show = dyn Fn(&mut Ui, &AppState, &mut Vec<Action>);

pub(crate) type Panel = Harness<'static, Bench>;

/// A panel as the window shows it. Every frame is looked through for letters without a face and widgets without a name.
pub(crate) fn panel(
    app_state: AppState,
    show: impl Fn(&mut Ui, &AppState, &mut Vec<Action>) + 'static,
) -> Panel {
    let bench = Bench { app_state, out: Vec::new() };
    let mut panel = Harness::builder()
        .with_size([520.0, 900.0])
        .with_context_setup(lab::theme::apply)
        .build_ui_state(move |ui, bench: &mut Bench| show(ui, &bench.app_state, &mut bench.out), bench);
    panel.run();
    panel
}

/// All that is written.
pub(crate) fn texts(panel: &Panel) -> Vec<String> {
    let root = panel.root();
    let nodes = root.children_recursive().filter(|node| node.accesskit_node().role() != Role::TextRun);
    let text = |node: egui_kittest::Node<'_>| {
        let node = node.accesskit_node();
        node.label().filter(|label| !label.is_empty()).or_else(|| node.value())
    };
    nodes.filter_map(text).collect()
}

/// Whether something is written somewhere.
pub(crate) fn says(panel: &Panel, part: &str) -> bool {
    texts(panel).iter().any(|text| text.contains(part))
}

#[track_caller]
pub(crate) fn assert_says(panel: &Panel, parts: &[&str]) {
    for part in parts {
        assert!(says(panel, part), "`{part}` is not in {:#?}", texts(panel));
    }
}

/// What is asked for once something has been done.
pub(crate) fn asked(panel: &mut Panel) -> Vec<Action> {
    panel.run();
    std::mem::take(&mut panel.state_mut().out)
}

/// What a click on a widget asks for.
#[track_caller]
pub(crate) fn click(panel: &mut Panel, role: Role, name: &str) -> Vec<Action> {
    panel.run();
    panel.get_by_role_and_label(role, name).click();
    asked(panel)
}

/// The value of a widget that has one.
#[track_caller]
pub(crate) fn value(panel: &Panel, role: Role, name: &str) -> f64 {
    let node = panel.get_by_role_and_label(role, name);
    node.accesskit_node().numeric_value().unwrap_or_else(|| panic!("`{name}` has no value"))
}

/// What a drag from one share of a widget's width to another asks for.
#[track_caller]
pub(crate) fn drag(panel: &mut Panel, role: Role, name: &str, [from, to]: [f32; 2]) -> Vec<Action> {
    let rect = panel.get_by_role_and_label(role, name).rect();
    let at = |share: f32| egui::pos2(egui::lerp(rect.x_range(), share), rect.center().y);
    panel.hover_at(at(from));
    panel.run();
    panel.drag_at(at(from));
    panel.run();
    panel.hover_at(at(0.5 * (from + to)));
    panel.run();
    panel.hover_at(at(to));
    panel.run();
    panel.drop_at(at(to));
    asked(panel)
}

/// What a number typed into a widget asks for.
#[track_caller]
pub(crate) fn enter(panel: &mut Panel, role: Role, name: &str, text: &str) -> Vec<Action> {
    panel.get_by_role_and_label(role, name).click();
    panel.run();
    panel.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    panel.event(Event::Text(text.to_owned()));
    panel.key_press(egui::Key::Enter);
    asked(panel)
}

/// What is written while the pointer rests on a text.
#[track_caller]
pub(crate) fn tip(panel: &mut Panel, sign: &str) -> Vec<String> {
    let before = texts(panel);
    panel.get_by_role_and_label(Role::Label, sign).hover();
    panel.run_steps(8);
    let now = texts(panel);
    panel.remove_cursor();
    panel.run_steps(2);
    now.into_iter().filter(|text| !before.contains(text)).collect()
}

/// Whatever a tip or the page of shortcuts says can be drawn.
#[test]
fn every_letter_has_a_face() {
    let all = panel(AppState::new(), |ui, _, _| {
        for symbol in lab::symbols::ALL {
            symbol.tip(ui);
        }
        for (title, shortcuts) in lab::keys::LIST {
            ui.heading(*title);
            for shortcut in *shortcuts {
                ui.monospace(shortcut.keys);
                ui.label(shortcut.what);
            }
        }
        for quantity in lab::quantities::PlotQuantity::all() {
            ui.label(quantity.axis());
        }
    });
    assert_says(&all, &["½‖r‖²", "Space"]);
}

/// What every panel says where there is no scene.
#[test]
fn panels_without_a_scene_say_so() {
    let style = rendering::Style::default();
    let shows: [(&str, Box<Show>); 9] = [
        ("formation", Box::new(lab::panels::formation::show)),
        ("edge", Box::new(lab::panels::edge::show)),
        ("law", Box::new(lab::panels::law::show)),
        ("observer", Box::new(lab::panels::law::observer)),
        ("sensing", Box::new(lab::panels::sensing::show)),
        ("limits", Box::new(lab::panels::world::limits)),
        ("safety", Box::new(lab::panels::safety::show)),
        ("world", Box::new(lab::panels::world::surroundings)),
        (
            "curves",
            Box::new(|ui, app_state, out| {
                lab::panels::curves::show(ui, app_state, &[lab::quantities::PlotQuantity::Speed], out);
            }),
        ),
    ];
    for (name, show) in shows {
        let panel = panel(AppState::new(), show);
        assert!(says(&panel, "No scene is open."), "{name}: {:?}", texts(&panel));
        assert!(panel.state().out.is_empty(), "{name}");
    }
    // These have something to show in any case.
    let bar =
        panel(AppState::new(), |ui, app_state, out| lab::panels::time_bar::show(ui, app_state, false, out));
    assert_says(&bar, &["Play", "t = 0.00 s"]);
    let film = panel(AppState::new(), move |ui, app_state, out| {
        lab::panels::film::show(ui, app_state, &style, None, out);
    });
    assert_says(&film, &["Look ahead"]);
    assert_says(&panel(AppState::new(), lab::panels::log::show), &["appear here"]);
    assert_says(&panel(AppState::new(), lab::panels::branches::show), &["Branch here"]);
}
