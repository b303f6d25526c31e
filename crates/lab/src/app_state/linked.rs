//! Links: opening one, and making one of what is shown.

use super::AppState;
use crate::numbers::fixed;
use crate::session::runner::RunRequest;
use scene::{Event, Follow, Link, LinkProof, LinkedScene, Scene, SceneText, SensingKind, TimedOverride};
use std::path::Path;
use studies::link::LinkComparison;

/// The line under the bar: what became of a link.
#[derive(Debug, Clone, PartialEq)]
pub struct StatusLine {
    /// What is said.
    pub text: String,
    /// Whether it is a fault.
    pub fault: bool,
    /// Whether a file is offered in place of a long link.
    pub offers_file: bool,
}

impl AppState {
    /// Opens a link: its scene, at its time, which the run is brought to.
    ///
    /// # Errors
    /// What is wrong with the link; then the state is as before.
    pub fn open_link(&mut self, text: &str) -> Result<Link, String> {
        let link: Link = text.parse().map_err(|error: scene::LinkError| error.to_string())?;
        let LinkedScene { home, text, .. } = link.open().map_err(|error| error.to_string())?;
        let playing = self.playing;
        self.playing = playing && link.time.is_none();
        if let Err(faults) = self.open(text, None, &home) {
            self.playing = playing;
            return Err(faults);
        }
        self.chosen.clone_from(&link.selected);
        if let Some(time) = link.time {
            self.requests.push(RunRequest::Reach(time));
            let why = if link.proof.is_some() { ", to compare it with the link" } else { "" };
            self.say(
                format!("The run goes to t = {time} s{why}. Play leaves that, and goes on from where it is"),
                false,
            );
        }
        self.link = Some(link.clone());
        Ok(link)
    }

    /// Compares the run with the link that led to it; `None` if something was changed on the way.
    pub(super) fn reached(&mut self, digest: Option<String>) {
        let Some(link) = &self.link else { return };
        let Some(digest) = digest else {
            return self
                .say("Not compared with the link: the run was changed, or played, before its time", false);
        };
        let cameras = |robot: &scene::Robot| {
            robot.role.follow().is_some_and(|follow| follow.sensing.kind == SensingKind::Camera)
        };
        let sees = self.scene().is_some_and(|scene| scene.robots.iter().any(cameras));
        if let Some(comparison) = LinkComparison::new(link, digest, sees) {
            self.say(format!("Link: {}", comparison.words()), comparison.same() == Some(false));
        }
    }

    /// Says something in the line under the bar, and in the log.
    pub(crate) fn say(&mut self, text: impl Into<String>, fault: bool) {
        let text = text.into();
        self.event(text.clone(), fault);
        self.status = Some(StatusLine { text, fault, offers_file: false });
    }

    /// Says that a link of so many characters was copied.
    pub fn shared(&mut self, link: &Link, length: usize) {
        let time = link.time.unwrap_or_default();
        let long = length > Link::SAFE_LENGTH;
        let but = if long { ": some programs cut links as long as that" } else { "" };
        self.say(format!("Link to t = {} s copied, {length} characters{but}", fixed(time, 2)), false);
        if let Some(status) = &mut self.status {
            status.offers_file = long;
        }
    }

    /// Asks for the digest of the run up to the shown time, which a link to it carries.
    pub fn share(&mut self) {
        if self.recorded {
            return self.fault("A recording is shared as its folder; a branch of it can be shared as a link");
        }
        let Some(history) = &self.history else { return };
        let samples = history.sample(self.time()) + 1;
        self.requests.push(RunRequest::Digest { branch: self.branch, samples });
    }

    /// The link to the shown branch after `samples` samples, of which `digest` is that, seen from `view`.
    ///
    /// # Errors
    /// Why there is none.
    pub fn link_to(&self, samples: u64, digest: &str, view: &str) -> Result<Link, String> {
        let branch = self.branches.get(self.branch).ok_or("There is no run")?;
        let home = self.draft.as_ref().map_or(Path::new("scene"), |draft| draft.home());
        let name = scene::scene_name(home);
        // What is changed at the present takes effect with the next sample.
        let shown =
            || branch.changes.iter().filter(|change| self.cursor.is_none() || change.sample < samples);
        let base = with_events(&self.base, shown().flat_map(|change| &change.events))?;
        // Files of laws are not on the machine where the link is opened.
        let base = match &self.first {
            Some(scene) if has_law_files(scene) => {
                let mut text = SceneText::parse(&base).map_err(|error| error.to_string())?;
                text.embed_laws(scene);
                text.text()
            }
            _ => base,
        };
        let mut link = Link::to_text(&base, &name).map_err(|error| error.to_string())?;
        for change in shown() {
            for set in &change.set {
                let set = set.parse().map_err(|error: scene::OverrideError| error.to_string())?;
                link.changes.push(TimedOverride { at: rounded(change.time), set });
            }
        }
        let robot = self.chosen_robot().and_then(|robot| Some(self.fleet()?.robots.get(robot)?.name.clone()));
        let link = Link {
            time: Some(rounded(samples.saturating_sub(1) as f64 * self.period())),
            view: Some(view.to_owned()),
            selected: robot,
            branch: (self.branch > 0).then(|| branch.name.clone()),
            proof: Some(LinkProof::of(digest)),
            ..link.shortened()
        };
        // What is copied can be opened.
        link.to_string().parse().map_err(|error: scene::LinkError| format!("This cannot be shared: {error}"))
    }
}

/// The text of a scene with what happened by hand: events have their own times.
/// Whether a law of a scene has a file of its own.
fn has_law_files(scene: &Scene) -> bool {
    let all = std::iter::once(scene).chain(scene.changes.iter().map(|change| &*change.then));
    let law = |follow: &Follow| follow.law.file.as_ref().is_some_and(scene::WrittenLaw::is_apart);
    all.flat_map(Scene::followers).any(|(_, follow)| law(follow))
}

fn with_events<'a>(base: &str, events: impl Iterator<Item = &'a Event>) -> Result<String, String> {
    let mut events = events.peekable();
    if events.peek().is_none() {
        return Ok(base.to_owned());
    }
    let mut text = SceneText::parse(base).map_err(|error| error.to_string())?;
    for event in events {
        text.add_table("events", &event.to_lines()).map_err(|error| error.to_string())?;
    }
    Ok(text.text())
}

/// A time of a sample without what is left over from its product, s.
fn rounded(time: f64) -> f64 {
    (time * 1e9).round() / 1e9
}
