//! What stills and films are told: the run, and how its pictures look.

use std::path::Path;
use studies::SceneRun;
use vocabulary::FleetInfo;

/// Width and height in pixels, as people write them: `1280x720`.
pub fn parse_size(text: &str) -> Option<[u32; 2]> {
    let (width, height) = text.split_once(['x', 'X', '×'])?;
    Some([width.trim().parse().ok()?, height.trim().parse().ok()?])
}

/// How pictures look.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOptions {
    /// View, or several joined by `+`; that of the scene where there is none.
    pub view: Option<String>,
    /// Width and height, pixels; those of the scene where there is none.
    pub size: Option<[u32; 2]>,
    /// Elements to hide.
    pub without: Vec<String>,
    /// In views through cameras, draws the detected tags, the estimated pose and its covariance.
    pub overlay: bool,
    /// The robot whose camera image is shown in a corner.
    pub inset_camera: Option<String>,
    /// Scale of text and lines, 1 at 1280 × 720; it follows the size where there is none.
    pub scale: Option<f64>,
    /// Samples per pixel: 4, or 1 for speed.
    pub samples: u32,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self {
            view: None,
            size: None,
            without: vec![],
            overlay: false,
            inset_camera: None,
            scale: None,
            samples: 4,
        }
    }
}

/// A run to draw, of a scene or recorded, and how.
#[derive(Debug, Clone)]
pub struct DrawJob {
    /// How its pictures look.
    pub picture: PictureOptions,
    /// Number or name of the graphics adapter, or `auto`.
    pub adapter: String,
    /// What files are called by.
    pub name: String,
    /// Names, bodies and edges of the run.
    pub fleet: FleetInfo,
    /// s.
    pub duration: f64,
    /// How the scene wants to be filmed.
    pub settings: scene::Film,
    /// The view where nothing names one.
    pub view: String,
}

impl DrawJob {
    /// That of a scene, read from `path`.
    pub fn of(path: &Path, run: &SceneRun, adapter: &str, picture: PictureOptions) -> Self {
        Self {
            picture,
            adapter: adapter.to_owned(),
            name: scene::scene_name(path),
            fleet: run.simulation.fleet().clone(),
            duration: run.scene.time.duration,
            settings: run.scene.film.clone(),
            view: run.scene.views.default.clone(),
        }
    }
}
