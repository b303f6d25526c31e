//! Arguments that several subcommands share. Those of one subcommand alone stand in its file.

use clap::Args;
use scene::Override;
use std::path::PathBuf;

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

pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    let parse = |t: &str| t.parse::<u32>().ok();
    text.split_once(['x', 'X', '×'])
        .and_then(|(w, h)| Some([parse(w)?, parse(h)?]))
        .ok_or_else(|| "write width and height in pixels, such as 1280x720".to_owned())
}

/// A time of a list; spaces after commas are natural.
pub(crate) fn time(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "write seconds with commas between them, such as 0,2.5,15".to_owned())
}

fn scale(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|v| (0.25..=8.0).contains(v));
    value.ok_or_else(|| "write a number from 0.25 to 8".to_owned())
}
