//! Arguments that several subcommands share. Those of one subcommand alone stand in its file.

use crate::failure::Failure;
use clap::Args;
use footage::{PictureOptions, parse_size};
use rendering::{AdapterChoice, Gpu};
use scene::Override;
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// Arguments of every subcommand that takes a scene.
#[derive(Debug, Args)]
pub(crate) struct SceneArgs {
    /// Scene file, the name of a shipped scene, such as circle-three: `echelon scenes` lists them; or a link in quotes
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    /// Override a value of the scene, such as time.duration=5 or robots.follower-1.distance=1.5; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub(crate) set: Vec<Override>,
    /// Random seed, in place of the scene's
    #[arg(long, value_parser = seed, allow_negative_numbers = true)]
    pub(crate) seed: Option<u64>,
    #[command(flatten)]
    pub(crate) adapter: AdapterArgs,
    /// Print the result as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Print errors only
    #[arg(long, short, conflicts_with = "json")]
    pub(crate) quiet: bool,
}

/// The graphics adapter.
#[derive(Debug, Args)]
pub(crate) struct AdapterArgs {
    /// Graphics adapter for everything that is rendered, camera images of robots included: its number in `echelon doctor`,
    /// vulkan, gl, part of its name, or both as in vulkan:llvmpipe; fails if there is no such adapter
    #[arg(id = "adapter", long = "adapter", value_name = "ADAPTER", default_value = AdapterArgs::AUTO,
        value_parser = clap::builder::NonEmptyStringValueParser::new())]
    pub(crate) name: String,
}

impl AdapterArgs {
    /// The name that leaves the choice to the program.
    const AUTO: &str = "auto";

    /// Opens the adapter where one is of use but not needed; the error says why there is none. One that was asked for by name
    /// has to be there.
    pub(crate) fn open_if_any(&self) -> Result<Result<Gpu, rendering::Error>, Failure> {
        match self.open() {
            Err(error) if self.name != Self::AUTO => Err(error.into()),
            opened => Ok(opened),
        }
    }

    /// Opens the adapter.
    pub(crate) fn open(&self) -> Result<Gpu, rendering::Error> {
        Gpu::open(&AdapterChoice::from(self.name.as_str()))
    }
}

/// How pictures look.
#[derive(Debug, Clone, Args)]
pub(crate) struct PictureArgs {
    /// View: snake, snake-eye, top, orbit, follow:ROBOT, camera:ROBOT, fixed, or `fixed:ex,ey,ez,tx,ty,tz[,degrees]` from an eye
    /// point to a target in m, with a field of view; several views joined by '+' split the picture
    #[arg(long)]
    pub(crate) view: Option<String>,
    /// Image size in pixels, such as 1280x720
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Elements to hide, such as labels,inset; any of ribbons, ghosts, set-points, edges, labels, names, grid, inset,
    /// caption, time, shadows, marks, contacts, barriers, events, plans
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) without: Vec<String>,
    /// In camera views, draw the detected tags, the estimated pose and its covariance
    #[arg(long)]
    pub(crate) overlay: bool,
    /// Show this robot's camera image in a corner of the picture, with the overlay
    #[arg(long, value_name = "ROBOT")]
    pub(crate) inset_camera: Option<String>,
    /// Scale of text and lines, 1 at 1280x720; by default it follows the size of the picture
    #[arg(long, value_parser = within(0.25..=8.0, "write a number from 0.25 to 8"))]
    pub(crate) scale: Option<f64>,
    /// Samples per pixel (MSAA): 4, or 1 for speed
    #[arg(long, default_value_t = 4)]
    pub(crate) samples: u32,
}

impl PictureArgs {
    /// As those who draw take them.
    pub(crate) fn options(&self) -> PictureOptions {
        let Self { view, size, without, overlay, inset_camera, scale, samples } = self.clone();
        PictureOptions { view, size, without, overlay, inset_camera, scale, samples }
    }
}

pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    parse_size(text).ok_or_else(|| "write width and height in pixels, such as 1280x720".to_owned())
}

/// A time of a list; spaces after commas are natural.
pub(crate) fn time(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "write seconds with commas between them, such as 0,2.5,15".to_owned())
}

/// A seed, in the range that scenes allow.
pub(crate) fn seed(text: &str) -> Result<u64, String> {
    let seed = text.parse().ok().filter(|seed| i64::try_from(*seed).is_ok());
    seed.ok_or_else(|| format!("write a whole number from 0 to {}", i64::MAX))
}

/// Takes a number in a range; `wanted` says which where it is another.
pub(crate) fn within(
    range: RangeInclusive<f64>,
    wanted: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| text.parse().ok().filter(|value| range.contains(value)).ok_or_else(|| wanted.to_owned())
}
