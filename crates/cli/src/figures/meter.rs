//! How far the whole job is: samples, frames and figures on one bar.

use super::drawn::FilmedRun;
use super::{FiguresArgs, Subject};
use crate::progress::Progress;
use studies::SceneRun;
use vocabulary::counted;

/// What a frame of a film and a figure weigh in samples of a few robots.
const FRAME: u64 = 120;
const FIGURE: u64 = 300;
/// Figures, about.
const FIGURES: u64 = 14;
/// Samples between two looks at the bar.
const STRIDE: u64 = 64;

/// ", 3 films", or nothing.
pub(super) fn films(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => ", a film".to_owned(),
        count => format!(", {count} films"),
    }
}

/// The bar, and what has been done.
pub(super) struct Meter {
    progress: Progress,
    done: u64,
    samples: u64,
    frames: u64,
    figures: u64,
}

impl Meter {
    pub(super) fn begin(
        args: &FiguresArgs,
        subject: &Subject,
        runs: &[SceneRun],
        shows: &[FilmedRun],
    ) -> Self {
        let frames: u64 = shows.iter().map(FilmedRun::frames).sum();
        let samples: u64 = runs.iter().map(|run| run.simulation.len()).sum();
        let of = subject.own.as_ref().map_or("the paper", |(_, name)| name.as_str());
        let films = films(shows.len());
        let what = format!("Figures of {of}: {}{films}", counted(runs.len(), "run"));
        let all = samples + FRAME * frames + FIGURE * FIGURES;
        let progress = Progress::begin(&what, all, args.quiet || args.json);
        Self { progress, done: 0, samples: 0, frames: 0, figures: 0 }
    }

    pub(super) fn sample(&mut self) {
        self.samples += 1;
        self.done += 1;
        if self.samples.is_multiple_of(STRIDE) {
            self.progress.at(self.done);
        }
    }

    pub(super) fn frame(&mut self) {
        self.frames += 1;
        self.done += FRAME;
        self.progress.at(self.done);
    }

    pub(super) fn figure(&mut self) {
        self.figures += 1;
        self.done += FIGURE;
        self.progress.at(self.done);
    }

    /// What has been done, in words.
    pub(super) fn so_far(&self) -> String {
        match (self.frames, self.figures) {
            (0, 0) => format!("after {} of the runs", counted(self.samples, "sample")),
            (frames, 0) => format!("after all runs and {}", counted(frames, "frame")),
            (_, figures) => format!("after all runs, with {} written", counted(figures, "figure")),
        }
    }
}
