//! Custom laws: which law a follower has, sliders for the parameters that a law declares, and its text.

use super::controls::{released, reset, sign, slider_width};
use super::law::scope;
use super::{chosen, empty_panel, on_click, tune};
use crate::action::{Action, LawChoice};
use crate::app_state::{AppState, LawEdit};
use crate::numbers::toml_number;
use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{self, Color32, ComboBox, FontId, RichText, ScrollArea, Slider, Stroke, TextEdit, Ui};
use laws::{CustomLaw, LawFile, Mistake, Parameter, SHIPPED_LAWS, Scale, TEMPLATE};
use scene::{Law, LawSource, WrittenLaw};
use vocabulary::LawKind;

/// Most mistakes that are listed under the text.
const LISTED: usize = 4;

/// A box to choose the law from the paper's, those that come with the program, and a new one.
pub(crate) fn choice(ui: &mut Ui, law: &Law, built_in: &[(LawKind, &str, &str)], out: &mut Vec<Action>) {
    let shown = match (law.custom(), law.built_in()) {
        (Some(custom), _) if custom.declaration().title.is_empty() => custom.name().to_owned(),
        (Some(custom), _) => custom.declaration().title.clone(),
        (None, kind) => {
            let known = built_in.iter().find(|(known, ..)| Some(*known) == kind);
            known.map_or("", |(_, name, _)| name).to_owned()
        }
    };
    let combo = ComboBox::from_id_salt("Law").selected_text(&shown).width(ui.available_width() - 8.0);
    let response = combo.show_ui(ui, |ui| {
        for (kind, name, tip) in built_in {
            let now = law.built_in() == Some(*kind);
            let label = ui.selectable_label(now, *name).on_hover_text(*tip);
            if label.clicked() && !now {
                out.push(Action::ChooseLaw(LawChoice::BuiltIn(*kind)));
            }
        }
        ui.separator();
        let new = ui.selectable_label(false, "New law…").on_hover_text("A law of your own, from a template");
        on_click(&new, Action::ChooseLaw(LawChoice::Text(TEMPLATE.to_owned())), out);
        ui.separator();
        let source = law.custom().map(WrittenLaw::source);
        for shipped in SHIPPED_LAWS {
            let Some(title) = title(shipped.text) else { continue };
            let now = source == Some(&LawSource::Shipped(shipped.name.to_owned()));
            let tip = format!("Law file {}", shipped.name);
            let label = ui.selectable_label(now, format!("{title} (law file)"));
            if label.on_hover_text(tip).clicked() && !now {
                out.push(Action::ChooseLaw(LawChoice::Shipped(shipped.name)));
            }
        }
    });
    chosen(&response.response, "Law", &shown);
}

/// Title of a law that comes with the program and looks at one leader.
fn title(text: &str) -> Option<String> {
    let law = LawFile::compile(text).ok()?;
    (law.declaration().leaders == 1).then(|| law.declaration().title.clone())
}

/// Parameters of a custom law.
pub(crate) fn parameters(ui: &mut Ui, app_state: &AppState, law: &Law, out: &mut Vec<Action>) {
    let Some(custom) = law.custom() else { return };
    let values = law.values();
    for (parameter, value) in custom.declaration().parameters.iter().zip(values) {
        row(ui, parameter, value, out);
    }
    if custom.text().is_none() {
        return;
    }
    let text =
        ui.button("Edit its text").on_hover_text("The panel Law text; what compiles takes hold as you type");
    on_click(&text, Action::ShowPanel("Law text"), out);
    let told = app_state.law_edit().and_then(|edit| match &*edit.mistakes {
        [] => edit.refusal,
        _ => Some("Its text has mistakes: the law before them drives on".to_owned()),
    });
    if let Some(told) = told {
        ui.colored_label(ui.visuals().error_fg_color, told.lines().next().unwrap_or_default());
    }
}

/// The text of the selected follower's custom law.
pub fn text(ui: &mut Ui, app_state: &AppState, out: &mut Vec<Action>) {
    let follow = app_state.tuned_follower().map(|(_, _, name, follow)| (name, follow));
    let Some(((name, follow), edit)) = follow.zip(app_state.law_edit()) else {
        let module = app_state.tuned_follower().and_then(|(.., follow)| follow.law.custom());
        let why = match module {
            Some(_) => "The law is a WebAssembly module, which has no text.",
            None => "The followers have a law of the paper, which has no text.",
        };
        empty_panel(ui, app_state, why);
        if app_state.tuned_follower().is_some() {
            let new = ui.button("New law").on_hover_text("A law of your own, from a template");
            on_click(&new, Action::ChooseLaw(LawChoice::Text(TEMPLATE.to_owned())), out);
        }
        return;
    };
    scope(ui, app_state, name, out);
    if let Some(LawSource::Shipped(file) | LawSource::File(file)) =
        follow.law.custom().map(WrittenLaw::source)
    {
        ui.weak(format!("From {file}; once it is changed it stands in the scene"));
    }
    editor(ui, &edit, out);
}

/// A slider for a parameter.
fn row(ui: &mut Ui, parameter: &Parameter, value: f64, out: &mut Vec<Action>) {
    let Parameter { name, symbol, default, range: [low, high], scale, help, .. } = parameter;
    let unit = parameter.behind();
    let key = format!("law.parameters.{name}");
    ui.horizontal(|ui| {
        sign(ui, |ui| ui.label(RichText::new(symbol).strong()));
        ui.spacing_mut().slider_width = slider_width(ui);
        let mut new = value;
        let mut slider = Slider::new(&mut new, *low..=*high).max_decimals(5).suffix(&unit);
        if *scale == Scale::Logarithmic {
            slider = slider.logarithmic(true).smallest_positive(*low);
        }
        let response = ui.add(slider);
        response.widget_info(|| egui::WidgetInfo::slider(true, new, name));
        let response = response.on_hover_text(format!("{name}: {help} ({low} to {high}{unit})"));
        if response.changed() && new != value {
            out.push(tune(name, key.clone(), toml_number(new.clamp(*low, *high))));
        }
        released(&response, out);
        reset(ui, value != *default, name, &format!("{default}{unit}"), key.into(), out);
    });
}

/// What is to be said of an edited text, and whether it is a fault.
fn remarks(edit: &LawEdit) -> Vec<(String, bool)> {
    let mut all: Vec<_> =
        edit.mistakes.iter().take(LISTED).map(|mistake| (mistake.to_string(), true)).collect();
    if let Some(more) = edit.mistakes.len().checked_sub(LISTED).filter(|more| *more > 0) {
        all.push((format!("and {more} more"), true));
    }
    all.extend(
        edit.refusal.iter().filter_map(|refusal| refusal.lines().next()).map(|line| (line.to_owned(), true)),
    );
    if all.is_empty() {
        all.push(("Takes hold as you type".to_owned(), false));
    }
    all
}

/// The text with line numbers, mistakes underlined, and what is wrong below: there it does not move the text.
fn editor(ui: &mut Ui, edit: &LawEdit, out: &mut Vec<Action>) {
    let font = egui::TextStyle::Monospace.resolve(ui.style());
    let mut text = edit.text.clone();
    let remarks = remarks(edit);
    let body = egui::TextStyle::Body.resolve(ui.style());
    let tall = |(remark, _): &(String, bool)| {
        let galley = ui.painter().layout(remark.clone(), body.clone(), Color32::WHITE, ui.available_width());
        galley.size().y + ui.spacing().item_spacing.y
    };
    let below: f32 = remarks.iter().map(tall).sum();
    let high = (ui.available_height() - below - ui.spacing().item_spacing.y).max(60.0);
    let lines = text.lines().count() + usize::from(text.ends_with('\n'));
    ScrollArea::both().id_salt("law text").auto_shrink([false, false]).max_height(high).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let numbers: Vec<String> = (1..=lines.max(1)).map(|line| format!("{line:>3}")).collect();
            let numbers = RichText::new(numbers.join("\n")).font(font.clone()).weak();
            // The text of a field begins below its margin.
            ui.vertical(|ui| {
                ui.add_space(2.0);
                ui.add(egui::Label::new(numbers).selectable(false).extend());
            });
            let mut layout = |ui: &Ui, buffer: &dyn egui::TextBuffer, _: f32| {
                let mistakes = if buffer.as_str() == edit.text { &edit.mistakes[..] } else { &[] };
                let job = underlined(buffer.as_str(), mistakes, &font, ui.visuals().text_color());
                ui.fonts_mut(|fonts| fonts.layout_job(job))
            };
            let field = TextEdit::multiline(&mut text)
                // It keeps the keyboard whatever is said around it.
                .id(egui::Id::unique("text of the law"))
                .code_editor()
                .desired_width(f32::INFINITY)
                .desired_rows(lines.max(4))
                .layouter(&mut layout);
            let response = ui.add(field);
            response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::MultilineTextInput, true, "Text of the law")
            });
            if response.changed() && text != edit.text {
                out.push(Action::EditLaw(text));
            }
            if response.lost_focus() {
                out.push(Action::Release);
            }
        });
    });
    for (remark, fault) in remarks {
        let colour = if fault { ui.visuals().error_fg_color } else { ui.visuals().weak_text_color() };
        ui.add(egui::Label::new(RichText::new(remark).color(colour)).wrap());
    }
}

/// A text in which comments are weak and mistakes underlined.
fn underlined(text: &str, mistakes: &[Mistake], font: &FontId, colour: Color32) -> LayoutJob {
    let mut job = LayoutJob::default();
    job.wrap.max_width = f32::INFINITY;
    // A mistake at the end of the text has no character of its own.
    let spans: Vec<[usize; 2]> = mistakes
        .iter()
        .map(|mistake| [mistake.place, mistake.end].map(|place| place.byte_in(text)))
        .collect();
    let plain = TextFormat::simple(font.clone(), colour);
    let comment = TextFormat::simple(font.clone(), colour.gamma_multiply(0.6));
    let mut cuts: Vec<usize> = spans.iter().flatten().copied().chain([0, text.len()]).collect();
    let mut end = 0;
    for line in text.split_inclusive('\n') {
        cuts.extend(line.find('#').map(|at| end + at));
        end += line.len();
        cuts.push(end);
    }
    cuts.sort_unstable();
    cuts.dedup();
    let commented = |at: usize| {
        let line = text[..at].rfind('\n').map_or(0, |at| at + 1);
        text[at..].starts_with('#') || text[line..at].contains('#')
    };
    for piece in cuts.windows(2) {
        let [from, to] = [piece[0], piece[1]];
        let mut format = if commented(from) { comment.clone() } else { plain.clone() };
        if spans.iter().any(|[start, end]| *start <= from && to <= *end && from < *end) {
            format.underline = Stroke::new(1.5, Color32::from_rgb(0xd8, 0x3a, 0x34));
        }
        job.append(&text[from..to], 0.0, format);
    }
    job
}
