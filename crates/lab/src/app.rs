//! The window itself: it hears news, shows panels, and does what is asked for.

use crate::Error;
use crate::action::Action;
use crate::desk::{Choice, Desk, Tool};
use crate::gallery::{self, Gallery};
use crate::keep::{Seen, free, keep};
use crate::kept::{Left, WorkKept, alive, left};
use crate::look;
use crate::panels::time_bar;
use crate::panes::{self, Pane, Panels};
use crate::quantities;
use crate::session::forecast::{Crystal, Forecast};
use crate::session::runner::{News, Order, Runner};
use crate::studio::{Job, RATE, Shot, Studio, Told};
use crate::view::viewport::{DeskView, Viewport};
use crate::watch::Watch;
use crate::window::{NAME, Options};
use eframe::egui::{self, Context, Ui};
use egui_tiles::Tree;
use rendering::{Layout, Sketch, Style};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Scenes opened before that are remembered.
const MOST_RECENT: usize = 8;
/// Between two times that unsaved work is put on disk.
const KEEP_EVERY: Duration = Duration::from_secs(1);

/// The window.
pub(crate) struct Lab {
    pub(crate) desk: Desk,
    runner: Runner,
    forecasts: Receiver<Forecast>,
    viewport: Viewport,
    studio: Studio,
    tree: Tree<Pane>,
    gallery: Gallery,
    shows: Shows,
    recent: Vec<PathBuf>,
    kept: WorkKept,
    kept_at: Instant,
    left: Option<Left>,
    watch: Watch,
    film: Option<Filming>,
    words: (Sender<Result<String, String>>, Receiver<Result<String, String>>),
    ctx: Context,
    ended: Arc<Mutex<Option<Error>>>,
    timings: crate::timing::Timing,
    print: bool,
}

/// What lies over the view.
#[derive(Debug, Default, Clone, Copy)]
struct Shows {
    gallery: bool,
    help: bool,
    hints: bool,
    closing: bool,
}

/// A film under way.
struct Filming {
    path: PathBuf,
    /// Time of the next frame, s, and the branch.
    next: f64,
    branch: usize,
    /// Moments up to this time have been sent, s.
    sent: f64,
    frames: u64,
}

/// What the window remembers between starts.
#[derive(serde::Serialize, serde::Deserialize, Default)]
struct Memory {
    tree: Option<Tree<Pane>>,
    recent: Vec<PathBuf>,
    hints_seen: bool,
    scale: Option<f32>,
}

impl Lab {
    pub(crate) fn new(
        context: &eframe::CreationContext<'_>,
        options: Options,
        ended: Arc<Mutex<Option<Error>>>,
    ) -> Result<Self, String> {
        let state = context.wgpu_render_state.as_ref().ok_or("there is no graphics device")?;
        let ctx = context.egui_ctx.clone();
        look::dress(&ctx);
        let wake = || {
            let ctx = ctx.clone();
            move || ctx.request_repaint()
        };
        let (crystal, forecasts) = Crystal::start(wake());
        let viewport = Viewport::new(state);
        let memory: Memory =
            context.storage.and_then(|storage| eframe::get_value(storage, "memory")).unwrap_or_default();
        ctx.set_zoom_factor(memory.scale.unwrap_or(1.0).clamp(0.5, 4.0));
        let folder = eframe::storage_dir(NAME);
        let mut lab = Self {
            desk: Desk::new(),
            runner: Runner::start(crystal, wake()),
            forecasts,
            studio: Studio::start(viewport.gpu().clone(), wake()),
            viewport,
            tree: memory.tree.filter(panes::sound).unwrap_or_else(panes::arrangement),
            gallery: Gallery::default(),
            shows: Shows { hints: !memory.hints_seen, ..Shows::default() },
            recent: memory.recent,
            kept: WorkKept::new(folder.as_deref()),
            kept_at: Instant::now(),
            left: folder.as_deref().and_then(|folder| left(folder, alive)),
            watch: Watch::start(wake(), options.stop),
            film: None,
            words: channel(),
            ctx: ctx.clone(),
            ended,
            timings: crate::timing::Timing::default(),
            print: options.timings,
        };
        lab.desk.playing = !options.paused;
        lab.desk.aloud = options.timings;
        lab.open_first(&options);
        Ok(lab)
    }

    fn open_first(&mut self, options: &Options) {
        match &options.scene {
            Some(path) => self.open(path),
            None => self.open_shipped(gallery::FIRST),
        }
        if !options.set.is_empty() && self.desk.draft.is_some() {
            let set = options.set.clone();
            self.desk.edit("Changes of the command line", |text| {
                set.iter().try_for_each(|set| {
                    let (path, value) = set.parts();
                    text.set(path, value).map_err(|error| error.to_string())
                })
            });
        }
    }

    // --- every frame -----------------------------------------------------------------------------------------

    fn hear(&mut self) {
        while let Some(news) = self.runner.news() {
            match news {
                News::Told { branch, changes: _, samples, digest } => {
                    self.keep_run(branch, Seen { samples, digest });
                }
                news => self.desk.hear(news),
            }
        }
        while let Ok(forecast) = self.forecasts.try_recv() {
            self.timings.forecast(&forecast);
            if forecast.branch == self.desk.branch && self.desk.ahead > 0.0 {
                self.desk.forecast = Some(forecast);
            }
        }
        while let Some(told) = self.studio.told() {
            match told {
                Told::Written(path) => self.desk.note(format!("Written: {}", path.display())),
                Told::Failed(why) => {
                    self.film = None;
                    self.desk.fault(why);
                }
            }
        }
        while let Ok(word) = self.words.1.try_recv() {
            match word {
                Ok(text) => self.desk.note(text),
                Err(text) => self.desk.fault(text),
            }
        }
        if self.watch.changed() {
            self.changed_on_disk();
        }
        self.film_on();
        self.keep_work();
    }

    /// Sends what the desk has ordered.
    fn send(&mut self) {
        for order in std::mem::take(&mut self.desk.orders) {
            let order = match order {
                Order::Open { scene, until, .. } => {
                    Order::Open { scene, until, gpu: Some(self.viewport.gpu().clone()) }
                }
                order => order,
            };
            self.runner.order(order);
        }
    }

    fn show(&mut self, ui: &mut Ui) -> Vec<Action> {
        let mut out = Vec::new();
        crate::keys::pressed(ui.ctx(), &self.desk, &mut out);
        let (branch, time) = (self.desk.branch, self.desk.time());
        if let Some(history) = &mut self.desk.history {
            history.prepare_trail(branch, time);
        }
        let filming = self.film.as_ref().map(|film| {
            format!("{}: {} frames, {} waiting", film.path.display(), film.frames, self.studio.waiting())
        });
        egui::Panel::top("time").show(ui, |ui| {
            ui.add_space(3.0);
            time_bar::show(ui, &self.desk, filming.is_some(), &mut out);
            ui.add_space(3.0);
        });
        self.notices(ui, &mut out);
        let desk = &self.desk;
        let style = self.viewport.style.clone();
        let view_tile = Pane::named("View").and_then(|pane| self.tree.tiles.find_pane(&pane));
        let viewport = &mut self.viewport;
        let mut view = |ui: &mut Ui, out: &mut Vec<Action>| {
            let empty = Arc::default();
            let seen = DeskView {
                desk,
                cast: desk.history.as_ref().map_or(&empty, |history| history.cast()),
                moment: desk.shown(),
                trail: desk.history.as_ref().and_then(|history| history.trail(branch, time)),
            };
            viewport.show(ui, &seen, out);
        };
        let mut panels = Panels {
            desk,
            style: &style,
            filming: filming.as_deref(),
            view: &mut view,
            view_tile,
            out: &mut out,
        };
        let frame = egui::Frame::new().fill(ui.visuals().panel_fill);
        let tree = &mut self.tree;
        egui::CentralPanel::default().frame(frame).show(ui, |ui| tree.ui(&mut panels, ui));
        self.over(ui.ctx(), &mut out);
        out
    }

    /// Lines under the bar: faults, and work that a crash has left.
    fn notices(&mut self, ui: &mut Ui, out: &mut Vec<Action>) {
        if let Some(left) = &self.left {
            let name =
                left.path.as_ref().map_or_else(|| "a scene".to_owned(), |path| path.display().to_string());
            egui::Panel::top("left").show(ui, |ui| {
                ui.horizontal_wrapped(|ui| {
                    ui.label(format!("Unsaved work on {name} was left when Echelon ended last time."));
                    if ui.button("Go on with it").clicked() {
                        out.push(Action::Recover);
                    }
                    if ui.button("Forget it").clicked() {
                        out.push(Action::Forget);
                    }
                });
            });
        }
        if let Some(notice) = self.desk.notice.clone() {
            egui::Panel::top("notice").show(ui, |ui| {
                ui.horizontal_top(|ui| {
                    if ui.button("×").on_hover_text("Dismiss (Esc)").clicked() {
                        out.push(Action::Dismiss);
                    }
                    let colour = ui.visuals().error_fg_color;
                    egui::ScrollArea::vertical().max_height(140.0).show(ui, |ui| {
                        ui.add(egui::Label::new(egui::RichText::new(notice).color(colour)).wrap());
                    });
                });
            });
        }
    }

    /// Windows over the view.
    fn over(&mut self, ctx: &Context, out: &mut Vec<Action>) {
        let mut open = self.shows.gallery;
        if open {
            egui::Window::new("Scenes").open(&mut open).collapsible(false).default_width(780.0).show(
                ctx,
                |ui| {
                    self.gallery.show(ui, &self.recent, out);
                },
            );
            self.shows.gallery &= open;
        }
        let mut open = self.shows.help;
        if open {
            egui::Window::new("Shortcuts").open(&mut open).collapsible(false).resizable(false).show(
                ctx,
                |ui| {
                    crate::keys::page(ui);
                },
            );
            self.shows.help &= open;
        }
        if self.shows.hints {
            self.hints(ctx);
        }
        if self.shows.closing {
            self.ask_before_closing(ctx, out);
        }
    }

    fn hints(&mut self, ctx: &Context) {
        let mut open = true;
        egui::Window::new("Three things to try")
            .open(&mut open)
            .collapsible(false)
            .resizable(false)
            .fixed_pos(self.viewport.rect.right_top() + egui::vec2(-12.0, 12.0))
            .pivot(egui::Align2::RIGHT_TOP)
            .default_width(300.0)
            .show(ctx, |ui| {
                ui.label(
                    "1.  Drag the bright ring: the set point moves, and the thin lines show the future.",
                );
                ui.label("2.  Drag ε in the panel Observer, then press Shift Home, and watch it peak.");
                ui.label("3.  Drag back on the line of time, change a gain, and play: a branch.");
                if ui.button("Got it").clicked() {
                    self.shows.hints = false;
                }
            });
        self.shows.hints &= open;
    }

    fn ask_before_closing(&mut self, ctx: &Context, out: &mut Vec<Action>) {
        egui::Modal::new(egui::Id::unique("closing")).show(ctx, |ui| {
            ui.label("The scene has changes that are not saved.");
            ui.horizontal(|ui| {
                if ui.button("Save and close").clicked() {
                    out.push(Action::Save);
                    self.shows.closing = false;
                    ctx.send_viewport_cmd(egui::ViewportCommand::Close);
                }
                if ui.button("Close without saving").clicked() {
                    self.kept.done();
                    self.desk.draft = None;
                    self.shows.closing = false;
                    ctx.send_viewport_cmd(egui::ViewportCommand::Close);
                }
                if ui.button("Stay").clicked() {
                    self.shows.closing = false;
                }
            });
        });
    }

    // --- what is asked for -----------------------------------------------------------------------------------

    fn act(&mut self, action: Action) {
        if self.desk.act(&action) {
            return;
        }
        match action {
            Action::Follow(robot) => self.viewport.follow(robot, &self.desk),
            Action::View(view) => self.viewport.look(&view),
            Action::Inset(robot) => {
                let now = &mut self.viewport.style.picture_in_picture;
                *now = if *now == robot { None } else { robot };
                self.viewport.style.detections = now.is_some();
            }
            Action::Element(name, on) => {
                // The names are the panel's own.
                let _ = self.viewport.style.set(name, on);
            }
            Action::Open(path) => self.open(&path),
            Action::OpenShipped(name) => self.open_shipped(name),
            Action::Save => self.save(None),
            Action::SaveAs(path) => self.save(Some(path)),
            Action::Reload => self.reload(),
            Action::Recover => self.recover(),
            Action::Forget => self.forget(),
            Action::Picture => self.picture(),
            Action::WindowPicture => self.window_picture(),
            Action::Film if self.film.is_some() => self.end_film(),
            Action::Film => self.begin_film(),
            Action::KeepRun => self.desk.orders.push(Order::Tell(self.desk.branch)),
            Action::CurvesCsv => self.write_curves("csv", &quantities::csv(&self.desk)),
            Action::CurvesSvg => self.write_curves("svg", &quantities::svg(&self.desk)),
            Action::Panel(name) => panes::toggle(&mut self.tree, name),
            Action::Theme => {
                let dark = self.ctx.theme() == egui::Theme::Dark;
                self.ctx.set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
            }
            Action::Scale(scale) => self.ctx.set_zoom_factor(scale.clamp(0.5, 4.0)),
            Action::Help => self.shows.help = !self.shows.help,
            Action::Gallery => self.shows.gallery = !self.shows.gallery,
            Action::Dismiss => self.dismiss(),
            _ => {}
        }
    }

    fn dismiss(&mut self) {
        if self.shows.gallery || self.shows.help || self.shows.hints {
            (self.shows.gallery, self.shows.help, self.shows.hints) = (false, false, false);
        } else if self.desk.notice.is_some() {
            self.desk.notice = None;
        } else if self.desk.tool != Tool::Hand {
            self.desk.tool = Tool::Hand;
        } else {
            self.desk.choice = Choice::Nothing;
        }
    }

    fn open(&mut self, path: &Path) {
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
            return self.open_picture(path);
        }
        match std::fs::read_to_string(path) {
            Ok(text) => {
                if self.take_scene(text, Some(path.to_owned()), path) {
                    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
                    self.recent.retain(|known| *known != path);
                    self.recent.insert(0, path);
                    self.recent.truncate(MOST_RECENT);
                }
            }
            Err(error) => self.desk.fault(format!("{} cannot be read: {error}", path.display())),
        }
    }

    fn open_shipped(&mut self, name: &str) {
        if let Some(shipped) = gallery::shipped(name) {
            self.take_scene(shipped.text.to_owned(), None, Path::new(&format!("{name}.toml")));
        }
    }

    /// A scene in place of the one that is open; where it cannot be opened, that one stays.
    fn take_scene(&mut self, text: String, path: Option<PathBuf>, home: &Path) -> bool {
        self.end_film();
        match self.desk.open(text, path.clone(), home) {
            Ok(()) => {
                self.desk.notice = None;
                self.shows.gallery = false;
                let view =
                    self.desk.scene().map_or_else(|| "snake".to_owned(), |scene| scene.views.default.clone());
                self.viewport.look(&view);
                self.viewport.style.picture_in_picture = None;
                self.watch.look_at(path);
                let title = self.desk.scene().map_or_else(String::new, |scene| scene.title.clone());
                self.ctx.send_viewport_cmd(egui::ViewportCommand::Title(format!("{title} — Echelon")));
                true
            }
            Err(faults) => {
                self.desk.fault(faults);
                false
            }
        }
    }

    /// A picture brings back the scene, the time and the view that made it.
    fn open_picture(&mut self, path: &Path) {
        let texts = match rendering::png::read_texts(path) {
            Ok(texts) => texts,
            Err(error) => return self.desk.fault(error.to_string()),
        };
        let of = |key: &str| texts.iter().find(|(known, _)| known == key).map(|(_, text)| text.clone());
        let Some(scene) = of("Scene") else {
            return self.desk.fault(format!("{} was not made by the lab: it holds no scene", path.display()));
        };
        let home = of("Home").map_or_else(|| path.to_owned(), PathBuf::from);
        if !self.take_scene(scene, None, &home) {
            return;
        }
        if let Some(time) = of("Time").and_then(|time| time.parse::<f64>().ok()).filter(|t| t.is_finite()) {
            self.desk.playing = false;
            self.desk.orders.clear();
            self.desk.restart(time);
        }
        if let Some(view) = of("View") {
            self.viewport.look(&view);
        }
        self.desk.note(format!("As in {}", path.display()));
    }

    fn save(&mut self, path: Option<PathBuf>) {
        let Some(draft) = &mut self.desk.draft else { return };
        // A scene that came with the program is saved beside where one works.
        let own = || free(Path::new("."), &stem(draft.home()), "toml");
        let path = path.or_else(|| draft.path.clone()).unwrap_or_else(own);
        if path.exists() && draft.path.as_ref() != Some(&path) {
            let text =
                format!("{} is there already: choose another name, or remove it first", path.display());
            return self.desk.fault(text);
        }
        match recording::write_whole(&path, draft.text().as_bytes()) {
            Ok(()) => {
                draft.saved_to(path.clone());
                self.kept.done();
                self.watch.look_at(Some(path.clone()));
                self.desk.note(format!("Saved: {}", path.display()));
            }
            Err(error) => self.desk.fault(error.to_string()),
        }
    }

    fn reload(&mut self) {
        let Some(path) = self.desk.draft.as_ref().and_then(|draft| draft.path.clone()) else { return };
        match std::fs::read_to_string(&path) {
            Ok(text) => self.take_text("Read again from disk", text),
            Err(error) => self.desk.fault(format!("{} cannot be read: {error}", path.display())),
        }
    }

    fn take_text(&mut self, what: &str, text: String) {
        let Some(draft) = &mut self.desk.draft else { return };
        match draft.replace(what, text) {
            Ok(effect) => {
                if let Some(path) = draft.path.clone() {
                    draft.saved_to(path);
                }
                self.desk.notice = None;
                self.desk.take(what, &effect);
            }
            Err(faults) => self.desk.fault(faults),
        }
    }

    fn changed_on_disk(&mut self) {
        if self.desk.draft.as_ref().is_some_and(crate::session::draft::Draft::unsaved) {
            let text = "The file has changed on disk, and there are changes here: Ctrl R takes the file, Ctrl S keeps yours.";
            self.desk.fault(text);
        } else {
            self.reload();
        }
    }

    fn recover(&mut self) {
        let Some(left) = self.left.take() else { return };
        let home = left.path.clone().unwrap_or_else(|| PathBuf::from("scene.toml"));
        let saved = left.path.as_ref().and_then(|path| std::fs::read_to_string(path).ok());
        let text = saved.unwrap_or_else(|| left.text.clone());
        if self.take_scene(text, left.path.clone(), &home) {
            // The work is an edit of what is on disk, so that it can be undone.
            if let Some(draft) = &mut self.desk.draft {
                match draft.replace("Work from before", left.text.clone()) {
                    Ok(_) => self.desk.restart(0.0),
                    Err(faults) => return self.desk.fault(faults),
                }
            }
            let _ = std::fs::remove_file(&left.file);
        }
    }

    fn forget(&mut self) {
        if let Some(left) = self.left.take() {
            let _ = std::fs::remove_file(left.file);
        }
    }

    fn write_curves(&mut self, ending: &str, text: &str) {
        let path = free(Path::new("."), &self.name(), ending);
        match recording::write_whole(&path, text.as_bytes()) {
            Ok(()) => self.desk.note(format!("Written: {}", path.display())),
            Err(error) => self.desk.fault(error.to_string()),
        }
    }

    fn keep_run(&mut self, branch: usize, seen: Seen) {
        if branch != self.desk.branch {
            return;
        }
        let text = match self.desk.script() {
            Ok(text) => text,
            Err(why) => return self.desk.fault(why),
        };
        let home = self.desk.draft.as_ref().map_or_else(PathBuf::new, |draft| draft.home().to_owned());
        let folder = free(Path::new("runs"), &format!("{}-lab", self.name()), "");
        let (sender, gpu, ctx) = (self.words.0.clone(), self.viewport.gpu().clone(), self.ctx.clone());
        self.desk.note("The run is being written down");
        let work = move || {
            let word = keep(&text, &home, &folder, &seen, Some(&gpu));
            // A window that is closed does not wait for it.
            let _ = sender.send(word);
            ctx.request_repaint();
        };
        if let Err(error) = std::thread::Builder::new().name("keep".to_owned()).spawn(work) {
            self.desk.fault(error.to_string());
        }
    }

    fn keep_work(&mut self) {
        let Some(draft) = &self.desk.draft else { return };
        if !draft.unsaved() {
            return self.kept.done();
        }
        let wait = KEEP_EVERY.saturating_sub(self.kept_at.elapsed());
        if !wait.is_zero() {
            return self.ctx.request_repaint_after(wait);
        }
        self.kept_at = Instant::now();
        if let Err(why) = self.kept.keep(draft.text(), draft.path.as_deref()) {
            self.desk.fault(why);
        }
    }

    fn name(&self) -> String {
        self.desk.draft.as_ref().map_or_else(|| "scene".to_owned(), |draft| stem(draft.home()))
    }

    // --- pictures and films ----------------------------------------------------------------------------------

    /// What is seen now, for a picture `size` large.
    fn shot(&self, moment: &Arc<vocabulary::Moment>, size: (u32, u32)) -> Option<Shot> {
        let cast = self.desk.history.as_ref()?.cast();
        let scale = (f64::from(size.1) / 720.0).max(0.5);
        Some(Shot {
            moment: Arc::clone(moment),
            layout: self.viewport.layout(cast, moment),
            style: self.viewport.dressed(&self.desk, moment, scale),
            words: self.desk.words(),
        })
    }

    /// What a film shows now: what is seen, or the view that was chosen for it, without what only the hand needs.
    fn film_shot(&self, moment: &Arc<vocabulary::Moment>) -> Option<Shot> {
        let shot = self.shot(moment, (1280, 720))?;
        let Some(view) = &self.desk.film_from else { return Some(shot) };
        let cast = self.desk.history.as_ref()?.cast();
        let names: Vec<String> = cast.members.iter().map(|member| member.name.clone()).collect();
        let style = Style { sketch: Sketch::default(), inset: true, ..shot.style };
        Some(Shot { layout: Layout::parse(view, &names).unwrap_or(shot.layout), style, ..shot })
    }

    fn picture(&mut self) {
        let size = (1920, 1080);
        let (Some(moment), Some(history)) = (self.desk.moment(), &self.desk.history) else { return };
        let time = self.desk.time();
        let Some(trail) = history.trail(self.desk.branch, time).cloned() else { return };
        let (cast, Some(shot)) = (Arc::clone(history.cast()), self.shot(&moment, size)) else { return };
        let path = free(Path::new("."), &self.name(), "png");
        let home =
            self.desk.draft.as_ref().map_or_else(String::new, |draft| draft.home().display().to_string());
        let texts = vec![
            ("Software", concat!("echelon ", env!("CARGO_PKG_VERSION")).to_owned()),
            ("Scene", self.desk.script().unwrap_or_default()),
            ("Home", home),
            ("Time", format!("{time:?}")),
            ("View", words_of(&shot.layout, &self.viewport.view)),
            ("Adapter", self.viewport.gpu().description()),
        ];
        self.studio.ask(Job::Picture {
            path,
            cast,
            size,
            trail: Box::new(trail),
            shot: Box::new(shot),
            texts,
        });
    }

    /// Writes a picture of the whole window.
    fn window_picture(&mut self) {
        let path = free(Path::new("."), &format!("{}-window", self.name()), "png");
        let (sender, ctx) = (self.words.0.clone(), self.ctx.clone());
        self.ctx.request_screenshot(move |image| {
            let [width, height] = image.size.map(|side| side as u32);
            let rgba = image.pixels.iter().flat_map(egui::Color32::to_array).collect();
            let picture = vocabulary::Picture { width, height, rgba };
            let texts = [("Software", concat!("echelon ", env!("CARGO_PKG_VERSION")))];
            let written = rendering::png::write(&path, &picture, &texts);
            // A window that is closed does not wait for it.
            let _ = sender.send(match written {
                Ok(()) => Ok(format!("Written: {}", path.display())),
                Err(error) => Err(error.to_string()),
            });
            ctx.request_repaint();
        });
    }

    /// Somebody ended the program from outside: unsaved work is put on disk and offered at the next start.
    fn interrupted(&mut self, ctx: &Context) {
        if let Some(draft) = self.desk.draft.take().filter(|draft| draft.unsaved())
            && let Err(why) = self.kept.keep(draft.text(), draft.path.as_deref())
        {
            self.desk.fault(why);
        }
        *self.ended.lock().unwrap_or_else(PoisonError::into_inner) = Some(Error::Interrupted);
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }

    fn begin_film(&mut self) {
        let time = self.desk.end();
        let branch = self.desk.branch;
        let Some(history) = &self.desk.history else { return };
        let Some(trail) = history.trail(branch, time).cloned() else { return };
        let cast = Arc::clone(history.cast());
        let path = free(Path::new("."), &self.name(), "mp4");
        self.studio.ask(Job::Begin { path: path.clone(), cast, size: (1280, 720), trail: Box::new(trail) });
        self.desk.note(format!("Filming to {}", path.display()));
        self.film = Some(Filming { path, next: time, branch, sent: time, frames: 0 });
    }

    fn end_film(&mut self) {
        if let Some(film) = self.film.take() {
            if film.frames == 0 {
                self.desk.note("Nothing was filmed: the run stood still");
            }
            self.studio.ask(Job::End);
        }
    }

    /// Frames of a film that are due, at even steps of simulated time whatever the window's pace.
    fn film_on(&mut self) {
        let Some(mut film) = self.film.take() else { return };
        let Some(history) = &self.desk.history else { return };
        if film.branch != self.desk.branch {
            film.branch = self.desk.branch;
            let time = history.end(film.branch);
            (film.next, film.sent) = (time, time);
            if let Some(trail) = history.trail(film.branch, time).cloned() {
                self.studio.ask(Job::Trail(Box::new(trail)));
            }
        }
        let end = history.end(film.branch);
        let mut jobs = Vec::new();
        while film.next <= end + 1e-9 {
            let Some(moment) = history.at(film.branch, film.next) else { break };
            jobs.push(Job::Moments(history.since(film.branch, [film.sent, film.next])));
            film.sent = film.next;
            if let Some(shot) = self.film_shot(&moment) {
                jobs.push(Job::Frame(Box::new(shot)));
                film.frames += 1;
            }
            film.next += self.desk.pace / RATE;
        }
        for job in jobs {
            self.studio.ask(job);
        }
        self.film = Some(film);
    }
}

impl eframe::App for Lab {
    fn logic(&mut self, ctx: &Context, _: &mut eframe::Frame) {
        self.hear();
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        for file in dropped {
            self.open(file.path());
        }
        if let Some(why) = self.viewport.gpu().lost() {
            let text = format!(
                "the graphics device is gone: {why}; unsaved work is kept and offered at the next start"
            );
            *self.ended.lock().unwrap_or_else(PoisonError::into_inner) = Some(Error::Window(text));
            self.desk.draft = None;
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
        if self.watch.stopped() {
            return self.interrupted(ctx);
        }
        let asked = ctx.input(|input| input.viewport().close_requested());
        let unsaved = self.desk.draft.as_ref().is_some_and(crate::session::draft::Draft::unsaved);
        if asked && unsaved {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.shows.closing = true;
        }
        self.send();
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        let began = Instant::now();
        let actions = self.show(ui);
        for action in actions {
            self.timings.asked(&action);
            self.act(action);
        }
        self.send();
        if !self.desk.orders.is_empty() || ui.ctx().input(|input| input.pointer.any_down()) {
            ui.ctx().request_repaint();
        }
        if self.viewport.rough() && !self.desk.playing {
            ui.ctx().request_repaint_after(Duration::from_millis(150));
        }
        self.timings.frame(began.elapsed(), frame.info().cpu_usage, self.viewport.pictures);
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        let memory = Memory {
            tree: Some(self.tree.clone()),
            recent: self.recent.clone(),
            hints_seen: !self.shows.hints,
            scale: Some(self.ctx.zoom_factor()),
        };
        eframe::set_value(storage, "memory", &memory);
    }

    fn on_exit(&mut self) {
        self.end_film();
        if self.print {
            self.timings.print(&self.desk);
        }
    }
}

/// Where a picture was taken from, in the words of `--view`.
fn words_of(layout: &rendering::Layout, named: &str) -> String {
    match layout.views.first() {
        Some(rendering::View::Fixed { eye, target, field_of_view }) => {
            let numbers = eye.iter().chain(target).map(|x| format!("{x:.4}")).collect::<Vec<_>>().join(",");
            format!("fixed:{numbers},{:.3}", field_of_view.to_degrees().clamp(5.0, 120.0))
        }
        _ => named.to_owned(),
    }
}

fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "scene".to_owned(), |stem| stem.to_string_lossy().into_owned())
}
