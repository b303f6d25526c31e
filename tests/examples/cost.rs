//! What the log costs: pairs of runs with their tables, without and with it; medians of time and of ratios.
//!
//! `cargo run --release -p tests --example cost -- [PAIRS] [SCENE…]`

use recording::{Recorder, RunOptions, Status};
use scene::Scene;
use simulation::{Simulation, build};
use std::path::Path;
use std::time::Instant;
use studies::run_options;

/// Runs a scene and records it; ms.
fn record(scene: &Scene, no_log: bool) -> f64 {
    let folder = tempfile::tempdir().expect("a folder");
    let mut run = Simulation::new(build(scene).expect("a formation"));
    let options = RunOptions { no_log, ..run_options(scene) };
    let began = Instant::now();
    let mut recorder = Recorder::create(folder.path(), run.fleet(), options).expect("a recorder");
    while let Some(record) = run.next_record() {
        recorder.push(record).expect("recorded");
    }
    recorder.finish(Status::Complete).expect("finished");
    began.elapsed().as_secs_f64() * 1e3
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn main() {
    let mut words = std::env::args().skip(1);
    let pairs: usize = words.next().and_then(|text| text.parse().ok()).unwrap_or(15);
    let asked: Vec<String> = words.collect();
    let usual = ["line-three", "cars-seven-v", "hundred"].map(str::to_owned);
    for name in if asked.is_empty() { usual.to_vec() } else { asked } {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(&name).with_extension("toml");
        let scene = Scene::load(&path, &[]).expect("a scene").scene;
        let times: Vec<[f64; 2]> =
            (0..pairs).map(|_| [true, false].map(|no_log| record(&scene, no_log))).collect();
        let [tables, both] = [0, 1].map(|k| median(times.iter().map(|pair| pair[k]).collect()));
        let ratio = median(times.iter().map(|pair| pair[1] / pair[0]).collect());
        let least = [0, 1].map(|k| times.iter().map(|pair| pair[k]).fold(f64::INFINITY, f64::min));
        println!(
            "{name}: {tables:.1} ms with tables, {both:.1} ms with the log too; median of ratios {ratio:.3}, \
             ratio of the shortest {:.3}",
            least[1] / least[0]
        );
    }
}
