//! Cost of a physics step: 1 to 1000 trucks that drive in curves, 5 ms a step, on one thread and on all.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::sync::Arc;
use vocabulary::{Command, Pose};
use world::{Physical, RobotSetup, Unicycle, World, WorldSetup};

#[path = "../tests/vehicles/truck.rs"]
mod truck;
use truck::truck;

const PERIOD: f64 = 0.01;
const STEPS_A_PERIOD: u64 = 2;

fn world(count: usize) -> Physical {
    let vehicle = Arc::new(truck());
    let actor = |k: usize| {
        let pose = Pose::new((k % 32) as f64 * 4.0, (k / 32) as f64 * 4.0, 0.3);
        let robot = Unicycle { pose, speed: 1.0, limits: vehicle.limits, body: vehicle.body, lead: None };
        RobotSetup { robot, wheels: Some(vehicle.clone()) }
    };
    let actors = (0..count).map(actor).collect();
    Physical::new(WorldSetup { actors, props: vec![], terrain: None, step: 0.005 })
}

fn cars(c: &mut Criterion) {
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let mut group = c.benchmark_group(format!("vehicle-steps of 5 ms, {threads} thread(s)"));
        for count in [1, 10, 100, 1000] {
            let mut world = world(count);
            let commands = vec![Command { acceleration: 0.0, turn_rate: 0.6 }; count];
            group.throughput(Throughput::Elements(count as u64 * STEPS_A_PERIOD));
            group.bench_function(BenchmarkId::from_parameter(count), |b| {
                // Within the pool, so that no time goes into calling it.
                pool.install(|| {
                    b.iter(|| {
                        world.apply(&commands);
                        world.advance(PERIOD);
                    });
                });
            });
        }
        group.finish();
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20).measurement_time(std::time::Duration::from_secs(3));
    targets = cars
}
criterion_main!(benches);
