//! Reading files that somebody named: one clear message for each way this can fail.

use crate::text::{Form, Node, Reporter};
use serde_json::{Value as Json, json};
use std::{
    fs::File,
    io::{ErrorKind, Read},
    path::Path,
};

/// Scenes are never this large; the bound limits memory and time.
const MOST_BYTES: u64 = 10_000_000;

/// The bytes of the file at `path`, or what is wrong with it.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, String> {
    let file = File::open(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => "no such file".to_owned(),
        _ => format!("cannot be opened: {error}"),
    })?;
    let about = file.metadata().map_err(|error| format!("cannot be read: {error}"))?;
    if about.is_dir() {
        return Err("is a directory, not a file".to_owned());
    }
    let too_large = || format!("is larger than {} MB, the most that is read", MOST_BYTES / 1_000_000);
    if about.len() > MOST_BYTES {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    // A pipe has no length beforehand.
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(|error| format!("cannot be read: {error}"))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(too_large());
    }
    Ok(bytes)
}

/// The text of the file at `path`, or what is wrong with it.
pub(crate) fn read_text(path: &Path) -> Result<String, String> {
    text_of(read_bytes(path)?)
}

/// Bytes of a file as text, or what is wrong with it.
pub(crate) fn text_of(bytes: Vec<u8>) -> Result<String, String> {
    String::from_utf8(bytes).map_err(|error| {
        let line = error.as_bytes()[..error.utf8_error().valid_up_to()].split(|byte| *byte == b'\n').count();
        format!("is not UTF-8 text: line {line} holds bytes that are not characters")
    })
}

/// The name of a CSV file beside the scene, which the function reads: its text, and what to call it in notes.
pub(crate) struct FileForm<T>(pub(crate) fn(&str, usize, &mut Reporter) -> Option<T>);

impl<T> Form for FileForm<T> {
    type Out = T;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<T> {
        let name = reporter.expect(node.as_text(), node, || "the name of a CSV file".to_owned())?;
        let path = reporter.beside_scene(name);
        match read_text(&path) {
            Ok(text) => {
                let source = reporter.add_source(path.display().to_string(), &text);
                reporter.files.push(path);
                self.0(&text, source, reporter)
            }
            Err(fault) => {
                reporter.report(node.span, format!("{}: {fault}", path.display()));
                None
            }
        }
    }

    fn schema(&self) -> Json {
        json!({ "type": "string" })
    }
}
