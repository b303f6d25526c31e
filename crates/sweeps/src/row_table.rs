//! Rows of a study as a table, column by column.

use crate::design::RunPoint;
use crate::measure::MEASURES;
use crate::row::{RowStatus, RunRow};
use recording::{Column, NamedColumn};
use scene::Study;
use std::borrow::Cow;
use vocabulary::Word;

/// Rows of a study, column by column.
#[derive(Debug, Clone)]
pub struct RowTable {
    columns: Vec<NamedColumn>,
    /// How many of them are the study's keys.
    keys: usize,
}

/// A value of a row.
enum RowValue<'a> {
    Whole(u64),
    Text(&'a str),
    Number(f64),
    Flag(bool),
}

impl RowTable {
    /// Without rows.
    pub fn new(study: &Study) -> Self {
        let keys = study.parameters.len();
        let point = RunPoint { values: vec![String::new(); keys], ..RunPoint::default() };
        let mut names = study.parameters.iter().map(|parameter| Cow::Owned(parameter.key.clone()));
        let column = |(name, value): (Option<&'static str>, RowValue<'_>)| {
            let column = match value {
                RowValue::Whole(_) => Column::Whole(vec![]),
                RowValue::Text(_) => Column::Text(vec![]),
                RowValue::Number(_) => Column::Number(vec![]),
                RowValue::Flag(_) => Column::Flag(vec![]),
            };
            NamedColumn::new(name.map(Cow::Borrowed).or_else(|| names.next()).unwrap_or_default(), column)
        };
        let empty = RunRow::of(point, RowStatus::Complete, String::new());
        Self { columns: values(&empty).into_iter().map(column).collect(), keys }
    }

    /// Its columns; they may be taken out and put in, all alike.
    pub fn columns_mut(&mut self) -> &mut [NamedColumn] {
        &mut self.columns
    }

    /// Its columns.
    pub fn columns(&self) -> &[NamedColumn] {
        &self.columns
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |first| first.column.len())
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds a row.
    pub fn push(&mut self, row: &RunRow) {
        for (named, (_, value)) in self.columns.iter_mut().zip(values(row)) {
            match (&mut named.column, value) {
                // Indices and seeds are below 2⁶³.
                (Column::Whole(all), RowValue::Whole(value)) => {
                    all.push(i64::try_from(value).unwrap_or(i64::MAX));
                }
                (Column::Text(all), RowValue::Text(value)) => all.push(value.to_owned()),
                (Column::Number(all), RowValue::Number(value)) => all.push(value),
                (Column::Flag(all), RowValue::Flag(value)) => all.push(value),
                _ => {}
            }
        }
    }

    /// A row; `None` where there is none.
    pub fn row(&self, index: usize) -> Option<RunRow> {
        let mut next = self.columns.iter().map(|named| &named.column);
        let [run, cell, sample, seed] = [(); 4].map(|()| whole(next.next(), index));
        let values = (0..self.keys).map(|_| text(next.next(), index)).collect::<Option<Vec<String>>>()?;
        let status = text(next.next(), index)?;
        let status =
            RowStatus::WORDS.iter().find(|(word, ..)| *word == status).map(|(_, status, _)| *status)?;
        let Some(Column::Flag(met)) = next.next() else { return None };
        Some(RunRow {
            point: RunPoint { index: run?, cell: cell?, sample: sample?, seed: seed?, values },
            status,
            met: *met.get(index)?,
            failed: text(next.next(), index)?,
            failed_time: number(next.next(), index)?,
            reason: text(next.next(), index)?,
            contacts: whole(next.next(), index)?,
            measures: MEASURES.iter().map(|_| number(next.next(), index)).collect::<Option<Vec<f64>>>()?,
            digest: text(next.next(), index)?,
            wall_time: number(next.next(), index)?,
        })
    }

    /// All rows.
    pub fn rows(&self) -> impl Iterator<Item = RunRow> {
        (0..self.len()).filter_map(|index| self.row(index))
    }
}

fn whole(column: Option<&Column>, row: usize) -> Option<u64> {
    let Some(Column::Whole(values)) = column else { return None };
    values.get(row).and_then(|value| u64::try_from(*value).ok())
}

fn text(column: Option<&Column>, row: usize) -> Option<String> {
    let Some(Column::Text(values)) = column else { return None };
    values.get(row).cloned()
}

fn number(column: Option<&Column>, row: usize) -> Option<f64> {
    let Some(Column::Number(values)) = column else { return None };
    values.get(row).copied()
}

/// The values of a row in the order of its columns, each with the name of its column; those of the study's keys have none.
fn values(row: &RunRow) -> Vec<(Option<&'static str>, RowValue<'_>)> {
    use RowValue::{Flag, Number, Text, Whole};
    let RunRow { point, status, met, failed, failed_time, reason, contacts, measures, digest, wall_time } =
        row;
    let mut values = vec![
        (Some("index"), Whole(point.index)),
        (Some("cell"), Whole(point.cell)),
        (Some("sample"), Whole(point.sample)),
        (Some("seed"), Whole(point.seed)),
    ];
    values.extend(point.values.iter().map(|value| (None, Text(value))));
    values.extend([
        (Some("status"), Text(status.word())),
        (Some("met"), Flag(*met)),
        (Some("failed"), Text(failed)),
        (Some("failed_time_s"), Number(*failed_time)),
        (Some("reason"), Text(reason)),
        (Some("contacts"), Whole(*contacts)),
    ]);
    values
        .extend(MEASURES.iter().zip(measures).map(|(measure, value)| (Some(measure.column), Number(*value))));
    values.extend([(Some("digest"), Text(digest)), (Some("wall_time_s"), Number(*wall_time))]);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_out_as_they_went_in() {
        let parameter =
            scene::StudyParameter { key: "law.k".to_owned(), values: "1,2".parse().expect("values") };
        let study = Study { parameters: vec![parameter], ..Study::of_scene("circle-three", "t") };
        let row = RunRow {
            point: RunPoint { index: 1, cell: 1, sample: 0, seed: 1 << 62, values: vec!["2".to_owned()] },
            status: RowStatus::Stopped,
            met: false,
            failed: "no_contact".to_owned(),
            failed_time: 3.5,
            reason: "2 contacts".to_owned(),
            contacts: 2,
            measures: (0..MEASURES.len()).map(|k| k as f64).collect(),
            digest: "d".to_owned(),
            wall_time: 0.25,
        };
        let mut table = RowTable::new(&study);
        table.push(&row);
        assert_eq!((table.len(), table.row(0), table.row(1)), (1, Some(row), None));
        let names: Vec<&str> = table.columns().iter().map(|column| &*column.name).collect();
        assert_eq!(names[..6], ["index", "cell", "sample", "seed", "law.k", "status"]);
        assert!(table.columns().iter().all(|column| column.column.len() == 1));
    }
}
