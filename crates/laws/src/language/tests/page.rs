//! What the page of the language says.

use super::{compiled, fault, mistakes_of};
use crate::CustomLaw;

#[test]
fn the_page_of_the_language_is_true() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/law-files.md");
    let page = std::fs::read_to_string(path).expect("a page");
    let mut table = String::new();
    for (_, name, unit, help) in crate::INPUTS {
        table = format!("{table}| `{name}` | {unit} | {help} |\n");
    }
    assert!(page.contains(&table), "the page should have this table:\n{table}");
    let mut table = String::new();
    for builtin in crate::language::builtin::BUILTINS {
        table = format!("{table}| `{}` | {} |\n", builtin.name, builtin.help);
    }
    assert!(page.contains(&table), "the page should have this table:\n{table}");
    let mut table = String::new();
    let mut counts = vec![];
    for law in crate::SHIPPED_LAWS {
        let compiled = compiled(law.text);
        let name = law.name;
        table = format!("{table}| [`{name}`](../laws/{name}.law) | {} |\n", compiled.declaration().title);
        counts.push(compiled.instructions());
    }
    assert!(page.contains(&table), "the page should have this table:\n{table}");
    counts.sort_unstable();
    let [least, .., most, predictive] = counts[..] else { panic!("{counts:?}") };
    let words = page.replace('\n', " ");
    let count = format!("the shipped laws take {least} to {most}, `predictive` {predictive}.");
    assert!(words.contains(&count), "the page should say: {count}");
    let laws: Vec<&str> =
        page.split("```law\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(!laws.is_empty());
    for law in laws {
        compiled(law);
    }
    let wrong = mistakes_of("\n\nlet e = wanted.distance - leader.bearing\nlet d = leader.distanse");
    let shown = wrong.iter().map(|mistake| {
        let (place, rest) = mistake.split_once('-').expect("a stretch");
        format!("{place}: {}", rest.split_once(' ').expect("a message").1)
    });
    let at_fault = fault(
        "\n\n\n\nlet e = (leader.distance / 4, 0)\nlet speed = own.speed - 0.75 [m/s]\nlet b = e.x / speed\ncommand = b * 1 [m/s^3], 0",
    );
    for line in shown.chain([at_fault]) {
        assert!(page.lines().any(|there| there == line), "the page should show: {line}");
    }
}
