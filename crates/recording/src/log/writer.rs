//! Writes the file: what is known before the run, a chunk after every batch of moments, what is known after it.

use super::drawing::Drawing;
use super::events::EventMessage;
use super::messages::{ContactRecord, SampleNumber};
use super::pictures::Photo;
use super::record::{self, Record};
use super::safety::SafetyRecord;
use super::{FORMAT, OURS, Topics, ros};
use crate::{Error, Manifest};
use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, Compression, WriteOptions};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use vocabulary::{
    EdgeState, FleetInfo, LawState, MeasurementRecord, Placement, PlannedPath, RobotState, StepRecord,
};

/// Where a message goes: its channel, which sample it belongs to and when that was.
#[derive(Clone, Copy, Default)]
pub(super) struct Stamp {
    pub(super) number: u64,
    pub(super) time: f64,
}

impl Stamp {
    /// Nanoseconds since the start of the run.
    pub(super) fn nanoseconds(self) -> u64 {
        (self.time * 1e9).round() as u64
    }
}

/// An open file, and the channels that were added to it.
pub(super) struct Channels {
    file: mcap::Writer<BufWriter<File>>,
    path: PathBuf,
    buffer: Vec<u8>,
}

impl Channels {
    fn fault(&self) -> impl FnOnce(mcap::McapError) -> Error + use<> {
        let path = self.path.clone();
        move |error| match error {
            mcap::McapError::Io(source) => Error::io("write", &path)(source),
            other => Error::table(&path)(other),
        }
    }

    /// A channel for messages of the schema with this name and descriptor.
    pub(super) fn add(&mut self, topic: &str, name: &str, schema: &[u8], index: usize) -> Result<u16, Error> {
        let about = BTreeMap::from([("index".to_owned(), index.to_string())]);
        let added = self.file.add_schema(name, "protobuf", schema);
        added.and_then(|id| self.file.add_channel(id, topic, "protobuf", &about)).map_err(self.fault())
    }

    fn add_own<T: Record + Default>(&mut self, topic: &str, index: usize) -> Result<u16, Error> {
        let (name, schema) = record::schema::<T>();
        self.add(topic, &name, &schema, index)
    }

    /// Writes the message that `fill` makes.
    pub(super) fn put(
        &mut self,
        channel: u16,
        stamp: Stamp,
        fill: impl FnOnce(&mut Vec<u8>),
    ) -> Result<(), Error> {
        self.buffer.clear();
        fill(&mut self.buffer);
        let time = stamp.nanoseconds();
        let sequence = stamp.number as u32;
        let header = MessageHeader { channel_id: channel, sequence, log_time: time, publish_time: time };
        self.file.write_to_known_channel(&header, &self.buffer).map_err(self.fault())
    }

    fn put_own<T: Record>(&mut self, channel: u16, stamp: Stamp, record: &mut T) -> Result<(), Error> {
        self.put(channel, stamp, |out| record::write(record, out))
    }

    fn attach(&mut self, name: &str, media_type: &str, text: &str) -> Result<(), Error> {
        let attachment = Attachment {
            log_time: 0,
            create_time: 0,
            name: name.to_owned(),
            media_type: media_type.to_owned(),
            data: Cow::Borrowed(text.as_bytes()),
        };
        self.file.attach(&attachment).map_err(self.fault())
    }

    /// Closes the chunk and hands it to the system.
    fn flush(&mut self) -> Result<(), Error> {
        self.file.flush().map_err(self.fault())
    }
}

/// Writes a log.
pub(super) struct Writer {
    to: Channels,
    fleet: FleetInfo,
    drawing: Option<Drawing>,
    robots: Vec<u16>,
    edges: Vec<u16>,
    measurements: Vec<u16>,
    props: Vec<u16>,
    safety: Vec<u16>,
    laws: Vec<u16>,
    events: Option<u16>,
    plans: Option<u16>,
    contacts: u16,
    samples: u16,
    number: u64,
    /// Where props were when they were last written in this chunk.
    placed: Vec<Placement>,
}

impl Writer {
    /// Writes what is known before the run into `file`; errors speak of `path`. Without drawings, where nobody will
    /// look.
    pub(super) fn create(
        file: File,
        path: &Path,
        fleet: &FleetInfo,
        scene: &str,
        manifest: &Manifest,
        drawn: bool,
    ) -> Result<Self, Error> {
        let ours = format!("{OURS}{}", env!("CARGO_PKG_VERSION"));
        let options = WriteOptions::library(WriteOptions::new(), ours)
            .compression(Some(Compression::Lz4))
            // Chunks end between two samples, by `flush`, and reach the file whole.
            .chunk_size(None)
            .disable_seeking(true);
        let file = options.create(BufWriter::with_capacity(1 << 16, file)).map_err(Error::table(path))?;
        let mut to = Channels { file, path: path.to_owned(), buffer: Vec::new() };
        let about = [("format", FORMAT.to_string()), ("program", manifest.program.clone())];
        let metadata = about.map(|(key, value)| (key.to_owned(), value)).into();
        to.file
            .write_metadata(&Metadata { name: super::NAME.to_owned(), metadata })
            .map_err(Error::table(path))?;
        let names = fleet.robots.iter().map(|m| &*m.name).chain(fleet.props.iter().map(|p| &*p.name));
        to.file
            .write_metadata(&Metadata { name: "ros2".to_owned(), metadata: ros::legal(names) })
            .map_err(Error::table(path))?;
        to.attach("scene.toml", "application/toml", scene)?;
        to.attach("manifest.json", "application/json", &text(manifest, path)?)?;
        let cast = to.add_own::<FleetInfo>(Topics::FLEET, 0)?;
        to.put_own(cast, Stamp::default(), &mut fleet.clone())?;
        let mut writer = Self {
            drawing: if drawn { Some(Drawing::begin(fleet, &mut to)?) } else { None },
            robots: vec![],
            edges: vec![],
            measurements: vec![],
            props: vec![],
            safety: vec![],
            laws: vec![],
            events: None,
            plans: None,
            contacts: to.add_own::<ContactRecord>(Topics::CONTACTS, 0)?,
            samples: to.add_own::<SampleNumber>(Topics::SAMPLES, 0)?,
            number: 0,
            placed: vec![],
            fleet: fleet.clone(),
            to,
        };
        writer.add_channels()?;
        writer.to.flush()?;
        Ok(writer)
    }

    fn add_channels(&mut self) -> Result<(), Error> {
        let Self { to, fleet, .. } = self;
        for (index, member) in fleet.robots.iter().enumerate() {
            self.robots.push(to.add_own::<RobotState>(&Topics::robot(member), index)?);
            if fleet.has_safety {
                self.safety.push(to.add_own::<SafetyRecord>(&Topics::safety(member), index)?);
            }
            if fleet.has_laws {
                self.laws.push(to.add_own::<LawState>(&Topics::law(member), index)?);
            }
        }
        if fleet.has_events {
            self.events = Some(to.add_own::<EventMessage>(Topics::EVENTS, 0)?);
        }
        if fleet.has_plans {
            self.plans = Some(to.add_own::<PlannedPath>(Topics::PLANS, 0)?);
        }
        for (index, edge) in fleet.edges.iter().enumerate() {
            self.edges.push(to.add_own::<EdgeState>(&Topics::edge(fleet, *edge), index)?);
            if fleet.has_sensors {
                self.measurements
                    .push(to.add_own::<MeasurementRecord>(&Topics::measurements(fleet, *edge), index)?);
            }
        }
        for (index, prop) in fleet.props.iter().enumerate() {
            self.props.push(to.add_own::<Placement>(&Topics::prop(prop), index)?);
        }
        Ok(())
    }

    /// Writes moments, and what cameras saw on the way, as one chunk.
    pub(super) fn push(&mut self, records: &mut [StepRecord], photos: &[Photo]) -> Result<(), Error> {
        self.placed.clear();
        let mut photos = photos.iter().peekable();
        for record in records {
            while let Some(photo) = photos.next_if(|photo| photo.time <= record.snapshot.time) {
                self.photo(photo)?;
            }
            self.record(record)?;
        }
        photos.try_for_each(|photo| self.photo(photo))?;
        self.to.flush()
    }

    fn photo(&mut self, photo: &Photo) -> Result<(), Error> {
        self.drawing.as_mut().map_or(Ok(()), |drawing| drawing.photo(photo, &mut self.to))
    }

    fn record(&mut self, record: &mut StepRecord) -> Result<(), Error> {
        let stamp = Stamp { number: self.number, time: record.snapshot.time };
        let to = &mut self.to;
        self.drawing.as_mut().map_or(Ok(()), |drawing| drawing.record(stamp, record, to))?;
        for (channel, robot) in self.robots.iter().zip(&mut record.snapshot.robots) {
            to.put_own(*channel, stamp, robot)?;
        }
        for (channel, edge) in self.edges.iter().zip(&mut record.edges) {
            to.put_own(*channel, stamp, edge)?;
        }
        for (index, (channel, prop)) in self.props.iter().zip(&mut record.snapshot.props).enumerate() {
            match self.placed.get_mut(index) {
                Some(placed) if same(placed, prop) => continue,
                Some(placed) => *placed = *prop,
                None => self.placed.push(*prop),
            }
            to.put_own(*channel, stamp, prop)?;
        }
        for contact in &record.contacts {
            let names = contact.things.map(|thing| self.fleet.name(thing).to_owned());
            to.put_own(self.contacts, stamp, &mut ContactRecord { contact: *contact, names })?;
        }
        for frame in &mut record.frames {
            if let Some(channel) = self.measurements.get(frame.edge) {
                to.put_own(*channel, stamp, frame)?;
            }
        }
        let mut filters = 0;
        for state in &record.safety {
            if let Some(channel) = self.safety.get(state.robot) {
                to.put_own(*channel, stamp, &mut SafetyRecord::new(state, &self.fleet))?;
                filters += 1;
            }
        }
        let mut laws = 0;
        for state in &mut record.laws {
            if let Some(channel) = self.laws.get(state.robot) {
                to.put_own(*channel, stamp, state)?;
                laws += 1;
            }
        }
        let mut happened = 0;
        if let Some(channel) = self.events {
            for event in &record.events {
                to.put_own(channel, stamp, &mut EventMessage::new(event, &self.fleet))?;
                happened += 1;
            }
        }
        let mut planned = 0;
        if let Some(channel) = self.plans {
            for plan in &record.plans {
                to.put_own(channel, stamp, &mut PlannedPath::clone(plan))?;
                planned += 1;
            }
        }
        let StepRecord { snapshot, edges, contacts, frames, leaders, .. } = record;
        let (robots, props) = (snapshot.robots.len(), snapshot.props.len());
        let counts = [robots, edges.len(), props, contacts.len(), frames.len(), filters, happened];
        let mut sample = SampleNumber {
            number: self.number,
            time: snapshot.time,
            counts,
            laws,
            plans: planned,
            leaders: leaders.clone(),
        };
        self.number += 1;
        to.put_own(self.samples, stamp, &mut sample)
    }

    /// Writes what is known after the run, and the indexes.
    pub(super) fn finish(mut self, manifest: &Manifest) -> Result<(), Error> {
        let text = text(manifest, &self.to.path)?;
        self.to.attach("manifest.json", "application/json", &text)?;
        self.to.file.finish().map_err(self.to.fault())?;
        let path = self.to.path.clone();
        let mut file = self.to.file.into_inner();
        std::io::Write::flush(&mut file).map_err(Error::io("write", &path))
    }
}

fn same(a: &Placement, b: &Placement) -> bool {
    let bits = |p: &Placement| (p.position.map(f64::to_bits), p.rotation.map(f64::to_bits));
    bits(a) == bits(b)
}

fn text(manifest: &Manifest, path: &Path) -> Result<String, Error> {
    serde_json::to_string_pretty(manifest).map_err(Error::table(path))
}
