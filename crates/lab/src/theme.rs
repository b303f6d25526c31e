//! The dark and the light theme of the window.

use eframe::egui::{self, Color32, CornerRadius, FontFamily, FontId, Stroke, TextStyle, Theme, Visuals};

/// The accent colour of the dark and the light theme.
const ACCENT: [Color32; 2] = [Color32::from_rgb(0x3d, 0x8b, 0xe0), Color32::from_rgb(0x1f, 0x6f, 0xc8)];

/// Sets fonts, colours and spacing of the dark and the light theme.
pub fn apply(ctx: &egui::Context) {
    // The font of the pictures comes before those of the library.
    let mut fonts = egui::FontDefinitions::default();
    fonts.font_data.insert("Inter".to_owned(), egui::FontData::from_static(rendering::FONT).into());
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        let names = fonts.families.entry(family.clone()).or_default();
        let at = if family == FontFamily::Proportional { 0 } else { names.len() };
        names.insert(at, "Inter".to_owned());
    }
    ctx.set_fonts(fonts);
    for theme in [Theme::Dark, Theme::Light] {
        ctx.set_visuals_of(theme, visuals(theme));
        ctx.style_mut_of(theme, |style| {
            style.spacing.item_spacing = egui::vec2(7.0, 5.0);
            style.spacing.button_padding = egui::vec2(7.0, 3.0);
            style.spacing.interact_size.y = 21.0;
            // No animations: only the robots move.
            style.animation_time = 0.0;
            for (name, size) in [
                (TextStyle::Body, 13.0),
                (TextStyle::Button, 13.0),
                (TextStyle::Small, 11.0),
                (TextStyle::Heading, 18.0),
            ] {
                style.text_styles.insert(name, FontId::new(size, FontFamily::Proportional));
            }
            style.text_styles.insert(TextStyle::Monospace, FontId::new(12.5, FontFamily::Monospace));
        });
    }
}

fn visuals(theme: Theme) -> Visuals {
    let dark = theme == Theme::Dark;
    let mut visuals = if dark { Visuals::dark() } else { Visuals::light() };
    let accent = ACCENT[usize::from(!dark)];
    visuals.selection.bg_fill = accent;
    visuals.selection.stroke = Stroke::new(1.0, Color32::WHITE);
    visuals.hyperlink_color = if dark { Color32::from_rgb(0x7d, 0xb8, 0xf5) } else { accent };
    visuals.slider_trailing_fill = true;
    visuals.warn_fg_color =
        if dark { Color32::from_rgb(0xf0, 0xb0, 0x50) } else { Color32::from_rgb(0xa0, 0x5a, 0x00) };
    visuals.error_fg_color =
        if dark { Color32::from_rgb(0xff, 0x7a, 0x66) } else { Color32::from_rgb(0xb8, 0x22, 0x12) };
    if dark {
        visuals.panel_fill = Color32::from_rgb(0x1d, 0x20, 0x25);
        visuals.window_fill = Color32::from_rgb(0x24, 0x28, 0x2e);
        visuals.extreme_bg_color = Color32::from_rgb(0x14, 0x16, 0x1a);
        visuals.widgets.noninteractive.fg_stroke.color = Color32::from_rgb(0xc8, 0xcd, 0xd4);
        visuals.widgets.inactive.fg_stroke.color = Color32::from_rgb(0xd8, 0xdc, 0xe2);
    } else {
        visuals.panel_fill = Color32::from_rgb(0xf4, 0xf5, 0xf7);
        visuals.window_fill = Color32::from_rgb(0xff, 0xff, 0xff);
        visuals.extreme_bg_color = Color32::from_rgb(0xff, 0xff, 0xff);
        visuals.widgets.noninteractive.fg_stroke.color = Color32::from_rgb(0x30, 0x36, 0x3e);
    }
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals
}
