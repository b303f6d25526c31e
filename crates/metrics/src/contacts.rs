//! The contacts of a run, each counted once.

use serde::Serialize;
use std::collections::BTreeMap;
use vocabulary::{Contact, FleetInfo};

/// Contacts that metrics list one by one.
const LISTED: usize = 100;

/// One contact.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct ContactMetrics {
    /// The two.
    pub between: [String; 2],
    /// First touch, s.
    pub begin: f64,
    /// Last touch, s.
    pub end: f64,
    /// Of the first touch, m.
    pub place: [f64; 3],
    /// From the first to the second.
    pub normal: [f64; 3],
    /// N s.
    pub impulse: f64,
}

/// Takes in the contacts of moment after moment: most of them again and again, until they end. Contacts between props
/// go into the table only.
#[derive(Debug, Clone, Default)]
pub(crate) struct ContactLog {
    /// Contacts of robots.
    pub(crate) count: usize,
    /// Number of the newest that was counted: contacts come in the order in which they began.
    newest: Option<u64>,
    /// Largest impulse, N s.
    pub(crate) largest: f64,
    first: Vec<Contact>,
    /// Those that had not ended when last seen, by number.
    open: BTreeMap<u64, Contact>,
}

impl ContactLog {
    pub(crate) fn push(&mut self, contacts: &[Contact]) {
        for contact in contacts {
            if contact.of_robot() {
                self.note(contact);
            }
            if contact.open {
                self.open.insert(contact.number, *contact);
            } else {
                self.open.remove(&contact.number);
            }
        }
    }

    /// Counts a contact of a robot, once.
    fn note(&mut self, contact: &Contact) {
        self.largest = self.largest.max(contact.impulse);
        if let Some(known) = self.first.iter_mut().find(|known| known.number == contact.number) {
            *known = *contact;
        } else if self.newest.is_none_or(|newest| contact.number > newest) {
            self.newest = Some(contact.number);
            self.count += 1;
            if self.first.len() < LISTED {
                self.first.push(*contact);
            }
        }
    }

    /// Those that have not ended, as if they ended now.
    pub(crate) fn close(&self) -> Vec<Contact> {
        self.open.values().map(|contact| Contact { open: false, ..*contact }).collect()
    }

    pub(crate) fn first(&self, fleet: &FleetInfo) -> Vec<ContactMetrics> {
        let entry = |contact: &Contact| {
            let Contact { things, begin, end, place, normal, impulse, .. } = *contact;
            let between = things.map(|thing| fleet.name(thing).to_owned());
            ContactMetrics { between, begin, end, place, normal, impulse }
        };
        self.first.iter().map(entry).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vocabulary::EntityId;

    #[test]
    fn a_contact_that_lasts_is_one() {
        let contact = |number, impulse, open| Contact {
            number,
            things: [EntityId::Robot(0), EntityId::Ground],
            begin: 1.0,
            end: 2.0,
            open,
            place: [0.0; 3],
            normal: [0.0, 0.0, -1.0],
            impulse,
        };
        let props =
            |number| Contact { things: [EntityId::Prop(0), EntityId::Prop(1)], ..contact(number, 9.0, true) };
        let mut log = ContactLog::default();
        log.push(&[contact(0, 1.0, true)]);
        log.push(&[contact(0, 5.0, true), contact(1, 2.0, true)]);
        log.push(&[contact(0, 5.0, false), contact(1, 3.0, true), props(2)]);
        assert_eq!((log.count, log.largest), (2, 5.0));
        assert_eq!(log.close(), [contact(1, 3.0, false), Contact { open: false, ..props(2) }]);
        let first = log.first(&FleetInfo::default());
        assert_eq!((first.len(), first[1].impulse, &*first[1].between[1]), (2, 3.0, "ground"));
    }
}
