//! The choice of a law, and the text of a custom law while it is edited: not every keystroke leaves a law.

use super::AppState;
use crate::action::LawChoice;
use laws::{CustomLaw, Declaration, LawFile, Mistake};
use scene::{EditError, LAW_CHOICE, SceneText, toml_text};
use vocabulary::{EntityId, StepRecord, Word};

/// The text of a custom law that is being edited.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LawEdit {
    /// What the editor shows.
    pub text: String,
    /// What is wrong with it; the law before is at work then.
    pub mistakes: Vec<Mistake>,
    /// Why the scene does not take it, though it is a law; or why it broke off as it drove.
    pub refusal: Option<String>,
    /// The text of the law that is at work.
    of: String,
}

impl AppState {
    /// The text of the custom law of the follower that panels tune, as the editor shows it; `None` where it has a
    /// built-in law, or a module, which has no text.
    pub fn law_edit(&self) -> Option<LawEdit> {
        let (.., follow) = self.tuned_follower()?;
        let text = follow.law.custom()?.text()?;
        let unchanged =
            || LawEdit { text: text.to_owned(), mistakes: vec![], refusal: None, of: text.to_owned() };
        // What somebody else changed in the meantime is shown as it is.
        Some(self.law_edit.clone().filter(|edit| edit.of == text).unwrap_or_else(unchanged))
    }

    /// Laws that broke off at samples that have arrived: in the log, and under their text.
    pub(crate) fn note_law_faults(&mut self, records: &[StepRecord]) {
        for record in records {
            for state in record.laws.iter().filter(|state| !state.fault.is_empty()) {
                let robot =
                    self.fleet().map_or("", |fleet| fleet.name(EntityId::Robot(state.robot))).to_owned();
                let time = record.snapshot.time;
                let text = format!(
                    "Law of {robot}, t = {time:.2} s, {}; it brakes until its law is changed",
                    state.fault
                );
                self.say(text.clone(), true);
                let shown = self.tuned_follower().is_some_and(|(_, robot, ..)| robot == state.robot);
                if let Some(edit) = self.law_edit().filter(|_| shown) {
                    self.law_edit = Some(LawEdit { refusal: Some(text), ..edit });
                }
            }
        }
    }

    /// Takes in an edited text: what is a law takes hold at the next sample.
    pub(crate) fn edit_law(&mut self, text: &str) {
        let Some(edit) = self.law_edit() else { return };
        let edit = LawEdit { text: text.to_owned(), mistakes: vec![], refusal: None, ..edit };
        self.law_edit = Some(match LawFile::compile(text) {
            Err(mistakes) => LawEdit { mistakes, ..edit },
            Ok(law) => {
                let faults =
                    self.put_law("Text of the law…", &LawChoice::Text(text.to_owned()), law.declaration());
                match faults {
                    Ok(()) => LawEdit { of: text.trim().to_owned(), ..edit },
                    Err(refusal) => LawEdit { refusal: Some(refusal), ..edit },
                }
            }
        });
    }

    /// Gives the selected follower, or all, another law, with its parameters at their defaults.
    pub(crate) fn choose_law(&mut self, choice: &LawChoice) {
        let what = format!("Law: {}", choice.name());
        if let Err(fault) = self.put_law(&what, choice, &Declaration::default()) {
            self.fault(fault);
        }
    }

    /// Writes another law into the scene. Parameters that `declaration` has keep their values.
    fn put_law(&mut self, what: &str, choice: &LawChoice, declaration: &Declaration) -> Result<(), String> {
        let kept = |name: &str, value: f64| {
            let fits = |[low, high]: [f64; 2]| (low..=high).contains(&value);
            declaration.parameters.iter().any(|own| own.name == name && fits(own.range))
        };
        let Some((_, _, name, follow)) = self.tuned_follower() else { return Ok(()) };
        let values: Vec<(String, f64)> =
            follow.law.parameters.iter().map(|(name, value)| (name.clone(), *value)).collect();
        let values: Vec<_> = values.into_iter().filter(|(name, value)| kept(name, *value)).collect();
        let (key, value) = match choice {
            LawChoice::BuiltIn(kind) => ("law.kind", toml_text(kind.word())),
            LawChoice::Shipped(name) => ("law.file", toml_text(name)),
            LawChoice::Text(text) => ("law.text", toml_text(text.trim())),
        };
        let (all, name) = (self.for_all, name.to_owned());
        let followers: Vec<String> = self
            .scene_now()
            .map_or_else(Vec::new, |scene| scene.followers().map(|(name, _)| name.to_owned()).collect());
        self.try_edit(what, |text: &mut SceneText| -> Result<(), EditError> {
            let places: Vec<String> = if all {
                let robots = followers.iter().map(|name| format!("robots.{name}."));
                let groups = (0..text.count("groups")).map(|group| format!("groups.{group}."));
                robots.chain(groups).chain([String::new()]).collect()
            } else {
                vec![format!("robots.{name}.")]
            };
            for place in &places {
                remove_law(text, place)?;
            }
            let place = if all { String::new() } else { format!("robots.{name}.") };
            text.set(&format!("{place}{key}"), &value)?;
            values.iter().try_for_each(|(name, value)| {
                text.set(&format!("{place}law.parameters.{name}"), &crate::numbers::toml_number(*value))
            })
        })
    }
}

/// Takes out what says at `place`, such as "robots.left.", which law a follower has, and with which parameters.
pub(super) fn remove_law(text: &mut SceneText, place: &str) -> Result<(), EditError> {
    LAW_CHOICE
        .iter()
        .chain(&["parameters"])
        .try_for_each(|key| text.remove(&format!("{place}law.{key}")).map(drop))
}

impl LawChoice {
    /// What to call it.
    pub fn name(&self) -> String {
        match self {
            Self::BuiltIn(kind) => kind.word().to_owned(),
            Self::Shipped(name) => (*name).to_owned(),
            Self::Text(_) => "a law of the scene's own".to_owned(),
        }
    }
}
