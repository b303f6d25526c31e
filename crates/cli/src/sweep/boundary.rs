//! `echelon sweep --boundary`: only the runs that it takes to find where the answer changes.

use super::tell::SweepEffort;
use super::{StudyArgs, keep};
use crate::failure::Failure;
use crate::print::say;
use figures::MapLine;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;
use sweeps::{BoundarySearch, Experiment, RunRow, StudyFolder, edge_line, for_every_row};
use vocabulary::counted;

/// Where the answer changes.
pub(super) struct FoundEdge {
    /// Neighbouring cells, first the one whose runs meet their expectations.
    pairs: Vec<[u64; 2]>,
    /// Cells that were run.
    cells: u64,
    /// As a line over a map.
    pub(super) line: Option<MapLine>,
}

/// Pairs that are printed.
const MOST_PAIRS: usize = 12;

/// Runs of a cell, and how many of them met their expectations.
#[derive(Default)]
struct CellTally {
    runs: u64,
    met: u64,
}

/// The search over the keys of a study.
pub(super) fn of(experiment: &Experiment) -> Result<BoundarySearch, Failure> {
    let boundary = BoundarySearch::new(experiment.design()).filter(|_| experiment.study().samples == 1);
    boundary.ok_or_else(|| {
        let text = "--boundary needs one or two keys that vary over ranges or lists, such as --vary law.k=1..10/129, and no \
            numbers that are drawn: seeds and --scatter are what may differ at random";
        Failure::Usage(text.to_owned())
    })
}

/// Makes the runs of the cells around the edge.
pub(super) fn search(
    experiment: &Experiment,
    folder: &Path,
    study: &mut StudyFolder,
    args: &StudyArgs,
    effort: &mut SweepEffort,
) -> Result<FoundEdge, Failure> {
    let design = experiment.design();
    let mut boundary = of(experiment)?;
    let mut tallies: BTreeMap<u64, CellTally> = BTreeMap::new();
    let count = |tallies: &mut BTreeMap<u64, CellTally>, row: &RunRow| {
        let tally = tallies.entry(row.point.cell).or_default();
        tally.runs += 1;
        tally.met += u64::from(row.met);
    };
    for_every_row(folder, experiment, |row| count(&mut tallies, &row))?;
    let each = design.runs_per_cell();
    loop {
        let wanted = boundary.wanted();
        if wanted.is_empty() {
            break;
        }
        let runs = wanted.iter().flat_map(|cell| cell * each..(cell + 1) * each);
        let missing: Vec<u64> = runs.filter(|index| !study.done().contains(*index)).collect();
        let many = missing.len() as u64;
        keep(experiment, missing.into_iter(), many, study, args, effort, |row| count(&mut tallies, row))?;
        study.flush()?;
        for cell in wanted {
            let met = tallies.get(&cell).is_some_and(|tally| 2 * tally.met > tally.runs);
            boundary.answer(cell, met);
        }
    }
    let pairs = boundary.edge();
    Ok(FoundEdge { line: edge_line(design, &pairs), cells: boundary.len(), pairs })
}

impl FoundEdge {
    /// Values on both sides of it, first those whose runs meet their expectations.
    pub(super) fn json(&self, experiment: &Experiment) -> Value {
        let design = experiment.design();
        let values = |cell: &u64| design.point(cell * design.runs_per_cell()).values;
        self.pairs.iter().map(|[met, unmet]| json!({ "met": values(met), "unmet": values(unmet) })).collect()
    }

    /// Prints where the edge is, and what it saved.
    pub(super) fn tell(&self, experiment: &Experiment) {
        let (design, study) = (experiment.design(), experiment.study());
        let (runs, all) = (self.cells * design.runs_per_cell(), study.runs());
        say(&format!(
            "{} in {} of {} cells instead of {all}: {:.1} times fewer",
            counted(runs, "run"),
            self.cells,
            study.cells(),
            all as f64 / runs.max(1) as f64
        ));
        if self.pairs.is_empty() {
            say(
                "all cells that were run answer alike: there is no edge, or one that is thinner than a quarter of the range",
            );
        }
        for [met, unmet] in self.pairs.iter().take(MOST_PAIRS) {
            let values = |cell: u64| design.point(cell * design.runs_per_cell()).values;
            let (met, unmet) = (values(*met), values(*unmet));
            let keys = study.parameters.iter().zip(met.iter().zip(&unmet));
            let words: Vec<String> = keys
                .map(|(parameter, (met, unmet))| {
                    if met == unmet {
                        format!("{} = {met}", parameter.key)
                    } else {
                        format!("{} between {met} (met) and {unmet}", parameter.key)
                    }
                })
                .collect();
            say(&format!("edge: {}", words.join(", ")));
        }
        if self.pairs.len() > MOST_PAIRS {
            say(&format!("… {} in all", counted(self.pairs.len(), "pair")));
        }
    }
}
