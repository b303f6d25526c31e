//! `echelon sweep`: many runs of a scene, their table, figures and report.

mod boundary;
mod folder;
mod joined;
mod tell;
mod theory;

use crate::args::AdapterArgs;
use crate::failure::Failure;
use crate::load::stem;
use crate::print::note;
use crate::progress::Progress;
use crate::{Outcome, interrupt};
use clap::{Args, Subcommand};
use scene::{
    Diagnostic, Diagnostics, FollowerScatter, Override, Sampling, Scene, Study, StudyFault, StudyParameter,
};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;
use sweeps::{Experiment, Progressed, RowTable, RunRow, StudyFolder, THREAD, run_all};
use vocabulary::{Word, counted};

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct SweepArgs {
    #[command(subcommand)]
    command: Option<SweepCommands>,
    #[command(flatten)]
    study: StudyArgs,
}

#[derive(Debug, Subcommand)]
enum SweepCommands {
    /// Put the shards of a study together
    Merge(joined::MergeArgs),
    /// Print the table of a study that was run before, and draw its figures anew
    Show(joined::ShowArgs),
}

#[derive(Debug, Args)]
struct StudyArgs {
    /// Study file, scene file, or the name of a shipped scene
    #[arg(value_name = "STUDY|SCENE", required = true)]
    subject: Option<PathBuf>,
    /// Vary a key: a range with its number of values, such as law.k=1..10/19 or observer.epsilon=log:0.001..0.1/13; a list,
    /// a=1,2,5 or a=zip:1,2,5; a distribution, a=uniform:0..1, a=log-uniform:0.001..0.1 or a=normal:MEAN,DEVIATION; or a==KEY
    /// for what another key is. May be repeated: there is a run for every combination
    #[arg(long, value_name = "KEY=VALUES", value_parser = varied)]
    vary: Vec<StudyParameter>,
    /// Override a value of all runs, such as time.duration=5; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<Override>,
    /// Runs of every combination, each with a seed of its own
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    seeds: Option<u64>,
    /// How often numbers with a distribution are drawn for every combination of the others
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    samples: Option<u64>,
    /// How they are drawn: independent, latin-hypercube, sobol
    #[arg(long, value_parser = sampling)]
    sampling: Option<Sampling>,
    /// Seed of everything that differs from run to run
    #[arg(long, value_parser = crate::args::seed, allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Start every follower within so many metres of where the scene puts it, with a heading that is off by so much: 0.5 or
    /// "0.5,20 deg"
    #[arg(long, value_name = "M[,ANGLE]", value_parser = scatter)]
    scatter: Option<FollowerScatter>,
    /// Give up a run that takes longer, s; its row says so
    #[arg(long, value_name = "S", value_parser = crate::args::within(0.001..=1e9, "write seconds, such as 10"))]
    limit: Option<f64>,
    /// Make only the runs that it takes to find where the answer changes: `met` is whether most runs of a combination meet
    /// their expectations; over one or two varied keys
    #[arg(long, value_name = "ANSWER", value_parser = ["met"], conflicts_with_all = ["shard", "range"])]
    boundary: Option<String>,
    /// Hold the map over two keys against theory: draw where the sampled loop is stable, where β is as large as Lemma 4.1 wants it
    /// and where ε is below the paper's ε₁, print in how many cells runs say otherwise, and write theory.csv
    #[arg(long, conflicts_with_all = ["shard", "range"])]
    theory: bool,
    /// Make one of N parts of the study, such as 3/16
    #[arg(long, value_name = "I/N", value_parser = shard, conflicts_with = "range")]
    shard: Option<[u64; 2]>,
    /// Make the runs from A on and before B, such as 0..500; with an --out that ends in .parquet, into that file alone
    #[arg(long, value_name = "A..B", value_parser = range)]
    range: Option<Range<u64>>,
    /// Threads; by default one for each core
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Folder of the study; by default sweeps/NAME. One that holds a part of it is gone on with
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace what an earlier study left in the folder
    #[arg(long)]
    force: bool,
    /// Print how many runs there are, and the first of them, and make none
    #[arg(long)]
    dry_run: bool,
    /// Fail, with exit code 1, where a smaller share of the runs meets its expectations, such as 0.99
    #[arg(long, value_name = "SHARE", value_parser = crate::args::within(0.0..=1.0, "write a share from 0 to 1"))]
    met_at_least: Option<f64>,
    #[command(flatten)]
    shown: ShownArgs,
}

/// What is made of rows.
#[derive(Debug, Args)]
struct ShownArgs {
    /// Film so many of the worst runs
    #[arg(long, value_name = "N", default_value_t = 0)]
    film_worst: u16,
    #[command(flatten)]
    adapter: AdapterArgs,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    /// Print errors only
    #[arg(long, short, conflicts_with = "json")]
    quiet: bool,
}

pub(crate) fn sweep(args: &SweepArgs) -> Outcome {
    match &args.command {
        Some(SweepCommands::Merge(args)) => joined::merge(args),
        Some(SweepCommands::Show(args)) => joined::show(args),
        None => run(&args.study),
    }
}

fn varied(text: &str) -> Result<StudyParameter, String> {
    let (key, values) = text.split_once('=').ok_or("write KEY=VALUES, such as law.k=1..10/19")?;
    let values = values.parse().map_err(|error: scene::ValuesError| error.to_string())?;
    Ok(StudyParameter { key: key.trim().to_owned(), values })
}

fn sampling(text: &str) -> Result<Sampling, String> {
    let known = Sampling::WORDS.iter().find(|(word, ..)| *word == text).map(|(_, sampling, _)| *sampling);
    known.ok_or_else(|| {
        let words: Vec<&str> = Sampling::WORDS.iter().map(|(word, ..)| *word).collect();
        format!("write one of {}", words.join(", "))
    })
}

pub(crate) fn scatter(text: &str) -> Result<FollowerScatter, String> {
    let wrong = || "write metres, or metres and an angle, such as 0.5 or \"0.5,20 deg\"".to_owned();
    let (position, heading) = text.split_once(',').unwrap_or((text, "0"));
    let heading = heading.trim();
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| *number >= 0.0);
    let heading = match heading.strip_suffix("deg").or_else(|| heading.strip_suffix('°')) {
        Some(degrees) => number(degrees).map(f64::to_radians),
        None => number(heading),
    };
    let position = number(position).filter(|metres| *metres <= 1000.0).ok_or_else(wrong)?;
    let heading = heading.filter(|angle| *angle <= std::f64::consts::PI + 1e-9).ok_or_else(wrong)?;
    Ok(FollowerScatter { position, heading })
}

fn shard(text: &str) -> Result<[u64; 2], String> {
    let found =
        text.split_once('/').and_then(|(i, n)| Some([i.trim().parse().ok()?, n.trim().parse().ok()?]));
    found
        .filter(|[i, n]| (1..=*n).contains(i))
        .ok_or_else(|| "write I/N with I from 1 to N, such as 3/16".to_owned())
}

fn range(text: &str) -> Result<Range<u64>, String> {
    let found = text.split_once("..").and_then(|(a, b)| Some(a.trim().parse().ok()?..b.trim().parse().ok()?));
    found
        .filter(|range| range.start < range.end)
        .ok_or_else(|| "write A..B with A below B, such as 0..500".to_owned())
}

/// The study of a command line.
fn study_of(args: &StudyArgs, subject: &Path) -> Result<Study, Failure> {
    let is_study = Study::is_meant(subject);
    let mut study = if is_study {
        Study::load(subject).map_err(|errors| Failure::Usage(errors.to_string()))?
    } else {
        Study::of_scene(&subject.display().to_string(), &stem(subject))
    };
    if study.title.is_empty() {
        study.title = stem(subject);
    }
    study.set.extend(args.set.iter().cloned());
    study.parameters.extend(args.vary.iter().cloned());
    study.seeds = args.seeds.unwrap_or(study.seeds).max(1);
    study.samples = args.samples.unwrap_or(study.samples).max(1);
    study.sampling = args.sampling.unwrap_or(study.sampling);
    study.seed = args.seed.unwrap_or(study.seed);
    study.scatter = args.scatter.unwrap_or(study.scatter);
    study.limit = args.limit.or(study.limit);
    Ok(study)
}

/// Faults where they stand: in the file, or on the command line.
fn refusal(subject: &Path, faults: &[StudyFault]) -> Failure {
    let told = Study::is_meant(subject).then(|| Study::located(subject, faults)).flatten();
    let plain = || {
        let line = |fault: &StudyFault| match &fault.key {
            Some(key) => format!("--vary {key}: {}", fault.text),
            None => fault.text.clone(),
        };
        faults.iter().map(line).collect::<Vec<_>>().join("\n")
    };
    Failure::Usage(told.map_or_else(plain, |errors| errors.to_string()))
}

/// Why the scene of a study cannot run: what the study's file says of it is told where it stands there.
fn scene_refusal(study: &Study, subject: &Path, errors: Diagnostics) -> Failure {
    let scene = Path::new(&study.scene);
    let told = |set: &[Override]| Scene::load(scene, set).err();
    let own = Study::load(subject).map_or(0, |file| file.set.len());
    // An error is that of the override with which it comes.
    let key = |error: &Diagnostic| {
        let has = |errors: &Diagnostics| errors.all().iter().any(|other| other.message == error.message);
        (0..own.min(study.set.len()))
            .find(|k| told(&study.set[..=*k]).is_some_and(|errors| has(&errors)))
            .map(|k| format!("set.{k}"))
    };
    let keys: Option<Vec<String>> = if told(&[]).is_none() {
        errors.all().iter().map(key).collect()
    } else {
        // What is wrong with a scene that is there stands in the scene.
        (!scene.exists()).then(|| vec!["scene".to_owned(); errors.all().len()])
    };
    let located = keys.filter(|_| Study::is_meant(subject)).and_then(|keys| {
        let fault =
            |(key, error): (String, &Diagnostic)| StudyFault { key: Some(key), text: error.message.clone() };
        Study::located(subject, &keys.into_iter().zip(errors.all()).map(fault).collect::<Vec<_>>())
    });
    sweeps::Error::Scene(located.unwrap_or(errors)).into()
}

/// The experiment of a study that can run.
fn experiment_of(study: &Study, subject: &Path) -> Result<Experiment, Failure> {
    let told = |error: sweeps::Error| match error {
        sweeps::Error::Study(faults) => refusal(subject, &faults),
        other => other.into(),
    };
    let experiment = Experiment::new(study.clone()).map_err(|error| match error {
        sweeps::Error::Scene(errors) => scene_refusal(study, subject, errors),
        other => told(other),
    })?;
    // What no run could be, all are told at once.
    experiment.check().map_err(told)?;
    Ok(experiment)
}

fn run(args: &StudyArgs) -> Outcome {
    // Required by its declaration.
    let Some(subject) = args.subject.as_deref() else { return Ok(()) };
    let experiment = experiment_of(&study_of(args, subject)?, subject)?;
    let runs = experiment.study().runs();
    let range = match (&args.range, args.shard) {
        (Some(range), _) => range.clone(),
        (None, Some([i, n])) => share(runs, i - 1, n)..share(runs, i, n),
        (None, None) => 0..runs,
    };
    if range.end > runs {
        return Err(Failure::Usage(format!(
            "the study has {}: a range ends at {runs} at most",
            counted(runs, "run")
        )));
    }
    if args.boundary.is_some() {
        boundary::of(&experiment)?;
    }
    if args.theory {
        theory::check(&experiment)?;
    }
    if args.dry_run {
        tell::dry(&experiment, &range, &args.shown);
        return Ok(());
    }
    interrupt::watch();
    quieten();
    if let Some(file) = args.out.as_deref().filter(|out| out.extension().is_some_and(|e| e == "parquet")) {
        return part(&experiment, range, file, args);
    }
    let part = match args.shard {
        Some([i, n]) => format!("-{i}-of-{n}"),
        None => {
            args.range.as_ref().map_or_else(String::new, |range| format!("-{}-{}", range.start, range.end))
        }
    };
    let folder = args.out.clone().unwrap_or_else(|| PathBuf::from("sweeps").join(stem(subject) + &part));
    let mut study = StudyFolder::open(&folder, &experiment, range.clone(), args.force)?;
    if !study.done().is_empty() && !args.shown.quiet {
        let done = study.done().len();
        note(&format!(
            "{} holds {done} of these {} already",
            folder.display(),
            counted(range.end - range.start, "run")
        ));
    }
    let (mut effort, mut edge) = (tell::SweepEffort::default(), None);
    let outcome = if args.boundary.is_some() {
        boundary::search(&experiment, &folder, &mut study, args, &mut effort).map(|found| edge = Some(found))
    } else {
        let missing = study.done().missing(range.clone());
        keep(&experiment, missing.iter(), missing.len(), &mut study, args, &mut effort, |_| ())
    };
    // Whatever went wrong, what was made is kept.
    let flushed = study.flush();
    if let Err(failure) = outcome {
        let (done, all) = (study.done().len(), range.end - range.start);
        return Err(match failure {
            Failure::Interrupted(_) => Failure::Interrupted(format!(
                "{done} of {all} runs are in {}; the same command goes on from there",
                folder.display()
            )),
            other => other.but(&format!("{} keeps {}", folder.display(), counted(done, "run"))),
        });
    }
    flushed?;
    study.finish()?;
    drop(study);
    let mut lines: Vec<figures::MapLine> = edge.iter().filter_map(|edge| edge.line.clone()).collect();
    let said = if args.theory { Some(theory::ask(&experiment, args)?) } else { None };
    lines.extend(said.iter().flat_map(|said| sweeps::theory_lines(experiment.design(), said)));
    let summary = folder::complete(&folder, &experiment, &args.shown, range == (0..runs), &lines)?;
    let mut more = vec![];
    more.extend(edge.iter().map(|edge| ("edge", edge.json(&experiment))));
    more.extend(said.iter().map(|said| ("theory", theory::json(said, &summary))));
    tell::study(&experiment, &summary, &folder, &effort, &args.shown, &more);
    if let Some(edge) = edge.filter(|_| !args.shown.quiet && !args.shown.json) {
        edge.tell(&experiment);
    }
    if let Some(said) = said {
        theory::keep(&folder, &experiment, &said, &summary, &args.shown)?;
    }
    judge(&summary, args.met_at_least)
}

/// The first run of part `i` of `n`.
fn share(runs: u64, i: u64, n: u64) -> u64 {
    u64::try_from(u128::from(runs) * u128::from(i) / u128::from(n)).unwrap_or(runs)
}

fn judge(summary: &sweeps::StudySummary, least: Option<f64>) -> Outcome {
    let share = summary.met as f64 / summary.runs.max(1) as f64;
    match least.filter(|least| share < *least) {
        None => Ok(()),
        Some(least) => {
            note(&format!(
                "{:.2} % of the runs meet their expectations, and {:.2} % are asked for",
                100.0 * share,
                100.0 * least
            ));
            Err(Failure::Expectation)
        }
    }
}

/// One file of rows.
fn part(experiment: &Experiment, range: Range<u64>, file: &Path, args: &StudyArgs) -> Outcome {
    let place = output::Place::file(file)?;
    let (mut rows, mut effort): (Vec<RunRow>, _) = (vec![], tell::SweepEffort::default());
    let count = range.end - range.start;
    let made = make(experiment, range, count, args, &mut effort, |row, _| {
        rows.extend(row);
        Ok(())
    });
    if let Err(Failure::Interrupted(_)) = made {
        return Err(Failure::Interrupted(format!(
            "{} of {count} runs were made, and none is kept",
            rows.len()
        )));
    }
    made?;
    rows.sort_by_key(|row| row.point.index);
    sweeps::write_rows(file, &RowTable::new(experiment.design()), rows.iter(), experiment.fingerprint())?;
    drop(place);
    Ok(())
}

/// Rows are on the disk after so many seconds at the latest.
const UNWRITTEN: f64 = 2.0;

/// Makes runs into a folder; `look` sees each row.
fn keep(
    experiment: &Experiment,
    indices: impl Iterator<Item = u64> + Send,
    count: u64,
    study: &mut StudyFolder,
    args: &StudyArgs,
    effort: &mut tell::SweepEffort,
    mut look: impl FnMut(&RunRow),
) -> Outcome {
    let mut written = 0.0;
    make(experiment, indices, count, args, effort, |row, time| {
        if let Some(row) = row {
            look(&row);
            study.push(row)?;
        }
        if time > written + UNWRITTEN {
            study.flush()?;
            written = time;
        }
        Ok(())
    })
}

/// Makes runs; `take` gets each row, or none after some time in which no run ended, and for how long runs have been made, s.
fn make(
    experiment: &Experiment,
    indices: impl Iterator<Item = u64> + Send,
    count: u64,
    args: &StudyArgs,
    effort: &mut tell::SweepEffort,
    mut take: impl FnMut(Option<RunRow>, f64) -> Outcome,
) -> Outcome {
    if count == 0 {
        return Ok(());
    }
    let cores = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let threads = args.threads.map_or_else(cores, usize::from);
    let what = format!("{} of {}", counted(count, "run"), experiment.study().title);
    let progress = Progress::begin(&what, count, args.shown.quiet || args.shown.json);
    let (began, mut made, mut unmet) = (Instant::now(), 0, 0_u64);
    let clock = || began.elapsed().as_secs_f64();
    run_all(experiment, indices, threads, &clock, |event| {
        let row = if let Progressed::Ended(row) = event { Some(row) } else { None };
        if let Some(row) = &row {
            made += 1;
            unmet += u64::from(!row.met);
            if unmet > 0 {
                progress.says(&what, &format!("{unmet} unmet"));
            }
            progress.at(made);
        }
        take(row, clock())?;
        Ok::<bool, Failure>(!interrupt::asked())
    })?;
    effort.runs += made;
    effort.wall += clock();
    if made == count {
        return Ok(());
    }
    Err(if interrupt::asked() {
        Failure::Interrupted(String::new())
    } else {
        Failure::Machine(
            "the system gives no threads to make runs; close other programs, or raise its limit".to_owned(),
        )
    })
}

/// Panics of runs are rows of the table, and not printed besides.
fn quieten() {
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !std::thread::current().name().is_some_and(|name| name.starts_with(THREAD)) {
            before(panic);
        }
    }));
}
