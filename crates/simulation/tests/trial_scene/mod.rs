//! Random maps as scenes.

use planning::{Convex, trial};
use std::fmt::Write;
use vocabulary::math;

/// The scene of a map: seven in a V from one corner to the other.
pub(crate) fn trial_scene(seed: u64, count: usize, vehicle: &str) -> String {
    let map = trial::map(seed, count);
    // On wheels with the gains of `cars-seven-v`: steering takes its time.
    let gains = if vehicle == "car" { "k = 2.0\nbeta = 1.5\nslope = 8.0" } else { "" };
    let mut text = format!(
        r#"schema = 1
title = "Map {seed}"
seed = {seed}
[time]
duration = 160.0
[vehicle]
kind = "{vehicle}"
acceleration_max = 3.0
turn_rate_max = 3.0
[law]
{gains}
heading = "path"
standing = true
[proximity]
range = 8.0
[safety]
filter = true
[narrowing]
narrows = true
[[groups]]
name = "robot"
shape = "v"
count = 7
pose = [8.0, 8.0, "45 deg"]
distance = 2.0
scatter = 0.1
path = {{ kind = "goal", pose = [33, 33, "45 deg"] }}
"#
    );
    for (number, obstacle) in map.obstacles().iter().enumerate() {
        // Writing to a text cannot fail.
        let _ = writeln!(text, "[[props]]\nname = \"thing-{number}\"\n{}", solid(obstacle));
    }
    text
}

fn solid(obstacle: &Convex) -> String {
    let [x, y] = obstacle.centre();
    let corners: Vec<[f64; 2]> = obstacle.corners().collect();
    let [a, b, c, ..] = corners.as_slice() else {
        return format!(
            "shape = \"cylinder\"\npose = [{x}, {y}, 0]\nradius = {}\nheight = 1.0",
            obstacle.radius()
        );
    };
    let side = |p: &[f64; 2], q: &[f64; 2]| math::hypot(q[0] - p[0], q[1] - p[1]);
    let heading = math::atan2(b[1] - a[1], b[0] - a[0]);
    format!("shape = \"block\"\npose = [{x}, {y}, {heading}]\nsize = [{}, {}, 1.0]", side(a, b), side(b, c))
}
