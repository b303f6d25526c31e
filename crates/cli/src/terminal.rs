//! A terminal that waits for pictures.

use crate::interrupt;
use crate::print::note;
use crate::progress::Progress;
use crate::replaced::Replaced;
use footage::Audience;
use std::cell::RefCell;
use std::path::Path;

/// A terminal that waits for pictures.
pub(crate) struct Terminal {
    quiet: bool,
    progress: RefCell<Progress>,
    replaced: RefCell<Replaced>,
}

impl Terminal {
    /// Prints errors and what went otherwise only where it is `quiet`.
    pub(crate) fn new(quiet: bool) -> Self {
        Self { quiet, progress: RefCell::new(Progress::Nothing), replaced: RefCell::default() }
    }

    /// Says which files were replaced.
    pub(crate) fn tell_replaced(&self) {
        self.replaced.borrow().tell(self.quiet);
    }
}

impl Audience for Terminal {
    fn note(&self, text: &str) {
        note(text);
    }

    fn remark(&self, text: &str) {
        if !self.quiet {
            note(text);
        }
    }

    fn about(&self, option: &str, text: &str) {
        self.remark(&format!("--{} {text}", option.replace('_', "-")));
    }

    fn begin(&self, what: &str, steps: u64) {
        *self.progress.borrow_mut() = Progress::begin(what, steps, self.quiet);
    }

    fn at(&self, step: u64) {
        self.progress.borrow().at(step);
    }

    fn end(&self) {
        *self.progress.borrow_mut() = Progress::Nothing;
    }

    fn stops(&self) -> bool {
        interrupt::asked()
    }

    fn writes(&self, path: &Path) {
        self.replaced.borrow_mut().look(path);
    }
}
