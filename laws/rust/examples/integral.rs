//! Output feedback with an integral of the error, in Rust: the same law as `laws/integral.law`, which says what it computes.
#![no_std]

use echelon_law::{Command, Told, cos, law, sin, wrap};

law! {
    declaration: r#"{
        "title": "Output feedback with an integral of the error, in Rust",
        "parameters": [
            { "name": "k1", "unit": "1/s", "default": 5, "range": [0.5, 20],
              "help": "double pole of the distance error without integral" },
            { "name": "k2", "unit": "1/s", "default": 5, "range": [0.5, 20],
              "help": "double pole of the bearing error without integral" },
            { "name": "T", "unit": "s", "default": 1, "range": [0.2, 20], "scale": "logarithmic",
              "help": "integral time, above 1/(2 k)" }
        ],
        "memory": [
            { "name": "sum_distance", "unit": "m s" }, { "name": "sum_bearing", "unit": "rad s" },
            { "name": "asked_acceleration", "unit": "m/s^2" }, { "name": "asked_turn_rate", "unit": "rad/s" }
        ]
    }"#,
    told: Told,
    parameters: Parameters,
    memory: Memory,
    shown: (),
    decide: decide,
}

#[repr(C)]
struct Parameters {
    k: [f64; 2],
    integral_time: f64,
}

#[repr(C)]
struct Memory {
    sum: [f64; 2],
    asked: [f64; 2],
}

fn decide(told: &Told, own: &Parameters, memory: &mut Memory, _: &mut ()) -> Command {
    let leader = &told.leaders[0];
    let (l, v) = (leader.distance, told.own_speed);
    let (sg, cg) = (sin(leader.view_angle), cos(leader.view_angle));
    let e = [leader.wanted_distance - l, wrap(leader.wanted_bearing - leader.bearing)];
    let de = [
        leader.wanted_distance_rate - leader.distance_rate,
        leader.wanted_bearing_rate - leader.bearing_rate,
    ];
    let wanted = [leader.wanted_distance_acceleration, leader.wanted_bearing_acceleration];
    let g0 = [-v * v / l, 0.0];
    let gs = [v * cg / l, -2.0 * v * sg / (l * l)];
    let b = [0, 1].map(|i| {
        let k = own.k[i];
        let sum = memory.sum[i] / own.integral_time;
        wanted[i] + g0[i] + gs[i] * leader.distance_rate + 2.0 * k * de[i] + k * k * (e[i] + sum)
    });
    let near = |applied: f64, asked: f64| (applied - asked).abs() < 1e-6;
    if near(told.own_acceleration, memory.asked[0]) && near(told.own_turn_rate, memory.asked[1]) {
        memory.sum = [0, 1].map(|i| memory.sum[i] + told.period * e[i]);
    }
    memory.asked = [cg * b[0] - sg * l * b[1], (sg * b[0] + cg * l * b[1]) / v];
    Command { acceleration: memory.asked[0], turn_rate: memory.asked[1] }
}
