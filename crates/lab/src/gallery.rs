//! The scenes that come with the program, with thumbnails, and those opened before.

use crate::action::Action;
use eframe::egui::{self, RichText, TextureHandle, Ui};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A scene that comes with the program.
pub struct Shipped {
    /// Its file name without the ending.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
    /// A PNG of it.
    pub thumbnail: &'static [u8],
}

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        /// All of them, the simplest first.
        pub const SHIPPED: &[Shipped] = &[$(Shipped {
            name: $name,
            text: include_str!(concat!("../../../scenes/", $name, ".toml")),
            thumbnail: include_bytes!(concat!("../thumbnails/", $name, ".png")),
        }),*];
    };
}

shipped![
    "circle-three",
    "line-three",
    "seven-v",
    "figure-eight-seven",
    "moving-set-point",
    "peaking",
    "hundred",
    "change-places",
    "cars-line-three",
    "cars-circle-three",
    "cars-seven-v",
    "cars-slalom",
    "cars-yard",
    "cars-ramp",
    "cars-rough",
    "cars-crash",
    "cars-mixed",
    "cars-full-size",
    "cars-limit-cycle",
    "cars-hundred",
    "vision-line-three",
    "vision-circle-three",
    "vision-cars-line-three",
    "vision-cars-circle-three",
    "vision-seven-v",
    "vision-occlusion",
    "vision-dropout",
    "vision-epsilon",
];

/// The scene that the lab opens with when none is named.
pub const FIRST: &str = "figure-eight-seven";

/// A shipped scene by its name.
pub fn shipped(name: &str) -> Option<&'static Shipped> {
    SHIPPED.iter().find(|shipped| shipped.name == name)
}

/// The menu of scenes.
#[derive(Default)]
pub struct Gallery {
    textures: BTreeMap<&'static str, TextureHandle>,
    path: String,
}

/// Size of a thumbnail, points.
const THUMBNAIL: egui::Vec2 = egui::vec2(176.0, 99.0);

impl Gallery {
    /// Shows the menu.
    pub fn show(&mut self, ui: &mut Ui, recent: &[PathBuf], out: &mut Vec<Action>) {
        self.own(ui, out);
        if !recent.is_empty() {
            ui.horizontal_wrapped(|ui| {
                ui.label(RichText::new("Opened before").strong());
                for path in recent {
                    let name =
                        path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
                    if ui.link(name).on_hover_text(path.display().to_string()).clicked() {
                        out.push(Action::Open(path.clone()));
                    }
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

    /// A scene of one's own, by its path.
    fn own(&mut self, ui: &mut Ui, out: &mut Vec<Action>) {
        ui.horizontal(|ui| {
            ui.label("File");
            let edit =
                egui::TextEdit::singleline(&mut self.path).hint_text("path of a scene, or drop one here");
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
            let image = decode(scene.thumbnail)
                .unwrap_or_else(|| egui::ColorImage::filled([1, 1], egui::Color32::GRAY));
            ui.ctx().load_texture(scene.name, image, egui::TextureOptions::LINEAR)
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
        if response.on_hover_text(title(scene.text)).clicked() {
            out.push(Action::OpenShipped(scene.name));
        }
    }
}

/// The title in a scene's text.
fn title(text: &str) -> &str {
    let line = text.lines().find_map(|line| line.strip_prefix("title"));
    line.and_then(|rest| rest.split('"').nth(1)).unwrap_or("")
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
    fn every_scene_of_the_folder_is_in_the_menu_and_every_thumbnail_can_be_shown() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        let files = std::fs::read_dir(folder).expect("scenes").flatten();
        let mut names: Vec<String> = files
            .filter_map(|f| f.path().file_stem().map(|stem| stem.to_string_lossy().into_owned()))
            .collect();
        names.sort();
        let mut shown: Vec<&str> = SHIPPED.iter().map(|shipped| shipped.name).collect();
        shown.sort_unstable();
        assert_eq!(names, shown);
        for scene in SHIPPED {
            assert!(decode(scene.thumbnail).is_some(), "{}", scene.name);
            assert!(!title(scene.text).is_empty(), "{}", scene.name);
        }
        assert!(shipped(FIRST).is_some());
    }
}
