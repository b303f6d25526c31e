//! Colours: the robots' own, and those of ink and paper. Names of colours are sRGB, shading is linear.

use vocabulary::Cast;

/// An sRGB colour, 0 to 1 a channel.
pub(crate) type Rgb = [f32; 3];

pub(crate) const fn hex(code: u32) -> Rgb {
    [((code >> 16) & 255) as f32 / 255.0, ((code >> 8) & 255) as f32 / 255.0, (code & 255) as f32 / 255.0]
}

/// Near-black, for robots that follow nobody.
pub(crate) const LEAD: Rgb = hex(0x001e_1e22);
/// The stripe on robots that follow nobody.
pub(crate) const GOLD: Rgb = hex(0x00e3_b341);
/// The names of robots in trouble.
pub(crate) const ALARM: Rgb = hex(0x00ff_9a7a);
/// Text on a light halo.
pub(crate) const INK: Rgb = hex(0x0012_161c);
/// Halo, and text on dark ground.
pub(crate) const PAPER: Rgb = hex(0x00fb_faf6);

// Okabe and Ito, "Color universal design" (2008), without black, which the lead robots have.
const FOLLOWERS: [Rgb; 7] = [
    hex(0x00e6_9f00),
    hex(0x0056_b4e9),
    hex(0x0000_9e73),
    hex(0x00f0_e442),
    hex(0x0000_72b2),
    hex(0x00d5_5e00),
    hex(0x00cc_79a7),
];

/// The colour of every robot of `cast`: followers take turns in the order in which they stand.
pub fn robot_colours(cast: &Cast) -> Vec<Rgb> {
    let mut followers = 0;
    let mut colour = |leads: bool| {
        if leads {
            return LEAD;
        }
        followers += 1;
        FOLLOWERS[(followers - 1) % FOLLOWERS.len()]
    };
    cast.members.iter().map(|member| colour(member.leads)).collect()
}

/// Linear light of an sRGB colour.
pub(crate) fn linear(colour: Rgb) -> Rgb {
    colour.map(|c| if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
}
