//! Scenes to test with, and a state with a run behind it.

use lab::action::Action;
use lab::app_state::AppState;
use lab::session::branches::BranchChange;
use lab::session::checked_scene::CheckedScene;
use lab::session::prediction::Predictor;
use lab::session::runner::{RunEvent, RunRequest, Runner};
use scene::{Scene, SceneText};
use simulation::Simulation;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;
use vocabulary::FleetInfo;

/// Three robots, with comments that edits have to keep.
pub(crate) const THREE: &str = "\
# Head of the file.
schema = 1
title = \"Three\" # the title
seed = 7

[time]
duration = 9.0
period = 0.01

[law]
# Gains of all.
k = 3.0 # not too stiff
beta = 2.0

# Who leads.
[[robots]]
name = \"leader\"
pose = [0.0, 0.0, 0.0]
path = { kind = \"circle\", speed = 1.0, turn_rate = 0.3 }

# To the left.
[[robots]]
name = \"left\"
pose = [-2.0, 1.0, 0.0] # where it starts
speed = 0.8
leader = \"leader\"
distance = 2.0 # from the leader
bearing = \"135 deg\"

# To the right.
[[robots]]
name = \"right\"
pose = [-2.0, -1.0, 0.0]
speed = 0.8
leader = \"leader\"
distance = 2.0
bearing = \"-135 deg\"
";

/// A checked scene.
pub(crate) fn scene(text: &str) -> Arc<Scene> {
    let loaded = Scene::parse(text, "t.toml", &[]).unwrap_or_else(|faults| panic!("{faults}\n{text}"));
    Arc::new(loaded.scene)
}

/// A scene with what it builds.
pub(crate) fn checked(text: &str) -> Box<CheckedScene> {
    Box::new(CheckedScene::new(scene(text)).expect("a run"))
}

/// A text with other values.
pub(crate) fn with(text: &str, sets: &[(&str, &str)]) -> String {
    let mut text = SceneText::parse(text).expect("TOML");
    for (path, value) in sets {
        text.set(path, value).expect("a place for the value");
    }
    text.text()
}

/// A state on which `samples` samples of a scene have arrived, and the run they are of.
pub(crate) fn app_state(text: &str, samples: usize) -> AppState {
    let mut app_state = AppState::new();
    app_state.playing = false;
    app_state.open(text.to_owned(), None, Path::new("t.toml")).expect("a scene");
    let scene = Arc::clone(app_state.scene().expect("a scene"));
    let mut run = Simulation::new(simulation::build(&scene).expect("a run"));
    run.extend_to(1e6);
    let fleet = FleetInfo { duration: scene.time.duration, ..run.fleet().clone() };
    let period = run.period();
    app_state.handle_event(RunEvent::Opened { fleet: Arc::new(fleet), period });
    let records = (0..samples).map(|_| run.next_record().expect("a moment").clone()).collect();
    app_state.handle_event(RunEvent::Records(0, records));
    app_state.requests.clear();
    app_state
}

/// A state and the thread that runs what it asks for; nothing goes on but by requests.
pub(crate) struct Rig {
    pub(crate) app_state: AppState,
    pub(crate) runner: Runner,
    wakes: Receiver<()>,
}

/// What is known of a branch.
pub(crate) struct BranchSummary {
    pub(crate) changes: Vec<BranchChange>,
    pub(crate) samples: u64,
    pub(crate) digest: String,
}

impl Rig {
    /// A scene that stands after its first sample.
    pub(crate) fn new(text: &str) -> Self {
        let (wake, wakes) = channel();
        let (predictor, _) = Predictor::start(|| ());
        let runner = Runner::start(predictor, None, move || wake.send(()).unwrap_or(()));
        let mut app_state = AppState::new();
        (app_state.playing, app_state.ahead) = (false, 0.0);
        app_state.open(text.to_owned(), None, Path::new("t.toml")).expect("a scene");
        let mut rig = Self { app_state, runner, wakes };
        rig.settle();
        rig
    }

    /// The next event.
    pub(crate) fn next(&mut self) -> RunEvent {
        loop {
            if let Some(run_event) = self.runner.next_event() {
                return run_event;
            }
            self.wakes.recv_timeout(Duration::from_mins(1)).expect("news");
        }
    }

    /// Sends what the state has requested, without waiting for what comes of it.
    pub(crate) fn send(&mut self) {
        for request in self.app_state.requests.drain(..) {
            self.runner.request(request);
        }
    }

    /// Lets everything that is requested be done, and the state take in what comes of it.
    pub(crate) fn settle(&mut self) {
        self.told(0);
    }

    /// What is known of a branch when everything that is ordered is done.
    pub(crate) fn told(&mut self, branch: usize) -> BranchSummary {
        self.send();
        self.runner.request(RunRequest::Summarize(branch));
        loop {
            match self.next() {
                RunEvent::Summary { changes, samples, digest, .. } => {
                    return BranchSummary { changes, samples, digest };
                }
                run_event => self.app_state.handle_event(run_event),
            }
        }
    }

    /// Does things, one after the other, each when the one before is done.
    pub(crate) fn act(&mut self, actions: &[Action]) {
        for action in actions {
            assert!(self.app_state.act(action), "{action:?} is not the desk's");
            self.settle();
        }
    }

    /// Samples of the branch that goes on.
    pub(crate) fn steps(&mut self, samples: usize) {
        for _ in 0..samples {
            self.runner.request(RunRequest::Step);
        }
        self.settle();
    }

    /// The text under edit.
    pub(crate) fn text(&self) -> &str {
        self.app_state.draft.as_ref().expect("a draft").text()
    }
}

/// Number and digest of the samples of a scene.
pub(crate) fn run(text: &str) -> (u64, String) {
    let mut run = Simulation::new(simulation::build(&scene(text)).expect("a run"));
    let mut digest = metrics::Digest::default();
    while let Some(record) = run.next_record() {
        digest.push(record);
    }
    (run.sample(), digest.text())
}
