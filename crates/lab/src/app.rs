//! The window itself: it hears news, shows panels, and does what is asked for.

use crate::Error;
use crate::action::Action;
use crate::desk::{Choice, Desk, Tool};
use crate::gallery::{self, Gallery};
use crate::keep::Seen;
use crate::kept::{Left, WorkKept, alive, left};
use crate::look;
use crate::over::Over;
use crate::panels::time_bar;
use crate::panes::{self, Pane, Panels};
use crate::quantities;
use crate::session::draft::Draft;
use crate::session::forecast::{Crystal, Forecast};
use crate::session::runner::{News, Order, Runner};
use crate::shots::Filming;
use crate::studio::{Studio, Told};
use crate::timing::Timing;
use crate::view::viewport::{DeskView, Viewport};
use crate::watch::Watch;
use crate::window::{NAME, Options};
use eframe::egui::{self, Context, Ui};
use egui_tiles::Tree;
use std::io::Write;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use vocabulary::counted;

/// The window.
pub(crate) struct Lab {
    pub(crate) desk: Desk,
    pub(crate) runner: Runner,
    pub(crate) forecasts: Receiver<Forecast>,
    pub(crate) viewport: Viewport,
    pub(crate) studio: Studio,
    pub(crate) tree: Tree<Pane>,
    pub(crate) gallery: Gallery,
    pub(crate) over: Over,
    pub(crate) hints: bool,
    title: String,
    /// What waits for an answer about unsaved work.
    pub(crate) next: Option<Action>,
    pub(crate) recent: Vec<PathBuf>,
    pub(crate) kept: WorkKept,
    pub(crate) kept_at: Instant,
    pub(crate) left: Option<Left>,
    pub(crate) watch: Watch,
    pub(crate) film: Option<Filming>,
    pub(crate) words: (Sender<Word>, Receiver<Word>),
    pub(crate) ctx: Context,
    pub(crate) ended: Arc<Mutex<Option<Error>>>,
    pub(crate) timings: Timing,
    pub(crate) print: bool,
}

/// A word from a thread: what was done, or why it could not be.
type Word = Result<String, String>;

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
        options: &Options,
        (began, ended): (Instant, Arc<Mutex<Option<Error>>>),
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
            over: Over::Nothing,
            hints: !memory.hints_seen,
            title: String::new(),
            next: None,
            recent: memory.recent,
            kept: WorkKept::new(folder.as_deref()),
            kept_at: Instant::now(),
            left: folder.as_deref().and_then(|folder| left(folder, alive)),
            watch: Watch::start(wake(), options.stop),
            film: None,
            words: channel(),
            ctx: ctx.clone(),
            ended,
            timings: Timing::since(began),
            print: options.timings,
        };
        if let Some([width, height]) = options.size {
            // A size that was asked for comes before the one that is remembered.
            ctx.send_viewport_cmd(egui::ViewportCommand::InnerSize(egui::vec2(width, height)));
        }
        lab.desk.playing = !options.paused;
        lab.desk.aloud = options.timings.then(std::io::stdout);
        lab.open_first(options);
        Ok(lab)
    }

    fn open_first(&mut self, options: &Options) {
        match &options.scene {
            Some(path) => self.open(path),
            None => self.open_shipped(gallery::FIRST),
        }
        if let Some(fault) = self.desk.notice.as_ref().filter(|_| self.desk.draft.is_none()) {
            // Whoever started it from a terminal looks there first.
            let _ = writeln!(std::io::stderr(), "error: {fault}");
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

    fn hear(&mut self) {
        while let Some(news) = self.runner.news() {
            match news {
                News::Told { branch, changes: _, samples, digest } => {
                    self.keep_run(branch, Seen { samples, digest });
                }
                News::Opened { .. } => {
                    // Another run, or the same from the start: a film goes forward only.
                    self.end_film();
                    self.desk.hear(news);
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
                Order::TakeUp { scene, .. } => {
                    Order::TakeUp { scene, gpu: Some(self.viewport.gpu().clone()) }
                }
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
        crate::keys::pressed(ui.ctx(), &self.desk, self.over != Over::Nothing, &mut out);
        let (branch, time) = (self.desk.branch, self.desk.time());
        if let Some(history) = &mut self.desk.history {
            history.prepare_trail(branch, time);
        }
        let filming = self.film.as_ref().map(|film| film.words(self.studio.waiting()));
        egui::Panel::top("time").frame(BARE).show(ui, |ui| {
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
                fleet: desk.history.as_ref().map_or(&empty, |history| history.fleet()),
                record: desk.shown(),
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
        let tree = &mut self.tree;
        egui::CentralPanel::default().frame(egui::Frame::new()).show(ui, |ui| {
            let room = ui.available_size();
            // In a window as small as a hand there is room for the view alone.
            if room.x < LEAST.x || room.y < LEAST.y {
                (panels.view)(ui, panels.out);
            } else {
                tree.ui(&mut panels, ui);
            }
        });
        self.windows(ui.ctx(), &mut out);
        out
    }

    fn act(&mut self, action: Action) {
        if self.desk.act(&action) {
            return;
        }
        match action {
            Action::Follow(robot) => self.viewport.follow(robot, &self.desk),
            Action::Viewpoint(view) => self.viewport.look(&view),
            Action::Inset(robot) => {
                let now = &mut self.viewport.style.picture_in_picture;
                *now = if *now == robot { None } else { robot };
                self.viewport.style.detections = now.is_some();
            }
            Action::Element(name, on) => {
                // The names are the panel's own.
                let _ = self.viewport.style.set(name, on);
            }
            Action::Open(_) | Action::OpenShipped(_) if self.unsaved() => {
                self.next = Some(action);
                self.over = Over::Leaving;
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
            Action::Film if self.desk.recorded => {
                self.desk.fault("A recorded run is filmed by: echelon replay RUN --film FILE");
            }
            Action::Film => self.begin_film(),
            Action::KeepRun if self.desk.recorded => self.desk.fault("This run is recorded already"),
            Action::KeepRun => self.desk.orders.push(Order::Tell(self.desk.branch)),
            Action::CurvesCsv => self.write_curves("csv", &quantities::csv(&self.desk)),
            Action::CurvesSvg => self.write_curves("svg", &quantities::svg(&self.desk)),
            Action::Panel(name) => panes::toggle(&mut self.tree, name),
            Action::Theme => {
                let dark = self.ctx.theme() == egui::Theme::Dark;
                self.ctx.set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
            }
            Action::Scale(scale) => self.ctx.set_zoom_factor(scale.clamp(0.5, 4.0)),
            Action::Help => self.toggle(Over::Help),
            Action::Gallery => self.toggle(Over::Gallery),
            Action::Dismiss => self.dismiss(),
            _ => {}
        }
    }

    pub(crate) fn unsaved(&self) -> bool {
        self.desk.draft.as_ref().is_some_and(Draft::unsaved)
    }

    /// The window is called as its scene.
    fn name_window(&mut self, ctx: &Context) {
        let title = self.desk.scene().map_or_else(String::new, |scene| scene.title.clone());
        if title != self.title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(format!("{title} — Echelon")));
            self.title = title;
        }
    }

    fn toggle(&mut self, over: Over) {
        self.over = if self.over == over { Over::Nothing } else { over };
    }

    fn dismiss(&mut self) {
        if self.over != Over::Nothing || self.hints {
            (self.over, self.hints) = (Over::Nothing, false);
        } else if self.desk.notice.is_some() {
            self.desk.notice = None;
        } else if self.desk.tool != Tool::Hand {
            self.desk.tool = Tool::Hand;
        } else {
            self.desk.choice = Choice::Nothing;
        }
    }

    /// Somebody ended the program from outside: unsaved work is put on disk and offered at the next start.
    fn interrupted(&mut self, ctx: &Context) {
        if let Some(draft) = self.desk.draft.take().filter(Draft::unsaved)
            && let Err(why) = self.kept.keep(draft.text(), draft.path.as_deref())
        {
            self.desk.fault(why);
        }
        *self.ended.lock().unwrap_or_else(PoisonError::into_inner) = Some(Error::Interrupted);
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }
}

/// The window is cleared in the colour of panels; to paint it once more costs as much as the robots on a processor.
pub(crate) const BARE: egui::Frame =
    egui::Frame { inner_margin: egui::Margin::symmetric(6, 2), ..egui::Frame::NONE };

/// Room for panels, points.
const LEAST: egui::Vec2 = egui::vec2(560.0, 340.0);

impl eframe::App for Lab {
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn logic(&mut self, ctx: &Context, _: &mut eframe::Frame) {
        self.hear();
        let passed = ctx.input(|input| f64::from(input.stable_dt.min(0.1)));
        if self.desk.roll(passed) {
            ctx.request_repaint();
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        for file in dropped {
            self.act(Action::Open(file.path().to_owned()));
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
        self.name_window(ctx);
        let asked = ctx.input(|input| input.viewport().close_requested());
        if asked && self.unsaved() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.over = Over::Closing;
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
            hints_seen: !self.hints,
            scale: Some(self.ctx.zoom_factor()),
        };
        eframe::set_value(storage, "memory", &memory);
    }

    fn on_exit(&mut self) {
        self.end_film();
        if self.studio.waiting() > 1 {
            // Where nobody reads it, the film is finished all the same.
            let _ = writeln!(
                std::io::stderr(),
                "finishing the film: {} to draw",
                counted(self.studio.waiting(), "frame")
            );
        }
        if self.print {
            self.timings.print(&self.desk);
        }
    }
}
