//! A log on a thread of its own: the run hands over moments in batches and goes on.

use super::pictures::{Photo, Roll};
use super::writer::Writer;
use crate::{Error, Manifest};
use std::fs::File;
use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use vocabulary::{FleetInfo, StepRecord};

/// A batch, and so a chunk, is about this long, s.
const SPAN: f64 = 1.0;
/// Robots and edges of all moments of a batch, at most: some two megabytes.
const MOST: usize = 8192;
/// Batches that wait to be written, at most.
const WAITING: usize = 4;

/// Moments of a stretch of time, and what cameras saw in it.
struct Batch {
    records: Vec<StepRecord>,
    photos: Vec<Photo>,
}

/// What the thread ends with.
type Written = Result<Writer, Error>;

/// Hands moments to the thread that writes them.
pub(crate) struct Pipe {
    work: Option<(SyncSender<Batch>, JoinHandle<Written>)>,
    batch: Vec<StepRecord>,
    /// Batches come back empty, so that their memory is used again.
    used: Receiver<Vec<StepRecord>>,
    spare: Vec<StepRecord>,
    weight: usize,
    roll: Roll,
}

impl Pipe {
    /// Writes what is known before the run, and waits for moments.
    pub(crate) fn create(
        path: &Path,
        fleet: &FleetInfo,
        scene: &str,
        manifest: &Manifest,
        roll: Roll,
    ) -> Result<Self, Error> {
        let file = File::create(path).map_err(Error::io("create", path))?;
        let mut writer = Writer::create(file, path, fleet, scene, manifest, true)?;
        let (sender, receiver) = sync_channel::<Batch>(WAITING);
        let (back, used) = sync_channel(WAITING);
        let write = move || {
            for mut batch in receiver {
                writer.push(&mut batch.records, &batch.photos)?;
                // Where nobody waits for it, it is dropped.
                let _ = back.try_send(batch.records);
            }
            Ok(writer)
        };
        let thread = std::thread::Builder::new().name("log".to_owned()).spawn(write);
        let thread = thread.map_err(Error::io("start a thread for", path))?;
        let work = Some((sender, thread));
        Ok(Self { work, batch: vec![], used, spare: vec![], weight: 0, roll })
    }

    /// Takes a moment; waits where many batches are on their way.
    pub(crate) fn push(&mut self, record: &StepRecord) -> Result<(), Error> {
        self.weight += 1 + record.snapshot.robots.len() + record.edges.len();
        let own = match self.spare.pop() {
            Some(mut spare) => {
                copy(&mut spare, record);
                spare
            }
            None => record.clone(),
        };
        self.batch.push(own);
        let began = self.batch.first().map_or(0.0, |first| first.snapshot.time);
        // The half keeps a sum of periods from falling just short.
        let period = (record.snapshot.time - began) / (self.batch.len() - 1).max(1) as f64;
        let long = record.snapshot.time - began > SPAN - 1.5 * period;
        if long && self.batch.len() > 1 || self.weight >= MOST { self.send() } else { Ok(()) }
    }

    fn send(&mut self) -> Result<(), Error> {
        self.weight = 0;
        let records = std::mem::take(&mut self.batch);
        while let Ok(used) = self.used.try_recv() {
            self.spare.extend(used);
        }
        let Some((sender, _)) = &self.work else { return Ok(()) };
        if sender.send(Batch { records, photos: self.roll.take() }).is_err() {
            // The thread has ended, which it does by an error only.
            self.join()?;
        }
        Ok(())
    }

    fn join(&mut self) -> Result<Option<Writer>, Error> {
        let Some((sender, thread)) = self.work.take() else { return Ok(None) };
        drop(sender);
        match thread.join() {
            Ok(result) => result.map(Some),
            Err(_) => Err(Error::log(super::FILE.as_ref(), "its thread failed")),
        }
    }

    /// Writes what is still on its way, and then `manifest`.
    pub(crate) fn finish(mut self, manifest: &Manifest) -> Result<(), Error> {
        self.send()?;
        self.join()?.map_or(Ok(()), |writer| writer.finish(manifest))
    }
}

/// Copies into memory that is there.
fn copy(to: &mut StepRecord, from: &StepRecord) {
    // What is added to a moment has to be copied: it does not compile without.
    let StepRecord { snapshot, edges, contacts, frames, safety, laws, leaders, events, plans } = from;
    to.snapshot.time = snapshot.time;
    to.snapshot.robots.clone_from(&snapshot.robots);
    to.snapshot.props.clone_from(&snapshot.props);
    to.edges.clone_from(edges);
    to.contacts.clone_from(contacts);
    to.frames.clone_from(frames);
    to.safety.clone_from(safety);
    to.laws.clone_from(laws);
    to.leaders.clone_from(leaders);
    to.events.clone_from(events);
    to.plans.clone_from(plans);
}
