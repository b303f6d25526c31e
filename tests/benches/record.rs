//! What recording costs: whole runs of three scenes with their tables, without and with the log. The second over the
//! first is what the log adds; `records` is the time to read them all back.

use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};
use recording::log::{FILE, Log};
use recording::{Recorder, RunOptions, Status};
use scene::Scene;
use simulation::{Simulation, build};
use std::hint::black_box;
use std::path::Path;
use studies::run_options;

fn load(name: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    Scene::load(folder.join(name).with_extension("toml"), &[]).expect("a scene").scene
}

/// Runs a scene and records it; the folder, for as long as it is wanted.
fn record(scene: &Scene, no_log: bool) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let mut run = Simulation::new(build(scene).expect("a formation"));
    let options = RunOptions { no_log, ..run_options(scene) };
    let mut recorder = Recorder::create(folder.path(), run.fleet(), options).expect("a recorder");
    while let Some(record) = run.next_record() {
        recorder.push(record).expect("recorded");
    }
    recorder.finish(Status::Complete).expect("finished");
    folder
}

fn runs(c: &mut Criterion) {
    let mut group = c.benchmark_group("record");
    group.sample_size(20);
    for name in ["line-three", "cars-seven-v", "hundred"] {
        let scene = load(name);
        for (what, no_log) in [("tables", true), ("tables and log", false)] {
            group.bench_function(BenchmarkId::new(what, name), |b| {
                b.iter_batched(|| (), |()| record(&scene, no_log), BatchSize::PerIteration);
            });
        }
        let folder = record(&scene, false);
        group.bench_function(BenchmarkId::new("moments", name), |b| {
            b.iter(|| {
                let log = Log::open(&folder.path().join(FILE)).expect("a log");
                log.records().for_each(|record| drop(black_box(record)));
            });
        });
    }
    group.finish();
}

criterion_group!(benches, runs);
criterion_main!(benches);
