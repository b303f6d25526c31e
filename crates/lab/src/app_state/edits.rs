//! How edits affect the run, and the branches that edits in the past start.

use super::AppState;
use super::branch_info::BranchInfo;
use super::past_changes::PastChanges;
use crate::session::branches::{BranchChange, script};
use crate::session::runner::{Fork, RunRequest};
use crate::session::scene_draft::{Effect, SceneDraft};
use scene::{EditError, SceneText};
use std::sync::Arc;

impl AppState {
    /// Edits the scene and passes the edit to the run; whether it succeeded. Says why where it did not.
    pub fn edit(&mut self, what: &str, edit: impl FnOnce(&mut SceneText) -> Result<(), EditError>) -> bool {
        let done = self.draft.is_some().then(|| self.try_edit(what, edit));
        match done {
            Some(Err(fault)) => {
                self.fault(fault);
                false
            }
            done => done.is_some(),
        }
    }

    /// Edits the scene and passes the edit to the run.
    ///
    /// # Errors
    /// Why the edit failed; then nothing has changed.
    pub(crate) fn try_edit(
        &mut self,
        what: &str,
        edit: impl FnOnce(&mut SceneText) -> Result<(), EditError>,
    ) -> Result<(), String> {
        let past_changes = self.in_the_past();
        let time = self.time();
        let done = match &mut self.draft {
            Some(draft) if !past_changes => {
                let settled = PastChanges::of(draft.scene(), time);
                draft.edit(what, |text| settled.settle(text).and_then(|()| edit(text)))
            }
            Some(_) => self.edit_past(what, edit),
            None => return Ok(()),
        };
        self.take(what, &done?);
        Ok(())
    }

    /// Whether the past is shown, where an edit starts a branch.
    pub(crate) fn in_the_past(&self) -> bool {
        self.forks == 0 && self.cursor.is_some_and(|time| time < self.end() - 1e-9)
    }

    /// The edit that undo would revert: in the past, the last one that applies there.
    pub fn undoes(&self) -> Option<String> {
        let draft = self.draft.as_ref()?;
        let what = if self.in_the_past() { draft.step_to(&self.there()?.1)?.0 } else { draft.undoes()? };
        Some(what.trim_end_matches('…').to_owned())
    }

    /// Reverts the last change that applies at the shown time, on a branch of its own.
    pub(crate) fn undo_past(&mut self) {
        let step = self.there().zip(self.draft.as_ref()).and_then(|((_, there), draft)| {
            let (what, before) = draft.step_to(&there)?;
            Some((format!("Undo: {}", what.trim_end_matches('…')), before.to_owned()))
        });
        let Some((what, before)) = step else {
            return self.note("Nothing was changed before this time");
        };
        self.fork();
        let Some(draft) = &mut self.draft else { return };
        match draft.replace(&what, before) {
            Ok(effect) => self.take(&what, &effect),
            Err(fault) => self.fault(fault),
        }
    }

    /// Edits in the past: starts a branch, unless the edit fails.
    fn edit_past(
        &mut self,
        what: &str,
        edit: impl FnOnce(&mut SceneText) -> Result<(), EditError>,
    ) -> Result<Effect, String> {
        let (Some((_, there)), Some(draft)) = (self.there(), &self.draft) else { return Ok(Effect::None) };
        let settled = PastChanges::of(&draft.read(&there)?, self.time());
        let edited = draft.edited(&there, |text| settled.settle(text).and_then(|()| edit(text)))?;
        let Some(edited) = edited else { return Ok(Effect::None) };
        self.fork();
        Ok(self.draft.as_mut().map_or(Effect::None, |draft| draft.put(what, edited)))
    }

    /// Passes an edited scene to the run.
    pub fn take(&mut self, what: &str, effect: &Effect) {
        match effect {
            Effect::None => {}
            Effect::Dress => {
                self.note(what);
                if let (Some(scene), Some(history)) =
                    (self.draft.as_ref().map(SceneDraft::scene), &mut self.history)
                {
                    history.dress(scene);
                }
            }
            Effect::Retune => {
                self.note(what);
                let Some(draft) = &mut self.draft else { return };
                match draft.take_checked() {
                    Ok(checked) => {
                        self.sent.push((Arc::clone(draft.scene()), draft.text().to_owned()));
                        self.requests.push(RunRequest::Change(Box::new(checked)));
                    }
                    Err(fault) => self.fault(fault),
                }
            }
            Effect::Restart(_) => {
                self.note(format!("{what} (the run restarts)"));
                let until = self.time();
                self.restart(until);
            }
        }
    }

    /// Forks the shown branch at the shown time.
    pub fn fork(&mut self) {
        let Some((sample, text)) = self.there() else { return };
        let name = format!("branch {}", self.branches.len() + self.forks);
        self.requests.push(RunRequest::Fork { from: self.branch, sample, name });
        self.forks += 1;
        // The scene returns to its state at that time.
        if let Some(draft) = &mut self.draft {
            // This text has been valid before.
            let _ = draft.turn_to(text);
        }
    }

    /// The sample after the shown time, and the scene's text there.
    pub(super) fn there(&self) -> Option<(u64, String)> {
        let sample = self.history.as_ref()?.sample(self.time()) + 1;
        Some((sample, self.branches.get(self.branch)?.text_at(sample, &self.base)))
    }

    /// Continues another branch.
    pub fn switch(&mut self, branch: usize) {
        if branch >= self.branches.len() || branch == self.branch {
            return;
        }
        self.branch = branch;
        self.cursor = None;
        self.prediction = None;
        self.requests.push(RunRequest::Switch(branch));
        let text = self.branches[branch].text_at(u64::MAX, &self.base);
        if let Some(draft) = &mut self.draft {
            let _ = draft.turn_to(text);
        }
    }

    /// The scene that reproduces the shown branch so far.
    ///
    /// # Errors
    /// Why there is none.
    pub fn script(&self) -> Result<String, String> {
        let branch = self.branches.get(self.branch).ok_or("There is no run.")?;
        script(&self.base, &self.own, &branch.changes, self.end().max(self.period()))
    }

    pub(crate) fn forked(&mut self, Fork { branch, from, sample, name, changes }: Fork) {
        let Some(history) = &mut self.history else { return };
        history.fork(from, sample);
        let time = (sample as f64 - 1.0) * history.period();
        let texts = self.branches.get(from).map_or_else(Vec::new, |b| b.texts.clone());
        let texts = texts.into_iter().filter(|(at, _)| *at < sample).collect();
        self.branches.truncate(branch);
        self.forks = self.forks.saturating_sub(1);
        let left = self.branches.get(from).map_or("", |branch| &branch.name);
        let what = format!("{name} forks from {left} here");
        self.branches.push(BranchInfo { name, parent: Some((from, time)), changes, texts });
        (self.branch, self.cursor) = (branch, None);
        self.note(what);
    }

    pub(crate) fn changed(&mut self, branch: usize, change: &BranchChange) {
        // The draft may have changed since.
        let sent = self.sent.iter().position(|(scene, _)| Arc::ptr_eq(scene, &change.scene));
        let sent = sent.and_then(|sent| self.sent.drain(..=sent).next_back());
        let text = sent.map(|(_, text)| text).or_else(|| Some(self.draft.as_ref()?.text().to_owned()));
        if let Some(face) = self.branches.get_mut(branch) {
            face.texts.retain(|(sample, _)| *sample != change.sample);
            face.texts.extend(text.map(|text| (change.sample, text)));
            face.changes.retain(|before| before.sample != change.sample);
            if !change.is_empty() {
                face.changes.push(change.clone());
            }
        }
    }
}
