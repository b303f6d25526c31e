//! The commands of the lab. Clicks, keys and panels all produce them, so most can be given in several ways.

use crate::app_state::sweep_plan::SweepPlan;
use crate::app_state::{Selection, Tool};
use scene::Failure;
use std::borrow::Cow;
use std::path::PathBuf;
use vocabulary::LawKind;

/// What happens to a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Happens {
    /// It follows the robot of this index, and keeps its place.
    Follows(usize),
    /// It follows nobody and drives straight on.
    Leads,
    /// It fails.
    Fails(Failure),
    /// Those who follow it take their places anew.
    Assigns,
}

/// A law of a follower.
#[derive(Debug, Clone, PartialEq)]
pub enum LawChoice {
    /// One of the paper's.
    BuiltIn(LawKind),
    /// One that comes with the program.
    Shipped(&'static str),
    /// One whose text stands in the scene.
    Text(String),
}

/// A command of the user.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Play or pause.
    Toggle,
    /// Advance one control sample.
    Step,
    /// Go back by this much time, s; forward where it is negative.
    Back(f64),
    /// Simulated seconds per second.
    Pace(f64),
    /// Go to this time, s.
    Seek(f64),
    /// Show the present again.
    Present,
    /// Show a branch and continue it.
    Branch(usize),
    /// Fork the shown branch at the shown time.
    Fork,
    /// Rename a branch: its index and the new name.
    NameBranch(usize, String),
    /// Select something.
    Select(Selection),
    /// Attach the camera to a robot; `None` detaches it.
    Follow(Option<usize>),
    /// Select a view by its name.
    Viewpoint(String),
    /// Show the camera image of a robot in a corner; `None` hides it.
    Inset(Option<usize>),
    /// Set values of the scene.
    Set {
        /// For undo and the log; a `…` at its end marks an edit in progress.
        what: String,
        /// Dotted paths and TOML values.
        values: Vec<(String, String)>,
    },
    /// Set a value of the selected follower or of all followers.
    Tune {
        /// For undo and the log; a `…` at its end marks an edit in progress.
        what: String,
        /// Its key, without the robot.
        key: Cow<'static, str>,
        /// TOML; `None` for its default.
        value: Option<String>,
    },
    /// Give the selected follower, or all followers, another law.
    ChooseLaw(LawChoice),
    /// Edit the text of the custom law of the selected follower.
    EditLaw(String),
    /// Whether gain changes apply to all followers.
    ForAll(bool),
    /// Whether the mirror image of a set point moves with it.
    Mirror(bool),
    /// Scale and rotate the whole formation.
    Shape {
        /// Factor of all distances.
        scale: f64,
        /// Added to all bearings, rad; left is positive.
        turn: f64,
    },
    /// Move the set point of an edge.
    SetPoint {
        /// The edge.
        edge: usize,
        /// m.
        distance: f64,
        /// rad.
        bearing: f64,
    },
    /// Move a goal of a lead robot.
    Goal {
        /// The robot.
        robot: usize,
        /// Number of the goal, from 0.
        number: usize,
        /// In the world, m.
        place: [f64; 2],
    },
    /// The user has released the dragged value.
    Release,
    /// Let a robot follow another; both by index.
    Connect {
        /// Index of the leader.
        leader: usize,
        /// Index of the follower.
        follower: usize,
        /// Whether it keeps the leaders that it has.
        adds: bool,
    },
    /// Let something happen to a robot now.
    Happen {
        /// Index of the robot.
        robot: usize,
        /// What.
        what: Happens,
    },
    /// Add a robot behind the selected one.
    AddRobot,
    /// Remove a robot by its name.
    RemoveRobot(String),
    /// Rename a robot: its name and the new name.
    RenameRobot(String, String),
    /// Add a prop of this shape at a place, m.
    AddProp(&'static str, [f64; 2]),
    /// Remove a prop by its name.
    RemoveProp(String),
    /// Select a tool for clicks on the ground.
    UseTool(Tool),
    /// Undo the last edit.
    Undo,
    /// Redoes a step; its name and its effect on the run.
    Redo,
    /// Write the scene to its file.
    Save,
    /// Write the scene to another file.
    SaveAs(PathBuf),
    /// Open a scene, a recorded run, or a picture with an embedded scene.
    Open(PathBuf),
    /// Open a shipped scene.
    OpenShipped(&'static str),
    /// Open a file that the browser has read, or text that was pasted: its name and its bytes.
    #[cfg(target_family = "wasm")]
    OpenBytes(PathBuf, Vec<u8>),
    /// Reload the file.
    Reload,
    /// Restore the unsaved work of an earlier session.
    Recover,
    /// Discard the unsaved work of an earlier session.
    Forget,
    /// Restart at time 0.
    Restart,
    /// Write the run to a folder, with its scene and its changes.
    KeepRun,
    /// Copy a link to what is shown.
    Share,
    /// Write a scene that repeats the shown branch, in place of a long link.
    SaveBranch,
    /// Close the line about a link.
    CloseStatus,
    /// Change what a sweep varies and shows.
    PlanSweep(SweepPlan),
    /// Sweep the scene.
    StartSweep(SweepPlan),
    /// Stop the sweep.
    StopSweep,
    /// Copy the command that makes a sweep.
    CopySweep(SweepPlan),
    /// Write a PNG of the view.
    Picture,
    /// Write a PNG of the whole window.
    WindowPicture,
    /// Start or end a film.
    Film,
    /// Film a named view; `None` films the current view.
    FilmFrom(Option<String>),
    /// Write the curves as CSV.
    CurvesCsv,
    /// Write the curves as SVG.
    CurvesSvg,
    /// Set the prediction horizon, s.
    Ahead(f64),
    /// Show or hide an element of the picture by its name.
    Element(&'static str, bool),
    /// Show or hide a panel by its name.
    Panel(&'static str),
    /// Bring a panel by its name to the front.
    ShowPanel(&'static str),
    /// Switch between the light and the dark theme.
    Theme,
    /// Set the zoom of the interface; 1 is normal.
    Scale(f32),
    /// Show or hide the shortcuts.
    Help,
    /// Show or hide the list of scenes.
    Gallery,
    /// Close what covers the view, or put the tool away.
    Dismiss,
}
