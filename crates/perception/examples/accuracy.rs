//! How well leaders are located in synthetic pictures, by distance. `cargo run --release --example accuracy [scenes]`

#[path = "../tests/synthetic/mod.rs"]
mod synthetic;

use perception::detect::{Detector, Locus, identify, sharpen};
use perception::pose::{Prior, SeenFace, locate};
use std::time::{Duration, Instant};
use synthetic::{Scenes, sensor};
use vocabulary::{Grey, Pose, Region, wrap};

/// Sums of squares over scenes.
#[derive(Default)]
struct Rms {
    squares: [f64; 3],
    n: f64,
}

impl Rms {
    fn add(&mut self, found: &Pose, truth: &Pose) {
        let range = found.x.hypot(found.y) / truth.x.hypot(truth.y) - 1.0;
        let bearing = wrap(found.y.atan2(found.x) - truth.y.atan2(truth.x));
        let errors = [100.0 * range, bearing.to_degrees(), wrap(found.heading - truth.heading).to_degrees()];
        for (sum, error) in self.squares.iter_mut().zip(errors) {
            *sum += error * error;
        }
        self.n += 1.0;
    }

    fn text(&self) -> String {
        let [a, b, c] = self.squares.map(|s| (s / self.n).sqrt());
        format!("{a:.3}% {b:.4}° {c:.3}°")
    }
}

/// Root of the mean square and median distance of corners from where they should be.
fn corners(errors: &mut [f64]) -> String {
    errors.sort_by(f64::total_cmp);
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len().max(1) as f64).sqrt();
    format!("{rms:.3}/{:.3}", errors.get(errors.len() / 2).unwrap_or(&f64::NAN))
}

fn main() {
    let scenes: usize = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(200);
    let sigma: f64 = std::env::args().nth(2).and_then(|n| n.parse().ok()).unwrap_or(0.01);
    let flat = Prior::default();
    time_imaging();
    println!(
        "  ℓ  seen/frames  faces  wrong  2+: n | refined, 2 faces or more  | raw POSIT, same | detector's corners, refined | 1 face refined (n, ambiguous, flips) | corners px rms/median: ours, detector's | residual, z of heading, deviation px | ms detect, sharpen, locate, whole frame"
    );
    for distance in [0.8, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 6.0] {
        let mut views = Scenes::seeded(100 + (10.0 * distance) as u64);
        let mut sensor = sensor(views.lens);
        let optics = *sensor.optics();
        let mut detector = Locus::new();
        let (mut several, mut raw, mut theirs, mut single) =
            (Rms::default(), Rms::default(), Rms::default(), Rms::default());
        let (mut frames, mut seen, mut faces, mut visible, mut wrong, mut ambiguous, mut flips) =
            (0, 0, 0, 0, 0, 0, 0);
        let (mut off, mut off_theirs) = (vec![], vec![]);
        let (mut chi, mut times) = ([0.0; 3], [Duration::ZERO; 4]);
        for frame in 0..scenes {
            let scene = views.next(distance);
            let whole = Region::whole(&views.lens);
            let region = scene.region();
            let picture = scene.picture(&mut sensor, whole, frame as u64);
            let mut tags = vec![];
            let clock = Instant::now();
            detector.detect(&picture, &mut tags);
            times[3] += clock.elapsed();
            wrong += tags.iter().filter(|tag| scene.rig.shell.face_of(tag.id).is_none()).count();
            let part = cut(&picture, region);
            let clock = Instant::now();
            detector.detect(&part, &mut tags);
            times[0] += clock.elapsed();
            wrong += tags.iter().filter(|tag| scene.rig.shell.face_of(tag.id).is_none()).count();
            let shift = |tags: &mut [perception::detect::Tag]| {
                for c in tags.iter_mut().flat_map(|t| &mut t.corners) {
                    *c = [c[0] + f64::from(region.x), c[1] + f64::from(region.y)];
                }
            };
            let mut before = tags.clone();
            let clock = Instant::now();
            sharpen(&part, region, &optics, &mut tags);
            times[1] += clock.elapsed();
            shift(&mut tags);
            shift(&mut before);
            let found = identify(&tags, &scene.rig.shell);
            let plain = identify(&before, &scene.rig.shell);
            let compare = |out: &mut Vec<f64>, faces: &[SeenFace]| {
                for face in faces {
                    let truth = scene.corners(face.face).expect("in front");
                    out.extend(face.corners.iter().zip(truth).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])));
                }
            };
            compare(&mut off, &found);
            compare(&mut off_theirs, &plain);
            visible += scene.visible.len();
            faces += found.len();
            if scene.visible.is_empty() {
                continue;
            }
            frames += 1;
            let clock = Instant::now();
            let estimate = locate(&scene.rig, &found, sigma, &flat, None);
            times[2] += clock.elapsed();
            let Some(estimate) = estimate else {
                if distance <= 4.0 {
                    println!("missed: faces {:?} of {:?}, {} tags", found, scene.visible, tags.len());
                }
                continue;
            };
            seen += 1;
            let far = wrap(estimate.pose.heading - scene.pose.heading).abs() > 8_f64.to_radians();
            ambiguous += usize::from(estimate.ambiguous);
            flips += usize::from(far && !estimate.ambiguous);
            if found.len() > 1 {
                several.add(&estimate.pose, &scene.pose);
                let c = estimate.covariance;
                let bound = c[2][2].sqrt();
                chi[0] += estimate.residual.powi(2);
                chi[1] += (wrap(estimate.pose.heading - scene.pose.heading) / bound).powi(2);
                chi[2] += found.iter().map(|f| f.deviation).sum::<f64>() / found.len() as f64;
                if let Some(pose) = estimate.raw {
                    raw.add(&pose, &scene.pose);
                }
                if let Some(e) = locate(&scene.rig, &plain, 0.01, &flat, None) {
                    theirs.add(&e.pose, &scene.pose);
                }
            } else if !estimate.ambiguous {
                single.add(&estimate.pose, &scene.pose);
            }
        }
        let ms = times.map(|t| format!("{:.2}", t.as_secs_f64() * 1e3 / scenes as f64)).join(", ");
        println!(
            "{distance:4.1} {seen:4}/{frames:<4} {faces:4}/{visible:<4} {wrong:3} {:4} | {} | {} | {} | {} ({}, {ambiguous}, {flips}) | {}, {} | {:.3} {:.2} {:.3} | {ms}",
            several.n,
            several.text(),
            raw.text(),
            theirs.text(),
            single.text(),
            single.n,
            corners(&mut off),
            corners(&mut off_theirs),
            (chi[0] / several.n).sqrt(),
            (chi[1] / several.n).sqrt(),
            chi[2] / several.n,
        );
    }
}

/// How long a sensor takes over a picture.
fn time_imaging() {
    use perception::imaging::{Optics, Purpose, Sensor, noise_stream};
    use vocabulary::Lens;
    let bent = Lens { distortion: [-0.28, 0.09, 1e-3, -7e-4, -0.01], ..Lens::default() };
    for lens in [Lens::default(), bent] {
        let mut sensor = Sensor::new(Optics { lens, ..Optics::default() });
        for region in [Region { x: 200, y: 150, width: 200, height: 150 }, Region::whole(&lens)] {
            let Region { width, height, .. } = sensor.source(region).region;
            let ideal = Grey { width, height, values: vec![100; (width * height) as usize] };
            let (mut picture, clock) = (Grey::default(), Instant::now());
            for frame in 0..50 {
                sensor.expose(&ideal, region, &mut noise_stream(1, 0, frame, Purpose::Pixels), &mut picture);
            }
            let ms = clock.elapsed().as_secs_f64() * 1e3 / 50.0;
            println!(
                "sensor, distorting: {}, {} by {}: {ms:.2} ms",
                lens.distorts(),
                region.width,
                region.height
            );
        }
    }
}

/// A part of a picture.
fn cut(picture: &Grey, region: Region) -> Grey {
    let row = |y: u32| {
        let start = (y * picture.width + region.x) as usize;
        picture.values[start..start + region.width as usize].iter().copied()
    };
    let values = (region.y..region.y + region.height).flat_map(row).collect();
    Grey { width: region.width, height: region.height, values }
}
