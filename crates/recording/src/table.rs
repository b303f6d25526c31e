//! Tidy tables: one row per robot or edge and sample, in Parquet and, on request, CSV.
//!
//! A Parquet file is readable only once it is closed, so rows go into small parts, each closed as soon as it is
//! full, and the parts become one file when the run ends.

use crate::Error;
use crate::column::{Column, NamedColumn};
use crate::columns::{self, Cell, Row};
use crate::parquet_file::{self, ParquetWriter};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
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
        /// Ways to goals, when they are planned.
        Plans = "plans",
    }
}

/// Samples a part holds: at 10 ms, half a run of the paper.
const SAMPLES_PER_PART: usize = 750;
/// Rows of the whole table that are in memory before they are written as a group.
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
            Self::Plans => fleet.has_plans,
            _ => true,
        };
        Self::WORDS.iter().map(|(_, kind, _)| *kind).filter(has).collect()
    }

    /// Shows `row` the values of every row that `record` adds.
    fn rows(self, fleet: &FleetInfo, record: &StepRecord, row: &mut Row<'_>) {
        let StepRecord { snapshot, edges: _, contacts, frames, safety, laws, leaders: _, events, plans } =
            record;
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
            Self::Plans => {
                for plan in plans {
                    columns::plan(snapshot.time, fleet, plan, row);
                }
            }
        }
    }
}

/// Gathers the rows of one table in memory.
pub struct TableBuilder {
    kind: TableKind,
    columns: Vec<NamedColumn>,
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
            match (&mut columns[next].column, cell) {
                (Column::Text(values), Cell::Text(text)) => values.push(text.to_owned()),
                (Column::Number(values), Cell::Number(number)) => values.push(number),
                (Column::Flag(values), Cell::Flag(flag)) => values.push(flag),
                _ => {}
            }
            next = (next + 1) % columns.len();
        });
    }

    /// Takes the rows out, column by column, each with its name; the table is empty then.
    pub fn take(&mut self) -> Vec<NamedColumn> {
        std::mem::replace(&mut self.columns, columns::empty(self.kind))
    }

    /// Rows so far.
    fn len(&self) -> usize {
        self.columns.first().map_or(0, |first| first.column.len())
    }

    /// The rows as text, cell by cell.
    fn texts(&self) -> impl Iterator<Item = impl Iterator<Item = String>> {
        (0..self.len()).map(|row| self.columns.iter().map(move |each| each.column.text(row)))
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
            file.write_record(writer.table.columns.iter().map(|each| &*each.name))
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
        let mut part = ParquetWriter::create(&self.part(self.parts), &self.table.columns)?;
        part.write(&mut self.table.columns)?;
        part.close()?;
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
        let mut whole = ParquetWriter::create(&self.path("parquet"), &self.table.columns)?;
        for index in 0..self.parts {
            parquet_file::append_columns(&self.part(index), &mut self.table.columns)?;
            if self.table.len() >= ROWS_PER_GROUP {
                whole.write(&mut self.table.columns)?;
            }
        }
        whole.write(&mut self.table.columns)?;
        whole.close()?;
        fs::remove_dir_all(self.parts_folder()).map_err(Error::io("remove", &self.parts_folder()))
    }
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
        parquet_file::append_columns(&path, &mut columns)?;
    }
    Ok(columns.into_iter().map(|each| each.column).collect())
}

fn parts(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let entries = fs::read_dir(folder).map_err(Error::io("read", folder))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|e| e.ok().map(|e| e.path())).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "parquet"));
    files.sort();
    Ok(files)
}
