//! Tests.

use super::LawFile;
use crate::{CustomLaw, Input, LeaderInput, Noise};

#[test]
fn explore() {
    let text = std::fs::read_to_string("/tmp/lang-try.law").unwrap();
    match LawFile::compile(&text) {
        Err(mistakes) => mistakes.iter().for_each(|m| println!("{m}  (to {})", m.end)),
        Ok(law) => {
            let d = law.declaration();
            println!("{d:#?}\n{} instructions", law.instructions());
            let leaders = [LeaderInput::default(); 4];
            let input = Input {
                time: 1.0,
                period: 0.01,
                own_speed: 1.0,
                own_acceleration: 0.0,
                own_turn_rate: 0.0,
                leaders: &leaders,
                noise: Noise::default(),
            };
            let p: Vec<f64> = d.parameters.iter().map(|p| p.default).collect();
            let mut m = vec![0.0; d.memory.len()];
            let mut s = vec![0.0; d.shown.len()];
            println!("{:?}", law.start(&input, &p, &mut m));
            println!("{m:?}");
            println!("{:?}", law.decide(&input, &p, &mut m, &mut s));
            println!("{m:?} {s:?}");
        }
    }
}
