//! Recorded runs: browsing, playback, and continuing from them.

use super::AppState;
use crate::session::runner::RunRequest;
use scene::{Role, Scene, SensingKind};
use std::sync::Arc;

impl AppState {
    /// Opens a recorded run; `home` is the folder of the files that its scene names.
    ///
    /// # Errors
    /// All that is wrong with its scene; then the state is as before.
    #[cfg(not(target_family = "wasm"))]
    pub fn open_recorded(&mut self, log: recording::log::Log, home: &std::path::Path) -> Result<(), String> {
        self.draft = Some(crate::session::scene_draft::SceneDraft::new(log.scene().to_owned(), None, home)?);
        self.selection = super::Selection::Nothing;
        self.begin();
        (self.recorded, self.playing) = (true, false);
        self.requests.push(RunRequest::Recorded(Box::new(log)));
        Ok(())
    }

    /// Simulates the scene of a recorded run again in the background, so that branches can fork from it anywhere.
    pub(crate) fn leave_recording(&mut self) {
        let Some(draft) = self.draft.as_ref().filter(|_| self.recorded) else { return };
        let scene = Arc::clone(draft.scene());
        self.recorded = false;
        if sees(&scene) {
            // Rendering camera images again in the background would take too long.
            let until = self.time();
            self.restart(until);
            return self.note("The run restarts from its scene, and camera images are rendered again");
        }
        self.requests.push(RunRequest::ResumeRecording(scene));
        self.requests.push(RunRequest::Ahead(self.ahead));
        self.note("The scene is simulated again in the background, up to the end of the recording");
    }

    /// A recorded run was simulated again; `same` tells whether it is equal bit for bit.
    pub(crate) fn recording_resumed(&mut self, same: bool) {
        if same {
            return self.note("The run is the same bit for bit; a change now makes a branch of it");
        }
        // Branches of a different run would not fit the shown history.
        let until = self.time();
        self.restart(until);
        self.fault(
            "The run differs from the recording, perhaps made by another program: the scene starts again",
        );
    }

    /// Plays a recorded run for `seconds` of wall time; whether it is still playing.
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

/// Whether any robot of a scene senses with a camera.
fn sees(scene: &Scene) -> bool {
    let camera =
        |role: &Role| matches!(role, Role::Follow(follow) if follow.sensing.kind == SensingKind::Camera);
    scene.robots.iter().any(|robot| camera(&robot.role))
}
