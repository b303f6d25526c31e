//! Eyes for the robots' cameras, and how long they take.

use crate::failure::Failure;
use recording::log::Roll;
use rendering::{AdapterChoice, Gpu, GpuCameraRenderer};
use simulation::Simulation;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Instant;
use vocabulary::{CameraRenderer, Grey, Shot, Snapshot};

/// What drawing for the robots' cameras has cost so far.
#[derive(Debug, Clone, Default)]
pub(crate) struct Drawn(Arc<[AtomicU64; 2]>);

impl Drawn {
    /// Pictures drawn.
    pub(crate) fn pictures(&self) -> u64 {
        self.0[0].load(Relaxed)
    }

    /// Time it took, s.
    pub(crate) fn seconds(&self) -> f64 {
        self.0[1].load(Relaxed) as f64 * 1e-9
    }
}

/// Eyes with a stop watch.
struct Timed {
    eyes: GpuCameraRenderer,
    drawn: Drawn,
}

impl CameraRenderer for Timed {
    fn look(&mut self, snapshot: &Snapshot, shots: &[Shot], pictures: &mut Vec<Grey>) -> Result<(), String> {
        let began = Instant::now();
        let result = self.eyes.look(snapshot, shots, pictures);
        let nanoseconds = u64::try_from(began.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.drawn.0[0].fetch_add(shots.len() as u64, Relaxed);
        self.drawn.0[1].fetch_add(nanoseconds, Relaxed);
        result
    }
}

/// Gives the cameras of a run someone to draw for them, where they take pictures: `gpu`, or the adapter called `adapter`.
/// Some of the pictures are left on `roll`.
pub(crate) fn open(
    simulation: &mut Simulation,
    gpu: Option<&Gpu>,
    adapter: &str,
    roll: Option<&Roll>,
) -> Result<Drawn, Failure> {
    let drawn = Drawn::default();
    if !simulation.needs_cameras() {
        return Ok(drawn);
    }
    let opened = if gpu.is_none() { Some(Gpu::open(&AdapterChoice::from(adapter))?) } else { None };
    if let Some(gpu) = gpu.or(opened.as_ref()) {
        let eyes = GpuCameraRenderer::new(gpu, simulation.fleet())?;
        let eyes: Box<dyn CameraRenderer> = Box::new(Timed { eyes, drawn: drawn.clone() });
        simulation.attach_cameras(match roll {
            Some(roll) => roll.through(eyes),
            None => eyes,
        });
    }
    Ok(drawn)
}
