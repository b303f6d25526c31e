//! Reads a log back: what is known of the run, and its moments in order or from a time on.
//!
//! Whole records are searched from the beginning, so a log that was cut off reads like any other, up to its last chunk.

use super::events::EventMessage;
use super::fleet::sound;
use super::import::{Imported, import};
use super::messages::{ContactRecord, SampleNumber};
use super::outline::{Chunk, ChunkOutline, LONGEST, body, parse};
use super::record::{self, Record};
use super::safety::SafetyRecord;
use super::{FORMAT, other_layout};
use crate::{Error, Manifest, Status};
use mcap::records::{MessageHeader, Record as Chunked, op};
use std::collections::{HashMap, VecDeque};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use vocabulary::{
    EdgeState, FleetInfo, LawState, MeasurementRecord, Placement, PlannedPath, RobotState, SafetyState,
    StepRecord,
};

/// A recorded run. A copy shares everything with the original.
#[derive(Debug, Clone)]
pub struct Log(Arc<Inside>);

#[derive(Debug)]
struct Inside {
    file: File,
    path: PathBuf,
    manifest: Manifest,
    scene: String,
    fleet: FleetInfo,
    channels: HashMap<u16, LogChannel>,
    chunks: Vec<Chunk>,
    whole: bool,
    /// What another program did with the file, if one did.
    remark: Option<String>,
    /// Time of the first moment, s.
    begins: f64,
}

/// What a channel's messages are.
#[derive(Debug, Clone, Copy)]
pub(super) enum LogChannel {
    Robot(usize),
    Edge(usize),
    Prop(usize),
    Measurement(usize),
    Safety(usize),
    Law(usize),
    Event,
    Plan,
    Contact,
    Sample,
    FleetInfo,
}

impl Log {
    /// Opens the log at `path`.
    ///
    /// # Errors
    /// [`Error::Log`] where the file is no log of this program's layout, or was cut off before its first chunk ended;
    /// [`Error::Output`] where it cannot be read.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let mut file = File::open(path).map_err(Error::io("open", path))?;
        let outline = ChunkOutline::of(&mut file, path)?;
        if outline.foreign {
            let Imported { mut file, begins, remark } = import(&file, path)?;
            let outline = ChunkOutline::of(&mut file, path)?;
            return Self::of_ours(file, path, outline, begins, Some(remark));
        }
        Self::of_ours(file, path, outline, 0.0, None)
    }

    /// Opens a file that is laid as ours are.
    fn of_ours(
        file: File,
        path: &Path,
        outline: ChunkOutline,
        begins: f64,
        remark: Option<String>,
    ) -> Result<Self, Error> {
        let wrong = |message: &str| Error::log(path, message);
        let Some(format) = outline.around.format else {
            return Err(wrong(
                "is an MCAP file, but no log of Echelon, or was cut off at its very beginning",
            ));
        };
        if format != FORMAT.to_string() {
            let message = other_layout(&format);
            return Err(wrong(&message));
        }
        let Some((manifest, scene)) = outline.around.manifest.zip(outline.around.scene) else {
            return Err(wrong("was cut off before the run began: its scene or its manifest is missing"));
        };
        let mut manifest: Manifest = serde_json::from_str(&manifest)
            .map_err(|error| wrong(&format!("holds a manifest that cannot be read: {error}")))?;
        let Some(first) = outline.chunks.first() else {
            return Err(wrong("was cut off before the run began: it names no robots"));
        };
        let (channels, fleet) = channels_and_fleet(&unpack(&file, path, *first)?);
        let fleet = fleet.filter(sound).ok_or_else(|| wrong("holds a fleet that cannot be read"))?;
        if manifest.status == Status::Running {
            let mut chunks = outline.chunks.iter().rev();
            manifest.samples = chunks.find_map(|chunk| samples(&file, path, *chunk, &channels)).unwrap_or(0);
        }
        let (chunks, whole, path) = (outline.chunks, outline.whole, path.to_owned());
        let inside = Inside { file, path, manifest, scene, fleet, channels, chunks, whole, remark, begins };
        Ok(Self(Arc::new(inside)))
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.0.path
    }

    /// What ran and how it ended; of a run that was cut off, `running`, with the samples that can be read.
    pub fn manifest(&self) -> &Manifest {
        &self.0.manifest
    }

    /// The resolved scene, as text; empty where another program left it out.
    pub fn scene(&self) -> &str {
        &self.0.scene
    }

    /// Where another program wrote the file anew: what it did, and what it left out.
    pub fn remark(&self) -> Option<&str> {
        self.0.remark.as_deref()
    }

    /// Time of the first moment, s: 0 unless another program left out the beginning.
    pub fn begins(&self) -> f64 {
        self.0.begins
    }

    /// Robots, edges, props, ground.
    pub fn fleet(&self) -> &FleetInfo {
        &self.0.fleet
    }

    /// Whether the file came to its end; else it was cut off, or is still being written.
    pub fn whole(&self) -> bool {
        self.0.whole
    }

    /// All moments in the order of time.
    pub fn records(&self) -> Moments {
        self.after_chunks(0)
    }

    /// The moments at and after `time` s: what lies before is skipped, not read.
    pub fn records_from(&self, time: f64) -> Moments {
        Moments { from: time, ..self.after_chunks(self.chunk_before(time)) }
    }

    /// The last moment at or before `time` s; the first one if there is none before.
    ///
    /// # Errors
    /// [`Error::Log`] where the file is damaged there.
    pub fn at(&self, time: f64) -> Result<Option<StepRecord>, Error> {
        let mut last = None;
        for record in self.after_chunks(self.chunk_before(time)) {
            let record = record?;
            if record.snapshot.time > time && last.is_some() {
                break;
            }
            last = Some(record);
        }
        Ok(last)
    }

    /// Number of the chunk from which on the moments around `time` s stand.
    fn chunk_before(&self, time: f64) -> usize {
        // The first chunk holds no moments; a stamp is rounded, so the chunk before may end with the one asked for.
        let begun = |chunk: &Chunk| chunk.begin as f64 * 1e-9 <= time + 1e-9;
        self.0.chunks.partition_point(begun).saturating_sub(2)
    }

    fn after_chunks(&self, next: usize) -> Moments {
        Moments { log: self.clone(), next, ready: VecDeque::new(), from: f64::NEG_INFINITY, fault: None }
    }
}

/// The channels and the fleet in the first chunk, unpacked.
fn channels_and_fleet(bytes: &[u8]) -> (HashMap<u16, LogChannel>, Option<FleetInfo>) {
    let (mut channels, mut schemas, mut fleet) = (HashMap::new(), HashMap::new(), None);
    for item in records(bytes) {
        match item {
            Chunked::Schema { header, .. } => {
                schemas.insert(header.id, header.name);
            }
            Chunked::Channel(channel) => {
                let index = channel.metadata.get("index").and_then(|text| text.parse().ok());
                let kind = schemas.get(&channel.schema_id).zip(index).and_then(|(n, k)| LogChannel::of(n, k));
                channels.extend(kind.map(|kind| (channel.id, kind)));
            }
            Chunked::Message { header, data }
                if matches!(channels.get(&header.channel_id), Some(LogChannel::FleetInfo)) =>
            {
                fleet = record::read::<FleetInfo>(&data);
            }
            _ => {}
        }
    }
    (channels, fleet)
}

/// Samples up to the end of a chunk; `None` where it cannot be read or holds none.
fn samples(file: &File, path: &Path, chunk: Chunk, channels: &HashMap<u16, LogChannel>) -> Option<u64> {
    let bytes = unpack(file, path, chunk).ok()?;
    let number = |item: Chunked<'_>| match item {
        Chunked::Message { header, data } => match channels.get(&header.channel_id)? {
            LogChannel::Sample => record::read::<SampleNumber>(&data).map(|sample| sample.number),
            _ => None,
        },
        _ => None,
    };
    records(&bytes).filter_map(number).last().map(|last| last + 1)
}

/// The records of a chunk, unpacked and checked.
fn unpack(file: &File, path: &Path, chunk: Chunk) -> Result<Vec<u8>, Error> {
    let damaged = |why: &dyn std::fmt::Display| {
        Error::log(path, format!("is damaged {:.2} s into the run: {why}", chunk.begin as f64 * 1e-9))
    };
    let body = body(&mut &*file, chunk.start, chunk.length).map_err(Error::io("read", path))?;
    let record = parse(op::CHUNK, &body).map_err(|error| damaged(&error))?;
    let Chunked::Chunk { header, data } = record else { return Ok(vec![]) };
    let mut bytes = Vec::new();
    // One byte more than is promised is enough to see that the promise is broken.
    let most = header.uncompressed_size.min(LONGEST) + 1;
    let unpacked = match &*header.compression {
        "" => (&*data).take(most).read_to_end(&mut bytes),
        "lz4" => lz4::Decoder::new(&*data).and_then(|lz4| lz4.take(most).read_to_end(&mut bytes)),
        other => return Err(damaged(&format!("it is compressed by {other}, which no log of ours is"))),
    };
    unpacked.map_err(|error| damaged(&error))?;
    let whole = bytes.len() as u64 == header.uncompressed_size;
    if !whole || (header.uncompressed_crc != 0 && crc32fast::hash(&bytes) != header.uncompressed_crc) {
        return Err(damaged(&"its checksum does not fit"));
    }
    Ok(bytes)
}

/// The records of an unpacked chunk.
fn records(mut bytes: &[u8]) -> impl Iterator<Item = Chunked<'_>> {
    std::iter::from_fn(move || {
        let (head, rest) = bytes.split_at_checked(9)?;
        let (code, length) = head.split_first()?;
        let length = usize::try_from(u64::from_le_bytes(length.try_into().ok()?)).ok()?;
        let (body, rest) = rest.split_at_checked(length)?;
        bytes = rest;
        parse(*code, body).ok()
    })
}

impl LogChannel {
    pub(super) fn of(schema: &str, index: usize) -> Option<Self> {
        match schema.strip_prefix(record::PACKAGE)?.strip_prefix('.')? {
            RobotState::NAME => Some(Self::Robot(index)),
            EdgeState::NAME => Some(Self::Edge(index)),
            Placement::NAME => Some(Self::Prop(index)),
            MeasurementRecord::NAME => Some(Self::Measurement(index)),
            SafetyRecord::NAME => Some(Self::Safety(index)),
            LawState::NAME => Some(Self::Law(index)),
            EventMessage::NAME => Some(Self::Event),
            PlannedPath::NAME => Some(Self::Plan),
            ContactRecord::NAME => Some(Self::Contact),
            SampleNumber::NAME => Some(Self::Sample),
            FleetInfo::NAME => Some(Self::FleetInfo),
            _ => None,
        }
    }
}

/// Moments of a log, a chunk in memory at a time. After an error there are no more.
#[derive(Debug)]
pub struct Moments {
    log: Log,
    next: usize,
    ready: VecDeque<StepRecord>,
    from: f64,
    fault: Option<Error>,
}

impl Iterator for Moments {
    type Item = Result<StepRecord, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(record) = self.ready.pop_front() {
                if record.snapshot.time >= self.from {
                    return Some(Ok(record));
                }
                continue;
            }
            if let Some(fault) = self.fault.take() {
                self.next = usize::MAX;
                return Some(Err(fault));
            }
            let chunk = self.log.0.chunks.get(self.next)?;
            self.next += 1;
            // What came whole before the damage is still told.
            self.fault = self.unpack(*chunk).err();
        }
    }
}

impl Moments {
    fn unpack(&mut self, chunk: Chunk) -> Result<(), Error> {
        let mut record = StepRecord::default();
        let mut props: Vec<Placement> = vec![];
        let bytes = unpack(&self.log.0.file, &self.log.0.path, chunk)?;
        for item in records(&bytes) {
            let Chunked::Message { header, data } = item else { continue };
            let Some(channel) = self.log.0.channels.get(&header.channel_id) else { continue };
            let closed =
                take(*channel, &data, &mut record, &mut props).ok_or_else(|| self.damaged(&header))?;
            if closed {
                record.snapshot.props.clone_from(&props);
                self.ready.push_back(std::mem::take(&mut record));
            }
        }
        Ok(())
    }

    fn damaged(&self, header: &MessageHeader) -> Error {
        let time = header.log_time as f64 * 1e-9;
        Error::log(&self.log.0.path, format!("is damaged at {time:.3} s: a message makes no sense"))
    }
}

/// What the filter of a robot did.
pub(super) fn safety_of(robot: usize, data: &[u8]) -> Option<SafetyState> {
    Some(SafetyState { robot, ..record::read::<SafetyRecord>(data)?.state })
}

/// Takes a message into `record`; whether that closes it. `None` where the message makes no sense there.
fn take(
    channel: LogChannel,
    data: &[u8],
    record: &mut StepRecord,
    props: &mut Vec<Placement>,
) -> Option<bool> {
    match channel {
        LogChannel::Robot(index) => {
            let robots = &mut record.snapshot.robots;
            (robots.len() == index).then_some(())?;
            robots.push(record::read(data)?);
        }
        LogChannel::Edge(index) => {
            (record.edges.len() == index).then_some(())?;
            record.edges.push(record::read(data)?);
        }
        LogChannel::Prop(index) => {
            let place = record::read(data)?;
            if index == props.len() { props.push(place) } else { *props.get_mut(index)? = place }
        }
        LogChannel::Measurement(index) => {
            record.frames.push(MeasurementRecord { edge: index, ..record::read(data)? });
        }
        LogChannel::Safety(index) => record.safety.push(safety_of(index, data)?),
        LogChannel::Law(robot) => record.laws.push(LawState { robot, ..record::read(data)? }),
        LogChannel::Event => record.events.push(record::read::<EventMessage>(data)?.event),
        LogChannel::Plan => record.plans.push(Arc::new(record::read(data)?)),
        LogChannel::Contact => record.contacts.push(record::read::<ContactRecord>(data)?.contact),
        LogChannel::Sample => {
            let sample: SampleNumber = record::read(data)?;
            record.snapshot.time = sample.time;
            let (robots, edges) = (record.snapshot.robots.len(), record.edges.len());
            let (contacts, frames) = (record.contacts.len(), record.frames.len());
            let found =
                [robots, edges, props.len(), contacts, frames, record.safety.len(), record.events.len()];
            let more = [record.laws.len(), record.plans.len()];
            (sample.counts == found && [sample.laws, sample.plans] == more).then_some(())?;
            record.leaders = sample.leaders;
            return Some(true);
        }
        LogChannel::FleetInfo => {}
    }
    Some(false)
}
