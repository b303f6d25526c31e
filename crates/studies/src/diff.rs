//! In which keys two resolved scenes differ.

use serde_json::Value;
use std::collections::BTreeMap;

/// A key that differs, with its value in both scenes; `None` where a scene has no such key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DifferingKey {
    /// Path, as `--set` has it.
    pub key: String,
    /// As JSON.
    pub values: [Option<String>; 2],
}

/// Keys that differ, by path; things with names go by their names.
pub fn differing_keys(scenes: [&Value; 2]) -> Vec<DifferingKey> {
    let mut leaves: BTreeMap<String, [Option<String>; 2]> = BTreeMap::new();
    for (side, tree) in scenes.into_iter().enumerate() {
        flatten(String::new(), tree, &mut |key, value| leaves.entry(key).or_default()[side] = Some(value));
    }
    let differs = leaves.into_iter().filter(|(_, [a, b])| a != b);
    differs.map(|(key, values)| DifferingKey { key, values }).collect()
}

/// Leaves of a tree by path.
fn flatten(key: String, tree: &Value, put: &mut impl FnMut(String, String)) {
    let below = |part: &str| if key.is_empty() { part.to_owned() } else { format!("{key}.{part}") };
    match tree {
        Value::Object(table) => table.iter().for_each(|(part, value)| flatten(below(part), value, put)),
        Value::Array(list) if list.iter().any(Value::is_object) => {
            for (index, value) in list.iter().enumerate() {
                let name = value.get("name").and_then(Value::as_str);
                flatten(below(&name.map_or_else(|| index.to_string(), str::to_owned)), value, put);
            }
        }
        leaf => put(key, leaf.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn keys_that_differ_are_told_by_their_paths() {
        let left =
            json!({ "law": { "k": 5, "beta": 2 }, "robots": [{ "name": "ann", "x": 1 }], "list": [1, 2] });
        let right = json!({ "law": { "k": 8, "beta": 2 }, "robots": [{ "name": "ann", "x": 1, "y": 2 }], "list": [1, 2] });
        let found = differing_keys([&left, &right]);
        let values = |a: Option<&str>, b: Option<&str>| [a, b].map(|v| v.map(str::to_owned));
        assert_eq!(found.len(), 2, "{found:?}");
        assert_eq!((found[0].key.as_str(), &found[0].values), ("law.k", &values(Some("5"), Some("8"))));
        assert_eq!((found[1].key.as_str(), &found[1].values), ("robots.ann.y", &values(None, Some("2"))));
    }
}
