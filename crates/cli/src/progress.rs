//! A bar with the time left on a terminal; elsewhere a line at the start of long jobs and one every ten seconds.

use crate::print::{harmless, note};
use indicatif::{ProgressBar, ProgressStyle};
use std::cell::{Cell, RefCell};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Progress of one job.
pub(crate) enum Progress {
    Nothing,
    Bar(ProgressBar),
    Lines { steps: u64, told: Cell<Instant>, more: RefCell<String> },
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
            return Self::Lines { steps, told: Cell::new(Instant::now()), more: RefCell::default() };
        }
        let bar = ProgressBar::new(steps).with_message(harmless(what).into_owned());
        if let Ok(style) = ProgressStyle::with_template("{msg} [{bar:30}] {percent:>3} %  {eta} left") {
            bar.set_style(style.progress_chars("━╸─"));
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self::Bar(bar)
    }

    /// What has become of the job so far, besides where it is; `what` is what it was begun with.
    pub(crate) fn says(&self, what: &str, more: &str) {
        match self {
            Self::Nothing => {}
            Self::Bar(bar) => bar.set_message(harmless(&format!("{what}, {more}")).into_owned()),
            Self::Lines { more: said, .. } => more.clone_into(&mut said.borrow_mut()),
        }
    }

    /// Where the job is.
    pub(crate) fn at(&self, step: u64) {
        match self {
            Self::Nothing => {}
            Self::Bar(bar) => bar.set_position(step),
            Self::Lines { steps, told, more } => {
                if told.get().elapsed() >= PAUSE {
                    told.set(Instant::now());
                    let more = more.borrow();
                    let more = if more.is_empty() { String::new() } else { format!(", {more}") };
                    note(&format!("{step} of {steps}{more}"));
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
