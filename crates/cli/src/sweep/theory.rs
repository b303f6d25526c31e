//! `echelon sweep --theory`: what certificates say of the cells of a map, beside what the runs did.

use super::tell::field;
use super::{ShownArgs, StudyArgs};
use crate::failure::Failure;
use crate::interrupt;
use crate::print::say;
use crate::progress::Progress;
use output::write_whole;
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::Path;
use sweeps::{Experiment, StudySummary, TheoryCell, TheoryClaim, agreement, theory};
use vocabulary::counted;

/// Theory is drawn over a map.
pub(super) fn check(experiment: &Experiment) -> Result<(), Failure> {
    if experiment.design().axes().len() == 2 && experiment.study().samples == 1 {
        return Ok(());
    }
    let text = "--theory needs two keys that vary over ranges or lists, such as --vary observer.epsilon=log:0.001..0.1/21 --vary \
        time.period=log:0.002..0.2/21, and no numbers that are drawn: seeds and --scatter are what may differ at random";
    Err(Failure::Usage(text.to_owned()))
}

/// What theory says of every cell.
pub(super) fn ask(experiment: &Experiment, args: &StudyArgs) -> Result<Vec<TheoryCell>, Failure> {
    let cells = experiment.study().cells();
    let progress = Progress::begin(
        &format!("Theory of {}", counted(cells, "cell")),
        cells,
        args.shown.quiet || args.shown.json,
    );
    let said = theory(experiment, |cell| {
        progress.at(cell);
        !interrupt::asked()
    });
    said.ok_or_else(|| {
        Failure::Interrupted("all runs are kept; the same command goes on from there".to_owned())
    })
}

/// In how many cells claims hold, and what runs say.
pub(super) fn json(said: &[TheoryCell], summary: &StudySummary) -> Value {
    let claims = TheoryClaim::ALL.into_iter().map(|claim| {
        let [[both, claimed], [met, neither]] = agreement(claim, said, &summary.cells);
        json!({
            "claim": claim.words(), "holds_and_met": both, "holds_and_unmet": claimed, "fails_and_met": met,
            "fails_and_unmet": neither,
        })
    });
    claims.collect()
}

/// Writes theory.csv, and prints where runs say otherwise.
pub(super) fn keep(
    folder: &Path,
    experiment: &Experiment,
    said: &[TheoryCell],
    summary: &StudySummary,
    args: &ShownArgs,
) -> Result<(), Failure> {
    let mut csv = "cell,".to_owned();
    for parameter in &experiment.study().parameters {
        csv += &field(&parameter.key);
        csv.push(',');
    }
    csv += "growth_per_period,beta_margin,epsilon_margin_s\n";
    let design = experiment.design();
    let number = |value: f64| if value.is_nan() { String::new() } else { value.to_string() };
    for cell in said {
        let values = design.point(cell.cell * design.runs_per_cell()).values;
        let values = values.iter().map(|value| field(value.trim_matches('"'))).collect::<Vec<_>>().join(",");
        let numbers = [cell.growth, cell.beta_margin, cell.epsilon_margin].map(number).join(",");
        // Writing to a text cannot fail.
        let _ = writeln!(csv, "{},{values},{numbers}", cell.cell);
    }
    write_whole(&folder.join("theory.csv"), csv.as_bytes())?;
    if args.quiet || args.json {
        return Ok(());
    }
    if TheoryClaim::ALL.iter().all(|claim| said.iter().all(|cell| claim.holds(cell).is_none())) {
        say("theory says nothing of these cells: its claims are of output feedback, and of β in robust laws");
    }
    for claim in TheoryClaim::ALL {
        let [[both, claimed], [met, neither]] = agreement(claim, said, &summary.cells);
        if both + claimed + met + neither > 0 {
            say(&format!(
                "{}: true in {} of {}, of which {claimed} do not meet their expectations; not in the rest, of which {met} do",
                claim.words(),
                both + claimed,
                counted(both + claimed + met + neither, "cell"),
            ));
        }
    }
    Ok(())
}
