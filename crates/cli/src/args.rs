//! Subcommands and flags.

use crate::certify::CertifyArgs;
use crate::compare::CompareArgs;
use crate::diff::DiffArgs;
use crate::film::Preset;
use crate::replay::ReplayArgs;
use crate::stills::StillsArgs;
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use scene::Override;
use std::path::PathBuf;

/// Echelon, a 3D laboratory for vehicle formations.
#[derive(Debug, Parser)]
#[command(name = "echelon", version, about, max_term_width = 110)]
#[command(after_help = "Exit codes: 0 done and expectations met, 1 an expectation of the scene failed or a \
    replay or another run differs, \
    2 wrong usage or a bad scene, 3 the machine (no adapter, disk full), 130 interrupted.")]
pub(crate) struct Program {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Simulate a scene, record it, and hold it against what it expects
    Run(RunArgs),
    /// Run a recorded run again, and say whether it comes out the same bit for bit; or draw it as it was recorded
    Replay(ReplayArgs),
    /// Say whether two recorded runs are the same bit for bit, and where they part
    Diff(DiffArgs),
    /// Open a window in which set points and gains are tuned while the scene runs
    Lab(LabArgs),
    /// Draw pictures of a scene at given times
    Capture(CaptureArgs),
    /// Make a film of a scene
    Film(FilmArgs),
    /// Draw a run on one sheet of pictures, and all of it in one picture as under a stroboscope
    Stills(StillsArgs),
    /// Compare pictures, or folders of pictures, as eyes would, and show where they differ
    Compare(CompareArgs),
    /// Search gains that fit a scene's vehicles, and print them
    Tune(TuneArgs),
    /// Say where errors of following come from: the scene with better and worse sensing, side by side
    Budget(BudgetArgs),
    /// Say what the paper's theorems promise for a scene's run, and whether their premises are met
    Certify(CertifyArgs),
    /// Write what the cameras of a scene see, with the truth about every tag: a labelled set of pictures
    Dataset(DatasetArgs),
    /// Make figures for print of the paper's runs or of a scene, and say whether they show what is claimed
    Figures(crate::figures::FiguresArgs),
    /// Measure how well leaders are found and located in drawn pictures
    Accuracy(AccuracyArgs),
    /// Read scenes and say what is wrong with them, without running
    Check(CheckArgs),
    /// List the scenes that come with the program, or print one to start from
    Scenes(crate::scenes::ScenesArgs),
    /// Print the JSON Schema of scene files
    Schema,
    /// Say which adapters, drivers and encoders this machine has, and what is missing
    Doctor(DoctorArgs),
    /// Print completions for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// What every subcommand on a scene takes.
#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// Scene file, or the name of a scene that comes with the program, such as circle-three: `echelon scenes` lists them
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    /// Change a value of the scene, such as time.duration=5 or robots.follower-1.distance=1.5; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<Override>,
    /// Seed in place of the scene's
    #[arg(long)]
    pub(crate) seed: Option<u64>,
    /// Adapter to draw with, pictures of cameras on robots included: its number in `echelon doctor`, vulkan, gl, part of its
    /// name, or both as in vulkan:llvmpipe; fails where there is none such
    #[arg(long, default_value = "auto")]
    pub(crate) adapter: String,
    /// Print the result as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Print errors only
    #[arg(long, short, conflicts_with = "json")]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub(crate) struct RunArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Folder for the run; runs/NAME-001, -002, … if left out
    #[arg(long, short, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Also write the tables as CSV
    #[arg(long)]
    pub(crate) csv: bool,
    /// Leave out log.mcap, which other tools open and replays are drawn from
    #[arg(long)]
    pub(crate) no_log: bool,
    /// Replace an earlier run in the folder
    #[arg(long)]
    pub(crate) force: bool,
    /// Also write what became of the scene's expectations as JUnit XML, which CI systems read; `-` is standard
    /// output, and what is for people goes to standard error
    #[arg(long, value_name = "FILE")]
    pub(crate) junit: Option<PathBuf>,
    /// Record nothing, only simulate and judge
    #[arg(long, conflicts_with_all = ["out", "csv", "force", "no_log"])]
    pub(crate) no_record: bool,
}

#[derive(Debug, Args)]
pub(crate) struct LabArgs {
    /// Scene file or the name of a scene that comes with the program, a run folder or log.mcap to look through, or a picture
    /// that the lab has made; a shipped scene if left out
    #[arg(value_name = "SCENE")]
    pub(crate) scene: Option<PathBuf>,
    /// Change a value of the scene, as an edit that can be undone; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<Override>,
    /// Adapter to draw with: its number in `echelon doctor`, vulkan, gl, part of its name, or both as in vulkan:llvmpipe; fails
    /// where there is none such
    #[arg(long, default_value = "auto")]
    pub(crate) adapter: String,
    /// Width and height of the window, such as 1280x800
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Stand at first instead of running
    #[arg(long)]
    pub(crate) paused: bool,
    /// Print what happens, and how fast the window was when it is closed
    #[arg(long)]
    pub(crate) timings: bool,
}

/// How pictures look.
#[derive(Debug, Args)]
pub(crate) struct PictureArgs {
    /// snake, snake-eye, top, orbit, follow:ROBOT, camera:ROBOT, fixed, or `fixed:ex,ey,ez,tx,ty,tz[,degrees]` from an eye
    /// to a target in m with a field of view; several joined by '+' split the picture
    #[arg(long)]
    pub(crate) view: Option<String>,
    /// Pixels, such as 1280x720
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Elements to leave out, such as labels,inset; any of ribbons, ghosts, set-points, edges, labels, names, grid, inset,
    /// caption, time, shadows, marks, contacts
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) without: Vec<String>,
    /// In views through cameras, draw the tags found, the pose estimated and how sure it is
    #[arg(long)]
    pub(crate) overlay: bool,
    /// Show what this robot's camera sees in a corner of the picture, with the overlay
    #[arg(long, value_name = "ROBOT")]
    pub(crate) inset_camera: Option<String>,
    /// Size of text and lines; that of 1280x720 is 1, and it goes with the size of the picture if left out
    #[arg(long, value_parser = scale)]
    pub(crate) scale: Option<f64>,
    /// Samples a pixel: 4, or 1 for speed
    #[arg(long, default_value_t = 4)]
    pub(crate) samples: u32,
}

#[derive(Debug, Args)]
pub(crate) struct CaptureArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    /// Times in s, such as 0,5,15; the end of the run if left out
    #[arg(long, value_name = "TIMES", value_delimiter = ',', allow_negative_numbers = true, value_parser = time)]
    pub(crate) at: Vec<f64>,
    /// Folder for the pictures; it may hold others
    #[arg(long, short, value_name = "DIR", default_value = ".")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct FilmArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
    /// Frames a second of simulation time
    #[arg(long)]
    pub(crate) fps: Option<f64>,
    /// Film file: .mp4, .m4v or .gif (480x270, 10 frames a second where the scene says no other); without an ending, a
    /// folder of PNG frames; .webm, .mkv, .mov, .avi, .mpg, .mpeg, .ogv, .ts, .flv and .wmv need ffmpeg. NAME.mp4 if left
    /// out
    #[arg(long, short, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Encode with the ffmpeg on PATH instead of the built-in encoder
    #[arg(long)]
    pub(crate) ffmpeg: bool,
    /// Measures, cards and, where the scene has no storyboard, shots for a purpose
    #[arg(long, value_enum, conflicts_with = "view")]
    pub(crate) preset: Option<Preset>,
    /// Begin anew where the same film was interrupted, instead of going on
    #[arg(long)]
    pub(crate) fresh: bool,
}

#[derive(Debug, Args)]
pub(crate) struct TuneArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Runs of the scene to try, at most
    #[arg(long, value_name = "N", default_value_t = 120, value_parser = clap::value_parser!(u64).range(4..=100_000))]
    pub(crate) trials: u64,
}

#[derive(Debug, Args)]
pub(crate) struct BudgetArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Folder for budget.svg, budget.json and budget.csv, with --epsilon for epsilon.svg and so on; it may hold others
    #[arg(long, short, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Noises of a tag's corners to try, px
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        allow_negative_numbers = true,
        default_value = "0,0.02,0.05,0.1,0.2,0.5,1",
        value_parser = pixels
    )]
    pub(crate) pixel_noise: Vec<f64>,
    /// Compare observer constants ε instead, s, such as 0.001,0.003,0.01,0.03,0.1, with the one that follows from the
    /// noise
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        allow_negative_numbers = true,
        conflicts_with = "pixel_noise",
        value_parser = epsilon
    )]
    pub(crate) epsilon: Vec<f64>,
    /// Leave out what needs pictures; with --epsilon, look by corners of tags instead
    #[arg(long)]
    pub(crate) no_camera: bool,
}

#[derive(Debug, Args)]
pub(crate) struct DatasetArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Folder for pictures, dataset.json and coco.json
    #[arg(long, short, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Time from one picture of a camera to its next, s
    #[arg(long, value_name = "SECONDS", default_value = "0.2", value_parser = interval)]
    pub(crate) every: f64,
    /// Followers whose cameras take pictures; all if left out
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) edges: Vec<String>,
    /// Look for the leader in the whole picture, instead of the part around where it is
    #[arg(long)]
    pub(crate) whole: bool,
    /// Replace an earlier data set in the folder
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct AccuracyArgs {
    /// Poses of the leader to try
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    pub(crate) poses: u64,
    /// Seed of the poses and of the noise
    #[arg(long, default_value_t = 1)]
    pub(crate) seed: u64,
    /// Adapter to draw with: its number in `echelon doctor`, vulkan, gl, part of its name, or both as in vulkan:llvmpipe; fails
    /// where there is none such
    #[arg(long, default_value = "auto")]
    pub(crate) adapter: String,
    /// Print the result as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// Scene files, or names of scenes that come with the program
    #[arg(value_name = "SCENE", required = true)]
    pub(crate) scenes: Vec<PathBuf>,
    /// Change a value of every scene
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<Override>,
    /// Print the resolved scene, every default written out
    #[arg(long)]
    pub(crate) resolved: bool,
}

#[derive(Debug, Args)]
pub(crate) struct DoctorArgs {
    /// Print the result as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let parse = |t: &str| t.parse::<u32>().ok();
    text.split_once(['x', 'X', '×'])
        .and_then(|(w, h)| Some([parse(w)?, parse(h)?]))
        .ok_or_else(|| "write width and height in pixels, such as 1280x720".to_owned())
}

/// A time of a list; spaces after commas are natural.
pub(crate) fn time(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "write seconds with commas between them, such as 0,2.5,15".to_owned())
}

fn pixels(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|v| (0.0..=50.0).contains(v));
    value.ok_or_else(|| "write pixels from 0 to 50, such as 0,0.1,0.5".to_owned())
}

fn epsilon(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|v| (1e-6..=100.0).contains(v));
    value.ok_or_else(|| "write seconds from 0.000001 to 100, such as 0.001,0.01,0.1".to_owned())
}

fn interval(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|v| (0.001..=1e5).contains(v));
    value.ok_or_else(|| "write seconds from 0.001 to 100000".to_owned())
}

fn scale(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|v| (0.25..=8.0).contains(v));
    value.ok_or_else(|| "write a number from 0.25 to 8".to_owned())
}
