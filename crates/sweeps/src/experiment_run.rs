//! A run of an experiment that is made piece by piece, and the row that comes of it.

use crate::design::RunPoint;
use crate::experiment::{CAMERAS, Experiment, GoOn};
use crate::row::{RowStatus, RunRow};
use metrics::Status;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use studies::{JudgedRun, RunUnderWay, STRIDE, SceneRun};

/// A run of an experiment that is made piece by piece. A fault of the program ends it, not the study.
pub struct ExperimentRun {
    point: RunPoint,
    stage: RunStage,
}

/// How far a run is.
enum RunStage {
    UnderWay(Box<RunUnderWay>),
    Judged(Box<JudgedRun>),
    Not(RowStatus, String),
}

impl ExperimentRun {
    pub(crate) fn new(experiment: &Experiment, point: RunPoint) -> Self {
        let stage = guarded(|| {
            let scene = match experiment.scene(&point) {
                Ok(scene) => scene,
                Err(refusal) => return RunStage::Not(RowStatus::Refused, refusal),
            };
            match SceneRun::new(scene) {
                Err(error) => RunStage::Not(RowStatus::Refused, error.to_string()),
                Ok(run) if run.simulation.needs_cameras() => {
                    RunStage::Not(RowStatus::Refused, CAMERAS.to_owned())
                }
                Ok(run) => RunStage::UnderWay(Box::new(RunUnderWay::unexamined(run))),
            }
        });
        Self { point, stage }
    }

    /// Goes on until the run ends or `go_on` says no, which is asked now and then; whether steps may be left.
    pub fn advance(&mut self, go_on: GoOn<'_>) -> bool {
        let RunStage::UnderWay(run) = &mut self.stage else { return false };
        let mut left = false;
        let stage = guarded(|| {
            loop {
                match run.step() {
                    Ok(true) if run.steps() % STRIDE != 0 || go_on() => {}
                    Ok(more) => {
                        left = more;
                        return None;
                    }
                    Err(error) => return Some(RunStage::Not(RowStatus::Broken, error.to_string())),
                }
            }
        });
        if let Some(stage) = stage {
            self.stage = stage;
        }
        left
    }

    /// The row of the run; `None` where it has not come to its end, but for one that took longer than `limit` s.
    pub fn row(self, limit: Option<f64>) -> Option<RunRow> {
        let Self { point, stage } = self;
        let stage = match stage {
            RunStage::UnderWay(run) => guarded(|| match run.finish() {
                Ok(judged) => RunStage::Judged(Box::new(judged)),
                Err(error) => RunStage::Not(RowStatus::Broken, error.to_string()),
            }),
            ended => ended,
        };
        match (stage, limit) {
            (RunStage::Not(status, reason), _) => Some(RunRow::of(point, status, reason)),
            (RunStage::Judged(judged), _) if judged.status != Status::Interrupted => {
                Some(RunRow { point, ..row(&judged) })
            }
            (RunStage::Judged(judged), Some(limit)) => {
                let time = judged.metrics.duration;
                let reason = format!("the run took longer than {limit} s, at {time:.2} s of its time");
                let row = RunRow::of(point, RowStatus::Expired, reason);
                Some(RunRow { failed_time: time, ..row }.measured(&judged))
            }
            _ => None,
        }
    }
}

/// What comes of some work, where a fault of the program is an answer, too.
fn guarded<T: From<RunStage>>(work: impl FnOnce() -> T) -> T {
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|payload| RunStage::Not(RowStatus::Panicked, message(payload.as_ref())).into())
}

/// What a row of a run that ended says, but for which run it is.
fn row(judged: &JudgedRun) -> RunRow {
    let status = if judged.status == Status::Complete { RowStatus::Complete } else { RowStatus::Stopped };
    let mut row = RunRow::of(RunPoint::default(), status, String::new()).measured(judged);
    row.digest.clone_from(&judged.digest);
    let unmet = judged.findings.iter().filter(|finding| finding.failed());
    let timed = unmet.map(|finding| (failed_at(finding.key, judged), finding));
    let first = timed.min_by(|a, b| a.0.total_cmp(&b.0));
    row.met = first.is_none();
    if let Some((time, finding)) = first {
        finding.key.clone_into(&mut row.failed);
        row.failed_time = time;
        row.reason = format!("wanted: {}; found: {}", finding.wanted, finding.found);
    }
    row
}

/// When it was clear that an expectation would not be met, s.
fn failed_at(key: &str, judged: &JudgedRun) -> f64 {
    let metrics = &judged.metrics;
    let found = match key {
        "no_contact" | "on_contact" | "contacts_exactly" | "contact_impulse_within" => {
            metrics.first_contacts.first().map(|contact| contact.begin)
        }
        "clearance_min" => metrics.clearance_min_time,
        "law" => metrics.law_faults.first().map(|fault| fault.time),
        _ => None,
    };
    found.unwrap_or(metrics.duration)
}

/// What a panic says.
fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
    format!("a fault of the program: {}", text.unwrap_or_else(|| "it says nothing".to_owned()))
}
