//! The state of the lab: scene, history, branches and selection. It carries out actions without a window.

mod branch_info;
pub mod commands;
mod edits;
mod law_edit;
mod linked;
mod past_changes;
mod recorded;
pub mod sweep_plan;
pub mod sweep_state;
pub mod sweeping;

use crate::session::branches::BranchChange;
use crate::session::history::History;
use crate::session::prediction::Prediction;
use crate::session::runner::{RunEvent, RunRequest};
use crate::session::scene_draft::SceneDraft;
pub use branch_info::BranchInfo;
pub use law_edit::LawEdit;
pub use linked::StatusLine;
use rendering::Trail;
use scene::{Follow, Leader, Link, Scene};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use sweep_state::SweepState;
use vocabulary::{EdgeState, EventKind, EventRecord, FleetInfo, ScalarTrajectory, StepRecord, math, wrap};

/// What is selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Selection {
    /// Nothing.
    #[default]
    Nothing,
    /// A robot, by its index.
    Robot(usize),
    /// An edge, by its index.
    Edge(usize),
}

/// Select a tool for clicks on the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tool {
    /// Select, and drag set points.
    #[default]
    Select,
    /// Drag from a robot to its new leader.
    Connect,
    /// Place a pillar.
    Pillar,
}

/// A line of the log.
#[derive(Debug, Clone, PartialEq)]
pub struct LogEntry {
    /// Simulated time, s.
    pub time: f64,
    /// What happened.
    pub text: String,
    /// Whether it is a fault.
    pub fault: bool,
}

/// Lines of the log that are kept.
const MOST_EVENTS: usize = 2000;

/// The state of the lab.
#[expect(clippy::struct_excessive_bools, reason = "each is a choice of its own")]
pub struct AppState {
    /// The scene being edited; `None` if none could be opened.
    pub draft: Option<SceneDraft>,
    /// Everything simulated so far.
    pub history: Option<History>,
    /// The branches, in the order of the history.
    pub branches: Vec<BranchInfo>,
    /// The branch that is shown and simulated.
    pub branch: usize,
    /// The shown time, s; `None` for the present.
    pub cursor: Option<f64>,
    /// Whether the run is playing.
    pub playing: bool,
    /// Whether the history is a recording, without a simulation behind it.
    pub recorded: bool,
    /// Simulated seconds per second.
    pub pace: f64,
    /// What is selected.
    pub selection: Selection,
    /// Select a tool for clicks on the ground.
    pub tool: Tool,
    /// The newest prediction.
    pub prediction: Option<Prediction>,
    /// Prediction horizon, s.
    pub ahead: f64,
    /// Whether gain changes apply to all followers.
    pub for_all: bool,
    /// Whether the mirror image of a set point moves with it.
    pub mirror: bool,
    /// The view of films; `None` is the current view.
    pub film_from: Option<String>,
    /// What happened.
    pub log: Vec<LogEntry>,
    /// An error message, until the user dismisses it.
    pub notice: Option<String>,
    /// What became of a link, until the user dismisses it.
    pub status: Option<StatusLine>,
    /// Where log entries are also printed.
    pub aloud: Option<std::io::Stdout>,
    /// Text of the scene at time 0 of the run.
    pub(crate) base: String,
    /// Branches that are requested and not yet made.
    pub(crate) forks: usize,
    /// Scenes sent to the run, with their texts.
    pub(crate) sent: Vec<(Arc<Scene>, String)>,
    /// The scene of this text.
    first: Option<Arc<Scene>>,
    /// The link that led to the run.
    pub(crate) link: Option<Link>,
    /// The name of the selected robot while a run restarts.
    pub(crate) chosen: Option<String>,
    /// The `[[changes]]` of that text.
    pub(crate) own: Vec<scene::Change>,
    /// The text of a custom law that is being edited.
    pub(crate) law_edit: Option<LawEdit>,
    /// The sweep of the scene.
    pub sweep: SweepState,
    /// Requests to the thread of the run.
    pub requests: Vec<RunRequest>,
}

impl AppState {
    /// A state with no scene.
    pub fn new() -> Self {
        Self {
            draft: None,
            history: None,
            branches: Vec::new(),
            branch: 0,
            cursor: None,
            playing: true,
            recorded: false,
            pace: 1.0,
            selection: Selection::Nothing,
            tool: Tool::Select,
            prediction: None,
            ahead: 6.0,
            for_all: true,
            mirror: false,
            film_from: None,
            log: Vec::new(),
            aloud: None,
            notice: None,
            status: None,
            link: None,
            base: String::new(),
            forks: 0,
            sent: Vec::new(),
            first: None,
            chosen: None,
            own: Vec::new(),
            law_edit: None,
            sweep: SweepState::default(),
            requests: Vec::new(),
        }
    }

    /// Opens a scene from its text; `path` is its file, `home` the folder of the files it names.
    ///
    /// # Errors
    /// All that is wrong with the text; then the state is as before.
    pub fn open(&mut self, text: String, path: Option<PathBuf>, home: &Path) -> Result<(), String> {
        let draft = SceneDraft::new(text, path, home)?;
        if self.draft.as_ref().is_none_or(|before| before.home() != draft.home()) {
            self.forget_sweep();
        }
        self.draft = Some(draft);
        self.selection = Selection::Nothing;
        self.restart(0.0);
        Ok(())
    }

    /// The current scene.
    pub fn scene(&self) -> Option<&Arc<Scene>> {
        self.draft.as_ref().map(SceneDraft::scene)
    }

    /// Restarts the run with the current scene and simulates it up to `until` s at once.
    pub fn restart(&mut self, until: f64) {
        self.begin();
        self.recorded = false;
        let Some(draft) = &self.draft else { return };
        self.requests.push(RunRequest::Open { scene: Arc::clone(draft.scene()), until });
        self.requests.push(RunRequest::Ahead(self.ahead));
        self.requests.push(RunRequest::Play(self.playing));
    }

    pub(crate) fn begin(&mut self) {
        let Some(draft) = &self.draft else { return };
        draft.text().clone_into(&mut self.base);
        self.first = Some(Arc::clone(draft.scene()));
        self.chosen = self.chosen_name();
        self.own.clone_from(&draft.scene().changes);
        self.cursor = None;
        (self.link, self.status) = (None, None);
    }

    /// The scene as it was at the shown time.
    fn held(&self) -> Option<&Scene> {
        let Some(time) = self.cursor else { return self.scene().map(|scene| &**scene) };
        let changes = self.branches.get(self.branch).map_or(&[][..], |branch| &branch.changes);
        let last = changes.iter().rfind(|change| change.time <= time + 1e-9);
        last.map(|change| &*change.scene).or(self.first.as_deref())
    }

    /// Robots and edges of the run.
    pub(crate) fn fleet(&self) -> Option<&Arc<FleetInfo>> {
        self.history.as_ref().map(History::fleet)
    }

    /// Control period of the run, s.
    pub(crate) fn period(&self) -> f64 {
        self.history.as_ref().map_or(0.01, History::period)
    }

    /// The trail up to the shown time, for pictures.
    pub(crate) fn trail(&self) -> Option<&Trail> {
        self.history.as_ref()?.trail(self.branch, self.time())
    }

    /// Whether the scene has changes that are not saved.
    pub(crate) fn unsaved(&self) -> bool {
        self.draft.as_ref().is_some_and(SceneDraft::unsaved)
    }

    fn chosen_name(&self) -> Option<String> {
        let robot = self.chosen_robot()?;
        Some(self.fleet()?.robots.get(robot)?.name.clone())
    }

    /// The scene with those of its own changes that apply by the shown time.
    pub fn scene_now(&self) -> Option<&Scene> {
        let (scene, time) = (self.held()?, self.time());
        let due = scene.changes.iter().rfind(|change| change.at <= time + 1e-9);
        Some(due.map_or(scene, |change| &change.then))
    }

    /// Title and caption of pictures, from the current scene.
    pub fn words(&self) -> [String; 2] {
        self.scene_now()
            .map_or_else(Default::default, |scene| [scene.title.clone(), simulation::caption(scene)])
    }

    /// The record at the shown time.
    pub fn record(&self) -> Option<Arc<StepRecord>> {
        let history = self.history.as_ref()?;
        match self.cursor {
            Some(time) => history.at(self.branch, time),
            None => history.head(self.branch).cloned(),
        }
    }

    /// The record at the shown time, with the current set points: a paused run shows edits at once.
    pub fn shown(&self) -> Option<Arc<StepRecord>> {
        let record = self.record()?;
        if self.cursor.is_some() || self.playing || !self.edits_to_come(&record) {
            return Some(record);
        }
        let wanted = |(edge, state): (usize, &EdgeState)| {
            let [distance, bearing] = self.set_point(edge)?;
            Some([distance, wrap(bearing - state.behind)])
        };
        let wanted: Vec<Option<[f64; 2]>> = record.edges.iter().enumerate().map(wanted).collect();
        let stale =
            |(state, wanted): (&EdgeState, &Option<[f64; 2]>)| wanted.is_some_and(|w| w != state.set_point);
        if !record.edges.iter().zip(&wanted).any(stale) {
            return Some(record);
        }
        let mut record = StepRecord::clone(&record);
        for (state, wanted) in record.edges.iter_mut().zip(wanted) {
            state.set_point = wanted.unwrap_or(state.set_point);
            let [distance, bearing] = state.set_point;
            state.error = [distance - state.relative.distance, wrap(bearing - state.relative.bearing)];
        }
        Some(Arc::new(record))
    }

    /// Whether the run has yet to take over an edit, so that `record` knows nothing of it.
    fn edits_to_come(&self, record: &StepRecord) -> bool {
        let (Some(history), Some(branch)) = (&self.history, self.branches.get(self.branch)) else {
            return false;
        };
        let sample = history.sample(record.snapshot.time);
        !self.sent.is_empty() || branch.texts.iter().any(|(at, _)| *at > sample)
    }

    /// The shown time, s.
    pub fn time(&self) -> f64 {
        self.cursor.unwrap_or_else(|| self.end())
    }

    /// The last time of the shown branch, s.
    pub fn end(&self) -> f64 {
        self.history.as_ref().map_or(0.0, |history| history.end(self.branch))
    }

    /// The follower of an edge: its index among the robots, its name and its parameters.
    pub fn follower(&self, edge: usize) -> Option<(usize, &str, &Follow)> {
        let scene = self.scene_now()?;
        let robots = scene.robots.iter().enumerate();
        let mut edges = robots.flat_map(|(index, robot)| {
            let follow = robot.role.follow();
            let count = follow.map_or(0, |follow| follow.leaders.count());
            follow.into_iter().cycle().take(count).map(move |follow| (index, &*robot.name, follow))
        });
        edges.nth(edge)
    }

    /// Whom an edge leads from in the scene, and what is wanted of it there.
    pub fn leader(&self, edge: usize) -> Option<&Leader> {
        Some(self.scene_now()?.edges().nth(edge)?.2)
    }

    /// All edges of the follower of `edge`, it included.
    pub fn beside(&self, edge: usize) -> Vec<usize> {
        let fleet = self.fleet();
        let own = fleet.and_then(|fleet| Some(fleet.edges_of(fleet.edges.get(edge)?.follower).collect()));
        own.unwrap_or_default()
    }

    /// The follower that panels tune, that of the selected edge or else the first: its edge and what
    /// [`AppState::follower`] returns.
    pub fn tuned_follower(&self) -> Option<(usize, usize, &str, &Follow)> {
        let edge = self.chosen_edge().unwrap_or(0);
        self.follower(edge).map(|(robot, name, follow)| (edge, robot, name, follow))
    }

    /// The robot whose safety filter panels tune: the selected one, or else the first that has a filter, or the first
    /// follower.
    pub fn filtered_robot(&self) -> Option<(usize, &scene::Robot)> {
        let robots = &self.scene_now()?.robots;
        let follows = |robot: &scene::Robot| robot.role.follow().is_some();
        let filtered = || robots.iter().position(|robot| robot.safety.acts(!follows(robot)));
        let index = self.chosen_robot().or_else(filtered).or_else(|| robots.iter().position(follows));
        robots.get(index.unwrap_or(0)).map(|robot| (index.unwrap_or(0), robot))
    }

    /// The current set point of an edge, m and rad, as the scene has it: against the heading that its bearing is held
    /// against, which may be behind the leader's own. One that has changed its leader has the place that this gave it.
    pub fn set_point(&self, edge: usize) -> Option<[f64; 2]> {
        let (robot, name, _) = self.follower(edge)?;
        let given = self.given_place(robot, name);
        let now = self.record().and_then(|record| {
            let state = record.edges.get(edge)?;
            Some([state.set_point[0], wrap(state.set_point[1] + state.behind)])
        });
        let value = |channel: &Option<ScalarTrajectory>, now: Option<f64>| match channel {
            Some(ScalarTrajectory::Constant(value)) if !given => Some(*value),
            _ => now,
        };
        let leader = self.leader(edge)?;
        Some([value(&leader.distance, now.map(|n| n[0]))?, value(&leader.bearing, now.map(|n| n[1]))?])
    }

    /// Whether an event has given `robot` its place, and nobody has moved it since.
    fn given_place(&self, robot: usize, name: &str) -> bool {
        let (Some(history), Some(branch)) = (&self.history, self.branches.get(self.branch)) else {
            return false;
        };
        let time = self.time() + 1e-9;
        let follows = |event: &EventRecord| {
            let gives = matches!(event.kind, EventKind::Follow | EventKind::Move);
            event.robot == robot && gives && event.happened()
        };
        let events = history.events(self.branch).iter().rev();
        let mut given = events.filter(|(at, event)| *at <= time && follows(event)).map(|(at, _)| *at);
        let Some(given) = given.next() else { return false };
        let moves = |set: &String| {
            let rest = set.strip_prefix("robots.").and_then(|rest| rest.strip_prefix(name));
            rest.is_some_and(|rest| rest.starts_with(".distance=") || rest.starts_with(".bearing="))
        };
        // A change holds from the sample after the one that is shown.
        let until = time + history.period();
        let moved =
            |change: &BranchChange| (given..=until).contains(&change.time) && change.set.iter().any(moves);
        self.sent.is_empty() && !branch.changes.iter().any(moved)
    }

    /// The set point of an edge that puts its place there, m, at the moment of `record`; as [`AppState::set_point`].
    pub fn set_point_at(&self, record: &StepRecord, edge: usize, place: [f64; 2]) -> Option<[f64; 2]> {
        let leader = record.edge(self.fleet()?, edge)?.leader;
        let leader = record.snapshot.robots.get(leader)?.motion.pose;
        let heading = leader.heading - record.edges.get(edge)?.behind;
        let [dx, dy] = [place[0] - leader.x, place[1] - leader.y];
        Some([math::hypot(dx, dy), wrap(math::atan2(dy, dx) - heading)])
    }

    /// The selected edge, or that of the selected robot.
    pub fn chosen_edge(&self) -> Option<usize> {
        match self.selection {
            Selection::Edge(edge) => Some(edge),
            Selection::Robot(robot) => self.edge_of(robot),
            Selection::Nothing => None,
        }
    }

    /// The edge of a follower, the first of one with several leaders.
    pub fn edge_of(&self, robot: usize) -> Option<usize> {
        self.fleet()?.edges.iter().position(|edge| edge.follower == robot)
    }

    /// The selected robot, or the follower of the selected edge.
    pub fn chosen_robot(&self) -> Option<usize> {
        match self.selection {
            Selection::Robot(robot) => Some(robot),
            Selection::Edge(edge) => self.fleet()?.edges.get(edge).map(|edge| edge.follower),
            Selection::Nothing => None,
        }
    }

    /// Adds a line to the log.
    pub fn note(&mut self, text: impl Into<String>) {
        self.event(text.into(), false);
    }

    /// Adds an error to the log and shows it.
    pub fn fault(&mut self, text: impl Into<String>) {
        let text = text.into();
        self.notice = Some(text.clone());
        self.event(text, true);
    }

    fn event(&mut self, text: String, fault: bool) {
        let time = self.time();
        if let Some(out) = &mut self.aloud {
            let kind = if fault { "fault" } else { "log" };
            // If the pipe is closed, the window continues.
            let _ = writeln!(out, "{kind} {time:.2} s: {text}");
        }
        // A drag is one line.
        let again = text.ends_with('…') && self.log.last().is_some_and(|last| last.text == text);
        if !again {
            self.log.push(LogEntry { time, text, fault });
        }
        if self.log.len() > MOST_EVENTS {
            self.log.remove(0);
        }
    }

    /// Shows a time of the branch, s.
    pub fn seek(&mut self, time: f64) {
        let end = self.end();
        if time >= end {
            self.cursor = None;
        } else {
            self.pause();
            // There is no record between two samples.
            let period = self.period();
            self.cursor = Some((time.max(0.0) / period).round() * period);
        }
    }

    /// Pauses the run.
    pub fn pause(&mut self) {
        if self.playing {
            self.playing = false;
            self.requests.push(RunRequest::Play(false));
        }
    }

    /// Plays the run, from the present.
    pub fn play(&mut self) {
        self.playing = true;
        if self.recorded {
            // At its end it starts again.
            self.cursor = self.cursor.or(Some(0.0));
            return;
        }
        self.cursor = None;
        self.requests.push(RunRequest::Play(true));
    }

    /// Handles an event from the thread of the run.
    pub fn handle_event(&mut self, run_event: RunEvent) {
        match run_event {
            RunEvent::Opened { fleet, period } => {
                self.history = Some(History::new(fleet, period));
                let name = self.link.as_ref().and_then(|link| link.branch.clone());
                let mut trunk = BranchInfo::trunk();
                trunk.name = name.unwrap_or(trunk.name);
                self.branches = vec![trunk];
                (self.branch, self.cursor, self.prediction, self.forks) = (0, None, None, 0);
                self.cursor = self.recorded.then_some(0.0);
                self.check_choice();
            }
            RunEvent::Records(branch, records) => {
                self.note_law_faults(&records);
                if let Some(history) = &mut self.history {
                    for record in records {
                        history.push(branch, record);
                    }
                }
            }
            RunEvent::Forked(fork) => self.forked(fork),
            RunEvent::Changed(branch, change) => self.changed(branch, &change),
            RunEvent::RecordingResumed(same) => self.recording_resumed(same),
            RunEvent::Reached(digest) => self.reached(digest),
            RunEvent::Summary { .. } | RunEvent::Digest { .. } => {}
            RunEvent::Stopped(why) => {
                self.playing = false;
                if let Some(why) = why {
                    self.fault(why);
                }
            }
            RunEvent::Refused(why) => {
                // Nothing is on its way any more.
                self.status = None;
                self.fault(why);
            }
        }
    }

    /// Keeps the selection by name; clears it where the robot is gone.
    fn check_choice(&mut self) {
        let Some(fleet) = self.fleet() else { return };
        let named = |name: &String| fleet.robots.iter().position(|member| member.name == *name);
        let robot = self.chosen.as_ref().and_then(named);
        let own: Vec<usize> = robot.into_iter().flat_map(|robot| fleet.edges_of(robot)).collect();
        let edge = match self.selection {
            // One with several leaders keeps that of them.
            Selection::Edge(edge) if own.contains(&edge) => Some(edge),
            _ => own.first().copied(),
        };
        self.selection = match (robot, edge, self.selection) {
            (Some(_), Some(edge), Selection::Edge(_)) => Selection::Edge(edge),
            (Some(robot), ..) => Selection::Robot(robot),
            (None, ..) if self.chosen.is_none() && !fleet.edges.is_empty() => Selection::Edge(0),
            _ => Selection::Nothing,
        };
    }
}

impl Default for AppState {
    fn default() -> Self {
        Self::new()
    }
}
