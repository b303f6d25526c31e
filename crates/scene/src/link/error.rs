//! What is wrong with a link.

use super::VERSION;
use crate::{Diagnostics, EditError, OverrideError};

/// What is wrong with a link.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LinkError {
    /// An address without a link in it.
    #[error("the address has no `#`: a link of Echelon goes on behind it, as in `#circle-three?t=7.5`")]
    Foreign,
    /// No scene is named.
    #[error("the link names no scene: write `#circle-three?t=7.5`, or any other of `echelon scenes`")]
    Empty,
    /// Longer than any link.
    #[error("the link has {0} bytes: none is longer than 1 MB")]
    Long(usize),
    /// A name that no shipped scene has; what may be meant.
    #[error("no scene that comes with the program is called `{0}`{1}")]
    Scene(String, String),
    /// It ends in the middle; how that shows.
    #[error("the link is cut off: {0}")]
    CutOff(String),
    /// The packed scene cannot be unpacked.
    #[error("the scene in the link is damaged: it {0}")]
    Damaged(&'static str),
    /// A part without `=`, or otherwise not of its form.
    #[error("`{0}` is no part of a link: write {1}")]
    Part(String, &'static str),
    /// A key that neither links nor scenes have.
    #[error("the link sets `{0}`, which is unknown: it is no key of a scene and none of a link")]
    Key(String),
    /// A part that stands in the link twice.
    #[error("the link has two of `{0}`")]
    Twice(&'static str),
    /// More values than are set.
    #[error("the link sets more than {0} values")]
    Sets(usize),
    /// A value that cannot be set.
    #[error(transparent)]
    Override(#[from] OverrideError),
    /// The scene is wrong.
    #[error("{0}")]
    Faults(#[from] Diagnostics),
    /// A value has no place in the text of the scene.
    #[error(transparent)]
    Edit(#[from] EditError),
    /// A scene that reads other files.
    #[error("the scene reads {0}, which a link cannot carry")]
    Files(String),
    /// A robot that the scene does not have.
    #[error("the link selects `{0}`: the scene has no robot of that name")]
    Robot(String),
    /// A newer program made it, which may be why.
    #[error(
        "{fault}\nechelon {version} made this link; this is {VERSION}, which may not know all that it says"
    )]
    Newer {
        /// The version that made it.
        version: String,
        /// What is wrong.
        fault: Box<LinkError>,
    },
}

/// Longest piece of a link in a message, characters.
const MOST_SHOWN: usize = 60;

/// A piece of a link for a message: short, and with nothing in it that moves a cursor.
pub(super) fn shown(text: &str) -> String {
    let plain = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    let mut shown: String = text.chars().take(MOST_SHOWN).map(plain).collect();
    if text.chars().nth(MOST_SHOWN).is_some() {
        shown.push('…');
    }
    shown
}
