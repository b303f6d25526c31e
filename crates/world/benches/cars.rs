//! Cost of a physics step: 1 to 1000 trucks that drive in curves, 5 ms a step, on one thread and on all.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::sync::Arc;
use vocabulary::{Body, Command, Limits, Pose};
use world::wheeled::tyre::Tyre;
use world::{Actor, Drivetrain, Physical, Stage, Unicycle, Wheeled, World};

const PERIOD: f64 = 0.01;
const STEPS_A_PERIOD: u64 = 2;

fn truck() -> Wheeled {
    let body =
        Body { length: 0.49, width: 0.39, height: 0.32, wheelbase: 0.30, track: 0.285, wheel_radius: 0.0825 };
    let limits = Limits {
        speed_min: 0.01,
        speed_max: 4.0,
        turn_rate_max: 8.0,
        acceleration_max: 4.0,
        curvature_max: 1.77,
        lateral_acceleration_max: 7.0,
    };
    Wheeled {
        body,
        limits,
        mass: 5.01,
        mass_height: 0.11,
        mass_forward: 0.5,
        inertia_scale: 1.0,
        clearance: 0.075,
        spring: 700.0,
        damping: 40.0,
        travel: 0.04,
        tyre: Tyre { friction: 0.9, cornering: 12.0, relaxation: 0.06, rolling: 0.03 },
        drag: 0.02,
        drivetrain: Drivetrain::Steered { angle_max: 0.49, rate: 5.0, lag: 0.08 },
        drive_force: 30.0,
        drive_lag: 0.1,
        brake_force: 35.0,
        brake_lag: 0.05,
        compensation: true,
        speed_gain: 4.0,
        turn_gain: 0.5,
    }
}

fn world(count: usize) -> Physical {
    let vehicle = Arc::new(truck());
    let actor = |k: usize| {
        let pose = Pose::new((k % 32) as f64 * 4.0, (k / 32) as f64 * 4.0, 0.3);
        let robot = Unicycle { pose, speed: 1.0, limits: vehicle.limits, body: vehicle.body, lead: None };
        Actor { robot, wheels: Some(vehicle.clone()) }
    };
    let actors = (0..count).map(actor).collect();
    Physical::new(Stage { actors, props: vec![], terrain: None, step: 0.005 })
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
                b.iter(|| {
                    pool.install(|| {
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
