//! Everything a person can ask the lab for. Clicks, keys and panels all end here, so each can be done in several ways.

use crate::app_state::{Selection, Tool};
use std::path::PathBuf;

/// One thing to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Run on or stand.
    Toggle,
    /// One control sample.
    Step,
    /// Back by this many control samples, s.
    Back(f64),
    /// Simulated seconds per second.
    Pace(f64),
    /// Look at this time, s.
    Seek(f64),
    /// Look at the present again.
    Present,
    /// Look at a branch, and go on with it.
    Branch(usize),
    /// Leave the branch that is looked at here.
    Fork,
    /// Call a branch something else.
    NameBranch(usize, String),
    /// Select something.
    Choose(Selection),
    /// Keep the camera with a robot; `None` lets it go.
    Follow(Option<usize>),
    /// Look from a view called this.
    Viewpoint(String),
    /// Show what a robot's camera sees in a corner; `None` for nothing.
    Inset(Option<usize>),
    /// Change values of the scene, each a dotted path and TOML.
    Set {
        /// For undo and the log; with `…` at its end it goes on.
        what: String,
        /// Path and value.
        values: Vec<(String, String)>,
    },
    /// Change a value of the follower that is selected, or of all of them.
    Tune {
        /// For undo and the log; with `…` at its end it goes on.
        what: String,
        /// Its key, without the robot.
        key: &'static str,
        /// TOML; `None` for its default.
        value: Option<String>,
    },
    /// Whether changes of gains are for all followers.
    ForAll(bool),
    /// Whether a set point's mirror image moves with it.
    Mirror(bool),
    /// Scale the whole formation, and turn it, rad.
    Shape {
        /// Factor on all distances.
        scale: f64,
        /// Added to all bearings, rad.
        turn: f64,
    },
    /// The set point of an edge, m and rad.
    SetPoint {
        /// The edge.
        edge: usize,
        /// m.
        distance: f64,
        /// rad.
        bearing: f64,
    },
    /// The value under the hand is let go.
    Rest,
    /// Let a robot follow another, by their indices.
    Connect {
        /// Who is followed.
        leader: usize,
        /// Who follows.
        follower: usize,
    },
    /// A robot behind the one that is selected.
    AddRobot,
    /// Take a robot out, by its name.
    RemoveRobot(String),
    /// Call a robot something else.
    RenameRobot(String, String),
    /// A pillar or so at a place, m.
    AddProp(&'static str, [f64; 2]),
    /// Take a prop out, by its name.
    RemoveProp(String),
    /// What clicks on the ground do.
    Take(Tool),
    /// One step back.
    Undo,
    /// One step forward again.
    Redo,
    /// Write the scene to its file.
    Save,
    /// Write the scene to another file.
    SaveAs(PathBuf),
    /// Open a scene from its file, or a picture with the scene that made it.
    Open(PathBuf),
    /// Open one of the scenes that come with the program.
    OpenShipped(&'static str),
    /// Read the file again.
    Reload,
    /// Go on from the work that a crash left.
    Recover,
    /// Forget the work that a crash left.
    Forget,
    /// Begin again at time 0.
    Restart,
    /// Write the run down as a scene with its changes, and as a run folder.
    KeepRun,
    /// A PNG of what is seen.
    Picture,
    /// A PNG of the whole window.
    WindowPicture,
    /// Begin or end a film.
    Film,
    /// Film from a view called this; `None` is what is seen.
    FilmFrom(Option<String>),
    /// Write the curves as CSV.
    CurvesCsv,
    /// Write the curves as SVG.
    CurvesSvg,
    /// Look this far ahead, s.
    Ahead(f64),
    /// Switch an element of the picture by its name.
    Element(&'static str, bool),
    /// Show or hide a panel by its name.
    Panel(&'static str),
    /// Light or dark.
    Theme,
    /// Size of everything, 1 for usual.
    Scale(f32),
    /// Show or hide the shortcuts.
    Help,
    /// Show or hide the menu of scenes.
    Gallery,
    /// Close whatever lies over the view.
    Dismiss,
}
