//! A link as text.

use super::{Link, LinkOrigin, LinkProof, TimedOverride};
use crate::Override;
use crate::packed::pack;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use std::fmt;

/// What is escaped in keys: all that has a meaning in links or addresses.
const IN_KEYS: &AsciiSet = &NON_ALPHANUMERIC.remove(b'-').remove(b'.').remove(b'_');
/// What is escaped in values.
const IN_VALUES: &AsciiSet = &IN_KEYS.remove(b',').remove(b':').remove(b'/').remove(b'@');

impl fmt::Display for Link {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.origin {
            LinkOrigin::Shipped(shipped) => write!(f, "#{}", shipped.name)?,
            LinkOrigin::Text(text) => write!(f, "#~{}", pack(text.as_bytes()))?,
        }
        let sets = self.set.iter().map(written);
        let changes = self.changes.iter().map(|TimedOverride { at, set }| format!("@{at}:{}", written(set)));
        let texts = [("view", &self.view), ("selected", &self.selected), ("branch", &self.branch)];
        let texts = texts.into_iter().filter_map(|(key, text)| Some((key, text.as_deref()?)));
        let proof =
            self.proof.iter().flat_map(|LinkProof { version, digits }| [("v", version), ("d", digits)]);
        let parts = sets.chain(changes).chain(self.time.map(|time| format!("t={time}"))).chain(
            texts
                .chain(proof.map(|(key, text)| (key, &**text)))
                .map(|(key, text)| format!("{key}={}", utf8_percent_encode(text, IN_VALUES))),
        );
        for (index, part) in parts.enumerate() {
            write!(f, "{}{part}", if index == 0 { '?' } else { '&' })?;
        }
        Ok(())
    }
}

/// An override.
fn written(set: &Override) -> String {
    let (path, value) = set.parts();
    let key = utf8_percent_encode(path, IN_KEYS).to_string();
    // Links have words of their own.
    let key = match key.as_bytes() {
        [first, rest @ ..] if super::read::WORDS.contains(&&*key) => {
            format!("%{first:02X}{}", String::from_utf8_lossy(rest))
        }
        _ => key,
    };
    format!("{key}={}", utf8_percent_encode(value, IN_VALUES))
}
