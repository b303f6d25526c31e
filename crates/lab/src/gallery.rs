//! The list of shipped scenes, with thumbnails, and of recent scenes.

use crate::action::Action;
use crate::panels::on_click;
use eframe::egui::{self, RichText, TextureHandle, Ui};
use scene::{SHIPPED, Shipped};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[cfg(not(target_family = "wasm"))]
macro_rules! thumbnails {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_bytes!(concat!("../thumbnails/", $name, ".png")) as &[u8])),*]
    };
}

/// PNG pictures of the shipped scenes by name. A page fetches them when the list is shown.
#[cfg(not(target_family = "wasm"))]
const THUMBNAILS: &[(&str, &[u8])] = &thumbnails![
    "circle-three",
    "line-three",
    "seven-v",
    "figure-eight-seven",
    "moving-set-point",
    "peaking",
    "hundred",
    "change-places",
    "crossing",
    "tangled",
    "pillar",
    "gate-4",
    "gate-2",
    "gate-1.5",
    "gate-1.2",
    "maze-three",
    "warehouse-seven",
    "moving-obstacle",
    "dead-end",
    "two-formations",
    "chain-twenty",
    "stop-and-go",
    "stop-and-go-curve",
    "hand-over",
    "lost-robot",
    "merge-two-columns",
    "join",
    "two-leaders",
    "law-full-state",
    "law-robust-state",
    "law-output-feedback",
    "law-integral",
    "law-sliding-mode",
    "law-predictive",
    "cars-line-three",
    "cars-circle-three",
    "cars-seven-v",
    "cars-stop-and-go",
    "cars-stop-and-go-curve",
    "cars-slalom",
    "cars-yard",
    "cars-ramp",
    "cars-rough",
    "cars-crash",
    "cars-mixed",
    "cars-full-size",
    "cars-crossing",
    "cars-tangled",
    "cars-pillar",
    "cars-gate-4",
    "cars-gate-2",
    "cars-gate-1.5",
    "cars-gate-1.2",
    "cars-limit-cycle",
    "cars-hundred",
    "vision-line-three",
    "vision-circle-three",
    "vision-cars-line-three",
    "vision-cars-circle-three",
    "vision-seven-v",
    "vision-gate-three",
    "vision-gate-seven",
    "vision-occlusion",
    "vision-dropout",
    "vision-epsilon",
];

/// The picture of a shipped scene.
#[cfg(not(target_family = "wasm"))]
fn thumbnail(name: &str) -> Option<egui::ColorImage> {
    let (_, bytes) = THUMBNAILS.iter().find(|(known, _)| *known == name)?;
    decode(bytes)
}

/// The scene that the lab opens by default.
pub const FIRST: &str = "figure-eight-seven";

/// The list of scenes.
#[derive(Default)]
pub struct Gallery {
    textures: BTreeMap<&'static str, TextureHandle>,
    path: String,
    #[cfg(target_family = "wasm")]
    fetched: crate::page::Fetched,
}

/// Size of a thumbnail, points.
const THUMBNAIL: egui::Vec2 = egui::vec2(176.0, 99.0);

impl Gallery {
    /// Shows the list.
    pub fn show(&mut self, ui: &mut Ui, recent: &[PathBuf], out: &mut Vec<Action>) {
        #[cfg(target_family = "wasm")]
        while let Some((name, bytes)) = self.fetched.next() {
            self.textures.insert(name, texture(ui, name, decode(&bytes)));
        }
        self.own(ui, out);
        if !recent.is_empty() {
            ui.horizontal_wrapped(|ui| {
                ui.label(RichText::new("Recent").strong());
                for path in recent {
                    let name =
                        path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
                    let link = ui.link(name).on_hover_text(path.display().to_string());
                    on_click(&link, Action::Open(path.clone()), out);
                }
            });
        }
        ui.add_space(6.0);
        egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
            let columns = ((ui.available_width() + 8.0) / (THUMBNAIL.x + 12.0)).floor().max(1.0) as usize;
            egui::Grid::new("scenes").num_columns(columns).spacing([10.0, 12.0]).show(ui, |ui| {
                for (index, scene) in SHIPPED.iter().enumerate() {
                    self.tile(ui, scene, out);
                    if (index + 1).is_multiple_of(columns) {
                        ui.end_row();
                    }
                }
            });
        });
    }

    /// A field for the path of a scene.
    fn own(&mut self, ui: &mut Ui, out: &mut Vec<Action>) {
        if cfg!(target_family = "wasm") {
            ui.label("Drop the file of a scene here, paste its text, or choose one of these.");
            return;
        }
        ui.horizontal(|ui| {
            ui.label("File");
            let edit =
                egui::TextEdit::singleline(&mut self.path).hint_text("path of a scene, or drop a file here");
            let edit = ui.add(edit.desired_width(360.0));
            let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if !entered {
                crate::panels::take_focus(&edit, ui);
            }
            let open = ui.add_enabled(!self.path.trim().is_empty(), egui::Button::new("Open"));
            if (entered || open.clicked()) && !self.path.trim().is_empty() {
                out.push(Action::Open(Path::new(self.path.trim()).to_owned()));
            }
        });
    }

    fn tile(&mut self, ui: &mut Ui, scene: &'static Shipped, out: &mut Vec<Action>) {
        let texture = self.textures.entry(scene.name).or_insert_with(|| {
            #[cfg(not(target_family = "wasm"))]
            let image = thumbnail(scene.name);
            #[cfg(target_family = "wasm")]
            let image = self.fetched.fetch(scene.name, format!("thumbnails/{}.png", scene.name), ui.ctx());
            texture(ui, scene.name, image)
        });
        let response = ui
            .vertical(|ui| {
                ui.set_width(THUMBNAIL.x);
                let picture = egui::Image::new((texture.id(), THUMBNAIL)).corner_radius(4.0);
                let response = ui.add(egui::Button::image(picture).frame(false));
                ui.label(scene.name);
                response
            })
            .inner;
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, scene.name));
        on_click(&response.on_hover_text(scene.title()), Action::OpenShipped(scene.name), out);
    }
}

/// The texture of a thumbnail; grey where there is none.
fn texture(ui: &Ui, name: &str, image: Option<egui::ColorImage>) -> TextureHandle {
    let image = image.unwrap_or_else(|| egui::ColorImage::filled([1, 1], egui::Color32::GRAY));
    ui.ctx().load_texture(name, image, egui::TextureOptions::LINEAR)
}

fn decode(bytes: &[u8]) -> Option<egui::ColorImage> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().ok()?;
    let mut pixels = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut pixels).ok()?;
    let size = [info.width as usize, info.height as usize];
    match info.color_type {
        png::ColorType::Rgb => Some(egui::ColorImage::from_rgb(size, &pixels[..info.buffer_size()])),
        png::ColorType::Rgba => {
            Some(egui::ColorImage::from_rgba_unmultiplied(size, &pixels[..info.buffer_size()]))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shipped_scene_has_a_thumbnail_that_can_be_shown() {
        for scene in SHIPPED {
            assert!(thumbnail(scene.name).is_some(), "{}", scene.name);
        }
        assert!(scene::shipped(FIRST).is_some());
    }
}
