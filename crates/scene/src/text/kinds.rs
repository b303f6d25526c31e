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

/// The kind called `word`, and what the keys `K` of a table make; `None` after a note.
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
    /// Reads the kind of `table`, whose node is `node`, and the keys it brings.
    pub(crate) fn take(
        &self,
        node: &Node,
        table: &mut TableReader<'_>,
        reporter: &mut Reporter,
    ) -> KindFound<T> {
        let found = table.take(self.key, &KindForm(self.all), self.usual.is_none(), reporter);
        let kind = match (found, node.get(self.key)) {
            (None, None) => self.all.iter().copied().find(|kind| Some(kind.word()) == self.usual),
            (found, _) => found.map(|found| found.value),
        };
        kind.map_or(KindFound::Unknown, |kind| KindFound::Known(kind.read(node, table, reporter)))
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

/// What became of reading a kind.
pub(crate) enum KindFound<T> {
    /// Its keys were read, and made this, or `None` after a note.
    Known(Option<T>),
    /// Nobody knows which keys there are.
    Unknown,
}

impl<T> Form for Kinds<T> {
    type Out = T;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<T> {
        let mut table = TableReader::of(node, reporter)?;
        let KindFound::Known(made) = self.take(node, &mut table, reporter) else { return None };
        table.finish(reporter);
        made
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
