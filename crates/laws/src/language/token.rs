//! The words and signs of a law file.

use super::law_text::{LawText, Stretch};
use super::mistake::MistakeList;

/// A word or sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum TokenKind<'a> {
    /// A number; no sign.
    Number(f64),
    /// A name or a word of the language.
    Name(&'a str),
    /// What stands between double quotes.
    Quoted(&'a str),
    /// What stands between square brackets.
    Unit(&'a str),
    /// A sign.
    Sign(&'static str),
    /// End of a statement: a `;`, or the end of a line that does not go on.
    Stop,
    /// End of the text.
    End,
}

/// A word or sign and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Token<'a> {
    pub(super) kind: TokenKind<'a>,
    pub(super) at: Stretch,
}

/// Signs by how they are typed; longer ones first. The second is the one that is meant.
const SIGNS: [(&str, &str); 33] = [
    ("<=", "<="),
    (">=", ">="),
    ("==", "=="),
    ("!=", "!="),
    ("..", ".."),
    ("**", "**"),
    ("&&", "&&"),
    ("||", "||"),
    ("+", "+"),
    ("-", "-"),
    ("*", "*"),
    ("/", "/"),
    ("^", "^"),
    ("(", "("),
    (")", ")"),
    ("{", "{"),
    ("}", "}"),
    (",", ","),
    ("=", "="),
    ("<", "<"),
    (">", ">"),
    (".", "."),
    ("'", "'"),
    ("!", "!"),
    ("²", "²"),
    ("³", "³"),
    ("·", "*"),
    ("×", "*"),
    ("−", "-"),
    ("≤", "<="),
    ("≥", ">="),
    ("≠", "!="),
    ("′", "'"),
];

/// Signs after which, and before which, a line goes on; brackets are counted apart.
const JOINS: [&str; 16] =
    ["+", "-", "*", "/", "^", "<", ">", "<=", ">=", "==", "!=", "=", ",", "..", "&&", "||"];

/// The longest name, in characters.
const NAME_MAX: usize = 60;

/// Splits a text into tokens, the last of which is [`TokenKind::End`].
pub(super) fn tokens<'a>(text: LawText<'a>, mistakes: &mut MistakeList) -> Vec<Token<'a>> {
    let mut lexer = Lexer { text: text.as_str(), at: 0, open: vec![], tokens: vec![] };
    while lexer.at < lexer.text.len() && !mistakes.is_full() {
        lexer.next(mistakes);
    }
    let end = Stretch { from: lexer.text.len(), to: lexer.text.len() };
    lexer.stop(end);
    lexer.tokens.push(Token { kind: TokenKind::End, at: end });
    lexer.tokens
}

struct Lexer<'a> {
    text: &'a str,
    at: usize,
    /// Brackets that are open: `(` or `{`.
    open: Vec<u8>,
    tokens: Vec<Token<'a>>,
}

impl<'a> Lexer<'a> {
    fn next(&mut self, mistakes: &mut MistakeList) {
        let rest = &self.text[self.at..];
        let Some(first) = rest.chars().next() else { return };
        let one = Stretch { from: self.at, to: self.at + first.len_utf8() };
        match first {
            '\n' => {
                // Comments and blank lines are passed at once, so that each is read once.
                self.at = self.text.len() - next_code(&rest[1..]).len();
                if !self.goes_on() {
                    self.stop(Stretch { to: one.from, ..one });
                }
            }
            ';' => {
                self.at = one.to;
                self.stop(one);
            }
            '#' => self.at += rest.find('\n').unwrap_or(rest.len()),
            '"' => {
                let length = rest[1..].find(['"', '\n', '\r']).map_or(rest.len(), |length| length + 1);
                let is_closed = rest[length..].starts_with('"');
                if !is_closed {
                    let at = Stretch { from: self.at, to: self.at + length };
                    mistakes.add(at, "the second `\"` is missing");
                }
                self.push(TokenKind::Quoted(&rest[1..length]), length + usize::from(is_closed));
            }
            '[' => {
                let length = rest.find([']', '\n', '\r']).unwrap_or(rest.len());
                if rest[length..].starts_with(']') {
                    self.push(TokenKind::Unit(&rest[1..length]), length + 1);
                } else {
                    mistakes.add(one, "the `]` behind the unit is missing");
                    self.push(TokenKind::Unit("-"), length);
                }
            }
            '0'..='9' => self.number(mistakes),
            '.' if rest[1..].starts_with(|c: char| c.is_ascii_digit()) => self.number(mistakes),
            _ if first.is_whitespace() => self.at = one.to,
            _ if begins_name(first) => {
                let length = rest.find(|c| !continues_name(c)).unwrap_or(rest.len());
                let name = &rest[..length];
                let end = name.char_indices().nth(NAME_MAX).map_or(length, |(end, _)| end);
                if end < length {
                    let at = Stretch { from: self.at, to: self.at + length };
                    mistakes.add(at, format!("this name is too long: {NAME_MAX} characters are enough"));
                }
                self.push(TokenKind::Name(&name[..end]), length);
            }
            _ => {
                if let Some((typed, meant)) = SIGNS.iter().find(|(typed, _)| rest.starts_with(typed)) {
                    self.sign(meant, typed.len());
                } else {
                    let hint = match first {
                        '%' | '\\' => ": comments begin with `#`",
                        '&' => ": write `and`",
                        '|' => ": write `or`, or `abs(x)`",
                        ':' => ": write `=`",
                        '√' => ": write `sqrt(x)`",
                        _ => "",
                    };
                    let shown =
                        if first.is_control() { "this character".to_owned() } else { format!("`{first}`") };
                    mistakes.add(one, format!("{shown} has no meaning here{hint}"));
                    self.at = one.to;
                }
            }
        }
    }

    fn push(&mut self, kind: TokenKind<'a>, length: usize) {
        self.tokens.push(Token { kind, at: Stretch { from: self.at, to: self.at + length } });
        self.at += length;
    }

    fn sign(&mut self, sign: &'static str, length: usize) {
        match sign {
            "(" | "{" => self.open.push(sign.as_bytes()[0]),
            ")" | "}" => {
                let wanted = if sign == ")" { b'(' } else { b'{' };
                if self.open.last() == Some(&wanted) {
                    self.open.pop();
                }
            }
            _ => {}
        }
        self.push(TokenKind::Sign(sign), length);
    }

    /// The end of a statement, once for several lines.
    fn stop(&mut self, at: Stretch) {
        let stopped = self.tokens.last().is_none_or(|last| last.kind == TokenKind::Stop);
        if !stopped {
            self.tokens.push(Token { kind: TokenKind::Stop, at });
        }
    }

    /// Whether the line that ends here goes on: inside round brackets, after a sign that wants more, and before one.
    fn goes_on(&mut self) -> bool {
        let rest = &self.text[self.at..];
        if self.open.last() == Some(&b'(') {
            if !begins_with_any(rest, &STARTERS) {
                return true;
            }
            // A bracket was forgotten: that is one mistake, not one in every line that follows.
            while self.open.last() == Some(&b'(') {
                self.open.pop();
            }
        }
        let after = match self.tokens.last().map(|last| last.kind) {
            Some(TokenKind::Sign(sign)) => JOINS.contains(&sign) || sign == "{",
            Some(TokenKind::Name(word)) => matches!(word, "and" | "or" | "not"),
            _ => false,
        };
        after || begins_with_join(rest)
    }

    fn number(&mut self, mistakes: &mut MistakeList) {
        let bytes = self.text.as_bytes();
        let digits = |mut at: usize| {
            while bytes.get(at).is_some_and(u8::is_ascii_digit) {
                at += 1;
            }
            at
        };
        let from = self.at;
        let mut to = digits(from);
        // A second point makes it the sign of a range.
        if bytes.get(to) == Some(&b'.') && bytes.get(to + 1) != Some(&b'.') {
            to = digits(to + 1);
        }
        if matches!(bytes.get(to), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(to + 1), Some(b'+' | b'-')));
            let end = digits(to + 1 + sign);
            if end > to + 1 + sign {
                to = end;
            }
        }
        let written = &self.text[from..to];
        let at = Stretch { from, to };
        let value = written.parse::<f64>().ok().filter(|value| value.is_finite());
        if value.is_none() {
            mistakes.add(at, "this number is too large");
        }
        self.push(TokenKind::Number(value.unwrap_or(1.0)), to - from);
        let rest = &self.text[to..];
        let length = rest.find(|c| !continues_name(c)).unwrap_or(rest.len());
        if length > 0 {
            let name = &rest[..length];
            mistakes.add(
                Stretch { from, to: to + length },
                format!("a number and a name need a sign between them, such as `{written} * {name}`; a unit stands in brackets, `{written} [{name}]`"),
            );
            self.at += length;
        }
    }
}

fn begins_name(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

fn continues_name(c: char) -> bool {
    // Raised digits are powers; lowered ones belong to names.
    begins_name(c) || c.is_ascii_digit() || ('₀'..='₉').contains(&c)
}

/// Whether a text is a name as law files have them, and not too long.
#[cfg(feature = "wasm")]
pub(crate) fn is_name(text: &str) -> bool {
    text.starts_with(begins_name) && text.chars().all(continues_name) && text.chars().count() <= NAME_MAX
}

/// What comes behind blank lines and comments.
fn next_code(text: &str) -> &str {
    let mut rest = text.trim_start();
    while let Some(comment) = rest.strip_prefix('#') {
        rest = comment.find('\n').map_or("", |end| comment[end..].trim_start());
    }
    rest
}

/// Words that begin a statement and stand nowhere else.
const STARTERS: [&str; 8] =
    ["let", "repeat", "function", "parameter", "memory", "command", "leaders", "knows"];

/// Whether a line begins with one of these words.
fn begins_with_any(rest: &str, words: &[&str]) -> bool {
    let begins = |word: &&str| rest.strip_prefix(*word).is_some_and(|rest| !rest.starts_with(continues_name));
    words.iter().any(begins)
}

/// Whether a line begins with what only continues another one.
fn begins_with_join(rest: &str) -> bool {
    let sign = SIGNS.iter().find(|(typed, _)| rest.starts_with(typed));
    sign.is_some_and(|(_, sign)| JOINS.contains(sign)) || begins_with_any(rest, &["and", "or", "else"])
}
