//! Pictures and films from Python: the one who waits for them is a [`Watch`].

use crate::arguments::{Names, Size};
use crate::error::RenderingError;
use crate::watch::Watch;
use footage::{Audience, PictureOptions};
use pyo3::exceptions::{PyKeyboardInterrupt, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use std::cell::Cell;
use std::ffi::CString;
use std::path::Path;
use std::sync::Mutex;

/// Tells a watch how far pictures are, and keeps what is to be said for afterwards.
pub(crate) struct Viewer<'a> {
    watch: &'a Watch,
    done: Cell<u64>,
    notes: &'a Mutex<Vec<String>>,
}

impl<'a> Viewer<'a> {
    /// What is said goes to `notes`.
    pub(crate) fn new(watch: &'a Watch, notes: &'a Mutex<Vec<String>>) -> Self {
        Self { watch, done: Cell::new(0), notes }
    }
}

impl Audience for Viewer<'_> {
    fn note(&self, text: &str) {
        if let Ok(mut notes) = self.notes.lock() {
            notes.push(text.to_owned());
        }
    }

    fn remark(&self, text: &str) {
        self.note(text);
    }

    fn about(&self, option: &str, text: &str) {
        self.note(&format!("{option} {text}"));
    }

    fn begin(&self, _what: &str, steps: u64) {
        self.watch.expect(steps);
    }

    fn at(&self, step: u64) {
        self.done.set(step);
    }

    fn end(&self) {}

    fn stops(&self) -> bool {
        !self.watch.goes_on(self.done.get())
    }

    fn writes(&self, _path: &Path) {}
}

/// Warns of what was noted.
pub(crate) fn warn(py: Python<'_>, notes: Mutex<Vec<String>>) -> PyResult<()> {
    for note in notes.into_inner().unwrap_or_default() {
        // A note holds no zero bytes but those of a name in a scene.
        let text = CString::new(note.replace('\0', " ")).unwrap_or_default();
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    Ok(())
}

/// Why there are no pictures, as an exception; what a law raised on the way comes first.
pub(crate) fn of_footage(error: &footage::Error) -> PyErr {
    if let Some(raised) = crate::law::raised() {
        return raised;
    }
    let text = error.to_string();
    match error {
        footage::Error::Usage(_) => PyValueError::new_err(text),
        footage::Error::Broken(_) => crate::error::RunError::new_err(text),
        footage::Error::Machine(_) => RenderingError::new_err(text),
        footage::Error::Output { error, kept } => crate::error::of_output(error, kept.as_deref()),
        footage::Error::Interrupted(_) => PyKeyboardInterrupt::new_err(text),
    }
}

/// How pictures look, as keyword arguments say it.
pub(crate) fn looks(
    view: Option<String>,
    size: Option<Size>,
    without: Option<Names>,
    overlay: bool,
    inset_camera: Option<String>,
) -> PictureOptions {
    let without = without.map_or_else(Vec::new, |Names(names)| names);
    let size = size.map(|Size(size)| size);
    PictureOptions { view, size, without, overlay, inset_camera, ..PictureOptions::default() }
}
