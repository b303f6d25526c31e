//! Custom laws in scenes: their files, their texts, modules, and values of their parameters.

use crate::Diagnostics;
use crate::files::{read_bytes, text_of};
use crate::packed::{Damage, unpack};
use crate::text::{Form, Node, Reporter, Span, Value, form::Text, words::instead_of};
use crate::types::{LawSource, Written, WrittenLaw};
use laws::{Declaration, LawFile, Mistake, SHIPPED_LAWS, is_module, read_module, shipped};
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Most characters of a law that is written in a scene.
const LAW_TEXT: usize = 100_000;
/// Most characters of a packed module.
const PACKED_MODULE: usize = 1_500_000;

/// Keys of which the one that is set last says which law a follower has.
pub const LAW_CHOICE: [&str; 4] = ["kind", "file", "text", "module"];

/// The keys of a table called `table` that lose their meaning where `key` is set.
pub(crate) fn replaced_by(table: &str, key: &str) -> impl Iterator<Item = &'static str> {
    let chooses = table == "law" && LAW_CHOICE.contains(&key);
    LAW_CHOICE.into_iter().filter(move |other| chooses && *other != key)
}

/// The name of a law that comes with the program, else of a law file beside the scene.
pub(crate) struct LawFileForm;

/// The text of a law.
pub(crate) struct LawTextForm;

/// A law that is a WebAssembly module, packed.
pub(crate) struct LawModuleForm;

/// Values of a law's parameters, by their names.
pub(crate) struct ParametersForm;

impl Form for LawFileForm {
    type Out = Option<WrittenLaw>;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Self::Out> {
        let name = reporter.expect(node.as_text(), node, || "the name of a law file".to_owned())?;
        let path = reporter.beside_scene(name);
        match open(name, &path, reporter) {
            Ok(law) => law.map(Some),
            Err(told) => {
                report_all(&told, &path.display().to_string(), node.span, reporter);
                None
            }
        }
    }

    fn schema(&self) -> Json {
        json!({ "type": "string" })
    }
}

/// The bytes of a law's file. One that is no file, such as a pipe, would be waited for without a word.
fn read_law(path: &Path) -> Result<Vec<u8>, String> {
    match path.metadata() {
        Ok(about) if !about.is_file() && !about.is_dir() => {
            Err("is no file: laws are read from files".to_owned())
        }
        _ => read_bytes(path),
    }
}

/// What to say of a law file that is not beside the scene.
fn elsewhere(name: &str, path: &Path) -> String {
    if !name.is_empty() && Path::new(name).is_file() && Path::new(name) != path {
        return ": law files are looked for beside the scene; there is one of that name in this folder"
            .to_owned();
    }
    instead_of(name, SHIPPED_LAWS.iter().map(|law| law.name))
}

impl Form for LawTextForm {
    type Out = Option<WrittenLaw>;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Self::Out> {
        let text = Text(LAW_TEXT).read(node, reporter)?;
        // Where a change of the law writes it, its ends are trimmed.
        compiled(LawSource::Scene, "law.text".to_owned(), text.trim(), reporter).map(Some)
    }

    fn schema(&self) -> Json {
        Text(LAW_TEXT).schema()
    }
}

impl Form for LawModuleForm {
    type Out = Option<WrittenLaw>;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Self::Out> {
        let packed = Text(PACKED_MODULE).read(node, reporter)?;
        match unpack(packed.trim()) {
            Ok(bytes) if is_module(&bytes) => {
                let law = of_module(LawSource::Scene, bytes);
                law.map_err(|told| report_all(&told, "law.module", node.span, reporter)).ok().map(Some)
            }
            Ok(_) => {
                reporter.report(node.span, "`module` unpacks to what is no WebAssembly module");
                None
            }
            Err(damage) => {
                let what = match damage {
                    Damage::CutOff => "is cut off",
                    Damage::Other(what) => what,
                };
                reporter
                    .report(node.span, format!("`module` {what}: it is a module, packed; `file` names one"));
                None
            }
        }
    }

    fn schema(&self) -> Json {
        Text(PACKED_MODULE).schema()
    }
}

/// The law of the file at `path`, or of that name among those that come with the program.
///
/// # Errors
/// Everything that is wrong with the file.
pub fn load_law(path: &Path) -> Result<WrittenLaw, Diagnostics> {
    let mut reporter = Reporter::new(Path::new(""));
    let law = open(&path.display().to_string(), path, &mut reporter);
    let law = law.map_err(|told| Diagnostics::whole_file(path, told))?;
    law.ok_or_else(|| reporter.into_diagnostics())
}

/// The law that comes with the program under a name, else that of the file at `path`; `None` after reporting mistakes in its
/// text, or else what is wrong with the whole file. What ships goes first: a shipped scene is the same wherever it runs.
fn open(name: &str, path: &Path, reporter: &mut Reporter) -> Result<Option<WrittenLaw>, Vec<String>> {
    if let Some(law) = shipped(name) {
        return Ok(compiled(LawSource::Shipped(name.to_owned()), name.to_owned(), law.text, reporter));
    }
    let bytes = read_law(path).map_err(|fault| {
        let hint = if path.exists() { String::new() } else { elsewhere(name, path) };
        vec![fault + &hint]
    })?;
    reporter.files.push(path.to_owned());
    let source = LawSource::File(name.to_owned());
    if is_module(&bytes) {
        return of_module(source, bytes).map(Some);
    }
    if path.extension().is_some_and(|extension| extension == "wasm") {
        return Err(vec!["is no WebAssembly module: it does not begin with the bytes of one".to_owned()]);
    }
    let text = text_of(bytes).map_err(|fault| vec![fault])?;
    Ok(compiled(source, path.display().to_string(), &text, reporter))
}

/// The law of a module, or what is wrong with it.
fn of_module(source: LawSource, bytes: Vec<u8>) -> Result<WrittenLaw, Vec<String>> {
    let law = read_module(&bytes)?;
    Ok(WrittenLaw::new(source, Written::Module(bytes.into()), law))
}

/// What is wrong with a law, reported where it is named at `span`; `origin` is the name of the file or key.
fn report_all(mistakes: &[String], origin: &str, span: Span, reporter: &mut Reporter) {
    for what in mistakes {
        reporter.report(span, format!("{origin}: {what}"));
    }
}

/// The law of a text, or `None` after reporting its mistakes where they stand.
fn compiled(source: LawSource, origin: String, text: &str, reporter: &mut Reporter) -> Option<WrittenLaw> {
    match LawFile::compile(text) {
        Ok(law) => Some(WrittenLaw::new(source, Written::Text(text.into()), Arc::new(law))),
        Err(mistakes) => {
            let number = reporter.add_source(origin, text);
            for Mistake { place, end, message } in mistakes {
                let [start, end] = [place, end].map(|place| place.byte_in(text));
                reporter.report(Span { source: number, start, end: end.max(start) }, message);
            }
            None
        }
    }
}

impl Form for ParametersForm {
    type Out = BTreeMap<String, f64>;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Self::Out> {
        let entries = reporter.expect(node.as_table(), node, || "a table of numbers by name".to_owned())?;
        let mut values = BTreeMap::new();
        for entry in entries {
            let number = match entry.node.value {
                Value::Number(value) => Some(value),
                Value::Integer(value) => Some(value as f64),
                _ => None,
            };
            let value = number.filter(|value| value.is_finite());
            let value = reporter
                .inside(&entry.key, |reporter| reporter.expect(value, &entry.node, || "a number".to_owned()));
            values.insert(entry.key.clone(), value?);
        }
        Some(values)
    }

    fn schema(&self) -> Json {
        json!({ "type": "object", "additionalProperties": { "type": "number" } })
    }
}

/// What is wrong with values for the parameters of a law: the names that it does not have, and the values out of range.
pub(crate) fn faults(values: &BTreeMap<String, f64>, law: &WrittenLaw) -> Vec<String> {
    let Declaration { parameters, .. } = law.declaration();
    let fault = |(name, value): (&String, &f64)| {
        let Some(parameter) = parameters.iter().find(|parameter| parameter.name == *name) else {
            let known = parameters.iter().map(|parameter| parameter.name.as_str());
            let hint = instead_of(name, known);
            return Some(format!("{} has no parameter `{name}`{hint}", law.name()));
        };
        let [low, high] = parameter.range;
        let unit = parameter.behind();
        (!(low..=high).contains(value)).then(|| {
            format!("`{name}` must be from {low} to {high}{unit}, as {} says, not {value}", law.name())
        })
    };
    values.iter().filter_map(fault).collect()
}
