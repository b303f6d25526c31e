//! What is made of the rows of a study: table, figures, films, report.

use super::ShownArgs;
use super::tell;
use crate::failure::Failure;
use crate::film;
use crate::load::build;
use figures::MapLine;
use footage::{DrawJob, FilmJob, PictureOptions};
use output::write_whole;
use report::{Rasterizer, Report, ReportFigure, ReportFilm};
use std::fs;
use std::path::Path;
use studies::{PROGRAM, RecordSource};
use sweeps::{Experiment, RunRow, StudySummary, SummaryBuilder, charts, for_every_row};

/// Runs that the report names.
const WORST: usize = 10;

/// Reads all rows of the study in `folder` and writes what is made of them.
pub(super) fn complete(
    folder: &Path,
    experiment: &Experiment,
    args: &ShownArgs,
    whole: bool,
    lines: &[MapLine],
) -> Result<StudySummary, Failure> {
    let keep = WORST.max(usize::from(args.film_worst));
    let mut builder = SummaryBuilder::new(experiment.design(), keep);
    for_every_row(folder, experiment, |row| builder.push(row))?;
    let summary = builder.finish();
    if !whole {
        return Ok(summary);
    }
    write_whole(&folder.join("summary.csv"), tell::csv(experiment, &summary).as_bytes())?;
    let charts = charts(experiment.design(), &summary, lines);
    let figures = folder.join("figures");
    fs::create_dir_all(&figures).map_err(output::Error::io("create", &figures))?;
    let rasterizer = Rasterizer::new(&[rendering::FONT]);
    for chart in &charts {
        write_whole(&figures.join(format!("{}.svg", chart.stem)), chart.svg.as_bytes())?;
        let pdf = rasterizer.pdf(&chart.svg).map_err(|error| Failure::Machine(error.to_string()))?;
        write_whole(&figures.join(format!("{}.pdf", chart.stem)), &pdf)?;
    }
    let films = films(folder, experiment, &summary.worst, args)?;
    let study = experiment.study();
    let report = Report {
        title: study.title.clone(),
        lead: tell::lead(experiment, &summary),
        items: charts
            .into_iter()
            .map(|chart| ReportFigure::new(chart.stem, chart.caption, chart.svg, String::new()))
            .collect(),
        films,
        tables: tell::tables(experiment, &summary),
        left_out: vec![],
        versions: vec![
            ["Program".to_owned(), PROGRAM.to_owned()],
            ["Study".to_owned(), experiment.fingerprint().to_owned()],
        ],
    };
    write_whole(&folder.join("report.html"), report::page(&report, rendering::FONT).as_bytes())?;
    Ok(summary)
}

/// Films of the worst runs.
fn films(
    folder: &Path,
    experiment: &Experiment,
    worst: &[RunRow],
    args: &ShownArgs,
) -> Result<Vec<ReportFilm>, Failure> {
    let mut films = vec![];
    let place = folder.join("films");
    for row in worst.iter().take(usize::from(args.film_worst)) {
        let Ok(scene) = experiment.scene(&row.point) else { continue };
        fs::create_dir_all(&place).map_err(output::Error::io("create", &place))?;
        let file = format!("run-{}.mp4", row.point.index);
        let run = build(scene, &format!("run {}", row.point.index))?;
        let picture = PictureOptions { size: Some([640, 360]), ..PictureOptions::default() };
        let draw = DrawJob::of(Path::new(&experiment.study().scene), &run, &args.adapter.name, picture);
        let job = FilmJob { fresh: true, ..FilmJob::of(&run, draw, &place.join(&file)) };
        film::shoot(job, true, false, |_| Ok(RecordSource::Run(Box::new(run.simulation))))?;
        let mp4 = fs::read(place.join(&file)).map_err(output::Error::io("read", &place))?;
        films.push(ReportFilm { file, caption: tell::worst_line(row), mp4 });
    }
    Ok(films)
}
