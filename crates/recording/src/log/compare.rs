//! Holds two logs against each other, moment by moment and bit by bit.

use super::events::EventMessage;
use super::messages::ContactRecord;
use super::read::Log;
use super::record::{self, FieldValue, Fields, Record};
use super::safety::SafetyRecord;
use crate::Error;
use std::collections::BTreeMap;
use vocabulary::{FleetInfo, PlannedPath, StepRecord, wrap};

/// One quantity of one robot or edge at one sample, as two logs have it.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Sample, counted from 0.
    pub sample: u64,
    /// s.
    pub time: f64,
    /// Whose it is, such as `robot bob` or `edge ann → bob`.
    pub of: String,
    /// Name of the field, its unit at the end, as in the tables.
    pub quantity: &'static str,
    /// As the logs have it.
    pub values: [String; 2],
}

/// The largest difference of a quantity over a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Peak {
    /// Name of the field, its unit at the end.
    pub quantity: &'static str,
    /// Largest magnitude; of words and flags, infinite.
    pub most: f64,
    /// Whose it was.
    pub of: String,
    /// When, s.
    pub time: f64,
}

/// What came of a comparison.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Comparison {
    /// Samples that both have.
    pub samples: u64,
    /// Samples that only one of them has: of the first, of the second.
    pub more: [u64; 2],
    /// The first quantity that differs.
    pub first: Option<Difference>,
    /// Samples that differ.
    pub differing: u64,
    /// Largest difference of every quantity that differs anywhere, by edges, robots, props, contacts, measurements, filters.
    pub peaks: Vec<Peak>,
}

impl Comparison {
    /// Whether both are the same, bit for bit.
    pub fn same(&self) -> bool {
        self.differing == 0 && self.more == [0, 0]
    }
}

/// Compares the moments of two logs whose casts have the same robots and edges; a difference of numbers of at most
/// `tolerance` is none. `tick` hears of every sample and says whether to go on.
///
/// # Errors
/// [`Error::Log`] where one of them is damaged.
pub fn compare(
    [a, b]: [&Log; 2],
    tolerance: f64,
    mut tick: impl FnMut(u64) -> bool,
) -> Result<Comparison, Error> {
    let (mut left, mut right) = (a.records(), b.records());
    let mut result = Comparison::default();
    let mut peaks = BTreeMap::new();
    let mut bytes = [vec![], vec![]];
    loop {
        match (left.next().transpose()?, right.next().transpose()?) {
            (None, None) => break,
            (Some(_), None) => result.more[0] += 1,
            (None, Some(_)) => result.more[1] += 1,
            (Some(p), Some(q)) => {
                let mut pair = [p, q];
                for (record, bytes) in pair.iter_mut().zip(&mut bytes) {
                    bits(record, bytes);
                }
                if bytes[0] != bytes[1] {
                    result.note(a.fleet(), &pair, tolerance, &mut peaks);
                }
                result.samples += 1;
            }
        }
        if !tick(result.samples) {
            break;
        }
    }
    result.peaks = peaks.into_values().collect();
    Ok(result)
}

/// All of a moment as bytes.
fn bits(record: &mut StepRecord, out: &mut Vec<u8>) {
    out.clear();
    out.extend(record.snapshot.time.to_le_bytes());
    for robot in &mut record.snapshot.robots {
        record::write(robot, out);
    }
    for edge in &mut record.edges {
        record::write(edge, out);
    }
    for prop in &mut record.snapshot.props {
        record::write(prop, out);
    }
    for contact in &record.contacts {
        record::write(&mut ContactRecord { contact: *contact, ..ContactRecord::default() }, out);
    }
    for frame in &mut record.frames {
        out.extend(frame.edge.to_le_bytes());
        record::write(frame, out);
    }
    for state in &record.safety {
        out.extend(state.robot.to_le_bytes());
        record::write(&mut SafetyRecord::new(state, &FleetInfo::default()), out);
    }
    for law in &mut record.laws {
        out.extend(law.robot.to_le_bytes());
        record::write(law, out);
    }
    for event in &record.events {
        record::write(&mut EventMessage::new(event, &FleetInfo::default()), out);
    }
    for plan in &record.plans {
        record::write(&mut PlannedPath::clone(plan), out);
    }
    for leader in &record.leaders {
        out.extend(leader.map_or(u64::MAX, |leader| leader as u64).to_le_bytes());
    }
}

/// The order of kinds, then that of fields.
type Place = (usize, usize);

impl Comparison {
    fn note(
        &mut self,
        fleet: &FleetInfo,
        pair: &[StepRecord; 2],
        tolerance: f64,
        peaks: &mut BTreeMap<Place, Peak>,
    ) {
        let time = pair[0].snapshot.time;
        let [a, b] = [0, 1].map(|k| quantities(&pair[k], fleet));
        let before = self.first.is_some();
        let mut differs = false;
        let found = a.iter().map(Some).chain(std::iter::repeat(None));
        let other = b.iter().map(Some).chain(std::iter::repeat(None));
        for (p, q) in found.zip(other).take(a.len().max(b.len())) {
            let Some(one) = p.or(q) else { break };
            let Some(difference) = apart(p, q).filter(|difference| *difference > tolerance) else { continue };
            differs = true;
            let peak = Peak { quantity: one.name, most: difference, of: one.of.clone(), time };
            let known = peaks.entry(one.place).or_insert_with(|| peak.clone());
            if difference > known.most {
                *known = peak;
            }
            if !before && self.first.is_none() {
                let text = |q: Option<&ComparedQuantity>| {
                    q.map_or_else(|| "not there".to_owned(), ComparedQuantity::text)
                };
                self.first = Some(Difference {
                    sample: self.samples,
                    time,
                    of: one.of.clone(),
                    quantity: one.name,
                    values: [text(p), text(q)],
                });
            }
        }
        self.differing += u64::from(differs);
    }
}

/// How far two are apart; `None` where they are the same bit for bit.
fn apart(a: Option<&ComparedQuantity>, b: Option<&ComparedQuantity>) -> Option<f64> {
    let (Some(a), Some(b)) = (a, b) else { return Some(f64::INFINITY) };
    match (&a.value, &b.value) {
        (ComparedValue::Number(p), ComparedValue::Number(q)) if p.to_bits() == q.to_bits() => None,
        (ComparedValue::Number(p), ComparedValue::Number(q)) => {
            let angle = a.name.ends_with("_rad");
            let difference = if angle { wrap(p - q) } else { p - q }.abs();
            Some(if difference.is_nan() { f64::INFINITY } else { difference })
        }
        (p, q) => (p != q || a.of != b.of).then_some(f64::INFINITY),
    }
}

#[derive(Debug, PartialEq)]
enum ComparedValue {
    Number(f64),
    Word(String),
}

struct ComparedQuantity {
    of: String,
    name: &'static str,
    place: Place,
    value: ComparedValue,
}

impl ComparedQuantity {
    fn text(&self) -> String {
        match &self.value {
            ComparedValue::Number(number) => number.to_string(),
            ComparedValue::Word(word) => word.clone(),
        }
    }
}

/// All quantities of a moment, by edge, robot, prop, contact, measurement, safety filter, law and event.
fn quantities(record: &StepRecord, fleet: &FleetInfo) -> Vec<ComparedQuantity> {
    let mut all = Collector { of: "sample".to_owned(), table: 0, field: 0, found: vec![] };
    let mut record = record.clone();
    all.add("time_s", ComparedValue::Number(record.snapshot.time));
    let name = |robot: usize| fleet.robots.get(robot).map_or("?", |member| &*member.name);
    let pair =
        |edge: usize| fleet.edges.get(edge).map_or_else(String::new, |edge| fleet.pair(*edge).join(" → "));
    if !record.leaders.is_empty() {
        let leaders = record.leaders.iter().enumerate().map(|(edge, leader)| {
            let follower = fleet.edges.get(edge).map_or("?", |edge| name(edge.follower));
            format!("{follower} follows {}", leader.map_or("nobody", name))
        });
        all.add("leaders", ComparedValue::Word(leaders.collect::<Vec<_>>().join(", ")));
    }
    // What a follower wanted stands before what became of it.
    for (index, edge) in record.edges.iter_mut().enumerate() {
        all.collect(1, format!("edge {}", pair(index)), edge);
    }
    for (index, robot) in record.snapshot.robots.iter_mut().enumerate() {
        all.collect(2, format!("robot {}", name(index)), robot);
    }
    for (index, prop) in record.snapshot.props.iter_mut().enumerate() {
        all.collect(3, format!("prop {}", fleet.props.get(index).map_or("?", |prop| &prop.name)), prop);
    }
    for contact in &record.contacts {
        let [first, second] = contact.things.map(|thing| fleet.name(thing).to_owned());
        let of = format!("contact of {first} and {second}");
        all.collect(4, of, &mut ContactRecord { contact: *contact, names: [first, second] });
    }
    for frame in &mut record.frames {
        all.collect(5, format!("measurement of {}", pair(frame.edge)), frame);
    }
    for state in &record.safety {
        let of = format!("safety filter of {}", name(state.robot));
        all.collect(6, of, &mut SafetyRecord::new(state, fleet));
    }
    for law in &mut record.laws {
        all.collect(8, format!("law of {}", name(law.robot)), law);
    }
    for event in &record.events {
        all.collect(7, "what happened".to_owned(), &mut EventMessage::new(event, fleet));
    }
    for plan in &record.plans {
        let of = format!("plan of {}", plan.lead().map_or("", name));
        all.collect(9, of, &mut PlannedPath::clone(plan));
    }
    all.found
}

struct Collector {
    of: String,
    table: usize,
    field: usize,
    found: Vec<ComparedQuantity>,
}

impl Collector {
    fn collect<T: Record>(&mut self, table: usize, of: String, record: &mut T) {
        (self.of, self.table, self.field) = (of, table, 0);
        // What collects never refuses.
        let _ = record.list(self);
    }

    fn add(&mut self, name: &'static str, value: ComparedValue) {
        self.found.push(ComparedQuantity {
            of: self.of.clone(),
            name,
            place: (self.table, self.field),
            value,
        });
        self.field += 1;
    }
}

impl Fields for Collector {
    fn field(&mut self, name: &'static str, value: FieldValue<'_>) -> Option<()> {
        let value = match value {
            FieldValue::Number(value) => ComparedValue::Number(*value),
            FieldValue::Count(value) => ComparedValue::Number(*value as f64),
            FieldValue::Flag(value) => ComparedValue::Word(value.to_string()),
            FieldValue::Text(text) => ComparedValue::Word(text.clone()),
            FieldValue::Series(values) => ComparedValue::Word(format!("{values:?}")),
            FieldValue::Choice(index, words) => ComparedValue::Word(words[*index].to_owned()),
            FieldValue::Numbers(values) => {
                let field = self.field;
                for value in values {
                    self.field = field;
                    self.add(name, ComparedValue::Number(*value));
                }
                return Some(());
            }
        };
        self.add(name, value);
        Some(())
    }

    fn each<T: Record + Default>(&mut self, _: &'static str, _: &mut Vec<T>) -> Option<()> {
        // No message of a moment holds others.
        Some(())
    }
}
