//! How alike two pictures are to the eye, as a whole and part by part.

use image::{Rgb, RgbImage, Rgba, RgbaImage};
use image_compare::rgb_hybrid_compare;
use vocabulary::Picture;

/// How alike two pictures are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Likeness {
    /// Of the whole, 0 to 1.
    pub whole: f64,
    /// Of the part that is least alike, 0 to 1.
    pub least: f64,
    /// The pixel in the middle of that part.
    pub place: [u32; 2],
    /// Share of the pixels that are not the same.
    pub other: f64,
}

/// Side of the parts that are judged one by one, pixels: what is wrong in one place does not drown in what is right
/// elsewhere.
const PART: u32 = 32;

/// Two pictures on a ground, and how alike they are there.
pub struct ComparedPictures {
    wanted: RgbImage,
    found: RgbImage,
    /// The unlikeness of every pixel.
    map: RgbImage,
    /// How alike they are.
    pub likeness: Likeness,
}

/// Two pictures on the ground on which they are less alike, black or white: what is transparent shows the ground, and no
/// opaque colour is like it on both.
///
/// # Errors
/// Why they cannot be compared, in words: they are not of one size.
pub fn compare_pictures(wanted: &RgbaImage, found: &RgbaImage) -> Result<ComparedPictures, String> {
    let on = |ground: u8| {
        let (wanted, found) = (flat(wanted, ground), flat(found, ground));
        let compared = rgb_hybrid_compare(&wanted, &found).map_err(|e| e.to_string())?;
        let map = compared.image.to_color_map().into_rgb8();
        let likeness = likeness_of(&wanted, &found, compared.score, &map);
        Ok::<_, String>(ComparedPictures { wanted, found, map, likeness })
    };
    let black = on(0)?;
    if [wanted, found].into_iter().all(|picture| picture.pixels().all(|p| p.0[3] == 255)) {
        return Ok(black);
    }
    let white = on(255)?;
    let less = |a: &Likeness, b: &Likeness| a.least < b.least || a.least == b.least && a.other > b.other;
    Ok(if less(&white.likeness, &black.likeness) { white } else { black })
}

/// A picture as it is seen on a ground of one grey.
fn flat(picture: &RgbaImage, ground: u8) -> RgbImage {
    let mix = |colour: u8, alpha: u8| {
        let (colour, alpha, ground) = (u32::from(colour), u32::from(alpha), u32::from(ground));
        ((colour * alpha + ground * (255 - alpha) + 127) / 255) as u8
    };
    RgbImage::from_fn(picture.width(), picture.height(), |x, y| {
        let Rgba([r, g, b, alpha]) = *picture.get_pixel(x, y);
        Rgb([r, g, b].map(|colour| mix(colour, alpha)))
    })
}

/// Likeness of a pixel, 0 to 1: that of its worst channel, brightness and colours; `map` has their unlikeness.
fn at(map: &RgbImage, x: u32, y: u32) -> f64 {
    1.0 - f64::from(map.get_pixel(x, y).0.into_iter().fold(0, u8::max)) / 255.0
}

fn likeness_of(a: &RgbImage, b: &RgbImage, whole: f64, map: &RgbImage) -> Likeness {
    let (width, height) = a.dimensions();
    let mut least = (1.0, [0, 0]);
    for top in (0..height).step_by(PART as usize) {
        for left in (0..width).step_by(PART as usize) {
            let (right, bottom) = ((left + PART).min(width), (top + PART).min(height));
            let pixels = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
            let sum: f64 = pixels.map(|(x, y)| at(map, x, y)).sum();
            let mean = sum / (f64::from(right - left) * f64::from(bottom - top));
            if mean < least.0 {
                least = (mean, [u32::midpoint(left, right), u32::midpoint(top, bottom)]);
            }
        }
    }
    let other = a.pixels().zip(b.pixels()).filter(|(p, q)| p != q).count() as f64;
    Likeness { whole, least: least.0, place: least.1, other: other / (f64::from(width) * f64::from(height)) }
}

impl ComparedPictures {
    /// Wanted, found, and where they differ: red on what was wanted, faintly.
    pub fn side_by_side(&self) -> Picture {
        let Self { wanted: a, found: b, map, .. } = self;
        let (width, height) = a.dimensions();
        let mut rgba = Vec::with_capacity(12 * width as usize * height as usize);
        for y in 0..height {
            for image in [a, b] {
                for x in 0..width {
                    let Rgb([r, g, b]) = *image.get_pixel(x, y);
                    rgba.extend([r, g, b, 255]);
                }
            }
            for x in 0..width {
                let grey = a.get_pixel(x, y).0.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0;
                let faint = 200.0 + 0.2 * grey;
                // Small differences are to be seen as well.
                let off = (1.0 - at(map, x, y)).clamp(0.0, 1.0).sqrt();
                let mix = |to: f64| (faint + (to - faint) * off) as u8;
                rgba.extend([mix(200.0), mix(20.0), mix(20.0), 255]);
            }
        }
        Picture { width: 3 * width, height, rgba }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(mark: Option<u32>) -> RgbImage {
        RgbImage::from_fn(160, 96, |x, y| {
            let ground = 120 + ((x * 7 + y * 13) % 9) as u8;
            match mark {
                Some(at) if x.abs_diff(at) < 8 && y.abs_diff(50) < 8 => Rgb([220, 60, 20]),
                _ => Rgb([ground; 3]),
            }
        })
    }

    fn likeness(a: &RgbImage, b: &RgbImage) -> Likeness {
        let compared = rgb_hybrid_compare(a, b).expect("compared");
        likeness_of(a, b, compared.score, &compared.image.to_color_map().into_rgb8())
    }

    #[test]
    fn the_same_is_alike_and_a_little_noise_nearly() {
        let a = picture(Some(40));
        let same = likeness(&a, &a);
        assert!(same.least > 0.9999 && same.other == 0.0);
        let mut noisy = a.clone();
        noisy.pixels_mut().step_by(700).for_each(|p| p.0[1] = p.0[1].saturating_add(3));
        let near = likeness(&a, &noisy);
        assert!(near.least > 0.95 && near.other > 0.0, "{}", near.least);
    }

    #[test]
    fn what_is_transparent_is_like_no_colour() {
        let opaque = |value: u8| RgbaImage::from_pixel(64, 64, Rgba([value, value, value, 255]));
        let clear = RgbaImage::from_pixel(64, 64, Rgba([0, 0, 0, 0]));
        for value in [0, 128, 255] {
            let found = compare_pictures(&opaque(value), &clear).expect("compared").likeness;
            assert!(found.least < 0.9 && found.other == 1.0, "{value}: {}", found.least);
        }
        // What colour it would have is not seen.
        let other = RgbaImage::from_pixel(64, 64, Rgba([200, 0, 0, 0]));
        assert_eq!(compare_pictures(&clear, &other).expect("compared").likeness.other, 0.0);
    }

    #[test]
    fn what_is_missing_in_one_place_is_found_there() {
        let found = likeness(&picture(Some(40)), &picture(None));
        assert!(found.least < 0.8 && found.whole > found.least, "{}", found.least);
        assert!(found.place[0].abs_diff(35) <= PART, "{:?}", found.place);
        let shown = ComparedPictures {
            wanted: picture(Some(40)),
            found: picture(None),
            map: picture(None),
            likeness: found,
        }
        .side_by_side();
        assert_eq!((shown.width, shown.height), (480, 96));
    }
}
