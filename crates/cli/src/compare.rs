//! `echelon compare`: do pictures look alike? For frames in CI against those that somebody has looked at.

use crate::Outcome;
use crate::failure::Failure;
use crate::interrupt;
use crate::junit::{self, Came, ReportedCheck};
use crate::print::{json, say};
use crate::replaced::Replaced;
use clap::Args;
use image::{Rgb, RgbImage, Rgba, RgbaImage};
use image_compare::rgb_hybrid_compare;
use output::Place;
use serde_json::json;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use vocabulary::{Picture, counted};

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// Reference picture (.png), or a folder of reference pictures
    #[arg(value_name = "WANTED")]
    wanted: PathBuf,
    /// Picture to compare, or a folder; pictures in folders are paired by name
    #[arg(value_name = "FOUND")]
    found: PathBuf,
    /// Similarity, 0 to 1, that every part of a picture has to reach
    #[arg(long, value_name = "LIKENESS", default_value_t = 0.9, value_parser = likeness)]
    threshold: f64,
    /// Folder for difference images: reference, picture, and where they differ
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Also write the result as JUnit XML for CI systems; `-` writes it to standard
    /// output and moves the report for people to standard error
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    /// Print only differences
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

fn likeness(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|v| (0.0..=1.0).contains(v));
    value.ok_or_else(|| "write a number from 0, anything, to 1, every pixel the same".to_owned())
}

/// Side of the parts that are judged one by one, pixels: what is wrong in one place does not drown in what is right
/// elsewhere.
const PART: u32 = 32;
/// Largest picture that is read, pixels.
const MOST_PIXELS: u64 = 200_000_000;

/// Two pictures of one name.
struct PicturePair {
    name: String,
    found: Result<Likeness, String>,
}

/// How alike two pictures are.
struct Likeness {
    /// Of the whole.
    whole: f64,
    /// Of the part that is least alike, and the pixel in its middle.
    least: f64,
    place: [u32; 2],
    /// Share of the pixels that are not the same.
    other: f64,
    /// What drew the wanted and the found one, where the files say so and it was not the same.
    adapters: Option<[String; 2]>,
}

impl PicturePair {
    fn passes(&self, threshold: f64) -> bool {
        self.found.as_ref().is_ok_and(|likeness| likeness.least >= threshold)
    }

    fn words(&self) -> String {
        match &self.found {
            Err(why) => why.clone(),
            Ok(l) if l.other == 0.0 => "the same".to_owned(),
            Ok(l) => {
                let by = l.adapters.as_ref().map_or_else(String::new, |[wanted, found]| {
                    format!("; drawn with {found}, wanted as with {wanted}")
                });
                format!(
                    "likeness {:.4}, least {:.4} around pixel ({}, {}), {:.2} % of the pixels differ{by}",
                    l.whole,
                    l.least,
                    l.place[0],
                    l.place[1],
                    100.0 * l.other
                )
            }
        }
    }
}

pub(crate) fn compare(args: &CompareArgs) -> Outcome {
    let began = Instant::now();
    let _report = junit::open(args.junit.as_deref(), args.json)?;
    let mut cases = vec![];
    let outcome = judge(args, &mut cases);
    junit::close(args.junit.as_deref(), "pictures", cases, outcome, began.elapsed(), args.quiet)
}

/// Compares all pictures; `cases` are what became of them.
fn judge(args: &CompareArgs, cases: &mut Vec<ReportedCheck>) -> Outcome {
    let pairs = pairs(args)?;
    let _place = args.out.as_deref().map(Place::folder).transpose()?;
    interrupt::watch();
    let (all, mut written) = (pairs.len(), DifferencePictures::default());
    let mut compared = Vec::with_capacity(all);
    for (name, wanted, found) in pairs {
        if interrupt::asked() {
            let came = Came::Skipped("the comparison was interrupted".to_owned());
            cases.push(ReportedCheck { name, came, time: Some(Duration::ZERO) });
            continue;
        }
        let began = Instant::now();
        let likeness = match (wanted, found) {
            (Some(wanted), Some(found)) => look(&wanted, &found, &name, args, &mut written)?,
            (Some(_), None) => Err(format!("is not in {}", args.found.display())),
            (None, _) => Err(format!("is not in {}", args.wanted.display())),
        };
        let pair = PicturePair { name, found: likeness };
        let came = if pair.passes(args.threshold) { Came::Fine } else { Came::Failed(pair.words()) };
        cases.push(ReportedCheck { name: pair.name.clone(), came, time: Some(began.elapsed()) });
        compared.push(pair);
    }
    let failed = compared.iter().filter(|pair| !pair.passes(args.threshold)).count();
    if args.json {
        let pair = |pair: &PicturePair| {
            let l = pair.found.as_ref().ok();
            json!({
                "name": pair.name, "passes": pair.passes(args.threshold), "fault": pair.found.as_ref().err(),
                "likeness": l.map(|l| l.whole), "least": l.map(|l| l.least), "at": l.map(|l| l.place),
                "pixels_differ": l.map(|l| l.other),
            })
        };
        let pairs: Vec<_> = compared.iter().map(pair).collect();
        json(&json!({ "threshold": args.threshold, "failed": failed, "pictures": pairs }));
    } else {
        for pair in compared.iter().filter(|pair| !args.quiet || !pair.passes(args.threshold)) {
            let mark = if pair.passes(args.threshold) { "✓" } else { "✗" };
            say(&format!("{mark} {}: {}", pair.name, pair.words()));
        }
        if failed > 0 || !args.quiet {
            let all = compared.len();
            say(&format!(
                "{} of {} alike, every part by {} at least",
                all - failed,
                counted(all, "picture"),
                args.threshold
            ));
        }
    }
    written.replaced.tell(args.quiet);
    if compared.len() < all {
        let text = format!("{} of {} are compared", compared.len(), counted(all, "picture"));
        return Err(Failure::Interrupted(text));
    }
    if let Some(failure) = written.lost {
        return Err(failure);
    }
    if failed == 0 { Ok(()) } else { Err(Failure::Expectation) }
}

/// Pictures of differences that were written.
#[derive(Default)]
struct DifferencePictures {
    /// The first that the disk refused.
    lost: Option<Failure>,
    replaced: Replaced,
}

/// A name, and the files on both sides that have it.
type Named = (String, Option<PathBuf>, Option<PathBuf>);

fn pairs(args: &CompareArgs) -> Result<Vec<Named>, Failure> {
    let (wanted, found) = (&args.wanted, &args.found);
    match (wanted.is_dir(), found.is_dir()) {
        (false, false) => {
            let name = found.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
            Ok(vec![(name, Some(wanted.clone()), Some(found.clone()))])
        }
        (true, true) => {
            let (left, right) = (names(wanted)?, names(found)?);
            if left.is_empty() && right.is_empty() {
                let text = format!(
                    "neither {} nor {} holds a .png: name pictures, or folders of them; recorded runs are compared by `echelon diff`",
                    wanted.display(),
                    found.display()
                );
                return Err(Failure::Usage(text));
            }
            let file = |names: &BTreeSet<OsString>, folder: &Path, name: &OsString| {
                names.contains(name).then(|| folder.join(name))
            };
            let named = |name: &OsString| {
                (name.to_string_lossy().into_owned(), file(&left, wanted, name), file(&right, found, name))
            };
            Ok(left.union(&right).map(named).collect())
        }
        (folder, _) => {
            let (one, other) = if folder { (wanted, found) } else { (found, wanted) };
            let what = if other.exists() { "is none" } else { "is not there" };
            let text = format!(
                "{} is a folder and {} {what}: give two pictures or two folders",
                one.display(),
                other.display()
            );
            Err(Failure::Usage(text))
        }
    }
}

/// Names of the pictures in a folder.
fn names(folder: &Path) -> Result<BTreeSet<OsString>, Failure> {
    let refused = |e| Failure::Usage(format!("cannot read {}: {e}", folder.display()));
    let files = std::fs::read_dir(folder).map_err(refused)?.flatten().map(|entry| entry.path());
    let pictures = files
        .filter(|path| path.is_file() && path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png")));
    Ok(pictures.filter_map(|path| path.file_name().map(OsString::from)).collect())
}

fn read(path: &Path) -> Result<RgbaImage, Failure> {
    let refused = |e: &dyn std::fmt::Display| Failure::Usage(format!("cannot read {}: {e}", path.display()));
    let reader = image::ImageReader::open(path).map_err(|e| refused(&e))?;
    let mut reader = reader.with_guessed_format().map_err(|e| refused(&e))?;
    if reader.format().is_none() {
        return Err(refused(&"it is no picture; recorded runs are compared by `echelon diff`"));
    }
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(4 * MOST_PIXELS);
    reader.limits(limits);
    Ok(reader.decode().map_err(|e| refused(&e))?.into_rgba8())
}

fn look(
    wanted: &Path,
    found: &Path,
    name: &str,
    args: &CompareArgs,
    written: &mut DifferencePictures,
) -> Result<Result<Likeness, String>, Failure> {
    let (a, b) = (read(wanted)?, read(found)?);
    if a.dimensions() != b.dimensions() {
        let [(w, h), (v, g)] = [a.dimensions(), b.dimensions()];
        return Ok(Err(format!("is {v}×{g} pixels, wanted {w}×{h}")));
    }
    let shown =
        shown(&a, &b).map_err(|e| Failure::Machine(format!("cannot compare {}: {e}", found.display())))?;
    let likeness = Likeness { adapters: adapters(wanted, found), ..shown.likeness };
    if let Some(folder) = args.out.as_ref().filter(|_| likeness.other > 0.0) {
        let path = folder.join(Path::new(name).with_extension("difference.png"));
        let picture = side_by_side(&shown.wanted, &shown.found, &shown.map);
        written.replaced.look(&path);
        let outcome = rendering::png::write(&path, &picture, &[("Software", studies::PROGRAM)]);
        // What came out is told, whatever becomes of a file.
        written.lost = written.lost.take().or(outcome.err().map(Failure::from));
    }
    Ok(Ok(likeness))
}

/// Two pictures on a ground, and how alike they are there.
struct ComparedPictures {
    wanted: RgbImage,
    found: RgbImage,
    /// The unlikeness of every pixel.
    map: RgbImage,
    likeness: Likeness,
}

/// Two pictures on the ground on which they are less alike, black or white: what is transparent shows the ground, and no
/// opaque colour is like it on both.
fn shown(wanted: &RgbaImage, found: &RgbaImage) -> Result<ComparedPictures, String> {
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

/// What drew two pictures, where their files say so and it was not the same.
fn adapters(wanted: &Path, found: &Path) -> Option<[String; 2]> {
    let drawn = |path: &Path| {
        let texts = rendering::png::read_texts(path).ok()?;
        texts.into_iter().find(|(key, _)| key == "Adapter").map(|(_, adapter)| adapter)
    };
    let both = [drawn(wanted)?, drawn(found)?];
    (both[0] != both[1]).then_some(both)
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
    Likeness {
        whole,
        least: least.0,
        place: least.1,
        other: other / (f64::from(width) * f64::from(height)),
        adapters: None,
    }
}

/// Wanted, found, and where they differ: red on what was wanted, faintly.
fn side_by_side(a: &RgbImage, b: &RgbImage, map: &RgbImage) -> Picture {
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
            let found = shown(&opaque(value), &clear).expect("compared").likeness;
            assert!(found.least < 0.9 && found.other == 1.0, "{value}: {}", found.least);
        }
        // What colour it would have is not seen.
        let other = RgbaImage::from_pixel(64, 64, Rgba([200, 0, 0, 0]));
        assert_eq!(shown(&clear, &other).expect("compared").likeness.other, 0.0);
    }

    #[test]
    fn what_is_missing_in_one_place_is_found_there() {
        let found = likeness(&picture(Some(40)), &picture(None));
        assert!(found.least < 0.8 && found.whole > found.least, "{}", found.least);
        assert!(found.place[0].abs_diff(35) <= PART, "{:?}", found.place);
        let shown = side_by_side(&picture(Some(40)), &picture(None), &picture(None));
        assert_eq!((shown.width, shown.height), (480, 96));
    }
}
