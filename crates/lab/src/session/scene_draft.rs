//! The text of the scene being edited: edits, undo, and the effect of an edit on the run.

use super::checked_scene::CheckedScene;
use scene::{Environment, Expect, Film, Scene, SceneText, Views};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Maximum number of undo steps.
const MOST_STEPS: usize = 500;

/// A scene file being edited.
pub struct SceneDraft {
    /// Its file; `None` if it was never saved.
    pub path: Option<PathBuf>,
    /// Names the scene in messages; its folder holds the files that the scene names.
    home: PathBuf,
    text: String,
    /// The parsed document, if the text has been parsed.
    document: Option<SceneText>,
    scene: Arc<Scene>,
    /// The built run, until the run thread takes it.
    checked: Option<CheckedScene>,
    saved: String,
    undo: Vec<UndoStep>,
    redo: Vec<UndoStep>,
}

/// An undo step.
struct UndoStep {
    text: String,
    scene: Arc<Scene>,
    /// The name of the edit after it.
    what: String,
}

/// A text and its scene.
#[derive(Debug)]
pub struct EditedScene {
    text: String,
    checked: CheckedScene,
}

/// The effect of an edit on the run.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// Nothing has changed.
    None,
    /// The run can apply it while it goes on.
    Retune,
    /// Only the appearance changes: light, title, views.
    Dress,
    /// The run has to restart, and why.
    Restart(String),
}

impl SceneDraft {
    /// A draft from a scene's text; `path` is its file.
    ///
    /// # Errors
    /// All that is wrong with the text.
    pub fn new(text: String, path: Option<PathBuf>, home: &Path) -> Result<Self, String> {
        let home = path.clone().unwrap_or_else(|| home.to_owned());
        let scene = Scene::parse(&text, &home, &[]).map_err(|faults| faults.to_string())?.scene;
        Ok(Self {
            path,
            home,
            saved: text.clone(),
            text,
            document: None,
            scene: Arc::new(scene),
            checked: None,
            undo: Vec::new(),
            redo: Vec::new(),
        })
    }

    /// The current text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The checked scene of the text.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The origin of the scene: its file, or the name under which it was opened.
    pub fn home(&self) -> &Path {
        &self.home
    }

    /// Whether there are unsaved changes.
    pub fn unsaved(&self) -> bool {
        self.text != self.saved
    }

    /// The text that was saved last; empty where it stands in no file.
    pub fn saved_text(&self) -> &str {
        &self.saved
    }

    /// Marks the text as unsaved: it stands in no file.
    pub fn never_saved(&mut self) {
        self.saved.clear();
    }

    /// Marks the text as saved at `path`.
    pub fn saved_to(&mut self, path: PathBuf) {
        self.saved.clone_from(&self.text);
        self.home.clone_from(&path);
        self.path = Some(path);
    }

    /// Edits the text. Successive edits with the same `what` ending in `…` are one undo step.
    ///
    /// # Errors
    /// Why the edit failed; then nothing has changed.
    pub fn edit<E: Display>(
        &mut self,
        what: &str,
        edit: impl FnOnce(&mut SceneText) -> Result<(), E>,
    ) -> Result<Effect, String> {
        // Taken out, so that an edit that fails half-way leaves no trace.
        let mut document = match self.document.take() {
            Some(document) => document,
            None => SceneText::parse(&self.text).map_err(|error| error.to_string())?,
        };
        edit(&mut document).map_err(|error| error.to_string())?;
        let text = document.text();
        // A document with new tables is parsed again: only then do later edits find them in their place.
        let kept = text.lines().count() == self.text.lines().count();
        let effect = self.replace(what, text)?;
        self.document = kept.then_some(document);
        Ok(effect)
    }

    /// Applies an edit to another text, without adopting it; `None` if the edit changes nothing.
    ///
    /// # Errors
    /// Why the edit failed.
    pub fn edited<E: Display>(
        &self,
        text: &str,
        edit: impl FnOnce(&mut SceneText) -> Result<(), E>,
    ) -> Result<Option<EditedScene>, String> {
        let mut document = SceneText::parse(text).map_err(|error| error.to_string())?;
        edit(&mut document).map_err(|error| error.to_string())?;
        let edited = document.text();
        if edited == text {
            return Ok(None);
        }
        let checked = self.check(&edited)?;
        Ok(Some(EditedScene { text: edited, checked }))
    }

    /// The scene of a text.
    ///
    /// # Errors
    /// All that is wrong with the text.
    pub fn read(&self, text: &str) -> Result<Scene, String> {
        Ok(Scene::parse(text, &self.home, &[]).map_err(|faults| faults.to_string())?.scene)
    }

    /// The scene of a text, built to check that it can run.
    ///
    /// # Errors
    /// All that is wrong with the text.
    pub fn check(&self, text: &str) -> Result<CheckedScene, String> {
        CheckedScene::new(Arc::new(self.read(text)?)).map_err(|error| error.to_string())
    }

    /// The scene with its built run; built again only if the text was not checked just now.
    ///
    /// # Errors
    /// Why the scene cannot run.
    pub fn take_checked(&mut self) -> Result<CheckedScene, String> {
        match self.checked.take() {
            Some(checked) => Ok(checked),
            None => CheckedScene::new(Arc::clone(&self.scene)).map_err(|error| error.to_string()),
        }
    }

    /// Replaces the text.
    ///
    /// # Errors
    /// All that is wrong with the text; then nothing has changed.
    pub fn replace(&mut self, what: &str, text: String) -> Result<Effect, String> {
        if text == self.text {
            return Ok(Effect::None);
        }
        let checked = self.check(&text)?;
        Ok(self.put(what, EditedScene { text, checked }))
    }

    /// Adopts an edited text.
    pub fn put(&mut self, what: &str, edited: EditedScene) -> Effect {
        let EditedScene { text, checked } = edited;
        let (effect, set) = self.effect_of(checked.scene());
        let before = UndoStep {
            text: std::mem::replace(&mut self.text, text),
            scene: std::mem::replace(&mut self.scene, Arc::clone(checked.scene())),
            what: what.to_owned(),
        };
        self.document = None;
        // The run takes it only for a change that it applies as it goes on.
        self.checked = (effect == Effect::Retune).then(|| checked.compared(Arc::clone(&before.scene), set));
        let goes_on = what.ends_with('…')
            && self.redo.is_empty()
            && self.undo.last().is_some_and(|last| last.what == what);
        if !goes_on {
            self.undo.push(before);
            if self.undo.len() > MOST_STEPS {
                self.undo.remove(0);
            }
        }
        self.redo.clear();
        effect
    }

    /// Switches to the text of another branch, where edits of this one cannot be undone.
    ///
    /// # Errors
    /// All that is wrong with the text; then nothing has changed.
    pub fn turn_to(&mut self, text: String) -> Result<(), String> {
        if text != self.text {
            // It ran before, so it need not be built to check that it can run.
            self.scene = Arc::new(self.read(&text)?);
            self.text = text;
            (self.document, self.checked) = (None, None);
        }
        self.undo.clear();
        self.redo.clear();
        Ok(())
    }

    /// Gives up unsaved changes.
    pub fn abandon(&mut self) {
        self.saved.clone_from(&self.text);
    }

    /// Ends a series of edits: the next one is a new undo step.
    pub fn rest(&mut self) {
        if let Some(last) = self.undo.last_mut()
            && let Some(done) = last.what.strip_suffix('…')
        {
            last.what = done.to_owned();
        }
    }

    /// Undoes a step; its name and its effect on the run.
    pub fn undo(&mut self) -> Option<(String, Effect)> {
        let step = self.undo.pop()?;
        let (now, effect) = self.swap(step);
        let what = now.what.clone();
        self.redo.push(now);
        Some((what, effect))
    }

    /// Redoes a step; its name and its effect on the run.
    pub fn redo(&mut self) -> Option<(String, Effect)> {
        let step = self.redo.pop()?;
        let (now, effect) = self.swap(step);
        let what = now.what.clone();
        self.undo.push(now);
        Some((what, effect))
    }

    /// The newest step that led to `text`: its name, and the text before it.
    pub fn step_to(&self, text: &str) -> Option<(&str, &str)> {
        let after = self.undo.iter().skip(1).map(|step| &*step.text).chain([&*self.text]);
        let steps: Vec<_> = self.undo.iter().zip(after).collect();
        steps.into_iter().rfind(|(_, after)| *after == text).map(|(step, _)| (&*step.what, &*step.text))
    }

    /// The name of the edit that undo would revert.
    pub fn undoes(&self) -> Option<&str> {
        self.undo.last().map(|step| step.what.trim_end_matches('…'))
    }

    /// The name of the edit that redo would apply.
    pub fn redoes(&self) -> Option<&str> {
        self.redo.last().map(|step| step.what.trim_end_matches('…'))
    }

    fn swap(&mut self, step: UndoStep) -> (UndoStep, Effect) {
        let effect = if step.text == self.text { Effect::None } else { self.effect_of(&step.scene).0 };
        (self.document, self.checked) = (None, None);
        let now = UndoStep {
            text: std::mem::replace(&mut self.text, step.text),
            scene: std::mem::replace(&mut self.scene, step.scene),
            what: step.what,
        };
        (now, effect)
    }

    /// The effect of another scene on the run, and the overrides that lead to it if the run can apply them.
    fn effect_of(&self, scene: &Scene) -> (Effect, Vec<String>) {
        let redressed = dress(&self.scene) != dress(scene);
        let sets = if redressed {
            let (title, description, environment, views, film, expect) = dress(scene);
            let dressed = Scene {
                title: title.clone(),
                description: description.clone(),
                environment: *environment,
                views: views.clone(),
                film: film.clone(),
                expect: *expect,
                ..Scene::clone(&self.scene)
            };
            dressed.sets_to(scene)
        } else {
            self.scene.sets_to(scene)
        };
        // Past changes may have become initial values, on which future changes depend. Otherwise changes are as before.
        let [before, after] = [&self.scene.changes, &scene.changes];
        let left = &before[before.len().saturating_sub(after.len())..];
        let same = |(a, b): (&scene::Change, &scene::Change)| (a.at, &a.set) == (b.at, &b.set);
        let timed = left.iter().map(|change| change.at).eq(after.iter().map(|change| change.at));
        let scripted = left.iter().zip(after).all(same);
        let effect = match &sets {
            Ok(set) if !timed || (set.is_empty() && !scripted) => {
                Effect::Restart("its changes are others".to_owned())
            }
            Ok(_) if joiners(&self.scene) != joiners(scene) => {
                Effect::Restart("a robot that leads comes to follow".to_owned())
            }
            Ok(_) if !redressed && self.scene.events != scene.events => Effect::Retune,
            Ok(set) if set.is_empty() && !redressed => Effect::None,
            Ok(set) if set.is_empty() => Effect::Dress,
            // Both at once: the file was edited by another program.
            Ok(_) if redressed => Effect::Restart("the scene is another".to_owned()),
            Ok(_) => Effect::Retune,
            Err(standing) => Effect::Restart(standing.join(", ")),
        };
        (effect, sets.unwrap_or_default())
    }
}

/// Robots that lead at the start and follow later.
fn joiners(scene: &Scene) -> Vec<String> {
    scene.joining().into_iter().map(|(name, _)| name.to_owned()).collect()
}

/// The parts of a scene that affect the appearance or the evaluation of its run, not the run itself.
fn dress(scene: &Scene) -> (&String, &String, &Environment, &Views, &Film, &Expect) {
    let Scene { title, description, environment, views, film, expect, .. } = scene;
    (title, description, environment, views, film, expect)
}
