//! What draws for the cameras on robots.

use crate::error::RenderingError;
use pyo3::prelude::*;
use rendering::{AdapterChoice, Gpu, GpuCameraRenderer};
use studies::SceneRun;

/// Gives the cameras of a run what draws for them, where they take pictures.
///
/// # Errors
/// [`RenderingError`] where there is no adapter.
pub(crate) fn attach(py: Python<'_>, run: &mut SceneRun, adapter: &str) -> PyResult<()> {
    if !run.simulation.needs_cameras() {
        return Ok(());
    }
    let fleet = run.simulation.fleet();
    let made = py.detach(|| {
        let gpu = Gpu::open(&AdapterChoice::from(adapter))?;
        GpuCameraRenderer::new(&gpu, fleet)
    });
    run.simulation
        .attach_cameras(Box::new(made.map_err(|error| RenderingError::new_err(error.to_string()))?));
    Ok(())
}
