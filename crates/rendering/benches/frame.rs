//! How long a frame takes, per view, size and number of robots, and how many frames a second a film is made at.
//!
//! `cargo bench -p rendering` prints medians; other work on the machine shows in them.

#[path = "../tests/stage/course.rs"]
#[expect(dead_code, reason = "shared with tests")]
mod course;
#[path = "../tests/stage/sight.rs"]
#[expect(dead_code, reason = "shared with tests")]
mod sight;
#[path = "../tests/stage/mod.rs"]
mod stage;

use course::{TRUCK, furnish};
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use film::{Film, FilmKind};
use rendering::{AdapterChoice, Gpu, GpuCameraRenderer, PictureSpec, Renderer, Style, ViewLayout};
use sight::shots;
use stage::{Path, Play};
use vocabulary::{Region, Shot};

fn gpu() -> Gpu {
    let adapter = std::env::var("ECHELON_ADAPTER").unwrap_or_default();
    Gpu::open(&AdapterChoice::from(adapter.as_str())).expect("benchmarks need a graphics adapter")
}

fn frames(criterion: &mut Criterion) {
    let gpu = gpu();
    let mut group = criterion.benchmark_group(format!("frame ({})", gpu.info().backend));
    group.sample_size(20);
    let sizes = [(1280, 720), (640, 360), (1920, 1080)];
    let cases = [
        ("snake", 3, 4),
        ("snake", 3, 1),
        ("snake", 7, 4),
        ("snake", 100, 4),
        ("top", 3, 4),
        ("snake+top", 3, 4),
    ];
    for (width, height) in sizes {
        for (view, robots, samples) in cases {
            if (width, view, robots, samples) != (1280, view, robots, samples)
                && (view, robots, samples) != cases[0]
            {
                continue;
            }
            let play = Play::new(robots, Path::named("eight"));
            let Ok(mut renderer) = Renderer::new(&gpu, &play.fleet, width, height, samples) else { continue };
            let (trail, record, style) = (play.trail(12.0), play.at(12.0), Style::default());
            let Ok(layout) = ViewLayout::parse(view, &[]) else { continue };
            group.bench_function(
                format!("{view}, {robots} robots, {width}x{height}, {samples} samples"),
                |b| {
                    b.iter(|| renderer.draw(PictureSpec::new(&trail, &record, &layout, &style)));
                },
            );
        }
    }
    group.finish();
}

fn film(criterion: &mut Criterion) {
    let gpu = gpu();
    let play = Play::new(3, Path::named("eight"));
    let count = 45_u32;
    let records: Vec<_> = (0..count).map(|k| play.at(f64::from(k) / 30.0)).collect();
    let layout = ViewLayout::single(rendering::Viewpoint::Snake);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut group = criterion.benchmark_group("film");
    group.sample_size(10).throughput(Throughput::Elements(u64::from(count)));
    group.bench_function("snake, 3 robots, 1280x720, mp4", |b| {
        let mut renderer = Renderer::new(&gpu, &play.fleet, 1280, 720, 4).expect("a renderer");
        b.iter_batched(
            || play.trail(0.0),
            |mut trail| -> Result<(), Box<dyn std::error::Error>> {
                let mut film = Film::create(&folder.path().join("a.mp4"), FilmKind::Mp4, 1280, 720, 30.0)?;
                for record in &records {
                    trail.push(record);
                    if let Some(picture) =
                        renderer.draw_next(PictureSpec::new(&trail, record, &layout, &Style::default()))?
                    {
                        film.push(picture)?;
                    }
                }
                if let Some(picture) = renderer.finish()? {
                    film.push(picture)?;
                }
                Ok(film.finish()?)
            },
            BatchSize::PerIteration,
        );
    });
    group.finish();
}

/// Seven cameras on trucks, each of which looks at its leader.
fn eyes(criterion: &mut Criterion) {
    let gpu = gpu();
    let mut play = Play::new(8, Path::named("eight"));
    furnish(&mut play.fleet, TRUCK, false, false);
    let mut snapshot = play.at(12.0).snapshot;
    let whole = shots(&play.fleet, &mut snapshot);
    let part = |shot: &Shot| Shot { region: Region { x: 210, y: 160, width: 220, height: 160 }, ..*shot };
    let parts: Vec<_> = whole.iter().map(part).collect();
    let mut group = criterion.benchmark_group("eyes");
    group.sample_size(30);
    for (name, shots) in [("7 of 220x160", &parts), ("7 of 640x480", &whole)] {
        let Ok(mut eyes) = GpuCameraRenderer::new(&gpu, &play.fleet) else { continue };
        let mut pictures = Vec::new();
        group.bench_function(name, |b| b.iter(|| eyes.take(&snapshot, shots, &mut pictures)));
    }
    group.finish();
}

criterion_group!(benches, frames, film, eyes);
criterion_main!(benches);
