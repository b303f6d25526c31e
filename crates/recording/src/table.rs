//! Tidy tables: one row per robot or edge and sample, in Parquet and, on request, CSV.
//!
//! A Parquet file is readable only once it is closed, so rows go into small parts, each closed as soon as it is
//! full, and the parts become one file when the run ends.

use crate::Error;
use crate::columns::{self, Cell, Row};
use arrow_array::{ArrayRef, BooleanArray, Float64Array, RecordBatch, StringArray};
use arrow_schema::{ArrowError, DataType, Field, Schema};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::properties::WriterProperties;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use vocabulary::{EntityId, FleetInfo, Mobility, StepRecord, Word, words};

words! {
    /// The tables of a run; the word is the stem of the file's name.
    pub enum TableKind {
        /// Poses and speeds of every robot.
        Robots = "robots",
        /// Set point, error, command and estimate of every edge.
        Edges = "edges",
        /// Contacts, each once, when it has ended.
        Contacts = "contacts",
        /// Where the props are that can move.
        Props = "props",
        /// Measurements of followers, when they arrive.
        Measurements = "measurements",
        /// What the safety filters did.
        Safety = "safety",
        /// What custom laws carry and show.
        Laws = "laws",
        /// What happened to the formation.
        Events = "events",
    }
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
    /// The tables that a run of `fleet` has.
    pub fn of(fleet: &FleetInfo) -> Vec<Self> {
        let moving = fleet.props.iter().any(|prop| prop.mobility != Mobility::Fixed);
        let has = |kind: &Self| match kind {
            Self::Props => moving,
            Self::Measurements => fleet.has_sensors,
            Self::Safety => fleet.has_safety,
            Self::Laws => fleet.has_laws,
            Self::Events => fleet.has_events,
            _ => true,
        };
        Self::WORDS.iter().map(|(_, kind, _)| *kind).filter(has).collect()
    }

    /// Shows `row` the values of every row that `record` adds.
    fn rows(self, fleet: &FleetInfo, record: &StepRecord, row: &mut Row<'_>) {
        let StepRecord { snapshot, edges: _, contacts, frames, safety, laws, leaders: _, events } = record;
        match self {
            Self::Robots => {
                for (member, robot) in fleet.robots.iter().zip(&snapshot.robots) {
                    columns::robot(snapshot.time, &member.name, robot, row);
                }
            }
            Self::Edges => {
                for (_, edge, state) in record.pairs(fleet) {
                    columns::edge(snapshot.time, fleet.pair(edge), state, row);
                }
            }
            Self::Contacts => {
                for contact in contacts.iter().filter(|contact| !contact.open) {
                    columns::contact(contact.things.map(|thing| fleet.name(thing)), contact, row);
                }
            }
            Self::Props => {
                let placed = fleet.props.iter().zip(&snapshot.props);
                for (prop, placement) in placed.filter(|(prop, _)| prop.mobility != Mobility::Fixed) {
                    columns::prop(snapshot.time, &prop.name, placement, row);
                }
            }
            Self::Measurements => {
                for frame in frames {
                    let Some(edge) = record.edge(fleet, frame.edge) else { continue };
                    columns::measurement(fleet.pair(edge), frame, row);
                }
            }
            Self::Safety => {
                for state in safety {
                    columns::safety(snapshot.time, fleet, state, row);
                }
            }
            Self::Laws => {
                for law in laws {
                    let follower = fleet.name(EntityId::Robot(law.robot));
                    for (quantity, value) in law.quantities.iter().zip(&law.values) {
                        columns::law(snapshot.time, follower, quantity, *value, row);
                    }
                }
            }
            Self::Events => {
                for event in events {
                    columns::event(snapshot.time, fleet, event, row);
                }
            }
        }
    }
}

/// Gathers the rows of one table in memory.
pub struct TableBuilder {
    kind: TableKind,
    columns: Vec<(&'static str, Column)>,
}

impl TableBuilder {
    /// A table without rows.
    pub fn new(kind: TableKind) -> Self {
        Self { kind, columns: columns::empty(kind) }
    }

    /// Adds the rows of a moment.
    pub fn push(&mut self, fleet: &FleetInfo, record: &StepRecord) {
        let (columns, mut next) = (&mut self.columns, 0);
        self.kind.rows(fleet, record, &mut |_, cell| {
            match (&mut columns[next].1, cell) {
                (Column::Text(values), Cell::Text(text)) => values.push(text.to_owned()),
                (Column::Number(values), Cell::Number(number)) => values.push(number),
                (Column::Flag(values), Cell::Flag(flag)) => values.push(flag),
                _ => {}
            }
            next = (next + 1) % columns.len();
        });
    }

    /// Takes the rows out; the table is empty then.
    ///
    /// # Errors
    /// [`ArrowError`] where the columns do not make a batch.
    pub fn take(&mut self) -> Result<RecordBatch, ArrowError> {
        let values = self.columns.iter_mut().map(|(_, column)| column.take()).collect();
        RecordBatch::try_new(schema(self.kind), values)
    }

    /// The rows as text, cell by cell.
    fn texts(&self) -> impl Iterator<Item = impl Iterator<Item = String>> {
        let rows = self.columns.first().map_or(0, |(_, column)| column.len());
        (0..rows).map(|row| self.columns.iter().map(move |(_, column)| column.text(row)))
    }
}

/// Writes one table.
pub(crate) struct TableWriter {
    kind: TableKind,
    folder: PathBuf,
    table: TableBuilder,
    samples: usize,
    parts: usize,
    csv: Option<csv::Writer<File>>,
}

impl TableWriter {
    pub(crate) fn create(folder: &Path, kind: TableKind, csv: bool) -> Result<Self, Error> {
        let mut writer = Self {
            kind,
            folder: folder.to_owned(),
            table: TableBuilder::new(kind),
            samples: 0,
            parts: 0,
            csv: None,
        };
        fs::create_dir_all(writer.parts_folder()).map_err(Error::io("create", &writer.parts_folder()))?;
        if csv {
            let path = writer.path("csv");
            let mut file = csv::Writer::from_path(&path).map_err(Error::table(&path))?;
            file.write_record(writer.table.columns.iter().map(|(name, _)| name))
                .map_err(Error::table(&path))?;
            writer.csv = Some(file);
        }
        Ok(writer)
    }

    fn path(&self, extension: &str) -> PathBuf {
        self.folder.join(self.kind.word()).with_extension(extension)
    }

    fn parts_folder(&self) -> PathBuf {
        self.path("parts")
    }

    fn part(&self, index: usize) -> PathBuf {
        self.parts_folder().join(format!("{index:06}.parquet"))
    }

    pub(crate) fn push(&mut self, fleet: &FleetInfo, record: &StepRecord) -> Result<(), Error> {
        self.table.push(fleet, record);
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
        let batch = self.table.take().map_err(Error::table(&path))?;
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
        for row in self.table.texts() {
            file.write_record(row).map_err(Error::table(&path))?;
        }
        file.flush().map_err(Error::io("write", &path))
    }

    /// Makes one file of all parts.
    pub(crate) fn finish(&mut self) -> Result<(), Error> {
        self.flush()?;
        let (path, draft) = (self.path("parquet"), self.path("parquet.tmp"));
        let schema = schema(self.kind);
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

fn schema(kind: TableKind) -> Arc<Schema> {
    let field = |(name, column): (&'static str, Column)| Field::new(name, column.data_type(), false);
    Arc::new(Schema::new(columns::empty(kind).into_iter().map(field).collect::<Vec<_>>()))
}

/// Writes a whole Parquet file as `draft` and renames it to `path`; where that fails, no draft is left.
fn write_parquet(
    draft: &Path,
    path: &Path,
    schema: &Arc<Schema>,
    fill: impl FnOnce(&mut ArrowWriter<File>) -> Result<(), Error>,
) -> Result<(), Error> {
    let write = || {
        let file = File::create(draft).map_err(Error::io("create", draft))?;
        let properties = WriterProperties::builder()
            .set_compression(Compression::ZSTD(ZstdLevel::default()))
            .set_max_row_group_row_count(Some(ROWS_PER_GROUP))
            .build();
        let mut writer =
            ArrowWriter::try_new(file, schema.clone(), Some(properties)).map_err(Error::table(draft))?;
        fill(&mut writer)?;
        writer.close().map_err(Error::table(path))?;
        fs::rename(draft, path).map_err(Error::io("write", path))
    };
    write().inspect_err(|_| {
        // The draft may not exist; the first error is the one to tell.
        let _ = fs::remove_file(draft);
    })
}

fn open(path: &Path) -> Result<parquet::arrow::arrow_reader::ParquetRecordBatchReader, Error> {
    let file = File::open(path).map_err(Error::io("open", path))?;
    ParquetRecordBatchReaderBuilder::try_new(file)
        .and_then(ParquetRecordBatchReaderBuilder::build)
        .map_err(Error::table(path))
}

/// Reads a table of the run in `folder` back, in the order of its columns; of a run that was killed, the
/// parts that were closed.
///
/// # Errors
/// [`Error`] when a file is missing or is no such table.
pub fn read_table(folder: &Path, kind: TableKind) -> Result<Vec<Column>, Error> {
    let tables = folder.join("tables");
    let whole = tables.join(kind.word()).with_extension("parquet");
    let files =
        if whole.exists() { vec![whole] } else { parts(&tables.join(kind.word()).with_extension("parts"))? };
    let mut columns = columns::empty(kind);
    for path in files {
        for batch in open(&path)? {
            let batch = batch.map_err(Error::table(&path))?;
            for (name, column) in &mut columns {
                append(column, batch.column_by_name(name)).ok_or_else(|| {
                    Error::table(&path)(format!("column `{name}` is missing or of another type"))
                })?;
            }
        }
    }
    Ok(columns.into_iter().map(|(_, column)| column).collect())
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
