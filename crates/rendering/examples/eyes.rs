//! What the robots' cameras see: `eyes FILE ROBOTS TIME BODY GROUND ADAPTER`, all optional; BODY and GROUND as for
//! `still`. Every follower looks at its leader; the pictures stand side by side, and their times are told.

#[path = "../tests/stage/course.rs"]
#[expect(dead_code, reason = "shared with tests")]
mod course;
#[path = "../tests/stage/sight.rs"]
#[expect(dead_code, reason = "shared with tests")]
mod sight;
#[path = "../tests/stage/mod.rs"]
#[expect(dead_code, reason = "shared with tests")]
mod stage;

use course::{CAR, ROVER, TRUCK, enlarge, furnish, grounded};
use film::png;
use rendering::{AdapterChoice, Gpu, GpuCameraRenderer};
use sight::{region_around, shots};
use stage::{Path, Play};
use std::time::Instant;
use vocabulary::math;
use vocabulary::{Body, Grey, Picture, Region, Shot, Snapshot};

fn median(
    eyes: &mut GpuCameraRenderer,
    snapshot: &Snapshot,
    shots: &[Shot],
) -> Result<String, Box<dyn std::error::Error>> {
    let mut pictures = Vec::new();
    let mut times = Vec::new();
    for _ in 0..61 {
        let start = Instant::now();
        eyes.take(snapshot, shots, &mut pictures)?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
    }
    times.sort_by(f64::total_cmp);
    Ok(format!("{:.2} ms, at best {:.2} ms", times[30], times[0]))
}

/// Pictures of one size, two to a row.
fn sheet(pictures: &[Grey]) -> Picture {
    let (width, height) = pictures.first().map_or((1, 1), |p| (p.width, p.height));
    let rows = pictures.len().div_ceil(2) as u32;
    let mut rgba = vec![255; (2 * width * rows * height * 4) as usize];
    for (k, picture) in pictures.iter().enumerate() {
        let (left, top) = ((k % 2) as u32 * width, (k / 2) as u32 * height);
        for (n, value) in picture.values.iter().enumerate() {
            let (x, y) = (left + n as u32 % width, top + n as u32 / width);
            // Displays want the sRGB curve; about that.
            let shown = math::powf(f64::from(*value) / 255.0, 1.0 / 2.2) * 255.0;
            let at = ((y * 2 * width + x) * 4) as usize;
            rgba[at..at + 3].fill(shown as u8);
        }
    }
    Picture { width: 2 * width, height: rows * height, rgba }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |k: usize, other: &str| words.get(k).cloned().unwrap_or_else(|| other.to_owned());
    let number = |k: usize, other: f64| words.get(k).and_then(|w| w.parse().ok()).unwrap_or(other);
    let mut play = Play::new(number(1, 8.0) as usize, Path::Eight);
    let (body, scale) = match word(3, "small").as_str() {
        "truck" => (TRUCK, 1.0),
        "car" => (CAR, 4.0),
        "rover" => (ROVER, 1.0),
        _ => (Body::default(), 1.0),
    };
    let ground = word(4, "flat");
    furnish(
        &mut play.fleet,
        body,
        matches!(ground.as_str(), "hills" | "course"),
        ground != "flat" && ground != "hills",
    );
    let mut record = play.at(number(2, 12.0));
    enlarge(&mut record, scale);
    let mut record = grounded(&play.fleet, record);
    let gpu = Gpu::open(&AdapterChoice::from(word(5, "auto").as_str()))?;
    let mut eyes = GpuCameraRenderer::new(&gpu, &play.fleet)?;
    let whole = shots(&play.fleet, &mut record.snapshot);
    let near: Vec<_> = whole
        .iter()
        .zip(&play.fleet.edges)
        .map(|(shot, edge)| Shot {
            region: region_around(&play.fleet, &record.snapshot, shot, edge.leader),
            ..*shot
        })
        .collect();
    let fixed: Vec<_> = whole
        .iter()
        .map(|s| Shot { region: Region { x: 210, y: 160, width: 220, height: 160 }, ..*s })
        .collect();
    println!("{} shots of 220x160: {}", fixed.len(), median(&mut eyes, &record.snapshot, &fixed)?);
    println!("{} shots of shells: {}", near.len(), median(&mut eyes, &record.snapshot, &near)?);
    println!("{} shots of 640x480: {}", whole.len(), median(&mut eyes, &record.snapshot, &whole)?);
    let mut pictures = Vec::new();
    eyes.take(&record.snapshot, &whole, &mut pictures)?;
    Ok(png::write(word(0, "eyes.png").as_ref(), &sheet(&pictures[..pictures.len().min(4)]), &[])?)
}
