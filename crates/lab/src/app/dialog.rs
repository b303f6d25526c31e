//! Which dialog covers the view.

/// What lies over the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Dialog {
    /// Nothing.
    #[default]
    Nothing,
    /// The menu of scenes.
    Gallery,
    /// The shortcuts.
    Help,
    /// The question before unsaved work is closed.
    Closing,
    /// The question before another scene takes the place of unsaved work.
    Leaving,
}
