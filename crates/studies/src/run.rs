//! One run of a scene: stepped, recorded if asked for, certified, and judged by what the scene expects.

use crate::certify::Examiner;
use crate::verdict::{not_finite, verdict};
use crate::{Error, STRIDE, SceneRun};
use metrics::{CertificateMetrics, Digest, JudgedExpectation, Metrics, MetricsBuilder};
use recording::{Finished, Recorder, Status};
use simulation::Fault;
use vocabulary::{Contact, StepRecord};

/// What came of a run.
pub struct JudgedRun {
    /// Complete, stopped before its time, or interrupted.
    pub status: Status,
    /// Samples that were taken.
    pub steps: u64,
    /// Errors, effort, clearance, contacts, certificates.
    pub metrics: Metrics,
    /// Of the trajectory.
    pub digest: String,
    /// Of the trajectory up to the time that was asked for, or to the end of the run if that is earlier.
    pub digest_then: Option<String>,
    /// The scene's expectations; none of a run that was interrupted.
    pub findings: Vec<JudgedExpectation>,
    /// The contacts that were open at the end, as if they ended then.
    pub closed: Vec<Contact>,
    /// Whether everything that was to be recorded is on the disk.
    pub written: Result<(), recording::Error>,
}

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
    run_with(run, recorder, Some(examiner), then, take)
}

/// As [`run`], without a recorder and without certificates, which take a third of the time of a run.
///
/// # Errors
/// As [`run_through`].
pub fn run_unexamined(run: SceneRun, mut go_on: impl FnMut(u64) -> bool) -> Result<JudgedRun, Error> {
    run_with(run, None, None, None, |_, steps| steps % STRIDE != 0 || go_on(steps))
}

fn run_with(
    run: SceneRun,
    recorder: Option<Recorder>,
    mut examiner: Option<Examiner>,
    then: Option<f64>,
    mut take: impl FnMut(&StepRecord, u64) -> bool,
) -> Result<JudgedRun, Error> {
    let SceneRun { scene, mut simulation } = run;
    let metrics = || Box::new(MetricsBuilder::new(simulation.fleet(), scene.judging()));
    let memory = || RecordSink::Memory { metrics: metrics(), digest: Box::default() };
    let mut sink = recorder.map_or_else(memory, |recorder| RecordSink::Disk(Box::new(recorder)));
    let mut steps = 0;
    let then = then.map(|time| simulation.sample_at(time) + 1);
    let mut digest_then = None;
    while let Some(record) = simulation.next_record() {
        if let Err(error) = sink.push(record) {
            sink.abandon();
            return Err(error.into());
        }
        if let Some(examiner) = &mut examiner {
            examiner.push(&simulation);
        }
        steps += 1;
        if then == Some(steps) {
            digest_then = Some(sink.digest());
        }
        if !take(simulation.record(), steps) {
            break;
        }
    }
    let broken = match simulation.fault() {
        Some(Fault::NotFinite(what)) => Some(not_finite(what)),
        Some(fault @ (Fault::CameraRenderer(_) | Fault::Law(_))) => {
            let error = Error::from(fault);
            sink.abandon();
            return Err(error);
        }
        None => None,
    };
    let status = match steps == simulation.len() {
        true => Status::Complete,
        false if simulation.stopped() || broken.is_some() => Status::Stopped,
        false => Status::Interrupted,
    };
    let certificates = examiner.map_or_else(Vec::new, |examiner| examiner.finish(&simulation));
    let certificates = certificates.iter().map(|c| c.metrics(simulation.fleet())).collect();
    let findings: Vec<JudgedExpectation> = match status {
        Status::Interrupted => vec![],
        _ => verdict(&scene, &sink.metrics(), status == Status::Complete).into_iter().chain(broken).collect(),
    };
    let closed = sink.closed_contacts();
    let (metrics, digest, written) = sink.finish(status, certificates, &findings);
    let digest_then = then.map(|_| digest_then.unwrap_or_else(|| digest.clone()));
    Ok(JudgedRun { status, steps, metrics, digest, digest_then, findings, closed, written })
}

/// Where records go: to a folder, or only into the sums that a verdict needs.
enum RecordSink {
    Disk(Box<Recorder>),
    Memory { metrics: Box<MetricsBuilder>, digest: Box<Digest> },
}

impl RecordSink {
    fn push(&mut self, record: &StepRecord) -> Result<(), recording::Error> {
        match self {
            Self::Disk(recorder) => recorder.push(record),
            Self::Memory { metrics, digest } => {
                metrics.push(record);
                digest.push(record);
                Ok(())
            }
        }
    }

    fn abandon(self) {
        if let Self::Disk(recorder) = self {
            recorder.abandon();
        }
    }

    fn digest(&self) -> String {
        match self {
            Self::Disk(recorder) => recorder.digest(),
            Self::Memory { digest, .. } => digest.text(),
        }
    }

    fn metrics(&self) -> Metrics {
        match self {
            Self::Disk(recorder) => recorder.metrics(),
            Self::Memory { metrics, .. } => metrics.finish(),
        }
    }

    fn closed_contacts(&self) -> Vec<Contact> {
        match self {
            Self::Disk(recorder) => recorder.closed_contacts(),
            Self::Memory { metrics, .. } => metrics.close_contacts(),
        }
    }

    fn finish(
        self,
        status: Status,
        certificates: Vec<CertificateMetrics>,
        findings: &[JudgedExpectation],
    ) -> (Metrics, String, Result<(), recording::Error>) {
        match self {
            Self::Disk(recorder) => {
                let Finished { metrics, digest, written } = recorder.conclude(status, certificates, findings);
                (metrics, digest, written.map(drop))
            }
            Self::Memory { metrics, digest } => {
                (Metrics { certificates, ..metrics.finish() }, digest.text(), Ok(()))
            }
        }
    }
}
