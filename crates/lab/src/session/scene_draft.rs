//! The scene as text that is being worked on: edits, undo, and what an edit means for the run.

use super::checked_scene::CheckedScene;
use scene::{Environment, Expect, Film, Scene, SceneText, Views};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Steps back that are kept.
const MOST_STEPS: usize = 500;

/// A scene file under work.
pub struct SceneDraft {
    /// Where it is saved; `None` for one that never was.
    pub path: Option<PathBuf>,
    /// Names the scene in messages, and where its tables are looked for.
    home: PathBuf,
    text: String,
    /// The text as it is edited, where it has been parsed.
    document: Option<SceneText>,
    scene: Arc<Scene>,
    /// What the scene builds, until the run takes it.
    checked: Option<CheckedScene>,
    saved: String,
    undo: Vec<UndoStep>,
    redo: Vec<UndoStep>,
}

/// A state to go back to.
struct UndoStep {
    text: String,
    scene: Arc<Scene>,
    /// What was done from here on, for people.
    what: String,
}

/// Another text of a scene, and the scene that it is.
#[derive(Debug)]
pub struct EditedScene {
    text: String,
    checked: CheckedScene,
}

/// What an edit means for the run.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// Nothing has changed.
    None,
    /// The run can take it as it goes.
    Retune,
    /// The run is the same, and looks different: light, title, views.
    Dress,
    /// The run has to begin anew, because of this.
    Restart(String),
}

impl SceneDraft {
    /// A scene from its text; `path` is where it is saved.
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

    /// The text as it stands.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The checked scene of the text.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Where the scene comes from: its file, or the name it was opened under.
    pub fn home(&self) -> &Path {
        &self.home
    }

    /// Whether there is something to save.
    pub fn unsaved(&self) -> bool {
        self.text != self.saved
    }

    /// The text is on disk now, at `path`.
    pub fn saved_to(&mut self, path: PathBuf) {
        self.saved.clone_from(&self.text);
        self.home.clone_from(&path);
        self.path = Some(path);
    }

    /// Edits the text. Edits in a row with the same `what` that ends in `…` are one step back.
    ///
    /// # Errors
    /// Why the edit cannot be, in words; then nothing has changed.
    pub fn edit<E: Display>(
        &mut self,
        what: &str,
        edit: impl FnOnce(&mut SceneText) -> Result<(), E>,
    ) -> Result<Effect, String> {
        // Taken out, so that an edit that fails half-way leaves nothing behind.
        let mut document = match self.document.take() {
            Some(document) => document,
            None => SceneText::parse(&self.text).map_err(|error| error.to_string())?,
        };
        edit(&mut document).map_err(|error| error.to_string())?;
        let text = document.text();
        // A document with new tables is parsed again: only then do later edits find them where a reader would.
        let kept = text.lines().count() == self.text.lines().count();
        let effect = self.replace(what, text)?;
        self.document = kept.then_some(document);
        Ok(effect)
    }

    /// Another text with an edit, which is not put in place, and its scene; `None` where the edit changes nothing.
    ///
    /// # Errors
    /// Why the edit cannot be, in words.
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

    /// The scene of a text, if it can run.
    ///
    /// # Errors
    /// All that is wrong with the text.
    pub fn check(&self, text: &str) -> Result<CheckedScene, String> {
        CheckedScene::new(Arc::new(self.read(text)?)).map_err(|error| error.to_string())
    }

    /// The scene with what it builds, for the run; built anew only where the text was not checked just now.
    ///
    /// # Errors
    /// Why the scene cannot run, in words.
    pub fn take_checked(&mut self) -> Result<CheckedScene, String> {
        match self.checked.take() {
            Some(checked) => Ok(checked),
            None => CheckedScene::new(Arc::clone(&self.scene)).map_err(|error| error.to_string()),
        }
    }

    /// Puts another text in place.
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

    /// Puts an edited text in place.
    pub fn put(&mut self, what: &str, edited: EditedScene) -> Effect {
        let EditedScene { text, checked } = edited;
        let (effect, set) = self.effect_of(checked.scene());
        let before = UndoStep {
            text: std::mem::replace(&mut self.text, text),
            scene: std::mem::replace(&mut self.scene, Arc::clone(checked.scene())),
            what: what.to_owned(),
        };
        self.document = None;
        // What is not taken by a run that goes on is not kept.
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

    /// Goes to the text of another branch: what was done on this one cannot be undone there.
    ///
    /// # Errors
    /// All that is wrong with the text; then nothing has changed.
    pub fn turn_to(&mut self, text: String) -> Result<(), String> {
        if text != self.text {
            // It ran before, so it need not be built to know that it can.
            self.scene = Arc::new(self.read(&text)?);
            self.text = text;
            (self.document, self.checked) = (None, None);
        }
        self.undo.clear();
        self.redo.clear();
        Ok(())
    }

    /// What is not saved need not be.
    pub fn abandon(&mut self) {
        self.saved.clone_from(&self.text);
    }

    /// Ends a row of edits: the next is a step of its own.
    pub fn rest(&mut self) {
        if let Some(last) = self.undo.last_mut()
            && let Some(done) = last.what.strip_suffix('…')
        {
            last.what = done.to_owned();
        }
    }

    /// One step back; what it was and what going back means.
    pub fn undo(&mut self) -> Option<(String, Effect)> {
        let step = self.undo.pop()?;
        let (now, effect) = self.swap(step);
        let what = now.what.clone();
        self.redo.push(now);
        Some((what, effect))
    }

    /// One step forward again.
    pub fn redo(&mut self) -> Option<(String, Effect)> {
        let step = self.redo.pop()?;
        let (now, effect) = self.swap(step);
        let what = now.what.clone();
        self.undo.push(now);
        Some((what, effect))
    }

    /// The step that made `text`: what it was, and the text before it. The newest, where several did.
    pub fn step_to(&self, text: &str) -> Option<(&str, &str)> {
        let after = self.undo.iter().skip(1).map(|step| &*step.text).chain([&*self.text]);
        let steps: Vec<_> = self.undo.iter().zip(after).collect();
        steps.into_iter().rfind(|(_, after)| *after == text).map(|(step, _)| (&*step.what, &*step.text))
    }

    /// What undo would take back.
    pub fn undoes(&self) -> Option<&str> {
        self.undo.last().map(|step| step.what.trim_end_matches('…'))
    }

    /// What redo would do again.
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

    /// What another scene means for the run, and the overrides that lead to it where the run can take it.
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
        // What was past may have become what is, and what is to come depends on what is. Else changes are as they were.
        let [before, after] = [&self.scene.changes, &scene.changes];
        let left = &before[before.len().saturating_sub(after.len())..];
        let same = |(a, b): (&scene::Change, &scene::Change)| (a.at, &a.set) == (b.at, &b.set);
        let timed = left.iter().map(|change| change.at).eq(after.iter().map(|change| change.at));
        let scripted = left.iter().zip(after).all(same);
        let effect = match &sets {
            Ok(set) if !timed || (set.is_empty() && !scripted) => {
                Effect::Restart("its changes are others".to_owned())
            }
            Ok(set) if set.is_empty() && !redressed => Effect::None,
            Ok(set) if set.is_empty() => Effect::Dress,
            // Both at once come from a file that was edited elsewhere.
            Ok(_) if redressed => Effect::Restart("the scene is another".to_owned()),
            Ok(_) => Effect::Retune,
            Err(standing) => Effect::Restart(standing.join(", ")),
        };
        (effect, sets.unwrap_or_default())
    }
}

/// What of a scene changes how its run looks or is judged, and not the run.
fn dress(scene: &Scene) -> (&String, &String, &Environment, &Views, &Film, &Expect) {
    let Scene { title, description, environment, views, film, expect, .. } = scene;
    (title, description, environment, views, film, expect)
}
