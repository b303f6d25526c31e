//! The declaration of a module, read from JSON.

use crate::declaration::{Declaration, Knowledge, Parameter, Quantity, Scale};
use crate::input::{INPUTS, InputKind, LEADERS_MAX};
use crate::language::{did_you_mean, is_name, symbol};
use crate::unit::Unit;
use serde_json::{Map, Value};

/// Most mistakes that are told of one module.
pub(super) const MISTAKES_MAX: usize = 20;
/// Longest piece of a declaration in a message, characters.
const SHOWN_MAX: usize = 60;

/// A piece of a module for a message: short, and with nothing in it that moves a cursor.
pub(super) fn shown(text: &str) -> String {
    let mut shown = line(text).chars().take(SHOWN_MAX).collect::<String>();
    if text.chars().nth(SHOWN_MAX).is_some() {
        shown.push('…');
    }
    shown
}

/// A text in one line.
fn line(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).collect()
}

/// What `text` declares; a law that exports `derive` is `continuous`.
///
/// # Errors
/// What is wrong with it.
pub(super) fn declared(text: &str, continuous: bool) -> Result<Declaration, Vec<String>> {
    let json: Value = serde_json::from_str(text)
        .map_err(|error| vec![format!("its declaration is not JSON: {}", shown(&error.to_string()))])?;
    let mut reader = DeclarationReader { mistakes: vec![], names: vec![] };
    let declaration = reader.declaration(&json, continuous);
    match declaration {
        Some(declaration) if reader.mistakes.is_empty() => Ok(declaration),
        _ => Err(reader.mistakes),
    }
}

/// Reads on behind a mistake, so that several are told at once.
struct DeclarationReader<'a> {
    mistakes: Vec<String>,
    /// Names that are taken.
    names: Vec<&'a str>,
}

impl<'a> DeclarationReader<'a> {
    fn mistake(&mut self, at: &str, what: impl AsRef<str>) {
        if self.mistakes.len() < MISTAKES_MAX {
            let at = if at.is_empty() { "it".to_owned() } else { format!("`{at}`") };
            self.mistakes.push(format!("its declaration: {at} {}", what.as_ref()));
        }
    }

    fn declaration(&mut self, json: &'a Value, continuous: bool) -> Option<Declaration> {
        let known = ["title", "leaders", "knows", "parameters", "memory", "shown"];
        let keys = self.table(json, "", &known)?;
        let title = self.text(keys, "", "title").map(line).unwrap_or_default().trim().to_owned();
        let leaders = match keys.get("leaders").map(Value::as_u64) {
            None => 1,
            Some(Some(count)) if (1..=LEADERS_MAX as u64).contains(&count) => count as usize,
            Some(_) => {
                self.mistake("leaders", format!("must be a whole number from 1 to {LEADERS_MAX}"));
                1
            }
        };
        let knows = match self.text(keys, "", "knows") {
            None | Some("output") => Knowledge::Output,
            Some("rates") => Knowledge::Rates,
            Some("motion") => Knowledge::Motion,
            Some(_) => {
                self.mistake("knows", "must be \"output\", \"rates\" or \"motion\"");
                Knowledge::Output
            }
        };
        let parameters = self.list(keys, "parameters", Self::parameter);
        let memory = self.list(keys, "memory", Self::quantity);
        let shown = self.list(keys, "shown", Self::quantity);
        let told = INPUTS.map(|(kind, ..)| kind).into_iter();
        let told = told.filter(|kind| !kind.is_motion() || knows == Knowledge::Motion);
        let per_leader = |kind: InputKind| 0..if kind.is_per_leader() { leaders } else { 1 };
        let mut reads: Vec<_> =
            told.flat_map(|kind| per_leader(kind).map(move |leader| (leader, kind))).collect();
        reads.sort_unstable();
        Some(Declaration { title, leaders, knows, parameters, memory, shown, reads, continuous })
    }

    fn table(&mut self, json: &'a Value, at: &str, known: &[&str]) -> Option<&'a Map<String, Value>> {
        let Some(keys) = json.as_object() else {
            self.mistake(at, "must be an object, `{ … }`");
            return None;
        };
        for key in keys.keys().filter(|key| !known.contains(&key.as_str())) {
            let hint = did_you_mean(key, known.iter().copied());
            self.mistake(&joined(at, &shown(key)), format!("is not known{hint}"));
        }
        Some(keys)
    }

    fn list<T>(
        &mut self,
        keys: &'a Map<String, Value>,
        key: &str,
        item: impl Fn(&mut Self, &'a Value, &str) -> Option<T>,
    ) -> Vec<T> {
        match keys.get(key) {
            None => vec![],
            Some(Value::Array(items)) => {
                let numbered = items.iter().enumerate();
                numbered.filter_map(|(index, json)| item(self, json, &format!("{key}[{index}]"))).collect()
            }
            Some(_) => {
                self.mistake(key, "must be a list, `[ … ]`");
                vec![]
            }
        }
    }

    fn text(&mut self, keys: &'a Map<String, Value>, at: &str, key: &str) -> Option<&'a str> {
        let value = keys.get(key)?;
        let text = value.as_str();
        if text.is_none() {
            self.mistake(&joined(at, key), "must be a text, `\"…\"`");
        }
        text
    }

    /// A name that nothing else has.
    fn name(&mut self, keys: &'a Map<String, Value>, at: &str) -> Option<&'a str> {
        if !keys.contains_key("name") {
            self.mistake(at, "needs a `name`");
            return None;
        }
        let name = self.text(keys, at, "name")?;
        if !is_name(name) {
            let rule = "is not a name: it begins with a letter, and goes on with letters, digits and `_`";
            self.mistake(&joined(at, "name"), rule);
            return None;
        }
        if self.names.contains(&name) {
            self.mistake(&joined(at, "name"), format!("`{name}` is taken"));
            return None;
        }
        self.names.push(name);
        Some(name)
    }

    /// A unit, and what one of it is in m, s and rad.
    fn unit(&mut self, keys: &'a Map<String, Value>, at: &str) -> (Unit, f64) {
        let text = self.text(keys, at, "unit").unwrap_or("-");
        Unit::parse(text).unwrap_or_else(|why| {
            self.mistake(&joined(at, "unit"), format!("is not right: {why}"));
            (Unit::NUMBER, 1.0)
        })
    }

    fn quantity(&mut self, json: &'a Value, at: &str) -> Option<Quantity> {
        let keys = self.table(json, at, &["name", "unit"])?;
        let name = self.name(keys, at);
        let (unit, scale) = self.unit(keys, at);
        if scale != 1.0 {
            self.mistake(&joined(at, "unit"), format!("must be in m, s and rad: write `{unit}`"));
        }
        Some(Quantity { name: name?.to_owned(), unit })
    }

    fn parameter(&mut self, json: &'a Value, at: &str) -> Option<Parameter> {
        let known = ["name", "symbol", "unit", "default", "range", "scale", "help"];
        let keys = self.table(json, at, &known)?;
        let name = self.name(keys, at);
        let (unit, size) = self.unit(keys, at);
        let default = keys.get("default").and_then(Value::as_f64).filter(|number| number.is_finite());
        if default.is_none() {
            self.mistake(&joined(at, "default"), "must be a number");
        }
        let range = match keys.get("range").and_then(Value::as_array).map(Vec::as_slice) {
            Some([low, high]) => low.as_f64().zip(high.as_f64()).filter(|(low, high)| low < high),
            _ => None,
        };
        if range.is_none() {
            let wanted = "must be two numbers, the smaller before the larger, such as `[0.1, 20]`";
            self.mistake(&joined(at, "range"), wanted);
        }
        let scale = match self.text(keys, at, "scale") {
            None | Some("linear") => Scale::Linear,
            Some("logarithmic") => Scale::Logarithmic,
            Some(_) => {
                self.mistake(&joined(at, "scale"), "must be \"linear\" or \"logarithmic\"");
                Scale::Linear
            }
        };
        let own_symbol = self.text(keys, at, "symbol").map(line).filter(|symbol| !symbol.is_empty());
        let help = self.text(keys, at, "help").map(line).unwrap_or_default();
        let (name, default, (low, high)) = (name?, default?, range?);
        if !(low..=high).contains(&default) {
            self.mistake(&joined(at, "default"), format!("{default} is not in the range {low} to {high}"));
        }
        if scale == Scale::Logarithmic && low <= 0.0 {
            self.mistake(&joined(at, "range"), "must begin above 0 where it is logarithmic");
        }
        if ![default, low, high].iter().all(|number| (number * size).is_finite()) {
            self.mistake(at, "has numbers that are too large in m, s and rad");
        }
        Some(Parameter {
            name: name.to_owned(),
            symbol: own_symbol.unwrap_or_else(|| symbol(name)),
            unit,
            unit_name: unit.name_of(size, keys.get("unit").and_then(Value::as_str).unwrap_or_default()),
            unit_size: size,
            default,
            range: [low, high],
            scale,
            help,
        })
    }
}

fn joined(at: &str, key: &str) -> String {
    if at.is_empty() { key.to_owned() } else { format!("{at}.{key}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_declaration_is_read_with_its_defaults() {
        let text = r#"{"title": "Mine", "leaders": 2, "knows": "motion",
            "parameters": [{"name": "epsilon", "unit": "deg", "default": 90, "range": [1, 180], "scale": "logarithmic"}],
            "memory": [{"name": "z", "unit": "m/s"}], "shown": [{"name": "e"}]}"#;
        let declaration = declared(text, true).expect("a declaration");
        let [own] = &declaration.parameters[..] else { panic!("one parameter") };
        assert_eq!(
            (own.symbol.as_str(), own.unit.to_string().as_str(), own.behind().as_str()),
            ("ε", "rad", " deg")
        );
        assert_eq!([own.default, own.range[1]], [90.0, 180.0]);
        assert_eq!(own.as_told(own.default), std::f64::consts::FRAC_PI_2);
        assert_eq!(declaration.memory, [Quantity { name: "z".to_owned(), unit: Unit::new(1, -1) }]);
        assert!(declaration.continuous && declaration.reads_rates());
        assert_eq!(declaration.reads.len(), 5 + 2 * 18);
        assert_eq!(declared("{}", false).map(|own| (own.leaders, own.knows)), Ok((1, Knowledge::Output)));
    }

    #[test]
    fn several_mistakes_are_told_at_once() {
        let text = r#"{"titel": "Mine", "leaders": 9, "knows": "all", "shown": {},
            "parameters": [{"name": "k", "unit": "kg", "default": 50, "range": [0, 20], "scale": "logarithmic"},
                {"name": "k", "default": "x", "range": [3, 1]}, 7],
            "memory": [{"name": "a b"}, {}, {"name": "d", "unit": "deg"}]}"#;
        let told = declared(text, false).expect_err("mistakes").join("\n");
        for words in [
            "`titel` is not known; did you mean `title`?",
            "`leaders` must be a whole number from 1 to 4",
            "`knows` must be \"output\", \"rates\" or \"motion\"",
            "`shown` must be a list",
            "`parameters[0].unit` is not right: there is no unit `kg`",
            "`parameters[0].default` 50 is not in the range 0 to 20",
            "`parameters[0].range` must begin above 0",
            "`parameters[1].name` `k` is taken",
            "`parameters[1].default` must be a number",
            "`parameters[1].range` must be two numbers",
            "`parameters[2]` must be an object",
            "`memory[0].name` is not a name",
            "`memory[1]` needs a `name`",
            "`memory[2].unit` must be in m, s and rad: write `rad`",
        ] {
            assert!(told.contains(words), "{words}\n{told}");
        }
        let broken = declared("{\"title\": ", false).expect_err("no JSON");
        assert!(broken[0].starts_with("its declaration is not JSON: EOF"), "{broken:?}");
    }
}
