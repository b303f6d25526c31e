//! What theory says of the cells of a study, to be held against what its runs did.

use crate::chart::edge_line;
use crate::design::Design;
use crate::experiment::Experiment;
use crate::summary::CellSummary;
use figures::{MapLine, Stroke};
use scene::Scene;
use studies::SceneRun;
use studies::certify::{Discretisation, Statement, beyond, certificates};
use vocabulary::TimeMode;

/// What theory says of a cell, by its first run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TheoryCell {
    /// The cell.
    pub cell: u64,
    /// By how much the slowest part of a sampled loop shrinks in a period near its set point, the largest of all followers and
    /// channels: stable below 1. NaN in continuous time, and where nobody follows by output feedback.
    pub growth: f64,
    /// The least room that Lemma 4.1 leaves β in the run, of all followers; NaN where it says nothing.
    pub beta_margin: f64,
    /// The least room that ε has below ε₁, s.
    pub epsilon_margin: f64,
}

/// What theory claims of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TheoryClaim {
    /// The sampled loop is stable near its set point.
    Stable,
    /// β is as large as Lemma 4.1 wants it.
    RobustGain,
    /// ε is at most ε₁ (eqs 44-46).
    SmallEpsilon,
}

impl TheoryClaim {
    /// All of them, in the order in which they are drawn.
    pub const ALL: [Self; 3] = [Self::Stable, Self::RobustGain, Self::SmallEpsilon];

    /// What it is, in a few words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Stable => "sampled loop stable",
            Self::RobustGain => "β of Lemma 4.1",
            Self::SmallEpsilon => "ε ≤ ε₁",
        }
    }

    fn stroke(self) -> Stroke {
        match self {
            Self::Stable => Stroke::Solid,
            Self::RobustGain => Stroke::Dashed,
            Self::SmallEpsilon => Stroke::Dotted,
        }
    }

    /// Whether it holds in a cell; `None` where theory says nothing.
    pub fn holds(self, cell: &TheoryCell) -> Option<bool> {
        let margin = match self {
            Self::Stable => 1.0 - cell.growth,
            Self::RobustGain => cell.beta_margin,
            Self::SmallEpsilon => cell.epsilon_margin,
        };
        (!margin.is_nan()).then_some(margin > 0.0)
    }
}

/// What theory says of every cell of a study; `None` where `go_on`, which gets the number of cells so far, says no.
/// The first run of each cell is made for it once more.
pub fn theory(experiment: &Experiment, mut go_on: impl FnMut(u64) -> bool) -> Option<Vec<TheoryCell>> {
    let design = experiment.design();
    let mut cells = vec![];
    for cell in 0..design.study().cells() {
        let silent = TheoryCell { cell, growth: f64::NAN, beta_margin: f64::NAN, epsilon_margin: f64::NAN };
        let scene = experiment.scene(&design.point(cell * design.runs_per_cell()));
        let said = match scene.map(|scene| said_of(scene, cell, || go_on(cell))) {
            Ok(said) => said?,
            Err(_) => silent,
        };
        cells.push(said);
    }
    go_on(design.study().cells()).then_some(cells)
}

fn said_of(scene: Scene, cell: u64, mut go_on: impl FnMut() -> bool) -> Option<TheoryCell> {
    let mut said =
        TheoryCell { cell, growth: growth(&scene), beta_margin: f64::NAN, epsilon_margin: f64::NAN };
    // What cannot be built, or breaks off, proves nothing.
    let Ok(run) = SceneRun::new(scene) else { return Some(said) };
    let Ok(certificates) = certificates(run, |_| go_on()) else { return Some(said) };
    for certificate in certificates? {
        let margin = |statement| certificate.finding(statement).and_then(|finding| finding.margin);
        said.beta_margin = said.beta_margin.min(margin(Statement::RobustGain).unwrap_or(f64::NAN));
        said.epsilon_margin = said.epsilon_margin.min(margin(Statement::Epsilon).unwrap_or(f64::NAN));
    }
    Some(said)
}

fn growth(scene: &Scene) -> f64 {
    let how = match scene.time.mode {
        TimeMode::Continuous => return f64::NAN,
        TimeMode::Sampled => Discretisation::Exact,
        TimeMode::Measured => Discretisation::Ramp,
    };
    let period = scene.time.period;
    scene
        .followers()
        .filter_map(|(_, follow)| {
            let growths = beyond::channels(follow)?
                .into_iter()
                .zip(follow.observer.epsilon)
                .map(|(channel, epsilon)| channel.growth(how, epsilon, period));
            Some(growths.fold(0.0, f64::max))
        })
        .fold(f64::NAN, f64::max)
}

/// Where claims begin and cease to hold, as lines over the map of a study over two keys, with ticks on the side on which they hold.
pub fn theory_lines(design: &Design, cells: &[TheoryCell]) -> Vec<MapLine> {
    TheoryClaim::ALL.into_iter().filter_map(|claim| line_of(design, cells, claim)).collect()
}

fn line_of(design: &Design, cells: &[TheoryCell], claim: TheoryClaim) -> Option<MapLine> {
    let holds =
        |places: &[u64]| cells.get(design.cell_at(places) as usize).and_then(|cell| claim.holds(cell));
    let mut pairs = vec![];
    for cell in cells {
        let places = design.places(cell.cell);
        for (axis, along) in design.axes().iter().enumerate() {
            let mut next = places.clone();
            next[axis] += 1;
            if next[axis] < along.len && holds(&places) != holds(&next) {
                let pair = [cell.cell, design.cell_at(&next)];
                pairs.push(if holds(&places) == Some(true) { pair } else { [pair[1], pair[0]] });
            }
        }
    }
    let line = edge_line(design, &pairs).filter(|_| !pairs.is_empty())?;
    Some(MapLine { name: claim.words().to_owned(), stroke: claim.stroke(), ..line })
}

/// Cells in which a claim holds and most runs meet their expectations, in which it holds and they do not, in which it does not
/// hold and they do, and in which neither is so.
pub fn agreement(claim: TheoryClaim, theory: &[TheoryCell], cells: &[CellSummary]) -> [[u64; 2]; 2] {
    let mut counts = [[0; 2]; 2];
    for cell in cells {
        let Some(holds) = theory.get(cell.cell as usize).and_then(|said| claim.holds(said)) else { continue };
        counts[usize::from(!holds)][usize::from(2 * cell.met <= cell.runs)] += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::{Study, StudyParameter};
    use std::path::PathBuf;

    fn experiment(keys: [&str; 2], set: &[&str]) -> Experiment {
        let parameter = |text: &str| {
            let (key, values) = text.split_once('=').expect("KEY=VALUES");
            StudyParameter { key: key.to_owned(), values: values.parse().expect("values") }
        };
        let study = Study {
            parameters: keys.map(parameter).to_vec(),
            set: set.iter().map(|text| text.parse().expect("an override")).collect(),
            ..Study::of_scene("line-three", "theory")
        };
        let text = scene::shipped("line-three").expect("a shipped scene").text;
        Experiment::of_text(study, text, PathBuf::from("line-three.toml")).expect("an experiment")
    }

    /// For line-three `echelon certify` prints stable up to 135 ms at the paper's ε, and a margin of -2.67 with β = 0.3.
    #[test]
    fn theory_of_a_cell_is_what_certify_prints() {
        let short = ["time.duration=2"];
        let periods = experiment(["observer.epsilon=0.001,0.01", "time.period=0.13,0.14"], &short);
        let cells = theory(&periods, |_| true).expect("to the end");
        let stable: Vec<_> = cells.iter().map(|cell| TheoryClaim::Stable.holds(cell)).collect();
        assert_eq!(stable[..2], [Some(true), Some(false)], "{cells:?}");
        let lines = theory_lines(periods.design(), &cells);
        assert_eq!(lines[0].name, "sampled loop stable");
        // Between the two periods, halfway.
        assert!(lines[0].points.iter().any(|[_, period]| (period - 0.135).abs() < 1e-12), "{lines:?}");
        let gains = experiment(["law.beta=0.3,5", "law.k=4,5"], &["time.duration=15"]);
        let cells = theory(&gains, |_| true).expect("to the end");
        let margins: Vec<f64> = cells.iter().map(|cell| cell.beta_margin).collect();
        assert!((margins[1] + 2.67).abs() < 0.01 && margins[3] > 0.9, "{margins:?}");
    }

    #[test]
    fn it_ends_where_it_is_told_to() {
        let gains = experiment(["law.beta=0.3,5", "law.k=4,5"], &["time.duration=2"]);
        assert_eq!(theory(&gains, |cell| cell < 2), None);
    }

    #[test]
    fn agreement_counts_all_four_cases() {
        let said =
            |cell: u64, growth: f64| TheoryCell { cell, growth, beta_margin: 1.0, epsilon_margin: f64::NAN };
        let theory: Vec<TheoryCell> =
            [0.9, 0.9, 1.1, 1.1, f64::NAN].into_iter().enumerate().map(|(k, g)| said(k as u64, g)).collect();
        let experiment = experiment(["law.beta=1,2,3,4,5", "law.k=4,5"], &[]);
        let design = experiment.design();
        let cells: Vec<CellSummary> = [1, 0, 1, 0, 1]
            .into_iter()
            .enumerate()
            .map(|(k, met)| CellSummary { runs: 1, met, ..CellSummary::of(k as u64, [], design) })
            .collect();
        assert_eq!(agreement(TheoryClaim::Stable, &theory, &cells), [[1, 1], [1, 1]]);
        assert_eq!(agreement(TheoryClaim::SmallEpsilon, &theory, &cells), [[0, 0], [0, 0]]);
    }
}
