//! Tidy tables: one row per robot or edge and sample, in Parquet and, on request, CSV.
//!
//! A Parquet file is readable only once it is closed, so rows go into small parts, each closed as soon as it is
//! full, and the parts become one file when the run ends.

use crate::{Error, columns};
use arrow_array::{ArrayRef, BooleanArray, Float64Array, RecordBatch, StringArray};
use arrow_schema::{DataType, Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::properties::WriterProperties;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use vocabulary::{FleetInfo, Mobility, StepRecord};

/// The tables of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableKind {
    /// Poses and speeds of every robot.
    Robots,
    /// Set point, error, command and estimate of every edge.
    Edges,
    /// Contacts, each once, when it has ended.
    Contacts,
    /// Where the props are that can move.
    Props,
    /// Measurements of followers, when they arrive.
    Measurements,
}

/// Values of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum Column {
    /// Names.
    Text(Vec<String>),
    /// SI numbers.
    Number(Vec<f64>),
    /// Yes or no.
    Flag(Vec<bool>),
}

/// Samples a part holds: at 10 ms, half a run of the paper.
const SAMPLES_PER_PART: usize = 750;
/// Rows of a Parquet file that are in memory at once while it is written.
const ROWS_PER_GROUP: usize = 1 << 17;

impl TableKind {
    /// Stem of the file's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Robots => "robots",
            Self::Edges => "edges",
            Self::Contacts => "contacts",
            Self::Props => "props",
            Self::Measurements => "measurements",
        }
    }

    /// Names of the columns, with units.
    pub fn columns(self) -> &'static [&'static str] {
        columns::of(self)
    }

    /// The tables that a run of `fleet` has.
    pub fn of(fleet: &FleetInfo) -> Vec<Self> {
        let moving = fleet.props.iter().any(|prop| prop.mobility != Mobility::Fixed);
        let all = [Self::Robots, Self::Edges, Self::Contacts, Self::Props, Self::Measurements];
        let has = |kind: &Self| match kind {
            Self::Props => moving,
            Self::Measurements => fleet.has_sensors,
            _ => true,
        };
        all.into_iter().filter(has).collect()
    }

    fn empty_columns(self) -> Vec<Column> {
        let kind = |name: &&str| match *name {
            "robot" | "leader" | "follower" | "condition" | "first" | "second" | "prop" | "sight"
            | "outcome" => Column::Text(vec![]),
            "limited" | "too_close" => Column::Flag(vec![]),
            _ => Column::Number(vec![]),
        };
        self.columns().iter().map(kind).collect()
    }

    /// One row per robot or edge of `record`, passed on as text, numbers and flags in the order of the columns.
    fn rows(self, fleet: &FleetInfo, record: &StepRecord, mut put: impl FnMut(&[&str], &[f64], &[bool])) {
        let time = record.snapshot.time;
        match self {
            Self::Robots => {
                for (member, robot) in fleet.robots.iter().zip(&record.snapshot.robots) {
                    let m = &robot.motion;
                    let (a, [left, right, ..]) = (&robot.attitude, &robot.wheels);
                    let numbers = [
                        time,
                        m.pose.x,
                        m.pose.y,
                        m.pose.heading,
                        m.speed,
                        m.acceleration,
                        m.turn_rate,
                        a.height,
                        a.roll,
                        a.pitch,
                        f64::midpoint(left.steering, right.steering),
                    ];
                    put(&[&member.name, robot.condition.name()], &numbers, &[]);
                }
            }
            Self::Edges => {
                for (edge, state) in fleet.edges.iter().zip(&record.edges) {
                    let [leader, follower] =
                        [&*fleet.robots[edge.leader].name, &*fleet.robots[edge.follower].name];
                    let (r, s) = (&state.relative, state);
                    let numbers = [
                        time,
                        r.distance,
                        r.bearing,
                        r.view_angle,
                        s.set_point[0],
                        s.set_point[1],
                        s.error[0],
                        s.error[1],
                        s.asked.acceleration,
                        s.asked.turn_rate,
                        s.applied.acceleration,
                        s.applied.turn_rate,
                        s.rates[0],
                        s.rates[1],
                        s.seen.distance,
                        s.seen.bearing,
                        s.seen.view_angle,
                        s.age,
                    ];
                    put(&[leader, follower, s.sight.name()], &numbers, &[s.limited, s.too_close]);
                }
            }
            Self::Contacts => {
                for contact in record.contacts.iter().filter(|contact| !contact.open) {
                    let names = contact.things.map(|thing| fleet.name(thing));
                    let ([x, y, z], [nx, ny, nz]) = (contact.place, contact.normal);
                    put(&names, &[contact.begin, contact.end, x, y, z, nx, ny, nz, contact.impulse], &[]);
                }
            }
            Self::Props => {
                for (prop, placement) in fleet.props.iter().zip(&record.snapshot.props) {
                    if prop.mobility != Mobility::Fixed {
                        let ([x, y, z], [qx, qy, qz, qw]) = (placement.position, placement.rotation);
                        put(&[&prop.name], &[time, x, y, z, qx, qy, qz, qw], &[]);
                    }
                }
            }
            Self::Measurements => {
                for frame in &record.frames {
                    let Some(edge) = fleet.edges.get(frame.edge) else { continue };
                    let [leader, follower] = [edge.leader, edge.follower].map(|k| &*fleet.robots[k].name);
                    let (measurement, truth, region) = (&frame.measurement, &frame.truth, &frame.region);
                    let [x, y, width, height] =
                        [region.x, region.y, region.width, region.height].map(f64::from);
                    let r = measurement.relative;
                    let numbers = [
                        measurement.stamp,
                        frame.arrival,
                        frame.faces() as f64,
                        r.distance,
                        r.bearing,
                        r.view_angle,
                        truth.distance,
                        truth.bearing,
                        truth.view_angle,
                        measurement.deviation[0],
                        measurement.deviation[1],
                        measurement.deviation[2],
                        frame.pan,
                        x,
                        y,
                        width,
                        height,
                    ];
                    put(&[leader, follower, frame.outcome.name()], &numbers, &[]);
                }
            }
        }
    }
}

/// Writes one table.
pub(crate) struct TableWriter {
    kind: TableKind,
    folder: PathBuf,
    columns: Vec<Column>,
    samples: usize,
    parts: usize,
    csv: Option<csv::Writer<File>>,
}

impl TableWriter {
    pub(crate) fn create(folder: &Path, kind: TableKind, csv: bool) -> Result<Self, Error> {
        let mut writer = Self {
            kind,
            folder: folder.to_owned(),
            columns: kind.empty_columns(),
            samples: 0,
            parts: 0,
            csv: None,
        };
        fs::create_dir_all(writer.parts_folder()).map_err(Error::io("create", &writer.parts_folder()))?;
        if csv {
            let path = writer.path("csv");
            let mut file = csv::Writer::from_path(&path).map_err(Error::table(&path))?;
            file.write_record(kind.columns()).map_err(Error::table(&path))?;
            writer.csv = Some(file);
        }
        Ok(writer)
    }

    fn path(&self, extension: &str) -> PathBuf {
        self.folder.join(self.kind.name()).with_extension(extension)
    }

    fn parts_folder(&self) -> PathBuf {
        self.path("parts")
    }

    fn part(&self, index: usize) -> PathBuf {
        self.parts_folder().join(format!("{index:06}.parquet"))
    }

    pub(crate) fn push(&mut self, fleet: &FleetInfo, record: &StepRecord) -> Result<(), Error> {
        let columns = &mut self.columns;
        self.kind.rows(fleet, record, |texts, numbers, flags| {
            let (mut texts, mut numbers, mut flags) = (texts.iter(), numbers.iter(), flags.iter());
            for column in columns.iter_mut() {
                match column {
                    Column::Text(values) => values.extend(texts.next().map(|t| (*t).to_owned())),
                    Column::Number(values) => values.extend(numbers.next()),
                    Column::Flag(values) => values.extend(flags.next()),
                }
            }
        });
        self.samples += 1;
        if self.samples == SAMPLES_PER_PART { self.flush() } else { Ok(()) }
    }

    /// Closes the current part.
    fn flush(&mut self) -> Result<(), Error> {
        if self.samples == 0 {
            return Ok(());
        }
        self.flush_csv()?;
        let path = self.part(self.parts);
        let draft = path.with_extension("tmp");
        let batch = batch(self.kind, &mut self.columns).map_err(Error::table(&path))?;
        write_parquet(&draft, &path, &batch.schema(), |writer| {
            writer.write(&batch).map_err(Error::table(&path))
        })?;
        self.parts += 1;
        self.samples = 0;
        Ok(())
    }

    fn flush_csv(&mut self) -> Result<(), Error> {
        let path = self.path("csv");
        let Some(file) = &mut self.csv else { return Ok(()) };
        let rows = self.columns.first().map_or(0, Column::len);
        for row in 0..rows {
            file.write_record(self.columns.iter().map(|c| c.text(row))).map_err(Error::table(&path))?;
        }
        file.flush().map_err(Error::io("write", &path))
    }

    /// Makes one file of all parts.
    pub(crate) fn finish(&mut self) -> Result<(), Error> {
        self.flush()?;
        let (path, draft) = (self.path("parquet"), self.path("parquet.tmp"));
        let schema = Arc::new(schema(self.kind));
        let all_parts = |writer: &mut ArrowWriter<File>| {
            for index in 0..self.parts {
                for batch in open(&self.part(index))? {
                    let batch = batch.map_err(Error::table(&path))?;
                    writer.write(&batch).map_err(Error::table(&path))?;
                }
            }
            Ok(())
        };
        write_parquet(&draft, &path, &schema, all_parts)?;
        fs::remove_dir_all(self.parts_folder()).map_err(Error::io("remove", &self.parts_folder()))
    }
}

impl Column {
    fn len(&self) -> usize {
        match self {
            Self::Text(v) => v.len(),
            Self::Number(v) => v.len(),
            Self::Flag(v) => v.len(),
        }
    }

    fn text(&self, row: usize) -> String {
        match self {
            Self::Text(v) => v[row].clone(),
            Self::Number(v) => v[row].to_string(),
            Self::Flag(v) => v[row].to_string(),
        }
    }

    fn data_type(&self) -> DataType {
        match self {
            Self::Text(_) => DataType::Utf8,
            Self::Number(_) => DataType::Float64,
            Self::Flag(_) => DataType::Boolean,
        }
    }

    /// Moves the values into an array.
    fn take(&mut self) -> ArrayRef {
        match self {
            Self::Text(v) => Arc::new(StringArray::from(std::mem::take(v))),
            Self::Number(v) => Arc::new(Float64Array::from(std::mem::take(v))),
            Self::Flag(v) => Arc::new(BooleanArray::from(std::mem::take(v))),
        }
    }
}

fn schema(kind: TableKind) -> Schema {
    let field = |(name, column): (&&str, Column)| Field::new(*name, column.data_type(), false);
    Schema::new(kind.columns().iter().zip(kind.empty_columns()).map(field).collect::<Vec<_>>())
}

fn batch(kind: TableKind, columns: &mut [Column]) -> Result<RecordBatch, arrow_schema::ArrowError> {
    RecordBatch::try_new(Arc::new(schema(kind)), columns.iter_mut().map(Column::take).collect())
}

/// Writes a whole Parquet file as `draft` and renames it to `path`; where that fails, no draft is left.
fn write_parquet(
    draft: &Path,
    path: &Path,
    schema: &Arc<Schema>,
    fill: impl FnOnce(&mut ArrowWriter<File>) -> Result<(), Error>,
) -> Result<(), Error> {
    let write = || {
        let mut writer = parquet_writer(draft, schema)?;
        fill(&mut writer)?;
        writer.close().map_err(Error::table(path))?;
        fs::rename(draft, path).map_err(Error::io("write", path))
    };
    write().inspect_err(|_| {
        // The draft may not exist; the first error is the one to tell.
        let _ = fs::remove_file(draft);
    })
}

fn parquet_writer(path: &Path, schema: &Arc<Schema>) -> Result<ArrowWriter<File>, Error> {
    let file = File::create(path).map_err(Error::io("create", path))?;
    let compression = Compression::ZSTD(ZstdLevel::default());
    let properties = WriterProperties::builder()
        .set_compression(compression)
        .set_max_row_group_row_count(Some(ROWS_PER_GROUP))
        .build();
    ArrowWriter::try_new(file, schema.clone(), Some(properties)).map_err(Error::table(path))
}

fn open(path: &Path) -> Result<parquet::arrow::arrow_reader::ParquetRecordBatchReader, Error> {
    let file = File::open(path).map_err(Error::io("open", path))?;
    ParquetRecordBatchReaderBuilder::try_new(file)
        .and_then(ParquetRecordBatchReaderBuilder::build)
        .map_err(Error::table(path))
}

/// Reads a table of the run in `folder` back, in the order of [`TableKind::columns`]; of a run that was killed, the
/// parts that were closed.
///
/// # Errors
/// [`Error`] when a file is missing or is no such table.
pub fn read_table(folder: &Path, kind: TableKind) -> Result<Vec<Column>, Error> {
    let tables = folder.join("tables");
    let whole = tables.join(kind.name()).with_extension("parquet");
    let files =
        if whole.exists() { vec![whole] } else { parts(&tables.join(kind.name()).with_extension("parts"))? };
    let mut columns = kind.empty_columns();
    for path in files {
        for batch in open(&path)? {
            let batch = batch.map_err(Error::table(&path))?;
            for (column, name) in columns.iter_mut().zip(kind.columns()) {
                append(column, batch.column_by_name(name)).ok_or_else(|| {
                    Error::table(&path)(format!("column `{name}` is missing or of another type"))
                })?;
            }
        }
    }
    Ok(columns)
}

fn parts(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let entries = fs::read_dir(folder).map_err(Error::io("read", folder))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "parquet"));
    files.sort();
    Ok(files)
}

fn append(column: &mut Column, array: Option<&ArrayRef>) -> Option<()> {
    let any = array?.as_any();
    match column {
        Column::Text(v) => {
            v.extend(any.downcast_ref::<StringArray>()?.iter().map(|t| t.unwrap_or_default().to_owned()));
        }
        Column::Number(v) => v.extend(any.downcast_ref::<Float64Array>()?.values().iter()),
        Column::Flag(v) => {
            v.extend(any.downcast_ref::<BooleanArray>()?.iter().map(Option::unwrap_or_default));
        }
    }
    Some(())
}
