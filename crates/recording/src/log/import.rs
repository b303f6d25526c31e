//! A log that another program wrote anew: sorted, filtered, compressed otherwise, its chunks laid anew.
//!
//! Our own reader relies on how our own writer lays a file. What others write is put together again, sample by sample,
//! into a log of ours in a file without a name, and read from there: a moment that comes back is the moment that was
//! recorded, bit for bit, or is not there.

use super::events::EventMessage;
use super::fleet::sound;
use super::messages::{ContactRecord, SampleNumber};
use super::outline::{Around, LONGEST, parse};
use super::read::{LogChannel, safety_of};
use super::record;
use super::writer::Writer;
use super::{FORMAT, Topics, other_layout};
use crate::{Error, Manifest, Status};
use mcap::records::{Header, MessageHeader, Record as Item};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;
use std::sync::Arc;
use vocabulary::{
    Contact, EdgeState, EventRecord, FleetInfo, LawState, MeasurementRecord, Placement, PlannedPath,
    RobotState, SafetyState, StepRecord, counted,
};

/// A log of ours, and what the foreign one has and lacks.
pub(super) struct Imported {
    pub(super) file: File,
    /// Time of its first moment, s.
    pub(super) begins: f64,
    pub(super) remark: String,
}

/// What a log of another program holds besides its moments.
#[derive(Default)]
struct ForeignLog {
    writer: String,
    around: Around,
    fleet: Option<FleetInfo>,
    channels: HashMap<u16, LogChannel>,
    /// Samples, and the times of the first two, s.
    samples: u64,
    times: [f64; 2],
    /// Whether messages come in the order of time.
    in_order: bool,
}

/// Moments that are written at once.
const BATCH: usize = 64;

/// Puts the log in `file` together again; errors speak of `path`.
pub(super) fn import(file: &File, path: &Path) -> Result<Imported, Error> {
    let wrong = |message: String| Error::log(path, message);
    let about = ForeignLog::of(file, path)?;
    if let Some(format) = about.around.format.as_ref().filter(|format| **format != FORMAT.to_string()) {
        return Err(wrong(other_layout(format)));
    }
    let fleet = about.fleet.clone().filter(sound).ok_or_else(|| {
        wrong(format!("is an MCAP file, but no log of Echelon: it has no topic {}", Topics::FLEET))
    })?;
    let mut manifest = match &about.around.manifest {
        Some(text) => serde_json::from_str(text)
            .map_err(|error| wrong(format!("holds a manifest that cannot be read: {error}")))?,
        None => Manifest {
            period: about.times[1] - about.times[0],
            status: Status::Interrupted,
            samples: about.samples,
            ..Manifest::of(&fleet)
        },
    };
    let scene = about.around.scene.clone().unwrap_or_default();
    let ours = output::scratch()?;
    let copy = ours.try_clone().map_err(Error::io("write", path))?;
    let mut writer = Writer::create(ours, path, &fleet, &scene, &manifest, false)?;
    let (mut pending, mut batch, mut count) = (Pending::default(), vec![], 0);
    let mut span = [0.0; 2];
    let mut take = |pending: &mut Pending, until: u64| -> Result<bool, Error> {
        while let Some(record) = pending.pop(until, &fleet) {
            let Ok(record) = record else { return Ok(false) };
            let time = record.snapshot.time;
            span = if count == 0 { [time; 2] } else { [span[0], time] };
            batch.push(record);
            count += 1;
            if batch.len() == BATCH {
                writer.push(&mut batch, &[])?;
                batch.clear();
            }
        }
        Ok(true)
    };
    let mut sound = true;
    read(file, path, |item| {
        if let Item::Message { header, data } = item
            && let Some(channel) = about.channels.get(&header.channel_id)
        {
            let fits = pending.add(*channel, &header, &data);
            sound = sound && fits && (!about.in_order || take(&mut pending, header.log_time)?);
        }
        Ok(sound)
    })?;
    sound = sound && take(&mut pending, u64::MAX)?;
    if !batch.is_empty() {
        writer.push(&mut batch, &[])?;
    }
    // Of a part, nobody knows the digest of the whole.
    let cut = manifest.digest.is_some() && count < manifest.samples;
    let whole = (manifest.samples.saturating_sub(1)) as f64 * manifest.period;
    if cut {
        (manifest.digest, manifest.status) = (None, Status::Interrupted);
    }
    if manifest.digest.is_none() {
        manifest.samples = (span[1] / manifest.period).round() as u64 + 1;
    }
    let part = if cut {
        format!("; of {whole:.2} s it holds {:.2} to {:.2} s", span[0], span[1])
    } else {
        String::new()
    };
    let remark = about.remark(count, sound) + &part;
    writer.finish(&manifest)?;
    Ok(Imported { file: copy, begins: span[0], remark })
}

impl ForeignLog {
    fn of(file: &File, path: &Path) -> Result<Self, Error> {
        let mut about = Self { in_order: true, ..Self::default() };
        let (mut schemas, mut topics) = (HashMap::new(), vec![]);
        let mut last = 0;
        read(file, path, |item| {
            match item {
                Item::Header(Header { library, .. }) => about.writer = library,
                item @ (Item::Metadata(_) | Item::Attachment { .. }) => about.around.note(item),
                Item::Schema { header, .. } => {
                    schemas.insert(header.id, header.name);
                }
                Item::Channel(channel) => {
                    let Some(schema) = schemas.get(&channel.schema_id) else { return Ok(true) };
                    let index = channel.metadata.get("index").and_then(|text| text.parse().ok());
                    if let Some(kind) = LogChannel::of(schema, index.unwrap_or(0)) {
                        about.channels.insert(channel.id, kind);
                    }
                    if index.is_none() {
                        topics.push((channel.id, schema.clone(), channel.topic));
                    }
                }
                Item::Message { header, data } => {
                    let Some(kind) = about.channels.get(&header.channel_id) else { return Ok(true) };
                    match kind {
                        LogChannel::FleetInfo => {
                            about.fleet = record::read::<FleetInfo>(&data);
                        }
                        LogChannel::Sample => {
                            if let Some(time) = about.times.get_mut(about.samples as usize) {
                                *time = header.log_time as f64 * 1e-9;
                            }
                            about.samples += 1;
                        }
                        _ => {}
                    }
                    about.in_order &= header.log_time >= last;
                    last = header.log_time;
                }
                _ => {}
            }
            Ok(true)
        })?;
        about.find(&topics);
        Ok(about)
    }

    /// Whose a channel is by its topic, where what was written about it was left out.
    fn find(&mut self, topics: &[(u16, String, String)]) {
        let Some(fleet) = &self.fleet else { return };
        let place = |kind: LogChannel, topic: &str| match kind {
            LogChannel::Robot(_) => fleet.robots.iter().position(|member| Topics::robot(member) == topic),
            LogChannel::Edge(_) => fleet.edges.iter().position(|edge| Topics::edge(fleet, *edge) == topic),
            LogChannel::Measurement(_) => {
                fleet.edges.iter().position(|edge| Topics::measurements(fleet, *edge) == topic)
            }
            LogChannel::Law(_) => fleet.robots.iter().position(|member| Topics::law(member) == topic),
            LogChannel::Safety(_) => fleet.robots.iter().position(|member| Topics::safety(member) == topic),
            LogChannel::Prop(_) => fleet.props.iter().position(|prop| Topics::prop(prop) == topic),
            _ => Some(0),
        };
        for (id, schema, topic) in topics {
            let kind = LogChannel::of(schema, 0);
            match kind.and_then(|kind| place(kind, topic)).and_then(|index| LogChannel::of(schema, index)) {
                Some(kind) => self.channels.insert(*id, kind),
                None => self.channels.remove(id),
            };
        }
    }

    /// What was done with the log, and what it lacks.
    fn remark(&self, count: u64, sound: bool) -> String {
        let anew = format!("was written anew by {}", self.writer);
        let lacks = [
            (self.around.scene.is_none(), "its scene"),
            (self.around.manifest.is_none(), "its manifest with the digest"),
        ];
        let lacks: Vec<&str> = lacks.iter().filter(|(lacks, _)| *lacks).map(|(_, what)| *what).collect();
        let lacks = match lacks.join(" and ") {
            nothing if nothing.is_empty() => nothing,
            lacks => format!(", which left out {lacks}"),
        };
        let all = self.samples;
        let broken = if sound && count == all {
            String::new()
        } else {
            format!(
                "; of its {} the first {count} are whole, the others lack topics or messages",
                counted(all, "sample")
            )
        };
        format!("{anew}{lacks}{broken}")
    }
}

/// What has come of moments that are not complete.
#[derive(Default)]
struct Pending {
    /// By time, ns.
    records: BTreeMap<u64, Parts>,
    /// Where props are that have not moved since.
    props: BTreeMap<usize, Placement>,
}

/// Of one moment.
#[derive(Default)]
struct Parts {
    robots: BTreeMap<usize, RobotState>,
    edges: BTreeMap<usize, EdgeState>,
    props: BTreeMap<usize, Placement>,
    frames: Vec<MeasurementRecord>,
    contacts: Vec<Contact>,
    safety: BTreeMap<usize, SafetyState>,
    laws: BTreeMap<usize, LawState>,
    events: Vec<EventRecord>,
    plans: Vec<Arc<PlannedPath>>,
    sample: Option<SampleNumber>,
}

/// A moment lacks something.
struct NotWhole;

impl Pending {
    /// Takes a message in; whether it makes sense.
    fn add(&mut self, channel: LogChannel, header: &MessageHeader, data: &[u8]) -> bool {
        if matches!(channel, LogChannel::FleetInfo) {
            return true;
        }
        let parts = self.records.entry(header.log_time).or_default();
        let mut put = || -> Option<()> {
            match channel {
                LogChannel::Robot(index) => drop(parts.robots.insert(index, record::read(data)?)),
                LogChannel::Edge(index) => drop(parts.edges.insert(index, record::read(data)?)),
                LogChannel::Prop(index) => drop(parts.props.insert(index, record::read(data)?)),
                LogChannel::Measurement(index) => {
                    parts.frames.push(MeasurementRecord { edge: index, ..record::read(data)? });
                }
                LogChannel::Safety(index) => drop(parts.safety.insert(index, safety_of(index, data)?)),
                LogChannel::Law(robot) => {
                    drop(parts.laws.insert(robot, LawState { robot, ..record::read(data)? }));
                }
                LogChannel::Event => parts.events.push(record::read::<EventMessage>(data)?.event),
                LogChannel::Plan => parts.plans.push(Arc::new(record::read(data)?)),
                LogChannel::Contact => {
                    parts.contacts.push(record::read::<ContactRecord>(data)?.contact);
                }
                LogChannel::Sample => parts.sample = Some(record::read(data)?),
                LogChannel::FleetInfo => {}
            }
            Some(())
        };
        put().is_some()
    }

    /// The first moment before `until` ns, to which nothing more can come, if it is whole; `None` where there is none.
    fn pop(&mut self, until: u64, fleet: &FleetInfo) -> Option<Result<StepRecord, NotWhole>> {
        let first = self.records.first_entry().filter(|entry| *entry.key() < until)?;
        Some(first.remove().whole(&mut self.props, fleet).ok_or(NotWhole))
    }
}

impl Parts {
    /// The moment, if all of it is there.
    fn whole(self, placed: &mut BTreeMap<usize, Placement>, fleet: &FleetInfo) -> Option<StepRecord> {
        let sample = self.sample?;
        placed.extend(self.props);
        let (robots, edges) = (self.robots.len(), self.edges.len());
        let (contacts, frames) = (self.contacts.len(), self.frames.len());
        let found = [robots, edges, placed.len(), contacts, frames, self.safety.len(), self.events.len()];
        let more = [self.laws.len(), self.plans.len()];
        (sample.counts == found && [sample.laws, sample.plans] == more).then_some(())?;
        let inside = |last: Option<&usize>, count: usize| last.is_none_or(|last| *last < count);
        let fits = inside(self.robots.keys().next_back(), fleet.robots.len())
            && inside(self.edges.keys().next_back(), fleet.edges.len())
            && inside(self.safety.keys().next_back(), fleet.robots.len())
            && inside(self.laws.keys().next_back(), fleet.robots.len())
            && inside(placed.keys().next_back(), fleet.props.len())
            && self.frames.iter().all(|frame| frame.edge < fleet.edges.len());
        let mut record = StepRecord { contacts: self.contacts, frames: self.frames, ..StepRecord::default() };
        record.snapshot.time = sample.time;
        record.snapshot.robots = self.robots.into_values().collect();
        record.snapshot.props = placed.values().copied().collect();
        record.edges = self.edges.into_values().collect();
        record.safety = self.safety.into_values().collect();
        record.laws = self.laws.into_values().collect();
        (record.leaders, record.events) = (sample.leaders, self.events);
        record.plans = self.plans;
        fits.then_some(record)
    }
}

/// Shows `take` every record, those in chunks too, until it has seen enough. What was cut off ends there.
fn read(
    mut file: &File,
    path: &Path,
    mut take: impl FnMut(Item<'_>) -> Result<bool, Error>,
) -> Result<(), Error> {
    let damaged = |error: mcap::McapError| Error::log(path, format!("is damaged: {error}"));
    file.rewind().map_err(Error::io("read", path))?;
    let mut file = BufReader::with_capacity(1 << 16, file);
    let options = LinearReaderOptions::default().with_record_length_limit(LONGEST as usize);
    let mut reader = LinearReader::new_with_options(options);
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(count)) => {
                let room = reader.insert(count.min(1 << 20));
                let read = file.read(room).map_err(Error::io("read", path))?;
                reader.notify_read(read);
            }
            Ok(LinearReadEvent::Record { data, opcode }) => {
                let item = parse(opcode, data).map_err(damaged)?;
                if !take(item)? {
                    return Ok(());
                }
            }
            Err(mcap::McapError::UnexpectedEof | mcap::McapError::UnexpectedEoc) => return Ok(()),
            Err(error) => return Err(damaged(error)),
        }
    }
    Ok(())
}
