//! What a frame in a window costs: medians of pairs that take turns, so that other work on the machine shows in both.
//! `window [ROBOTS BODY GROUND VIEW FRAMES]`, as for `still`.

#[path = "../tests/stage/course.rs"]
#[expect(dead_code, reason = "shared with tests")]
mod course;
#[path = "../tests/stage/mod.rs"]
#[expect(dead_code, reason = "shared with tests")]
mod stage;

use course::{CAR, enlarge, furnish, grounded};
use rendering::{AdapterChoice, Gpu, PictureSpec, Renderer, Style, Trail, ViewLayout};
use stage::{Path, Play};
use std::time::{Duration, Instant};
use vocabulary::{Body, StepRecord};

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort();
    times[times.len() / 2].as_secs_f64() * 1e3
}

fn texture(gpu: &Gpu, width: u32, height: u32) -> wgpu::TextureView {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn main() -> Result<(), rendering::Error> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |k: usize, other: &str| words.get(k).cloned().unwrap_or_else(|| other.to_owned());
    let robots = word(0, "7").parse().unwrap_or(7);
    let (body, scale) = if word(1, "car") == "car" { (CAR, 10.0) } else { (Body::default(), 1.0) };
    let ground = word(2, "flat");
    let frames = word(4, "25").parse::<i32>().unwrap_or(25);
    let mut play = Play::new(robots, Path::named("eight"));
    let (hills, props) = (matches!(&*ground, "hills" | "course"), matches!(&*ground, "props" | "course"));
    furnish(&mut play.fleet, body, hills, props);
    let at = |time: f64| {
        let mut record = play.at(time);
        enlarge(&mut record, scale);
        grounded(&play.fleet, record)
    };
    let mut trail = Trail::new(&play.fleet);
    let past: Vec<StepRecord> = (0..6_000).map(|k| at(0.01 * f64::from(k))).collect();
    let start = Instant::now();
    for record in &past {
        trail.push(record);
    }
    println!("push: {:.2} µs", start.elapsed().as_secs_f64() * 1e6 / past.len() as f64);
    let start = Instant::now();
    let copies: Vec<_> = (0..100).map(|_| trail.clone()).collect();
    println!("clone: {:.1} µs", start.elapsed().as_secs_f64() * 1e6 / copies.len() as f64);
    let mut now = 60.0;
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let layout = ViewLayout::parse(&word(3, "snake"), &[])?;
    let styled = |list: &str| -> Result<Style, rendering::Error> {
        let names: Vec<_> = list.split(',').filter(|w| !w.is_empty() && !w.starts_with('(')).collect();
        Ok(Style { interactive: list == "(interactive)", ..Style::without(&names)? })
    };
    // Still: where nothing moved but the eye.
    let styles = [
        "",
        "(still)",
        "(interactive)",
        "shadows",
        "ghosts",
        "ribbons,marks",
        "inset,caption,time,names,labels,grid",
    ];
    println!("{:>10} {:>7} {:>38} {:>8} {:>8}", "size", "samples", "without", "prepare", "frame");
    for (width, height) in [(800, 560), (1280, 800)] {
        for samples in [4, 1] {
            let mut renderer = Renderer::new(&gpu, &play.fleet, width, height, samples)?;
            let view = texture(&gpu, width, height);
            let mut times = vec![(Vec::new(), Vec::new()); styles.len()];
            for _ in 0..frames {
                for (list, (prepared, whole)) in styles.iter().zip(&mut times) {
                    let style = styled(list)?;
                    now += if *list == "(still)" { 0.0 } else { 0.01 };
                    let record = at(now);
                    let start = Instant::now();
                    renderer.draw_into(&view, PictureSpec::new(&trail, &record, &layout, &style))?;
                    prepared.push(start.elapsed());
                    let waited = gpu.device.poll(wgpu::PollType::wait_indefinitely());
                    waited.map_err(|e| rendering::Error::Device(e.to_string()))?;
                    whole.push(start.elapsed());
                }
            }
            for (list, (prepared, whole)) in styles.iter().zip(times) {
                println!(
                    "{width:>5}x{height:<4} {samples:>7} {list:>38} {:>8.2} {:>8.2}",
                    median(prepared),
                    median(whole)
                );
            }
        }
    }
    Ok(())
}
