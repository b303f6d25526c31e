//! Simulated seconds per second: columns of 3 to 1000 robots under each law, and shipped scenes; nothing recorded.
//!
//! Throughput is in steps; at the control period of 10 ms a hundred steps are a second, so 500 000 steps a second
//! are 5000 times real time.

use criterion::{BatchSize, Bencher, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use scene::Scene;
use simulation::{Setup, Simulation, build};
use std::hint::black_box;

/// Control samples in a run of one simulated second.
const STEPS: u64 = 101;

fn scene(robots: usize, law: &str, mode: &str) -> String {
    format!(
        "schema = 1\ntitle = \"bench\"\n[time]\nduration = 1.0\nmode = \"{mode}\"\n[law]\nkind = \"{law}\"\n\
         [[groups]]\nshape = \"v\"\ncount = {robots}\nname = \"robot\"\nfollows = \"leader\"\nscatter = 0.1\n\
         distance = 0.8\npath = {{ kind = \"circle\", speed = 0.05, turn_rate = 0.001 }}\n"
    )
}

/// Steps a run to its end; setting it up does not count.
fn whole_run(b: &mut Bencher<'_>, setup: &Setup) {
    b.iter_batched_ref(
        || Simulation::new(setup.clone()),
        |run| {
            while let Some(record) = run.next_record() {
                black_box(record);
            }
        },
        BatchSize::LargeInput,
    );
}

fn seconds_per_second(c: &mut Criterion) {
    let mut group = c.benchmark_group("simulate");
    group.sample_size(20);
    for (law, mode) in [
        ("robust-state", "sampled"),
        ("full-state", "sampled"),
        ("output-feedback", "sampled"),
        ("output-feedback", "measured"),
    ] {
        for robots in [3, 7, 100, 1000] {
            let text = scene(robots, law, mode);
            let loaded = Scene::parse(&text, "bench.toml", &[]).expect("a scene");
            let setup = build(&loaded.scene).expect("a formation");
            group.throughput(Throughput::Elements(STEPS));
            group.bench_with_input(BenchmarkId::new(format!("{law}, {mode}"), robots), &setup, whole_run);
        }
    }
    group.finish();
}

/// Every kind of vehicle, a yard of props, noise, geometric sensing and continuous time: shipped scenes over a second.
fn shipped_scenes(c: &mut Criterion) {
    let mut group = c.benchmark_group("shipped");
    group.sample_size(20);
    for (name, what, set) in [
        ("cars-seven-v", "own", None),
        ("cars-mixed", "own", None),
        ("cars-yard", "own", None),
        ("cars-rough", "own", None),
        ("seven-v", "noise", Some("sensing.kind=noise")),
        ("circle-three", "geometric", Some("sensing.kind=geometric")),
        ("circle-three", "continuous", Some("time.mode=continuous")),
    ] {
        let shipped = scene::shipped(name).expect("a shipped scene");
        let set = ["time.duration=1.0"].into_iter().chain(set);
        let set: Vec<_> = set.map(|text| text.parse().expect("an override")).collect();
        let loaded = Scene::parse(shipped.text, name, &set).expect("a scene");
        let setup = build(&loaded.scene).expect("a formation");
        group.throughput(Throughput::Elements(STEPS));
        group.bench_with_input(BenchmarkId::new(name, what), &setup, whole_run);
    }
    group.finish();
}

criterion_group!(benches, seconds_per_second, shipped_scenes);
criterion_main!(benches);
