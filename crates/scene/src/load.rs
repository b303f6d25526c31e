//! From a path to a checked scene, and back to text.

use crate::{
    Diagnostics, Override, Scene,
    changes::changes,
    document::Document,
    files::read_text,
    resolve::resolve,
    shipped::{Shipped, nearest_shipped, shipped},
    text::{Form, Node, Reporter, table, words::MEANT},
};
use serde_json::json;
use std::path::{Path, PathBuf};

/// A scene and what it was made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The checked scene.
    pub scene: Scene,
    /// Text of the scene file, without overrides.
    pub text: String,
    /// Files that were read: the scene file, then the tables it names.
    pub files: Vec<PathBuf>,
}

/// Reads and checks the scene at `path`: see [`Scene::load`].
pub(crate) fn load(path: &Path, overrides: &[Override]) -> Result<Loaded, Diagnostics> {
    if let Some(shipped) = named(path) {
        return parse(shipped.text, path, overrides);
    }
    let text = read_text(path).map_err(|fault| Diagnostics::whole_file(path, [fault + &suggestion(path)]))?;
    parse(&text, path, overrides)
}

/// Checks scene `text`: see [`Scene::parse`].
pub(crate) fn parse(text: &str, path: &Path, overrides: &[Override]) -> Result<Loaded, Diagnostics> {
    if text.trim().is_empty() {
        let fault = "is empty: a scene needs at least `schema = 1`, a title and a robot";
        return Err(Diagnostics::whole_file(path, [fault.to_owned()]));
    }
    let mut reporter = Reporter::new(path.parent().unwrap_or(Path::new("")));
    match check(text, path, overrides, &mut reporter) {
        Some(scene) if reporter.is_clean() => {
            let files = [path.to_owned()].into_iter().chain(reporter.files).collect();
            Ok(Loaded { scene, text: text.to_owned(), files })
        }
        _ => Err(reporter.into_diagnostics()),
    }
}

/// The shipped scene that a path names, where there is no file; a folder of that name is none.
fn named(path: &Path) -> Option<&'static Shipped> {
    path.to_str().and_then(shipped).filter(|_| !path.exists() || path.is_dir())
}

/// What to say of a file that is not there where a shipped scene may be meant.
fn suggestion(path: &Path) -> String {
    let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    match nearest_shipped(&stem).filter(|_| !path.exists()) {
        Some(name) => format!(" ({MEANT}{name}`, which comes with the program?)"),
        None => String::new(),
    }
}

fn check(text: &str, path: &Path, overrides: &[Override], reporter: &mut Reporter) -> Option<Scene> {
    let source = reporter.add_source(path.display().to_string(), text);
    let mut root = Node::parse_document(text, source, reporter)?;
    for change in overrides {
        change.apply(&mut root, reporter);
    }
    let document = table::<Document>().read(&root, reporter)?;
    let mut scene = resolve(document, &root, reporter)?;
    if reporter.is_clean() {
        scene.changes = changes(&root, &scene, reporter);
    }
    Some(scene)
}

/// JSON Schema (2020-12) of scene files.
pub fn schema() -> serde_json::Value {
    let mut schema = table::<Document>().schema();
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("Echelon scene");
    schema
}
