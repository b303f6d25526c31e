//! Errors of rendering: those of the user's input, and those of the machine.

/// Everything this crate can fail with.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No graphics adapter fits.
    #[error(
        "no graphics adapter{}; {found}",
        .wanted.as_ref().map_or(String::new(), |w| format!(" matches {w:?}"))
    )]
    NoAdapter {
        /// What was asked for by name, if anything.
        wanted: Option<String>,
        /// What the machine has, or where one comes from.
        found: String,
    },
    /// The graphics device refused or was lost.
    #[error("the graphics device failed: {0}")]
    Device(String),
    /// A view or an element of the picture that does not exist.
    #[error("unknown {what} {given:?}{}; {what}s are {valid}", .nearest.as_ref().map_or(String::new(), |n| format!(" (did you mean {n:?}?)")))]
    Unknown {
        /// `view` or `element`.
        what: &'static str,
        /// What was asked for.
        given: String,
        /// The valid name nearest to it.
        nearest: Option<String>,
        /// All valid forms.
        valid: String,
    },
    /// A view `fixed:` whose numbers give no camera.
    #[error(
        "view {given:?}: {fault}; `fixed:ex,ey,ez,tx,ty,tz[,degrees]` takes an eye and a target in m, and a field of view \
         from {} to {} degrees",
        .degrees[0], .degrees[1]
    )]
    FixedView {
        /// What was asked for.
        given: String,
        /// The number that is wrong, and why.
        fault: String,
        /// Smallest and largest field of view, degrees.
        degrees: [f64; 2],
    },
    /// More views than a picture is split into.
    #[error("{0} views are too many for one picture: join at most four")]
    TooManyViews(usize),
    /// A picture size that cannot be drawn.
    #[error("a picture of {width}×{height} cannot be drawn: width and height must be 16 to {most} pixels")]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// Largest side this adapter draws.
        most: u32,
    },
    /// Samples per pixel that adapters do not offer.
    #[error("{0} samples a pixel are not offered: use 4, or 1 for speed")]
    Samples(u32),
    /// A moment whose robots or edges are not those of the fleet.
    #[error("the moment has {got} {what}, the cast {want}")]
    FleetInfo {
        /// Robots or edges.
        what: &'static str,
        /// In the moment.
        got: usize,
        /// In the fleet.
        want: usize,
    },
}

impl Error {
    /// Whether the user's input is at fault; otherwise the machine is.
    pub fn is_usage(&self) -> bool {
        !matches!(self, Self::NoAdapter { .. } | Self::Device(_))
    }
}

/// The name among `valid` nearest to `given`, if one is near enough to be meant.
pub(crate) fn nearest<'a>(given: &str, valid: impl IntoIterator<Item = &'a str>) -> Option<String> {
    valid
        .into_iter()
        .map(|name| (strsim::jaro_winkler(given, name), name))
        .filter(|(score, _)| *score > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name.to_owned())
}
