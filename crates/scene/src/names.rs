//! What robots and props have in common as they are written: names and poses.

use crate::text::{
    Form, Node, Reporter, Triple, angle_of_turns,
    form::{Angle, Number},
    number,
};
use serde_json::{Value as Json, json};
use unicode_normalization::char::is_combining_mark;

/// Start pose [m, m, rad].
pub(crate) const POSE: Triple<Number, Number, Angle> = Triple(number("m"), number("m"), angle_of_turns(10.0));

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
        let fits = |c: char| {
            (c.is_alphanumeric() || is_combining_mark(c) || c == '-' || c == '_') && !is_invisible(c)
        };
        name.chars().all(fits) && (1..=self.most).contains(&name.chars().count())
    }
}

impl Form for NameForm {
    type Out = String;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<String> {
        let name = node.as_text().filter(|name| self.takes(name));
        if name.is_none() {
            reporter.wrong(node, &format!("a name of 1 to {} letters, digits, `-` and `_`", self.most));
            let invisible = node.as_text().and_then(|name| name.chars().find(|c| is_invisible(*c)));
            if let Some(sign) = invisible {
                reporter.append_to_last(&format!(": U+{:04X} in it cannot be seen", u32::from(sign)));
            }
        }
        name.map(str::to_owned)
    }

    fn schema(&self) -> Json {
        let class = |[first, last]: &[char; 2]| {
            format!(r"\u{{{:X}}}-\u{{{:X}}}", u32::from(*first), u32::from(*last))
        };
        let invisible: String = INVISIBLE.iter().map(class).collect();
        let pattern = format!(r"^(?:(?![{invisible}])[\p{{L}}\p{{N}}\p{{M}}_-]){{1,{}}}$", self.most);
        json!({ "type": "string", "pattern": pattern })
    }
}

/// Letters and marks that leave no trace (Default_Ignorable_Code_Point of Unicode): names that differ by them look alike.
const INVISIBLE: [[char; 2]; 11] = [
    ['\u{34f}', '\u{34f}'],
    ['\u{61c}', '\u{61c}'],
    ['\u{115f}', '\u{1160}'],
    ['\u{17b4}', '\u{17b5}'],
    ['\u{180b}', '\u{180f}'],
    ['\u{200b}', '\u{206f}'],
    ['\u{3164}', '\u{3164}'],
    ['\u{fe00}', '\u{fe0f}'],
    ['\u{feff}', '\u{feff}'],
    ['\u{ffa0}', '\u{ffa0}'],
    ['\u{e0000}', '\u{e0fff}'],
];

fn is_invisible(c: char) -> bool {
    INVISIBLE.iter().any(|[first, last]| (*first..=*last).contains(&c))
}
