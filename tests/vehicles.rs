//! Formations of wheeled vehicles: gains that fit them, and that the physics step does not matter.

use metrics::{Metrics, MetricsBuilder};
use scene::Scene;
use simulation::{Simulation, build};
use std::path::Path;
use vocabulary::Judging;
use vocabulary::math;

fn run(name: &str, overrides: &[&str]) -> Metrics {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    let overrides: Vec<_> = overrides.iter().map(|o| o.parse().expect("an override")).collect();
    let scene = Scene::load(path, &overrides).expect("a scene").scene;
    let mut simulation = Simulation::new(build(&scene).expect("a formation"));
    let settled_after = scene.expect.settled_after.unwrap_or(0.0);
    let judging = Judging { settling_band: scene.expect.settling_band, settled_after };
    let mut metrics = MetricsBuilder::new(simulation.fleet(), judging);
    while let Some(record) = simulation.next_record() {
        metrics.push(record);
    }
    metrics.finish()
}

/// Halving the physics step changes the settled errors by less than 5 %.
#[test]
fn settled_errors_do_not_hang_on_the_physics_step() {
    for name in ["cars-line-three.toml", "cars-circle-three.toml"] {
        let settled = |step: &str| {
            run(name, &[step])
                .edges
                .iter()
                .map(|e| math::hypot(e.final_error[0], 2.0 * e.final_error[1]))
                .collect::<Vec<_>>()
        };
        for (coarse, fine) in settled("physics.step=0.005").iter().zip(settled("physics.step=0.0025")) {
            assert!((coarse / fine - 1.0).abs() < 0.05, "{name}: {coarse} m at 5 ms, {fine} m at 2.5 ms");
        }
    }
}

/// With the paper's gains the actuators' lags make a limit cycle; with gains that fit them there is none.
#[test]
fn the_papers_gains_circle_on_wheels() {
    let circling = run("cars-limit-cycle.toml", &[]);
    let settled = run("cars-line-three.toml", &[]);
    let largest = |m: &Metrics| m.edges.iter().map(|e| e.late_peak_error[0]).fold(0.0, f64::max);
    assert!(
        largest(&circling) > 0.05 && largest(&settled) < 0.02,
        "{} {}",
        largest(&circling),
        largest(&settled)
    );
}
