//! The scene that a link leads to.

use super::{Link, LinkError, LinkOrigin, TimedOverride};
use crate::{Loaded, Scene, SceneText};
use std::path::PathBuf;

/// The scene that a link leads to.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkedScene {
    /// What it is called by in messages and as a file.
    pub home: PathBuf,
    /// Its text, with all that the link sets.
    pub text: String,
    /// The checked scene of the text.
    pub scene: Scene,
}

impl Link {
    /// The scene with all that the link sets: values in their place, later ones as `[[changes]]`. It lasts until the time of
    /// the link at least; what it expects is left out where the link makes it another run than it was written for.
    ///
    /// # Errors
    /// All that is wrong with it.
    pub fn open(&self) -> Result<LinkedScene, LinkError> {
        self.scene().map_err(|fault| self.explained(fault))
    }

    fn scene(&self) -> Result<LinkedScene, LinkError> {
        let base = match &self.origin {
            LinkOrigin::Shipped(shipped) => shipped.text,
            LinkOrigin::Text(text) => text,
        };
        let home = PathBuf::from(self.name()).with_extension("toml");
        let start = alone(Scene::parse(base, &home, &self.set)?)?;
        let ends = self.time.filter(|time| *time > start.time.duration);
        let mut opened = LinkedScene { home, text: base.to_owned(), scene: start };
        if !self.set.is_empty() || !self.changes.is_empty() || ends.is_some() {
            let mut text = SceneText::parse(base)?;
            for set in &self.set {
                let (path, value) = set.parts();
                text.set(path, value)?;
            }
            if !self.changes.is_empty() {
                text.schedule(&opened.scene.changes, &self.later())?;
            }
            if let Some(duration) = ends {
                text.set("time.duration", &format!("{duration:?}"))?;
            }
            if !self.changes.is_empty() || ends.is_some() {
                text.remove("expect")?;
            }
            opened.text = text.text();
            opened.scene = alone(Scene::parse(&opened.text, &opened.home, &[])?)?;
        }
        if let Some(name) = self.selected.as_ref().filter(|name| opened.scene.index_of(name).is_none()) {
            return Err(LinkError::Robot(super::error::shown(name)));
        }
        Ok(opened)
    }

    /// What is set later, time by time.
    fn later(&self) -> Vec<crate::ChangeText> {
        let mut later: Vec<crate::ChangeText> = vec![];
        for TimedOverride { at, set } in &self.changes {
            match later.last_mut() {
                Some(last) if last.at == *at => last.set.push(set.to_string()),
                _ => later.push(crate::ChangeText { at: *at, set: vec![set.to_string()] }),
            }
        }
        later
    }
}

/// The scene of a text that needs no other file.
pub(super) fn alone(loaded: Loaded) -> Result<Scene, LinkError> {
    match loaded.files.get(1) {
        Some(file) => Err(LinkError::Files(super::error::shown(&file.display().to_string()))),
        None => Ok(loaded.scene),
    }
}
