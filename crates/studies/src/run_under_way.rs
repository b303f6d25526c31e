//! A run that is stepped piece by piece, with what is kept of it: so it can be made in the shares of a frame, too.

use crate::certify::Examiner;
use crate::verdict::{not_finite, verdict};
use crate::{Error, JudgedRun, SceneRun};
use metrics::{CertificateMetrics, Digest, JudgedExpectation, Metrics, MetricsBuilder, Status};
#[cfg(not(target_family = "wasm"))]
use recording::{Finished, Recorder};
use scene::Scene;
use simulation::{Fault, Simulation};
use vocabulary::{Contact, StepRecord};

/// A run that is stepped piece by piece.
pub struct RunUnderWay {
    scene: Scene,
    simulation: Simulation,
    sink: RecordSink,
    examiner: Option<Examiner>,
    steps: u64,
    /// The number of steps after which the digest is taken besides.
    then: Option<u64>,
    digest_then: Option<String>,
}

impl RunUnderWay {
    /// A run without a recorder and without certificates, which take a third of the time of a run.
    pub fn unexamined(run: SceneRun) -> Self {
        let sink = RecordSink::memory(&run);
        Self::new(run, sink, None, None)
    }

    /// A run with certificates, into `recorder` if there is one, whose digest at `then` s is taken on the way.
    #[cfg(not(target_family = "wasm"))]
    pub(crate) fn examined(
        run: SceneRun,
        recorder: Option<Recorder>,
        examiner: Examiner,
        then: Option<f64>,
    ) -> Self {
        let sink = recorder
            .map_or_else(|| RecordSink::memory(&run), |recorder| RecordSink::Disk(Box::new(recorder)));
        Self::new(run, sink, Some(examiner), then)
    }

    fn new(run: SceneRun, sink: RecordSink, examiner: Option<Examiner>, then: Option<f64>) -> Self {
        let SceneRun { scene, simulation } = run;
        let then = then.map(|time| simulation.sample_at(time) + 1);
        Self { scene, simulation, sink, examiner, steps: 0, then, digest_then: None }
    }

    /// Takes the next step; whether there was one.
    ///
    /// # Errors
    /// [`Error::Recording`] where the disk refuses the record.
    pub fn step(&mut self) -> Result<bool, Error> {
        let Some(record) = self.simulation.next_record() else { return Ok(false) };
        self.sink.push(record)?;
        if let Some(examiner) = &mut self.examiner {
            examiner.push(&self.simulation);
        }
        self.steps += 1;
        if self.then == Some(self.steps) {
            self.digest_then = Some(self.sink.digest());
        }
        Ok(true)
    }

    /// Steps that were taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The record of the last step.
    pub fn record(&self) -> &StepRecord {
        self.simulation.record()
    }

    /// Gives the run up; what was recorded stays, as interrupted.
    pub fn abandon(self) {
        self.sink.abandon();
    }

    /// What came of the run. One that has steps left, and no reason to end, is interrupted.
    ///
    /// # Errors
    /// [`Error::Camera`] where cameras could not take their pictures, [`Error::Law`] where a law for many followers gave no
    /// commands.
    pub fn finish(self) -> Result<JudgedRun, Error> {
        let Self { scene, simulation, sink, examiner, steps, then, digest_then } = self;
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
        let metrics = sink.metrics();
        let findings: Vec<JudgedExpectation> = match status {
            Status::Interrupted => vec![],
            _ => verdict(&scene, &metrics, status == Status::Complete).into_iter().chain(broken).collect(),
        };
        let judged = JudgedRun {
            status,
            steps,
            metrics,
            digest: String::new(),
            digest_then: None,
            findings,
            closed: sink.closed_contacts(),
            #[cfg(not(target_family = "wasm"))]
            written: Ok(()),
        };
        let judged = sink.finish(judged, certificates);
        let digest_then = then.map(|_| digest_then.unwrap_or_else(|| judged.digest.clone()));
        Ok(JudgedRun { digest_then, ..judged })
    }
}

/// Where records go: to a folder, or only into the sums that a verdict needs.
enum RecordSink {
    #[cfg(not(target_family = "wasm"))]
    Disk(Box<Recorder>),
    Memory {
        metrics: Box<MetricsBuilder>,
        digest: Box<Digest>,
    },
}

impl RecordSink {
    fn memory(run: &SceneRun) -> Self {
        let metrics = Box::new(MetricsBuilder::new(run.simulation.fleet(), run.scene.judging()));
        Self::Memory { metrics, digest: Box::default() }
    }

    fn push(&mut self, record: &StepRecord) -> Result<(), Error> {
        match self {
            #[cfg(not(target_family = "wasm"))]
            Self::Disk(recorder) => Ok(recorder.push(record)?),
            Self::Memory { metrics, digest } => {
                metrics.push(record);
                digest.push(record);
                Ok(())
            }
        }
    }

    fn abandon(self) {
        match self {
            #[cfg(not(target_family = "wasm"))]
            Self::Disk(recorder) => recorder.abandon(),
            Self::Memory { .. } => {}
        }
    }

    fn digest(&self) -> String {
        match self {
            #[cfg(not(target_family = "wasm"))]
            Self::Disk(recorder) => recorder.digest(),
            Self::Memory { digest, .. } => digest.text(),
        }
    }

    fn metrics(&self) -> Metrics {
        match self {
            #[cfg(not(target_family = "wasm"))]
            Self::Disk(recorder) => recorder.metrics(),
            Self::Memory { metrics, .. } => metrics.finish(),
        }
    }

    fn closed_contacts(&self) -> Vec<Contact> {
        match self {
            #[cfg(not(target_family = "wasm"))]
            Self::Disk(recorder) => recorder.closed_contacts(),
            Self::Memory { metrics, .. } => metrics.close_contacts(),
        }
    }

    /// Ends what is recorded, and says what came of the run.
    fn finish(self, run: JudgedRun, certificates: Vec<CertificateMetrics>) -> JudgedRun {
        match self {
            #[cfg(not(target_family = "wasm"))]
            Self::Disk(recorder) => {
                let Finished { metrics, digest, written } =
                    recorder.conclude(run.status, certificates, &run.findings);
                JudgedRun { metrics, digest, written: written.map(drop), ..run }
            }
            Self::Memory { metrics, digest } => {
                let metrics = Metrics { certificates, ..metrics.finish() };
                JudgedRun { metrics, digest: digest.text(), ..run }
            }
        }
    }
}
