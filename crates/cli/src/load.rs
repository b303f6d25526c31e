//! From a scene file to a simulation.

use crate::args::SceneArgs;
use crate::eyes::{self, Drawn};
use crate::failure::Failure;
use crate::interrupt;
use crate::recorded;
use rendering::Gpu;
use scene::{Override, Scene};
use simulation::{Setup, Simulation};
use std::path::Path;

/// A scene and its run, before the first step.
pub(crate) struct Loaded {
    pub(crate) scene: Scene,
    pub(crate) simulation: Simulation,
}

/// Loads, checks and builds the scene of `args`.
pub(crate) fn load(args: &SceneArgs) -> Result<Loaded, Failure> {
    let mut overrides = args.set.clone();
    if let Some(seed) = args.seed {
        overrides.push(parse_seed(seed)?);
    }
    let (scene, setup) = load_file(&args.scene, &overrides)?;
    interrupt::watch();
    Ok(Loaded { scene, simulation: Simulation::new(setup) })
}

impl Loaded {
    /// Gives the robots' cameras someone to draw for them, where they take pictures: `gpu`, or the adapter of `args`.
    pub(crate) fn attach_cameras(&mut self, gpu: Option<&Gpu>, args: &SceneArgs) -> Result<Drawn, Failure> {
        eyes::open(&mut self.simulation, gpu, &args.adapter, None)
    }
}

/// Loads, checks and builds the scene at `path`.
pub(crate) fn load_file(path: &Path, overrides: &[Override]) -> Result<(Scene, Setup), Failure> {
    recorded::refuse(path)?;
    let loaded = Scene::load(path, overrides).map_err(|errors| Failure::Usage(errors.to_string()))?;
    let setup = simulation::build(&loaded.scene)
        .map_err(|error| Failure::Usage(format!("{}: {error}", path.display())))?;
    Ok((loaded.scene, setup))
}

fn parse_seed(seed: u64) -> Result<Override, Failure> {
    format!("seed={seed}").parse().map_err(|e: scene::OverrideError| Failure::Usage(e.to_string()))
}

/// The scene's file name without its ending.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "scene".to_owned(), |s| s.to_string_lossy().into_owned())
}
