//! Time of the filter of one robot, with what a crowd of eight and three views ask.

use criterion::{Criterion, criterion_group, criterion_main};
use safety::{Filter, HalfPlane, Wish};
use std::hint::black_box;
use vocabulary::{Command, Constraint, SafetyState, math};

/// Rows around the origin; `room` is what each leaves of it.
fn rows(count: usize, room: f64, name: impl Fn(usize) -> Constraint) -> Vec<HalfPlane> {
    (0..count)
        .map(|k| {
            let (sin, cos) = math::sin_cos(0.7 + k as f64 * 2.4);
            HalfPlane {
                normal: [0.1 * cos, 0.235 * sin],
                bound: -room,
                constraint: name(k),
                value: 0.1,
                direction: 0.0,
            }
        })
        .collect()
}

fn filter(c: &mut Criterion) {
    let wish = Wish {
        command: Command { acceleration: 2.0, turn_rate: 1.5 },
        acceleration: [-3.0, 3.0],
        turn_rate: 3.0,
        speed: 0.8,
    };
    let view = |k: usize| [Constraint::ViewDistance, Constraint::ViewLeft, Constraint::ViewRight][k];
    let views = rows(3, 0.2, view);
    let (mut filter, mut state) = (Filter::default(), SafetyState::default());
    for (name, room) in [("eight_barriers", 0.1), ("eight_barriers_in_conflict", -0.1)] {
        let collisions = rows(8, room, Constraint::Robot);
        c.bench_function(name, |b| {
            b.iter(|| filter.apply(black_box(&wish), black_box(&collisions), &views, &mut state));
        });
    }
}

criterion_group!(benches, filter);
criterion_main!(benches);
