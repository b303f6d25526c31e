//! Tables: which keys there are, what each means, its form and its default, all said once.

use crate::text::{
    Form, Node, Reporter, Span,
    node::Entry,
    words::{did_you_mean, nearest, quoted},
};
use serde_json::{Map, Value as Json, json};
use std::marker::PhantomData;

/// A value and where it was found.
#[derive(Debug, Clone)]
pub(crate) struct Found<T> {
    pub(crate) span: Span,
    pub(crate) value: T,
}

/// What was found, or else a default, as if it stood at `span`.
pub(crate) fn found_or<T>(
    found: Option<Found<T>>,
    span: Span,
    default: impl FnOnce() -> T,
) -> Option<Found<T>> {
    found.or_else(|| Some(Found { span, value: default() }))
}

/// Whichever of two keys is given, and whether it was the second; reports an error if none or both are.
pub(crate) fn one_of<T>(
    node: &Node,
    keys: [&str; 2],
    found: [Option<Found<T>>; 2],
    reporter: &mut Reporter,
) -> Option<(Found<T>, bool)> {
    match found {
        [Some(found), None] => Some((found, false)),
        [None, Some(found)] => Some((found, true)),
        _ => {
            // The error of a key that is there but wrong is reported already.
            let given = keys.iter().filter(|key| node.get(key).is_some()).count();
            if given != 1 {
                reporter.report(node.span, format!("give either `{}` or `{}` here", keys[0], keys[1]));
            }
            None
        }
    }
}

/// What is special about a key, written behind it in its declaration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mark {
    /// It may change while a run goes.
    Live,
    /// No robot depends on it once the run goes.
    Apart,
    /// It means something on wheels only.
    Wheels,
    /// It means something where wheels are steered.
    Steered,
}

/// A table with known keys; made by [`keys!`] or [`settings!`].
pub(crate) trait Keys: Sized {
    /// What the table is about.
    const ABOUT: &'static str;

    /// Reads every known key.
    fn read(table: &mut TableReader<'_>, reporter: &mut Reporter) -> Self;

    /// The JSON Schema of every known key.
    fn fields() -> Vec<Field>;

    /// What is special about a known key; `None` for one that is not known.
    fn marks(key: &str) -> Option<&'static [Mark]>;

    /// Every key that was read, and where its value stands.
    fn spans(&self) -> Vec<(&'static str, Span)>;

    /// Where the value of `key` stands, if it was read.
    fn span_of(&self, key: &str) -> Option<Span> {
        self.spans().into_iter().find(|(known, _)| *known == key).map(|(_, span)| span)
    }
}

/// What one table of a file says of something in which every key has a default; made by [`settings!`].
pub(crate) trait Part {
    /// It with every key.
    type Whole: Default;

    /// What is said here, else what `base` says, else `default`.
    fn complete_with(&self, base: &Self, default: Self::Whole) -> Self::Whole;

    /// What is said here, else what `base` says.
    fn over(&self, base: &Self) -> Self;

    /// What is said here, else what `base` says, else the default.
    fn complete(&self, base: &Self) -> Self::Whole {
        self.complete_with(base, Self::Whole::default())
    }
}

/// A key as the JSON Schema sees it.
pub(crate) struct Field {
    pub(crate) key: &'static str,
    pub(crate) about: &'static str,
    pub(crate) required: bool,
    pub(crate) default: Json,
    pub(crate) schema: Json,
}

/// Reads the keys of one table and remembers which, to find unknown keys.
pub(crate) struct TableReader<'n> {
    span: Span,
    entries: &'n [Entry],
    known: Vec<&'static str>,
}

impl<'n> TableReader<'n> {
    /// A reader of `node`, or `None` after reporting that it is not a table.
    pub(crate) fn of(node: &'n Node, reporter: &mut Reporter) -> Option<Self> {
        let entries = reporter.expect(node.as_table(), node, || "a table".to_owned())?;
        Some(Self { span: node.span, entries, known: vec![] })
    }

    /// Where the table stands.
    pub(crate) fn span(&self) -> Span {
        self.span
    }

    /// Reads the value of `key`.
    pub(crate) fn take<F: Form>(
        &mut self,
        key: &'static str,
        form: &F,
        required: bool,
        reporter: &mut Reporter,
    ) -> Option<Found<F::Out>> {
        self.known.push(key);
        let Some(entry) = self.entries.iter().find(|entry| entry.key == key) else {
            if required {
                reporter.report(self.span, format!("`{key}` is missing"));
            }
            return None;
        };
        let value = reporter.inside(key, |reporter| form.read(&entry.node, reporter))?;
        Some(Found { span: entry.node.span, value })
    }

    /// Reports the keys that were not asked for.
    pub(crate) fn finish(self, reporter: &mut Reporter) {
        for entry in self.entries.iter().filter(|entry| !self.known.contains(&entry.key.as_str())) {
            if reporter.is_full() {
                return;
            }
            let known = self.known.iter().copied();
            let hint = nearest(&entry.key, known.clone()).map_or_else(String::new, did_you_mean);
            let message = format!("unknown key `{}`{hint} (known here: {})", entry.key, quoted(known));
            reporter.report(entry.span, message);
        }
    }
}

/// The form of a table with the keys of `K`.
pub(crate) struct TableForm<K>(PhantomData<K>);

/// The form of a table with the keys of `K`.
pub(crate) const fn table<K: Keys>() -> TableForm<K> {
    TableForm(PhantomData)
}

impl<K: Keys> Form for TableForm<K> {
    type Out = K;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<K> {
        let mut table = TableReader::of(node, reporter)?;
        let keys = K::read(&mut table, reporter);
        table.finish(reporter);
        Some(keys)
    }

    fn schema(&self) -> Json {
        object(K::ABOUT, K::fields())
    }
}

/// The JSON Schema of a table with these fields and no others.
pub(crate) fn object(about: &str, fields: Vec<Field>) -> Json {
    let required: Vec<_> = fields.iter().filter(|field| field.required).map(|field| field.key).collect();
    let properties: Map<_, _> =
        fields.into_iter().map(|field| (field.key.to_owned(), property(field))).collect();
    json!({
        "type": "object", "description": plain(about), "properties": properties, "required": required,
        "additionalProperties": false,
    })
}

fn property(field: Field) -> Json {
    let mut schema = field.schema;
    schema["description"] = json!(plain(field.about));
    if !field.default.is_null() {
        schema["default"] = field.default;
    }
    schema
}

/// A doc comment as running text.
fn plain(about: &str) -> String {
    about.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Defines what is read from a table: for each key its meaning, type and form, and whether it is `required`,
/// `optional`, replaced by `or(…)` where it is missing, or a `part` that is empty where it is missing; a `default(…)`
/// is filled in later.
macro_rules! keys {
    (
        $(#[doc = $about:literal])*
        struct $name:ident {
            $( $(#[doc = $doc:literal])* $key:ident : $type:ty = $form:expr, $need:ident $(($default:expr))? $(, $mark:ident)*; )+
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Debug, Clone, Default)]
        pub(crate) struct $name { $( pub(crate) $key: Option<$crate::text::Found<$type>>, )+ }

        impl $crate::text::Keys for $name {
            const ABOUT: &'static str = concat!($($about, " "),*);

            fn read(table: &mut $crate::text::keys::TableReader<'_>, reporter: &mut $crate::text::Reporter) -> Self {
                Self { $( $key: {
                    let required = $crate::text::keys::keys!(@required $need);
                    let found = table.take(stringify!($key), &$form, required, reporter);
                    $crate::text::keys::keys!(@found $need found, table $(, $default)?)
                }, )+ }
            }

            fn fields() -> Vec<$crate::text::keys::Field> {
                vec![ $( $crate::text::keys::Field {
                    key: stringify!($key),
                    about: concat!($($doc, " "),*),
                    required: $crate::text::keys::keys!(@required $need),
                    default: $crate::text::keys::keys!(@default $type $(, $default)?),
                    schema: $crate::text::Form::schema(&$form),
                }, )+ ]
            }

            fn marks(key: &str) -> Option<&'static [$crate::text::keys::Mark]> {
                match key {
                    $( stringify!($key) => Some(&[$($crate::text::keys::Mark::$mark),*]), )+
                    _ => None,
                }
            }

            fn spans(&self) -> Vec<(&'static str, $crate::text::Span)> {
                let all = [ $( (stringify!($key), self.$key.as_ref().map(|found| found.span)), )+ ];
                all.into_iter().filter_map(|(key, span)| Some((key, span?))).collect()
            }
        }
    };
    (@required required) => { true };
    (@required optional) => { false };
    (@required or) => { false };
    (@required default) => { false };
    (@required part) => { false };
    (@found or $found:ident, $table:ident, $default:expr) => {
        $crate::text::keys::found_or($found, $table.span(), || $default)
    };
    (@found part $found:ident, $table:ident) => { $crate::text::keys::found_or($found, $table.span(), Default::default) };
    (@found $need:ident $found:ident, $table:ident $(, $default:expr)?) => { $found };
    (@default $type:ty) => { serde_json::Value::Null };
    (@default $type:ty, $default:expr) => { serde_json::to_value::<$type>($default).unwrap_or_default() };
}
pub(crate) use keys;

/// Defines a table in which every key has a default: its checked type `$name`, and `$part`, what one table of a file
/// says of it.
macro_rules! settings {
    (
        $(#[doc = $about:literal])*
        $(#[derive($($derive:ident),*)])?
        pub struct $name:ident from $part:ident {
            $( $(#[doc = $doc:literal])* pub $key:ident : $type:ty = $default:expr, $form:expr $(, $mark:ident)*; )+
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize)]
        $(#[derive($($derive),*)])?
        pub struct $name { $( $(#[doc = $doc])* pub $key: $type, )+ }

        impl Default for $name {
            fn default() -> Self {
                Self { $( $key: $default, )+ }
            }
        }

        $crate::text::keys::keys! {
            $(#[doc = $about])*
            struct $part { $( $(#[doc = $doc])* $key: $type = $form, default($default) $(, $mark)*; )+ }
        }

        impl $crate::text::Part for $part {
            type Whole = $name;

            fn complete_with(&self, base: &Self, default: $name) -> $name {
                $name { $(
                    $key: match self.$key.as_ref().or(base.$key.as_ref()) {
                        Some(found) => found.value.clone(),
                        None => default.$key,
                    },
                )+ }
            }

            fn over(&self, base: &Self) -> Self {
                Self { $( $key: self.$key.clone().or_else(|| base.$key.clone()), )+ }
            }
        }
    };
}
pub(crate) use settings;
