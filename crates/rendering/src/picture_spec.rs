//! What a picture shows, and how.

use crate::{Style, Trail, ViewLayout};
use vocabulary::StepRecord;

/// A moment with what a picture needs to know of the past, the views of it, and the elements that are drawn.
#[derive(Debug, Clone, Copy)]
pub struct PictureSpec<'a> {
    /// The past.
    pub trail: &'a Trail,
    /// The moment.
    pub record: &'a StepRecord,
    /// The views.
    pub layout: &'a ViewLayout,
    /// The elements.
    pub style: &'a Style,
}

impl<'a> PictureSpec<'a> {
    /// A picture of `record`, with `trail` before it.
    pub fn new(trail: &'a Trail, record: &'a StepRecord, layout: &'a ViewLayout, style: &'a Style) -> Self {
        Self { trail, record, layout, style }
    }
}
