//! What all rows of a study say, cell by cell.

use crate::design::Design;
use crate::interval::wilson;
use crate::measure::MEASURES;
use crate::row::{RowStatus, RunRow};
use serde::Serialize;
use std::collections::BTreeMap;
use vocabulary::Word;

/// The runs of one combination of values that are not drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CellSummary {
    /// The combination, counted from 0.
    pub cell: u64,
    /// Its values, in the order of the study's keys; empty where they are drawn.
    pub values: Vec<String>,
    /// Runs.
    pub runs: u64,
    /// Runs that met everything their scene expects.
    pub met: u64,
    /// The share of these, and the ends of its 95 % interval (Wilson).
    pub share: f64,
    /// Its ends.
    pub interval: [f64; 2],
    /// Runs with contacts.
    pub with_contacts: u64,
    /// Whether it has several runs and all are the same, bit for bit.
    pub alike: bool,
    /// 5 %, 50 % and 95 % of each of the [`MEASURES`], of the runs that have it; NaN where none has. Of settling times those of
    /// all runs, NaN where so many settle by no time.
    pub quantiles: Vec<[f64; 3]>,
}

/// What all rows of a study say.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudySummary {
    /// Cells that have runs, in their order.
    pub cells: Vec<CellSummary>,
    /// Runs.
    pub runs: u64,
    /// Runs that met everything their scene expects.
    pub met: u64,
    /// Ends of the 95 % interval of their share (Wilson).
    pub met_interval: [f64; 2],
    /// Runs with contacts.
    pub with_contacts: u64,
    /// Ends of the 95 % interval of the share without (Wilson).
    pub contact_free_interval: [f64; 2],
    /// Runs by how they ended.
    pub by_status: BTreeMap<&'static str, u64>,
    /// Runs by the expectation that they did not meet first.
    pub by_failure: BTreeMap<String, u64>,
    /// Time that the runs took, s, all together.
    pub wall_time: f64,
    /// The worst runs, first the worst.
    #[serde(skip)]
    pub worst: Vec<RunRow>,
}

/// Gathers rows; those of a cell are in memory until its last is there.
#[derive(Debug)]
pub struct SummaryBuilder<'a> {
    design: &'a Design,
    open: BTreeMap<u64, OpenCell>,
    summary: StudySummary,
    keep: usize,
}

/// A cell of which rows are missing.
#[derive(Debug, Default)]
struct OpenCell {
    runs: u64,
    met: u64,
    with_contacts: u64,
    digest: Option<String>,
    differs: bool,
    values: Vec<String>,
    measures: Vec<Vec<f64>>,
}

impl<'a> SummaryBuilder<'a> {
    /// For the rows of a study; the `keep` worst runs are named.
    pub fn new(design: &'a Design, keep: usize) -> Self {
        let summary = StudySummary {
            cells: vec![],
            runs: 0,
            met: 0,
            met_interval: [0.0, 1.0],
            with_contacts: 0,
            contact_free_interval: [0.0, 1.0],
            by_status: BTreeMap::new(),
            by_failure: BTreeMap::new(),
            wall_time: 0.0,
            worst: vec![],
        };
        Self { design, open: BTreeMap::new(), summary, keep }
    }

    /// Takes in a row.
    pub fn push(&mut self, row: RunRow) {
        let summary = &mut self.summary;
        summary.runs += 1;
        summary.met += u64::from(row.met);
        summary.with_contacts += u64::from(row.contacts > 0);
        summary.wall_time += row.wall_time;
        *summary.by_status.entry(row.status.word()).or_default() += 1;
        if !row.failed.is_empty() {
            *summary.by_failure.entry(row.failed.clone()).or_default() += 1;
        }
        let cell = self.open.entry(row.point.cell).or_default();
        cell.push(&row);
        if cell.runs == self.design.runs_per_cell()
            && let Some(cell) = self.open.remove(&row.point.cell)
        {
            summary.cells.push(cell.close(row.point.cell, self.design));
        }
        let place = summary.worst.partition_point(|other| !worse(&row, other));
        if place < self.keep {
            summary.worst.insert(place, row);
            summary.worst.truncate(self.keep);
        }
    }

    /// What the rows say; cells that lack runs are among them.
    pub fn finish(mut self) -> StudySummary {
        for (number, cell) in std::mem::take(&mut self.open) {
            self.summary.cells.push(cell.close(number, self.design));
        }
        let mut summary = self.summary;
        summary.cells.sort_by_key(|cell| cell.cell);
        summary.met_interval = wilson(summary.met, summary.runs);
        summary.contact_free_interval = wilson(summary.runs - summary.with_contacts, summary.runs);
        summary
    }
}

impl CellSummary {
    /// What the rows of a cell say, in any order; some may be missing.
    pub fn of<'a>(cell: u64, rows: impl IntoIterator<Item = &'a RunRow>, design: &Design) -> Self {
        let mut open = OpenCell::default();
        for row in rows {
            open.push(row);
        }
        open.close(cell, design)
    }
}

impl OpenCell {
    fn push(&mut self, row: &RunRow) {
        self.runs += 1;
        self.met += u64::from(row.met);
        self.with_contacts += u64::from(row.contacts > 0);
        self.values.clone_from(&row.point.values);
        self.differs |= self.digest.as_ref().is_some_and(|digest| *digest != row.digest);
        self.digest.get_or_insert_with(|| row.digest.clone());
        self.measures.resize(MEASURES.len(), vec![]);
        for (all, value) in self.measures.iter_mut().zip(&row.measures) {
            all.extend(value.is_finite().then_some(*value));
        }
    }

    fn close(self, cell: u64, design: &Design) -> CellSummary {
        let mut values = self.values;
        for (value, parameter) in values.iter_mut().zip(&design.study().parameters) {
            if matches!(parameter.values, scene::Values::Drawn { .. }) {
                value.clear();
            }
        }
        let mut measures = self.measures;
        for (all, measure) in measures.iter_mut().zip(&MEASURES) {
            // A run that does not settle settles later than all that do.
            if measure.column == SETTLING {
                all.resize(self.runs as usize, f64::INFINITY);
            }
        }
        CellSummary {
            cell,
            values,
            runs: self.runs,
            met: self.met,
            share: self.met as f64 / self.runs.max(1) as f64,
            interval: wilson(self.met, self.runs),
            with_contacts: self.with_contacts,
            // What did not run has no digest.
            alike: self.runs > 1 && !self.differs && self.digest.is_some_and(|digest| !digest.is_empty()),
            quantiles: measures.into_iter().map(quantiles).collect(),
        }
    }
}

/// The measure that a run has only if it settles.
const SETTLING: &str = "settling_time_s";

/// 5 %, 50 % and 95 % of some values, between two values in proportion; NaN of none.
fn quantiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [0.05, 0.5, 0.95].map(|share| {
        let Some(last) = values.len().checked_sub(1) else { return f64::NAN };
        let place = share * last as f64;
        let (low, within) = (place.floor(), place.fract());
        let [a, b] = [low as usize, (low as usize + 1).min(last)].map(|k| values[k]);
        // Of a run that never settles nothing is in proportion.
        let value = if within == 0.0 { a } else { a + within * (b - a) };
        if value.is_finite() { value } else { f64::NAN }
    })
}

/// Whether one run is worse than another: one that broke off before one that touched before one that missed an expectation, the
/// earlier the worse; then the larger late error.
fn worse(a: &RunRow, b: &RunRow) -> bool {
    let rank = |row: &RunRow| match row.status {
        RowStatus::Panicked => 5,
        RowStatus::Broken | RowStatus::Expired => 4,
        RowStatus::Refused => 3,
        RowStatus::Complete | RowStatus::Stopped => {
            if row.contacts > 0 {
                2
            } else {
                u8::from(!row.met)
            }
        }
    };
    let late = |row: &RunRow| {
        let of = |column| {
            MEASURES.iter().position(|m| m.column == column).map_or(0.0, |index| row.measures[index])
        };
        let error = of("late_distance_error_m");
        if error.is_nan() { f64::INFINITY } else { error }
    };
    let time = |row: &RunRow| if row.failed_time.is_nan() { f64::INFINITY } else { row.failed_time };
    let order = rank(b).cmp(&rank(a)).then(time(a).total_cmp(&time(b))).then(late(b).total_cmp(&late(a)));
    order.then(a.point.index.cmp(&b.point.index)).is_lt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::{Study, StudyParameter};

    fn row(design: &Design, index: u64, met: bool) -> RunRow {
        let mut row = RunRow::of(design.point(index), RowStatus::Complete, String::new());
        row.met = met;
        row.measures = vec![index as f64; MEASURES.len()];
        if !met {
            "no_contact".clone_into(&mut row.failed);
            (row.contacts, row.failed_time) = (1, 10.0 - index as f64);
        }
        row
    }

    #[test]
    fn cells_are_told_apart_and_the_worst_runs_come_first() {
        let parameters =
            vec![StudyParameter { key: "law.k".to_owned(), values: "1,2".parse().expect("values") }];
        let design = Design::new(Study { parameters, seeds: 10, ..Study::of_scene("circle-three", "t") });
        let mut builder = SummaryBuilder::new(&design, 2);
        // In any order.
        for index in (0..20).rev() {
            builder.push(row(&design, index, index % 5 != 0));
        }
        let summary = builder.finish();
        assert_eq!((summary.runs, summary.met, summary.with_contacts), (20, 16, 4));
        assert_eq!(summary.by_failure, BTreeMap::from([("no_contact".to_owned(), 4)]));
        let [one, two] = &summary.cells[..] else { panic!("{:?}", summary.cells) };
        assert_eq!((one.values.clone(), two.values.clone()), (vec!["1".to_owned()], vec!["2".to_owned()]));
        assert_eq!((one.runs, one.met, one.share), (10, 8, 0.8));
        let [low, middle, high] = two.quantiles[0];
        assert!(
            (low - 10.45).abs() < 1e-9 && middle == 14.5 && (high - 18.55).abs() < 1e-9,
            "{:?}",
            two.quantiles[0]
        );
        let worst: Vec<u64> = summary.worst.iter().map(|row| row.point.index).collect();
        assert_eq!(worst, [15, 10]);
    }

    #[test]
    fn what_no_run_has_is_no_number() {
        assert!(quantiles(vec![]).iter().all(|value| value.is_nan()));
        assert_eq!(quantiles(vec![3.0]), [3.0; 3]);
        let never = f64::INFINITY;
        assert_eq!(quantiles(vec![never, 1.0, 3.0, never, 2.0])[1], 3.0);
        assert!(quantiles(vec![1.0, 2.0, never, never])[1].is_nan());
    }

    /// Most runs of the first cell never settle; the second has several seeds and one run.
    #[test]
    fn runs_that_never_settle_count_and_those_that_are_alike_are_told() {
        let parameters =
            vec![StudyParameter { key: "law.k".to_owned(), values: "1,2".parse().expect("values") }];
        let design = Design::new(Study { parameters, seeds: 3, ..Study::of_scene("circle-three", "t") });
        let settling = MEASURES.iter().position(|measure| measure.column == SETTLING).expect("a measure");
        let cell = |cell: u64, times: [f64; 3], digests: [&str; 3]| {
            let rows: Vec<RunRow> = (0..3)
                .map(|seed| {
                    let mut row = row(&design, 3 * cell + seed as u64, true);
                    row.measures[settling] = times[seed];
                    row.digest = digests[seed].to_owned();
                    row
                })
                .collect();
            CellSummary::of(cell, &rows, &design)
        };
        let rare = cell(0, [4.0, f64::NAN, f64::NAN], ["a", "b", "a"]);
        assert!(rare.quantiles[settling][1].is_nan() && !rare.alike, "{rare:?}");
        let usual = cell(1, [4.0, 5.0, f64::NAN], ["a", "a", "a"]);
        assert!(usual.quantiles[settling][1] == 5.0 && usual.alike, "{usual:?}");
        assert!(!cell(1, [4.0; 3], ["", "", ""]).alike, "nothing has run");
    }
}
