//! Names as ROS 2 takes them in topics: letters, digits and single underscores, no digit in front.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

/// A legal name for each of `names`, no two the same: those that are legal keep theirs.
pub(super) fn legal<'a>(names: impl IntoIterator<Item = &'a str>) -> BTreeMap<String, String> {
    let names: BTreeSet<&str> = names.into_iter().collect();
    let (kept, changed): (Vec<&str>, Vec<&str>) = names.into_iter().partition(|name| plain(name) == *name);
    let mut taken: BTreeSet<String> = kept.iter().map(|name| (*name).to_owned()).collect();
    let mut all: BTreeMap<String, String> =
        kept.iter().map(|name| ((*name).to_owned(), (*name).to_owned())).collect();
    for name in changed {
        let plain = plain(name);
        let numbered = (2..).map(|number| format!("{plain}_{number}"));
        if let Some(free) = std::iter::once(plain.clone()).chain(numbered).find(|free| !taken.contains(free))
        {
            taken.insert(free.clone());
            all.insert(name.to_owned(), free);
        }
    }
    all
}

/// The legal name nearest to `name`.
fn plain(name: &str) -> String {
    let mut text = String::with_capacity(name.len());
    for c in name.chars() {
        match c {
            'a'..='z' | 'A'..='Z' | '0'..='9' => text.push(c),
            c if c.is_ascii() => text.push('_'),
            // A letter that ROS does not have is told by its number; writing to a text cannot fail.
            c => drop(write!(text, "u{:x}_", u32::from(c))),
        }
    }
    let words: Vec<&str> = text.split('_').filter(|word| !word.is_empty()).collect();
    let text = words.join("_");
    if text.starts_with(|c: char| c.is_ascii_digit()) || text.is_empty() { format!("n{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_legal_and_one_to_one() {
        let names = ["0", "n0", "r-1", "r_1", "r__1", "_a", "robot-3", "隊", "é", "lead", "-", "_"];
        let all = legal(names);
        let mut seen = BTreeSet::new();
        for name in names {
            let legal = &all[name];
            assert!(seen.insert(legal), "{legal} stands for two");
            let fits = |c: char| c.is_ascii_alphanumeric() || c == '_';
            assert!(legal.chars().all(fits) && !legal.contains("__") && !legal.ends_with('_'), "{legal}");
            assert!(legal.starts_with(|c: char| c.is_ascii_alphabetic()), "{legal}");
        }
        assert_eq!((&*all["r_1"], &*all["r-1"], &*all["n0"], &*all["0"]), ("r_1", "r_1_2", "n0", "n0_2"));
        assert_eq!((&*all["robot-3"], &*all["lead"], &*all["隊"]), ("robot_3", "lead", "u968a"));
    }
}
