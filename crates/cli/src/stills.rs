//! `echelon stills`: a run on one sheet, and all of it in one picture.

mod strobe;

use crate::args::{PictureArgs, SceneArgs};
use crate::failure::Failure;
use crate::load::{load, stem};
use crate::print::{json, say};
use crate::progress::Progress;
use crate::replaced::Replaced;
use crate::terminal::Terminal;
use crate::{Outcome, cameras, interrupt};
use clap::Args;
use footage::{Playback, RenderSetup};
use output::Place;
use rendering::{PictureSpec, Style, ViewLayout};
use serde_json::json;
use std::path::PathBuf;
use studies::RecordSource;
use vocabulary::{Picture, StepRecord};

#[derive(Debug, Args)]
pub(crate) struct StillsArgs {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    picture: PictureArgs,
    /// Folder for NAME-sheet.png and NAME-strobe.png; it may hold others
    #[arg(long, short, value_name = "DIR", default_value = ".")]
    out: PathBuf,
    /// Pictures on the sheet, and images of each robot in the strobe picture
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(2..=64))]
    count: u32,
    /// Pictures per row of the sheet
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=16))]
    columns: u32,
}

/// Size of the strobe picture, and of a picture on the sheet, pixels.
const STROBE: [u32; 2] = [1600, 900];
const TILE: [u32; 2] = [480, 270];
/// White between the pictures of a sheet, pixels.
const GAP: u32 = 8;

pub(crate) fn stills(args: &StillsArgs) -> Outcome {
    let mut loaded = load(&args.scene)?;
    let _place = Place::folder(&args.out)?;
    let fleet = loaded.simulation.fleet().clone();
    let name = stem(&args.scene.scene);
    let quiet = args.scene.quiet || args.scene.json;
    let tile = args.picture.size.unwrap_or(TILE);
    let large = args.picture.size.unwrap_or(STROBE);
    let view = loaded.scene.views.default.clone();
    let terminal = Terminal::new(args.scene.quiet);
    let mut small =
        RenderSetup::open(&args.scene.adapter.name, &args.picture.options(), &fleet, &view, tile, &terminal)?;
    cameras::attach(&mut loaded, Some(&small.gpu), &args.scene.adapter.name, None)?;
    let duration = loaded.scene.time.duration;

    // Both are drawn from the same moments.
    let steps = u64::from(2 * args.count);
    let progress = Progress::begin(&format!("Drawing stills of {name}"), steps, quiet);
    let mut playback =
        Playback::new(&fleet, RecordSource::Run(Box::new(loaded.simulation)), &interrupt::asked);
    let (mut records, mut tiles): (Vec<StepRecord>, Vec<Picture>) = (Vec::new(), Vec::new());
    for k in 0..args.count {
        let record = playback.at(duration * f64::from(k) / f64::from(args.count - 1));
        playback.check()?;
        if interrupt::asked() {
            return Err(Failure::Interrupted("nothing was written".into()));
        }
        // Title and law stand on the first picture for all of them.
        let style = Style { caption: small.style.caption && k == 0, inset: false, ..small.style.clone() };
        let spec = PictureSpec::new(playback.trail(), &record, &small.layout, &style);
        tiles.push(small.renderer.draw(spec)?);
        records.push(record);
        progress.at(u64::from(k) + 1);
    }
    let sheet = sheet(&tiles, args.columns);
    let mut big = rendering::Renderer::new(&small.gpu, &fleet, large[0], large[1], args.picture.samples)?;
    let aspect = f64::from(large[0]) / f64::from(large[1]);
    let layout = ViewLayout::single(strobe::view(&records, &fleet, aspect));
    let style = Style {
        ghosts: false,
        labels: false,
        edges: false,
        set_points: false,
        names: false,
        inset: false,
        clock: false,
        scale: args.picture.scale.unwrap_or_else(|| Style::scale_for(large[0], large[1])),
        ..small.style
    };
    let mut pictures = Vec::with_capacity(records.len());
    for (k, record) in records.iter().enumerate() {
        if interrupt::asked() {
            return Err(Failure::Interrupted("nothing was written".into()));
        }
        pictures.push(big.draw(PictureSpec::new(playback.trail(), record, &layout, &style))?);
        progress.at(u64::from(args.count) + k as u64 + 1);
    }
    let strobe = strobe::together(&pictures);
    drop(progress);
    let adapter = small.gpu.description();
    let texts =
        [("Title", fleet.title.as_str()), ("Software", studies::PROGRAM), ("Adapter", adapter.as_str())];
    let (mut files, mut replaced) = (Vec::<(PathBuf, [u32; 2])>::new(), Replaced::default());
    for (kind, picture) in [("sheet", sheet), ("strobe", strobe)] {
        let path = args.out.join(format!("{name}-{kind}.png"));
        replaced.look(&path);
        film::png::write(&path, &picture, &texts).map_err(|error| match files.first() {
            Some((first, _)) => Failure::from(error).but(&format!("{} is written", first.display())),
            None => Failure::from(error).but("nothing is written"),
        })?;
        files.push((path, [picture.width, picture.height]));
    }
    replaced.tell(args.scene.quiet);
    if args.scene.json {
        let file =
            |(path, size): &(PathBuf, [u32; 2])| json!({ "file": path.display().to_string(), "size": size });
        json(&json!({ "files": files.iter().map(file).collect::<Vec<_>>(), "adapter": adapter }));
    } else if !args.scene.quiet {
        for (path, [width, height]) in files {
            say(&format!("{}: {width}×{height}", path.display()));
        }
    }
    Ok(())
}

/// Pictures in rows, white between them.
fn sheet(pictures: &[Picture], columns: u32) -> Picture {
    let (wide, high) = pictures.first().map_or((1, 1), |p| (p.width, p.height));
    let columns = columns.min(pictures.len() as u32).max(1);
    let rows = (pictures.len() as u32).div_ceil(columns);
    let (width, height) = (columns * (wide + GAP) + GAP, rows * (high + GAP) + GAP);
    let mut rgba = vec![255; 4 * width as usize * height as usize];
    for (k, picture) in pictures.iter().enumerate() {
        let (column, row) = (k as u32 % columns, k as u32 / columns);
        let (x, y) = ((GAP + column * (wide + GAP)) as usize, (GAP + row * (high + GAP)) as usize);
        for (line, bytes) in picture.rgba.chunks_exact(4 * wide as usize).enumerate() {
            let at = 4 * ((y + line) * width as usize + x);
            if let Some(place) = rgba.get_mut(at..at + bytes.len()) {
                place.copy_from_slice(bytes);
            }
        }
    }
    Picture { width, height, rgba }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_has_every_picture_in_its_place() {
        let grey = |value: u8| Picture { width: 20, height: 10, rgba: vec![value; 800] };
        let sheet = sheet(&[grey(10), grey(20), grey(30)], 2);
        assert_eq!((sheet.width, sheet.height), (2 * 28 + 8, 2 * 18 + 8));
        let at = |x: u32, y: u32| sheet.rgba[4 * (y * sheet.width + x) as usize];
        assert_eq!([at(9, 9), at(40, 9), at(9, 30), at(40, 30), at(2, 2)], [10, 20, 30, 255, 255]);
    }
}
