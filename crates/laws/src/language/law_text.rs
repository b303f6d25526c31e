//! The text of a law, and stretches of it.

use crate::custom_law::Place;

/// A stretch of text, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Stretch {
    /// The first byte.
    pub(super) from: usize,
    /// The byte behind the last.
    pub(super) to: usize,
}

impl Stretch {
    /// From the start of one to the end of another.
    pub(super) fn through(self, other: Self) -> Self {
        Self { from: self.from, to: other.to.max(self.to) }
    }
}

/// The longest quotation, in characters.
const QUOTE_MAX: usize = 40;

/// The text of a law without its byte order mark.
#[derive(Debug, Clone, Copy)]
pub(super) struct LawText<'a>(&'a str);

impl<'a> LawText<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self(text.strip_prefix('\u{feff}').unwrap_or(text))
    }

    pub(super) fn as_str(self) -> &'a str {
        self.0
    }

    /// Line and character of a byte.
    pub(super) fn place(self, byte: usize) -> Place {
        let before = self.0.get(..byte).unwrap_or(self.0);
        let line = before.matches('\n').count() as u32 + 1;
        let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count()) as u32 + 1;
        Place { line, column }
    }

    /// A stretch as it is quoted in messages, in one line and not too long.
    pub(super) fn quote(self, at: Stretch) -> String {
        let words: Vec<&str> = self.0.get(at.from..at.to).unwrap_or("").split_whitespace().collect();
        let line: String = words.join(" ").chars().filter(|c| !c.is_control()).collect();
        if line.chars().count() <= QUOTE_MAX {
            return format!("`{line}`");
        }
        let head: String = line.chars().take(QUOTE_MAX - 2).collect();
        format!("`{}…`", head.trim_end())
    }

    /// The title: the first line, where it is a comment.
    pub(super) fn title(self) -> String {
        let first = self.0.lines().find(|line| !line.trim().is_empty());
        let comment = first.and_then(|line| line.trim().strip_prefix('#'));
        comment.unwrap_or("").trim_start_matches('#').trim().chars().filter(|c| !c.is_control()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_lines_and_characters() {
        let text = LawText::new("\u{feff}ψ = 1\r\n  γ");
        assert_eq!(text.place(0), Place { line: 1, column: 1 });
        assert_eq!(text.place(3), Place { line: 1, column: 3 });
        assert_eq!(text.place(text.as_str().len()), Place { line: 2, column: 4 });
    }

    #[test]
    fn a_place_leads_back_to_its_byte() {
        for marked in ["\u{feff}ψ = 1\r\n  γ\n", "ψ = 1\n\nγ"] {
            let text = LawText::new(marked);
            let mark = marked.len() - text.as_str().len();
            for (byte, _) in text.as_str().char_indices() {
                assert_eq!(text.place(byte).byte_in(marked), mark + byte);
            }
            assert_eq!(text.place(text.as_str().len()).byte_in(marked), marked.len());
        }
        assert_eq!(Place { line: 9, column: 1 }.byte_in("a\nb"), 3);
    }

    #[test]
    fn a_quotation_is_one_short_line() {
        let text = LawText::new("a +\n    b");
        assert_eq!(text.quote(Stretch { from: 0, to: 9 }), "`a + b`");
        let long = "x".repeat(50);
        assert_eq!(LawText::new(&long).quote(Stretch { from: 0, to: 50 }), format!("`{}…`", "x".repeat(38)));
    }

    #[test]
    fn the_title_is_the_comment_at_the_top() {
        assert_eq!(LawText::new("\r\n## Mine (eq 42)\r\nleaders 1").title(), "Mine (eq 42)");
        assert_eq!(LawText::new("leaders 1\n# Mine").title(), "");
        assert_eq!(LawText::new("").title(), "");
    }
}
