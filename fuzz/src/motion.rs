//! Way-points to motion.

use scene::Scene;
use simulation::Simulation;
use std::fmt::Write;
use std::path::Path;

/// Samples that are driven.
const SAMPLES: usize = 1500;

/// Any way-points make a motion that is finite, or are refused in words. The first byte says whether the way is closed and
/// how fast it is driven; each point is four more, hundredths of a metre.
pub fn way_points(data: &[u8]) {
    let Some((first, rest)) = data.split_first() else { return };
    let points = rest.chunks_exact(4).take(40).map(|c| {
        [i16::from_le_bytes([c[0], c[1]]), i16::from_le_bytes([c[2], c[3]])].map(|v| f64::from(v) * 0.01)
    });
    let mut text = String::new();
    for [x, y] in points {
        // Writing to a text cannot fail.
        let _ = write!(text, "[{x}, {y}], ");
    }
    let (closed, speed) = (first % 2 == 1, 0.1 + 0.1 * f64::from(first / 2 % 16));
    let text = format!(
        "schema = 1\ntitle = \"t\"\n[time]\nduration = 1000.0\n[[robots]]\nname = \"a\"\n\
         path = {{ kind = \"waypoints\", points = [{text}], closed = {closed}, speed = {speed} }}\n"
    );
    let Ok(loaded) = Scene::parse(&text, Path::new("scene.toml"), &[]) else { return };
    let Ok(setup) = simulation::build(&loaded.scene) else { return };
    let mut simulation = Simulation::new(setup);
    for _ in 0..SAMPLES {
        let Some(record) = simulation.next_record() else { break };
        let motion = record.snapshot.robots[0].motion;
        let numbers = [
            motion.pose.x,
            motion.pose.y,
            motion.pose.heading,
            motion.speed,
            motion.acceleration,
            motion.turn_rate,
        ];
        assert!(numbers.iter().all(|number| number.is_finite()), "{motion:?}\n{text}");
    }
}
