//! From a scene file to a run.

use crate::args::SceneArgs;
use crate::failure::Failure;
use crate::print::note;
use crate::{interrupt, link, recorded};
use scene::{Loaded, Override, Scene};
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;
use studies::SceneRun;

/// Loads, checks and builds the scene of `args`.
pub(crate) fn load(args: &SceneArgs) -> Result<SceneRun, Failure> {
    let run = load_file(&args.scene, &with_seed(&args.set, args.seed)?)?;
    interrupt::watch();
    Ok(run)
}

/// Loads, checks and builds the scene at `path`.
pub(crate) fn load_file(path: &Path, overrides: &[Override]) -> Result<SceneRun, Failure> {
    build(read(path, overrides)?, &path.display())
}

/// Loads and checks the scene at `path`, which may be a link.
pub(crate) fn read(path: &Path, overrides: &[Override]) -> Result<Scene, Failure> {
    if let Some(link) = link::meant(path)? {
        return link::read(&link, overrides);
    }
    Ok(read_file(path, overrides)?.scene)
}

/// Loads and checks the scene file at `path`, or the shipped scene of that name.
pub(crate) fn read_file(path: &Path, overrides: &[Override]) -> Result<Loaded, Failure> {
    recorded::refuse(path)?;
    let _waits = told_to_wait(path);
    Scene::load(path, overrides).map_err(|errors| Failure::Usage(errors.to_string()))
}

/// How long a scene that comes through a pipe is waited for in silence.
const SILENCE: Duration = Duration::from_secs(2);

/// Says after a while what is waited for where `path` is a pipe or the like; not once what is returned is dropped.
fn told_to_wait(path: &Path) -> Option<Sender<()>> {
    std::fs::metadata(path).ok().filter(|about| !about.is_file() && !about.is_dir())?;
    let (there, waits) = channel();
    let text =
        format!("waiting for {}, which is no file: something has to write a scene to it", path.display());
    std::thread::spawn(move || {
        if waits.recv_timeout(SILENCE) == Err(RecvTimeoutError::Timeout) {
            note(&text);
        }
    });
    Some(there)
}

/// Builds a scene; a fault names it by `name`.
pub(crate) fn build(scene: Scene, name: &dyn std::fmt::Display) -> Result<SceneRun, Failure> {
    SceneRun::new(scene).map_err(|error| Failure::Usage(format!("{name}: {error}")))
}

/// The overrides of a command line, with its seed as one of them.
pub(crate) fn with_seed(set: &[Override], seed: Option<u64>) -> Result<Vec<Override>, Failure> {
    let mut overrides = set.to_vec();
    if let Some(seed) = seed {
        let seed = format!("seed={seed}").parse();
        overrides.push(seed.map_err(|e: scene::OverrideError| Failure::Usage(e.to_string()))?);
    }
    Ok(overrides)
}

/// The scene's file name without its ending; of a link the name of its scene.
pub(crate) fn stem(path: &Path) -> String {
    if let Ok(Some(link)) = link::meant(path) {
        return link.name().to_owned();
    }
    scene::scene_name(path)
}
