//! Parquet files of the columns that tables have: text, numbers and flags, none of them ever absent.

use crate::Error;
use crate::column::{Column, NamedColumn};
use bytes::Bytes;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::column::reader::ColumnReader;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{ChunkReader, FileReader, RowGroupReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Under which key a file carries its mark.
const MARK: &str = "echelon";

/// A Parquet file while it is written: under a draft's name, until it is whole.
pub struct ParquetWriter {
    draft: PathBuf,
    path: PathBuf,
    file: SerializedFileWriter<File>,
}

impl ParquetWriter {
    /// Begins the file at `path`, which appears when it is closed. It has the columns of `columns`.
    ///
    /// # Errors
    /// [`Error`] where it cannot be written.
    pub fn create(path: &Path, columns: &[NamedColumn]) -> std::result::Result<Self, Error> {
        Self::with(path, columns, None)
    }

    /// As [`ParquetWriter::create`]; the file carries a mark, which [`read_mark`] finds.
    ///
    /// # Errors
    /// [`Error`] where it cannot be written.
    pub fn marked(path: &Path, columns: &[NamedColumn], mark: &str) -> std::result::Result<Self, Error> {
        Self::with(path, columns, Some(mark))
    }

    fn with(path: &Path, columns: &[NamedColumn], mark: Option<&str>) -> std::result::Result<Self, Error> {
        let draft = path.with_extension("tmp");
        let file = File::create(&draft).map_err(Error::io("create", &draft))?;
        let file = schema(columns)
            .and_then(|schema| SerializedFileWriter::new(file, schema, properties(mark)))
            .map_err(Error::table(&draft))?;
        Ok(Self { draft, path: path.to_owned(), file })
    }

    /// Writes rows as a group, and takes them out of `columns`.
    ///
    /// # Errors
    /// [`Error`] where the disk does not take them.
    pub fn write(&mut self, columns: &mut [NamedColumn]) -> std::result::Result<(), Error> {
        write_group(&mut self.file, columns).map_err(Error::table(&self.path))
    }

    /// Completes the file and gives it its name.
    ///
    /// # Errors
    /// [`Error`] where the disk does not take it.
    pub fn close(mut self) -> std::result::Result<(), Error> {
        self.file.finish().map_err(Error::table(&self.path))?;
        fs::rename(&self.draft, &self.path).map_err(Error::io("write", &self.path))
    }
}

impl Drop for ParquetWriter {
    fn drop(&mut self) {
        // A file that has its name left no draft; what else goes wrong here says less than the first error did.
        let _ = fs::remove_file(&self.draft);
    }
}

/// Appends the rows of the file at `path` to `columns`, each found by its name.
///
/// # Errors
/// [`Error`] where it cannot be read, or lacks a column.
pub fn append_columns(path: &Path, columns: &mut [NamedColumn]) -> std::result::Result<(), Error> {
    let file = File::open(path).map_err(Error::io("open", path))?;
    append_from(&SerializedFileReader::new(file).map_err(Error::table(path))?, path, columns)
}

/// As [`append_columns`], of a file in memory, with its mark.
///
/// # Errors
/// [`Error`] where it is no such file, or lacks a column.
pub fn append_bytes(
    bytes: Vec<u8>,
    columns: &mut [NamedColumn],
) -> std::result::Result<Option<String>, Error> {
    let path = Path::new(IN_MEMORY);
    let reader = SerializedFileReader::new(Bytes::from(bytes)).map_err(Error::table(path))?;
    append_from(&reader, path, columns)?;
    Ok(mark_of(&reader))
}

/// Rows as the bytes of a file with a mark; they are taken out of `columns`.
///
/// # Errors
/// [`Error`] where they cannot be encoded.
pub fn parquet_bytes(columns: &mut [NamedColumn], mark: &str) -> std::result::Result<Vec<u8>, Error> {
    let path = Path::new(IN_MEMORY);
    let mut written = || {
        let mut file = SerializedFileWriter::new(vec![], schema(columns)?, properties(Some(mark)))?;
        write_group(&mut file, columns)?;
        file.into_inner()
    };
    written().map_err(Error::table(path))
}

/// What a file is called in messages that has no name.
const IN_MEMORY: &str = "rows in memory";

fn append_from<R: ChunkReader + 'static>(
    reader: &SerializedFileReader<R>,
    path: &Path,
    columns: &mut [NamedColumn],
) -> std::result::Result<(), Error> {
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group).map_err(Error::table(path))?;
        for NamedColumn { name, column } in &mut *columns {
            let index = schema.columns().iter().position(|described| described.name() == &**name);
            let read = index.map_or(Ok(false), |index| read_column(&*group, index, column));
            if !read.map_err(Error::table(path))? {
                let message = format!("column `{name}` is missing or of another type");
                return Err(Error::table(path)(message));
            }
        }
    }
    Ok(())
}

/// The mark that the file at `path` carries; `None` where it has none.
///
/// # Errors
/// [`Error`] where it cannot be read.
pub fn read_mark(path: &Path) -> std::result::Result<Option<String>, Error> {
    let file = File::open(path).map_err(Error::io("open", path))?;
    Ok(mark_of(&SerializedFileReader::new(file).map_err(Error::table(path))?))
}

fn mark_of<R: ChunkReader + 'static>(reader: &SerializedFileReader<R>) -> Option<String> {
    let pairs = reader.metadata().file_metadata().key_value_metadata();
    pairs.and_then(|pairs| pairs.iter().find(|pair| pair.key == MARK)?.value.clone())
}

/// Whole numbers of the file at `path`, by the name of their column.
///
/// # Errors
/// [`Error`] where it cannot be read, or has no such column.
pub fn read_whole(path: &Path, name: &'static str) -> std::result::Result<Vec<i64>, Error> {
    let mut columns = [NamedColumn::new(name, Column::Whole(vec![]))];
    append_columns(path, &mut columns)?;
    let [NamedColumn { column, .. }] = columns;
    Ok(if let Column::Whole(numbers) = column { numbers } else { vec![] })
}

fn properties(mark: Option<&str>) -> Arc<WriterProperties> {
    let mark = mark.map(|mark| vec![KeyValue::new(MARK.to_owned(), mark.to_owned())]);
    let properties = WriterProperties::builder().set_compression(Compression::ZSTD(ZstdLevel::default()));
    Arc::new(properties.set_key_value_metadata(mark).build())
}

fn schema(columns: &[NamedColumn]) -> Result<Arc<Type>> {
    let field = |NamedColumn { name, column }: &NamedColumn| {
        let (physical, logical) = match column {
            Column::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            Column::Number(_) => (Physical::DOUBLE, None),
            Column::Whole(_) => (Physical::INT64, None),
            Column::Flag(_) => (Physical::BOOLEAN, None),
        };
        Type::primitive_type_builder(name, physical)
            .with_repetition(Repetition::REQUIRED)
            .with_logical_type(logical)
            .build()
            .map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<_>>()?;
    Type::group_type_builder("table").with_fields(fields).build().map(Arc::new)
}

fn write_group<W: Write + Send>(
    file: &mut SerializedFileWriter<W>,
    columns: &mut [NamedColumn],
) -> Result<()> {
    let mut group = file.next_row_group()?;
    for named in columns {
        write_column(&mut group, &mut named.column)?;
    }
    group.close().map(drop)
}

fn write_column<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    column: &mut Column,
) -> Result<()> {
    let Some(mut writer) = group.next_column()? else {
        return Err(ParquetError::General("more columns than the file has".into()));
    };
    match (writer.untyped(), column) {
        (ColumnWriter::ByteArrayColumnWriter(writer), Column::Text(texts)) => {
            let bytes: Vec<_> =
                std::mem::take(texts).into_iter().map(|text| ByteArray::from(text.into_bytes())).collect();
            writer.write_batch(&bytes, None, None)?;
        }
        (ColumnWriter::DoubleColumnWriter(writer), Column::Number(numbers)) => {
            writer.write_batch(&std::mem::take(numbers), None, None)?;
        }
        (ColumnWriter::Int64ColumnWriter(writer), Column::Whole(numbers)) => {
            writer.write_batch(&std::mem::take(numbers), None, None)?;
        }
        (ColumnWriter::BoolColumnWriter(writer), Column::Flag(flags)) => {
            writer.write_batch(&std::mem::take(flags), None, None)?;
        }
        _ => return Err(ParquetError::General("a column of another type than the file has".into())),
    }
    writer.close()
}

/// Appends a column of a group of rows; `false` if it is of another type, or lacks values.
fn read_column(group: &dyn RowGroupReader, index: usize, column: &mut Column) -> Result<bool> {
    let rows = usize::try_from(group.metadata().num_rows())?;
    let read = match (group.get_column_reader(index)?, column) {
        (ColumnReader::ByteArrayColumnReader(mut reader), Column::Text(texts)) => {
            let mut bytes = vec![];
            reader.read_records(rows, None, None, &mut bytes)?;
            for text in &bytes {
                texts.push(text.as_utf8()?.to_owned());
            }
            bytes.len()
        }
        (ColumnReader::DoubleColumnReader(mut reader), Column::Number(numbers)) => {
            reader.read_records(rows, None, None, numbers)?.1
        }
        (ColumnReader::Int64ColumnReader(mut reader), Column::Whole(numbers)) => {
            reader.read_records(rows, None, None, numbers)?.1
        }
        (ColumnReader::BoolColumnReader(mut reader), Column::Flag(flags)) => {
            reader.read_records(rows, None, None, flags)?.1
        }
        _ => return Ok(false),
    };
    Ok(read == rows)
}
