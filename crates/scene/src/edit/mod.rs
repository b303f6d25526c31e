//! The text of a scene, edited in place: comments, order and layout stay as their writer left them.

mod cut;
mod find;
mod merge;
mod put;
mod rename;
mod schedule;

use crate::{Scene, law_file::replaced_by, names::NameForm, text::node::composed};
use find::{PathStep, item_at, items, made_by_group, names, steps};
pub use schedule::ChangeText;
use std::collections::BTreeMap;
use toml_edit::{DocumentMut, InlineTable, Item, Table, Value};

/// The text of a scene that can be edited.
///
/// Paths are those of `--set`: `law.k`, `robots.follower-1.distance`, robots that groups make included. The text is not
/// checked as a scene; [`crate::Scene::parse`] does that.
#[derive(Debug, Clone)]
pub struct SceneText {
    document: DocumentMut,
    /// Whether lines end as on Windows; the document knows no such ends.
    carriage_returns: bool,
}

/// Why a text cannot be edited so.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct EditError(String);

/// A text as a value of TOML, over several lines where it has them.
pub fn toml_text(text: &str) -> String {
    Value::from(text).decorated("", "").to_string()
}

/// What stands in a scene in the place of the name of a law's file: a key, and its value.
type Embedded = BTreeMap<String, (&'static str, String)>;

/// Puts laws in the places of the names of their files, in all tables called `law`.
fn embed(item: &mut Item, laws: &Embedded) {
    if let Item::ArrayOfTables(tables) = item {
        let tables = tables
            .iter_mut()
            .flat_map(|table| table.iter_mut().map(|(key, item)| (key.get().to_owned(), item)));
        tables.for_each(|(key, item)| embed_in(&key, item, laws));
        return;
    }
    if let Some(table) = item.as_table_like_mut() {
        table.iter_mut().for_each(|(key, item)| embed_in(key.get(), item, laws));
    }
}

fn embed_in(key: &str, item: &mut Item, laws: &Embedded) {
    let law = item.as_table_like_mut().filter(|_| key == "law");
    if let Some(law) = law
        && let Some((key, words)) = law.get("file").and_then(Item::as_str).and_then(|name| laws.get(name))
    {
        law.remove("file");
        law.insert(key, Item::Value(Value::from(words.as_str())));
    } else {
        embed(item, laws);
    }
}

impl EditError {
    fn new(message: impl Into<String>) -> Self {
        Self(message.into())
    }
}

impl SceneText {
    /// Takes a text to edit.
    ///
    /// # Errors
    /// What is not TOML about it.
    pub fn parse(text: &str) -> Result<Self, EditError> {
        let document = text.parse::<DocumentMut>();
        let carriage_returns = text.contains("\r\n");
        document
            .map(|document| Self { document, carriage_returns })
            .map_err(|error| EditError::new(error.to_string()))
    }

    /// The text as it is now.
    pub fn text(&self) -> String {
        let text = self.document.to_string();
        if self.carriage_returns { text.replace('\n', "\r\n") } else { text }
    }

    /// The value at `path` as it is written there; `None` if nothing is written there.
    pub fn get(&self, path: &str) -> Option<String> {
        let steps = steps(self.document.as_table(), path).ok()?;
        let value = item_at(self.document.as_item(), &steps)?.as_value()?;
        Some(value.clone().decorated("", "").to_string())
    }

    /// How many items a list of tables has.
    pub fn count(&self, list: &str) -> usize {
        let items = self.document.get(list);
        items.map_or(0, |item| item.as_array_of_tables().map_or(0, toml_edit::ArrayOfTables::len))
    }

    /// Puts `value`, which is TOML, else text, at `path`. Where an angle was written in degrees, a number in rad is
    /// written in degrees again, to 1e-6 deg.
    ///
    /// # Errors
    /// Where the path leads nowhere, or a table or a list of tables would be lost.
    pub fn set(&mut self, path: &str, value: &str) -> Result<(), EditError> {
        let steps = steps(self.document.as_table(), path)?;
        let value = value.trim();
        let value = value.parse::<Value>().unwrap_or_else(|_| Value::from(value)).decorated("", "");
        // Half an edit is none.
        let mut edited = self.document.clone();
        for key in self.superseded(&steps, &value) {
            cut::cut(&mut edited, &[steps.as_slice(), &[PathStep::Key(key)]].concat())?;
        }
        if let [.., PathStep::Key(table), PathStep::Key(key)] = steps.as_slice() {
            for other in replaced_by(table, key) {
                let path = [&steps[..steps.len() - 1], &[PathStep::Key(other.to_owned())]].concat();
                if item_at(edited.as_item(), &path).is_some_and(|item| !item.is_none()) {
                    cut::cut(&mut edited, &path)?;
                }
            }
        }
        put::put(edited.as_item_mut(), &steps, 0, value)?;
        self.document = edited;
        Ok(())
    }

    /// Writes laws that have files of their own in the places of the files' names, so that the scene needs no other file for
    /// them; `scene` is that of the text.
    pub fn embed_laws(&mut self, scene: &Scene) {
        let mut robots = scene.clone();
        let mut laws = Embedded::new();
        robots.for_every_robot(|robot| {
            let law = robot.role.follow().and_then(|follow| follow.law.file.as_ref());
            laws.extend(law.filter(|law| law.is_apart()).map(|law| (law.name().to_owned(), law.in_words())));
        });
        embed(self.document.as_item_mut(), &laws);
    }

    /// Takes out what is written at `path`, a value or a table; comment lines stay. Whether there was anything.
    ///
    /// # Errors
    /// Where the path leads to a whole robot, prop or other item; see [`SceneText::remove_item`].
    pub fn remove(&mut self, path: &str) -> Result<bool, EditError> {
        let steps = steps(self.document.as_table(), path)?;
        if item_at(self.document.as_item(), &steps).is_none_or(Item::is_none) {
            return Ok(false);
        }
        cut::cut(&mut self.document, &steps)?;
        Ok(true)
    }

    /// Adds a robot: the lines of its table without their head.
    ///
    /// # Errors
    /// Where the lines are not TOML, or have no name or one that is taken.
    pub fn add_robot(&mut self, lines: &str) -> Result<(), EditError> {
        self.add_table("robots", lines)
    }

    /// Adds an item to a list of tables such as `props` or `changes`: the lines of its table without their head.
    ///
    /// # Errors
    /// Where the lines are not TOML, or the list is none; of robots also where they have no name or one that is taken.
    pub fn add_table(&mut self, list: &str, lines: &str) -> Result<(), EditError> {
        let added = lines.parse::<DocumentMut>().map_err(|error| EditError::new(error.to_string()))?;
        let mut table = Table::new();
        for (key, item) in added.as_table() {
            // Tables of their own would have their place among the heads of another text.
            let value = item.clone().into_value().map_err(|_| EditError::new(format!("`{key}` is empty")))?;
            table.insert(key, Item::Value(value.decorated(" ", "")));
        }
        if list == "robots" {
            let name = table.get("name").and_then(Item::as_str);
            self.check_free(name.ok_or_else(|| EditError::new("a robot needs a `name`"))?)?;
        }
        put::add(self.document.as_table_mut(), list, table)
    }

    /// Takes the item called or numbered `name` out of a list of tables, with the comment lines right above and in it. Of a
    /// robot that a group makes, the group says that it is absent.
    ///
    /// # Errors
    /// Where there is none such.
    pub fn remove_item(&mut self, list: &str, name: &str) -> Result<(), EditError> {
        let name = &*composed(name);
        if self.made(list, name).is_some() {
            return self.set(&format!("{list}.{name}.absent"), "true");
        }
        self.check_own(list, name)?;
        let steps = steps(self.document.as_table(), &format!("{list}.{name}"))?;
        cut::cut_item(&mut self.document, &steps)
    }

    /// Calls a robot something else, wherever it is spoken of: by followers, groups, views and changes. Of a robot that a
    /// group makes, the group says what it is called.
    ///
    /// # Errors
    /// Where there is none called `old`, or `new` is taken or no name.
    pub fn rename_robot(&mut self, old: &str, new: &str) -> Result<(), EditError> {
        let (old, new) = (&*composed(old), &*composed(new));
        let made = self.made("robots", old);
        if made.is_none() {
            self.check_own("robots", old)?;
        }
        if old == new {
            return Ok(());
        }
        self.check_free(new)?;
        if !NameForm::WHOLE.takes(new) {
            let text = format!("`{new}` is not a name: 1 to 40 letters, digits, `-` and `_`");
            return Err(EditError::new(text));
        }
        match made {
            // Its own name again.
            Some((_, key)) if key == new => {
                self.remove(&format!("robots.{old}.name"))?;
            }
            Some(_) => self.set(&format!("robots.{old}.name"), &Value::from(new).to_string())?,
            None => {}
        }
        rename::rename(self.document.as_table_mut(), old, new);
        Ok(())
    }

    /// Keys of the table with a head at the end of the steps that `value` in its place does not have.
    fn superseded(&self, steps: &[PathStep], value: &Value) -> Vec<String> {
        let Some(Item::Table(table)) = item_at(self.document.as_item(), steps) else { return vec![] };
        let stays = |key: &str| match value {
            Value::InlineTable(new) => new.contains_key(key),
            // The word of a kind stands for a table of it.
            Value::String(_) => key == "kind" || !put::has_kinds(steps.last()),
            _ => true,
        };
        table.iter().map(|(key, _)| key).filter(|key| !stays(key)).map(str::to_owned).collect()
    }

    /// Refuses names that a robot has.
    fn check_free(&self, name: &str) -> Result<(), EditError> {
        let root = self.document.as_table();
        let taken = names(root, "robots").any(|taken| taken == name) || made_by_group(root, name).is_some();
        if taken { Err(EditError::new(format!("there is a robot called `{name}` already"))) } else { Ok(()) }
    }

    /// The group that makes a robot of this name, if it does not stand in the list itself, and the name that the robot
    /// has by its place.
    fn made(&self, list: &str, name: &str) -> Option<(usize, String)> {
        let root = self.document.as_table();
        let written = names(root, list).any(|known| known == name);
        if list == "robots" && !written { made_by_group(root, name) } else { None }
    }

    /// Refuses names and numbers that nothing in a list has.
    fn check_own(&self, list: &str, name: &str) -> Result<(), EditError> {
        let root = self.document.as_table();
        let number = name.parse::<usize>().is_ok_and(|index| index < items(root, list).len());
        let known = number || names(root, list).any(|known| known == name);
        if known { Ok(()) } else { Err(EditError::new(find::nothing_called(root, list, name))) }
    }
}

/// An inline table of one key.
fn table_of(key: &str, value: Value) -> InlineTable {
    let mut table = InlineTable::new();
    table.insert(key, value);
    table
}
