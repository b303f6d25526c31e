//! What is made of the rows of a study: table, figures, films, report.

use super::ShownArgs;
use super::tell;
use crate::failure::Failure;
use crate::film;
use crate::load::build;
use figures::{MapLine, Stroke};
use footage::{DrawJob, FilmJob, PictureOptions};
use output::write_whole;
use report::{Rasterizer, Report, ReportFigure, ReportFilm};
use serde::{Deserialize, Serialize};
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
    let lines = kept_lines(folder, lines)?;
    let charts = charts(experiment.design(), &summary, &lines);
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

/// A line over a map as `lines.json` has it.
#[derive(Serialize, Deserialize)]
struct KeptLine {
    name: String,
    dashes: Dashes,
    stretches: Vec<Vec<[f64; 2]>>,
    ticks: Vec<[[f64; 2]; 2]>,
}

/// How it is drawn.
#[derive(Serialize, Deserialize, Clone, Copy)]
#[serde(rename_all = "lowercase")]
enum Dashes {
    Solid,
    Dashed,
    Dotted,
}

impl KeptLine {
    fn of(line: &MapLine) -> Self {
        let finite = |point: &&[f64; 2]| point.iter().all(|number| number.is_finite());
        let stretches = line.points.split(|point| !finite(&point)).filter(|stretch| !stretch.is_empty());
        Self {
            name: line.name.clone(),
            dashes: match line.stroke {
                Stroke::Dashed => Dashes::Dashed,
                Stroke::Dotted => Dashes::Dotted,
                _ => Dashes::Solid,
            },
            stretches: stretches.map(<[_]>::to_vec).collect(),
            ticks: line.ticks.clone(),
        }
    }

    fn line(self) -> MapLine {
        let stretches = self.stretches.into_iter();
        MapLine {
            name: self.name,
            stroke: match self.dashes {
                Dashes::Solid => Stroke::Solid,
                Dashes::Dashed => Stroke::Dashed,
                Dashes::Dotted => Stroke::Dotted,
            },
            points: stretches.flat_map(|stretch| stretch.into_iter().chain([[f64::NAN; 2]])).collect(),
            ticks: self.ticks,
        }
    }
}

/// Lines that stay with the study: `lines.json` has those of all commands so far, of which a new one takes the place of the one with
/// its name.
fn kept_lines(folder: &Path, new: &[MapLine]) -> Result<Vec<MapLine>, Failure> {
    let file = folder.join("lines.json");
    let before = fs::read(&file).ok().and_then(|text| serde_json::from_slice::<Vec<KeptLine>>(&text).ok());
    let before = before.unwrap_or_default().into_iter().map(KeptLine::line);
    let mut lines: Vec<MapLine> =
        before.filter(|line| new.iter().all(|other| other.name != line.name)).collect();
    lines.extend(new.iter().cloned());
    if !new.is_empty() {
        let kept: Vec<KeptLine> = lines.iter().map(KeptLine::of).collect();
        let text = serde_json::to_vec(&kept).map_err(|error| Failure::Machine(error.to_string()))?;
        write_whole(&file, &text)?;
    }
    Ok(lines)
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
