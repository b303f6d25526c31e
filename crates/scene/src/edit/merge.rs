//! A value in place of another, as its writer would have written it.

use toml_edit::{Array, InlineTable, Value};

/// Puts `new` in place of `old`, whose surroundings, layout and degrees it keeps.
pub(super) fn merge(old: &mut Value, new: Value) {
    match (old, new) {
        (Value::Array(old), Value::Array(new)) => merge_lists(old, new),
        (Value::InlineTable(old), Value::InlineTable(new)) => merge_tables(old, new),
        (old, new) => {
            let new = in_degrees(old, &new).unwrap_or(new);
            let decor = old.decor().clone();
            *old = new;
            *old.decor_mut() = decor;
        }
    }
}

fn merge_lists(old: &mut Array, new: Array) {
    // What goes takes no comment with it.
    while old.len() > new.len() {
        let gone = old.remove(old.len() - 1);
        let decor = [gone.decor().prefix(), gone.decor().suffix()]
            .map(|text| text.and_then(|t| t.as_str()).unwrap_or(""));
        let kept: String = decor.into_iter().filter(|text| text.contains('#')).collect();
        if !kept.is_empty() {
            let trailing = format!("{kept}{}", old.trailing().as_str().unwrap_or(""));
            old.set_trailing(trailing);
        }
    }
    let known = old.len();
    let last = known.checked_sub(1).and_then(|index| old.get(index)).map(|value| value.decor().clone());
    for (index, value) in new.into_iter().enumerate() {
        if let Some(old) = old.get_mut(index) {
            merge(old, value);
            continue;
        }
        // As the last one stands, so do those that come after it.
        let prefix = match &last {
            Some(decor) if known > 1 => {
                let prefix = decor.prefix().and_then(|text| text.as_str()).unwrap_or(" ");
                prefix.get(prefix.rfind('\n').unwrap_or(0)..).unwrap_or(" ").to_owned()
            }
            _ => if index > 0 { " " } else { "" }.to_owned(),
        };
        old.push_formatted(value.decorated(prefix, ""));
    }
}

fn merge_tables(old: &mut InlineTable, new: InlineTable) {
    old.retain(|key, _| new.contains_key(key));
    for (key, value) in new {
        match old.get_mut(&key) {
            Some(old) => merge(old, value),
            None => {
                old.insert(key, value.decorated(" ", ""));
            }
        }
    }
    settle(old);
}

/// A table in one line has a space inside each brace.
pub(super) fn settle(table: &mut InlineTable) {
    let lines = table.to_string().contains('\n');
    if lines || table.is_dotted() {
        return;
    }
    let count = table.len();
    for (index, (mut key, value)) in table.iter_mut().enumerate() {
        key.leaf_decor_mut().set_prefix(" ");
        key.leaf_decor_mut().set_suffix(" ");
        value.decor_mut().set_prefix(" ");
        value.decor_mut().set_suffix(if index + 1 == count { " " } else { "" });
    }
}

/// A number in rad in degrees, where `old` is in degrees.
fn in_degrees(old: &Value, new: &Value) -> Option<Value> {
    let unit = ["deg", "°"]
        .into_iter()
        .find(|unit| old.as_str().is_some_and(|text| text.trim_end().ends_with(unit)))?;
    let rad = new.as_float().or_else(|| new.as_integer().map(|value| value as f64))?;
    let space = if old.as_str().is_some_and(|text| text.contains(' ')) { " " } else { "" };
    // Adding 0 turns −0 into 0.
    let degrees = (rad.to_degrees() * 1e6).round() / 1e6 + 0.0;
    rad.is_finite().then(|| Value::from(format!("{degrees}{space}{unit}")))
}
