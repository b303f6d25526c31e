//! A still of a synthetic formation: `still FILE VIEW ROBOTS PATH TIME WIDTH HEIGHT SCALE ADAPTER BODY GROUND WITHOUT CAMERA`, all
//! optional; BODY is small, truck, car or rover, GROUND flat, props, hills or course;
//! CAMERA is the index of a robot whose view is shown in a corner. Views through cameras show what was detected.

#[path = "../tests/stage/course.rs"]
mod course;
#[path = "../tests/stage/sight.rs"]
mod sight;
#[path = "../tests/stage/mod.rs"]
mod stage;

use course::{CAR, ROVER, TRUCK, enlarge, furnish, grounded, overturn, touch};
use film::png;
use rendering::{AdapterChoice, Gpu, PictureSpec, Renderer, Style, Trail, ViewLayout};
use sight::measurements;
use stage::{Path, Play};
use std::time::Instant;
use vocabulary::{Body, StepRecord};

/// The play with its bodies and its ground, and how large it is.
fn staged(robots: usize, path: &str, body: &str, ground: &str) -> (Play, f64) {
    let mut play = Play::new(robots, Path::named(path));
    let (body, scale) = match body {
        "truck" => (TRUCK, 1.0),
        "car" => (CAR, 10.0),
        "rover" => (ROVER, 1.0),
        _ => (Body::default(), 1.0),
    };
    let props = matches!(ground, "props" | "course");
    furnish(&mut play.fleet, body, matches!(ground, "hills" | "course"), props);
    (play, scale)
}

/// A moment on that ground; on a course the last robot ends on its roof.
fn record(play: &Play, scale: f64, wreck: f64, time: f64) -> StepRecord {
    let mut record = play.at(time);
    enlarge(&mut record, scale);
    let mut record = grounded(&play.fleet, record);
    let last = play.fleet.robots.len() - 1;
    if time > wreck {
        overturn(&play.fleet, &mut record, last);
        let robot = record.snapshot.robots[last];
        let (pose, height) = (robot.motion.pose, robot.attitude.height);
        record.contacts.push(touch(0, wreck + 0.1, [pose.x + 0.3, pose.y - 0.1, height - 0.2]));
    }
    record
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let start = Instant::now();
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |k: usize, other: &str| words.get(k).cloned().unwrap_or_else(|| other.to_owned());
    let number = |k: usize, other: f64| words.get(k).and_then(|w| w.parse().ok()).unwrap_or(other);
    let ground = word(10, "flat");
    let (play, scale) = staged(number(2, 3.0) as usize, &word(3, "eight"), &word(9, "small"), &ground);
    let names: Vec<_> = play.fleet.robots.iter().map(|m| m.name.clone()).collect();
    let time = number(4, 12.0);
    let gpu = Gpu::open(&AdapterChoice::from(word(8, "auto").as_str()))?;
    let opened = start.elapsed();
    let (width, height) = (number(5, 1280.0) as u32, number(6, 720.0) as u32);
    let mut renderer = Renderer::new(&gpu, &play.fleet, width, height, 4)?;
    let built = start.elapsed();
    let wreck = if ground == "course" { time - 0.22 } else { f64::INFINITY };
    let mut trail = if words.len() > 9 { Trail::new(&play.fleet) } else { play.trail(time) };
    for k in 0..=(time * 30.0) as i32 {
        trail.push(&record(&play, scale, wreck, f64::from(k) / 30.0));
    }
    let without = word(11, "");
    let mut style = Style::without(
        &without.split(',').filter(|w| !w.is_empty() && *w != "detections").collect::<Vec<_>>(),
    )?;
    style.scale = number(7, 1.0);
    let layout = ViewLayout::parse(&word(1, "snake"), &names)?;
    let mut record = record(&play, scale, wreck, time);
    measurements(&play.fleet, &mut record);
    style.detections = !without.contains("detections");
    style.picture_in_picture = words.get(12).and_then(|w| w.parse().ok());
    let picture = renderer.draw(PictureSpec::new(&trail, &record, &layout, &style))?;
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
            renderer.draw(PictureSpec::new(&trail, &record, &layout, &style)).map(|_| start.elapsed())
        })
        .collect::<Result<_, _>>()?;
    times.sort();
    println!("median of 15 frames {:?}", times[7]);
    Ok(())
}
