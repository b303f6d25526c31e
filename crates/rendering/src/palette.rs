//! Colours: the robots' own, and those of ink and paper. Names of colours are sRGB, shading is linear.

pub(crate) use vocabulary::colours::{Rgb, hex};
pub use vocabulary::colours::{narrowing_colour, robot_colours};

/// The stripe on robots without a leader.
pub(crate) const GOLD: Rgb = hex(0x00e3_b341);
/// Barriers that are tight.
pub(crate) const RED: Rgb = hex(0x00e5_3935);
/// The names of robots in trouble.
pub(crate) const ALARM: Rgb = hex(0x00ff_9a7a);
/// Text on a light halo.
pub(crate) const INK: Rgb = hex(0x0012_161c);
/// Halo, and text on dark ground.
pub(crate) const PAPER: Rgb = hex(0x00fb_faf6);

/// A colour with an opacity.
pub(crate) fn with_alpha([red, green, blue]: Rgb, alpha: f32) -> [f32; 4] {
    [red, green, blue, alpha]
}

/// Linear light of an sRGB colour.
pub(crate) fn linear(colour: Rgb) -> Rgb {
    colour.map(|c| if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
}
