//! What a law file costs beside the same law in Rust: output feedback (eq 42) with an observer of its own (eqs 31-32), 11 numbers
//! of memory. Both give the same bits.

use criterion::{Criterion, criterion_group, criterion_main};
use laws::{CustomLaw, Input, LawFile, LeaderInput, Noise};
use std::hint::black_box;
use vocabulary::{Relative, SetPoint, math, wrap};

const TEXT: &str = include_str!("backward-observer.law");
/// k, beta1, beta2, slope1, slope2, epsilon, lowest.
const PARAMETERS: [f64; 7] = [5.0, 5.0, 5.0, 24.53, 24.53, 0.001, 0.1];
const NUMBERS: usize = 11;

/// The law in Rust, each operation in the order of the text.
fn native(input: &Input<'_>, parameters: &[f64; 7], m: &mut [f64; NUMBERS]) -> [f64; 2] {
    let [k, beta1, beta2, slope1, slope2, epsilon, lowest] = *parameters;
    let leader = &input.leaders[0];
    let (l, psi, h) = (leader.relative.distance, leader.relative.bearing, input.period);
    if m[0] == 0.0 {
        m[0] = 1.0;
        m[1] = l;
        m[2] = psi;
    } else {
        let (alpha1, alpha2) = (2.0, 1.0);
        let q = m[5].max(lowest);
        let (sg, cg) = (math::sin(m[7]), math::cos(m[7]));
        let slope_d = (l - m[5]) / h;
        let slope_b = wrap(psi - m[6]) / h;
        let c0 = m[8] / q * cg;
        let c1 = -2.0 * m[8] / q * sg / q;
        let f0 = cg * m[9] + m[8] * sg * m[10] + m[8] * m[8] / q - c0 * slope_d;
        let f1 = -(sg / q) * m[9] + m[8] * cg / q * m[10] - c1 * slope_d;
        let mut d1 = (m[1] - m[5]) / epsilon;
        let mut e1 = wrap(m[2] - m[6]) / epsilon;
        let mut d2 = m[3] - slope_d;
        let mut e2 = m[4] - slope_b;
        let t = h / 4.0;
        let r = t / epsilon;
        for _ in 0..4 {
            let determinant = (1.0 + alpha1 * r) * (1.0 + t * c0) + alpha2 * r * r;
            let b2 = d2 + t * f0;
            let next_d1 = (d1 * (1.0 + t * c0) + r * b2) / determinant;
            let next_d2 = ((1.0 + alpha1 * r) * b2 - alpha2 * r * d1) / determinant;
            let other = (1.0 + alpha1 * r) + alpha2 * r * r;
            let b3 = e2 + t * (f1 - c1 * next_d2);
            let next_e1 = (e1 + r * b3) / other;
            let next_e2 = ((1.0 + alpha1 * r) * b3 - alpha2 * r * e1) / other;
            (d1, d2, e1, e2) = (next_d1, next_d2, next_e1, next_e2);
        }
        m[1] = l + d1 * epsilon;
        m[2] = psi + e1 * epsilon;
        m[3] = slope_d + d2;
        m[4] = slope_b + e2;
    }
    let q = l.max(lowest);
    let v = input.own_speed;
    let (sin, cos) = (math::sin(leader.relative.view_angle), math::cos(leader.relative.view_angle));
    let wanted = &leader.wanted;
    let error = [wanted.value[0] - l, wrap(wanted.value[1] - psi)];
    let b0 = wanted.acceleration[0] - v * v / q
        + v / q * cos * m[3]
        + 2.0 * k * (wanted.rate[0] - m[3])
        + k * k * error[0]
        + beta1 * math::tanh(slope1 * error[0]);
    let b1 = wanted.acceleration[1] - 2.0 * v / q * sin / q * m[3]
        + 2.0 * k * (wanted.rate[1] - m[4])
        + k * k * error[1]
        + beta2 * math::tanh(slope2 * error[1]);
    let across = q * b1;
    let acceleration = cos * b0 - sin * across;
    let turn_rate = ((sin * b0 + cos * across) / v).clamp(-11.5, 11.5);
    m[5..].copy_from_slice(&[l, psi, leader.relative.view_angle, v, acceleration, turn_rate]);
    [acceleration, turn_rate]
}

/// What a follower sees in sample `k` of a smooth run.
fn seen(k: usize) -> LeaderInput {
    let t = k as f64 * 0.01;
    let bearing = wrap(-2.35 + 0.2 * math::cos(0.5 * t));
    LeaderInput {
        relative: Relative {
            distance: 2.0 + 0.3 * math::sin(0.7 * t),
            bearing,
            view_angle: wrap(bearing + 0.1 * math::sin(0.3 * t)),
        },
        wanted: SetPoint { value: [2.0, -2.356], ..SetPoint::default() },
        ..LeaderInput::default()
    }
}

fn input(leaders: &[LeaderInput], k: usize) -> Input<'_> {
    Input {
        time: k as f64 * 0.01,
        period: 0.01,
        own_speed: 1.0 + 0.2 * math::cos(k as f64 * 0.009),
        own_acceleration: 0.0,
        own_turn_rate: 0.0,
        leaders,
        noise: Noise::default(),
    }
}

const SAMPLES: usize = 500;

fn law_file(criterion: &mut Criterion) {
    let law = LawFile::compile(TEXT).expect("a law");
    let told: Vec<[LeaderInput; 1]> = (0..SAMPLES).map(|k| [seen(k)]).collect();
    let inputs: Vec<Input<'_>> = told.iter().enumerate().map(|(k, told)| input(told, k)).collect();
    let mut shown = vec![0.0; law.declaration().shown.len()];
    let (mut ours, mut theirs) = ([0.0; NUMBERS], [0.0; NUMBERS]);
    for input in &inputs {
        let command = law.decide(input, &PARAMETERS, &mut ours, &mut shown).expect("a command");
        let native = native(input, &PARAMETERS, &mut theirs);
        assert_eq!([command.acceleration, command.turn_rate].map(f64::to_bits), native.map(f64::to_bits));
        assert_eq!(ours.map(f64::to_bits), theirs.map(f64::to_bits));
    }
    let mut group = criterion.benchmark_group("output feedback with its observer");
    group.bench_function("law file", |bencher| {
        let mut at = 0;
        bencher.iter(|| {
            at = (at + 1) % SAMPLES;
            law.decide(black_box(&inputs[at]), &PARAMETERS, &mut ours, &mut shown)
        });
    });
    group.bench_function("Rust", |bencher| {
        let mut at = 0;
        bencher.iter(|| {
            at = (at + 1) % SAMPLES;
            native(black_box(&inputs[at]), black_box(&PARAMETERS), &mut theirs)
        });
    });
    group.finish();

    let mut group = criterion.benchmark_group("shipped");
    for shipped in laws::SHIPPED_LAWS {
        let law = LawFile::compile(shipped.text).expect("a law");
        let leaders = [seen(0); laws::LEADERS_MAX];
        let input = input(&leaders, 0);
        let parameters: Vec<f64> = law.declaration().parameters.iter().map(|p| p.default).collect();
        let mut memory = vec![0.0; law.declaration().memory.len()];
        let mut shown = vec![0.0; law.declaration().shown.len()];
        law.start(&input, &parameters, &mut memory).expect("a start");
        let start = memory.clone();
        group.bench_function(shipped.name, |bencher| {
            bencher.iter(|| {
                memory.copy_from_slice(&start);
                law.decide(black_box(&input), &parameters, &mut memory, &mut shown)
            });
        });
    }
    group.finish();
    criterion.bench_function("compile", |bencher| bencher.iter(|| LawFile::compile(black_box(TEXT))));
}

criterion_group!(benches, law_file);
criterion_main!(benches);
