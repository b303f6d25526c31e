//! A link from text.

use super::error::shown;
use super::{LATEST, Link, LinkError, LinkOrigin, LinkProof, MOST_BYTES, MOST_SETS, TimedOverride};
use crate::document::Document;
use crate::packed::{Damage, unpack};
use crate::shipped::{nearest_shipped, shipped};
use crate::text::Keys;
use crate::{Override, composed};
use percent_encoding::percent_decode_str;
use std::str::FromStr;

/// Keys that links have and scenes have not.
pub(super) const WORDS: [&str; 6] = ["t", "view", "selected", "branch", "v", "d"];

impl FromStr for Link {
    type Err = LinkError;

    /// Reads a link, with or without `#`, alone or behind the address of a page.
    fn from_str(text: &str) -> Result<Self, LinkError> {
        if text.len() > MOST_BYTES {
            return Err(LinkError::Long(text.len()));
        }
        let text = text.trim();
        let link = match text.split_once('#') {
            Some((_, link)) => link,
            None if text.contains("://") => return Err(LinkError::Foreign),
            None => text,
        };
        let (origin, parts) = link.split_once('?').unwrap_or((link, ""));
        let parts: Vec<&str> = parts.split('&').filter(|part| !part.is_empty()).collect();
        let version = parts.iter().find_map(|part| part.strip_prefix("v=")).unwrap_or("");
        read(origin, &parts).map_err(|fault| newer(fault, version))
    }
}

/// A fault, with the version that made the link where that is newer.
fn newer(fault: LinkError, version: &str) -> LinkError {
    let proof = LinkProof { version: shown(version), digits: String::new() };
    if proof.newer() && !matches!(fault, LinkError::CutOff(_)) {
        LinkError::Newer { version: proof.version, fault: Box::new(fault) }
    } else {
        fault
    }
}

impl Link {
    /// `fault`, with the version that made the link where that is newer.
    pub(super) fn explained(&self, fault: LinkError) -> LinkError {
        newer(fault, self.proof.as_ref().map_or("", |proof| &proof.version))
    }
}

fn read(origin: &str, parts: &[&str]) -> Result<Link, LinkError> {
    let mut link = Link::to(origin_of(origin)?);
    let (mut version, mut digits) = (None, None);
    for part in parts {
        let (key, value) = part
            .split_once('=')
            .ok_or_else(|| LinkError::Part(shown(part), "key=value, with & between parts"))?;
        match key {
            "t" => put("t", &mut link.time, time(value, part)?)?,
            "view" => put("view", &mut link.view, plain(value)?)?,
            "selected" => put("selected", &mut link.selected, plain(value)?)?,
            "branch" => put("branch", &mut link.branch, plain(value)?)?,
            "v" => put("v", &mut version, plain(value)?)?,
            "d" => put("d", &mut digits, value.to_ascii_lowercase())?,
            _ => match key.strip_prefix('@') {
                Some(later) => {
                    let (at, path) = later.split_once(':').ok_or_else(|| {
                        LinkError::Part(shown(part), "@TIME:key=value for what is set later")
                    })?;
                    let set = set(path, value)?;
                    link.changes.push(TimedOverride { at: time(at, part)?, set });
                }
                None => link.set.push(set(key, value)?),
            },
        }
        for (count, most) in [link.set.len(), link.changes.len()].into_iter().zip(MOST_SETS) {
            if count > most {
                return Err(LinkError::Sets(most));
            }
        }
    }
    link.proof = proof(version, digits)?;
    Ok(link)
}

/// What version and digits prove.
fn proof(version: Option<String>, digits: Option<String>) -> Result<Option<LinkProof>, LinkError> {
    let of_digits = |digits: &str| digits.chars().all(|c| c.is_ascii_hexdigit());
    let (version, digits) = match (version, digits) {
        (None, None) => return Ok(None),
        (Some(_), None) => {
            let text = "it ends before its digest (`d=`). Where it was edited by hand, take `v=` out too";
            return Err(LinkError::CutOff(text.to_owned()));
        }
        (version, Some(digits)) => (version.unwrap_or_default(), digits),
    };
    if digits.len() < LinkProof::DIGITS && of_digits(&digits) {
        let text = format!("its digest has {} digits of {}", digits.len(), LinkProof::DIGITS);
        return Err(LinkError::CutOff(text));
    }
    if digits.len() != LinkProof::DIGITS || !of_digits(&digits) {
        return Err(LinkError::Part(shown(&format!("d={digits}")), "d= and 8 hexadecimal digits"));
    }
    let known = |part: &str| part.len() <= 6 && part.parse::<u32>().is_ok();
    if version.split('.').count() != 3 || !version.split('.').all(known) {
        return Err(LinkError::Part(shown(&format!("v={version}")), "a version such as v=0.1.0"));
    }
    Ok(Some(LinkProof { version, digits }))
}

fn origin_of(text: &str) -> Result<LinkOrigin, LinkError> {
    if let Some(packed) = text.strip_prefix('~') {
        let bytes = unpack(packed).map_err(|damage| match damage {
            Damage::CutOff => LinkError::CutOff("its scene ends in the middle".to_owned()),
            Damage::Other(what) => LinkError::Damaged(what),
        })?;
        let text = String::from_utf8(bytes);
        return text.map(LinkOrigin::Text).map_err(|_| LinkError::Damaged("unpacks to what is no text"));
    }
    if text.is_empty() {
        return Err(LinkError::Empty);
    }
    let name = plain(text)?;
    shipped(&name).map(LinkOrigin::Shipped).ok_or_else(|| {
        let meant =
            nearest_shipped(&name).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        LinkError::Scene(shown(&name), meant)
    })
}

/// Puts what may stand in a link once.
fn put<T>(key: &'static str, place: &mut Option<T>, value: T) -> Result<(), LinkError> {
    match place.replace(value) {
        None => Ok(()),
        Some(_) => Err(LinkError::Twice(key)),
    }
}

/// A time, s.
fn time(text: &str, part: &str) -> Result<f64, LinkError> {
    let time = text.parse::<f64>().ok().filter(|time| (0.0..=LATEST).contains(time));
    // Adding 0 turns −0 into 0.
    time.map(|time| time + 0.0).ok_or_else(|| LinkError::Part(shown(part), "a time from 0 to 100000 s"))
}

fn set(path: &str, value: &str) -> Result<Override, LinkError> {
    let (path, value) = (plain(path)?, plain(value)?);
    if path.contains('=') {
        return Err(LinkError::Part(shown(&path), "a key such as law.k"));
    }
    let first = path.split('.').next().unwrap_or(&path).trim();
    if Document::marks(first).is_none() {
        return Err(LinkError::Key(shown(&path)));
    }
    format!("{path}={value}").parse().map_err(|error| match error {
        crate::OverrideError::Form(_) => LinkError::Part(shown(&path), "a key such as law.k"),
        deep @ crate::OverrideError::Deep(_) => deep.into(),
    })
}

/// Text without its escapes.
fn plain(text: &str) -> Result<String, LinkError> {
    let mut escapes = text.split('%').skip(1).peekable();
    while let Some(escape) = escapes.next() {
        let digits = escape.as_bytes().iter().take(2).filter(|byte| byte.is_ascii_hexdigit()).count();
        if digits < 2 && escape.len() == digits && escapes.peek().is_none() {
            return Err(LinkError::CutOff(format!("`{}` ends in an escape", shown(text))));
        }
        if digits < 2 {
            return Err(LinkError::Part(shown(text), "%25 for a %"));
        }
    }
    let text = percent_decode_str(text).decode_utf8();
    text.map(|text| composed(&text))
        .map_err(|_| LinkError::Damaged("has an escape that stands for no character"))
}
