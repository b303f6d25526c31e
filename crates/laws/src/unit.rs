//! Units of the numbers of a law: powers of the metre and the second. A radian is a number, as in SI.

use std::fmt;
use std::hash::{Hash, Hasher};
use vocabulary::math;

/// Powers of metre and second, in twelfths, so that roots and thirds of powers are exact.
///
/// Two units are the same where these powers are; that angles count in radians is remembered for [`fmt::Display`] alone.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unit {
    /// Power of the metre, in twelfths.
    pub metre: i16,
    /// Power of the second, in twelfths.
    pub second: i16,
    /// Power of the radian, which is a number.
    radian: i8,
}

/// Twelfths in a power of one.
const WHOLE: i16 = 12;
/// The largest power of metre or second.
const POWER_MAX: i16 = 100;

impl Unit {
    /// A number without a unit, and an angle in rad.
    pub const NUMBER: Self = Self::new(0, 0);
    /// An angle in rad: a number that is shown with "rad".
    pub const ANGLE: Self = Self::NUMBER.angular();

    /// The unit with whole powers of metre and second.
    pub const fn new(metre: i16, second: i16) -> Self {
        Self { metre: WHOLE * metre, second: WHOLE * second, radian: 0 }
    }

    /// The same unit, shown as that of an angle: "rad/s" in place of "1/s".
    #[must_use]
    pub const fn angular(self) -> Self {
        Self { radian: 1, ..self }
    }

    /// Whether it is shown as "rad".
    pub fn is_angle(self) -> bool {
        self == Self::NUMBER && self.radian == 1
    }

    /// The unit of a product; none where a power is beyond all use.
    pub fn multiply(self, other: Self) -> Option<Self> {
        Self::within(
            i32::from(self.metre) + i32::from(other.metre),
            i32::from(self.second) + i32::from(other.second),
            i32::from(self.radian) + i32::from(other.radian),
        )
    }

    /// The unit of a quotient; none where a power is beyond all use.
    pub fn divide(self, other: Self) -> Option<Self> {
        Self::within(
            i32::from(self.metre) - i32::from(other.metre),
            i32::from(self.second) - i32::from(other.second),
            i32::from(self.radian) - i32::from(other.radian),
        )
    }

    /// The unit of a power; none where it is no multiple of a twelfth, or beyond all use.
    pub fn power(self, exponent: f64) -> Option<Self> {
        let scaled = |power: i16| {
            let scaled = f64::from(power) * exponent;
            let near = scaled.round();
            // A third has no exact decimal: what is written as 0.3333333333333333 counts.
            ((scaled - near).abs() < 1e-9 && near.abs() < 1e6).then_some(near as i32)
        };
        let radian = f64::from(self.radian) * exponent;
        let radian = if radian.fract() == 0.0 && radian.abs() < 100.0 { radian as i32 } else { 0 };
        Self::within(scaled(self.metre)?, scaled(self.second)?, radian)
    }

    fn within(metre: i32, second: i32, radian: i32) -> Option<Self> {
        let most = i32::from(POWER_MAX * WHOLE);
        let fits = metre.abs() <= most && second.abs() <= most;
        let radian = i8::try_from(radian).unwrap_or(0);
        fits.then_some(Self { metre: metre as i16, second: second as i16, radian })
    }

    /// What it is called where one that is `size` of it is `written`: by its own name where they are the same.
    pub(crate) fn name_of(self, size: f64, written: &str) -> String {
        if size == 1.0 { self.to_string() } else { written.trim().to_owned() }
    }

    /// It as it stands behind a number: with a space before it, or nothing.
    pub fn behind(self) -> String {
        let unit = self.to_string();
        if unit.is_empty() { unit } else { format!(" {unit}") }
    }

    /// The unit that `text` says, such as "m/s^2", "m/s²", "rad/s", "deg", "m^0.5 / s^1.5" or "-", with what one of it is in
    /// m, s and rad.
    ///
    /// # Errors
    /// What is wrong with it, and which units there are.
    pub fn parse(text: &str) -> Result<(Self, f64), String> {
        let mut reader = UnitReader { rest: text.trim(), known: (Self::NUMBER, 1.0) };
        if matches!(reader.rest, "-" | "−") {
            return Ok(reader.known);
        }
        reader.product()?;
        if !reader.rest.is_empty() {
            return Err(format!("`{}` is not part of a unit", reader.rest));
        }
        let (unit, scale) = reader.known;
        if scale.is_finite() && scale > 0.0 { Ok((unit, scale)) } else { Err(BEYOND.to_owned()) }
    }
}

const BEYOND: &str = "the powers of this unit are too large";

/// The names of units, what they are, and what one of them is in m, s and rad.
const NAMES: [(&str, Unit, f64); 11] = [
    ("m", Unit::new(1, 0), 1.0),
    ("s", Unit::new(0, 1), 1.0),
    ("rad", Unit::ANGLE, 1.0),
    ("deg", Unit::ANGLE, std::f64::consts::PI / 180.0),
    ("°", Unit::ANGLE, std::f64::consts::PI / 180.0),
    ("km", Unit::new(1, 0), 1000.0),
    ("cm", Unit::new(1, 0), 0.01),
    ("mm", Unit::new(1, 0), 0.001),
    ("h", Unit::new(0, 1), 3600.0),
    ("min", Unit::new(0, 1), 60.0),
    ("ms", Unit::new(0, 1), 0.001),
];

/// Digits as they are raised, by their value.
const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// Reads a unit from left to right.
struct UnitReader<'a> {
    rest: &'a str,
    known: (Unit, f64),
}

impl UnitReader<'_> {
    /// Takes `c` from the front, behind spaces.
    fn takes(&mut self, c: char) -> bool {
        let rest = self.rest.trim_start().strip_prefix(c);
        self.rest = rest.unwrap_or(self.rest);
        rest.is_some()
    }

    /// Factors, each after a space, a point or a stroke; behind a stroke some may stand in brackets.
    fn product(&mut self) -> Result<(), String> {
        self.factor(1.0)?;
        while !self.rest.trim_start().is_empty() {
            if self.takes('/') {
                if self.takes('(') {
                    while !self.takes(')') {
                        let _ = self.takes('·') || self.takes('*');
                        self.factor(-1.0)?;
                    }
                } else {
                    self.factor(-1.0)?;
                }
            } else {
                let _ = self.takes('·') || self.takes('*') || self.takes('×');
                self.factor(1.0)?;
            }
        }
        Ok(())
    }

    /// A name with its power, or 1.
    fn factor(&mut self, sign: f64) -> Result<(), String> {
        self.rest = self.rest.trim_start();
        if self.takes('1') {
            return Ok(());
        }
        let end = self.rest.find(|c: char| !c.is_alphabetic() && c != '°').unwrap_or(self.rest.len());
        let (name, rest) = self.rest.split_at(end);
        let Some((_, unit, scale)) = NAMES.iter().find(|(known, ..)| *known == name) else {
            let names = NAMES.map(|(name, ..)| name).join(", ");
            let found = if name.is_empty() { self.rest } else { name };
            let end = found.char_indices().nth(20).map_or(found.len(), |(end, _)| end);
            return Err(match &found[..end] {
                "" => format!("a unit is missing; there are {names}, and `-` for a number"),
                found => format!("there is no unit `{found}`; there are {names}, and `-` for a number"),
            });
        };
        self.rest = rest;
        let power = sign * self.exponent()?;
        let raised = unit.power(power).and_then(|unit| self.known.0.multiply(unit));
        let scale = if power.fract() == 0.0 && power.abs() <= 100.0 {
            math::powi(*scale, power as i32)
        } else {
            math::powf(*scale, power)
        };
        self.known = (raised.ok_or(BEYOND)?, self.known.1 * scale);
        Ok(())
    }

    /// `^2`, `^-1`, `^0.5`, `^(1/3)`, `²`, `⁻¹` or nothing.
    fn exponent(&mut self) -> Result<f64, String> {
        if let Some(rest) = self.rest.strip_prefix('^') {
            let bracket = rest.strip_prefix('(');
            let rest = bracket.unwrap_or(rest);
            let in_number =
                |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+') || bracket.is_some() && c == '/';
            let end = rest.find(|c| !in_number(c)).unwrap_or(rest.len());
            let (number, rest) = rest.split_at(end);
            let value = match number.split_once('/') {
                Some((over, under)) => {
                    over.parse().ok().zip(under.parse().ok()).map(|(a, b): (f64, f64)| a / b)
                }
                None => number.parse().ok(),
            };
            self.rest = if bracket.is_some() { rest.strip_prefix(')').unwrap_or(rest) } else { rest };
            return value.filter(|value| value.is_finite()).ok_or_else(|| format!("`^{number}` is no power"));
        }
        let sign = self.rest.strip_prefix('⁻');
        let digits = sign.unwrap_or(self.rest);
        let value = |c: char| RAISED.iter().position(|raised| *raised == c);
        let mut power = None;
        let mut end = 0;
        for digit in digits.chars().map_while(value).take(3) {
            power = Some(10.0 * power.unwrap_or(0.0) + digit as f64);
            end += RAISED[digit].len_utf8();
        }
        let Some(power) = power else { return Ok(1.0) };
        self.rest = &digits[end..];
        Ok(if sign.is_some() { -power } else { power })
    }
}

impl PartialEq for Unit {
    fn eq(&self, other: &Self) -> bool {
        (self.metre, self.second) == (other.metre, other.second)
    }
}

impl Eq for Unit {}

impl Hash for Unit {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.metre, self.second).hash(state);
    }
}

/// Such as "m/s²", "rad/s", "1/s", "m^0.5/s^1.5"; empty for a number.
impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Where there are metres, m/s is shown rather than m·rad/s.
        let radian = if self.metre == 0 { i16::from(self.radian) * WHOLE } else { 0 };
        let powers = [("m", self.metre), ("rad", radian), ("s", self.second)];
        let list = |sign: i16| -> Vec<String> {
            let there = powers.iter().filter(|(_, power)| power * sign > 0);
            there.map(|(name, power)| format!("{name}{}", Exponent(power * sign))).collect()
        };
        let (above, below) = (list(1), list(-1));
        match (above.is_empty(), below.len()) {
            (true, 1..) => f.write_str("1")?,
            _ => f.write_str(&above.join("·"))?,
        }
        match below.len() {
            0 => Ok(()),
            1 => write!(f, "/{}", below[0]),
            _ => write!(f, "/({})", below.join("·")),
        }
    }
}

/// A positive power in twelfths.
struct Exponent(i16);

impl fmt::Display for Exponent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let power = self.0;
        match (power / WHOLE, power % WHOLE) {
            (1, 0) => Ok(()),
            (whole @ 2..=9, 0) => write!(f, "{}", RAISED[whole as usize]),
            (whole, 0) => write!(f, "^{whole}"),
            // Quarters have short decimals.
            (_, part) if part % 3 == 0 => write!(f, "^{}", f64::from(power) / f64::from(WHOLE)),
            (_, part) if part % 2 == 0 => {
                let (over, under) = if part % 4 == 0 { (power / 4, 3) } else { (power / 2, 6) };
                write!(f, "^({over}/{under})")
            }
            _ => write!(f, "^({power}/{WHOLE})"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> String {
        Unit::parse(text).map_or_else(|message| message, |(unit, scale)| format!("{unit} {scale}"))
    }

    #[test]
    fn units_are_read_and_shown() {
        for (text, shown) in [
            ("m", "m 1"),
            ("m/s^2", "m/s² 1"),
            ("m/s²", "m/s² 1"),
            ("m s⁻²", "m/s² 1"),
            ("m/s/s", "m/s² 1"),
            ("1/s", "1/s 1"),
            ("rad/s", "rad/s 1"),
            ("1/rad", "1/rad 1"),
            ("m rad/s", "m/s 1"),
            ("-", " 1"),
            ("1", " 1"),
            ("m^0.5 / s^1.5", "m^0.5/s^1.5 1"),
            ("m^(1/3)", "m^(1/3) 1"),
            ("m·s", "m·s 1"),
            ("m*s^-1", "m/s 1"),
            ("1/(m s)", "1/(m·s) 1"),
            ("1/(m·s^10)", "1/(m·s^10) 1"),
            ("km/min", "m/s 16.666666666666668"),
            ("ms", "s 0.001"),
            ("km/h", "m/s 0.2777777777777778"),
            ("deg", "rad 0.017453292519943295"),
            ("°", "rad 0.017453292519943295"),
        ] {
            assert_eq!(read(text), shown, "{text}");
        }
    }

    #[test]
    fn what_is_shown_is_read_again() {
        for metre in [-24, -12, -7, -6, -4, -3, -2, 0, 1, 2, 4, 6, 12, 18, 20, 120] {
            for second in [-120, -24, -18, -12, -5, 0, 6, 12] {
                for radian in [-1, 0, 1, 2] {
                    let unit = Unit { metre, second, radian };
                    if unit == Unit::NUMBER && radian == 0 {
                        continue;
                    }
                    let shown = unit.to_string();
                    let (again, scale) =
                        if shown.is_empty() { (unit, 1.0) } else { Unit::parse(&shown).expect("a unit") };
                    assert_eq!((again, scale), (unit, 1.0), "{shown}");
                    assert_eq!(again.to_string(), shown);
                }
            }
        }
    }

    #[test]
    fn what_is_no_unit_is_refused_in_words() {
        let names = "there are m, s, rad, deg, °, km, cm, mm, h, min, ms, and `-` for a number";
        for (text, message) in [
            ("", format!("a unit is missing; {names}")),
            ("m/", format!("a unit is missing; {names}")),
            ("m/(s", format!("a unit is missing; {names}")),
            ("kg", format!("there is no unit `kg`; {names}")),
            ("m^", "`^` is no power".to_owned()),
            ("m^1.2.3", "`^1.2.3` is no power".to_owned()),
            ("m^(1/0)", "`^1/0` is no power".to_owned()),
            ("m^101", BEYOND.to_owned()),
            ("m^0.1", BEYOND.to_owned()),
            ("km^100 km^90", BEYOND.to_owned()),
            ("m)", format!("there is no unit `)`; {names}")),
        ] {
            assert_eq!(Unit::parse(text), Err(message), "{text}");
        }
    }

    #[test]
    fn products_quotients_and_powers_add_up() {
        let [metre, second] = [Unit::new(1, 0), Unit::new(0, 1)];
        let speed = metre.divide(second).expect("a unit");
        assert_eq!(speed, Unit::new(1, -1));
        assert_eq!(speed.multiply(speed), Some(Unit::new(2, -2)));
        assert_eq!(speed.power(0.5).map(|root| root.to_string()).as_deref(), Some("m^0.5/s^0.5"));
        assert_eq!(speed.power(1.0 / 3.0).and_then(|root| root.power(3.0)), Some(speed));
        assert_eq!(speed.power(0.1), None);
        assert_eq!(speed.power(101.0), None);
        assert_eq!(Unit::new(100, 0).multiply(metre), None);
        assert_eq!(Unit::NUMBER.power(0.1), Some(Unit::NUMBER));
        assert_eq!(Unit::ANGLE, Unit::NUMBER);
        assert!(Unit::ANGLE.is_angle() && !Unit::NUMBER.is_angle());
    }
}
