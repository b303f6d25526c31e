//! Tests of the language as a whole: what texts mean, and what is said of those that mean nothing.

mod any_text;
mod faults;
mod mistakes;
mod page;
mod statements;
mod totality;
mod values;

use super::LawFile;
use crate::{CustomLaw, Fault, Input, LeaderInput, Noise};
use vocabulary::{Command, MotionInput, Relative, SetPoint};

fn compiled(text: &str) -> LawFile {
    LawFile::compile(text).unwrap_or_else(|mistakes| {
        let lines: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
        panic!("{}\nin\n{text}", lines.join("\n"))
    })
}

/// The mistakes in a text, such as "1:9-1:12 nothing is called `abc`".
fn mistakes(text: &str) -> Vec<String> {
    match LawFile::compile(text) {
        Ok(_) => vec![],
        Err(mistakes) => mistakes.iter().map(|m| format!("{}-{} {}", m.place, m.end, m.message)).collect(),
    }
}

/// The mistakes in a law that has `text` and a command.
fn mistakes_of(text: &str) -> Vec<String> {
    mistakes(&format!("{text}\ncommand = 0, 0"))
}

/// What a law is told: every number is another one.
fn leaders() -> [LeaderInput; 4] {
    [0.0, 1.0, 2.0, 3.0].map(|k| LeaderInput {
        relative: Relative { distance: 2.0 + k, bearing: 0.5 + k, view_angle: -0.25 - k },
        rates: [0.125 + k, -0.375 - k],
        wanted: SetPoint {
            value: [3.0 + k, 1.5 + k],
            rate: [0.1 + k, 0.2 + k],
            acceleration: [0.3 + k, 0.4 + k],
        },
        motion: MotionInput {
            speed: 1.1 + k,
            acceleration: 0.6 + k,
            turn_rate: 0.7 + k,
            turn_acceleration: 0.8 + k,
        },
        frame: [0.9 + k, 1.9 + k],
        heading: 0.05 + k,
    })
}

fn input(leaders: &[LeaderInput]) -> Input<'_> {
    Input {
        time: 1.5,
        period: 0.01,
        own_speed: 0.75,
        own_acceleration: -0.5,
        own_turn_rate: 0.25,
        leaders,
        noise: Noise { seed: 7, robot: 2, sample: 41 },
    }
}

/// What a run of samples leaves: the last command, memory and shown quantities.
#[derive(Debug)]
struct Run {
    command: Command,
    memory: Vec<f64>,
    shown: Vec<f64>,
}

fn run(law: &LawFile, samples: usize) -> Result<Run, Fault> {
    let leaders = leaders();
    let mut input = input(&leaders);
    let declaration = law.declaration();
    let parameters: Vec<f64> = declaration.parameters.iter().map(|parameter| parameter.default).collect();
    let mut memory = vec![0.0; declaration.memory.len()];
    let mut shown = vec![0.0; declaration.shown.len()];
    law.start(&input, &parameters, &mut memory)?;
    let mut command = Command::default();
    for _ in 0..samples {
        command = law.decide(&input, &parameters, &mut memory, &mut shown)?;
        input.noise.sample += 1;
    }
    Ok(Run { command, memory, shown })
}

/// The quantities that the statements of `text` show after a sample.
fn shown(text: &str) -> Vec<f64> {
    run(&compiled(&format!("{text}\ncommand = 0, 0")), 1).expect("a sample").shown
}

fn fault(text: &str) -> String {
    run(&compiled(text), 1).expect_err("a fault").to_string()
}
