//! `echelon laws`: custom laws that come with the program, and what a law file or a module is and does.

use crate::Outcome;
use crate::failure::Failure;
use crate::load::read;
use crate::print::{json, note, say, verbatim};
use clap::{Args, Subcommand};
use laws::{CustomLaw, Declaration, Knowledge, LawFile, Parameter, SHIPPED_LAWS, Scale, TEMPLATE, shipped};
use scene::{Diagnostic, Diagnostics, WrittenLaw, load_law};
use serde_json::{Value, json};
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use studies::{LoopEnd, Pole, SteadyLeaders, close};
use vocabulary::{counted, math};

#[derive(Debug, Args)]
pub(crate) struct LawsArgs {
    #[command(subcommand)]
    what: Option<LawsCommand>,
    /// Print as JSON
    #[arg(long, global = true)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum LawsCommand {
    /// List the laws that come with the program (the default)
    List,
    /// Print the text of a law: echelon laws show integral > mine.law
    Show {
        /// The name of a law that comes with the program, or a scene whose followers have a custom law
        #[arg(value_name = "LAW")]
        name: String,
    },
    /// Say what is wrong with law files and WebAssembly modules, or what they declare
    Check {
        /// Law files, modules, or names of laws that come with the program
        #[arg(value_name = "LAW", required = true)]
        laws: Vec<PathBuf>,
    },
    /// Write a law to start from
    New {
        /// The file; it must not be there yet
        #[arg(value_name = "FILE")]
        file: PathBuf,
    },
    /// Let one unicycle follow by a law, and print where it settles and the poles of the loop there
    Test(TestArgs),
}

#[derive(Debug, Args)]
struct TestArgs {
    /// A law file, a module, or the name of a law that comes with the program
    #[arg(value_name = "LAW")]
    law: PathBuf,
    /// Set a parameter, such as k=3
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Wanted distance from every leader, m
    #[arg(long, value_name = "METRES", default_value_t = 2.0)]
    distance: f64,
    /// Wanted bearing from the leader, degrees; by default -135. Behind several leaders its place decides
    #[arg(long, value_name = "DEGREES", value_parser = degrees, allow_hyphen_values = true)]
    bearing: Option<f64>,
    /// Speed of the leaders, m/s
    #[arg(long, value_name = "M/S", default_value_t = 1.0)]
    speed: f64,
    /// Their turn rate, rad/s
    #[arg(long, value_name = "RAD/S", default_value_t = 0.0, allow_negative_numbers = true)]
    turn_rate: f64,
    /// Control period, s
    #[arg(long, value_name = "SECONDS", default_value_t = 0.01)]
    period: f64,
}

pub(crate) fn laws(args: &LawsArgs) -> Outcome {
    match &args.what {
        None | Some(LawsCommand::List) => {
            list(args.json);
            Ok(())
        }
        Some(LawsCommand::Show { name }) => show(name),
        Some(LawsCommand::Check { laws }) => check(laws, args.json),
        Some(LawsCommand::New { file }) => new(file),
        Some(LawsCommand::Test(test)) => self::test(test, args.json),
    }
}

fn list(as_json: bool) {
    let declared = SHIPPED_LAWS.iter().filter_map(|law| {
        let compiled = LawFile::compile(law.text).ok()?;
        Some((law.name, compiled.declaration().clone()))
    });
    if as_json {
        let law = |(name, declaration): (&str, Declaration)| {
            let mut found = declared_json(&declaration);
            found["name"] = json!(name);
            found
        };
        return json(&declared.map(law).collect());
    }
    let widest = SHIPPED_LAWS.iter().map(|law| law.name.len()).max().unwrap_or(0);
    for (name, declaration) in declared {
        say(&format!("{name:widest$}  {}; {}", declaration.title, known(&declaration)));
    }
}

/// What a law has to know, in words.
fn known(declaration: &Declaration) -> String {
    let leaders = counted(declaration.leaders, "leader");
    let knows = match declaration.knows {
        Knowledge::Output => "knows distance and bearing",
        Knowledge::Rates => "knows true rates, too",
        Knowledge::Motion => "knows the leader's motion, too",
    };
    if declaration.leaders == 1 { knows.to_owned() } else { format!("{leaders}, {knows}") }
}

fn declared_json(declaration: &Declaration) -> Value {
    let parameter = |own: &Parameter| {
        json!({
            "name": own.name, "symbol": own.symbol, "unit": own.unit_name, "default": own.default,
            "range": own.range, "logarithmic": own.scale == Scale::Logarithmic, "help": own.help,
        })
    };
    let quantity = |own: &laws::Quantity| json!({ "name": own.name, "unit": own.unit.to_string() });
    json!({
        "title": declaration.title, "leaders": declaration.leaders,
        "knows": match declaration.knows {
            Knowledge::Output => "output",
            Knowledge::Rates => "rates",
            Knowledge::Motion => "motion",
        },
        "continuous": declaration.continuous,
        "parameters": declaration.parameters.iter().map(parameter).collect::<Vec<_>>(),
        "memory": declaration.memory.iter().map(quantity).collect::<Vec<_>>(),
        "shown": declaration.shown.iter().map(quantity).collect::<Vec<_>>(),
    })
}

fn show(name: &str) -> Outcome {
    if let Some(law) = shipped(name) {
        verbatim(law.text);
        return Ok(());
    }
    if Path::new(name).is_file() {
        return show_of_scene(Path::new(name));
    }
    let names: Vec<&str> = SHIPPED_LAWS.iter().map(|law| law.name).collect();
    let text = format!("no law called `{name}` comes with the program; there are {}", names.join(", "));
    Err(Failure::Usage(text))
}

/// The text of the law of a scene's followers: what was written in the lab, as a file of its own.
fn show_of_scene(path: &Path) -> Outcome {
    let scene = read(path, &[])?;
    let mut texts: Vec<(&str, &str)> = vec![];
    for (follower, follow) in scene.followers() {
        if let Some(text) = follow.law.custom().and_then(WrittenLaw::text)
            && !texts.iter().any(|(_, known)| *known == text)
        {
            texts.push((follower, text));
        }
    }
    let path = path.display();
    match texts[..] {
        [(_, text)] => {
            verbatim(&format!("{}\n", text.trim_end()));
            Ok(())
        }
        [] => Err(Failure::Usage(format!("{path}: no follower has a law file or a law as text"))),
        [(first, _), (second, _), ..] => Err(Failure::Usage(format!(
            "{path}: its followers have different laws, those of `{first}` and `{second}` among them: copy the one that \
             you want out of `echelon check {path} --resolved`"
        ))),
    }
}

fn check(paths: &[PathBuf], as_json: bool) -> Outcome {
    let (mut problems, mut all) = (vec![], vec![]);
    for path in paths {
        let mut found = match read_law(path) {
            Ok(law) if as_json => declared_json(law.declaration()),
            Ok(law) => {
                tell(path, law.declaration());
                continue;
            }
            Err(mistakes) => {
                problems.push(mistakes.to_string());
                mistakes_json(&mistakes)
            }
        };
        found["law"] = json!(path.display().to_string());
        all.push(found);
    }
    if as_json {
        json(&all.into());
    }
    if problems.is_empty() { Ok(()) } else { Err(Failure::Usage(problems.join("\nerror: "))) }
}

/// A law; what is a scene is not taken for the text of one.
fn read_law(path: &Path) -> Result<WrittenLaw, Diagnostics> {
    let law = load_law(path);
    let is_scene = path.extension().is_some_and(|extension| extension == "toml");
    let hint =
        "is a scene, not a law: `echelon check` checks scenes, and `echelon laws show` prints the law of one";
    law.map_err(
        |mistakes| if is_scene && path.is_file() { Diagnostics::of_file(path, hint) } else { mistakes },
    )
}

fn mistakes_json(mistakes: &Diagnostics) -> Value {
    json!({ "mistakes": mistakes.all().iter().map(mistake_json).collect::<Vec<_>>() })
}

/// A mistake with its place; without one where the whole file is meant.
fn mistake_json(mistake: &Diagnostic) -> Value {
    let Diagnostic { line, column, width, message, .. } = mistake;
    match line {
        0 => json!({ "message": message }),
        _ => json!({ "line": line, "column": column, "width": width, "message": message }),
    }
}

/// What a law declares.
fn tell(path: &Path, declaration: &Declaration) {
    let time = if declaration.continuous { "samples and continuous time" } else { "samples" };
    let title = if declaration.title.is_empty() { "a law without a title" } else { &declaration.title };
    say(&format!("{}: good: {title}; {}; for {time}", path.display(), known(declaration)));
    for own in &declaration.parameters {
        let scale = if own.scale == Scale::Logarithmic { ", logarithmic" } else { "" };
        let [low, high] = own.range;
        let text = format!("  {} = {}{}", own.name, own.default, own.behind());
        say(&format!("{text:<24} {low} to {high}{scale}  {}", own.help));
    }
    let names = |all: &[laws::Quantity]| {
        let name = |own: &laws::Quantity| match own.unit.to_string() {
            unit if unit.is_empty() => own.name.clone(),
            unit => format!("{} [{unit}]", own.name),
        };
        all.iter().map(name).collect::<Vec<_>>().join(", ")
    };
    for (what, all) in [("memory", &declaration.memory), ("shows", &declaration.shown)] {
        if !all.is_empty() {
            say(&format!("  {what}: {}", names(all)));
        }
    }
}

fn new(file: &Path) -> Outcome {
    let failed = |error: std::io::Error| {
        let path = file.display();
        match error.kind() {
            ErrorKind::AlreadyExists => {
                Failure::Usage(format!("{path} is there already: choose another name"))
            }
            ErrorKind::NotFound => Failure::Usage(format!("cannot write {path}: there is no such folder")),
            _ => Failure::Machine(format!("cannot write {path}: {error}")),
        }
    };
    if file.to_str().is_some_and(|name| shipped(name).is_some()) {
        let text = format!("{} is a law that comes with the program: choose another name", file.display());
        return Err(Failure::Usage(text));
    }
    if file.extension().is_some_and(|extension| extension == "wasm") {
        let text = format!("{}: a new law is text: choose a name such as mine.law", file.display());
        return Err(Failure::Usage(text));
    }
    let mut opened = OpenOptions::new().write(true).create_new(true).open(file).map_err(failed)?;
    opened.write_all(TEMPLATE.as_bytes()).map_err(failed)?;
    let path = file.display();
    note(&format!("{path}: try it with echelon lab circle-three --set law.file={path}"));
    say(&path.to_string());
    Ok(())
}

/// Bearing behind one leader where none is said, degrees.
const BEARING: f64 = -135.0;

/// Degrees, as a number or as scenes write them, "-135 deg".
fn degrees(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches("deg").trim_end_matches('°').trim_end();
    number.parse().map_err(|_| "write degrees, such as -135".to_owned())
}

/// Bounds of what a test takes, by option: all are finite.
fn bounded(name: &str, value: f64, [low, high]: [f64; 2]) -> Outcome {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(Failure::Usage(format!("--{name} must be from {low} to {high}, not {value}")))
}

fn test(args: &TestArgs, as_json: bool) -> Outcome {
    bounded("distance", args.distance, [0.01, 1000.0])?;
    bounded("bearing", args.bearing.unwrap_or(BEARING), [-180.0, 180.0])?;
    bounded("speed", args.speed, [0.001, 100.0])?;
    bounded("turn-rate", args.turn_rate, [-10.0, 10.0])?;
    bounded("period", args.period, [1e-4, 1.0])?;
    let law = read_law(&args.law).map_err(|mistakes| {
        if as_json {
            json(&mistakes_json(&mistakes));
        }
        Failure::Usage(mistakes.to_string())
    })?;
    let parameters = parameters(&law, &args.set)?;
    let leaders = leaders(&law, args)?;
    let declared = &law.declaration().parameters;
    let told: Vec<f64> = declared.iter().zip(&parameters).map(|(own, value)| own.as_told(*value)).collect();
    let end = close(&*law.law(), &told, &leaders).map_err(|fault| {
        let mark = if fault.place.is_some() { ":" } else { ": " };
        Failure::Broken(format!("{}{mark}{fault}", args.law.display()))
    })?;
    let stable = end.poles.as_ref().is_some_and(|poles| poles.iter().all(|pole| pole.re < -MARGINAL));
    if as_json {
        json(&end_json(&end, stable));
    } else {
        tell_end(&law, &parameters, args, &end, stable);
    }
    if stable { Ok(()) } else { Err(Failure::Expectation) }
}

/// The law's parameters with those that are set.
fn parameters(law: &WrittenLaw, set: &[String]) -> Result<Vec<f64>, Failure> {
    let declared = &law.declaration().parameters;
    let mut values: Vec<f64> = declared.iter().map(|own| own.default).collect();
    for set in set {
        let usage = |why: String| Failure::Usage(format!("--set {set}: {why}"));
        let (name, value) =
            set.split_once('=').ok_or_else(|| usage("write a parameter's name=value".to_owned()))?;
        let Some(index) = declared.iter().position(|own| own.name == name.trim()) else {
            let names: Vec<&str> = declared.iter().map(|own| own.name.as_str()).collect();
            return Err(usage(format!("the law has no parameter `{name}`; it has {}", names.join(", "))));
        };
        let [low, high] = declared[index].range;
        let value = value.trim().parse::<f64>().ok().filter(|value| (low..=high).contains(value));
        values[index] = value.ok_or_else(|| {
            usage(format!("must be a number from {low} to {high}{}", declared[index].behind()))
        })?;
    }
    Ok(values)
}

/// Leaders side by side, a distance apart, and the follower near its place.
fn leaders(law: &WrittenLaw, args: &TestArgs) -> Result<SteadyLeaders, Failure> {
    let TestArgs { distance, speed, turn_rate, period, .. } = *args;
    let (count, bearing) = (law.declaration().leaders, args.bearing.unwrap_or(BEARING).to_radians());
    let (places, wanted, start) = match count {
        1 => {
            let (sin, cos) = math::sin_cos(bearing);
            let place = [distance * cos, distance * sin];
            (vec![[0.0, 0.0]], vec![[Some(distance), Some(bearing)]], place)
        }
        2 => {
            let side = 0.5 * distance;
            let behind = -(distance * distance - side * side).sqrt();
            if args.bearing.is_some() {
                let text = "--bearing is for one leader: behind two the follower's place decides";
                return Err(Failure::Usage(text.to_owned()));
            }
            let places = vec![[0.0, side], [0.0, -side]];
            // Only what the law reads of a set point is wanted.
            let reads = |leader: usize, part: usize| {
                let reads = &law.declaration().reads;
                reads.iter().any(|(of, kind)| *of == leader && kind.wanted() == Some(part))
            };
            let wanted = |(leader, [_, y]): (usize, &[f64; 2])| {
                let bearing = math::atan2(-y, behind);
                [reads(leader, 0).then_some(distance), reads(leader, 1).then_some(bearing)]
            };
            let wanted = places.iter().enumerate().map(wanted).collect();
            (places, wanted, [behind, 0.0])
        }
        _ => {
            let text = format!("{} looks at {count} leaders: a test takes one or two", law.name());
            return Err(Failure::Usage(text));
        }
    };
    // A little off, so that the follower has something to do.
    let start = [start[0] * 1.02, start[1] + 0.01 * distance];
    Ok(SteadyLeaders { places, wanted, speed, turn_rate, period, start })
}

fn tell_end(law: &WrittenLaw, parameters: &[f64], args: &TestArgs, end: &LoopEnd, stable: bool) {
    let TestArgs { distance, speed, turn_rate, period, .. } = args;
    let bearing = args.bearing.unwrap_or(BEARING);
    say(&format!("{}: {}", args.law.display(), law.declaration().title));
    let declared = law.declaration().parameters.iter().zip(parameters);
    let value = |(own, value): (&Parameter, &f64)| format!("{} {value}{}", own.symbol, own.behind());
    let values: Vec<String> = declared.map(value).collect();
    if !values.is_empty() {
        say(&values.join(" · "));
    }
    let place = match law.declaration().leaders {
        1 => format!("{distance} m at {bearing}° from a leader"),
        count => {
            format!("{distance} m from each of {count} leaders that are {distance} m apart, side by side,")
        }
    };
    say(&format!("{place} at {speed} m/s and {turn_rate} rad/s, every {} ms, without limits", 1e3 * period));
    if law.declaration().knows == Knowledge::Output {
        say("rates are taken as true; in a run the built-in observer estimates them");
    }
    for (index, [distance, bearing]) in end.errors.iter().enumerate() {
        let of = if end.errors.len() > 1 { format!(" to leader {}", index + 1) } else { String::new() };
        let [distance, bearing] = [rounded(1e3 * distance, 3), rounded(bearing.to_degrees(), 4)];
        say(&format!("after {:.0} s: error {distance} mm, {bearing}°{of}", end.time));
    }
    let Some(poles) = &end.poles else {
        let moved = rounded(1e3 * end.moved, 3);
        let text = "it does not come to rest, so there is nothing to linearise about";
        return say(&format!(
            "in its last second it moves by {moved} (mm, mrad or mm/s, the largest): {text}"
        ));
    };
    say("\npole, 1/s                 damping  time constant");
    for pole in poles.iter().filter(|pole| pole.im >= 0.0) {
        say(&line(pole));
    }
    let memory = &law.declaration().memory;
    let apart: Vec<&str> =
        end.apart.iter().filter_map(|index| memory.get(*index)).map(|own| &*own.name).collect();
    if !apart.is_empty() {
        say(&format!("without effect on the motion, and without a pole here: {}", apart.join(", ")));
    }
    let grows = poles.iter().any(|pole| pole.re > MARGINAL);
    say(match (stable, grows) {
        (true, _) => "stable",
        (false, true) => "not stable",
        (false, false) => "not asymptotically stable: what does not decay stays",
    });
}

/// A pole this near to the imaginary axis is on it, 1/s.
const MARGINAL: f64 = 1e-5;

/// A number with so many decimals, and no sign before zero.
fn rounded(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    if text.chars().all(|c| "-0.".contains(c)) { text.replace('-', "") } else { text }
}

fn line(pole: &Pole) -> String {
    let size = math::hypot(pole.re, pole.im);
    let (re, im) = (rounded(pole.re, 3), pole.im);
    let value = if im == 0.0 { re } else { format!("{re} ± {im:.3}i") };
    let damping = if size > MARGINAL { -pole.re / size } else { 0.0 };
    let time = match pole.re {
        re if re.abs() < MARGINAL => "does not decay".to_owned(),
        re if re > 0.0 => "grows".to_owned(),
        re => format!("{:.3} s", -1.0 / re),
    };
    format!("{value:<24}  {damping:>7.3}  {time:>13}")
}

fn end_json(end: &LoopEnd, stable: bool) -> Value {
    let poles = end.poles.as_ref();
    let poles = poles.map(|poles| poles.iter().map(|pole| [pole.re, pole.im]).collect::<Vec<_>>());
    json!({
        "settles": poles.is_some(), "moved": end.moved, "stable": stable, "errors": end.errors, "speed": end.speed,
        "acceleration": end.command.acceleration, "turn_rate": end.command.turn_rate, "poles": poles,
    })
}
