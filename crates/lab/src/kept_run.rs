//! Keeps a run of the lab: simulates its scene with its changes again, and writes tables and digest.

pub use crate::session::run_event::SeenRun;
use recording::log::Roll;
use recording::{Recorder, RunOptions, Status};
use rendering::{Gpu, GpuCameraRenderer};
use scene::Scene;
use simulation::Simulation;
use std::path::Path;
use studies::run_options;
use vocabulary::counted;

/// Runs the scene of `text` again and records it in `folder`; returns a description of the result.
///
/// # Errors
/// Why it could not be written.
pub fn keep(
    text: &str,
    home: &Path,
    folder: &Path,
    seen: &SeenRun,
    gpu: Option<&Gpu>,
) -> Result<String, String> {
    let scene = Scene::parse(text, home, &[]).map_err(|faults| faults.to_string())?.scene;
    let setup = simulation::build(&scene).map_err(|error| error.to_string())?;
    let mut run = Simulation::new(setup);
    let roll = Roll::default();
    if run.needs_cameras() {
        let gpu = gpu.ok_or("there is no adapter to render camera images")?;
        let eyes = GpuCameraRenderer::new(gpu, run.fleet()).map_err(|error| error.to_string())?;
        run.attach_cameras(roll.through(Box::new(eyes)));
    }
    let options = RunOptions { roll, ..run_options(&scene) };
    let mut recorder = Recorder::create(folder, run.fleet(), options).map_err(|error| error.to_string())?;
    while let Some(record) = run.next_record() {
        recorder.push(record).map_err(|error| error.to_string())?;
    }
    let (manifest, _) = recorder.finish(Status::Complete).map_err(|error| error.to_string())?;
    let digest = manifest.digest.unwrap_or_default();
    let (place, samples) = (folder.display(), counted(manifest.samples, "sample"));
    if (manifest.samples, &*digest) == (seen.samples, &*seen.digest) {
        Ok(format!("The run is in {place}: {samples}, digest {digest}, the same as in the window"))
    } else {
        Err(format!("{place} holds {samples} with digest {digest}, which differs from the run in the window"))
    }
}
