//! The types that editors see, `_echelon.pyi`, have every method of the extension, each with the documentation that it has in
//! the source: `UPDATE_STUBS=1` writes that into them. The build of this test also makes the extension, which
//! `tests/python/run` loads.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use syn::{Attribute, Expr, ImplItem, Item, Lit, Meta};

/// Documentation by `Class` and `Class.method`.
type Docs = BTreeMap<String, Vec<String>>;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()
}

/// Whether an attribute of that name stands on an item.
fn has(attributes: &[Attribute], name: &str) -> bool {
    attributes.iter().any(|attribute| attribute.path().is_ident(name))
}

/// The lines of an item's documentation.
fn doc(attributes: &[Attribute]) -> Vec<String> {
    let line = |attribute: &Attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(text) => match &text.lit {
                Lit::Str(text) => Some(text.value().strip_prefix(' ').unwrap_or(&text.value()).to_owned()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    };
    attributes.iter().filter_map(line).collect()
}

/// What a source file shows to Python.
fn read(text: &str, docs: &mut Docs) {
    let class = |name: String| name.strip_prefix("Py").map(str::to_owned);
    for item in syn::parse_file(text).expect("Rust").items {
        match item {
            Item::Struct(item) if has(&item.attrs, "pyclass") => {
                docs.extend(class(item.ident.to_string()).map(|name| (name, doc(&item.attrs))));
            }
            Item::Fn(item) if has(&item.attrs, "pyfunction") => {
                docs.insert(item.sig.ident.to_string(), doc(&item.attrs));
            }
            Item::Impl(block) if has(&block.attrs, "pymethods") => {
                let syn::Type::Path(of) = &*block.self_ty else { continue };
                let Some(class) = of.path.get_ident().and_then(|name| class(name.to_string())) else {
                    continue;
                };
                for method in block.items {
                    let ImplItem::Fn(method) = method else { continue };
                    docs.insert(format!("{class}.{}", method.sig.ident), doc(&method.attrs));
                }
            }
            _ => {}
        }
    }
}

/// The stubs without documentation: signatures, one to a line or over several, and what stands beside them.
fn bare(stubs: &str) -> Vec<&str> {
    let mut inside = false;
    let mut lines = vec![];
    for line in stubs.lines() {
        let quotes = line.matches("\"\"\"").count();
        let begins = line.trim_start().starts_with("\"\"\"") && !lines.is_empty();
        if inside {
            inside = quotes == 0;
        } else if begins {
            inside = quotes == 1;
        } else {
            lines.push(line);
        }
    }
    lines
}

/// The stubs with the documentation in `docs`, which is taken out there.
fn documented(stubs: &str, docs: &mut Docs) -> String {
    let (mut text, mut class, mut pending) = (String::new(), String::new(), None);
    for line in bare(stubs) {
        let (indent, body) = (line.len() - line.trim_start().len(), line.trim_start());
        text.push_str(line);
        text.push('\n');
        let name = |start: &str| body.strip_prefix(start)?.split(['(', ':']).next().map(str::to_owned);
        if let Some(name) = name("class ") {
            class.clone_from(&name);
            pending = Some((name, indent));
        } else if let Some(name) = name("def ") {
            let name = if indent == 0 { name } else { format!("{class}.{name}") };
            pending = Some((name, indent));
        }
        // A signature ends where its body would begin.
        if line.trim_end().ends_with(':')
            && let Some((name, indent)) = pending.take()
        {
            let lines = docs.remove(&name).unwrap_or_else(|| panic!("the extension has no `{name}`"));
            let pad = " ".repeat(indent + 4);
            let shown = lines.iter().map(|line| format!("{pad}{line}").trim_end().to_owned());
            let shown = shown.collect::<Vec<_>>().join("\n");
            let shown = shown.trim_start();
            let end = if lines.len() > 1 { format!("\n{pad}") } else { String::new() };
            text.extend([&pad, "\"\"\"", shown, &end, "\"\"\"\n"]);
        }
    }
    text
}

#[test]
fn the_stubs_have_every_method_with_its_documentation() {
    let mut docs = Docs::new();
    for source in ["copies", "program", "scene", "run", "simulation", "study", "table"] {
        read(
            &fs::read_to_string(root().join("src").join(source).with_extension("rs")).expect("a file"),
            &mut docs,
        );
    }
    let path = root().join("python/echelon/_echelon.pyi");
    let stubs = fs::read_to_string(&path).expect("stubs");
    let wanted = documented(&stubs, &mut docs);
    // What begins with one underscore is of the package itself, and Python knows what these are.
    let known = |name: &str| {
        let method = name.rsplit('.').next().unwrap_or(name);
        (method.starts_with('_') && !method.starts_with("__"))
            || ["__repr__", "__eq__", "__reduce__"].contains(&method)
    };
    let left: Vec<_> = docs.keys().filter(|name| !known(name)).collect();
    assert!(left.is_empty(), "_echelon.pyi has no {left:?}");
    if std::env::var_os("UPDATE_STUBS").is_some() {
        fs::write(&path, &wanted).expect("written");
    }
    assert!(
        stubs == wanted || std::env::var_os("UPDATE_STUBS").is_some(),
        "write the stubs anew with UPDATE_STUBS=1"
    );
}
