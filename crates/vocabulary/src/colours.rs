//! The robots' colours, the same in pictures, figures, windows and logs.

use crate::FleetInfo;

/// An sRGB colour, 0 to 1 a channel.
pub type Rgb = [f32; 3];

/// The colour of a code such as 0xff8800.
pub const fn hex(code: u32) -> Rgb {
    [((code >> 16) & 255) as f32 / 255.0, ((code >> 8) & 255) as f32 / 255.0, (code & 255) as f32 / 255.0]
}

/// Near-black, for robots that follow nobody.
pub const LEAD: Rgb = hex(0x001e_1e22);

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

/// The colour of every robot of `fleet`: followers take turns in the order in which they stand.
pub fn robot_colours(fleet: &FleetInfo) -> Vec<Rgb> {
    let mut followers = 0;
    let mut colour = |leads: bool| {
        if leads {
            return LEAD;
        }
        followers += 1;
        FOLLOWERS[(followers - 1) % FOLLOWERS.len()]
    };
    fleet.robots.iter().map(|member| colour(member.leads)).collect()
}

/// Ground that a formation sweeps in its shape, and in its column.
const SHAPE: Rgb = hex(0x002f_7fd6);
const COLUMN: Rgb = hex(0x00e0_7b1f);

/// Colour of a formation narrowed by a share: 0 in its shape, 1 in its column.
pub fn narrowing_colour(narrowing: f64) -> Rgb {
    let narrow = narrowing.clamp(0.0, 1.0) as f32;
    [0, 1, 2].map(|k| SHAPE[k] + narrow * (COLUMN[k] - SHAPE[k]))
}
