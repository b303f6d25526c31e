//! One run of a scene: stepped, recorded if asked for, certified, and judged by what the scene expects.

use crate::certify::Examiner;
use crate::run_under_way::RunUnderWay;
use crate::{Error, STRIDE, SceneRun};
use recording::Recorder;
use vocabulary::StepRecord;

pub use crate::JudgedRun;

/// Runs a scene to its end, into `recorder` if there is one, and takes the digest at `then` s on the way. `go_on` gets the
/// number of steps every [`STRIDE`] steps and says whether the run goes on; a run that does not is interrupted.
///
/// # Errors
/// As [`run_through`].
pub fn run(
    run: SceneRun,
    recorder: Option<Recorder>,
    then: Option<f64>,
    mut go_on: impl FnMut(u64) -> bool,
) -> Result<JudgedRun, Error> {
    run_through(run, recorder, then, |_, steps| steps % STRIDE != 0 || go_on(steps))
}

/// As [`run`]; `take` gets every record, and the number of steps so far.
///
/// # Errors
/// [`Error::Recording`] where the disk refuses a record, [`Error::Camera`] where cameras cannot take their pictures,
/// [`Error::Law`] where a law for many followers gives no commands. What was recorded until then stays, as interrupted.
pub fn run_through(
    run: SceneRun,
    recorder: Option<Recorder>,
    then: Option<f64>,
    take: impl FnMut(&StepRecord, u64) -> bool,
) -> Result<JudgedRun, Error> {
    let examiner = Examiner::new(&run.scene, &run.simulation, false);
    run_with(RunUnderWay::examined(run, recorder, examiner, then), take)
}

fn run_with(
    mut run: RunUnderWay,
    mut take: impl FnMut(&StepRecord, u64) -> bool,
) -> Result<JudgedRun, Error> {
    loop {
        match run.step() {
            Ok(true) if take(run.record(), run.steps()) => {}
            Ok(_) => return run.finish(),
            Err(error) => {
                run.abandon();
                return Err(error);
            }
        }
    }
}
