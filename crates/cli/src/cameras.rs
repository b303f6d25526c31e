//! What draws for the cameras on robots, and how long it takes.

use crate::failure::Failure;
use recording::log::Roll;
use rendering::{AdapterChoice, Gpu, GpuCameraRenderer};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Instant;
use studies::SceneRun;
use vocabulary::{CameraRenderer, FleetInfo, Grey, Shot, Snapshot};

/// What drawing for the robots' cameras has cost so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct DrawingCost(Arc<[AtomicU64; 2]>);

impl DrawingCost {
    /// Pictures drawn.
    pub(crate) fn pictures(&self) -> u64 {
        self.0[0].load(Relaxed)
    }

    /// Time it took, s.
    pub(crate) fn seconds(&self) -> f64 {
        self.0[1].load(Relaxed) as f64 * 1e-9
    }
}

/// A renderer with a stop watch.
struct TimedRenderer {
    renderer: GpuCameraRenderer,
    cost: DrawingCost,
}

impl CameraRenderer for TimedRenderer {
    fn render(&mut self, snapshot: &Snapshot, shots: &[Shot], images: &mut Vec<Grey>) -> Result<(), String> {
        let began = Instant::now();
        let result = self.renderer.render(snapshot, shots, images);
        let nanoseconds = u64::try_from(began.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.cost.0[0].fetch_add(shots.len() as u64, Relaxed);
        self.cost.0[1].fetch_add(nanoseconds, Relaxed);
        result
    }
}

/// Gives the cameras of a run what draws for them, where they take pictures: `gpu`, or the adapter called `adapter`.
/// Some of the pictures are left on `roll`.
pub(crate) fn attach(
    run: &mut SceneRun,
    gpu: Option<&Gpu>,
    adapter: &str,
    roll: Option<&Roll>,
) -> Result<DrawingCost, Failure> {
    let cost = DrawingCost::default();
    if !run.simulation.needs_cameras() {
        return Ok(cost);
    }
    let opened = if gpu.is_none() { Some(Gpu::open(&AdapterChoice::from(adapter))?) } else { None };
    if let Some(gpu) = gpu.or(opened.as_ref()) {
        let renderer = GpuCameraRenderer::new(gpu, run.simulation.fleet())?;
        let timed: Box<dyn CameraRenderer> = Box::new(TimedRenderer { renderer, cost: cost.clone() });
        run.simulation.attach_cameras(match roll {
            Some(roll) => roll.through(timed),
            None => timed,
        });
    }
    Ok(cost)
}

/// Makes renderers for the cameras of any fleet, all on one adapter; where there is none, it says so.
pub(crate) fn factory(
    gpu: Option<&Gpu>,
) -> impl FnMut(&FleetInfo) -> Result<Box<dyn CameraRenderer>, String> {
    move |fleet| {
        let gpu = gpu.ok_or("there is no adapter to draw with")?;
        let renderer = GpuCameraRenderer::new(gpu, fleet).map_err(|error| error.to_string())?;
        Ok(Box::new(renderer))
    }
}
