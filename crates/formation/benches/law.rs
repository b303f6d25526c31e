//! What one law evaluation and one observer step cost.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use formation::Heading;
use formation::relative::Geometry;
use formation::{Estimate, Law, LawInput, Observer, Switching};
use std::hint::black_box;
use vocabulary::{EdgeSample, LawKind, MotionInput, Relative, SetPoint, Track};

fn relative(t: f64) -> Relative {
    Relative { distance: 2.1 + 0.3 * t, bearing: -2.3 - 0.2 * t, view_angle: -2.2 + 0.4 * t }
}

fn laws(c: &mut Criterion) {
    let mut group = c.benchmark_group("law");
    let set_point = SetPoint { value: [2.0, -2.3], ..SetPoint::default() };
    let leader = MotionInput { speed: 1.0, turn_rate: 0.3, ..MotionInput::default() };
    for kind in [LawKind::FullState, LawKind::RobustState, LawKind::OutputFeedback] {
        let law = Law {
            kind,
            gain: [5.0; 2],
            robust_gain: [5.0; 2],
            switching: Switching::Tanh([24.53; 2]),
            distance_min: 0.1,
            heading: Heading::Leader,
        };
        group.bench_function(format!("{kind:?}"), |b| {
            b.iter(|| {
                let geometry = Geometry::new(&black_box(relative(0.0)), 0.1);
                law.command(&LawInput {
                    geometry: &geometry,
                    error: [-0.1, 0.05],
                    set_point: &set_point,
                    rates: [0.1, 0.2],
                    own_speed: 0.9,
                    leader: &leader,
                })
            });
        });
    }
    group.finish();
}

fn observers(c: &mut Criterion) {
    let mut group = c.benchmark_group("observer, period 10 ms");
    let sample =
        |t: f64| EdgeSample { relative: relative(t), own_speed: 0.9 + t, acceleration: 1.0, turn_rate: -0.5 };
    let track = Track { duration: 0.01, samples: Track::NODES.map(|n| sample(n * 0.01)) };
    let estimate = Estimate { output: [2.1, -2.3], rates: [0.2, -0.1] };
    for epsilon in [1e-5, 1e-3, 1e-2, 1.0] {
        let observer =
            Observer { epsilon: [epsilon; 2], alpha1: [2.0; 2], alpha2: [1.0; 2], distance_min: 0.1 };
        group.bench_with_input(BenchmarkId::new("sampled, epsilon", epsilon), &observer, |b, observer| {
            b.iter(|| observer.follow(&estimate, black_box(&track)));
        });
        group.bench_with_input(BenchmarkId::new("measured, epsilon", epsilon), &observer, |b, observer| {
            b.iter(|| observer.follow_samples(&estimate, black_box(&sample(0.0)), &relative(0.01), 0.01));
        });
    }
    group.finish();
}

criterion_group!(benches, laws, observers);
criterion_main!(benches);
