//! `echelon compare`: do pictures look alike? For frames in CI against those that somebody has looked at.

use crate::args::within;
use crate::failure::Failure;
use crate::junit::{self, Came, ReportedCheck};
use crate::print::{json, say};
use crate::replaced::Replaced;
use crate::{Outcome, interrupt};
use clap::Args;
use image::RgbaImage;
use output::Place;
use serde_json::json;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use studies::likeness::{Likeness, compare_pictures};
use vocabulary::counted;

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    /// Reference picture (.png), or a folder of reference pictures
    #[arg(value_name = "WANTED")]
    wanted: PathBuf,
    /// Picture to compare, or a folder; pictures in folders are paired by name
    #[arg(value_name = "FOUND")]
    found: PathBuf,
    /// Similarity, 0 to 1, that every part of a picture has to reach
    #[arg(long, value_name = "LIKENESS", default_value_t = 0.95, value_parser = within(0.0..=1.0, "write a number from 0 (every picture passes) to 1 (every pixel has to be equal)"))]
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

/// Largest picture that is read, pixels.
const MOST_PIXELS: u64 = 200_000_000;

/// Two pictures of one name.
struct PicturePair {
    name: String,
    found: Result<PictureFinding, String>,
}

/// How alike two pictures are, and what drew them.
struct PictureFinding {
    likeness: Likeness,
    /// What drew the wanted and the found one, where the files say so and it was not the same.
    adapters: Option<[String; 2]>,
}

impl PicturePair {
    fn passes(&self, threshold: f64) -> bool {
        self.found.as_ref().is_ok_and(|found| found.likeness.least >= threshold)
    }

    fn words(&self) -> String {
        match &self.found {
            Err(why) => why.clone(),
            Ok(found) if found.likeness.other == 0.0 => "the same".to_owned(),
            Ok(PictureFinding { likeness: l, adapters }) => {
                let by = adapters.as_ref().map_or_else(String::new, |[wanted, found]| {
                    format!("; drawn with {found}, the reference with {wanted}")
                });
                // Where nothing stands out, a place would mislead.
                let [x, y] = l.place;
                let around =
                    if l.least < 1.0 - 5e-5 { format!(" around pixel ({x}, {y})") } else { String::new() };
                let [whole, least, other] = [l.whole, l.least, 100.0 * l.other];
                format!(
                    "likeness {whole:.4}, least {least:.4}{around}, {other:.2} % of the pixels differ{by}"
                )
            }
        }
    }
}

pub(crate) fn compare(args: &CompareArgs) -> Outcome {
    junit::reported(args.junit.as_deref(), "pictures", args.json, args.quiet, |cases| judge(args, cases))
}

/// Difference pictures among the references would be compared the next time.
fn refuse_own_folder(args: &CompareArgs) -> Result<(), Failure> {
    let Some(out) = args.out.as_deref().and_then(|out| out.canonicalize().ok()) else { return Ok(()) };
    for side in [&args.wanted, &args.found] {
        if side.canonicalize().is_ok_and(|folder| folder.is_dir() && folder == out) {
            return Err(Failure::Usage(format!(
                "-o {}: the pictures that are compared are in this folder; name another one for the differences",
                side.display()
            )));
        }
    }
    Ok(())
}

/// Compares all pictures; `cases` are what became of them.
fn judge(args: &CompareArgs, cases: &mut Vec<ReportedCheck>) -> Outcome {
    let pairs = pairs(args)?;
    refuse_own_folder(args)?;
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
            let l = pair.found.as_ref().ok().map(|found| found.likeness);
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
        return Err(refused(&"it is not a picture; recorded runs are compared by `echelon diff`"));
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
) -> Result<Result<PictureFinding, String>, Failure> {
    let (a, b) = (read(wanted)?, read(found)?);
    if a.dimensions() != b.dimensions() {
        let [(w, h), (v, g)] = [a.dimensions(), b.dimensions()];
        return Ok(Err(format!("is {v}×{g} pixels, wanted {w}×{h}")));
    }
    let compared = compare_pictures(&a, &b)
        .map_err(|e| Failure::Machine(format!("cannot compare {}: {e}", found.display())))?;
    let likeness = compared.likeness;
    if let Some(folder) = args.out.as_ref().filter(|_| likeness.other > 0.0) {
        let path = folder.join(Path::new(name).with_extension("difference.png"));
        written.replaced.look(&path);
        let outcome = film::png::write(&path, &compared.side_by_side(), &[("Software", studies::PROGRAM)]);
        // Results are printed even if a file cannot be written.
        written.lost = written.lost.take().or(outcome.err().map(Failure::from));
    }
    Ok(Ok(PictureFinding { likeness, adapters: adapters(wanted, found) }))
}

/// What drew two pictures, where their files say so and it was not the same.
fn adapters(wanted: &Path, found: &Path) -> Option<[String; 2]> {
    let drawn = |path: &Path| {
        let texts = film::png::read_texts(path).ok()?;
        texts.into_iter().find(|(key, _)| key == "Adapter").map(|(_, adapter)| adapter)
    };
    let both = [drawn(wanted)?, drawn(found)?];
    (both[0] != both[1]).then_some(both)
}
