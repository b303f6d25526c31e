//! A film of a synthetic formation: `film FILE VIEW ROBOTS SECONDS RATE WIDTH HEIGHT ADAPTER`, all optional.

#[path = "../tests/stage/mod.rs"]
mod stage;

use film::{Film, FilmKind};
use rendering::{AdapterChoice, Gpu, PictureSpec, Renderer, Style, ViewLayout};
use stage::{Path, Play};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let start = Instant::now();
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |k: usize, other: &str| words.get(k).cloned().unwrap_or_else(|| other.to_owned());
    let number = |k: usize, other: f64| words.get(k).and_then(|w| w.parse().ok()).unwrap_or(other);
    let play = Play::new(number(2, 3.0) as usize, Path::named("eight"));
    let names: Vec<_> = play.fleet.robots.iter().map(|m| m.name.clone()).collect();
    let gpu = Gpu::open(&AdapterChoice::from(word(7, "auto").as_str()))?;
    let (width, height) = (number(5, 1280.0) as u32, number(6, 720.0) as u32);
    let rate = number(4, 30.0);
    let mut renderer = Renderer::new(&gpu, &play.fleet, width, height, 4)?;
    let layout = ViewLayout::parse(&word(1, "snake"), &names)?;
    let (mut trail, style) = (play.trail(0.0), Style::default());
    let file = word(0, "film.mp4");
    let path: &std::path::Path = file.as_ref();
    let mut film = Film::create(path, FilmKind::of(path, false)?, width, height, rate)?;
    for k in 0..(number(3, 15.0) * rate) as u32 {
        let record = play.at(f64::from(k) / rate);
        trail.push(&record);
        if let Some(picture) = renderer.draw_next(PictureSpec::new(&trail, &record, &layout, &style))? {
            film.push(picture)?;
        }
    }
    if let Some(picture) = renderer.finish()? {
        film.push(picture)?;
    }
    let frames = film.frames();
    film.finish()?;
    println!("{}: {frames} frames in {:?}", gpu.description(), start.elapsed());
    Ok(())
}
