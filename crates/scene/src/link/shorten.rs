//! A link without repetition: what all followers get at a time is said once.

use super::difference::tightened;
use super::{Link, TimedOverride};
use crate::Override;
use std::collections::BTreeMap;

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
    let common: Vec<Option<(u64, String)>> =
        changes.iter().map(|change| common(&change.set).map(|set| (change.at.to_bits(), set))).collect();
    let mut counts: BTreeMap<&(u64, String), usize> = BTreeMap::new();
    for known in common.iter().flatten() {
        *counts.entry(known).or_default() += 1;
    }
    let mut short = vec![];
    for (change, common) in changes.iter().zip(&common) {
        let count = common.as_ref().and_then(|common| counts.get_mut(common));
        match (common, count) {
            (Some((_, set)), Some(count)) if followers > 1 && (*count == followers || *count == 0) => {
                // The first one speaks for all.
                if *count > 0
                    && let Ok(set) = set.parse()
                {
                    short.push(TimedOverride { at: change.at, set });
                }
                *count = 0;
            }
            _ => short.push(change.clone()),
        }
    }
    short
}

/// The override for all followers that one for a single robot is a part of.
fn common(set: &Override) -> Option<String> {
    let (path, value) = set.parts();
    let (_, key) = path.strip_prefix("robots.")?.split_once('.')?;
    key.contains('.').then(|| format!("{key}={value}"))
}
