//! Pictures and films of the view.

use super::LabApp;
use crate::exporter::{ExportJob, ExportTarget, FrameSpec, RATE};
use crate::outlet::{self, free};
use eframe::egui;
use rendering::{Annotations, Style, ViewLayout};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use vocabulary::counted;

/// A film under way.
pub(crate) struct FilmCapture {
    path: PathBuf,
    /// Time of the next frame, s, and the branch.
    next: f64,
    branch: usize,
    /// Records up to this time have been sent, s.
    sent: f64,
    frames: u64,
}

impl FilmCapture {
    /// Its progress, in words.
    pub(crate) fn words(&self, waiting: usize) -> String {
        format!("{}: {}, {waiting} waiting", self.path.display(), counted(self.frames, "frame"))
    }
}

impl LabApp {
    /// The current view, for a picture of `size` pixels.
    pub(crate) fn shot(&self, record: &Arc<vocabulary::StepRecord>, size: [u32; 2]) -> Option<FrameSpec> {
        let fleet = self.app_state.fleet()?;
        let scale = (f64::from(size[1]) / 720.0).max(0.5);
        Some(FrameSpec {
            record: Arc::clone(record),
            layout: self.viewport.layout(fleet, record),
            style: self.viewport.annotated_style(&self.app_state, record, scale),
            words: self.app_state.words(),
        })
    }

    /// The frame of a film: the current view or the view chosen for films, without handles.
    pub(crate) fn film_shot(&self, record: &Arc<vocabulary::StepRecord>) -> Option<FrameSpec> {
        let shot = self.shot(record, [1280, 720])?;
        let Some(view) = &self.app_state.film_from else { return Some(shot) };
        let fleet = self.app_state.fleet()?;
        let names: Vec<String> = fleet.robots.iter().map(|member| member.name.clone()).collect();
        let style = Style { annotations: Annotations::default(), inset: true, ..shot.style };
        Some(FrameSpec { layout: ViewLayout::parse(view, &names).unwrap_or(shot.layout), style, ..shot })
    }

    pub(crate) fn picture(&mut self) {
        let size = [1920, 1080];
        let Some(record) = self.app_state.record() else { return };
        let (Some(fleet), Some(trail)) = (self.app_state.fleet(), self.app_state.trail()) else { return };
        let Some(shot) = self.shot(&record, size) else { return };
        let path = free(Path::new("."), &self.name(), "png");
        let home = self.app_state.draft.as_ref().map(|draft| draft.home().display().to_string());
        let texts = vec![
            ("Software", studies::PROGRAM.to_owned()),
            ("Scene", self.app_state.script().unwrap_or_default()),
            ("Home", home.unwrap_or_default()),
            ("Time", format!("{:?}", self.app_state.time())),
            ("View", words_of(&shot.layout, &self.viewport.view)),
            ("Adapter", self.viewport.gpu.description()),
        ];
        let target = ExportTarget { path, fleet: Arc::clone(fleet), size, trail: trail.clone() };
        let (target, shot) = (Box::new(target), Box::new(shot));
        self.exporter.ask(ExportJob::Picture { target, shot, texts });
    }

    /// Writes a picture of the whole window.
    pub(crate) fn window_picture(&mut self) {
        let path = free(Path::new("."), &format!("{}-window", self.name()), "png");
        let (sender, ctx) = (self.words.0.clone(), self.ctx.clone());
        self.ctx.request_screenshot(move |image| {
            let [width, height] = image.size.map(|side| side as u32);
            let rgba = image.pixels.iter().flat_map(egui::Color32::to_array).collect();
            let picture = vocabulary::Picture { width, height, rgba };
            let texts = [("Software", studies::PROGRAM)];
            let encoded = film::png::encode(&picture, &texts).map_err(|error| error.to_string());
            let written = encoded.and_then(|bytes| outlet::write(&path, &bytes));
            // A closing window does not wait for it.
            let _ = sender.send(written.map(|()| format!("Written: {}", path.display())));
            ctx.request_repaint();
        });
    }
    pub(crate) fn begin_film(&mut self) {
        let time = self.app_state.end();
        let branch = self.app_state.branch;
        let Some(history) = &self.app_state.history else { return };
        let Some(trail) = history.trail(branch, time).cloned() else { return };
        let fleet = Arc::clone(history.fleet());
        let path = free(Path::new("."), &self.name(), "mp4");
        let target = ExportTarget { path: path.clone(), fleet, size: [1280, 720], trail };
        self.exporter.ask(ExportJob::Begin(Box::new(target)));
        self.app_state.note(format!("Filming to {}", path.display()));
        let next = time + self.app_state.pace / RATE;
        self.film = Some(FilmCapture { path, next, branch, sent: time, frames: 0 });
    }

    pub(crate) fn end_film(&mut self) {
        if let Some(film) = self.film.take() {
            if film.frames == 0 {
                self.app_state.note("Nothing was filmed: the run was paused");
            }
            self.exporter.ask(ExportJob::End);
        }
    }

    /// Requests the frames of a film that are due, at even steps of simulated time at any pace.
    pub(crate) fn film_on(&mut self) {
        let Some(mut film) = self.film.take() else { return };
        let Some(history) = &self.app_state.history else { return };
        if film.branch != self.app_state.branch {
            film.branch = self.app_state.branch;
            let time = history.end(film.branch);
            (film.next, film.sent) = (time, time);
            if let Some(trail) = history.trail(film.branch, time).cloned() {
                self.exporter.ask(ExportJob::Trail(Box::new(trail)));
            }
        }
        let end = history.end(film.branch);
        while film.next <= end + 1e-9 {
            let Some(record) = history.at(film.branch, film.next) else { break };
            self.exporter.ask(ExportJob::Records(history.since(film.branch, [film.sent, film.next])));
            film.sent = film.next;
            if let Some(shot) = self.film_shot(&record) {
                self.exporter.ask(ExportJob::Frame(Box::new(shot)));
                film.frames += 1;
            }
            film.next += self.app_state.pace / RATE;
        }
        self.film = Some(film);
    }
}

/// The view of a picture, in the syntax of `--view`.
pub(super) fn words_of(layout: &rendering::ViewLayout, named: &str) -> String {
    match layout.views.first() {
        Some(rendering::Viewpoint::Fixed { eye, target, field_of_view }) => {
            let numbers = eye.iter().chain(target).map(|x| format!("{x:.4}")).collect::<Vec<_>>().join(",");
            format!("fixed:{numbers},{:.3}", field_of_view.to_degrees().clamp(5.0, 120.0))
        }
        _ => named.to_owned(),
    }
}
