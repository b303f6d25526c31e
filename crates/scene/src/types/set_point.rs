//! What one channel of a set point does in time.

use crate::text::{
    Form, Found, Node, Reporter, Value, angle, angle_within, form::Number, keys, list, number, table,
};

use serde_json::{Value as Json, json};
use std::f64::consts::{PI, TAU};
use vocabulary::{Ramp, ScalarTrajectory};

/// Defines the form `$form` of a channel out of the forms of a value that holds, of a value that is passed through,
/// and of an amplitude.
macro_rules! channel {
    ($(#[doc = $doc:literal])* $form:ident, $wave:ident, $interpolant:ident, $held:expr, $passed:expr, $amplitude:expr) => {
        keys! {
            /// A sinusoid: mean + amplitude · sin(rate · t).
            struct $wave {
                /// In the middle, m or rad.
                mean: f64 = $held, required;
                /// Swing to either side, m or rad.
                amplitude: f64 = $amplitude, required;
                /// Rate of the sine, rad/s.
                rate: f64 = number("rad/s").up_to(1000.0), required;
            }
        }

        keys! {
            /// A smooth passage from one value to another.
            struct $interpolant {
                /// Value before, m or rad; in a list the one where the last passage ended, if left out.
                from: f64 = $passed, optional;
                /// Value after, m or rad.
                to: f64 = $passed, required;
                /// When it starts, s.
                start: f64 = number("s").from(0.0), required;
                /// How long it takes, s.
                over: f64 = number("s").above(0.0), required;
            }
        }

        $(#[doc = $doc])*
        pub(crate) struct $form;

        impl Form for $form {
            type Out = ScalarTrajectory;

            fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<ScalarTrajectory> {
                let passages = match &node.value {
                    Value::Table(_) if node.get("mean").is_some() || node.get("to").is_none() => {
                        let keys = table::<$wave>().read(node, reporter)?;
                        let (mean, amplitude, rate) = (keys.mean?.value, keys.amplitude?.value, keys.rate?.value);
                        return Some(ScalarTrajectory::Sinusoid { mean, amplitude, rate });
                    }
                    Value::Table(_) => vec![table::<$interpolant>().read(node, reporter)?],
                    Value::List(_) => list(table::<$interpolant>(), 1, 1000).read(node, reporter)?,
                    _ => return $held.read(node, reporter).map(ScalarTrajectory::Constant),
                };
                let passages = passages.into_iter().map(|p| Some((p.from, p.to?.value, p.start?, p.over?.value)));
                chain(node, passages.collect::<Option<Vec<_>>>()?, reporter)
            }

            fn schema(&self) -> Json {
                let interpolant = table::<$interpolant>();
                json!({ "anyOf": [
                    $held.schema(), table::<$wave>().schema(), interpolant.schema(), list(interpolant, 1, 1000).schema(),
                ] })
            }
        }
    };
}

channel!(
    /// A wanted distance.
    DistanceForm, DistanceWave, DistancePassage, DISTANCE, DISTANCE, number("m")
);
channel!(
    /// A wanted bearing.
    BearingForm, BearingWave, BearingPassage, angle(), angle_within(-TAU, TAU), angle_within(-PI, PI)
);

/// A distance between two robots.
const DISTANCE: Number = number("m").above(0.0).up_to(1000.0);

/// One passage as it was read: from, to, start, over.
type StepInterpolant = (Option<Found<f64>>, f64, Found<f64>, f64);

/// Passages in the order of time, each from where the last one ended.
fn chain(node: &Node, passages: Vec<StepInterpolant>, reporter: &mut Reporter) -> Option<ScalarTrajectory> {
    let mut ramps: Vec<Ramp> = Vec::with_capacity(passages.len());
    for (from, to, start, over) in passages {
        let last = ramps.last();
        let Some(value) = from.as_ref().map(|from| from.value).or(last.map(|last| last.to)) else {
            reporter.report(node.span, "`from` is missing: the first passage has to say where it starts");
            return None;
        };
        if let Some(last) = last {
            if start.value < last.start + last.over {
                let free = last.start + last.over;
                reporter.report(start.span, format!("this starts before the last passage ends at {free} s"));
            }
            if let Some(from) = from.filter(|from| from.value != last.to) {
                reporter
                    .report(from.span, format!("`from` must be {}, where the last passage ended", last.to));
            }
        }
        ramps.push(Ramp { from: value, to, start: start.value, over });
    }
    Some(ScalarTrajectory::Ramps(ramps))
}
