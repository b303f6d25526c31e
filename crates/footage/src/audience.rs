//! Whoever waits for pictures.

use std::path::Path;

/// Whoever waits for pictures: hears of them, and may stop the work.
pub trait Audience {
    /// Something went otherwise than asked for.
    fn note(&self, text: &str);

    /// Something that is good to know.
    fn remark(&self, text: &str);

    /// Something about what was asked for by an option of that name, such as `inset_camera`; the text goes on after the name.
    fn about(&self, option: &str, text: &str);

    /// A job of so many steps begins.
    fn begin(&self, what: &str, steps: u64);

    /// Where the job is.
    fn at(&self, step: u64);

    /// The job is at its end.
    fn end(&self);

    /// Whether the work is to stop.
    fn stops(&self) -> bool;

    /// A file is about to be written, in the place of another one where there is one.
    fn writes(&self, path: &Path);
}
