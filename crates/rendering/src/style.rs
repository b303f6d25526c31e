//! The elements of a picture besides ground, sky and robots; each has a name by which it can be switched off.

use crate::Error;
use crate::error::nearest;
use crate::{Annotations, Overlays};

macro_rules! elements {
    ($($(#[$doc:meta])* $field:ident = $name:literal,)*) => {
        /// Which elements a picture has, and how large its text is.
        #[derive(Debug, Clone, PartialEq)]
        pub struct Style {
            $($(#[$doc])* pub $field: bool,)*
            /// Size of text and lines relative to a picture of 720 lines at arm's length; 2 for dense screens, and
            /// [`Style::scale_for`] for files.
            pub scale: f64,
            /// Over views through cameras: the detected tags, and the estimated leader.
            pub detections: bool,
            /// The robot through whose camera a small picture in the corner is seen, by its index.
            pub picture_in_picture: Option<usize>,
            /// Annotations on the ground; views through cameras do not show them.
            pub annotations: Annotations,
            /// What films add: cards, a line, plots.
            pub show: Overlays,
            /// Quicker pictures, for a window: ribbons and tyre marks have fewer points, within half a pixel of where they
            /// are in others, and follow hills less closely.
            pub interactive: bool,
        }

        impl Default for Style {
            fn default() -> Self {
                Self {
                    $($field: true,)*
                    scale: 1.0,
                    detections: false,
                    picture_in_picture: None,
                    annotations: Annotations::default(),
                    show: Overlays::default(),
                    interactive: false,
                }
            }
        }

        impl Style {
            /// The names of all elements.
            pub const ELEMENTS: &[&str] = &[$($name),*];

            fn switch(&mut self, name: &str) -> Option<&mut bool> {
                match name {
                    $($name => Some(&mut self.$field),)*
                    _ => None,
                }
            }
        }
    };
}

elements! {
    /// Coloured bands on the ground where the robots drove.
    ribbons = "ribbons",
    /// Faint bodies where the robots were.
    ghosts = "ghosts",
    /// Rings where the followers should be, and arrows to them.
    set_points = "set-points",
    /// Lines from leader to follower.
    edges = "edges",
    /// Distance and bearing beside the edges.
    labels = "labels",
    /// The robots' names.
    names = "names",
    /// Metre lines on the ground and their coordinates.
    grid = "grid",
    /// The chart of errors over time.
    inset = "inset",
    /// Title, law and gains.
    caption = "caption",
    /// The time.
    clock = "time",
    /// Cast shadows.
    shadows = "shadows",
    /// Tyre marks that stay.
    marks = "marks",
    /// Flashes where things touch, and the marks that stay there.
    contacts = "contacts",
    /// Arcs around robots with a safety filter, which redden as barriers tighten, and the names of those that act.
    barriers = "barriers",
    /// What happened to the formation lately, in words.
    events = "events",
    /// Ways to goals that are planned, coloured by the shape of the formation.
    plans = "plans",
}

/// Below this scale names could not be read.
const LEAST_SCALE: f64 = 0.65;

impl Style {
    /// The scale that suits a picture of some size: text and lines are the same part of it as at 1280×720, and never too
    /// small to be read. What is higher than wide is looked at on a phone.
    pub fn scale_for(width: u32, height: u32) -> f64 {
        let [width, height] = [width, height].map(f64::from);
        let grown = if height > width { width / 640.0 } else { height / 720.0 };
        grown.max(LEAST_SCALE)
    }

    /// Everything except the elements named.
    ///
    /// # Errors
    /// [`Error::Unknown`] for the first name that is none.
    pub fn without<S: AsRef<str>>(names: &[S]) -> Result<Self, Error> {
        let mut style = Self::default();
        for name in names {
            style.set(name.as_ref(), false)?;
        }
        Ok(style)
    }

    /// Nothing but ground, sky and robots with their shadows: what a camera would see.
    pub fn bare() -> Self {
        let mut style = Self::default();
        for name in Self::ELEMENTS {
            if let Some(switch) = style.switch(name) {
                *switch = *name == "shadows";
            }
        }
        style
    }

    /// Whether an element is drawn; false where there is none of that name.
    pub fn shows(&self, name: &str) -> bool {
        // The one list of elements is that of the switches.
        self.clone().switch(name).is_some_and(|on| *on)
    }

    /// Switches one element.
    ///
    /// # Errors
    /// [`Error::Unknown`] where there is none of that name.
    pub fn set(&mut self, name: &str, on: bool) -> Result<(), Error> {
        match self.switch(name) {
            Some(switch) => {
                *switch = on;
                Ok(())
            }
            None => Err(Error::Unknown {
                what: "element",
                given: name.to_owned(),
                nearest: nearest(name, Self::ELEMENTS.iter().copied()),
                valid: Self::ELEMENTS.join(", "),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_switched_by_name() {
        let style = Style::without(&["grid", "set-points"]).unwrap();
        assert!(!style.grid && !style.set_points && style.ribbons);
        let error = Style::without(&["ribons"]).unwrap_err().to_string();
        assert!(error.contains("did you mean \"ribbons\""), "{error}");
    }
}
