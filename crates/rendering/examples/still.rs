//! A still of a synthetic formation: `still FILE VIEW ROBOTS PATH TIME WIDTH HEIGHT SCALE ADAPTER`, all optional.

#[path = "../tests/stage/mod.rs"]
mod stage;

use rendering::{AdapterChoice, Gpu, Layout, Renderer, Style, png};
use stage::{Path, Play};
use std::time::Instant;

fn main() -> Result<(), rendering::Error> {
    let start = Instant::now();
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |k: usize, other: &str| words.get(k).cloned().unwrap_or_else(|| other.to_owned());
    let number = |k: usize, other: f64| words.get(k).and_then(|w| w.parse().ok()).unwrap_or(other);
    let play = Play::new(number(2, 3.0) as usize, Path::named(&word(3, "eight")));
    let names: Vec<_> = play.cast.members.iter().map(|m| m.name.clone()).collect();
    let time = number(4, 12.0);
    let gpu = Gpu::open(&AdapterChoice::from(word(8, "auto").as_str()))?;
    let opened = start.elapsed();
    let (width, height) = (number(5, 1280.0) as u32, number(6, 720.0) as u32);
    let mut renderer = Renderer::new(&gpu, &play.cast, width, height, 4)?;
    let built = start.elapsed();
    let trail = play.trail(time);
    let style = Style { scale: number(7, 1.0), ..Style::default() };
    let layout = Layout::parse(&word(1, "snake"), &names)?;
    let moment = play.at(time);
    let picture = renderer.draw(&trail, &moment, &layout, &style)?;
    let drawn = start.elapsed();
    let file = word(0, "still.png");
    png::write(file.as_ref(), &picture, &[("Adapter", &gpu.description())])?;
    println!(
        "{}: open {opened:?}, build {built:?}, drawn {drawn:?}, written {:?}",
        gpu.description(),
        start.elapsed()
    );
    let mut times: Vec<_> = (0..15)
        .map(|_| {
            let start = Instant::now();
            renderer.draw(&trail, &moment, &layout, &style).map(|_| start.elapsed())
        })
        .collect::<Result<_, _>>()?;
    times.sort();
    println!("median of 15 frames {:?}", times[7]);
    Ok(())
}
