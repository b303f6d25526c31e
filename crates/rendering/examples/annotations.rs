//! What annotations look like: `annotations FILE VIEW ROBOTS PATH TIME WIDTH HEIGHT BODY GROUND QUICK`, all optional; BODY and
//! GROUND as for `still`, QUICK is `interactive` for a picture as in a window.

#[path = "../tests/stage/course.rs"]
#[expect(dead_code, reason = "shared with tests")]
mod course;
#[path = "../tests/stage/mod.rs"]
#[expect(dead_code, reason = "shared with tests")]
mod stage;

use course::{CAR, ROVER, TRUCK, enlarge, furnish, grounded};
use film::png;
use rendering::{
    AdapterChoice, AnnotationArrow, AnnotationStroke, Annotations, Ghost, Gpu, PictureSpec, Renderer, Ring,
    ShadedArea, StrokePoint, Style, Trail, ViewLayout, robot_colours,
};
use stage::{Path, Play};
use vocabulary::{Body, Pose, StepRecord};

/// Every kind of thing, `size` times as large as for small robots.
fn sketched(play: &Play, at: &dyn Fn(f64) -> StepRecord, time: f64, size: f64) -> Annotations {
    let now = at(time);
    let colours = robot_colours(&play.fleet);
    let pose = |record: &StepRecord, k: usize| record.snapshot.robots[k].motion.pose;
    let place = |p: Pose| [p.x, p.y];
    let mut annotations = Annotations::default();
    let ahead: Vec<StepRecord> = (0..=60).map(|k| at(time + 0.1 * f64::from(k))).collect();
    let last = ahead.len() - 1;
    for (robot, colour) in colours.iter().enumerate() {
        let places: Vec<_> = ahead.iter().map(|m| place(pose(m, robot))).collect();
        let colour = if robot == 0 { [0.89, 0.70, 0.25] } else { *colour };
        let mut stroke = AnnotationStroke::fading(&places, colour, 0.9);
        if robot == 1 {
            for spot in &mut stroke.spots[18..30] {
                *spot = StrokePoint { colour: [1.0, 0.18, 0.12], alpha: 0.95, ..*spot };
            }
        }
        stroke.dashed = robot % 2 == 0;
        annotations.strokes.push(stroke);
        if robot > 0 {
            annotations.ghosts.push(Ghost { robot, pose: pose(&ahead[last], robot), alpha: 0.28 });
        }
    }
    let colour = |k: usize| colours[k.min(colours.len() - 1)];
    let beside =
        |k: usize, forward: f64, left: f64| pose(&now, k).world_from_body(forward * size, left * size);
    annotations.rings.push(Ring::new(beside(1, 0.0, 0.9), 0.2 * size, colour(1)).selected());
    annotations.rings.push(Ring::new(beside(1, -0.9, 0.9), 0.2 * size, colour(1)).hovered());
    annotations.rings.push(Ring::new(beside(1, -1.8, 0.9), 0.2 * size, colour(1)));
    annotations.rings.push(Ring { glow: 0.5, ..Ring::new(beside(2, 0.13, 0.0), 0.36 * size, [1.0; 3]) });
    let arrow = |from: [f64; 2], to: [f64; 2]| AnnotationArrow {
        from,
        to,
        gaps: [0.3 * size; 2],
        colour: [0.98, 0.85, 0.4],
        alpha: 0.9,
    };
    annotations.arrows.push(arrow(beside(0, 0.13, 0.0), beside(2, 0.13, 0.0)));
    // Ground inside of the turn, softer towards its edge.
    let (columns, step) = (25, 0.1 * size);
    let corner = beside(2, 0.4, -2.6);
    let alpha = |k: usize| {
        let [x, y] = [(k % columns) as f32, (k / columns) as f32].map(|c| c / 12.0 - 1.0);
        0.55 * ((1.0 - x.hypot(y)) * 3.0).clamp(0.0, 1.0)
    };
    let alphas: Vec<_> = (0..columns * columns).map(alpha).collect();
    annotations.areas.push(ShadedArea::field(corner, step, columns, &alphas, [0.93, 0.25, 0.2], true));
    annotations
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |k: usize, other: &str| words.get(k).cloned().unwrap_or_else(|| other.to_owned());
    let number = |k: usize, other: f64| words.get(k).and_then(|w| w.parse().ok()).unwrap_or(other);
    let (body, scale) = match word(7, "small").as_str() {
        "truck" => (TRUCK, 1.0),
        "car" => (CAR, 10.0),
        "rover" => (ROVER, 1.0),
        _ => (Body::default(), 1.0),
    };
    let ground = word(8, "flat");
    let mut play = Play::new(number(2, 3.0) as usize, Path::named(&word(3, "eight")));
    furnish(
        &mut play.fleet,
        body,
        matches!(ground.as_str(), "hills" | "course"),
        matches!(ground.as_str(), "props" | "course"),
    );
    let at = |time: f64| {
        let mut record = play.at(time);
        enlarge(&mut record, scale);
        grounded(&play.fleet, record)
    };
    let time = number(4, 12.0);
    let mut trail = Trail::new(&play.fleet);
    for k in 0..=(time * 30.0) as i32 {
        trail.push(&at(f64::from(k) / 30.0));
    }
    let names: Vec<_> = play.fleet.robots.iter().map(|m| m.name.clone()).collect();
    let layout = ViewLayout::parse(&word(1, "snake"), &names)?;
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let mut renderer =
        Renderer::new(&gpu, &play.fleet, number(5, 1280.0) as u32, number(6, 800.0) as u32, 4)?;
    let interactive = word(9, "") == "interactive";
    let style = Style { annotations: sketched(&play, &at, time, scale), interactive, ..Style::default() };
    let picture = renderer.draw(PictureSpec::new(&trail, &at(time), &layout, &style))?;
    Ok(png::write(word(0, "annotations.png").as_ref(), &picture, &[("Adapter", &gpu.description())])?)
}
