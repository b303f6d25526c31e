//! Rows of a study as a table, column by column.

use crate::design::{Design, RunPoint};
use crate::measure::MEASURES;
use crate::row::{RowStatus, RunRow};
use recording::{Column, NamedColumn};
use scene::{Study, Values, WrittenNumber};
use std::borrow::Cow;
use std::sync::Arc;
use vocabulary::Word;

/// Rows of a study, column by column. Keys that are varied are numbers where all their values are, angles in rad.
#[derive(Debug, Clone)]
pub struct RowTable {
    columns: Vec<NamedColumn>,
    /// Says what the key columns of a row are.
    design: Arc<Design>,
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
    pub fn new(design: &Design) -> Self {
        let study = design.study();
        let point = RunPoint { values: vec![String::new(); study.parameters.len()], ..RunPoint::default() };
        let mut keys = study.parameters.iter();
        let column = |(name, value): (Option<&'static str>, RowValue<'_>)| {
            let column = match value {
                RowValue::Whole(_) => Column::Whole(vec![]),
                RowValue::Text(_) => Column::Text(vec![]),
                RowValue::Number(_) => Column::Number(vec![]),
                RowValue::Flag(_) => Column::Flag(vec![]),
            };
            match name {
                Some(name) => NamedColumn::new(Cow::Borrowed(name), column),
                None => keys.next().map_or(NamedColumn::new(Cow::default(), column), |parameter| {
                    NamedColumn::new(Cow::Owned(parameter.key.clone()), key_column(study, &parameter.values))
                }),
            }
        };
        let empty = RunRow::of(point, RowStatus::Complete, String::new());
        Self { columns: values(&empty).into_iter().map(column).collect(), design: Arc::new(design.clone()) }
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
                (Column::Number(all), RowValue::Text(value)) => {
                    all.push(WrittenNumber::of(value).map_or(f64::NAN, WrittenNumber::si));
                }
                (Column::Flag(all), RowValue::Text(value)) => all.push(value == "true"),
                (Column::Number(all), RowValue::Number(value)) => all.push(value),
                (Column::Flag(all), RowValue::Flag(value)) => all.push(value),
                _ => {}
            }
        }
    }

    /// A row; `None` where there is none.
    pub fn row(&self, index: usize) -> Option<RunRow> {
        let mut next = self.columns.iter().map(|named| &named.column);
        let run = whole(next.next(), index).filter(|run| *run < self.design.study().runs())?;
        // Cell, sample, seed and keys follow from the run.
        let mut next = next.skip(3 + self.design.study().parameters.len());
        let status = text(next.next(), index)?;
        let status =
            RowStatus::WORDS.iter().find(|(word, ..)| *word == status).map(|(_, status, _)| *status)?;
        let Some(Column::Flag(met)) = next.next() else { return None };
        Some(RunRow {
            point: self.design.point(run),
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

/// The column of a key that becomes these: numbers, flags or text.
fn key_column(study: &Study, of: &Values) -> Column {
    match of {
        Values::Drawn { .. } => Column::Number(vec![]),
        Values::Grid { values, .. } | Values::Zipped(values) => {
            if values.iter().all(|value| WrittenNumber::of(value).is_some()) {
                Column::Number(vec![])
            } else if values.iter().all(|value| ["true", "false"].contains(&value.as_str())) {
                Column::Flag(vec![])
            } else {
                Column::Text(vec![])
            }
        }
        // A key that is itself what another is cannot be named.
        Values::Same(key) => match study.parameters.iter().find(|other| other.key == *key) {
            Some(other) if !matches!(other.values, Values::Same(_)) => key_column(study, &other.values),
            _ => Column::Text(vec![]),
        },
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

    fn design(keys: &[(&str, &str)]) -> Design {
        let parameter = |(key, values): &(&str, &str)| scene::StudyParameter {
            key: (*key).to_owned(),
            values: values.parse().expect("values"),
        };
        let parameters = keys.iter().map(parameter).collect();
        Design::new(Study { parameters, ..Study::of_scene("circle-three", "t") })
    }

    #[test]
    fn rows_come_out_as_they_went_in() {
        let design = design(&[("law.k", "1,2")]);
        let row = RunRow {
            point: design.point(1),
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
        let mut table = RowTable::new(&design);
        table.push(&row);
        assert_eq!((table.len(), table.row(0), table.row(1)), (1, Some(row.clone()), None));
        let names: Vec<&str> = table.columns().iter().map(|column| &*column.name).collect();
        assert_eq!(names[..6], ["index", "cell", "sample", "seed", "law.k", "status"]);
        assert!(table.columns().iter().all(|column| column.column.len() == 1));
        // A run that the study has not.
        table.push(&RunRow { point: RunPoint { index: 2, ..row.point.clone() }, ..row });
        assert_eq!(table.row(1), None);
    }

    #[test]
    fn keys_are_numbers_and_flags_where_all_their_values_are() {
        let design = design(&[
            ("a", "-90 deg,1.5"),
            ("b", "car,1"),
            ("c", "true,false"),
            ("d", "uniform:2..2.5"),
            ("e", "=a"),
            ("f", "[1, 2],[3, 4]"),
            ("g", "\"007\",\"07\""),
            ("h", "\"1.5 rad\",\"90°\""),
            ("i", "1,inf"),
        ]);
        let mut table = RowTable::new(&design);
        table.push(&RunRow::of(design.point(0), RowStatus::Complete, String::new()));
        let column = |name: &str| {
            let found = table.columns().iter().find(|column| column.name == name);
            &found.expect("a column").column
        };
        let quarter = -std::f64::consts::FRAC_PI_2;
        assert_eq!(column("a"), &Column::Number(vec![quarter]));
        assert_eq!(column("b"), &Column::Text(vec!["car".to_owned()]));
        assert_eq!(column("c"), &Column::Flag(vec![true]));
        assert!(matches!(column("d"), Column::Number(drawn) if (2.0..2.5).contains(&drawn[0])));
        assert_eq!(column("e"), &Column::Number(vec![quarter]));
        assert_eq!(column("f"), &Column::Text(vec!["[1, 2]".to_owned()]));
        assert_eq!(column("g"), &Column::Text(vec!["\"007\"".to_owned()]));
        assert_eq!(column("h"), &Column::Number(vec![1.5]));
        assert_eq!(column("i"), &Column::Text(vec!["1".to_owned()]));
    }
}
