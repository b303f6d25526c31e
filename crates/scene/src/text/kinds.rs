//! Tables of which one key says what other keys there are.

use crate::text::{
    Form, Keys, Node, Reporter,
    keys::{Field, TableReader, object},
    words::not_a_word,
};
use serde_json::{Value as Json, json};

/// A table whose `key` is the word of one of `all` kinds, which says which other keys it has.
pub(crate) struct Kinds<T: 'static> {
    pub(crate) key: &'static str,
    /// Word that is meant where the key is missing.
    pub(crate) usual: Option<&'static str>,
    pub(crate) all: &'static [&'static dyn KindOption<T>],
}

/// One kind: its word, and the keys it brings.
pub(crate) trait KindOption<T> {
    fn word(&self) -> &'static str;
    fn about(&self) -> &'static str;
    fn fields(&self) -> Vec<Field>;
    fn read(&self, node: &Node, table: &mut TableReader<'_>, reporter: &mut Reporter) -> Option<T>;
}

/// The kind called `word`, and what the keys `K` of a table make; `None` after reporting an error.
pub(crate) struct Kind<K, T> {
    pub(crate) word: &'static str,
    pub(crate) make: fn(K, &Node, &mut Reporter) -> Option<T>,
}

impl<K: Keys, T> KindOption<T> for Kind<K, T> {
    fn word(&self) -> &'static str {
        self.word
    }

    fn about(&self) -> &'static str {
        K::ABOUT
    }

    fn fields(&self) -> Vec<Field> {
        K::fields()
    }

    fn read(&self, node: &Node, table: &mut TableReader<'_>, reporter: &mut Reporter) -> Option<T> {
        (self.make)(K::read(table, reporter), node, reporter)
    }
}

impl<T> Kinds<T> {
    /// Reads a table of one of these kinds. Returns what its kind makes of its keys, or `None` after reporting an error, and
    /// what `shared` makes of the keys that all kinds have.
    pub(crate) fn read_with<S>(
        &self,
        node: &Node,
        reporter: &mut Reporter,
        shared: impl FnOnce(&mut TableReader<'_>, &mut Reporter) -> S,
    ) -> Option<(Option<T>, S)> {
        let mut table = TableReader::of(node, reporter)?;
        let found = table.take(self.key, &KindForm(self.all), self.usual.is_none(), reporter);
        // Without a kind the other keys are not known.
        let kind = match (found, node.get(self.key)) {
            (None, None) => self.all.iter().copied().find(|kind| Some(kind.word()) == self.usual),
            (found, _) => found.map(|found| found.value),
        }?;
        let made = kind.read(node, &mut table, reporter);
        let shared = shared(&mut table, reporter);
        table.finish(reporter);
        Some((made, shared))
    }

    /// Each kind's table, with `shared` keys that all of them have besides.
    pub(crate) fn schema_with(&self, shared: fn() -> Vec<Field>) -> Json {
        let one = |kind: &&dyn KindOption<T>| {
            let fields = kind.fields().into_iter().chain(shared());
            let mut schema = object(kind.about(), fields.collect());
            schema["properties"][self.key] =
                json!({ "const": kind.word(), "description": kind.about().trim() });
            if self.usual != Some(kind.word())
                && let Some(required) = schema["required"].as_array_mut()
            {
                required.push(json!(self.key));
            }
            schema
        };
        json!({ "oneOf": self.all.iter().map(one).collect::<Vec<_>>() })
    }
}

impl<T> Form for Kinds<T> {
    type Out = T;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<T> {
        self.read_with(node, reporter, |_, _| ())?.0
    }

    fn schema(&self) -> Json {
        self.schema_with(Vec::new)
    }
}

/// The word of a kind.
struct KindForm<T: 'static>(&'static [&'static dyn KindOption<T>]);

impl<T> Form for KindForm<T> {
    type Out = &'static dyn KindOption<T>;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<&'static dyn KindOption<T>> {
        let found = self.0.iter().copied().find(|kind| node.as_text() == Some(kind.word()));
        if found.is_none() {
            not_a_word(node, self.0.iter().map(|kind| kind.word()), reporter);
        }
        found
    }

    fn schema(&self) -> Json {
        json!({ "enum": self.0.iter().map(|kind| kind.word()).collect::<Vec<_>>() })
    }
}
