//! A custom law as a scene names it: by the file that holds its text, or by the text itself.

use laws::{CustomLaw, Declaration, LawFile};
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// A custom law, checked and ready to run.
#[derive(Debug, Clone)]
pub struct WrittenLaw {
    source: LawSource,
    text: Arc<str>,
    law: Arc<LawFile>,
}

/// Where the text of a law stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LawSource {
    /// It comes with the program under that name.
    Shipped(String),
    /// In the file of that name beside the scene.
    File(String),
    /// In the scene.
    Scene,
}

impl WrittenLaw {
    pub(crate) fn new(source: LawSource, text: &str, law: LawFile) -> Self {
        Self { source, text: text.into(), law: Arc::new(law) }
    }

    /// Where its text stands.
    pub fn source(&self) -> &LawSource {
        &self.source
    }

    /// What to call it in messages: the name of its file, or the key that holds its text.
    pub fn name(&self) -> &str {
        match &self.source {
            LawSource::Shipped(name) | LawSource::File(name) => name,
            LawSource::Scene => "law.text",
        }
    }

    /// Its text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether its text stands in a file of its own, without which a scene that names it cannot be read.
    pub fn is_apart(&self) -> bool {
        matches!(self.source, LawSource::File(_))
    }

    /// The same law with its text in the scene.
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
        (&self.source, &self.text) == (&other.source, &other.text)
    }
}

impl Serialize for WrittenLaw {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.source {
            LawSource::Shipped(name) | LawSource::File(name) => name.serialize(serializer),
            LawSource::Scene => self.text.serialize(serializer),
        }
    }
}
