//! A link without repetition: what all followers get at a time is said once.

use super::difference::tightened;
use super::{Link, TimedOverride};
use crate::Override;

impl Link {
    /// The same link, shorter where the changes of one time give every follower the same value.
    #[must_use]
    pub fn shortened(self) -> Self {
        let changes = self.changes.iter().map(|TimedOverride { at, set }| {
            let set = tightened(&set.to_string()).unwrap_or_else(|| set.clone());
            TimedOverride { at: *at, set }
        });
        let tight = Self { changes: changes.collect(), ..self };
        let Ok(opened) = tight.open() else { return tight };
        let followers = opened.scene.followers().count();
        let short = Self { changes: together(&tight.changes, followers), ..tight.clone() };
        // A value of one robot stays before that of all: then the two are not the same.
        if short.open().is_ok_and(|short| short.scene == opened.scene) { short } else { tight }
    }
}

/// Changes of which those that all `followers` have are one.
fn together(changes: &[TimedOverride], followers: usize) -> Vec<TimedOverride> {
    let mut short: Vec<TimedOverride> = vec![];
    for change in changes {
        let common = common(&change.set).filter(|common| {
            let alike = |other: &&TimedOverride| {
                other.at == change.at && self::common(&other.set).as_ref() == Some(common)
            };
            followers > 1 && changes.iter().filter(alike).count() == followers
        });
        let next = TimedOverride { at: change.at, set: common.unwrap_or_else(|| change.set.clone()) };
        if !short.contains(&next) {
            short.push(next);
        }
    }
    short
}

/// The override for all followers that one for a single robot is a part of.
fn common(set: &Override) -> Option<Override> {
    let (path, value) = set.parts();
    let (_, key) = path.strip_prefix("robots.")?.split_once('.')?;
    key.contains('.').then(|| format!("{key}={value}").parse().ok())?
}
