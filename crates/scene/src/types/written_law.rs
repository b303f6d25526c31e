//! A custom law as a scene names it: by the file that holds it, or by what would stand in that file.

use crate::packed::pack;
use laws::{CustomLaw, Declaration};
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// A custom law, checked and ready to run.
#[derive(Debug, Clone)]
pub struct WrittenLaw {
    source: LawSource,
    written: Written,
    law: Arc<dyn CustomLaw>,
}

/// Where a law stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LawSource {
    /// It comes with the program under that name.
    Shipped(String),
    /// In the file of that name beside the scene.
    File(String),
    /// In the scene.
    Scene,
}

/// What a law was made from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Written {
    /// The text of a law file.
    Text(Arc<str>),
    /// A WebAssembly module.
    Module(Arc<[u8]>),
}

impl WrittenLaw {
    pub(crate) fn new(source: LawSource, written: Written, law: Arc<dyn CustomLaw>) -> Self {
        Self { source, written, law }
    }

    /// Where it stands.
    pub fn source(&self) -> &LawSource {
        &self.source
    }

    /// What to call it in messages: the name of its file, or the key that holds it.
    pub fn name(&self) -> &str {
        match (&self.source, &self.written) {
            (LawSource::Shipped(name) | LawSource::File(name), _) => name,
            (LawSource::Scene, Written::Text(_)) => "law.text",
            (LawSource::Scene, Written::Module(_)) => "law.module",
        }
    }

    /// Its text; a WebAssembly module has none.
    pub fn text(&self) -> Option<&str> {
        match &self.written {
            Written::Text(text) => Some(text),
            Written::Module(_) => None,
        }
    }

    /// The key of `law` under which a scene holds it, and what stands there.
    pub(crate) fn in_words(&self) -> (&'static str, String) {
        match &self.written {
            Written::Text(text) => ("text", text.to_string()),
            Written::Module(bytes) => ("module", pack(bytes)),
        }
    }

    /// Whether it stands in a file of its own, without which a scene that names it cannot be read.
    pub fn is_apart(&self) -> bool {
        matches!(self.source, LawSource::File(_))
    }

    /// The same law, standing in the scene.
    pub(crate) fn in_scene(&self) -> Self {
        Self { source: LawSource::Scene, ..self.clone() }
    }

    /// What it says of itself.
    pub fn declaration(&self) -> &Declaration {
        self.law.declaration()
    }

    /// The law, to be run.
    pub fn law(&self) -> Arc<dyn CustomLaw> {
        self.law.clone()
    }
}

impl PartialEq for WrittenLaw {
    fn eq(&self, other: &Self) -> bool {
        (&self.source, &self.written) == (&other.source, &other.written)
    }
}

impl Serialize for WrittenLaw {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.source {
            LawSource::Shipped(name) | LawSource::File(name) => name.serialize(serializer),
            LawSource::Scene => self.in_words().1.serialize(serializer),
        }
    }
}
