//! Runs that were recorded: to look through, to play, and to take up where one looks.

use super::{AppState, Selection};
use crate::session::runner::RunRequest;
use crate::session::scene_draft::SceneDraft;
use recording::log::Log;
use scene::{Role, Scene, SensingKind};
use std::path::Path;
use std::sync::Arc;

impl AppState {
    /// Opens a run that was recorded, to look through it; its files are looked for at `home`.
    ///
    /// # Errors
    /// All that is wrong with its scene; then the state is as before.
    pub fn open_recorded(&mut self, log: Log, home: &Path) -> Result<(), String> {
        self.draft = Some(SceneDraft::new(log.scene().to_owned(), None, home)?);
        self.selection = Selection::Nothing;
        self.begin();
        (self.recorded, self.playing) = (true, false);
        self.requests.push(RunRequest::Recorded(Box::new(log)));
        Ok(())
    }

    /// Takes a recorded run up: its scene runs anew, unseen, as far as that came, so that branches can leave it anywhere.
    pub(crate) fn leave_recording(&mut self) {
        let Some(draft) = self.draft.as_ref().filter(|_| self.recorded) else { return };
        let scene = Arc::clone(draft.scene());
        self.recorded = false;
        if sees(&scene) {
            // Pictures take too long to be drawn again unseen.
            let until = self.time();
            self.restart(until);
            return self.note("The scene runs anew from here on: what cameras saw is drawn again");
        }
        self.requests.push(RunRequest::ResumeRecording(scene));
        self.requests.push(RunRequest::Ahead(self.ahead));
        self.note("What was recorded is taken up: the scene runs anew, unseen, as far as that came");
    }

    /// A recorded run was taken up.
    pub(crate) fn recording_resumed(&mut self, same: bool) {
        if same {
            return self.note("It is the same run, bit for bit: what changes from here on is a branch of it");
        }
        // Branches of another run would not fit the past that is shown.
        let until = self.time();
        self.restart(until);
        self.fault("The scene does not run as it was recorded, by another program perhaps: it begins anew");
    }

    /// Goes on through a recorded run, `seconds` of the clock; whether it goes on after that.
    pub fn roll(&mut self, seconds: f64) -> bool {
        if !self.recorded || !self.playing {
            return false;
        }
        let time = self.time() + seconds * self.pace;
        self.playing = time < self.end();
        self.cursor = self.playing.then_some(time);
        self.playing
    }
}

/// Whether robots of a scene see by camera.
fn sees(scene: &Scene) -> bool {
    let camera =
        |role: &Role| matches!(role, Role::Follow(follow) if follow.sensing.kind == SensingKind::Camera);
    scene.robots.iter().any(|robot| camera(&robot.role))
}
