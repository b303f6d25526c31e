//! Law files.

use crate::scenes::in_words;
use laws::{CustomLaw, Fault, Input, LEADERS_MAX, LawFile, LeaderInput, Noise};
use vocabulary::{Command, MotionInput, Relative, SetPoint};

/// Samples that a law decides with each of the numbers it is told.
const SAMPLES: u64 = 3;

/// Any text is a law, or is refused in words. A law ends, whatever it is told; it gives finite numbers, or says in words what is
/// at fault.
pub fn law_file(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let law = match LawFile::compile(&text) {
        Ok(law) => law,
        Err(mistakes) => {
            assert!(!mistakes.is_empty() && mistakes.len() <= 20, "{} mistakes", mistakes.len());
            assert!(mistakes.windows(2).all(|pair| pair[0].place <= pair[1].place), "{mistakes:?}");
            for mistake in mistakes {
                assert!(mistake.place <= mistake.end, "{mistake:?}");
                in_words(&mistake.to_string());
            }
            return;
        }
    };
    let again = LawFile::compile(law.text()).expect("the same text");
    assert!(again.declaration() == law.declaration(), "the same text declares something else");
    let plain: Vec<f64> = law.declaration().parameters.iter().map(|parameter| parameter.default).collect();
    for told in [0.7, 0.0, -0.0, -1e-3, 1e9, -1e300, f64::MIN_POSITIVE, f64::INFINITY, f64::NAN] {
        let leaders = [told_of_leader(told); LEADERS_MAX];
        for parameters in [&plain, &vec![told; plain.len()]] {
            drive(&law, &leaders, told, parameters);
        }
    }
}

/// A leader of which every number is `x`, or near it.
pub(crate) fn told_of_leader(x: f64) -> LeaderInput {
    LeaderInput {
        relative: Relative { distance: x, bearing: -x, view_angle: x / 2.0 },
        rates: [x, -x],
        wanted: SetPoint { value: [x, x], rate: [-x, x], acceleration: [x, -x] },
        motion: MotionInput { speed: x, acceleration: -x, turn_rate: x, turn_acceleration: -x },
        frame: [x, x],
        heading: -x,
    }
}

/// Lets a law decide some samples, in each of which it gives finite numbers or says in words why it does not.
pub(crate) fn drive(law: &dyn CustomLaw, leaders: &[LeaderInput], told: f64, parameters: &[f64]) {
    let declaration = law.declaration();
    let mut memory = vec![0.0; declaration.memory.len()];
    let mut shown = vec![0.0; declaration.shown.len()];
    for sample in 0..SAMPLES {
        let input = Input {
            time: told,
            period: 0.01,
            own_speed: told,
            own_acceleration: -told,
            own_turn_rate: told,
            leaders,
            noise: Noise { seed: 1, robot: 2, sample },
        };
        if sample == 0
            && let Err(fault) = law.start(&input, parameters, &mut memory)
        {
            in_words(&fault.to_string());
            memory.fill(0.5);
        }
        if declaration.continuous {
            let mut rates = vec![0.0; memory.len()];
            judge(&law.derive(&input, parameters, &memory, &mut rates), &rates);
        }
        let decided = law.decide(&input, parameters, &mut memory, &mut shown);
        judge(&decided, &memory);
    }
}

fn judge(decided: &Result<Command, Fault>, numbers: &[f64]) {
    match decided {
        Ok(command) => {
            assert!(command.acceleration.is_finite() && command.turn_rate.is_finite(), "{command:?}");
            assert!(numbers.iter().all(|number| number.is_finite()), "{numbers:?}");
        }
        Err(fault) => in_words(&fault.to_string()),
    }
}
