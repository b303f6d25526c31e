//! Forms: what a value may look like. Each reads its value, says what is wrong with it, and describes itself to
//! the JSON Schema, so that the reader and the schema cannot disagree.

use crate::text::{Node, Reporter, Value};
use serde_json::{Value as Json, json};
use std::{
    f64::consts::{PI, TAU},
    marker::PhantomData,
};
use vocabulary::wrap;

/// What a value may look like.
pub(crate) trait Form {
    /// What it is read into.
    type Out;

    /// The value, or `None` after reporting what is wrong with it.
    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Self::Out>;

    /// Its JSON Schema.
    fn schema(&self) -> Json;
}

/// Numbers that differ from their bounds by rounding only still count as inside, angles of 180 deg above all.
const ROUNDING: f64 = 1e-12;

/// A number in a range.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Number {
    unit: &'static str,
    low: f64,
    open: bool,
    high: f64,
    infinite: bool,
}

/// A finite number of any sensible size; `unit` is for messages, the schema and axes.
pub(crate) const fn number(unit: &'static str) -> Number {
    Number { unit, low: -1e6, open: false, high: 1e6, infinite: false }
}

impl Number {
    /// Larger than `low`.
    pub(crate) const fn above(self, low: f64) -> Self {
        Self { low, open: true, ..self }
    }

    /// At least `low`.
    pub(crate) const fn from(self, low: f64) -> Self {
        Self { low, open: false, ..self }
    }

    /// At most `high`.
    pub(crate) const fn up_to(self, high: f64) -> Self {
        Self { high, ..self }
    }

    /// `inf` is fine too.
    pub(crate) const fn or_infinite(self) -> Self {
        Self { infinite: true, ..self }
    }

    /// What it has to be, in words.
    pub(crate) fn expected(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" in {}", self.unit) };
        let infinite = if self.infinite { ", or inf" } else { "" };
        let (low, and) = if self.open { ("above", "and at most") } else { ("from", "to") };
        format!("a number{unit} {low} {} {and} {}{infinite}", self.low, self.high)
    }

    /// Whether `value` is in range.
    pub(crate) fn holds(&self, value: f64) -> bool {
        let low = if self.open { value > self.low } else { value >= self.low };
        low && (value <= self.high || (self.infinite && value == f64::INFINITY))
    }
}

impl Form for Number {
    type Out = f64;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<f64> {
        let value = node.as_number().filter(|value| self.holds(*value));
        reporter.expect(value, node, || self.expected())
    }

    fn schema(&self) -> Json {
        let low = if self.open { "exclusiveMinimum" } else { "minimum" };
        let high = if self.infinite { json!(null) } else { json!(self.high) };
        let mut schema = json!({ "type": "number", low: self.low });
        if !high.is_null() {
            schema["maximum"] = high;
        }
        if !self.unit.is_empty() {
            schema["x-unit"] = json!(self.unit);
        }
        schema
    }
}

/// An angle: a number in rad, or text with a unit such as "135 deg".
#[derive(Debug, Clone, Copy)]
pub(crate) struct Angle {
    low: f64,
    high: f64,
    wrapped: bool,
}

/// An angle of at most half a turn either way, read into (−π, π].
pub(crate) const fn angle() -> Angle {
    Angle { low: -PI, high: PI, wrapped: true }
}

/// An angle from `low` to `high` in rad; it stays as it is written.
pub(crate) const fn angle_within(low: f64, high: f64) -> Angle {
    Angle { low, high, wrapped: false }
}

/// An angle of up to `turns` either way, read into (−π, π].
pub(crate) const fn angle_of_turns(turns: f64) -> Angle {
    Angle { low: -turns * TAU, high: turns * TAU, wrapped: true }
}

impl Form for Angle {
    type Out = f64;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<f64> {
        let value = node.as_number().or_else(|| node.as_text().and_then(angle_of_text));
        let value = value.filter(|v| *v >= self.low - ROUNDING && *v <= self.high + ROUNDING);
        let expected = || {
            let [low, high] = [self.low, self.high].map(|bound| (bound.to_degrees() * 1e6).round() / 1e6);
            format!("an angle, in rad or as \"135 deg\", from {low} deg to {high} deg")
        };
        let value = reporter.expect(value, node, expected)?.clamp(self.low, self.high);
        Some(if self.wrapped { wrap(value) } else { value })
    }

    fn schema(&self) -> Json {
        let [low, high] = [self.low - ROUNDING, self.high + ROUNDING];
        json!({ "anyOf": [
            { "type": "number", "minimum": low, "maximum": high, "x-unit": "rad" },
            { "type": "string", "pattern": r"^\s*[-+]?[0-9.]+([eE][-+]?[0-9]+)?\s*(deg|°|rad)\s*$" },
        ] })
    }
}

fn angle_of_text(text: &str) -> Option<f64> {
    let text = text.trim();
    let degrees = text.strip_suffix("deg").or_else(|| text.strip_suffix('°'));
    let (number, in_degrees) = match degrees {
        Some(number) => (number, true),
        None => (text.strip_suffix("rad")?, false),
    };
    let value: f64 = number.trim_end().parse().ok()?;
    Some(if in_degrees { value.to_radians() } else { value })
}

/// A whole number in a range.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Integer<T>(u64, u64, PhantomData<T>);

/// A whole number from `low` to `high`.
pub(crate) const fn integer<T: TryFrom<u64>>(low: u64, high: u64) -> Integer<T> {
    Integer(low, high, PhantomData)
}

impl<T: TryFrom<u64>> Form for Integer<T> {
    type Out = T;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<T> {
        let Self(low, high, _) = *self;
        let value = match node.value {
            Value::Integer(value) => u64::try_from(value).ok().filter(|value| (low..=high).contains(value)),
            _ => None,
        };
        let value = value.and_then(|value| T::try_from(value).ok());
        let range = || format!("a whole number from {low} to {high}");
        reporter.expect(value, node, || if low == high { low.to_string() } else { range() })
    }

    fn schema(&self) -> Json {
        json!({ "type": "integer", "minimum": self.0, "maximum": self.1 })
    }
}

/// `true` or `false`.
pub(crate) struct Flag;

impl Form for Flag {
    type Out = bool;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<bool> {
        let flag = if let Value::Flag(flag) = node.value { Some(flag) } else { None };
        reporter.expect(flag, node, || "true or false".to_owned())
    }

    fn schema(&self) -> Json {
        json!({ "type": "boolean" })
    }
}

/// Any text of up to so many characters.
pub(crate) struct Text(pub(crate) usize);

impl Form for Text {
    type Out = String;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<String> {
        let value = node.as_text().filter(|text| text.chars().count() <= self.0);
        reporter.expect(value, node, || format!("text of at most {} characters", self.0)).map(str::to_owned)
    }

    fn schema(&self) -> Json {
        json!({ "type": "string", "maxLength": self.0 })
    }
}

/// A value without a default, which may be left out altogether.
pub(crate) struct Optional<F>(pub(crate) F);

impl<F: Form> Form for Optional<F> {
    type Out = Option<F::Out>;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Self::Out> {
        self.0.read(node, reporter).map(Some)
    }

    fn schema(&self) -> Json {
        self.0.schema()
    }
}
