//! Which runs have been made, as stretches of indices.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

/// A set of indices; it takes as much room as it has gaps.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct IndexSet {
    /// The stretches, by their first index, with the index behind their last.
    stretches: BTreeMap<u64, u64>,
    len: u64,
}

impl IndexSet {
    /// Adds an index; says whether it was new.
    pub fn insert(&mut self, index: u64) -> bool {
        let before = self.stretches.range(..=index).next_back().map(|(from, to)| (*from, *to));
        if before.is_some_and(|(_, to)| index < to) {
            return false;
        }
        let end = self.stretches.remove(&(index + 1)).unwrap_or(index + 1);
        let begin = before.filter(|(_, to)| *to == index).map_or(index, |(from, _)| from);
        self.stretches.insert(begin, end);
        self.len += 1;
        true
    }

    /// How many there are.
    pub fn len(&self) -> u64 {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Whether an index is in it.
    pub fn contains(&self, index: u64) -> bool {
        self.stretches.range(..=index).next_back().is_some_and(|(_, to)| index < *to)
    }

    /// Those of a range that are not in it.
    #[must_use]
    pub fn missing(&self, range: Range<u64>) -> Self {
        let mut missing = Self::default();
        let mut from = range.start;
        let mut add = |from: u64, to: u64| {
            if from < to {
                missing.stretches.insert(from, to);
                missing.len += to - from;
            }
        };
        for (begin, end) in &self.stretches {
            if *begin >= range.end {
                break;
            }
            add(from, *begin);
            from = from.max(*end);
        }
        add(from, range.end);
        missing
    }

    /// All of them, in order.
    pub fn iter(&self) -> impl Iterator<Item = u64> + Send + use<> {
        self.stretches.clone().into_iter().flat_map(|(from, to)| from..to)
    }
}

/// Its stretches as command lines name them: `0..5, 7..8`.
impl fmt::Display for IndexSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 6;
        let shown: Vec<String> =
            self.stretches.iter().take(SHOWN).map(|(from, to)| format!("{from}..{to}")).collect();
        f.write_str(&shown.join(", "))?;
        if self.stretches.len() > SHOWN { f.write_str(", …") } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_grow_together() {
        let mut set = IndexSet::default();
        for index in [5, 3, 4, 0, 9] {
            assert!(set.insert(index), "{index}");
        }
        assert!(!set.insert(4) && !set.insert(0));
        assert_eq!((set.to_string(), set.len()), ("0..1, 3..6, 9..10".to_owned(), 5));
        assert!(set.contains(3) && set.contains(5) && !set.contains(6) && !set.contains(1));
        let missing = set.missing(1..12);
        assert_eq!((missing.to_string(), missing.len()), ("1..3, 6..9, 10..12".to_owned(), 7));
        assert_eq!(missing.iter().collect::<Vec<u64>>(), [1, 2, 6, 7, 8, 10, 11]);
        assert_eq!(set.missing(3..6), IndexSet::default());
        assert_eq!(IndexSet::default().missing(0..2).to_string(), "0..2");
    }
}
