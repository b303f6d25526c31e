//! The window itself: it receives events, shows panels and carries out actions.

mod capture;
mod dialogs;
mod files;

use self::capture::FilmCapture;
use self::dialogs::Dialog;
use crate::Error;
use crate::action::Action;
use crate::app_state::{AppState, Selection, Tool};
use crate::autosave::{Autosave, RecoverableWork};
use crate::background::{Next, SHARE};
use crate::exporter::{ExportEvent, Exporter};
use crate::file_watcher::FileWatcher;
use crate::frame_timings::FrameTimings;
use crate::gallery::{self, Gallery};
use crate::options::Options;
use crate::panels::time_bar;
use crate::panes::{self, Pane, Panels};
use crate::quantities;
use crate::session::prediction::{Prediction, Predictor};
use crate::session::run_event::SeenRun;
use crate::session::runner::{RunEvent, RunRequest, Runner};
use crate::session::scene_draft::SceneDraft;
use crate::session::sweeper::Sweeper;
use crate::theme;
use crate::view::viewport::Viewport;
use eframe::egui::{self, Context, Ui};
use egui_tiles::Tree;
use std::io::Write;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use vocabulary::counted;
use web_time::{Duration, Instant};

/// The window.
pub(crate) struct LabApp {
    pub(crate) app_state: AppState,
    pub(crate) runner: Runner,
    pub(crate) predictions: Receiver<Prediction>,
    pub(crate) viewport: Viewport,
    pub(crate) exporter: Exporter,
    pub(crate) sweeper: Sweeper,
    pub(crate) tree: Tree<Pane>,
    pub(crate) gallery: Gallery,
    pub(crate) dialog: Dialog,
    pub(crate) hints: bool,
    title: String,
    /// The action that waits for the answer about unsaved changes.
    pub(crate) next: Option<Action>,
    pub(crate) recent: Vec<PathBuf>,
    pub(crate) autosave: Autosave,
    pub(crate) kept_at: Instant,
    pub(crate) left: Option<RecoverableWork>,
    pub(crate) file_watcher: FileWatcher,
    pub(crate) film: Option<FilmCapture>,
    pub(crate) words: (Sender<Word>, Receiver<Word>),
    /// Dropped files that the browser has read.
    #[cfg(target_family = "wasm")]
    dropped: (Sender<DroppedBytes>, Receiver<DroppedBytes>),
    pub(crate) ctx: Context,
    pub(crate) ended: Arc<Mutex<Option<Error>>>,
    pub(crate) timings: FrameTimings,
    pub(crate) print: bool,
}

/// What the window remembers between sessions.
#[derive(serde::Serialize, serde::Deserialize, Default)]
struct Memory {
    tree: Option<Tree<Pane>>,
    recent: Vec<PathBuf>,
    hints_seen: bool,
    scale: Option<f32>,
}

/// A message from a thread: what was done, or why it failed.
type Word = Result<String, String>;

/// A file that the browser has read: its name and its bytes, or why it cannot be read.
#[cfg(target_family = "wasm")]
type DroppedBytes = (PathBuf, Result<Vec<u8>, String>);

impl LabApp {
    /// The window, with where it keeps unsaved work and what was left of that.
    pub(crate) fn new(
        context: &eframe::CreationContext<'_>,
        options: &Options,
        autosave: Autosave,
        left: Option<RecoverableWork>,
        began: Instant,
        ended: Arc<Mutex<Option<Error>>>,
    ) -> Result<Self, String> {
        let state = context.wgpu_render_state.as_ref().ok_or("there is no graphics device")?;
        let ctx = context.egui_ctx.clone();
        theme::apply(&ctx);
        let wake = || {
            let ctx = ctx.clone();
            move || ctx.request_repaint()
        };
        let (predictor, predictions) = Predictor::start(wake());
        let viewport = Viewport::new(state);
        let memory: Memory =
            context.storage.and_then(|storage| eframe::get_value(storage, "memory")).unwrap_or_default();
        ctx.set_zoom_factor(memory.scale.unwrap_or(1.0).clamp(0.5, 4.0));
        // A page cannot wait for pictures to come back.
        let eyes = (!cfg!(target_family = "wasm")).then(|| viewport.gpu.clone());
        let mut lab = Self {
            app_state: AppState::new(),
            runner: Runner::start(predictor, eyes, wake()),
            predictions,
            exporter: Exporter::start(viewport.gpu.clone(), wake()),
            sweeper: Sweeper::new(wake()),
            viewport,
            tree: memory.tree.filter(panes::sound).unwrap_or_else(panes::arrangement),
            gallery: Gallery::default(),
            dialog: Dialog::Nothing,
            hints: !memory.hints_seen,
            title: String::new(),
            next: None,
            recent: memory.recent,
            autosave,
            kept_at: Instant::now(),
            left,
            file_watcher: FileWatcher::start(wake(), options.stop),
            film: None,
            words: channel(),
            #[cfg(target_family = "wasm")]
            dropped: channel(),
            ctx: ctx.clone(),
            ended,
            timings: FrameTimings::since(began),
            print: options.timings,
        };
        if let Some([width, height]) = options.size {
            // A requested size takes precedence over the remembered one.
            ctx.send_viewport_cmd(egui::ViewportCommand::InnerSize(egui::vec2(width, height)));
        }
        lab.app_state.playing = !options.paused;
        lab.app_state.aloud = options.timings.then(std::io::stdout);
        lab.open_first(options);
        Ok(lab)
    }

    fn open_first(&mut self, options: &Options) {
        match &options.scene {
            Some(path) => self.open(path),
            None => self.open_shipped(gallery::FIRST),
        }
        if let Some(fault) = self.app_state.notice.as_ref().filter(|_| self.app_state.draft.is_none()) {
            // Users who start it from a terminal look there first.
            let _ = writeln!(std::io::stderr(), "error: {fault}");
        }
        if !options.set.is_empty() && self.app_state.draft.is_some() {
            let set = options.set.clone();
            self.app_state.edit("Changes from the command line", |text| {
                set.iter().try_for_each(|set| {
                    let (path, value) = set.parts();
                    text.set(path, value)
                })
            });
        }
    }

    fn poll_events(&mut self) {
        while let Some(run_event) = self.runner.next_event() {
            match run_event {
                RunEvent::Summary { branch, changes: _, samples, digest } => {
                    self.keep_run(branch, SeenRun { samples, digest });
                }
                RunEvent::Digest { branch, samples, digest } if branch == self.app_state.branch => {
                    self.copy_link(samples, &digest);
                }
                RunEvent::Opened { .. } => {
                    // Another run, or the same from the start: time in a film only increases.
                    self.end_film();
                    self.app_state.handle_event(run_event);
                }
                run_event => self.app_state.handle_event(run_event),
            }
        }
        while let Ok(prediction) = self.predictions.try_recv() {
            self.timings.prediction(&prediction);
            if prediction.branch == self.app_state.branch && self.app_state.ahead > 0.0 {
                self.app_state.prediction = Some(prediction);
            }
        }
        while let Some(event) = self.sweeper.next_event() {
            self.app_state.handle_sweep_event(event);
        }
        while let Some(told) = self.exporter.next_event() {
            match told {
                ExportEvent::Written(path) => self.app_state.note(format!("Written: {}", path.display())),
                ExportEvent::Failed(why) => {
                    self.film = None;
                    self.app_state.fault(why);
                }
            }
        }
        while let Ok(word) = self.words.1.try_recv() {
            match word {
                Ok(text) => self.app_state.note(text),
                Err(text) => self.app_state.fault(text),
            }
        }
        if self.file_watcher.changed() {
            self.changed_on_disk();
        }
        self.film_on();
        self.keep_work();
    }

    /// Sends the pending requests of the state.
    fn send(&mut self) {
        for request in self.app_state.requests.drain(..) {
            self.runner.request(request);
        }
        for request in self.app_state.sweep.requests.drain(..) {
            self.sweeper.request(&request);
        }
    }

    /// Gives the work beside the window its share of the frame, where it has no threads.
    fn tick(&mut self) {
        let next = self.runner.tick(SHARE).min(self.exporter.tick(SHARE)).min(self.sweeper.tick(SWEEP_SHARE));
        if let Next::After(time) = next {
            self.ctx.request_repaint_after(time);
        }
    }

    /// Opens files that were dropped on the window, and links that are pasted.
    #[cfg(not(target_family = "wasm"))]
    fn take_dropped(&mut self, ctx: &Context) {
        for text in pasted(ctx).into_iter().filter(|text| scene::Link::is_meant(text)) {
            self.act(Action::Open(text.into()));
        }
        for file in ctx.input(|input| input.raw.dropped_files.clone()) {
            self.act(Action::Open(file.path().to_owned()));
        }
    }

    /// Opens files that were dropped on the page, once the browser has read them, and scenes whose text is pasted.
    #[cfg(target_family = "wasm")]
    fn take_dropped(&mut self, ctx: &Context) {
        for file in ctx.input(|input| input.raw.dropped_files.clone()) {
            let (sender, ctx) = (self.dropped.0.clone(), ctx.clone());
            wasm_bindgen_futures::spawn_local(async move {
                // A page that is left does not wait for it.
                let _ = sender.send((file.path().to_owned(), file.bytes_async().await));
                ctx.request_repaint();
            });
        }
        for text in pasted(ctx) {
            self.act(match scene::Link::is_meant(&text) {
                true => Action::Open(text.into()),
                false => Action::OpenBytes("pasted.toml".into(), text.into_bytes()),
            });
        }
        while let Ok((name, bytes)) = self.dropped.1.try_recv() {
            match bytes {
                Ok(bytes) => self.act(Action::OpenBytes(name, bytes)),
                Err(why) => self.app_state.fault(format!("{} cannot be read: {why}", name.display())),
            }
        }
    }

    fn show(&mut self, ui: &mut Ui) -> Vec<Action> {
        let mut out = Vec::new();
        crate::keys::pressed(ui.ctx(), &self.app_state, self.dialog != Dialog::Nothing, &mut out);
        let (branch, time) = (self.app_state.branch, self.app_state.time());
        if let Some(history) = &mut self.app_state.history {
            history.prepare_trail(branch, time);
        }
        let filming = self.film.as_ref().map(|film| film.words(self.exporter.waiting()));
        egui::Panel::top("time").frame(BARE).show(ui, |ui| {
            ui.add_space(3.0);
            time_bar::show(ui, &self.app_state, filming.is_some(), &mut out);
            ui.add_space(3.0);
        });
        self.notices(ui, &mut out);
        self.status(ui, &mut out);
        let app_state = &self.app_state;
        let style = self.viewport.style.clone();
        let view_tile = Pane::named("View").and_then(|pane| self.tree.tiles.find_pane(&pane));
        let viewport = &mut self.viewport;
        let mut view = |ui: &mut Ui, out: &mut Vec<Action>| {
            viewport.show(ui, app_state, out);
        };
        let mut panels = Panels {
            app_state,
            style: &style,
            filming: filming.as_deref(),
            view: &mut view,
            view_tile,
            out: &mut out,
        };
        let tree = &mut self.tree;
        egui::CentralPanel::default().frame(egui::Frame::new()).show(ui, |ui| {
            let room = ui.available_size();
            if room.x >= LEAST.x && room.y >= LEAST.y {
                tree.ui(&mut panels, ui);
            } else if room.y >= LEAST.y {
                panels.stacked(ui);
            } else {
                // A tiny window has room for the view only.
                (panels.view)(ui, panels.out);
            }
        });
        self.windows(ui.ctx(), &mut out);
        out
    }

    fn act(&mut self, action: Action) {
        if self.app_state.act(&action) {
            return;
        }
        match action {
            Action::Follow(robot) => self.viewport.follow(robot, &self.app_state),
            Action::Viewpoint(view) => self.viewport.look(&view),
            Action::Inset(robot) => {
                let now = &mut self.viewport.style.picture_in_picture;
                *now = if *now == robot { None } else { robot };
                self.viewport.style.detections = now.is_some();
            }
            Action::Element(name, on) => {
                // The names are those of the panel.
                let _ = self.viewport.style.set(name, on);
            }
            Action::Open(_) | Action::OpenShipped(_) if self.app_state.unsaved() => self.ask_first(action),
            #[cfg(target_family = "wasm")]
            Action::OpenBytes(..) if self.app_state.unsaved() => self.ask_first(action),
            #[cfg(target_family = "wasm")]
            Action::OpenBytes(name, bytes) => self.open_bytes(&name, bytes),
            Action::Open(path) => self.open(&path),
            Action::OpenShipped(name) => self.open_shipped(name),
            Action::Save => self.save(None),
            Action::SaveAs(path) => self.save(Some(path)),
            Action::Reload => self.reload(),
            Action::Recover => self.recover(),
            Action::Forget => self.forget(),
            Action::CopySweep(plan) => self.copy_sweep(&plan),
            Action::SaveBranch => self.save_branch(),
            Action::CloseStatus => self.app_state.status = None,
            Action::Picture => self.picture(),
            Action::WindowPicture => self.window_picture(),
            Action::Film if self.film.is_some() => self.end_film(),
            Action::Film if self.app_state.recorded => {
                self.app_state.fault("To film a recorded run, use: echelon replay RUN --film FILE");
            }
            Action::Film => self.begin_film(),
            Action::KeepRun if self.app_state.recorded => {
                self.app_state.fault("This run is a recording already");
            }
            Action::KeepRun => self.app_state.requests.push(RunRequest::Summarize(self.app_state.branch)),
            Action::CurvesCsv => self.write_curves("csv", &quantities::csv(&self.app_state)),
            Action::CurvesSvg => self.write_curves("svg", &quantities::svg(&self.app_state)),
            Action::Panel(name) => panes::toggle(&mut self.tree, name),
            Action::ShowPanel(name) => panes::bring(&mut self.tree, name),
            Action::Theme => {
                let dark = self.ctx.theme() == egui::Theme::Dark;
                self.ctx.set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
            }
            Action::Scale(scale) => self.ctx.set_zoom_factor(scale.clamp(0.5, 4.0)),
            Action::Help => self.toggle(Dialog::Help),
            Action::Gallery => self.toggle(Dialog::Gallery),
            Action::Dismiss => self.dismiss(),
            _ => {}
        }
    }

    /// Asks what to do with unsaved changes before an action.
    fn ask_first(&mut self, action: Action) {
        self.next = Some(action);
        self.dialog = Dialog::Leaving;
    }

    /// Sets the window's title to that of its scene.
    fn name_window(&mut self, ctx: &Context) {
        let title = self.app_state.scene().map_or_else(String::new, |scene| scene.title.clone());
        if title != self.title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(format!("{title} — Echelon")));
            self.title = title;
        }
    }

    fn toggle(&mut self, dialog: Dialog) {
        self.dialog = if self.dialog == dialog { Dialog::Nothing } else { dialog };
    }

    fn dismiss(&mut self) {
        if self.dialog != Dialog::Nothing || self.hints {
            (self.dialog, self.hints) = (Dialog::Nothing, false);
        } else if self.app_state.notice.is_some() {
            self.app_state.notice = None;
        } else if self.app_state.status.is_some() {
            self.app_state.status = None;
        } else if self.app_state.tool != Tool::Select {
            self.app_state.tool = Tool::Select;
        } else {
            self.app_state.selection = Selection::Nothing;
        }
    }

    /// The program was terminated from outside: writes unsaved work, which the next start offers.
    fn interrupted(&mut self, ctx: &Context) {
        if let Some(draft) = self.app_state.draft.take().filter(SceneDraft::unsaved)
            && let Err(why) = self.autosave.keep(draft.text(), draft.path.as_deref(), draft.home())
        {
            self.app_state.fault(why);
        }
        self.end(ctx, Error::Interrupted);
    }

    /// Closes the window and keeps the reason.
    fn end(&self, ctx: &Context, why: Error) {
        *self.ended.lock().unwrap_or_else(PoisonError::into_inner) = Some(why);
        ctx.send_viewport_cmd(egui::ViewportCommand::Close);
    }
}

/// Texts that are pasted into none of the fields.
fn pasted(ctx: &Context) -> Vec<String> {
    if ctx.egui_wants_keyboard_input() {
        return vec![];
    }
    let pasted = |event: &egui::Event| match event {
        egui::Event::Paste(text) => Some(text.clone()),
        _ => None,
    };
    ctx.input(|input| input.events.iter().filter_map(pasted).collect())
}

/// Computing time of sweeps in a frame, where there are no threads: the run that is shown comes first.
const SWEEP_SHARE: Duration = Duration::from_millis(5);

/// The window is cleared in the colour of panels. On a CPU, painting it again would cost as much as the robots.
pub(crate) const BARE: egui::Frame =
    egui::Frame { inner_margin: egui::Margin::symmetric(6, 2), ..egui::Frame::NONE };

/// Size of the panel area, points.
const LEAST: egui::Vec2 = egui::vec2(560.0, 340.0);

impl eframe::App for LabApp {
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn logic(&mut self, ctx: &Context, _: &mut eframe::Frame) {
        self.tick();
        self.poll_events();
        let passed = ctx.input(|input| f64::from(input.stable_dt.min(0.1)));
        if self.app_state.roll(passed) {
            ctx.request_repaint();
        }
        self.take_dropped(ctx);
        #[cfg(target_family = "wasm")]
        crate::page::show_state(&self.app_state, self.left.is_some());
        if let Some(why) = self.viewport.gpu.lost() {
            let text = format!("the graphics device was lost: {why}; the next start offers unsaved work");
            self.app_state.draft = None;
            self.end(ctx, Error::Window(text));
        }
        if self.file_watcher.stopped() {
            return self.interrupted(ctx);
        }
        self.name_window(ctx);
        let asked = ctx.input(|input| input.viewport().close_requested());
        if asked && self.app_state.unsaved() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.dialog = Dialog::Closing;
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
        if !self.app_state.requests.is_empty() || ui.ctx().input(|input| input.pointer.any_down()) {
            ui.ctx().request_repaint();
        }
        if self.viewport.rough() && !self.app_state.playing {
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
        if self.exporter.waiting() > 1 {
            // Without a reader the film is finished all the same.
            let _ = writeln!(
                std::io::stderr(),
                "finishing the film: {} to draw",
                counted(self.exporter.waiting(), "frame")
            );
        }
        if self.print {
            self.timings.print(&self.app_state);
        }
    }
}
