//! Heights of the ground, in files beside the scene.

use crate::{
    files::FileForm,
    table_file::{line_at, separator, why},
    text::{Reporter, Span, form::Number, number},
};
use vocabulary::counted;

/// One height.
pub(crate) const HEIGHT: Number = number("m").from(-1000.0).up_to(1000.0);
/// Most heights that are read: as many as can be written into a scene and read again.
pub(crate) const MOST_HEIGHTS: usize = 300_000;

/// The name of a CSV file of heights: no header, a row of numbers for each y, the smallest y first.
pub(crate) const HEIGHTS_FILE: FileForm<Vec<Vec<f64>>> = FileForm(read_rows);

fn read_rows(text: &str, source: usize, reporter: &mut Reporter) -> Option<Vec<Vec<f64>>> {
    let mut table = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let mut rows: Vec<Vec<f64>> = vec![];
    let (mut good, mut count) = (true, 0);
    for (index, record) in table.records().enumerate() {
        let position =
            record.as_ref().map_or_else(csv::Error::position, csv::StringRecord::position).cloned();
        let row = record.map_err(|error| format!("not a row of heights: {}", why(&error)));
        let wanted = rows.first().map(Vec::len);
        match row.and_then(|record| read_row(&record, index + 1, wanted)) {
            Ok(row) => {
                count += row.len();
                rows.push(row);
            }
            Err(fault) => {
                reporter.report(line_at(position.as_ref(), text, source), fault);
                good = false;
            }
        }
        if count > MOST_HEIGHTS || reporter.is_full() {
            break;
        }
    }
    if good && let Some(fault) = wrong_size(&rows) {
        reporter.report(Span { source, start: 0, end: 0 }, fault);
        return None;
    }
    good.then_some(rows)
}

fn read_row(record: &csv::StringRecord, row: usize, wanted: Option<usize>) -> Result<Vec<f64>, String> {
    let read = |(index, text): (usize, &str)| {
        let number = text.parse().ok().filter(|number| HEIGHT.holds(*number));
        number.ok_or_else(|| {
            let column = index + 1;
            if text.is_empty() {
                return format!("there is no height in row {row}, column {column}: a hole");
            }
            let hint = separator(text).unwrap_or_default();
            format!(
                "the height in row {row}, column {column} must be {}, not {text:?}{hint}",
                HEIGHT.expected()
            )
        })
    };
    let heights = record.iter().enumerate().map(read).collect::<Result<Vec<_>, _>>()?;
    wrong_length(row, heights.len(), wanted).map_or(Ok(heights), Err)
}

/// What is wrong with a row, counted from 1, of `length` heights where the first has `wanted`.
pub(crate) fn wrong_length(row: usize, length: usize, wanted: Option<usize>) -> Option<String> {
    let wanted = wanted.filter(|wanted| *wanted != length)?;
    let column = length.min(wanted) + 1;
    let missing = if length < wanted { "there is no height from" } else { "there are more heights from" };
    let heights = counted(length, "height");
    Some(format!("row {row} has {heights} and the first row {wanted}: {missing} column {column} on"))
}

/// What is wrong with the number of heights in rows of one length.
pub(crate) fn wrong_size(rows: &[Vec<f64>]) -> Option<String> {
    let columns = rows.first().map_or(0, Vec::len);
    if rows.len() < 2 || columns < 2 {
        return Some(format!("heights need two rows of two at least, not {} of {columns}", rows.len()));
    }
    (rows.len() * columns > MOST_HEIGHTS)
        .then(|| format!("more than {MOST_HEIGHTS} heights; take a larger `cell`"))
}
