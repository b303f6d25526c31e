//! A bar with the time left on a terminal; elsewhere a line at the start of long jobs and one every ten seconds.

use crate::print::{harmless, note};
use indicatif::{ProgressBar, ProgressStyle};
use std::cell::Cell;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Progress of one job.
pub(crate) enum Progress {
    Nothing,
    Bar(ProgressBar),
    Lines { steps: u64, told: Cell<Instant> },
}

/// Between two lines where there is no terminal.
const PAUSE: Duration = Duration::from_secs(10);

impl Progress {
    /// Begins a job of `steps` steps; silent where `quiet`.
    pub(crate) fn begin(what: &str, steps: u64, quiet: bool) -> Self {
        if quiet {
            return Self::Nothing;
        }
        if !std::io::stderr().is_terminal() {
            note(&format!("{what} …"));
            return Self::Lines { steps, told: Cell::new(Instant::now()) };
        }
        let bar = ProgressBar::new(steps).with_message(harmless(what).into_owned());
        if let Ok(style) = ProgressStyle::with_template("{msg} [{bar:30}] {percent:>3} %  {eta} left") {
            bar.set_style(style.progress_chars("━╸─"));
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self::Bar(bar)
    }

    /// What the job is, where that has changed.
    pub(crate) fn says(&self, what: &str) {
        if let Self::Bar(bar) = self {
            bar.set_message(harmless(what).into_owned());
        }
    }

    /// Where the job is.
    pub(crate) fn at(&self, step: u64) {
        match self {
            Self::Nothing => {}
            Self::Bar(bar) => bar.set_position(step),
            Self::Lines { steps, told } => {
                if told.get().elapsed() >= PAUSE {
                    told.set(Instant::now());
                    note(&format!("{step} of {steps}"));
                }
            }
        }
    }
}

impl Drop for Progress {
    /// Takes the bar away.
    fn drop(&mut self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}
