//! Values put where paths lead, and tables made where there are none yet.

use super::find::PathStep;
use super::merge::{merge, settle};
use super::{EditError, table_of};
use toml_edit::{ArrayOfTables, Item, Table, Value};

/// Puts `value` where the steps from number `depth` on lead from `item`.
pub(super) fn put(item: &mut Item, steps: &[PathStep], depth: usize, value: Value) -> Result<(), EditError> {
    let key = match steps.get(depth) {
        None => return replace(item, steps, value),
        Some(PathStep::Item(index)) => {
            let item = item.get_mut(*index).ok_or_else(|| EditError::new("the list is shorter"))?;
            return put(item, steps, depth + 1, value);
        }
        Some(PathStep::Key(key)) => key,
    };
    spell_out(item, depth.checked_sub(1).and_then(|before| steps.get(before)));
    let position = if depth == 0 { Some(settings_position(item)) } else { None };
    let table = item
        .as_table_like_mut()
        .ok_or_else(|| EditError::new(format!("there is no key `{key}` here: this is a plain value")))?;
    let last = depth + 1 == steps.len();
    if table.get(key).is_none_or(Item::is_none) {
        if last {
            table.insert(key, Item::Value(value.decorated(" ", "")));
            tidy(item);
            return Ok(());
        }
        table.insert(key, made(steps, depth, position));
    }
    let inside = table.get_mut(key).ok_or_else(|| EditError::new(format!("`{key}` cannot be made")))?;
    put(inside, steps, depth + 1, value)?;
    tidy(item);
    Ok(())
}

/// The table that the step at `depth` leads to, as it is usually written: settings of the scene and members of groups
/// under a head of their own, others within a line.
fn made(steps: &[PathStep], depth: usize, position: Option<isize>) -> Item {
    let key = |depth: usize| match steps.get(depth) {
        Some(PathStep::Key(key)) => Some(key.as_str()),
        _ => None,
    };
    let in_group = key(0) == Some("groups");
    let headed = depth == 0 || (in_group && depth == 3 && key(2) == Some("members"));
    let mut table = Table::new();
    table.set_position(position);
    if in_group && depth == 2 && key(2) == Some("members") {
        table.set_implicit(true);
        Item::Table(table)
    } else if headed {
        table.decor_mut().set_prefix("\n");
        Item::Table(table)
    } else {
        Item::Value(Value::InlineTable(toml_edit::InlineTable::new()))
    }
}

/// Where a new head of settings stands among all heads: after the last that is no list, before all lists.
fn settings_position(root: &Item) -> isize {
    let Some(root) = root.as_table() else { return 0 };
    let lists = root.iter().filter_map(|(_, item)| item.as_array_of_tables()?.iter().next()?.position());
    let first_list = lists.min().unwrap_or(isize::MAX);
    let settings = root.iter().filter_map(|(_, item)| item.as_table()?.position());
    settings
        .filter(|position| *position < first_list)
        .max()
        .unwrap_or_else(|| first_list.saturating_sub(1).min(0))
}

/// Whether the word of a kind may stand here for a table of that kind.
pub(super) fn has_kinds(key: Option<&PathStep>) -> bool {
    matches!(key, Some(PathStep::Key(key)) if key == "vehicle" || key == "sensing")
}

/// Makes what is the word of its kind a table of that kind.
fn spell_out(item: &mut Item, key: Option<&PathStep>) {
    if let Item::Value(old @ Value::String(_)) = item
        && has_kinds(key)
    {
        let decor = old.decor().clone();
        let mut new = Value::InlineTable(table_of("kind", old.clone().decorated(" ", "")));
        *new.decor_mut() = decor;
        *old = new;
    }
}

/// Puts spaces right in a table within a line.
fn tidy(item: &mut Item) {
    if let Item::Value(Value::InlineTable(table)) = item {
        settle(table);
    }
}

fn replace(item: &mut Item, steps: &[PathStep], value: Value) -> Result<(), EditError> {
    match (item, value) {
        (Item::Value(old), value) => merge(old, value),
        (Item::Table(table), Value::InlineTable(new)) => {
            for (key, value) in new {
                let item = table.entry(&key).or_insert(Item::None);
                replace(item, &[PathStep::Key(key.clone())], value)?;
            }
        }
        (Item::Table(table), value @ Value::String(_)) if has_kinds(steps.last()) => {
            replace(table.entry("kind").or_insert(Item::None), &[], value)?;
        }
        (item @ Item::None, value) => *item = Item::Value(value.decorated(" ", "")),
        (Item::Table(_), _) => return Err(EditError::new("this is a table: set its keys one by one")),
        (Item::ArrayOfTables(_), _) => {
            return Err(EditError::new("this is a list of tables: add and remove its items one by one"));
        }
    }
    Ok(())
}

/// Adds `table` at the end of a list.
pub(super) fn add(root: &mut Table, list: &str, mut table: Table) -> Result<(), EditError> {
    match root.entry(list).or_insert_with(|| Item::ArrayOfTables(ArrayOfTables::new())) {
        Item::ArrayOfTables(tables) => {
            table.decor_mut().set_prefix("\n");
            tables.push(table);
            Ok(())
        }
        Item::Value(Value::Array(values)) => {
            let mut inline = table.into_inline_table();
            settle(&mut inline);
            values.push(inline);
            Ok(())
        }
        _ => Err(EditError::new(format!("`{list}` is not a list"))),
    }
}
