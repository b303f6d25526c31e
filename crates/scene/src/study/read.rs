//! From the text of a study file to a study, and back.

use super::values::parts_of_list;
use super::{FollowerScatter, MOST_RUNS, Sampling, Study, StudyFault, StudyParameter, Values};
use crate::document::SCHEMA_VERSION;
use crate::files::FileForm;
use crate::text::words::word;
use crate::text::{
    Form, Found, Node, Reporter, Span, Text, angle_within, integer, keys, list, number, table,
};
use crate::{Diagnostics, Override, toml_text};
use serde_json::{Value as Json, json};
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;
use vocabulary::{Word, counted};

keys! {
    /// A study: runs of a scene that differ.
    struct StudyKeys {
        /// Version of this format.
        schema: u64 = integer::<u64>(SCHEMA_VERSION, SCHEMA_VERSION), required;
        /// Title of tables, figures and reports.
        title: String = Text(200), or(String::new());
        /// The file of the scene, beside the study, or the name of one that ships.
        scene: String = Text(1000), required;
        /// Seed of everything that differs from run to run.
        seed: u64 = integer::<u64>(0, i64::MAX as u64), or(1);
        /// Runs of every combination, each with a seed of its own.
        seeds: u64 = integer::<u64>(1, MOST_RUNS), or(1);
        /// How often numbers with a distribution are drawn in every cell.
        samples: u64 = integer::<u64>(1, MOST_RUNS), or(1);
        /// How they are drawn.
        sampling: Sampling = word::<Sampling>(), or(Sampling::Independent);
        /// Overrides of all runs, as `--set` has them: "time.duration=5".
        set: Vec<Override> = list(OverrideForm, 0, 1000), part;
        /// Keys that differ from run to run, and their values: a range with its number of values, "1..10/19" or
        /// "log:0.001..0.1/13"; a list, [1, 2, 5] or "zip:1,2,5"; a distribution, "uniform:0..1", "log-uniform:0.001..0.1" or
        /// "normal:MEAN,DEVIATION"; or "=KEY" for what another key is.
        vary: Vec<VariedKey> = VaryForm, part;
        /// A CSV file with a column for each of several keys: a row is a combination.
        table: Vec<StudyParameter> = FileForm(read_table), part;
        /// How far followers start from where their scene puts them.
        scatter: ScatterKeys = table::<ScatterKeys>(), part;
        /// How long a run may take, s of wall time.
        limit: f64 = number("s").above(0.0), optional;
    }
}

keys! {
    /// How far followers start from where their scene puts them.
    struct ScatterKeys {
        /// Radius of the disc in which a follower starts, m.
        position: f64 = number("m").from(0.0).up_to(1000.0), or(0.0);
        /// Largest turn of its heading to either side.
        heading: f64 = angle_within(0.0, PI), or(0.0);
    }
}

/// A varied key and where it stands.
#[derive(Debug, Clone)]
pub(crate) struct VariedKey {
    parameter: StudyParameter,
    span: Span,
}

struct OverrideForm;

impl Form for OverrideForm {
    type Out = Override;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Override> {
        let text = reporter
            .expect(node.as_text(), node, || "an override, such as \"time.duration=5\"".to_owned())?;
        text.parse().map_err(|fault: crate::OverrideError| reporter.report(node.span, fault.to_string())).ok()
    }

    fn schema(&self) -> Json {
        json!({ "type": "string" })
    }
}

/// Values of many keys, whose paths are quoted or dotted.
struct VaryForm;

impl Form for VaryForm {
    type Out = Vec<VariedKey>;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Vec<VariedKey>> {
        reporter.expect(node.as_table(), node, || "a table of keys and their values".to_owned())?;
        let mut found = vec![];
        collect(node, "", &mut found, reporter);
        // In the order of the file: the first is the slowest.
        found.sort_by_key(|varied| varied.span.start);
        Some(found)
    }

    fn schema(&self) -> Json {
        json!({ "type": "object" })
    }
}

/// All values under a path.
fn collect(node: &Node, path: &str, found: &mut Vec<VariedKey>, reporter: &mut Reporter) {
    for entry in node.as_table().unwrap_or_default() {
        let key = if path.is_empty() { entry.key.clone() } else { format!("{path}.{}", entry.key) };
        if entry.node.as_table().is_some() {
            collect(&entry.node, &key, found, reporter);
            continue;
        }
        let text = match (&entry.node.as_list(), entry.node.as_text()) {
            (Some(items), _) => {
                items.iter().map(|item| reporter.shown(item.span)).collect::<Vec<_>>().join(",")
            }
            (None, Some(text)) => text.to_owned(),
            (None, None) => reporter.shown(entry.node.span).to_owned(),
        };
        match text.parse::<Values>() {
            Ok(values) => {
                found.push(VariedKey { parameter: StudyParameter { key, values }, span: entry.span });
            }
            Err(fault) => reporter.report(entry.node.span, format!("`{key}`: {fault}")),
        }
    }
}

/// The columns of a table as values that go together.
fn read_table(text: &str, source: usize, reporter: &mut Reporter) -> Option<Vec<StudyParameter>> {
    let whole = Span { source, start: 0, end: 0 };
    let mut table =
        csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let keys: Vec<String> = table.headers().ok()?.iter().map(str::to_owned).collect();
    let mut columns: Vec<Vec<String>> = vec![vec![]; keys.len()];
    for record in table.records() {
        let record = match record {
            Ok(record) => record,
            Err(error) => {
                let (span, text) = match error.kind() {
                    csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
                        let start = pos.as_ref().map_or(0, |pos| pos.byte() as usize);
                        let span = Span { source, start, end: start };
                        (
                            span,
                            format!(
                                "this row has {}, and there are {expected_len} keys",
                                counted(*len, "value")
                            ),
                        )
                    }
                    _ => (whole, format!("not a row of the table: {error}")),
                };
                reporter.report(span, text);
                return None;
            }
        };
        for ((column, key), value) in columns.iter_mut().zip(&keys).zip(&record) {
            if value.is_empty() || parts_of_list(value).len() > 1 {
                let row = column.len() + 1;
                let message =
                    format!("`{key}` in row {row} is `{value}`: write one value, a list in brackets");
                reporter.report(whole, message);
                return None;
            }
            column.push(value.to_owned());
        }
    }
    if keys.is_empty() || columns.first().is_none_or(Vec::is_empty) {
        reporter.report(whole, "a table needs a header with keys, and a row under it");
        return None;
    }
    let parameter = |(key, values)| StudyParameter { key, values: Values::Zipped(values) };
    Some(keys.into_iter().zip(columns).map(parameter).collect())
}

/// Reads the text of the study at `path`.
pub(super) fn parse(text: &str, path: &Path) -> Result<Study, Diagnostics> {
    let mut reporter = Reporter::new(path.parent().unwrap_or(Path::new("")));
    match study(text, path, &mut reporter) {
        Some(study) if reporter.is_clean() => Ok(study),
        _ => Err(reporter.into_diagnostics()),
    }
}

fn study(text: &str, path: &Path, reporter: &mut Reporter) -> Option<Study> {
    let source = reporter.add_source(path.display().to_string(), text);
    let root = Node::parse_document(text, source, reporter)?;
    let keys = table::<StudyKeys>().read(&root, reporter)?;
    let vary = value(keys.vary)?;
    let place = |key: &str| vary.iter().find(|varied| varied.parameter.key == key).map(|varied| varied.span);
    let scatter = value(keys.scatter)?;
    let study = Study {
        title: value(keys.title)?,
        scene: beside(&value(keys.scene)?, path),
        seed: value(keys.seed)?,
        seeds: value(keys.seeds)?,
        samples: value(keys.samples)?,
        sampling: value(keys.sampling)?,
        set: value(keys.set)?,
        parameters: vary.iter().map(|varied| varied.parameter.clone()).chain(value(keys.table)?).collect(),
        // Both are left out with their table.
        scatter: FollowerScatter {
            position: value(scatter.position).unwrap_or_default(),
            heading: value(scatter.heading).unwrap_or_default(),
        },
        limit: keys.limit.map(|found| found.value),
    };
    for fault in study.faults() {
        let span = fault.key.as_deref().and_then(place).unwrap_or(root.span.first());
        reporter.report(span, fault.text);
    }
    Some(study)
}

/// Puts faults where the keys stand that they name: varied keys, `scene`, and `set.K` for an override by its place. `None` where the
/// text has none of them.
pub(super) fn located(text: &str, path: &Path, faults: &[StudyFault]) -> Option<Diagnostics> {
    let mut reporter = Reporter::new(path.parent().unwrap_or(Path::new("")));
    let source = reporter.add_source(path.display().to_string(), text);
    let root = Node::parse_document(text, source, &mut reporter)?;
    let vary = root.get("vary").map_or_else(Vec::new, |node| {
        let mut found = vec![];
        collect(node, "", &mut found, &mut reporter);
        found
    });
    // What is not there is in the table.
    let table = root.get("table").map(|node| node.span);
    let set = |place: usize| Some(root.get("set")?.as_list()?.get(place)?.span);
    let place = |key: &str| match key.strip_prefix("set.").and_then(|place| place.parse().ok()) {
        Some(place) => set(place),
        None if key == "scene" => Some(root.get("scene")?.span),
        None => vary.iter().find(|varied| varied.parameter.key == key).map(|varied| varied.span).or(table),
    };
    let places: Vec<Option<Span>> = faults.iter().map(|fault| place(fault.key.as_deref()?)).collect();
    if places.iter().all(Option::is_none) {
        return None;
    }
    for (fault, place) in faults.iter().zip(places) {
        reporter.report(place.unwrap_or(root.span.first()), fault.text.clone());
    }
    Some(reporter.into_diagnostics())
}

fn value<T>(found: Option<Found<T>>) -> Option<T> {
    found.map(|found| found.value)
}

/// A scene's file is beside the study; what ships is found anywhere.
fn beside(scene: &str, study: &Path) -> String {
    let folder = study.parent().unwrap_or(Path::new(""));
    let path = folder.join(scene);
    if path.is_file() { path.display().to_string() } else { scene.to_owned() }
}

/// A study as a file has it.
pub(super) fn written(study: &Study) -> String {
    let mut text = format!("schema = {SCHEMA_VERSION}\n");
    let mut line = |key: &str, value: String| {
        let _ = writeln!(text, "{key} = {value}");
    };
    line("title", toml_text(&study.title));
    line("scene", toml_text(&study.scene));
    line("seed", study.seed.to_string());
    line("seeds", study.seeds.to_string());
    line("samples", study.samples.to_string());
    line("sampling", toml_text(study.sampling.word()));
    if let Some(limit) = study.limit {
        line("limit", format!("{limit:?}"));
    }
    let set: Vec<String> = study.set.iter().map(|change| toml_text(&change.to_string())).collect();
    line("set", format!("[{}]", set.join(", ")));
    let FollowerScatter { position, heading } = study.scatter;
    line("scatter", format!("{{ position = {position:?}, heading = {heading:?} }}"));
    let _ = writeln!(text, "\n[vary]");
    for StudyParameter { key, values } in &study.parameters {
        let _ = writeln!(text, "{} = {}", toml_text(key), toml_text(&values.to_string()));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "schema = 1\ntitle = \"Gains\"\nscene = \"circle-three\"\nseeds = 20\nset = [\"time.duration=5\"]\n\
        scatter = { position = 0.5, heading = \"20 deg\" }\n\n[vary]\nlaw.k = \"1..10/19\"\n\"law.beta\" = [1, 2, 5]\n\
        vehicle.kind = [\"car\", \"unicycle\"]\nobserver.epsilon = 0.01\n";

    fn read(text: &str) -> Result<Study, Diagnostics> {
        parse(text, Path::new("study.toml"))
    }

    #[test]
    fn a_file_is_read_and_written() {
        let study = read(FILE).expect("a study");
        assert_eq!((study.cells(), study.runs()), (19 * 3 * 2, 19 * 3 * 2 * 20));
        let keys: Vec<&str> = study.parameters.iter().map(|p| p.key.as_str()).collect();
        assert_eq!(keys, ["law.k", "law.beta", "vehicle.kind", "observer.epsilon"]);
        assert!((study.scatter.heading - 20_f64.to_radians()).abs() < 1e-12);
        assert_eq!(read(&study.to_toml()).expect("its own text"), study);
    }

    #[test]
    fn everything_but_the_scene_may_be_left_out() {
        let study = read("schema = 1\nscene = \"circle-three\"\n").expect("a study");
        assert_eq!(study, Study::of_scene("circle-three", ""));
    }

    #[test]
    fn faults_stand_where_they_are() {
        for (from, to, line, wanted) in [
            ("seeds = 20", "seed = 20\nsedes = 2", 5, "did you mean `seeds`"),
            ("seeds = 20", "seeds = 0", 4, "from 1 to"),
            ("1..10/19", "10..1/19", 9, "does not rise"),
            ("[1, 2, 5]", "[1, 1]", 10, "twice"),
            ("time.duration=5", "time.duration", 5, "not an override"),
            ("time.duration=5", "law.k=5", 9, "given twice"),
        ] {
            let errors = read(&FILE.replace(from, to)).expect_err(to);
            let first = &errors.all()[0];
            assert!(first.line == line && first.message.contains(wanted), "{to}: {errors}");
        }
    }

    #[test]
    fn a_table_brings_keys_that_go_together() {
        let folder = std::env::temp_dir().join(format!("study-table-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        std::fs::write(
            folder.join("rows.csv"),
            "law.k,robots.follower-1.pose\n1,\"[0, 1, 2]\"\n2,\"[3, 4, 5]\"\n",
        )
        .expect("rows");
        let path = folder.join("study.toml");
        let study =
            parse("schema = 1\nscene = \"circle-three\"\ntable = \"rows.csv\"\n", &path).expect("a study");
        assert_eq!(study.cells(), 2);
        assert_eq!(parse(&study.to_toml(), &path).expect("its own text"), study);
        std::fs::write(folder.join("rows.csv"), "law.k,law.beta\n1,2\n3\n").expect("rows");
        let errors = parse("schema = 1\nscene = \"circle-three\"\ntable = \"rows.csv\"\n", &path)
            .expect_err("a short row");
        let first = &errors.all()[0];
        assert!(first.line == 3 && first.message.contains("1 value, and there are 2 keys"), "{errors}");
        std::fs::write(folder.join("rows.csv"), "law.k\n").expect("rows");
        assert!(parse("schema = 1\nscene = \"circle-three\"\ntable = \"rows.csv\"\n", &path).is_err());
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
