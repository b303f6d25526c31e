//! Keys and values that are one of a few words, and the nearest of them to a misspelt one.

use crate::text::{Form, Node, Reporter};
use serde_json::{Value as Json, json};
use vocabulary::Word;

/// A form that takes one of a few words.
pub(crate) struct Words<T: 'static>(pub(crate) &'static [(&'static str, T, &'static str)]);

/// The form that takes the words of `T`.
pub(crate) const fn word<T: Word>() -> Words<T> {
    Words(T::WORDS)
}

impl<T: Copy + 'static> Form for Words<T> {
    type Out = T;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<T> {
        let found = self.0.iter().find(|(word, ..)| node.as_text() == Some(*word));
        if found.is_none() {
            not_a_word(node, self.0.iter().map(|(word, ..)| *word), reporter);
        }
        found.map(|(_, value, _)| *value)
    }

    fn schema(&self) -> Json {
        let options =
            self.0.iter().map(|(word, _, about)| json!({ "const": word, "description": about.trim() }));
        json!({ "oneOf": options.collect::<Vec<_>>() })
    }
}

/// Reports that `node` is none of `words`, with the nearest.
pub(crate) fn not_a_word<'a>(
    node: &Node,
    words: impl Iterator<Item = &'a str> + Clone,
    reporter: &mut Reporter,
) {
    let near = node.as_text().and_then(|text| nearest(text, words.clone()));
    reporter.wrong(node, &format!("one of {}", quoted(words)));
    reporter.append_to_last(&near.map_or_else(String::new, did_you_mean));
}

/// The words in backquotes, separated by commas.
pub(crate) fn quoted<'a>(words: impl Iterator<Item = &'a str>) -> String {
    words.map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}

/// The word a writer most likely meant.
pub(crate) fn nearest<'a>(text: &str, words: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    // Longer texts are no slips of the pen, and comparing them takes time.
    let text = text.get(..text.len().min(60))?.to_lowercase();
    let close = words.map(|word| (strsim::osa_distance(&text, &word.to_lowercase()), word));
    let (distance, word) = close.min_by_key(|(distance, _)| *distance)?;
    (distance <= 1 + word.chars().count() / 3).then_some(word)
}

/// The end of a message that a name is not among `names`: the nearest, and the first few that there are.
pub(crate) fn instead_of<'a>(name: &str, names: impl Iterator<Item = &'a str> + Clone) -> String {
    const SHOWN: usize = 8;
    let hint = nearest(name, names.clone()).map_or_else(String::new, did_you_mean);
    let more = if names.clone().nth(SHOWN).is_some() { ", …" } else { "" };
    let known = quoted(names.take(SHOWN));
    if known.is_empty() { hint } else { format!("{hint} (known here: {known}{more})") }
}

/// The end of a message that names the nearest valid word.
pub(crate) fn did_you_mean(word: &str) -> String {
    format!(", {MEANT}{word}`?")
}

/// What stands before a word that may have been meant.
pub(crate) const MEANT: &str = "did you mean `";

/// The word that a message says may have been meant.
pub(crate) fn suggested(message: &str) -> Option<&str> {
    message.split_once(MEANT)?.1.split('`').next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_many_names_the_first_are_enough() {
        let names: Vec<String> = (0..9).map(|k| format!("p{k}")).collect();
        let told = |count: usize| instead_of("zoe", names[..count].iter().map(String::as_str));
        assert_eq!(told(9), " (known here: `p0`, `p1`, `p2`, `p3`, `p4`, `p5`, `p6`, `p7`, …)");
        assert_eq!(told(8), " (known here: `p0`, `p1`, `p2`, `p3`, `p4`, `p5`, `p6`, `p7`)");
        assert_eq!(told(0), "");
        assert_eq!(suggested(&told(3)), None);
        assert_eq!(suggested(&instead_of("p", ["p1"].into_iter())), Some("p1"));
        assert_eq!(instead_of("p", ["p1"].into_iter()), ", did you mean `p1`? (known here: `p1`)");
    }
}
