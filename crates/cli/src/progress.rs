//! A bar with the time left on a terminal; elsewhere a line at the start of long jobs.

use crate::print::note;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::Duration;

/// Progress of one job.
pub(crate) struct Progress(Option<ProgressBar>);

impl Progress {
    /// Begins a job of `steps` steps; silent where `quiet`.
    pub(crate) fn begin(what: &str, steps: u64, quiet: bool) -> Self {
        if quiet {
            return Self(None);
        }
        if !std::io::stderr().is_terminal() {
            note(&format!("{what} …"));
            return Self(None);
        }
        let bar = ProgressBar::new(steps).with_message(what.to_owned());
        if let Ok(style) = ProgressStyle::with_template("{msg} [{bar:30}] {percent:>3} %  {eta} left") {
            bar.set_style(style.progress_chars("━╸─"));
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(Some(bar))
    }

    /// Where the job is.
    pub(crate) fn at(&self, step: u64) {
        if let Some(bar) = &self.0 {
            bar.set_position(step);
        }
    }

    /// Ends the job and takes the bar away.
    pub(crate) fn end(self) {
        drop(self);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
