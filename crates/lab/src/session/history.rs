//! Everything simulated so far, branch by branch: records, trails and clearances.

use metrics::clearance::Clearance;
use rendering::Trail;
use std::sync::Arc;
use vocabulary::{BarrierState, EventRecord, FleetInfo, SafetyState, StepRecord};

/// Maximum memory of the records of a branch, bytes.
const MOST_BYTES: usize = 96 << 20;
/// Limits of the number of records of a branch, whatever their size.
const MOST_MOMENTS: usize = 20_000;
const LEAST_MOMENTS: usize = 600;
/// About as many barriers as a filter has at once.
const FEW_BARRIERS: usize = 8;
/// Initial time between two kept trails, s; it doubles when there are too many.
const TRAIL_EVERY: f64 = 2.0;
const MOST_TRAILS: usize = 40;

/// The history of all branches.
pub struct History {
    fleet: Arc<FleetInfo>,
    period: f64,
    past: Vec<BranchHistory>,
    /// Measures clearance; in its initial state.
    clearance: Option<Clearance>,
    /// The last trail, since the next request is usually near it.
    shown: Option<(usize, Trail)>,
}

/// The history of a branch, including that of its parent before the fork.
#[derive(Clone)]
struct BranchHistory {
    records: Vec<Arc<StepRecord>>,
    /// Every how many samples a record is kept.
    stride: u64,
    head: Option<Arc<StepRecord>>,
    trail: Trail,
    trails: Vec<Trail>,
    trail_every: f64,
    /// Least clearance between bodies over time: s, m.
    rooms: Vec<[f64; 2]>,
    /// What happened to the formation, and when in s.
    events: Vec<(f64, EventRecord)>,
}

/// Interval between two measurements of clearance, s.
const ROOM_EVERY: f64 = 0.1;
/// Maximum number of robots for which clearance is measured while they drive.
const MOST_ROBOTS_WITH_ROOM: usize = 30;
/// Maximum number of kept events.
const MOST_EVENTS: usize = 10_000;
/// Maximum number of kept clearances.
const MOST_ROOMS: usize = 20_000;

impl History {
    /// The empty history of a run of `fleet` with a control period in s.
    pub fn new(fleet: Arc<FleetInfo>, period: f64) -> Self {
        let past = BranchHistory {
            records: Vec::new(),
            stride: 1,
            head: None,
            trail: Trail::new(&fleet),
            trails: Vec::new(),
            trail_every: TRAIL_EVERY,
            rooms: Vec::new(),
            events: Vec::new(),
        };
        let clearance = (fleet.robots.len() <= MOST_ROBOTS_WITH_ROOM).then(|| Clearance::new(&fleet));
        Self { clearance, fleet, period, past: vec![past], shown: None }
    }

    /// Robots and edges.
    pub fn fleet(&self) -> &Arc<FleetInfo> {
        &self.fleet
    }

    /// Changes the appearance of the run: light, title, views.
    pub fn dress(&mut self, scene: &scene::Scene) {
        let light = vocabulary::Light {
            sun_elevation: scene.environment.sun_elevation,
            sun_azimuth: scene.environment.sun_azimuth,
            haze_from: scene.environment.haze_from,
        };
        self.fleet =
            Arc::new(FleetInfo { light, title: scene.title.clone(), ..FleetInfo::clone(&self.fleet) });
    }

    /// Control period, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Number of branches.
    pub fn branches(&self) -> usize {
        self.past.len()
    }

    /// Adds the next record of a branch.
    pub fn push(&mut self, branch: usize, record: StepRecord) {
        let sample = self.sample(record.snapshot.time);
        let most = self.most_moments(&record);
        if let Some(past) = self.past.get_mut(branch) {
            // A branch receives its first record again; it may have it already.
            if past.is_known(&record) {
                return;
            }
            if let Some(clearance) = &self.clearance {
                past.measure(clearance, &record);
            }
            past.push(sample, Arc::new(record), most, self.period);
        }
    }

    /// Adds a branch that forks from `from` before `sample`.
    pub fn fork(&mut self, from: usize, sample: u64) {
        let until = (sample as f64 - 0.5) * self.period;
        let Some(parent) = self.past.get(from) else { return };
        let mut past = BranchHistory {
            records: parent.records.iter().filter(|m| m.snapshot.time < until).cloned().collect(),
            stride: parent.stride,
            head: None,
            trail: Trail::new(&self.fleet),
            trails: parent.trails.iter().filter(|t| before(t, until)).cloned().collect(),
            trail_every: parent.trail_every,
            rooms: parent.rooms.iter().filter(|[time, _]| *time < until).copied().collect(),
            events: parent.events.iter().filter(|(time, _)| *time < until).copied().collect(),
        };
        past.head = past.records.last().cloned();
        past.trail = past.trail_until(until, &self.fleet);
        self.past.push(past);
    }

    /// Control sample at a time, s.
    pub fn sample(&self, time: f64) -> u64 {
        (time / self.period).round().max(0.0) as u64
    }

    /// The last record of a branch.
    pub fn head(&self, branch: usize) -> Option<&Arc<StepRecord>> {
        self.past.get(branch)?.head.as_ref()
    }

    /// Time of the last record of a branch, s.
    pub fn end(&self, branch: usize) -> f64 {
        self.head(branch).map_or(0.0, |record| record.snapshot.time)
    }

    /// Time of the last record of any branch, s.
    pub fn latest(&self) -> f64 {
        (0..self.past.len()).map(|branch| self.end(branch)).fold(0.0, f64::max)
    }

    /// The record of a branch at a time; interpolated between two kept records.
    pub fn at(&self, branch: usize, time: f64) -> Option<Arc<StepRecord>> {
        let past = self.past.get(branch)?;
        let head = past.head.as_ref()?;
        let eps = 1e-6 * self.period;
        if time >= head.snapshot.time - eps {
            return Some(Arc::clone(head));
        }
        let after = past.records.partition_point(|m| m.snapshot.time <= time + eps);
        let before = past.records.get(after.saturating_sub(1))?;
        let next = past.records.get(after).unwrap_or(head);
        let (a, b) = (before.snapshot.time, next.snapshot.time);
        if past.stride == 1 || time - a < eps || b <= a {
            return Some(Arc::clone(before));
        }
        Some(Arc::new(StepRecord::between(before, next, ((time - a) / (b - a)).clamp(0.0, 1.0))))
    }

    /// Prepares the trail of a branch up to a time, for [`History::trail`].
    pub fn prepare_trail(&mut self, branch: usize, time: f64) {
        let Some(past) = self.past.get(branch) else { return };
        if past.is_head(time) {
            return;
        }
        let near = self.shown.take().filter(|(of, trail)| *of == branch && before(trail, time));
        let kept = past.trails.iter().rev().find(|trail| before(trail, time));
        let since = |trail: &Trail| trail.time().unwrap_or(f64::NEG_INFINITY);
        let start = match (near, kept) {
            (Some((_, near)), Some(kept)) if since(&near) < since(kept) => kept.clone(),
            (Some((_, near)), _) => near,
            (None, Some(kept)) => kept.clone(),
            (None, None) => Trail::new(&self.fleet),
        };
        self.shown = Some((branch, past.grow(start, time)));
    }

    /// The trail of a branch at a time, for pictures: that of the present, or of the time prepared last.
    pub fn trail(&self, branch: usize, time: f64) -> Option<&Trail> {
        let past = self.past.get(branch)?;
        if past.is_head(time) {
            return Some(&past.trail);
        }
        self.shown.as_ref().filter(|(of, _)| *of == branch).map(|(_, trail)| trail)
    }

    /// Records of a branch after one time and up to another, s.
    pub fn since(&self, branch: usize, [after, until]: [f64; 2]) -> Vec<Arc<StepRecord>> {
        let Some(past) = self.past.get(branch) else { return Vec::new() };
        let first = past.records.partition_point(|m| m.snapshot.time <= after + 1e-9);
        let some = past.records[first..].iter().take_while(|m| m.snapshot.time <= until + 1e-9);
        some.cloned().collect()
    }

    /// At most `most` evenly spaced records of a branch between two times, s.
    pub fn between(&self, branch: usize, [from, to]: [f64; 2], most: usize) -> Vec<&StepRecord> {
        let Some(past) = self.past.get(branch) else { return Vec::new() };
        let first = past.records.partition_point(|m| m.snapshot.time < from).saturating_sub(1);
        let last = (past.records.partition_point(|m| m.snapshot.time <= to) + 1).min(past.records.len());
        let some = &past.records[first.min(last)..last];
        // Whole multiples of the step, so that curves do not jitter as they grow.
        let step = some.len().div_ceil(most.max(1)).next_power_of_two();
        let skip = first.next_multiple_of(step) - first;
        let mut records: Vec<&StepRecord> = some.iter().skip(skip).step_by(step).map(|m| &**m).collect();
        let head = past.head.as_deref().filter(|head| head.snapshot.time <= to);
        let last = records.last().map_or(f64::NEG_INFINITY, |record| record.snapshot.time);
        records.extend(head.filter(|head| head.snapshot.time > last));
        records
    }

    /// Least clearances between bodies of a branch between two times: s, m.
    pub fn rooms(&self, branch: usize, [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
        let Some(past) = self.past.get(branch) else { return Vec::new() };
        past.rooms.iter().filter(|[time, _]| (from..=to).contains(time)).copied().collect()
    }

    /// What happened to the formation on a branch, and when in s.
    pub fn events(&self, branch: usize) -> &[(f64, EventRecord)] {
        self.past.get(branch).map_or(&[], |past| &past.events)
    }

    fn most_moments(&self, record: &StepRecord) -> usize {
        let robots = self.fleet.robots.len() * size_of::<vocabulary::RobotState>();
        let edges = self.fleet.edges.len() * size_of::<vocabulary::EdgeState>();
        let props = self.fleet.props.len() * size_of::<vocabulary::Placement>();
        let safety =
            record.safety.len() * (size_of::<SafetyState>() + FEW_BARRIERS * size_of::<BarrierState>());
        (MOST_BYTES / (robots + edges + props + safety + 200)).clamp(LEAST_MOMENTS, MOST_MOMENTS)
    }
}

impl BranchHistory {
    fn is_head(&self, time: f64) -> bool {
        self.head.as_ref().is_none_or(|head| time >= head.snapshot.time - 1e-9)
    }

    fn is_known(&self, record: &StepRecord) -> bool {
        self.head.as_ref().is_some_and(|head| record.snapshot.time <= head.snapshot.time)
    }

    fn measure(&mut self, clearance: &Clearance, record: &StepRecord) {
        let time = record.snapshot.time;
        let due = self.rooms.last().is_none_or(|[last, _]| time >= last + ROOM_EVERY - 1e-9);
        if !due || self.rooms.len() >= MOST_ROOMS {
            return;
        }
        let mut clearance = clearance.clone();
        clearance.push(&record.snapshot);
        let rooms = clearance.least().iter().flatten().map(|room| room.clearance);
        let least = rooms.fold(f64::INFINITY, f64::min);
        if least.is_finite() {
            self.rooms.push([time, least]);
        }
    }

    fn push(&mut self, sample: u64, record: Arc<StepRecord>, most: usize, period: f64) {
        self.trail.push(&record);
        let time = record.snapshot.time;
        if self.events.len() < MOST_EVENTS {
            self.events.extend(record.events.iter().map(|event| (time, *event)));
        }
        if self.trails.last().and_then(Trail::time).unwrap_or(0.0) + self.trail_every <= time + 1e-9 {
            self.trails.push(self.trail.clone());
            if self.trails.len() > MOST_TRAILS {
                self.trail_every *= 2.0;
                let mut kept = false;
                self.trails.retain(|_| {
                    kept = !kept;
                    !kept
                });
            }
        }
        self.head = Some(Arc::clone(&record));
        if sample.is_multiple_of(self.stride) {
            self.records.push(record);
        }
        if self.records.len() > most {
            self.stride *= 2;
            let stride = self.stride;
            self.records.retain(|m| ((m.snapshot.time / period).round() as u64).is_multiple_of(stride));
        }
    }

    /// The trail of all records up to a time.
    fn trail_until(&self, time: f64, fleet: &FleetInfo) -> Trail {
        let start = self.trails.iter().rev().find(|trail| before(trail, time));
        self.grow(start.cloned().unwrap_or_else(|| Trail::new(fleet)), time)
    }

    /// A trail with the records after it, up to a time.
    fn grow(&self, mut trail: Trail, time: f64) -> Trail {
        let last = trail.time().unwrap_or(f64::NEG_INFINITY);
        let from = self.records.partition_point(|m| m.snapshot.time <= last);
        for record in self.records.iter().skip(from).take_while(|m| m.snapshot.time <= time + 1e-9) {
            trail.push(record);
        }
        trail
    }
}

/// Whether a trail ends before a time.
fn before(trail: &Trail, time: f64) -> bool {
    trail.time().is_none_or(|end| end <= time + 1e-9)
}
