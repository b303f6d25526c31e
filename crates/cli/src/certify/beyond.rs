//! What lies beyond the paper, with the runs that it takes.

use super::nothing;
use crate::failure::Failure;
use crate::interrupt;
use crate::progress::Progress;
use scene::Scene;
use std::sync::atomic::{AtomicU64, Ordering};
use studies::certify::beyond::SensitivityCost;
use studies::certify::sensitivity::{Sensitivities, sensitivities};
use vocabulary::counted;

/// What every gain does to the settled error, or why that is left out.
pub(super) fn every_gain(
    scene: &Scene,
    asked: bool,
    quiet: bool,
) -> Result<Result<Sensitivities, String>, Failure> {
    let (runs, heavy) = match SensitivityCost::of(scene) {
        SensitivityCost::Pictures => {
            return Ok(Err("left out: cameras take pictures in every run".to_owned()));
        }
        SensitivityCost::Heavy(runs) if !asked => {
            return Ok(Err(format!(
                "left out: {} of this scene take long; ask for them with --sensitivity",
                counted(runs, "run")
            )));
        }
        SensitivityCost::Heavy(runs) => (runs, true),
        SensitivityCost::Light(runs) => (runs, false),
    };
    let what = format!("Trying every gain, {}", counted(runs, "run"));
    let progress = Progress::begin(&what, runs, quiet || !heavy);
    let done = AtomicU64::new(0);
    let look = || {
        done.fetch_add(1, Ordering::Relaxed);
        !interrupt::asked()
    };
    // The bar is not made for several threads: it goes on by itself.
    let found = sensitivities(scene, look).map_err(studies::Error::from)?;
    progress.at(done.load(Ordering::Relaxed));
    drop(progress);
    found.map(Ok).ok_or_else(nothing)
}
