//! Sweeps of the present scene: what is asked for, what comes of it, and whether it still holds.

use super::AppState;
use super::sweep_plan::SweepPlan;
use super::sweep_state::{SweepProgress, SweepResult, SweepState};
use crate::session::scene_draft::SceneDraft;
use crate::session::sweeper::{SweepEvent, SweepOrder, SweepRequest};
use scene::{Override, Scene, Study};
use std::path::Path;
use std::sync::Arc;
use sweeps::Experiment;
use vocabulary::counted;

/// A line for a shell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SweepCommand {
    /// The line.
    pub text: String,
    /// Whether it makes the same runs; else the scene has to be saved first.
    pub same: bool,
}

impl AppState {
    /// The text of the scene as it is at the shown time: in the past, as it was there.
    pub fn text_shown(&self) -> Option<String> {
        if self.in_the_past()
            && let Some((_, text)) = self.there()
        {
            return Some(text);
        }
        Some(self.draft.as_ref()?.text().to_owned())
    }

    /// Asks for a sweep of the scene.
    pub(crate) fn start_sweep(&mut self, plan: &SweepPlan) {
        self.stop_sweep();
        self.sweep.plan = Some(plan.clone());
        let (Some(text), Some(draft)) = (self.text_shown(), &self.draft) else { return };
        let name = scene::scene_name(draft.home());
        let sweep = &mut self.sweep;
        match plan.study(&name) {
            Err(text) => sweep.progress = SweepProgress::Refused(text),
            Ok(study) => {
                sweep.number += 1;
                sweep.text.clone_from(&text);
                let home = draft.home().to_owned();
                let order = SweepOrder { number: sweep.number, study, text, home };
                sweep.requests.push(SweepRequest::Check(Box::new(order)));
                sweep.progress = SweepProgress::Checking;
            }
        }
    }

    /// Gives up the runs that have not been made.
    pub(crate) fn stop_sweep(&mut self) {
        let sweep = &mut self.sweep;
        match (&sweep.progress, &sweep.result) {
            (SweepProgress::Running, Some(result)) => {
                sweep.requests.push(SweepRequest::Stop(Arc::clone(&result.job)));
                sweep.progress = SweepProgress::Stopped;
            }
            (SweepProgress::Checking, _) => {
                // Nobody waits for what the check says.
                sweep.number += 1;
                sweep.progress = SweepProgress::Idle;
            }
            _ => {}
        }
    }

    /// Forgets the sweep: another scene is open.
    pub(crate) fn forget_sweep(&mut self) {
        self.stop_sweep();
        let SweepState { requests, number, .. } = std::mem::take(&mut self.sweep);
        self.sweep = SweepState { requests, number, ..SweepState::default() };
    }

    /// Takes in what the threads of sweeps say.
    pub fn handle_sweep_event(&mut self, event: SweepEvent) {
        let sweep = &mut self.sweep;
        match event {
            SweepEvent::Ready(job) if job.number == sweep.number => {
                sweep.requests.push(SweepRequest::Make(Arc::clone(&job)));
                sweep.result = Some(SweepResult::new(job, std::mem::take(&mut sweep.text)));
                sweep.progress = SweepProgress::Running;
            }
            SweepEvent::Refused(number, text) if number == sweep.number => {
                sweep.progress = SweepProgress::Refused(text);
            }
            SweepEvent::Row(number, row) => {
                let Some(result) = sweep.result.as_mut().filter(|result| result.job.number == number) else {
                    return;
                };
                result.push(*row);
                if result.done == result.runs() && sweep.progress == SweepProgress::Running {
                    sweep.progress = SweepProgress::Complete;
                    let runs = usize::try_from(result.runs()).unwrap_or(usize::MAX);
                    let met: u64 = result.cells.iter().map(|cell| cell.met).sum();
                    self.note(format!(
                        "Sweep of {}: {met} meet what the scene expects",
                        counted(runs, "run")
                    ));
                }
            }
            SweepEvent::Ready(_) | SweepEvent::Refused(..) => {}
        }
    }

    /// What in the present scene makes the rows of the sweep those of another one; `None` where they are of this one.
    pub fn sweep_outdated(&self) -> Option<String> {
        let (result, text) = (self.sweep.result.as_ref()?, self.text_shown()?);
        if text == result.text {
            return None;
        }
        let mut compared = result.compared.borrow_mut();
        if let Some((_, found)) = compared.as_ref().filter(|(known, _)| *known == text) {
            return found.clone();
        }
        let found = self.difference(result, &text);
        *compared = Some((text, found.clone()));
        found
    }

    /// What differs between the scene of a sweep and one of this text, but for what is swept.
    fn difference(&self, result: &SweepResult, text: &str) -> Option<String> {
        let home = self.draft.as_ref()?.home();
        let experiment = &result.job.experiment;
        let Ok(overrides) = experiment.design().overrides(&experiment.design().point(0)) else { return None };
        let read = |text: &str| Scene::parse(text, home, &overrides).map(|loaded| loaded.scene);
        let Ok(before) = read(&result.text) else { return None };
        match read(text) {
            Ok(now) => first_difference(&before, now),
            Err(_) => Some("the scene".to_owned()),
        }
    }

    /// The command that makes a sweep of the scene.
    pub fn sweep_command(&self, plan: &SweepPlan) -> Option<SweepCommand> {
        let (draft, text) = (self.draft.as_ref()?, self.text_shown()?);
        let name = scene::scene_name(draft.home());
        let subject = match &draft.path {
            Some(path) => path.display().to_string(),
            None => name.clone(),
        };
        let sides: Vec<[String; 2]> =
            plan.sides.iter().map(|side| [side.key.clone(), side.values()]).collect();
        // What the file has not: as overrides, without those of keys that are swept.
        let saved = draft.saved_text();
        let read = |text: &str| Some(Scene::parse(text, draft.home(), &[]).ok()?.scene);
        let sets = read(saved).zip(read(&text)).and_then(|(a, b)| a.sets_to(&b).ok()).unwrap_or_default();
        let swept = |set: &String| {
            let key = set.split('=').next().unwrap_or_default();
            sides.iter().any(|[side, _]| key == side || key.ends_with(&format!(".{side}")))
        };
        let sets: Vec<String> = sets.into_iter().filter(|set| !swept(set)).collect();
        let same = plan.study(&name).is_ok_and(|study| same_runs(draft, saved, &text, &sets, study));
        let mut words = vec!["echelon".to_owned(), "sweep".to_owned(), quoted(&subject)];
        for [key, values] in &sides {
            words.extend(["--vary".to_owned(), quoted(&format!("{key}={values}"))]);
        }
        for set in &sets {
            words.extend(["--set".to_owned(), quoted(set)]);
        }
        words.extend(["--seeds".to_owned(), plan.seeds.to_string()]);
        Some(SweepCommand { text: words.join(" "), same })
    }
}

/// Whether the command of a study makes the runs of the scene of `text`: of the saved text, with overrides.
fn same_runs(draft: &SceneDraft, saved: &str, text: &str, sets: &[String], study: Study) -> bool {
    let shipped = || {
        let name = scene::scene_name(draft.home());
        scene::shipped(&name).is_some_and(|shipped| shipped.text == saved)
    };
    if draft.path.is_none() && !shipped() {
        return false;
    }
    let set: Result<Vec<Override>, _> = sets.iter().map(|set| set.parse()).collect();
    let Ok(set) = set else { return false };
    let first = |study: Study, text: &str, home: &Path| {
        let experiment = Experiment::of_text(study, text, home.to_owned()).ok()?;
        experiment.scene(&experiment.design().point(0)).ok()
    };
    let there = first(Study { set, ..study.clone() }, saved, draft.home());
    let here = first(study, text, draft.home());
    there.zip(here).is_some_and(|(there, here)| first_difference(&there, here).is_none())
}

/// What differs first between two scenes whose runs are not the same, or are not judged alike.
fn first_difference(before: &Scene, now: Scene) -> Option<String> {
    // What is seen, and what a scene is called, changes no run.
    let now = Scene {
        title: before.title.clone(),
        description: before.description.clone(),
        environment: before.environment,
        views: before.views.clone(),
        film: before.film.clone(),
        seed: before.seed,
        ..now
    };
    if *before == now {
        return None;
    }
    let path = |text: String| text.split('`').nth(1).map(str::to_owned);
    let found = match before.sets_to(&now) {
        Ok(sets) => sets.first().and_then(|set| set.split_once('=')).map(|(key, value)| {
            // Of a pair that is equal one is enough.
            let pair = value.trim_matches(['[', ']']).split_once(", ");
            let value = pair.filter(|(a, b)| a == b).map_or(value, |(a, _)| a);
            format!("{key} = {value}")
        }),
        Err(obstacles) => obstacles.into_iter().next().and_then(path),
    };
    Some(found.unwrap_or_else(|| "changes".to_owned()))
}

/// A word of a shell's line.
fn quoted(word: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "_./:=,+-".contains(letter);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}
