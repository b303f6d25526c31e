//! What robots and props have in common as they are written: names and poses.

use crate::text::{
    Form, Node, Reading, angle_of_turns,
    form::{Angle, Number},
    lists::Triple,
    number, triple,
};
use serde_json::{Value as Json, json};
use unicode_normalization::char::is_combining_mark;

/// Start pose [m, m, rad].
pub(crate) const POSE: Triple<Number, Number, Angle> = triple(number("m"), number("m"), angle_of_turns(10.0));

/// A robot's or prop's name: fit for paths of overrides, columns of tables and file names.
pub(crate) struct NameForm {
    /// Most characters.
    most: usize,
}

impl NameForm {
    /// A whole name.
    pub(crate) const WHOLE: Self = Self { most: 40 };
    /// The start of names that end in a number.
    pub(crate) const START: Self = Self { most: 34 };

    /// Whether it takes `name`.
    pub(crate) fn takes(&self, name: &str) -> bool {
        let fits = |c: char| c.is_alphanumeric() || is_combining_mark(c) || c == '-' || c == '_';
        name.chars().all(fits) && (1..=self.most).contains(&name.chars().count())
    }
}

impl Form for NameForm {
    type Out = String;

    fn read(&self, node: &Node, reading: &mut Reading) -> Option<String> {
        let name = node.as_text().filter(|name| self.takes(name));
        if name.is_none() {
            reading.wrong(node, &format!("a name of 1 to {} letters, digits, `-` and `_`", self.most));
        }
        name.map(str::to_owned)
    }

    fn schema(&self) -> Json {
        json!({ "type": "string", "pattern": format!(r"^[\p{{L}}\p{{N}}\p{{M}}_-]{{1,{}}}$", self.most) })
    }
}
