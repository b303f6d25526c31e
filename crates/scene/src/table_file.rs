//! Tables of a lead robot's motion, in files beside the scene.

use crate::{
    files::FileForm,
    path_form::{MOST_ROWS, SPEED, TIME, TURN_RATE},
    text::{Reporter, Span, form::Number},
};
use vocabulary::counted;

/// Columns and the forms of their values.
const COLUMNS: [(&str, Number); 3] = [("t", TIME), ("v", SPEED), ("omega", TURN_RATE)];

/// The name of a CSV file with columns t, v, omega.
pub(crate) const ROWS_FILE: FileForm<Vec<[f64; 3]>> = FileForm(read_rows);

/// What is wrong with `value` as the next of numbers that rise from 0.
fn out_of_order(last: Option<f64>, value: f64) -> Option<String> {
    match last {
        None if value != 0.0 => Some(format!("the first row must be at 0, not at {value}")),
        Some(last) if value <= last => Some(format!("rows must rise: {value} follows {last}")),
        _ => None,
    }
}

/// Reports where numbers do not rise from 0.
pub(crate) fn check_rising(values: impl Iterator<Item = f64>, span: Span, reporter: &mut Reporter) {
    let mut last = None;
    for value in values {
        if let Some(fault) = out_of_order(last, value) {
            reporter.report(span, fault);
            return;
        }
        last = Some(value);
    }
}

fn read_rows(text: &str, source: usize, reporter: &mut Reporter) -> Option<Vec<[f64; 3]>> {
    let mut table =
        csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let columns = find_columns(table.headers().ok()?, source, reporter)?;
    let mut rows: Vec<[f64; 3]> = Vec::new();
    let mut good = true;
    for record in table.records().take(MOST_ROWS + 1) {
        let span = line_at(
            record.as_ref().map_or_else(csv::Error::position, csv::StringRecord::position),
            text,
            source,
        );
        let row = record.map_err(|error| format!("not a row of the table: {}", why(&error)));
        match row.and_then(|record| read_row(&record, columns)) {
            Ok(row) => {
                if let Some(fault) = out_of_order(rows.last().map(|last| last[0]), row[0]) {
                    reporter.report(span, fault);
                }
                rows.push(row);
            }
            Err(fault) => {
                reporter.report(span, fault);
                good = false;
            }
        }
    }
    if good && !(1..=MOST_ROWS).contains(&rows.len()) {
        let message = format!("a table needs 1 to {MOST_ROWS} rows under its header");
        reporter.report(Span { source, start: 0, end: 0 }, message);
        return None;
    }
    good.then_some(rows)
}

fn find_columns(header: &csv::StringRecord, source: usize, reporter: &mut Reporter) -> Option<[usize; 3]> {
    let find = |(name, _): (&str, Number)| header.iter().position(|column| column == name);
    let [Some(t), Some(v), Some(omega)] = COLUMNS.map(find) else {
        let names = COLUMNS.map(|(name, _)| name).join(", ");
        let found = header.iter().take(10).collect::<Vec<_>>().join(", ");
        let hint = header.iter().find_map(separator).unwrap_or_default();
        let message = format!("the columns must be {names}, not {found}{hint}");
        reporter.report(Span { source, start: 0, end: 0 }, message);
        return None;
    };
    Some([t, v, omega])
}

fn read_row(record: &csv::StringRecord, columns: [usize; 3]) -> Result<[f64; 3], String> {
    let mut row = [0.0; 3];
    for ((value, column), (name, form)) in row.iter_mut().zip(columns).zip(COLUMNS) {
        let text = record.get(column).unwrap_or("");
        let number = text.parse().ok().filter(|number| form.holds(*number));
        *value = number.ok_or_else(|| {
            let hint = separator(text).unwrap_or_default();
            format!("`{name}` must be {}, not {text:?}{hint}", form.expected())
        })?;
    }
    Ok(row)
}

/// The CSV reader's message about a row, without the line number, which is reported with the position.
pub(crate) fn why(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("it has {}, and the header {expected_len}", counted(len, "value"))
        }
        _ => error.to_string(),
    }
}

/// The end of a message about a value that holds what other programs put between values.
pub(crate) fn separator(text: &str) -> Option<&'static str> {
    let known = [
        (';', "; the file is separated by `;`: use commas, and points in numbers"),
        ('\t', "; the file is separated by tabs: use commas"),
    ];
    known.into_iter().find_map(|(sign, hint)| text.contains(sign).then_some(hint))
}

/// The line of the record that is read from a position in a file on. The reader stands behind the last record: the rest
/// of its line end, empty lines and comments come first.
pub(crate) fn line_at(position: Option<&csv::Position>, text: &str, source: usize) -> Span {
    let mut start = position.map_or(0, |position| position.byte() as usize);
    let length = loop {
        let rest = text.get(start..).unwrap_or("");
        let length = rest.find(['\r', '\n']).unwrap_or(rest.len());
        if length == rest.len() || !(length == 0 || rest.starts_with('#')) {
            break length;
        }
        start += length + 1;
    };
    Span { source, start, end: start + length }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// Line and text of the fault of a table that has one in its row `2,x,0`.
    fn fault(text: &str) -> (usize, String) {
        let mut reporter = Reporter::new(Path::new(""));
        let source = reporter.add_source("way.csv".to_owned(), text);
        assert_eq!(read_rows(text, source, &mut reporter), None);
        let diagnostics = reporter.into_diagnostics();
        let [one] = diagnostics.all() else { panic!("{diagnostics}") };
        (one.line, one.excerpt.clone())
    }

    #[test]
    fn a_fault_stands_at_its_line_whatever_lies_between() {
        for (text, line) in [
            ("t,v,omega\n0,1,0\n2,x,0\n", 3),
            ("t,v,omega\r\n0,1,0\r\n2,x,0\r\n", 3),
            ("t,v,omega\n0,1,0\n\n\n2,x,0", 5),
            ("t,v,omega\n0,1,0\n# a remark\n\n# and one more\n2,x,0\n", 6),
            ("# first\r\nt,v,omega\r\n\r\n0,1,0\r\n# a remark\r\n2,x,0\r\n", 6),
        ] {
            assert_eq!(fault(text), (line, "2,x,0".to_owned()), "{text:?}");
        }
    }
}
