//! The layout of panels: a tree of tiles that the user rearranges and the lab remembers.

use crate::action::Action;
use crate::app_state::AppState;
use crate::panels::{
    branches, certificates, curves, custom_law, edge, film, formation, law, log, safety, sensing, sweep,
    world,
};
use crate::quantities::PlotQuantity;
use eframe::egui::{ComboBox, Frame, Id, Panel, ScrollArea, Ui, WidgetText};
use egui_tiles::{Behavior, Linear, LinearDir, SimplificationOptions, Tile, TileId, Tiles, Tree, UiResponse};
use rendering::Style;
use serde::{Deserialize, Serialize};

/// One panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pane(usize);

/// Draws a panel.
type Draw = fn(&mut Ui, &mut Panels<'_>);

/// The panels by name; the first is the 3D view.
pub const PANES: &[(&str, Draw)] = &[
    ("View", |ui, on| (on.view)(ui, on.out)),
    ("Formation", |ui, on| formation::show(ui, on.app_state, on.out)),
    ("Edge", |ui, on| edge::show(ui, on.app_state, on.out)),
    ("Law", |ui, on| law::show(ui, on.app_state, on.out)),
    ("Observer", |ui, on| law::observer(ui, on.app_state, on.out)),
    ("Sensing", |ui, on| sensing::show(ui, on.app_state, on.out)),
    ("Limits", |ui, on| world::limits(ui, on.app_state, on.out)),
    ("World", |ui, on| world::surroundings(ui, on.app_state, on.out)),
    ("Film", |ui, on| film::show(ui, on.app_state, on.style, on.filming, on.out)),
    ("Branches", |ui, on| branches::show(ui, on.app_state, on.out)),
    ("Log", |ui, on| log::show(ui, on.app_state, on.out)),
    ("Errors", |ui, on| on.curves(ui, &[PlotQuantity::DistanceError, PlotQuantity::BearingError])),
    ("Commands", |ui, on| on.curves(ui, &[PlotQuantity::Acceleration, PlotQuantity::TurnRate])),
    ("Speeds", |ui, on| on.curves(ui, &[PlotQuantity::Speed])),
    ("Observer error", |ui, on| {
        on.curves(ui, &[PlotQuantity::DistanceRateError, PlotQuantity::BearingRateError]);
    }),
    ("Energy", |ui, on| on.curves(ui, &[PlotQuantity::TrackingEnergy, PlotQuantity::ObserverEnergy])),
    ("Clearance", |ui, on| on.curves(ui, &[PlotQuantity::Clearance])),
    ("Certificates", |ui, on| certificates::show(ui, on.app_state, on.out)),
    ("Safety", |ui, on| safety::show(ui, on.app_state, on.out)),
    ("Barriers", |ui, on| safety::plots(ui, on.app_state, on.out)),
    ("Law text", |ui, on| custom_law::text(ui, on.app_state, on.out)),
    ("Signals", |ui, on| curves::signals(ui, on.app_state, on.out)),
    ("Sweep", |ui, on| sweep::show(ui, on.app_state, on.out)),
];

impl Pane {
    /// The panel of this name.
    pub fn named(name: &str) -> Option<Self> {
        PANES.iter().position(|(known, _)| *known == name).map(Self)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        PANES.get(self.0).map_or("", |(name, _)| name)
    }
}

/// The initial layout.
pub fn arrangement() -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let mut tabs = |names: &[&str]| {
        let panes: Vec<_> =
            names.iter().filter_map(|n| Pane::named(n)).map(|pane| tiles.insert_pane(pane)).collect();
        tiles.insert_tab_tile(panes)
    };
    let view = tabs(&["View"]);
    let (formation, edge) = (tabs(&["Formation"]), tabs(&["Edge", "Branches"]));
    let (law, more) = (
        tabs(&["Law", "Observer", "Limits", "Safety"]),
        tabs(&["Sensing", "World", "Sweep", "Film", "Log", "Law text"]),
    );
    let plots = [
        tabs(&["Errors"]),
        tabs(&["Commands", "Speeds", "Barriers", "Signals"]),
        tabs(&["Observer error"]),
        tabs(&["Energy", "Certificates", "Clearance"]),
    ];
    let left = tiles.insert_container(Linear::new_binary(LinearDir::Vertical, [formation, edge], 0.46));
    let right = tiles.insert_container(Linear::new_binary(LinearDir::Vertical, [law, more], 0.48));
    let mut middle = Linear::new(LinearDir::Horizontal, vec![left, view, right]);
    middle.shares.set_share(left, 0.19);
    middle.shares.set_share(view, 0.56);
    middle.shares.set_share(right, 0.25);
    let middle = tiles.insert_container(middle);
    let plots = tiles.insert_horizontal_tile(plots.to_vec());
    let root = tiles.insert_container(Linear::new_binary(LinearDir::Vertical, [middle, plots], 0.74));
    Tree::new(Id::unique("panels"), root, tiles)
}

/// Whether a remembered layout is valid: it contains the view, and no panel twice.
pub fn sound(tree: &Tree<Pane>) -> bool {
    let count = |pane: Pane| {
        tree.tiles.iter().filter(|(_, tile)| matches!(tile, Tile::Pane(p) if *p == pane)).count()
    };
    tree.root().is_some()
        && (0..PANES.len()).all(|k| count(Pane(k)) <= 1)
        && count(Pane(0)) == 1
        && tree.tiles.iter().all(|(_, tile)| !matches!(tile, Tile::Pane(pane) if pane.0 >= PANES.len()))
}

/// Toggles a panel.
pub fn toggle(tree: &mut Tree<Pane>, name: &str) {
    let Some(pane) = Pane::named(name) else { return };
    match tree.tiles.find_pane(&pane) {
        Some(id) if pane.0 != 0 && tree.is_visible(id) => {
            tree.remove_recursively(id);
        }
        _ => bring(tree, name),
    }
}

/// Brings a panel to the front.
pub fn bring(tree: &mut Tree<Pane>, name: &str) {
    let Some(pane) = Pane::named(name) else { return };
    if let Some(id) = tree.tiles.find_pane(&pane) {
        tree.set_visible(id, true);
    } else {
        let id = tree.tiles.insert_pane(pane);
        let tabs = tree.tiles.insert_tab_tile(vec![id]);
        if let Some(root) = tree.root() {
            tree.move_tile_to_container(tabs, root, usize::MAX, false);
        }
    }
    tree.make_active(|_, tile| matches!(tile, Tile::Pane(p) if *p == pane));
}

/// What draws the panels.
pub struct Panels<'a> {
    /// The state that they show.
    pub app_state: &'a AppState,
    /// Elements of the view.
    pub style: &'a Style,
    /// Progress of a film.
    pub filming: Option<&'a str>,
    /// Draws the 3D view.
    pub view: &'a mut dyn FnMut(&mut Ui, &mut Vec<Action>),
    /// The tile that shows the view.
    pub view_tile: Option<TileId>,
    /// Actions of the user.
    pub out: &'a mut Vec<Action>,
}

impl Behavior<Pane> for Panels<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, pane: &mut Pane) -> UiResponse {
        let Some((name, draw)) = PANES.get(pane.0) else { return UiResponse::None };
        if pane.0 == 0 {
            draw(ui, self);
            return UiResponse::None;
        }
        Frame::new().inner_margin(6.0).show(ui, |ui| {
            // Content that is wider than the panel can be scrolled to.
            let scroll = ScrollArea::horizontal().id_salt(name).auto_shrink([false, false]);
            scroll.show(ui, |ui| draw(ui, self));
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        pane.name().into()
    }

    fn is_tab_closable(&self, tiles: &Tiles<Pane>, id: TileId) -> bool {
        !matches!(tiles.get(id), Some(Tile::Pane(Pane(0))))
    }

    fn is_tab_bar_visible(&self, _: TileId, tabs: &egui_tiles::Tabs) -> bool {
        // The view needs no tab.
        tabs.children.len() > 1 || !self.only_view(tabs)
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }

    fn gap_width(&self, _: &eframe::egui::Style) -> f32 {
        2.0
    }

    fn min_size(&self) -> f32 {
        40.0
    }
}

impl Panels<'_> {
    /// Shows the view and one panel under it: for telephones, and windows that are as narrow.
    pub fn stacked(&mut self, ui: &mut Ui) {
        let id = Id::unique("the panel of a narrow window");
        let mut chosen: usize = ui.data(|data| data.get_temp(id)).unwrap_or(1);
        let high = 0.5 * ui.available_height();
        Panel::bottom("stacked").exact_size(high).frame(Frame::new().inner_margin(6.0)).show(ui, |ui| {
            ComboBox::from_id_salt("panel").selected_text(PANES[chosen].0).show_ui(ui, |ui| {
                for (index, (name, _)) in PANES.iter().enumerate().skip(1) {
                    ui.selectable_value(&mut chosen, index, *name);
                }
            });
            ScrollArea::both()
                .id_salt(chosen)
                .auto_shrink([false, false])
                .show(ui, |ui| PANES[chosen].1(ui, self));
        });
        ui.data_mut(|data| data.insert_temp(id, chosen));
        (self.view)(ui, self.out);
    }

    fn curves(&mut self, ui: &mut Ui, quantities: &[PlotQuantity]) {
        curves::show(ui, self.app_state, quantities, self.out);
    }

    fn only_view(&self, tabs: &egui_tiles::Tabs) -> bool {
        tabs.children.len() == 1 && self.view_tile == tabs.active
    }
}
