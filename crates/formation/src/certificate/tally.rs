//! What statements need of all samples, kept in a size that does not grow with the run.
//!
//! Some bounds are known at the end only, since they come of the largest that a run went through. They rise as it goes;
//! so a sample that is inside now stays inside, and one that is outside counts only where no other outdoes it.

use super::premise::Spell;

/// At which samples something was so.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Tally {
    ends: Option<[f64; 2]>,
    count: u64,
}

impl Tally {
    pub(super) fn note(&mut self, time: f64, so: bool) {
        if so {
            self.ends = Some([self.ends.map_or(time, |ends| ends[0]), time]);
            self.count += 1;
        }
    }

    /// Among so many samples.
    pub(super) fn spell(&self, samples: u64) -> Option<Spell> {
        let [first, last] = self.ends?;
        Some(Spell { first, last, share: self.count as f64 / samples.max(1) as f64 })
    }
}

/// A value below zero at some samples, and its least.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Margin {
    pub(super) below: Tally,
    pub(super) least: Option<f64>,
}

impl Margin {
    pub(super) fn note(&mut self, time: f64, room: f64) {
        self.below.note(time, room < 0.0);
        self.least = Some(self.least.map_or(room, |least| least.min(room)));
    }
}

/// A sample with two values, each of which has to lie above a bound for it to count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BoundEvent {
    pub(super) time: f64,
    pub(super) values: [f64; 2],
}

impl BoundEvent {
    fn above(&self, bounds: [f64; 2]) -> bool {
        self.values[0] > bounds[0] && self.values[1] > bounds[1]
    }

    /// Whether it counts wherever the other does.
    fn covers(&self, other: &Self) -> bool {
        self.values[0] >= other.values[0] && self.values[1] >= other.values[1]
    }
}

/// Most events that are kept: a run that swings or drifts for ever leaves no more. Of more than these, those nearest to
/// the bounds all stay, and of the others every other one goes: only if a bound later rises past the nearest ones may a
/// time or a margin be that of a neighbour.
const MOST: usize = 2048;

/// The first, the last and the largest event above two bounds that rise until the end.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Outside {
    /// In the order of time; none is covered by one before it.
    first: Vec<BoundEvent>,
    /// In the order of time; none is covered by one after it.
    last: Vec<BoundEvent>,
}

impl Outside {
    /// Takes in the next event, with the bounds as they are now.
    pub(super) fn note(&mut self, event: BoundEvent, bounds: [f64; 2]) {
        self.first.retain(|known| known.above(bounds));
        self.last.retain(|known| known.above(bounds));
        if !event.above(bounds) {
            return;
        }
        if !self.first.iter().any(|known| known.covers(&event)) {
            self.first.push(event);
        }
        self.last.retain(|known| !event.covers(known));
        self.last.push(event);
        self.thin();
    }

    /// Takes in an event from before all others, with the bounds as they are now.
    fn note_before(&mut self, event: BoundEvent, bounds: [f64; 2]) {
        if !event.above(bounds) {
            return;
        }
        self.first.retain(|known| !event.covers(known));
        self.first.insert(0, event);
        if !self.last.iter().any(|known| known.covers(&event)) {
            self.last.insert(0, event);
        }
        self.thin();
    }

    /// The values rise along the first events and fall along the last ones.
    fn thin(&mut self) {
        thin(&mut self.first, true);
        thin(&mut self.last, false);
    }

    /// First and last time of an event above the bounds, s.
    pub(super) fn ends(&self, bounds: [f64; 2]) -> Option<[f64; 2]> {
        let first = self.first.iter().find(|event| event.above(bounds))?;
        let last = self.last.iter().rev().find(|event| event.above(bounds))?;
        Some([first.time, last.time])
    }
}

/// The largest first value of events whose second lies above a bound that rises until the end; in the order of the
/// second value.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Largest(Vec<BoundEvent>);

impl Largest {
    pub(super) fn note(&mut self, event: BoundEvent, bound: f64) {
        self.0.retain(|known| known.values[1] > bound && !event.covers(known));
        if event.values[1] > bound && !self.0.iter().any(|known| known.covers(&event)) {
            let place = self.0.partition_point(|known| known.values[1] < event.values[1]);
            self.0.insert(place, event);
        }
        thin(&mut self.0, true);
    }

    pub(super) fn above(&self, bound: f64) -> Option<f64> {
        self.0.iter().filter(|event| event.values[1] > bound).map(|event| event.values[0]).reduce(f64::max)
    }
}

/// Where a value lies above a bound from a time on, when the bound rises and the time falls until the end.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct OutsideLate {
    /// Before that time as it is now: they count only if it falls to them.
    early: Vec<BoundEvent>,
    late: Outside,
    largest: Option<f64>,
}

impl OutsideLate {
    /// Takes in the next value; `from` is `None` while the time is not known at all.
    pub(super) fn note(&mut self, time: f64, value: f64, bound: f64, from: Option<f64>) {
        let event = BoundEvent { time, values: [value, f64::INFINITY] };
        if from.is_none_or(|from| time < from) {
            self.early.push(event);
        } else {
            self.late.note(event, [bound, 0.0]);
            self.largest = Some(self.largest.map_or(value, |largest| largest.max(value)));
        }
        self.settle(bound, from);
        thin(&mut self.early, false);
    }

    /// What is no longer too early is late.
    fn settle(&mut self, bound: f64, from: Option<f64>) {
        let Some(from) = from else { return };
        let begin = self.early.partition_point(|event| event.time < from);
        for event in self.early.drain(begin..).rev() {
            let value = event.values[0];
            self.largest = Some(self.largest.map_or(value, |largest| largest.max(value)));
            self.late.note_before(event, [bound, 0.0]);
        }
    }

    /// First and last time above the bound, s, and the largest value, from a time on.
    pub(super) fn from(&self, time: f64, bound: f64) -> (Option<[f64; 2]>, Option<f64>) {
        let mut all = self.clone();
        all.settle(bound, Some(time));
        (all.late.ends([bound, 0.0]), all.largest)
    }
}

/// Of too many events, leaves out every other one of the later half, or of the earlier half.
fn thin(events: &mut Vec<BoundEvent>, later: bool) {
    if events.len() <= MOST {
        return;
    }
    let (mut index, middle) = (0, events.len() / 2);
    events.retain(|_| {
        index += 1;
        (index > middle) != later || index % 2 == 1
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// What is kept gives what all events give, whatever the bounds become.
        #[test]
        fn nothing_is_lost_that_counts(
            events in proptest::collection::vec([0.0..4.0, 0.0..4.0, 0.0..0.3, 0.0..0.3], 1..80),
            more in [0.0..2.0, 0.0..2.0],
        ) {
            let (mut outside, mut largest, mut bounds) = (Outside::default(), Largest::default(), [0.0; 2]);
            let mut all = vec![];
            for (k, [a, b, da, db]) in (0..).zip(events) {
                bounds = [bounds[0] + da * 0.2, bounds[1] + db * 0.2];
                let event = BoundEvent { time: f64::from(k), values: [a, b] };
                outside.note(event, bounds);
                largest.note(event, bounds[1]);
                all.push(event);
            }
            let bounds = [bounds[0] + more[0], bounds[1] + more[1]];
            let counted: Vec<_> = all.iter().filter(|event| event.above(bounds)).collect();
            let ends = counted.first().zip(counted.last()).map(|(a, b)| [a.time, b.time]);
            prop_assert_eq!(outside.ends(bounds), ends);
            let most = all.iter().filter(|e| e.values[1] > bounds[1]).map(|e| e.values[0]).reduce(f64::max);
            prop_assert_eq!(largest.above(bounds[1]), most);
        }
    }

    proptest! {
        /// As above, with a time from which on it counts that falls.
        #[test]
        fn nothing_is_lost_that_is_late(
            values in proptest::collection::vec([0.0..4.0, 0.0..2.0], 1..80),
            unknown in 0_usize..20,
            [more, less] in [0.0..2.0, 0.0..30.0],
        ) {
            let (mut outside, mut bound, mut from) = (OutsideLate::default(), 0.0, 60.0);
            for (k, [value, step]) in values.iter().enumerate() {
                (bound, from) = (bound + 0.02 * step, from - step);
                outside.note(k as f64, *value, bound, (k >= unknown).then_some(from));
            }
            let (bound, from) = (bound + more, from - less);
            let late: Vec<_> = values.iter().enumerate().filter(|(k, _)| *k as f64 >= from).collect();
            let above: Vec<_> = late.iter().filter(|(_, v)| v[0] > bound).map(|(k, _)| *k as f64).collect();
            let ends = above.first().zip(above.last()).map(|(a, b)| [*a, *b]);
            let largest = late.iter().map(|(_, v)| v[0]).reduce(f64::max);
            prop_assert_eq!(outside.from(from, bound), (ends, largest));
        }
    }

    #[test]
    fn what_is_kept_has_an_end() {
        let (mut outside, mut largest) = (Outside::default(), Largest::default());
        for k in 0..10_000 {
            let rising = f64::from(k);
            outside.note(BoundEvent { time: rising, values: [rising, 1.0] }, [-1.0, 0.0]);
            outside.note(BoundEvent { time: rising, values: [-rising, 2.0] }, [-1e9, 0.0]);
            largest.note(BoundEvent { time: rising, values: [rising, -rising] }, -1e9);
        }
        assert!(outside.first.len() <= MOST && outside.last.len() <= MOST && largest.0.len() <= MOST);
    }
}
