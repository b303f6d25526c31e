//! Scenes on disk: open, save, reload and recover; and runs that are kept.

use super::LabApp;
use super::capture::words_of;
use super::dialogs::Dialog;
use crate::app_state::sweep_plan::SweepPlan;
use crate::app_state::sweeping::SweepCommand;
use crate::autosave::discard;
#[cfg(not(target_family = "wasm"))]
use crate::kept_run::keep;
use crate::outlet::{self, free};
use crate::session::run_event::SeenRun;
use scene::Link;
use std::path::{Path, PathBuf};
use web_time::{Duration, Instant};

/// Recent scenes that are remembered.
#[cfg(not(target_family = "wasm"))]
const MOST_RECENT: usize = 8;
/// Interval between two autosaves.
const KEEP_EVERY: Duration = Duration::from_secs(1);

impl LabApp {
    pub(crate) fn open(&mut self, path: &Path) {
        if let Some(link) = path.to_str().filter(|text| Link::is_meant(text) && !path.exists()) {
            return self.open_link(link);
        }
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
            return self.open_picture(path);
        }
        if path.is_dir() || path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap")) {
            return self.open_recorded(path);
        }
        if let Some(shipped) = path.to_str().and_then(scene::shipped).filter(|_| !path.exists()) {
            return self.open_shipped(shipped.name);
        }
        self.open_file(path);
    }

    #[cfg(not(target_family = "wasm"))]
    fn open_file(&mut self, path: &Path) {
        match std::fs::read_to_string(path) {
            Ok(text) => {
                if self.take_scene(text, Some(path.to_owned()), path) {
                    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
                    self.recent.retain(|known| *known != path);
                    self.recent.insert(0, path);
                    self.recent.truncate(MOST_RECENT);
                }
            }
            Err(error) => self.app_state.fault(format!("{} cannot be read: {error}", path.display())),
        }
    }

    /// A page has no files: it is its address that names a scene.
    #[cfg(target_family = "wasm")]
    fn open_file(&mut self, path: &Path) {
        self.app_state
            .fault(format!("no scene `{}` comes with this page: Ctrl O lists them", path.display()));
    }

    /// Opens a recorded run: its log, or the folder that holds it.
    #[cfg(not(target_family = "wasm"))]
    fn open_recorded(&mut self, path: &Path) {
        use recording::log::{FILE, Log};
        let path = &if path.is_dir() { path.join(FILE) } else { path.to_owned() };
        let log = match Log::open(path) {
            Ok(log) => log,
            Err(error) => return self.app_state.fault(error.to_string()),
        };
        self.end_film();
        // The scene file may lie beside the log.
        if let Err(faults) = self.app_state.open_recorded(log, &path.with_file_name("scene.toml")) {
            return self.app_state.fault(faults);
        }
        self.app_state.notice = None;
        self.dialog = Dialog::Nothing;
        self.viewport.look("snake");
        self.file_watcher.look_at(None);
        self.app_state.note(format!("Opened the recording {}", path.display()));
    }

    /// Says who opens a recorded run.
    #[cfg(target_family = "wasm")]
    fn open_recorded(&mut self, path: &Path) {
        self.app_state.fault(format!("a page opens no recordings: `echelon lab {}` does", path.display()));
    }

    /// Opens a file whose bytes the browser has: `path` is its name.
    #[cfg(target_family = "wasm")]
    pub(crate) fn open_bytes(&mut self, path: &Path, bytes: Vec<u8>) {
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
            let texts = film::png::texts_of(&bytes, path);
            return self.restore_picture(path, texts);
        }
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mcap")) {
            return self.open_recorded(path);
        }
        match String::from_utf8(bytes) {
            Ok(text) => {
                self.take_scene(text, None, path);
            }
            Err(_) => self.app_state.fault(format!("{} is no scene: it is no text", path.display())),
        }
    }

    pub(crate) fn open_shipped(&mut self, name: &str) {
        if let Some(shipped) = scene::shipped(name) {
            self.take_scene(shipped.text.to_owned(), None, Path::new(&format!("{name}.toml")));
        }
    }

    /// Opens a link.
    fn open_link(&mut self, text: &str) {
        self.end_film();
        match self.app_state.open_link(text) {
            Ok(link) => self.dress_for(None, link.view.as_deref()),
            Err(faults) => self.app_state.fault(faults),
        }
    }

    /// Copies the link to the shown branch after `samples` samples, of which `digest` is that.
    pub(crate) fn copy_link(&mut self, samples: u64, digest: &str) {
        let Some(record) = self.app_state.record() else { return };
        let Some(fleet) = self.app_state.fleet() else { return };
        let view = words_of(&self.viewport.layout(fleet, &record), &self.viewport.view);
        match self.app_state.link_to(samples, digest, &view) {
            Ok(link) => {
                let text = outlet::share(&self.ctx, &link.to_string());
                self.app_state.shared(&link, text.chars().count());
            }
            Err(why) => self.app_state.fault(why),
        }
    }

    /// Copies the command that makes a sweep of the scene.
    pub(crate) fn copy_sweep(&mut self, plan: &SweepPlan) {
        let Some(SweepCommand { text, same }) = self.app_state.sweep_command(plan) else { return };
        self.ctx.copy_text(text.clone());
        let but = if same { "" } else { ". Save the scene first (Ctrl S): no file has all of it" };
        self.app_state.say(format!("Copied: {text}{but}"), false);
    }

    /// Writes a scene that repeats the shown branch.
    pub(crate) fn save_branch(&mut self) {
        let path = free(Path::new("."), &self.name(), "toml");
        let written = self.app_state.script().and_then(|text| outlet::write(&path, text.as_bytes()));
        match written {
            Ok(()) => {
                self.app_state.status = None;
                self.app_state.note(format!("Written: {}, which repeats the run", path.display()));
            }
            Err(why) => self.app_state.fault(why),
        }
    }

    /// Replaces the open scene; if the new one cannot be opened, the old one stays.
    pub(crate) fn take_scene(&mut self, text: String, path: Option<PathBuf>, home: &Path) -> bool {
        self.end_film();
        if let Err(faults) = self.app_state.open(text, path.clone(), home) {
            self.app_state.fault(faults);
            return false;
        }
        self.dress_for(path, None);
        true
    }

    /// Looks at a scene that was opened from `path`, from `view` or else as it says itself.
    fn dress_for(&mut self, path: Option<PathBuf>, view: Option<&str>) {
        self.app_state.notice = None;
        self.dialog = Dialog::Nothing;
        let own = self.app_state.scene().map(|scene| &*scene.views.default);
        self.viewport.look(view.or(own).unwrap_or("snake"));
        self.viewport.style.picture_in_picture = None;
        self.file_watcher.look_at(path);
    }

    /// Restores the scene, the time and the view that are embedded in a picture.
    pub(crate) fn open_picture(&mut self, path: &Path) {
        self.restore_picture(path, film::png::read_texts(path));
    }

    fn restore_picture(&mut self, path: &Path, texts: Result<Vec<(String, String)>, film::Error>) {
        let texts = match texts {
            Ok(texts) => texts,
            Err(error) => return self.app_state.fault(error.to_string()),
        };
        let of = |key: &str| texts.iter().find(|(known, _)| known == key).map(|(_, text)| text.clone());
        let Some(scene) = of("Scene") else {
            let text = format!("{} holds no scene: the lab did not write it", path.display());
            return self.app_state.fault(text);
        };
        let home = of("Home").map_or_else(|| path.to_owned(), PathBuf::from);
        if !self.take_scene(scene, None, &home) {
            return;
        }
        if let Some(time) = of("Time").and_then(|time| time.parse::<f64>().ok()).filter(|t| t.is_finite()) {
            self.app_state.playing = false;
            self.app_state.requests.clear();
            self.app_state.restart(time);
        }
        if let Some(view) = of("View") {
            self.viewport.look(&view);
        }
        self.app_state.note(format!("Restored from {}", path.display()));
    }

    pub(crate) fn save(&mut self, path: Option<PathBuf>) {
        let Some(draft) = &mut self.app_state.draft else { return };
        // A shipped scene is saved in the current folder.
        let own = || free(Path::new("."), &stem(draft.home()), "toml");
        let path = path.or_else(|| draft.path.clone()).unwrap_or_else(own);
        if path.exists() && draft.path.as_ref() != Some(&path) {
            let text = format!("{} exists already: choose another name, or remove it first", path.display());
            return self.app_state.fault(text);
        }
        match outlet::write(&path, draft.text().as_bytes()) {
            Ok(()) => {
                draft.saved_to(path.clone());
                self.autosave.done();
                self.app_state.notice = None;
                self.file_watcher.look_at(Some(path.clone()));
                self.app_state.note(format!("Saved: {}", path.display()));
            }
            Err(why) => self.app_state.fault(why),
        }
    }

    pub(crate) fn reload(&mut self) {
        let Some(path) = self.app_state.draft.as_ref().and_then(|draft| draft.path.clone()) else { return };
        match std::fs::read_to_string(&path) {
            Ok(text) => self.take_text("Reloaded from disk", text),
            Err(error) => self.app_state.fault(format!("{} cannot be read: {error}", path.display())),
        }
    }

    pub(crate) fn take_text(&mut self, what: &str, text: String) {
        let Some(draft) = &mut self.app_state.draft else { return };
        match draft.replace(what, text) {
            Ok(effect) => {
                if let Some(path) = draft.path.clone() {
                    draft.saved_to(path);
                }
                self.app_state.notice = None;
                self.app_state.take(what, &effect);
            }
            Err(faults) => self.app_state.fault(faults),
        }
    }

    pub(crate) fn changed_on_disk(&mut self) {
        if self.app_state.unsaved() {
            let text = "The file has changed on disk, and the lab has unsaved changes: Ctrl R loads the file, Ctrl S keeps yours.";
            self.app_state.fault(text);
        } else {
            self.reload();
        }
    }

    pub(crate) fn recover(&mut self) {
        let Some(left) = self.left.take() else { return };
        let saved = left.path.as_ref().and_then(|path| std::fs::read_to_string(path).ok());
        let text = saved.unwrap_or_else(|| left.text.clone());
        if self.take_scene(text, left.path.clone(), &left.home) {
            // The recovered text is an edit of the file, so that it can be undone.
            if let Some(draft) = &mut self.app_state.draft {
                if left.path.is_none() {
                    draft.never_saved();
                }
                match draft.replace("Recovered work", left.text.clone()) {
                    Ok(_) => self.app_state.restart(0.0),
                    Err(faults) => return self.app_state.fault(faults),
                }
            }
            discard(&left.file);
        }
    }

    pub(crate) fn forget(&mut self) {
        if let Some(left) = self.left.take() {
            discard(&left.file);
        }
    }

    pub(crate) fn write_curves(&mut self, ending: &str, text: &str) {
        let path = free(Path::new("."), &self.name(), ending);
        match outlet::write(&path, text.as_bytes()) {
            Ok(()) => self.app_state.note(format!("Written: {}", path.display())),
            Err(why) => self.app_state.fault(why),
        }
    }

    pub(crate) fn keep_run(&mut self, branch: usize, seen: SeenRun) {
        if branch != self.app_state.branch {
            return;
        }
        let text = match self.app_state.script() {
            Ok(text) => text,
            Err(why) => return self.app_state.fault(why),
        };
        self.write_run(text, seen);
    }

    /// Writes a run in the background.
    #[cfg(not(target_family = "wasm"))]
    fn write_run(&mut self, text: String, seen: SeenRun) {
        let home = self.app_state.draft.as_ref().map_or_else(PathBuf::new, |draft| draft.home().to_owned());
        let folder = free(Path::new("runs"), &format!("{}-lab", self.name()), "");
        let (sender, gpu, ctx) = (self.words.0.clone(), self.viewport.gpu.clone(), self.ctx.clone());
        self.app_state.note("Writing the run to disk");
        let work = move || {
            let word = keep(&text, &home, &folder, &seen, Some(&gpu));
            // A closing window does not wait for it.
            let _ = sender.send(word);
            ctx.request_repaint();
        };
        if let Err(error) = std::thread::Builder::new().name("keep".to_owned()).spawn(work) {
            self.app_state.fault(error.to_string());
        }
    }

    /// Downloads the scene of a run, with what the run came to in its first line.
    #[cfg(target_family = "wasm")]
    fn write_run(&mut self, text: String, seen: SeenRun) {
        let file = format!("{}-lab-001.toml", self.name());
        let came_to = format!("{}, digest {}", vocabulary::counted(seen.samples, "sample"), seen.digest);
        match outlet::write(Path::new(&file), format!("# {came_to}\n{text}").as_bytes()) {
            Ok(()) => self.app_state.note(format!("Downloaded: `echelon run {file}` repeats {came_to}")),
            Err(why) => self.app_state.fault(why),
        }
    }

    pub(crate) fn keep_work(&mut self) {
        let Some(draft) = &self.app_state.draft else { return };
        if !draft.unsaved() {
            return self.autosave.done();
        }
        let wait = KEEP_EVERY.saturating_sub(self.kept_at.elapsed());
        if !wait.is_zero() {
            return self.ctx.request_repaint_after(wait);
        }
        self.kept_at = Instant::now();
        if let Err(why) = self.autosave.keep(draft.text(), draft.path.as_deref(), draft.home()) {
            self.app_state.fault(why);
        }
    }

    pub(crate) fn name(&self) -> String {
        self.app_state.draft.as_ref().map_or_else(|| "scene".to_owned(), |draft| stem(draft.home()))
    }
}

fn stem(path: &Path) -> String {
    scene::scene_name(path)
}
